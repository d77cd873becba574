#include "materials/video/tracks/video_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <utility>

#include "mesher/base/error.h"

extern char** environ;

namespace liana {
namespace {

constexpr int kLargestSide = 8192;  // pixels

}  // namespace

VideoReader::VideoReader(const std::filesystem::path& path) : path_(path) {
  if (!std::filesystem::is_regular_file(path))
    throw Error(Error::Kind::Input, path.string() + ": no such file",
                "check the path; it is relative to the current folder");
  int output[2];
  require(pipe2(output, O_CLOEXEC) == 0, "pipe failed");
  messages_ = memfd_create("ffmpeg", MFD_CLOEXEC);
  require(messages_ >= 0, "memfd_create failed");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output[1], 1);
  posix_spawn_file_actions_adddup2(&actions, messages_, 2);
  // "file:" makes a name of what starts with a dash; the white list keeps a playlist from reaching elsewhere.
  // YUV4MPEG2 says size and rate in its first line.
  const std::string source = "file:" + path.string();
  const char* arguments[] = {"ffmpeg",       "-nostdin", "-loglevel",    "error", "-protocol_whitelist",
                             "file,pipe",    "-i",       source.c_str(), "-map",  "0:v:0",
                             "-pix_fmt",     "gray",     "-strict",      "-1",    "-f",
                             "yuv4mpegpipe", "pipe:1",   nullptr};
  const int failure =
      posix_spawnp(&child_, "ffmpeg", &actions, nullptr, const_cast<char* const*>(arguments), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(output[1]);
  from_child_ = output[0];
  if (failure != 0) {
    child_ = -1;
    finish();
    throw Error(Error::Kind::Input,
                fmt::format("{}: ffmpeg cannot be started ({})", path.string(), std::strerror(failure)),
                "install the Debian package ffmpeg, or give point tracks as CSV");
  }
  try {
    read_header();
  } catch (...) {
    finish();
    throw;
  }
}

VideoReader::~VideoReader() {
  finish();
}

void VideoReader::finish() {
  if (from_child_ >= 0) close(std::exchange(from_child_, -1));
  if (child_ > 0) {
    kill(child_, SIGTERM);
    while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) continue;
    child_ = -1;
  }
  if (messages_ >= 0) close(std::exchange(messages_, -1));
}

void VideoReader::fail(const std::string& what) {
  char said[300] = {};
  if (pread(messages_, said, sizeof said - 1, 0) < 0) said[0] = '\0';
  std::string text(said);
  if (const size_t end = text.find('\n'); end != std::string::npos) text.resize(end);
  throw Error(Error::Kind::Input,
              fmt::format("{}: {}{}{}", path_.string(), what, text.empty() ? "" : ": ", text),
              "give a video that ffmpeg plays (mp4, mov, webm, ...), or point tracks as .csv");
}

bool VideoReader::read_bytes(void* to, size_t count) {
  for (size_t got = 0; got < count;) {
    const ssize_t now = read(from_child_, static_cast<char*>(to) + got, count - got);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) {
      if (got > 0) fail("the video breaks off");
      return false;
    }
    got += static_cast<size_t>(now);
  }
  return true;
}

std::string VideoReader::read_line() {
  std::string line;
  for (char c; line.size() < 1000 && read_bytes(&c, 1) && c != '\n';) line += c;
  return line;
}

void VideoReader::read_header() {
  std::istringstream words(read_line());
  std::string word;
  words >> word;
  if (word != "YUV4MPEG2") fail("is no video");
  unsigned rate = 0, per = 0;
  while (words >> word) {
    if (word[0] == 'W') width_ = std::atoi(&word[1]);
    if (word[0] == 'H') height_ = std::atoi(&word[1]);
    if (word[0] == 'F' && std::sscanf(&word[1], "%u:%u", &rate, &per) == 2 && per > 0)
      frames_per_second_ = static_cast<double>(rate) / per;
  }
  if (width_ < 1 || height_ < 1 || width_ > kLargestSide || height_ > kLargestSide)
    fail(fmt::format("has frames of {} x {} pixels; up to {} a side can be read", width_, height_,
                     kLargestSide));
  if (!(frames_per_second_ > 0 && frames_per_second_ <= 1e4))
    fail("does not say how many frames a second has");
}

bool VideoReader::next(GrayFrame& frame) {
  if (read_line().substr(0, 5) != "FRAME") return false;
  frame.width = width_;
  frame.height = height_;
  frame.pixels.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_));
  if (!read_bytes(frame.pixels.data(), frame.pixels.size())) fail("the video breaks off");
  return true;
}

}  // namespace liana
