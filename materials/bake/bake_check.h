// The rules every bake keeps, whoever made it.
#pragma once

#include "materials/bake/bake.h"

namespace liana {

/// Parents first, every number finite and of a possible sign, centrelines of two stations or more, kinds
/// known, law in range. Throws Error{Input} naming `where` and the domain.
void check(const Bake& bake, const std::string& where);

}  // namespace liana
