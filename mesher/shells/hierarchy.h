// Who grows from whom, for shells of which no file says it.
#pragma once

#include <vector>

#include "mesher/plant/segmented_plant.h"
#include "mesher/shells/hierarchy_weights.h"
#include "mesher/shells/shell_shape.h"

namespace liana {

struct Growth {
  int parent = -1;        ///< index of a shell, -1: a trunk
  double confidence = 1;  ///< 0 to 1
  Vec3 root;              ///< where it begins
};

/// One tree, or several trunks, over all shells. Every shell has ends it may grow from and, if it is a
/// branch, bones that others may grow from. Each pair of an end and a branch near it has a cost: the gap
/// between them, the distance from the branch's middle line, being thicker than what carries it, beginning at
/// its thin end, or where the other branch itself begins (a sibling rather than a parent). Standing on the
/// ground has a cost too. The tree grows from the thickest trunk by the cheapest pair (Prim), then each shell
/// moves to a cheaper parent among those that do not grow from it. A known parent (index of a branch, else
/// -1) is taken as it is. Leaves carry nothing and always have a parent: what floats goes to the nearest
/// branch. The confidence is that of the chosen pair among all of the shell's, as exp(-cost / 0.12). `up` is
/// a unit vector. Needs a branch. Time n log n.
std::vector<Growth> find_growth(const std::vector<ShellShape>& shapes, const std::vector<DomainKind>& kinds,
                                const std::vector<int>& known_parents, const Vec3& up,
                                const HierarchyWeights& weights = {});

}  // namespace liana
