// The verbs of the program. Each adds its subcommand, which sets the exit code when something is amiss.
#pragma once

namespace CLI {
class App;
}

namespace liana {

enum ExitCode : int {
  kSuccess = 0,
  kInputError = 1,   ///< or an output that cannot be written
  kUsageError = 2,   ///< the command line makes no sense
  kPartial = 3,      ///< done, but for parts that are named
  kNotAsBaked = 4,   ///< verify: something moves otherwise than baked
  kCancelled = 130,  ///< Ctrl-C
};

void add_bake_verb(CLI::App& app, int& exit_code);
void add_inspect_verb(CLI::App& app, int& exit_code);
void add_infer_verb(CLI::App& app, int& exit_code);
void add_verify_verb(CLI::App& app, int& exit_code);
void add_modes_verb(CLI::App& app, int& exit_code);
void add_simulate_verb(CLI::App& app, int& exit_code);
void add_edit_verb(CLI::App& app, int& exit_code);

}  // namespace liana
