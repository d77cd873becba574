// MP4 (H.264) through an ffmpeg child process.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>

#include "mesher/base/files.h"
#include "runtime/picture/image.h"

namespace liana {

/// add() every frame, then finish(); the file appears under its name only then. Without finish() nothing is
/// left. Sides must be even (a rule of the format). Throws Error{Usage} for a bad size or rate, Error{Output}
/// when ffmpeg is missing or fails, with what it said.
class VideoWriter {
 public:
  VideoWriter(const std::filesystem::path& path, int width, int height, double frames_per_second);
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  ~VideoWriter();

  void add(const Image& frame);
  void finish();

 private:
  [[noreturn]] void fail();
  int wait_for_child();
  std::string messages();

  std::filesystem::path path_;
  AtomicFile file_;
  int width_, height_;
  pid_t child_ = -1;
  int to_child_ = -1, from_child_ = -1;
};

}  // namespace liana
