// What the lane kernels work on: plain numbers, no classes, so that one source can be compiled for several
// processors without any of its code leaking from one copy into another.
#pragma once

#include <cstddef>
#include <cstdint>

namespace liana::lanes {

/// Four particles that do not depend on each other, handled together. The first `count` lanes are theirs, the
/// others repeat the first.
struct Pack {
  uint32_t self[4];    ///< particle
  uint32_t slot[4];    ///< its pose and block
  uint32_t parent[4];  ///< its parent's pose, or the world's
  uint32_t up[4];      ///< block that what it passes on is added to
  uint32_t count;
};

/// Numbers per particle and per pack, and where in a record they are.
constexpr int kParticleStride = 32;  ///< struct Particle: see the assertions in time_step.cpp
constexpr int kMotionStride = 20;    ///< struct Motion
constexpr int kPoseStride = 16;   ///< position 3, –, orientation 4, velocity 3, angular velocity 3, – –
constexpr int kBlockStride = 28;  ///< A_i 21 (lower triangle, row by row), b_i 6, –
constexpr int kBlockLoad = 21;
constexpr int kRecordLanes = 64;  ///< Lanes per pack, see step_kernels.h

constexpr double kLeastGapScale = 1e-3;  ///< m: what a gap is measured against without any length

/// One substep over one plant. Symbols as in time_step.h.
struct StepView {
  const double* particle;  ///< kParticleStride each
  const double* from;      ///< Motion at the start, kMotionStride each
  double* to;              ///< Motion at the end
  double* pose;            ///< kPoseStride per slot: first as balanced, then as at the end
  double* block;           ///< kBlockStride per slot
  double* record;          ///< kRecordLanes × 4 per pack
  const Pack* packs;       ///< children in earlier packs than parents
  size_t pack_count;
  double gravity[3];
  double h, alpha_m, alpha_f;
  /// x₁ = x₀ + h v₀ + h² (before a₀ + after a₁): ½−β and β. v₁ = v₀ + h ((1−γ) a₀ + γ a₁).
  double before, after, gamma;
  double position_rate, velocity_rate;  ///< k₁, k₂
  size_t ahead = 0;  ///< packs to the one whose data is called into the cache while one is eliminated
};

/// What a run over some packs found out.
struct AdvanceResult {
  double gap = 0;      ///< largest joint gap over its gap_scale()
  bool finite = true;  ///< every number of the new state is

  void add(const AdvanceResult& more) {
    if (more.gap > gap) gap = more.gap;
    finite = finite && more.finite;
  }
};

/// The phases of a substep, in order; each runs over packs [begin, end).
struct Kernels {
  const char* name;
  void (*predict)(const StepView&, size_t begin, size_t end);
  void (*assemble)(const StepView&, size_t begin, size_t end);
  void (*factor)(const StepView&, size_t begin, size_t end);
  void (*substitute)(const StepView&, size_t begin, size_t end);  ///< last pack first: accelerations only
  AdvanceResult (*advance)(const StepView&, size_t begin, size_t end);  ///< last pack first
};

/// The fastest that this processor can run. All give the same bits.
const Kernels& best_kernels();
const Kernels& portable_kernels();
/// Null when the processor (or the build) has no AVX2, or not AVX-512 with VL and DQ.
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

}  // namespace liana::lanes
