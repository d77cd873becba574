// A species law as the file that read_species_file reads.
#pragma once

#include <string>
#include <string_view>

#include "materials/law/species_file.h"

namespace liana {

/// Sets a number's source and confidence, e.g. of "groups.level1.damping.low_factor" (the value is in
/// file.law).
void set_source(SpeciesFile& file, const std::string& where, const std::string& source,
                const std::string& confidence);

/// TOML with every number of file.law and the source that file.numbers has for it (a group that another one
/// stood for takes that one's). `comment` goes on top, its lines marked as comments.
std::string species_toml(const SpeciesFile& file, std::string_view comment);

}  // namespace liana
