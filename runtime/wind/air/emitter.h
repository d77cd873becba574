// Where air particles come from: a fan of the shape of a disc or a box.
#pragma once

#include "runtime/wind/air/sph_air.h"
#include "runtime/wind/field/ambient_wind.h"

namespace liana {

struct EmitterParameters {
  enum class Shape { Disc, Box };
  Shape shape = Shape::Disc;
  Vec3 center = Vec3::Zero();      ///< m
  Vec3 direction = {1, 0, 0};      ///< that it blows to; any length but zero
  double speed = 5;                ///< m/s
  double radius = 0.5;             ///< m, of a disc
  double width = 1, height = 1;    ///< m, of a box: level, and up as far as the direction lets it
  double turbulence = 0.1;         ///< standard deviation of the velocity along it, over the speed
  double turbulence_length = 0.5;  ///< m, length scale of its eddies
  double gust = 0;                 ///< standard deviation of the speed by gusts, over the speed
  double gust_period = 4;          ///< s, from one strong gust to the next, about

  template <class Archive>
  void persist(Archive& a) {
    a(shape, center, direction, speed, radius, width, height, turbulence, turbulence_length, gust,
      gust_period);
  }
};

/// Sends layers of particles one spacing apart, so that the air leaves with its rest density, each layer
/// shifted by half a spacing. Deterministic for a seed.
class Emitter {
 public:
  /// Throws Error{Input} for values out of range.
  Emitter(const EmitterParameters& parameters, uint64_t seed);

  /// Air within one spacing before the emitter goes as the emitter says, whatever presses against it: without
  /// this a fan's own pressure would drive its air backwards. Then emits what leaves within dt. Returns how
  /// many particles found no room (domain full, or a solid in the way).
  size_t emit(SphAir& air, double time, double dt);

  /// m/s, of its mean wind, gusts included.
  double speed_at(double time) const { return parameters_.speed * gust_at(time); }
  /// m/s that the wind hardly ever exceeds: mean plus two standard deviations of gusts and of turbulence.
  double top_speed() const {
    return parameters_.speed * (1 + 2 * parameters_.gust + 2 * parameters_.turbulence);
  }
  template <class Archive>
  void persist(Archive& a) {
    a(due_, layers_);
    // not state: parameters_, eddies_, axes_, gust_phase_: set once
  }

  const EmitterParameters& parameters() const { return parameters_; }
  Vec3 direction() const { return axes_.col(0); }

 private:
  double gust_at(double time) const;
  bool contains(double across, double up) const;

  EmitterParameters parameters_;
  AmbientWind eddies_;
  Mat3 axes_;  // columns: direction, across, up
  double gust_phase_[3];
  double due_ = 0;  // m that the last layer has moved
  size_t layers_ = 0;
};

}  // namespace liana
