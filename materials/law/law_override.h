// One number of a species law changed by a text, as on a command line.
#pragma once

#include <string>

#include "materials/law/species_law.h"

namespace liana {

/// assignment: "KEY=VALUE" with a key as in SourcedNumber::where, e.g. "groups.leaf.damping.low_factor=0.2"
/// ("groups." may be left out). Throws Error{Usage} for an unknown key (suggesting the nearest) or a value
/// that is no number, and Error{Input} when the law is no longer possible.
void set_number(SpeciesLaw& law, const std::string& assignment);

}  // namespace liana
