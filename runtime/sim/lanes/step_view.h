// What the lane kernels work on: plain numbers, no classes, so that one source can be compiled for several
// processors without any of its code leaking from one copy into another.
#pragma once

#include <cstddef>
#include <cstdint>

namespace liana::lanes {

/// Four particles that do not depend on each other, handled together. The first `count` lanes are theirs, the
/// others repeat the first. parent is StepView::count, the world, for a root.
struct alignas(16) Pack {
  uint32_t self[4];
  uint32_t parent[4];
  uint32_t count;
};

/// Numbers per particle and per pack, and where in a record they are.
constexpr int kParticleStride = 32;  ///< struct Particle: see the assertions in time_step.cpp
constexpr int kMotionStride = 20;    ///< struct Motion
constexpr int kPoseStride = 16;   ///< position 3, –, orientation 4, velocity 3, angular velocity 3, – –
constexpr int kBlockStride = 28;  ///< A_i 21 (lower triangle, row by row), b_i 6, –
constexpr int kBlockLoad = 21;
constexpr int kRecordLanes = 73;  ///< Lanes per pack, see step_kernels.h

/// One substep over one plant. Symbols as in time_step.h.
struct StepView {
  uint32_t count;          ///< particles; record `count` of pose and block stands for the world
  const double* particle;  ///< kParticleStride each
  const double* from;      ///< Motion at the start, kMotionStride each
  double* to;              ///< Motion at the end
  double* pose;            ///< kPoseStride each, count + 1 of them: first as balanced, then as at the end
  double* block;           ///< kBlockStride each, count + 1 of them
  double* record;          ///< kRecordLanes × 4 per pack
  const Pack* packs;       ///< children in earlier packs than parents
  double gravity[3];
  double h, alpha_m, alpha_f, gamma, beta;
  double position_rate, velocity_rate;  ///< k₁, k₂
};

/// What a run over some packs found out.
struct AdvanceResult {
  double gap = 0;      ///< largest joint gap over the particle's length
  bool finite = true;  ///< every number of the new state is
};

/// The phases of a substep, in order; each runs over particles or packs [begin, end).
struct Kernels {
  const char* name;
  void (*predict)(const StepView&, uint32_t begin, uint32_t end);
  void (*assemble)(const StepView&, size_t begin, size_t end);
  void (*factor)(const StepView&, size_t begin, size_t end);      ///< packs in order
  void (*substitute)(const StepView&, size_t begin, size_t end);  ///< last pack first: accelerations only
  AdvanceResult (*advance)(const StepView&, size_t begin, size_t end);  ///< last pack first
};

/// The fastest that this processor can run. All give the same bits.
const Kernels& best_kernels();
const Kernels& portable_kernels();
/// Null when the processor (or the build) has no AVX2.
const Kernels* avx2_kernels();

}  // namespace liana::lanes
