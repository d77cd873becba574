#include "tests/support/program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include "mesher/base/files.h"
#include "tests/support/scratch_folder.h"

namespace liana {

namespace fs = std::filesystem;

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          const fs::path& folder) {
  const ScratchFolder capture;
  const fs::path out = capture / "out", err = capture / "err";
  const pid_t child = fork();
  if (child == 0) {
    std::vector<const char*> argv = {program.c_str()};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    argv.push_back(nullptr);
    const int to_out = open(out.c_str(), O_WRONLY | O_CREAT, 0600),
              to_err = open(err.c_str(), O_WRONLY | O_CREAT, 0600);
    const int from = open("/dev/null", O_RDONLY);
    setenv("XDG_CACHE_HOME", capture.path().c_str(), 1);  // no test sees what another one left
    if (chdir(folder.c_str()) != 0) _exit(127);
    dup2(from, 0), dup2(to_out, 1), dup2(to_err, 2);
    execvp(argv[0], const_cast<char* const*>(argv.data()));
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out), read_file(err)};
}

ProgramResult run_liana(const std::vector<std::string>& arguments, const fs::path& folder) {
  return run_program(LIANA_PROGRAM, arguments, folder);
}

fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / name; access(file.c_str(), X_OK) == 0) return file;
  return {};
}

}  // namespace liana
