// The same kernels, still four at a time, for processors with AVX-512: its 32 registers and its shuffles make
// them a tenth faster.
#define LIANA_LANES lanes_avx512
#include "runtime/sim/step/lanes/step_kernels.h"

namespace liana::lanes {

#ifdef __AVX512VL__
const Kernels* avx512_kernels() {
  using namespace lanes_avx512;
  static constexpr Kernels kernels{"avx512", predict, assemble, factor, substitute, advance};
  const bool supported = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                         __builtin_cpu_supports("avx512dq");
  return supported ? &kernels : nullptr;
}
#else
const Kernels* avx512_kernels() {
  return nullptr;
}
#endif

}  // namespace liana::lanes
