// A bake as a table for people.
#pragma once

#include <string>

#include "materials/bake/bake.h"

namespace liana {

/// One row per group and kind: how many, from the shortest to the longest, and what the law made of them;
/// then what failed. Ends with a newline.
std::string bake_table(const Bake& bake);

/// One row per domain.
std::string domain_table(const Bake& bake);

}  // namespace liana
