#include "runtime/view/frame_target.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstring>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr int kMostPixels = 16384;  // a side

void texture(unsigned id, GLint inner, GLenum outer, GLenum type, int width, int height) {
  glBindTexture(GL_TEXTURE_2D, id);
  glTexImage2D(GL_TEXTURE_2D, 0, inner, width, height, 0, outer, type, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
}

}  // namespace

FrameTarget::FrameTarget(int width, int height, int samples)
    : width_(width), height_(height), samples_(samples) {
  if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels)
    throw Error(Error::Kind::Usage, fmt::format("a picture of {} x {} pixels cannot be drawn", width, height),
                fmt::format("choose sides from 1 to {}", kMostPixels));
  texture(color_.id(), GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, width, height);
  texture(depth_.id(), GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_.id(), 0);
  if (samples > 1) {
    fine_.emplace();
    glBindRenderbuffer(GL_RENDERBUFFER, fine_->color.id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, fine_->depth.id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, fine_->frame.id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, fine_->color.id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, fine_->depth.id());
  }
  require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "frame target is incomplete");
}

void FrameTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, fine_ ? fine_->frame.id() : frame_.id());
  glViewport(0, 0, width_, height_);
}

void FrameTarget::resolve() const {
  if (!fine_) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, fine_->frame.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_.id());
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                    GL_NEAREST);
}

Image FrameTarget::read() const {
  Image image{width_, height_, std::vector<uint8_t>(size_t(width_) * height_ * 3)};
  std::vector<uint8_t> flipped(image.pixels.size());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, flipped.data());
  const size_t row = size_t(width_) * 3;
  for (int y = 0; y < height_; ++y)
    std::memcpy(&image.pixels[y * row], &flipped[(height_ - 1 - y) * row], row);
  return image;
}

void FrameTarget::copy_to_screen(int width, int height) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                    width == width_ && height == height_ ? GL_NEAREST : GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace liana
