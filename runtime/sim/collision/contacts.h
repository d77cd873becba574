// Contacts of a plant with solid obstacles and the ground, as springs to the world for the next time step.
//
// Every particle is looked at in its centre and its head (its tail is its parent's head, unless it is loose),
// with the cross-section's own reach towards the surface as radius. A contact is made when the point is
// inside, or will be by the end of the step.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/sim/collision/sdf_obstacle.h"
#include "runtime/sim/plant.h"
#include "runtime/sim/topology.h"

namespace liana {

struct CollisionScene {
  std::span<const SdfObstacle* const> solids;
  std::optional<double> ground_height;  ///< m; the ground is a horizontal plane
};

struct ContactOptions {
  double friction = 0.6;          ///< Coulomb's coefficient
  double creep_speed = 2e-3;      ///< m/s, below which friction is viscous
  double stiffness_ratio = 1000;  ///< normal stiffness over m/Δt²
  double least_stiffness = 5e3;   ///< N/m
  double push_out_speed = 1.0;    ///< m/s, at which what is deep inside is moved out
};

struct ContactReport {
  size_t contacts = 0;         ///< springs made
  size_t exempt = 0;           ///< roots, and particles at a plant's base that were inside when first seen
  double max_penetration = 0;  ///< m, of the state looked at, without exempt particles
};

/// One per plant: it remembers which particles were made inside something, and the contacts of the present
/// step.
class Contacts {
 public:
  explicit Contacts(const ContactOptions& options = {}) : options_(options) {}

  /// Appends the contact springs for the next step of the plant's time scheme, from its present state: of
  /// what is inside, or will be if it goes on as it does.
  ContactReport gather(const Plant& plant, const CollisionScene& scene, std::vector<WorldSpring>& springs);

  /// After that step: appends springs for what is inside by more than `tolerance` (m) all the same and had
  /// none, for taking the step again from `before`. Returns how many.
  size_t gather_missed(const Plant& after, std::span<const Motion> before, const CollisionScene& scene,
                       double tolerance, std::vector<WorldSpring>& springs);

  /// The plant lost particles: what is known of the others goes with them.
  void follow(const TopologyChange& change);

  /// Only looks: the report of the present state, with no springs.
  ContactReport measure(const Plant& plant, const CollisionScene& scene);

 private:
  using Key = uint64_t;  // particle, probe, solid
  void notice_new_particles(const Plant& plant, const CollisionScene& scene);
  WorldSpring spring(const Plant& plant, const Motion& motion, size_t particle, const Vec3& point, double gap,
                     const Vec3& normal) const;

  ContactOptions options_;
  std::vector<uint8_t> exempt_;  // per particle
  std::vector<Key> made_;        // sorted: the contacts that have a spring in this step
};

}  // namespace liana
