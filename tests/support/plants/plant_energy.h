// How much a plant moves, bends and stands high.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// J, of what can be seen: motion, bending, height. What joints hold in stretch comes and goes within a step:
/// they are so stiff that the hundredth of a length which a step may leave open would hold more than all the
/// rest.
double visible_energy(const Plant& plant);

}  // namespace liana
