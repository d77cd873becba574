// The inner loops of the air's time step, eight neighbours at a time. Compiled with and without AVX2; both
// give the same bits.
#pragma once

#include <cstdint>

namespace liana {

/// One air particle, two vector loads. Coordinates are relative to a corner of the domain.
struct alignas(32) AirState {
  float x, y, z;          // m
  float pressure;         // Pa
  float vx, vy, vz;       // m/s
  float specific_volume;  // 1/ρ, m³/kg
};

/// m is the mass of a particle (kg); kernels in sph_kernels.h.
struct AirConstants {
  float support;         // h, m
  float density_factor;  // m times the factor of W_poly6
  float force_factor;    // m times the factor of ∇W_spiky and ∇²W_visc
  float viscosity;       // μ, Pa·s
};

/// What may be near the particles of one cell. Arrays have room for all particles and 8 more.
struct Candidates {
  float *x, *y, *z;  ///< m
  int32_t* index;    ///< which particle it is
};

/// Fills `to` with the particles of nine runs of indices (the rows of cells around one) that are nearer than
/// h to the box around particles [begin, end); pads with far ones. x, y, z: all particles, with 8 far ones
/// behind. Returns how many, a multiple of 8.
using GatherPass = uint32_t (*)(uint32_t begin, uint32_t end, const uint32_t (&run_begin)[9],
                                const uint32_t (&run_end)[9], const AirConstants& k, const float* x,
                                const float* y, const float* z, const Candidates& to);

/// Sums ρ of Eq. 12 for particles [begin, end) over all candidates nearer than h, itself included, into
/// density[i], and appends who they are: list_begin[i] .. list_end[i] in `list` (from `used` on), padded by
/// `nobody` to a multiple of 8. Returns the new `used`. The list must have room for (end - begin) * (count +
/// 16) more.
using DensityPass = uint32_t (*)(uint32_t begin, uint32_t end, const Candidates& near, uint32_t count,
                                 int32_t nobody, const AirConstants& k, const AirState* state, float* density,
                                 uint32_t* list_begin, uint32_t* list_end, int32_t* list, uint32_t used);

/// Acceleration (m/s²) of particles [begin, end) by Eq. 11: pressure and viscosity. Three floats each, and a
/// fourth unused. Forces of a pair are opposite to the last bit.
using ForcePass = void (*)(uint32_t begin, uint32_t end, const AirConstants& k, const AirState* state,
                           const uint32_t* list_begin, const uint32_t* list_end, const int32_t* list,
                           float* acceleration);

/// Appends those of particles [begin, end) that lie in the ellipsoid |η| < 1, η = G (x − centre), with 1 −
/// |η|, from `used` on. G by rows, 1/m. Returns the new `used`. Both lists need room for end - begin + 8
/// more.
using EllipsoidPass = uint32_t (*)(uint32_t begin, uint32_t end, const float* x, const float* y,
                                   const float* z, const float (&centre)[3], const float (&G)[9],
                                   int32_t* index, float* depth, uint32_t used);

struct SphPasses {
  GatherPass gather;
  DensityPass density;
  ForcePass force;
  EllipsoidPass ellipsoid;
  const char* name;
};

/// AVX2 where the processor has it, unless `portable`.
const SphPasses& sph_passes(bool portable = false);

}  // namespace liana
