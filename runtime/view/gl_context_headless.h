// OpenGL without a screen.
#pragma once

#include <string>

namespace liana {

/// An OpenGL 3.3 core context through EGL, made current on the calling thread; no display or window system is
/// needed. Surfaceless first, then every EGL device in turn. Throws Error{Output} naming what was tried and
/// what to install.
class HeadlessContext {
 public:
  HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;
  ~HeadlessContext();

  void make_current();
  /// What draws, as "llvmpipe (LLVM 15.0.6, 256 bits), surfaceless".
  const std::string& description() const { return description_; }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string description_;
};

}  // namespace liana
