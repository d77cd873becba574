#include "runtime/wind/air/sph_pass.h"

#include "runtime/wind/field/simd8.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace liana {

constexpr float kFarAway = 1e18f;  // m: its square still is a float

namespace portable {
namespace {

inline uint32_t append_positive(const Float8& left, const int32_t* index, int32_t* list, uint32_t used) {
  for (int j = 0; j < 8; ++j) {
    list[used] = index[j];
    used += left[j] > 0;
  }
  return used;
}

inline uint32_t append_positive(const Float8& left, const Float8& x, const Float8& y, const Float8& z,
                                const Int8& index, const Candidates& to, uint32_t n) {
  for (int j = 0; j < 8; ++j) {
    to.x[n] = x[j], to.y[n] = y[j], to.z[n] = z[j], to.index[n] = index[j];
    n += left[j] > 0;
  }
  return n;
}

inline uint32_t append_positive(const Float8& left, const Int8& number, int32_t* index, float* depth,
                                uint32_t used) {
  for (int j = 0; j < 8; ++j) {
    index[used] = number[j], depth[used] = left[j];
    used += left[j] > 0;
  }
  return used;
}

inline Float8 square_root(const Float8& a) {
  Float8 root;
  for (int j = 0; j < 8; ++j) root[j] = __builtin_sqrtf(a[j]);
  return root;
}

}  // namespace
}  // namespace portable

#if defined(__x86_64__)
namespace avx2 {
namespace {

/// For each of the 256 outcomes of eight comparisons: the places of the ones, first, and their number.
struct Compression {
  alignas(32) int32_t places[256][8];
  uint8_t count[256];
};
constexpr Compression compression() {
  Compression table = {};
  for (int mask = 0; mask < 256; ++mask)
    for (int j = 0; j < 8; ++j)
      if (mask >> j & 1) table.places[mask][table.count[mask]++] = j;
  return table;
}
constexpr Compression kCompression = compression();

__attribute__((target("avx2"), always_inline)) inline uint32_t append_positive(Float8 left,
                                                                               const int32_t* index,
                                                                               int32_t* list, uint32_t used) {
  const int mask = _mm256_movemask_ps(_mm256_cmp_ps(left, _mm256_setzero_ps(), _CMP_GT_OQ));
  const __m256i places = _mm256_load_si256(reinterpret_cast<const __m256i*>(kCompression.places[mask]));
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(index));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(list + used), _mm256_permutevar8x32_epi32(all, places));
  return used + kCompression.count[mask];
}

__attribute__((target("avx2"), always_inline)) inline uint32_t append_positive(Float8 left, Float8 x,
                                                                               Float8 y, Float8 z, Int8 index,
                                                                               const Candidates& to,
                                                                               uint32_t n) {
  const int mask = _mm256_movemask_ps(_mm256_cmp_ps(left, _mm256_setzero_ps(), _CMP_GT_OQ));
  const __m256i places = _mm256_load_si256(reinterpret_cast<const __m256i*>(kCompression.places[mask]));
  _mm256_storeu_ps(to.x + n, _mm256_permutevar8x32_ps(x, places));
  _mm256_storeu_ps(to.y + n, _mm256_permutevar8x32_ps(y, places));
  _mm256_storeu_ps(to.z + n, _mm256_permutevar8x32_ps(z, places));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.index + n),
                      _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(index), places));
  return n + kCompression.count[mask];
}

__attribute__((target("avx2"), always_inline)) inline uint32_t append_positive(Float8 left, Int8 number,
                                                                               int32_t* index, float* depth,
                                                                               uint32_t used) {
  const int mask = _mm256_movemask_ps(_mm256_cmp_ps(left, _mm256_setzero_ps(), _CMP_GT_OQ));
  const __m256i places = _mm256_load_si256(reinterpret_cast<const __m256i*>(kCompression.places[mask]));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(index + used),
                      _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(number), places));
  _mm256_storeu_ps(depth + used, _mm256_permutevar8x32_ps(left, places));
  return used + kCompression.count[mask];
}

__attribute__((target("avx2"), always_inline)) inline Float8 square_root(Float8 a) {
  return _mm256_sqrt_ps(a);
}

}  // namespace
}  // namespace avx2
#endif

}  // namespace liana

#define LIANA_ISA portable
#define LIANA_TARGET
#include "runtime/wind/air/sph_pass_body.h"
#undef LIANA_ISA
#undef LIANA_TARGET

#if defined(__x86_64__)
#define LIANA_ISA avx2
#define LIANA_TARGET __attribute__((target("avx2")))
#include "runtime/wind/air/sph_pass_body.h"
#undef LIANA_ISA
#undef LIANA_TARGET
#endif

namespace liana {

const SphPasses& sph_passes(bool portable) {
  static constexpr SphPasses plain = {portable::gather, portable::density, portable::force,
                                      portable::ellipsoid, "portable"};
#if defined(__x86_64__)
  static constexpr SphPasses wide = {avx2::gather, avx2::density, avx2::force, avx2::ellipsoid, "AVX2"};
  if (!portable && __builtin_cpu_supports("avx2")) return wide;
#endif
  return plain;
}

}  // namespace liana
