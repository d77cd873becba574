// Plants and air particles move each other: what the plants gain, the air loses.
//
// Between a full-grown particle b of a plant and an air particle j near it acts a viscosity force of [Müller
// et al. 2003]'s form, μ V_b V_j (v_j − v_b) ∇²W(η), with η = G (x_j − x_b) of Eq. 13. The air's true
// viscosity acts in a layer far thinner than the particles' spacing; so μ is what gives the body's known drag
// in sum:
//
//   w_bj  V_j (1 − |η|), of unit sum       c_b  how much of the kernel is filled with air, at most 1
//   D_b   ½ ρ C_d A |u − v_b|, the drag on the projected area    k_bj = c_b D_b w_bj / (1 + l_j)
//   l_j   Σ_b c_b D_b w_bj Δt / m: the share of its motion that air particle j would lose in a step. The
//   divisor
//         is an implicit step of the air's, so that dense foliage stops the air and never turns it round.
//
// With an ambient wind U the particle is in air of velocity U + v_j where there are air particles, and of U
// where there are none.
#pragma once

#include <span>

#include "runtime/sim/step/time_step.h"
#include "runtime/wind/air/sph_air.h"
#include "runtime/wind/field/wind_forces.h"

namespace liana {

/// A plant in the wind: which of its particles are still growing (one flag each; empty: none). Those are
/// moved by the ambient wind only ([Haedrich17] §5.3).
struct PlantInWind {
  const Plant* plant;
  std::span<const uint8_t> growing;
};

/// Each step: set_bodies(), SphWind::step(), find(), dashpots() and wrenches() for every plant, the plants'
/// steps, react(). Allocates nothing once it has seen the most pairs. Deterministic, the same with any number
/// of threads.
class PlantCoupling {
 public:
  explicit PlantCoupling(SphAir& air, const DragOptions& drag = {}) : air_(air), drag_(drag) {}

  /// The plants' particles that are so thick that their volume matters to the air: give them to
  /// SphWind::step().
  std::span<AirBody> set_bodies(std::span<const PlantInWind> plants);
  /// Pairs and their strength, for a step of dt (s) from the plants' present state. ambient: null for none.
  void find(std::span<const PlantInWind> plants, const WindField* ambient, double time, double dt);
  /// Appends the dashpots of plant `index` to the air: drag, by air particles and by the ambient wind.
  void dashpots(size_t index, const Plant& plant, std::vector<WorldSpring>& springs) const;
  /// Adds the air's pressure on the plant's thick particles; one Wrench per particle.
  void add_pressure(size_t index, std::span<Wrench> wrenches) const;
  /// After the plants' steps: takes from the air what they got.
  void react(std::span<const PlantInWind> plants);

  size_t pairs() const;
  size_t body_count() const { return bodies_.size(); }
  /// N·s that the air lost to drag in the last step.
  const Vec3& exchanged() const { return exchanged_; }

 private:
  struct Target {  // a plant's particle in reach of the air
    ParticleId particle;
    uint32_t first, last;  // pairs
    Vec3 ambient;          // U, m/s
    double still;          // N·s/m: drag by the ambient wind alone, where no air particles are
    Vec3 velocity;         // v_b at the step's begin, m/s
    double own;            // Σ k_bj, N·s/m
    Vec3 drive;            // Σ k_bj v_j, N
  };
  struct Block {  // particles of one plant: one task
    size_t plant;
    uint32_t first, last;
    std::vector<Target> targets;
    std::vector<int32_t> air;
    std::vector<float> weight;  // 1 - |η|, then k_bj, N·s/m
  };
  void make_blocks(std::span<const PlantInWind> plants);
  void find_pairs(Block& block, const PlantInWind& in, const WindField* ambient, double time);
  void settle(Block& block);

  SphAir& air_;
  DragOptions drag_;
  double dt_ = 0;
  std::vector<Block> blocks_;
  std::vector<size_t> first_block_;  // of each plant, and one more
  std::vector<AirBody> bodies_;
  std::vector<std::pair<size_t, ParticleId>> body_of_;  // plant and particle
  std::vector<float> load_, change_;                    // l_j; change of velocity, 4 each
  Vec3 exchanged_ = Vec3::Zero();
};

}  // namespace liana
