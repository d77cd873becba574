#include "runtime/app/plant_options.h"

#include <CLI/CLI.hpp>

namespace liana {

void add_plant_options(CLI::App& verb, LoadOptions& options) {
  verb.add_option("--unit", options.unit,
                  "Unit of the plant's lengths [auto: metres in glTF, centimetres in MTG, else guessed from "
                  "its size]")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Unit>{
              {"m", Unit::Metre}, {"cm", Unit::Centimetre}, {"mm", Unit::Millimetre}, {"auto", Unit::Auto}},
          CLI::ignore_case))
      ->option_text("m|cm|mm|auto");
  verb.add_option("--up", options.up, "The plant's axis that points up [auto: z in PLY and MTG, else y]")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, UpAxis>{{"y", UpAxis::Y}, {"z", UpAxis::Z}, {"auto", UpAxis::Auto}},
          CLI::ignore_case))
      ->option_text("y|z|auto");
  verb.add_flag("--merged", options.ignore_hierarchy,
                "Split a glTF plant and find its hierarchy even if the file has one of its own");
}

}  // namespace liana
