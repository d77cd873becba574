#include "runtime/view/video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "mesher/base/error.h"

extern char** environ;

namespace liana {
namespace {

/// Keeps a write to a dead child from ending the program, for this thread only, and takes away the signal it
/// raised.
class NoBrokenPipe {
 public:
  NoBrokenPipe() {
    sigemptyset(&set_);
    sigaddset(&set_, SIGPIPE);
    sigset_t waiting;
    sigpending(&waiting);
    was_pending_ = sigismember(&waiting, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &set_, &before_);
  }
  ~NoBrokenPipe() {
    const timespec now{};
    if (!was_pending_)
      while (sigtimedwait(&set_, nullptr, &now) == SIGPIPE) continue;
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t set_, before_;
  bool was_pending_;
};

}  // namespace

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height, double frames_per_second)
    : path_(path), file_(path), width_(width), height_(height) {
  if (width < 2 || height < 2 || width % 2 || height % 2)
    throw Error(Error::Kind::Usage,
                fmt::format("{}: a video of {} x {} pixels is not possible", path.string(), width, height),
                "choose even sides");
  if (!(frames_per_second > 0 && frames_per_second <= 1000))
    throw Error(Error::Kind::Usage, fmt::format("{}: {} frames per second", path.string(), frames_per_second),
                "choose a rate above 0 and up to 1000");

  int input[2], output[2];  // each: read end, write end; closed in the child unless duplicated
  require(pipe2(input, O_CLOEXEC) == 0 && pipe2(output, O_CLOEXEC) == 0, "pipe failed");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input[0], 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output[1], 2);
  const std::string size = fmt::format("{}x{}", width, height), rate = fmt::format("{}", frames_per_second);
  // Without -xerror a disk that fills while the last bytes are written is still a success.
  // A path that starts with a dash would be taken for an option: "file:" makes it a name.
  const std::string target = "file:" + file_.partial().string();
  const char* arguments[] = {"ffmpeg",    "-y",         "-xerror",  "-nostdin", "-loglevel",    "error",
                             "-f",        "rawvideo",   "-pix_fmt", "rgb24",    "-s",           size.c_str(),
                             "-r",        rate.c_str(), "-i",       "pipe:0",   "-c:v",         "libx264",
                             "-preset",   "veryfast",   "-crf",     "19",       "-pix_fmt",     "yuv420p",
                             "-movflags", "+faststart", "-f",       "mp4",      target.c_str(), nullptr};
  const int failure =
      posix_spawnp(&child_, "ffmpeg", &actions, nullptr, const_cast<char* const*>(arguments), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(input[0]);
  close(output[1]);
  to_child_ = input[1];
  from_child_ = output[0];
  if (failure != 0) {
    child_ = -1;
    close(to_child_);
    close(from_child_);
    throw Error(Error::Kind::Output,
                fmt::format("{}: ffmpeg cannot be started ({})", path.string(), std::strerror(failure)),
                "install the Debian package ffmpeg, or ask for pictures (--png) instead");
  }
}

VideoWriter::~VideoWriter() {
  if (child_ > 0) {
    kill(child_, SIGTERM);
    wait_for_child();
  }
}

int VideoWriter::wait_for_child() {
  if (to_child_ >= 0) close(std::exchange(to_child_, -1));
  int status = 0;
  while (waitpid(child_, &status, 0) < 0 && errno == EINTR) continue;
  child_ = -1;
  if (from_child_ >= 0) close(std::exchange(from_child_, -1));
  return status;
}

std::string VideoWriter::messages() {
  std::string text(2000, '\0');
  size_t size = 0;
  for (ssize_t got; size < text.size() && (got = read(from_child_, &text[size], text.size() - size)) > 0;)
    size += size_t(got);
  text.resize(size);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

void VideoWriter::fail() {
  if (to_child_ >= 0) close(std::exchange(to_child_, -1));
  const std::string said = messages();
  wait_for_child();
  throw Error(Error::Kind::Output,
              fmt::format("{}: ffmpeg failed: {}", path_.string(), said.empty() ? "no message" : said),
              "check that the folder exists, is writable and has space");
}

void VideoWriter::add(const Image& frame) {
  require(child_ > 0 && frame.width == width_ && frame.height == height_,
          "VideoWriter::add: wrong size or finished");
  const NoBrokenPipe guard;
  for (size_t sent = 0; sent < frame.pixels.size();) {
    const ssize_t now = write(to_child_, frame.pixels.data() + sent, frame.pixels.size() - sent);
    if (now > 0)
      sent += size_t(now);
    else if (errno != EINTR)
      fail();
  }
}

void VideoWriter::finish() {
  require(child_ > 0, "VideoWriter::finish twice");
  close(std::exchange(to_child_, -1));
  const std::string said = messages();  // until ffmpeg ends
  const int status = wait_for_child();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(Error::Kind::Output,
                fmt::format("{}: ffmpeg failed: {}", path_.string(), said.empty() ? "no message" : said),
                "check that the folder exists, is writable and has space");
  file_.commit();
}

}  // namespace liana
