// Where a frame is drawn: colour and depth, with or without multisampling.
#pragma once

#include <optional>

#include "runtime/picture/image.h"
#include "runtime/view/gl_objects.h"

namespace liana {

/// What several samples a pixel are drawn to.
struct Multisampled {
  GlObject frame{GlKind::Framebuffer}, color{GlKind::Renderbuffer}, depth{GlKind::Renderbuffer};
};

class FrameTarget {
 public:
  /// samples: 1, or 4 for smooth edges. Sides of 1 to 16384 pixels. Throws Error{Usage} outside.
  FrameTarget(int width, int height, int samples);

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }

  void bind() const;     ///< what is drawn next goes here
  void resolve() const;  ///< after the last draw: colour() and depth() hold the frame
  unsigned color() const { return color_.id(); }  ///< texture, RGBA
  unsigned depth() const { return depth_.id(); }  ///< texture
  Image read() const;                             ///< the resolved frame
  void copy_to_screen(int width, int height) const;

 private:
  int width_, height_, samples_;
  GlObject frame_{GlKind::Framebuffer}, color_{GlKind::Texture}, depth_{GlKind::Texture};
  std::optional<Multisampled> fine_;
};

}  // namespace liana
