// What the names in a file say of the kind of a part.
#pragma once

#include <string>

namespace liana {

/// "leaf", "leaves", "blade", "petal", "foliage", "frond", "needle" or "flower", any case, as a whole word of
/// the name or at its start ("Leaf.012").
bool named_as_leaf(const std::string& name);

/// "bark", "trunk", "branch", "stem", "twig", "wood" or "shoot", in the same way.
bool named_as_branch(const std::string& name);

}  // namespace liana
