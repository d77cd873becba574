// Eight floats at once in plain GCC/Clang vector types: one meaning whatever the processor has, since nothing
// is fused or approximated. Functions that use it are compiled twice (see sph_pass_body.h).
#pragma once

#include <cstdint>

namespace liana {

using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));
/// The same, at any address. Clang keeps the alignment only of a typedef.
typedef float Float8Loose __attribute__((vector_size(32), aligned(4), may_alias));
typedef float Float4Loose __attribute__((vector_size(16), aligned(4), may_alias));

}  // namespace liana
