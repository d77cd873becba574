#include <fmt/core.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "mesher/base/error.h"
#include "mesher/base/nearest_word.h"
#include "runtime/app/verbs.h"

namespace {

using liana::Error;

int exit_code_of(Error::Kind kind) {
  switch (kind) {
    case Error::Kind::Usage:
      return liana::kUsageError;
    case Error::Kind::Partial:
      return liana::kPartial;
    case Error::Kind::Cancelled:
      return liana::kCancelled;
    case Error::Kind::Input:
    case Error::Kind::Output:
      break;
  }
  return liana::kInputError;
}

void complain(const std::string& what, const std::string& hint) {
  fmt::print(stderr, "liana: {}\n", what);
  if (!hint.empty()) fmt::print(stderr, "  try: {}\n", hint);
}

/// Says what is wrong with a command line, naming the verb that was probably meant.
void complain_of_usage(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return complain(error.what(), "liana --help");
  const std::string given = argv[1];
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  const std::string nearest = liana::nearest_word(given, verbs);
  if (nearest == given) return complain(error.what(), "liana " + given + " --help");
  complain("there is no verb '" + given + "'",
           "did you mean 'liana " + nearest + "'? liana --help lists all");
}

/// Keep what is freed: baking solves thousands of domains that take and give back the same megabyte, and
/// asking the system for it each time costs a sixth of a small domain. The program's choice, not its
/// libraries'.
void keep_freed_memory() {
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  CLI::App app{"Liana makes plants move like real ones: what is baked is what moves.", "liana"};
  app.set_version_flag("--version", std::string("liana ") + LIANA_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Example:\n  liana bake data/plants/apple_small.glb --species apple -o apple.bake\n"
      "Each verb has its own help: liana bake --help");
  int exit_code = liana::kSuccess;
  liana::add_bake_verb(app, exit_code);
  liana::add_inspect_verb(app, exit_code);
  liana::add_infer_verb(app, exit_code);
  liana::add_verify_verb(app, exit_code);
  liana::add_modes_verb(app, exit_code);
  liana::add_simulate_verb(app, exit_code);
  liana::add_edit_verb(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    complain_of_usage(app, error, argc, argv);
    return liana::kUsageError;
  } catch (const Error& error) {
    complain(error.what(), error.hint);
    return exit_code_of(error.kind);
  } catch (const std::exception& error) {
    complain(std::string("stopped by a fault of its own: ") + error.what(),
             "report it with the command and the file");
    return liana::kInputError;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    complain("what it has to say cannot be written", "check where its output goes to");
    return liana::kInputError;
  }
  return exit_code;
}
