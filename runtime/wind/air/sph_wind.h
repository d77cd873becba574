// A wind of smoothed particles: emitters, solids, and a domain beyond which the air is still.
#pragma once

#include <memory>

#include "runtime/wind/air/emitter.h"

namespace liana {

struct SphWindParameters {
  Vec3 low = Vec3::Constant(-2), high = Vec3::Constant(2);  ///< domain, m
  double spacing = 0.15;                                    ///< m between air particles
  double air_density = 1.3;                                 ///< kg/m³
  double sound_over_speed =
      3;  ///< speed of sound over the emitters' top speed: 3 lets densities differ by ~5 %
  double viscosity_ratio = 0.005;  ///< eddy viscosity over (density · speed of sound · support): just calm
  size_t max_particles = 10000;
  std::vector<EmitterParameters> emitters;
  uint64_t seed = 1;
  unsigned threads = 1;   ///< 0: one per core; the result does not depend on it
  bool portable = false;  ///< as AirOptions::portable

  template <class Archive>
  void persist(Archive& a) {
    a(low, high, spacing, air_density, sound_over_speed, viscosity_ratio, max_particles, emitters, seed);
    // not state: threads, portable: the same bits
  }
};

/// Counts since the start.
struct SphWindReport {
  size_t particles = 0;
  size_t substeps = 0;
  size_t emitted = 0, refused = 0;  ///< refused: no room in the domain, or an emitter in a solid
  size_t left = 0;                  ///< out of the domain or crushed, their places free for new ones
  size_t limited = 0;               ///< velocities that had to be cut to twice the speed of sound

  template <class Archive>
  void persist(Archive& a) {
    a(particles, substeps, emitted, refused, left, limited);
  }
};

class SphWind : public WindField {
 public:
  /// Solids must outlive it; those that are ever placed anew are `moving`. Throws Error{Input} for values out
  /// of range.
  explicit SphWind(const SphWindParameters& parameters, std::span<const SdfObstacle* const> solids = {},
                   std::optional<double> ground_height = {}, std::span<const SdfObstacle* const> moving = {});

  /// Lets dt (s) pass in as many equal substeps as the air needs. Bodies gather impulses. Moving solids are
  /// to be where they are at its end, with the velocities that bring them there.
  void step(double dt, std::span<AirBody> bodies = {});
  int substeps(double dt) const;

  /// Eq. 12 at a point, at the time of the last step (the argument is not used): zero where no particles are.
  Vec3 velocity(const Vec3& position, double time) const override;

  SphAir& air() { return air_; }
  const SphAir& air() const { return air_; }
  double time() const { return time_; }
  SphWindReport report() const;

  template <class Archive>
  void persist(Archive& a) {
    for (Emitter& emitter : emitters_) a(emitter);
    a(air_, time_, report_);
    // not state: walls_: set once
    // not state: moving_: placed anew in every substep
  }

 private:
  std::vector<Emitter> emitters_;
  AirWalls walls_;
  MovingWalls moving_;
  SphAir air_;
  double time_ = 0;
  SphWindReport report_;
};

}  // namespace liana
