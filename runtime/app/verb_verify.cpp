#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "materials/bake/bake_file.h"
#include "mesher/base/files.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/verify_text.h"
#include "runtime/app/writable.h"

namespace liana {
namespace {

struct VerifyArguments {
  std::filesystem::path bake, json;
  unsigned threads = 0;
  bool all = false;
  VerifyOptions options;
};

int verify(const VerifyArguments& arguments) {
  if (!arguments.json.empty()) require_writable_folder(arguments.json);
  const Bake bake = read_bake(arguments.bake);
  VerifyReport report;
  {
    TerminalProgress progress;
    report = verify_bake(bake, arguments.options, arguments.threads, progress);
  }
  if (!arguments.json.empty()) write_file(arguments.json, verify_json(bake, report));
  fmt::print("{}", verify_table(bake, report, arguments.options, arguments.all));
  return report.within ? kSuccess : kNotAsBaked;
}

}  // namespace

void add_verify_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* verb = app.add_subcommand(
      "verify",
      "Pluck every branch and leaf of a bake in the simulator and measure whether it moves as baked");
  verb->add_option("bake", arguments->bake, "The bake (liana bake makes one)")->required();
  verb->add_option("--json", arguments->json, "Also write what was measured as JSON");
  verb->add_flag("--all", arguments->all, "One row per branch and leaf instead of one per level");
  verb->add_option("--threads", arguments->threads, "Threads to use [all cores]")->check(CLI::Range(0, 1024));
  verb->add_option("--dt", arguments->options.scheme.dt, "Time step, s")
      ->check(CLI::Range(1e-4, 0.1))
      ->capture_default_str();
  verb->footer(
      "Example:\n"
      "  liana verify apple.bake --json verify.json\n\n"
      "Each one is held at its parent, carries the mass of all that grows from it, is bent a little and let "
      "go;\n"
      "frequency (nu) and damping factor (xi) are read from how its tip moves.\n"
      "Exit code: 0 all as baked, 1 bad input, 2 bad command line, 4 some are not as baked");
  verb->callback([arguments, &exit_code] { exit_code = verify(*arguments); });
}

}  // namespace liana
