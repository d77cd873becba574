#include "runtime/sim/step/lanes/step_view.h"

namespace liana::lanes {

const Kernels& best_kernels() {
  static const Kernels& best = avx512_kernels() ? *avx512_kernels()
                               : avx2_kernels() ? *avx2_kernels()
                                                : portable_kernels();
  return best;
}

}  // namespace liana::lanes
