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

#include "runtime/wind/air/moving_walls.h"
#include "runtime/wind/air/sph_pass.h"

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

/// A solid ellipsoid in the air whose volume displaces it: a thick piece of a plant.
struct AirBody {
  Vec3 position;  ///< m
  Quat orientation;
  Vec3 half_axes;               ///< m, along its own axes
  Vec3 impulse = Vec3::Zero();  ///< N·s, what the air's pressure gave it so far: added to by advance()
};

class SphAir {
 public:
  /// Throws Error{Input} for values out of range. Walls must outlive the air; null: none. Moving ones are to
  /// be placed before each step where they are at its begin.
  explicit SphAir(const AirOptions& options, const AirWalls* walls = nullptr,
                  const MovingWalls* moving = nullptr);
  ~SphAir();

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
  void push(size_t i, const Vec3& change);                ///< adds to a velocity, m/s
  double density(size_t i) const { return density_[i]; }  ///< kg/m³, of the last step
  double particle_mass() const { return mass_; }          ///< kg
  double support() const { return support_; }             ///< h, m
  Vec3 momentum() const;                                  ///< kg·m/s, summed in double
  size_t limited() const { return limited_; }  ///< velocities cut to 2 c so far; 0 in normal motion
  /// Particles that left the domain so far, or that moving walls ran over or crushed.
  size_t left() const { return left_; }
  const AirOptions& options() const { return options_; }

  /// The particles in the cells that a box touches: calls visit(first, last) for ranges of indices. The box
  /// (m) is relative to the domain's low corner.
  template <class Visit>
  void for_ranges(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const Visit& visit) const;
  const SphPasses& passes() const { return passes_; }
  const AirState* states() const { return state_.data(); }
  const float* xs() const { return x_.data(); }  ///< of all particles, m from the low corner; padded by 8
  const float* ys() const { return y_.data(); }
  const float* zs() const { return z_.data(); }

 private:
  static constexpr uint8_t kStanding = 1, kMoving = 2;
  static constexpr double kWallGap = 0.25;  // of the spacing: nearer to a solid no particle comes
  struct Chunk {                            // particles of some neighbouring cells: one task
    uint32_t first_cell, last_cell, first, last;
    std::vector<int32_t> list;
    std::vector<float> x, y, z;  // candidates of the cell at hand
    std::vector<int32_t> index;
    size_t limited;
  };
  struct BodyPair {
    uint32_t body, particle;
    float volume_gradient[3];  // V_b ∇W, 1/m
  };
  int cell_along(float x, int axis) const;
  void find_body_pairs(std::span<const AirBody> bodies);
  void push_bodies(std::span<AirBody> bodies, double dt);
  void densities(Chunk& chunk);
  template <bool kMovingWalls>
  void finish_density(uint32_t begin, uint32_t end, uint8_t near_wall);
  template <bool kMovingWalls>
  void move(Chunk& chunk, float dt);
  void mark_cells_near_moving();
  float feel_moving(uint32_t i, uint8_t near_wall, float share);
  void push_off_moving(AirState& a, uint32_t i, float dt) const;
  void keep_out_of_moving(AirState& a, uint32_t i, float dt) const;

  AirOptions options_;
  const AirWalls* walls_;      // null: none
  const MovingWalls* moving_;  // null: none
  const SphPasses& passes_;
  double support_, mass_, longest_step_;
  AirConstants constants_;
  float cell_size_;
  int cells_[3];  // with an empty border
  size_t count_ = 0, limited_ = 0, left_ = 0;
  std::vector<AirState> state_, sorted_;
  std::vector<float> x_, y_, z_, density_, acceleration_, extra_density_, extra_acceleration_;
  std::vector<AirWalls::Sample> wall_;
  std::vector<MovingWalls::Sample> moving_wall_;
  std::vector<uint32_t> key_, cell_begin_, list_begin_, list_end_;
  std::vector<uint8_t> cell_near_wall_;  // of kStanding and kMoving
  std::vector<Chunk> chunks_;
  std::vector<BodyPair> body_pairs_;
};

template <class Visit>
void SphAir::for_ranges(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const Visit& visit) const {
  int first[3], last[3];
  for (int k = 0; k < 3; ++k) first[k] = cell_along(low[k], k), last[k] = cell_along(high[k], k);
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y) {
      const size_t row = size_t(cells_[0]) * (y + size_t(cells_[1]) * z);
      const uint32_t begin = cell_begin_[row + first[0]], end = cell_begin_[row + last[0] + 1];
      if (begin < end) visit(begin, end);
    }
}

}  // namespace liana
