// Particles of a growing plant: their mass, inertia and physical joint stiffness, how one is appended,
// lengthened and turned. Current and rest orientation always receive the same growth rotation ([Haedrich17]
// Eq. 8-10), so growth is plastic and does not load a joint.
#pragma once

#include "runtime/growth/surroundings.h"
#include "runtime/sim/model/plant.h"

namespace liana {

/// What a particle is attached to: a point of its parent (parent's frame), or of the world.
struct Attachment {
  ParticleId parent;
  Vec3 on_parent = Vec3::Zero();  ///< m
};

struct SegmentShape {
  double half_length, half_width, half_thickness;  ///< m
  double stalk = 0;                                ///< m between the joint and the particle's tail (petiole)
};

/// Adds a particle that moves with its parent, at rest where it is put. Its joint has no stiffness yet.
ParticleId append_segment(Plant& plant, BranchId branch, const Attachment& at, const SegmentShape& shape,
                          const Quat& orientation);

Vec3 forward_of(const Plant& plant, ParticleId particle);      ///< unit, world
Vec3 head_of(const Plant& plant, ParticleId particle);         ///< m, world
Vec3 joint_point_of(const Plant& plant, ParticleId particle);  ///< m, world, as a point of the particle

/// Eq. 9-10: turns a particle about its joint, in its current and its rest state.
void turn_segment(Plant& plant, ParticleId particle, const Quat& world_rotation);
/// Turns a particle about its joint until a ball about one of its points (particle's frame) is outside of all
/// solids.
void keep_out(Plant& plant, ParticleId particle, const Vec3& point, double radius,
              const Surroundings& around);
/// Apical growth: the head moves forward by `by` metres, the tail stays.
void lengthen_segment(Plant& plant, ParticleId particle, double by);

/// Mass (a stem is a cylinder, a blade half its bounding box) and inertia for a density, kg/m³.
void set_mass(Particle& particle, DomainKind kind, double density);

}  // namespace liana
