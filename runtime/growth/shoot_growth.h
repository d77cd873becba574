// A growing shoot: where its tip turns, and how it lengthens until the next particle is due.
#pragma once

#include <optional>
#include <span>

#include "mesher/base/random.h"
#include "runtime/growth/climber_parameters.h"
#include "runtime/growth/surroundings.h"
#include "runtime/sim/model/plant.h"

namespace liana {

/// What a shoot is besides its branch of particles.
struct Shoot {
  BranchId branch;
  double tip_radius;       ///< m
  double course;           ///< rad on the surface, from upwards towards normal × up
  double longest;          ///< m
  double light = 1;        ///< 1 - O at its tip, smoothed over the last particles
  double free_length = 0;  ///< m since its last hold
  double since_leaf = 0;   ///< m
  unsigned leaves = 0;
  bool growing = true;
  bool lost_tip = false;  ///< since the last step of growth

  template <class Archive>
  void persist(Archive& a) {
    a(branch, tip_radius, course, longest, light, free_length, since_leaf, leaves, growing, lost_tip);
  }
};

/// Upwards along a surface of this outward normal, rotated by `course` about it: unit; zero where the surface
/// is nearly level, for there is no up on it.
Vec3 course_on_surface(const Vec3& normal, double course);

/// R_g of [Haedrich17] Eq. 8 for a tip: surface adaption, phototropism, the shoot's course and random wander.
Quat tip_turn(const Shoot& shoot, const Vec3& forward, double radius, const std::optional<Support>& support,
              const Surroundings& around, const TropismParameters& parameters, Random& random, double dt);

/// What a tip would grow into.
struct Blocked {
  Vec3 normal;  ///< unit, out of it
  double free;  ///< m that it may still grow
};

/// What a head of this radius (m) runs into, rather than along, on its next `length` m.
std::optional<Blocked> in_the_way(const Surroundings& around, const Vec3& head, const Vec3& forward,
                                  double radius, double length);

/// Where it goes on, unit: along what stops it; where it meets that squarely, in the direction `away`.
Vec3 along(const Blocked& wall, const Vec3& forward, const Vec3& away);

/// Turns and lengthens the shoot's last particle by dt of growth and keeps its head out of solids and ground.
/// True when the particle is full-grown.
bool grow_tip(Plant& plant, const Shoot& shoot, const ClimberParameters& parameters,
              const Surroundings& around, Random& random, double dt);

}  // namespace liana
