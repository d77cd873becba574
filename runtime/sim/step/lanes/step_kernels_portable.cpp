// The kernels for any processor.
#define LIANA_LANES lanes_portable
#include "runtime/sim/step/lanes/step_kernels.h"

namespace liana::lanes {

const Kernels& portable_kernels() {
  using namespace lanes_portable;
  static constexpr Kernels kernels{"portable", predict, assemble, factor, substitute, advance};
  return kernels;
}

}  // namespace liana::lanes
