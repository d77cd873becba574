// Frames of any video file, in grey, decoded by an ffmpeg child process.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace liana {

struct GrayFrame {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  ///< width * height, rows from the top
};

/// Frames come at a constant rate (ffmpeg repeats or drops frames of a variable one) and upright.
class VideoReader {
 public:
  /// Throws Error{Input} when the file is missing, holds no video or is above 8192 pixels a side, and when
  /// ffmpeg is not installed.
  explicit VideoReader(const std::filesystem::path& path);
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;
  ~VideoReader();

  double frames_per_second() const { return frames_per_second_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// False at the end. Throws Error{Input} for a video that breaks off.
  bool next(GrayFrame& frame);

 private:
  bool read_bytes(void* to, size_t count);  ///< false at the end of the stream
  std::string read_line();
  void read_header();
  void finish();
  [[noreturn]] void fail(const std::string& what);

  std::filesystem::path path_;
  pid_t child_ = -1;
  int from_child_ = -1, messages_ = -1;
  int width_ = 0, height_ = 0;
  double frames_per_second_ = 0;
};

}  // namespace liana
