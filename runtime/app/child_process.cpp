#include "runtime/app/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

extern char** environ;

namespace liana {
namespace {

/// Until it ends; one interrupt when the user wants to stop. The status of waitpid.
int wait_for(pid_t child, const Progress& progress) {
  constexpr std::chrono::milliseconds kPause(10);
  bool interrupted = false;
  for (int status = 0;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    require(ended >= 0 || errno == EINTR, "a child is waited for once");
    if (ended == child) return status;
    if (progress.cancelled() && !interrupted) {
      kill(child, SIGINT);
      interrupted = true;
    }
    std::this_thread::sleep_for(kPause);
  }
}

}  // namespace

int run_self(const std::vector<std::string>& arguments, const std::filesystem::path& log,
             const Progress& progress) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  // A group of its own: a terminal's Ctrl-C reaches it through us, once.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = -1;
  const int failed = posix_spawn(&child, program.c_str(), &files, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (failed)
    throw Error(Error::Kind::Output,
                log.string() + ": cannot start a process (" + std::strerror(failed) + ")");

  const int status = wait_for(child, progress);
  progress.throw_if_cancelled();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace liana
