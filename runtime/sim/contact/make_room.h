// Lists that seldom ask for memory.
#pragma once

#include <cstddef>

namespace liana {

/// Room for `more` at the end of a list, and for twice as many when it has none: a plant that grows asks
/// seldom, one that does not asks once. What is not used costs addresses, not memory.
void make_room(auto& list, size_t more) {
  if (list.capacity() < list.size() + more) list.reserve(2 * (list.size() + more));
}

}  // namespace liana
