// The same kernels for processors with AVX2; runtime/CMakeLists.txt compiles this file for them.
#define LIANA_LANES lanes_avx2
#include "runtime/sim/step/lanes/step_kernels.h"

namespace liana::lanes {

#ifdef __AVX2__
const Kernels* avx2_kernels() {
  using namespace lanes_avx2;
  static constexpr Kernels kernels{"avx2", predict, assemble, factor, substitute, advance};
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
}
#else
const Kernels* avx2_kernels() {
  return nullptr;
}
#endif

}  // namespace liana::lanes
