// Where a climber holds on: [Haedrich17] Eq. 5 as springs of finite strength.
//
// The paper moves a particle by φ(x_anchor - x) each step, φ growing with the particle; a spring that grows
// with the particle's width does the same through the solver, and pulls with a force that the plant can tear
// off from.
#pragma once

#include <vector>

#include "runtime/growth/climber_parameters.h"
#include "runtime/growth/surroundings.h"
#include "runtime/sim/model/plant.h"
#include "runtime/sim/model/topology.h"

namespace liana {

class Anchors {
 public:
  explicit Anchors(const AnchorParameters& parameters, double young_radius)
      : parameters_(parameters), young_radius_(young_radius) {}

  /// Anchors a particle to the closest surface, or to the ground, if that is near enough. True when it holds
  /// on now.
  bool attach(Plant& plant, ParticleId particle, const Surroundings& around);

  /// Hardens anchors, lets them follow the stem's thickness and their moving supports, and releases those
  /// pulled beyond the distance. Solids must stand where they will be at the end of the coming step.
  void update(Plant& plant, double dt_growth);

  /// The plant lost particles, and its anchors with them.
  void follow(const TopologyChange& change);

  bool holds(ParticleId particle) const { return particle.index() < held_.size() && held_[particle.index()]; }
  size_t count() const { return records_.size(); }
  size_t released() const { return released_; }  ///< so far

  template <class Archive>
  void persist(Archive& a) {
    a(records_, held_, released_);
    // not state: parameters_, young_radius_: set once
  }

 private:
  struct Record {
    ParticleId particle;
    double gap;                // m between stem and surface when it was made
    double age = 0;            // growth s
    const SdfObstacle* solid;  // what it holds on to, null: the ground
    Vec3 on_solid, normal;     // where, m, and out of it, unit; in the solid's own frame

    template <class Archive>
    void persist(Archive& a) {
      a(particle, gap, age, solid, on_solid, normal);
    }
  };
  AnchorParameters parameters_;
  double young_radius_;
  std::vector<Record> records_;  // one for each of plant.anchors
  std::vector<uint8_t> held_;    // per particle
  size_t released_ = 0;
};

}  // namespace liana
