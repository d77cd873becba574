// Air as smoothed particles: [Haedrich17] Eq. 11-13 with the kernels and forces of [Müller et al. 2003].
//
//   s  spacing of the particles at rest, m          ρ₀  rest density, kg/m³      c  speed of sound, m/s
//   h  support radius of the kernels, 2 s           p   pressure, c² (ρ − ρ₀), never negative, Pa
//   m  mass of a particle: a lattice of spacing s has the density ρ₀ exactly
//
// The air is weakly compressible: c is not that of real air but a few times the fastest wind, so that
// densities differ by some per cent and a step may be long. Pressure does not pull: where no particles are,
// still air is meant.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mesher/base/archive.h"
#include "runtime/wind/air/air_bodies.h"
#include "runtime/wind/air/air_boundary.h"
#include "runtime/wind/air/air_cells.h"
#include "runtime/wind/air/air_neighbours.h"

namespace liana {

struct AirOptions {
  Vec3 low = Vec3::Constant(-1),
       high = Vec3::Constant(1);  ///< domain; particles that leave it are taken out, m
  double spacing = 0.15;          ///< s, m
  double rest_density = 1.3;      ///< kg/m³; [Haedrich17] §5.3: 1.3-1.4
  double sound_speed = 15;        ///< c, m/s
  double viscosity = 0.02;        ///< μ, Pa·s: the air's own plus unresolved eddies'
  size_t capacity = 10000;        ///< particles at most
  unsigned threads = 1;           ///< 0: one per core; the result does not depend on it
  bool portable = false;          ///< no AVX2, for comparison: the same result, slower
};

template <>
inline constexpr bool kPlainBytes<AirState> = true;

/// Its parts: AirCells (who is where), AirNeighbours (the sums over pairs), AirBoundary (walls), AirBodies.
class SphAir {
 public:
  /// Throws Error{Input} for values out of range. Walls must outlive the air; null: none. Moving ones are to
  /// be placed before each step where they are at its begin.
  explicit SphAir(const AirOptions& options, const AirWalls* walls = nullptr,
                  const MovingWalls* moving = nullptr);

  /// A new particle; false when there is no room for it, outside of the domain or in a solid.
  bool add(const Vec3& position, const Vec3& velocity);
  size_t size() const { return count_; }

  /// Longest stable step, s.
  double longest_step() const { return longest_step_; }
  /// One step of dt <= longest_step(), s. Particles change their order; bodies stand still and gather
  /// impulses.
  void step(double dt, std::span<AirBody> bodies = {});
  /// Brings cells and order up to date after add(): step() does so itself. Needed before the queries below.
  void sort();

  Vec3 position(size_t i) const { return options_.low + Vec3(state_[i].x, state_[i].y, state_[i].z); }
  Vec3 velocity(size_t i) const { return Vec3(state_[i].vx, state_[i].vy, state_[i].vz); }
  void push(size_t i, const Vec3& change);                             ///< adds to a velocity, m/s
  double density(size_t i) const { return neighbours_.density()[i]; }  ///< kg/m³, of the last step
  double particle_mass() const { return mass_; }                       ///< kg
  double support() const { return support_; }                          ///< h, m
  Vec3 momentum() const;                                               ///< kg·m/s, summed in double
  size_t limited() const { return limited_; }  ///< velocities cut to 2 c so far; 0 in normal motion
  /// Particles that left the domain so far, or that moving walls ran over or crushed.
  size_t left() const { return left_; }
  const AirOptions& options() const { return options_; }

  /// Who is where, as of the last sort: places relative to the domain's low corner.
  const AirCells& cells() const { return cells_; }
  const SphPasses& passes() const { return passes_; }
  const AirState* states() const { return state_.data(); }

  template <class Archive>
  void persist(Archive& a) {
    a(count_, limited_, left_);
    if (count_ > options_.capacity) state_mismatch();
    std::span<AirState> there(state_.data(), count_);
    a(there);
    // not state: options_, passes_, support_, mass_, longest_step_, constants_: set once
    // not state: cells_: made again from the particles, which are in their order
    // not state: boundary_, neighbours_, bodies_, sorted_, chunk_limited_: working memory of one step
    if constexpr (Archive::kReads) sort();
  }

 private:
  template <bool kMovingWalls>
  void densities(size_t chunk);
  template <bool kMovingWalls>
  void move(size_t chunk, float dt);
  void swap_in(size_t count);

  AirOptions options_;
  double support_, mass_, longest_step_;
  AirConstants constants_;
  const SphPasses& passes_;
  AirCells cells_;
  AirBoundary boundary_;
  AirNeighbours neighbours_;
  AirBodies bodies_;
  size_t count_ = 0, limited_ = 0, left_ = 0;
  std::vector<AirState> state_, sorted_;
  std::vector<size_t> chunk_limited_;
};

}  // namespace liana
