// Text over the picture: numbers in a corner, help along the bottom. Needs an OpenGL context, current.
#pragma once

#include "runtime/picture/simulation_view.h"

struct ImGuiContext;

namespace liana {

struct OverlayText {
  SimulationStats stats;
  double frames_per_second = 0;
  double draw_ms = 0;  ///< of the last frame
  bool paused = false, grabbing = false, stats_shown = true;
};

class Overlay {
 public:
  Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;
  ~Overlay();

  /// Draws into the framebuffer that is bound, `width` x `height` pixels. `scale` enlarges the letters (1: 13
  /// pixels).
  void draw(const OverlayText& text, int width, int height, float scale = 1);

 private:
  ImGuiContext* context_;
};

}  // namespace liana
