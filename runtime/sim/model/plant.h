// One simulated plant: a tree of oriented particles, and the branches (chains of particles) it is made of.
//
// A particle is a rigid segment with its long axis along local y. Particles and branches are stored parents
// first, and grow by appending, so a loop upwards through the arrays meets parents before children.
#pragma once

#include <string>
#include <vector>

#include "materials/bake/bake.h"
#include "mesher/base/ids.h"
#include "runtime/sim/model/large_pages.h"
#include "runtime/sim/model/remap.h"

namespace liana {

/// Where a particle is and how it moves: the state that a hash, a snapshot or a recording covers. World
/// frame. Aligned so that each is read in three lines of the cache.
struct alignas(32) Motion {
  Vec3 position = Vec3::Zero();  ///< of the centre of mass, m
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();              ///< m/s
  Vec3 angular_velocity = Vec3::Zero();      ///< rad/s
  Vec3 acceleration = Vec3::Zero();          ///< m/s², generalized-α's a
  Vec3 angular_acceleration = Vec3::Zero();  ///< rad/s²

  template <class Archive>
  void persist(Archive& a) {
    a(position, orientation, velocity, angular_velocity, acceleration, angular_acceleration);
  }
};

/// The joint that holds a particle to its parent (to the world for the first particle of a plant).
/// Energy: U = ½ e_sᵀ C_s e_s − rest_force·e_s + ½ e_bᵀ C_b e_b − rest_moment·e_b. All of it is written in
/// the joint's frame R_parent R_rest: the particle's own frame at rest, carried by the parent (y along the
/// particle; x, z bend).
struct Joint {
  Vec3 on_parent = Vec3::Zero();        ///< a_p, in the parent's frame (world frame for a root), m
  Vec3 on_self = Vec3::Zero();          ///< a_c, in the particle's frame: usually (0, -half_length, 0), m
  Quat rest = Quat::Identity();         ///< R_rest: orientation relative to the parent's at rest
  Vec3 shear_stiffness = Vec3::Zero();  ///< C_s = (GA, EA, GA)/h, N/m, after calibration
  Vec3 bend_stiffness = Vec3::Zero();   ///< C_b = (EI_x, GJ, EI_z)/h, N·m/rad, after calibration
  Vec3 rest_force = Vec3::Zero();       ///< what the joint exerts on the particle at rest, joint's frame, N
  Vec3 rest_moment = Vec3::Zero();      ///< the same about the joint, N·m

  template <class Archive>
  void persist(Archive& a) {
    a(on_parent, on_self, rest, shear_stiffness, bend_stiffness, rest_force, rest_moment);
  }
};

/// Four lines of the cache.
struct alignas(64) Particle {
  ParticleId parent;
  BranchId branch;
  double half_length = 0;        ///< m, along local y; > 0
  double half_width = 0;         ///< m, along local x
  double half_thickness = 0;     ///< m, along local z (the soft bending direction of a flat domain)
  double mass = 0;               ///< kg
  Vec3 inertia = Vec3::Zero();   ///< principal moments about the centre, body frame, kg·m²
  double mass_damping = 0;       ///< d_M, 1/s
  double stiffness_damping = 0;  ///< d_K, s, of its joint
  Joint joint;

  template <class Archive>
  void persist(Archive& a) {
    a(parent, branch, half_length, half_width, half_thickness, mass, inertia, mass_damping, stiffness_damping,
      joint);
  }
};

/// Arrays of these make up most of a large plant: they lie in large pages.
using MotionArray = std::vector<Motion, LargePages<Motion>>;
using ParticleArray = std::vector<Particle, LargePages<Particle>>;

/// A spring from a point of a particle to a point of the world: anchor, grab, contact. Only ever adds to the
/// particle's own 6×6 block, so the tree stays solvable in linear time.
struct WorldSpring {
  ParticleId particle;
  Vec3 on_particle = Vec3::Zero();      ///< in the particle's frame, m
  Vec3 target = Vec3::Zero();           ///< in the world, m
  Mat3 stiffness = Mat3::Zero();        ///< N/m, symmetric positive semi-definite, world frame
  Mat3 damping = Mat3::Zero();          ///< N·s/m, acts on the point's velocity relative to the target's
  Vec3 target_velocity = Vec3::Zero();  ///< m/s

  template <class Archive>
  void persist(Archive& a) {
    a(particle, on_particle, target, stiffness, damping, target_velocity);
  }
};

/// A chain of particles with one material: a baked domain, a growing shoot, or a leaf.
struct Branch {
  static constexpr uint32_t kNoShade = ~uint32_t{0};
  BranchId parent;  ///< invalid for a trunk
  DomainKind kind = DomainKind::Branch;
  int level = 0;
  std::string group;
  DomainId domain;                    ///< in the bake it came from; invalid for grown ones
  std::vector<ParticleId> particles;  ///< root to tip
  double length = 0;                  ///< ℓ, m: what the law is evaluated with
  DomainMaterial material;            ///< target: what calibration makes it swing like
  double stiffness_scale = 1;  ///< k*/ω₁² of the last calibration, of the physical joint stiffnesses
  uint32_t shade = kNoShade;   ///< what its look varies with, once ids have changed
  double strength = 0;         ///< Pa that its joints bear (see breaking.h); 0: it never breaks
  LineageId lineage;           ///< invalid in plants put together by hand
  uint32_t born = 0;           ///< particles that it ever had: the ordinal of the next one's lineage

  template <class Archive>
  void persist(Archive& a) {
    a(parent, kind, level, group, domain, particles, length, material, stiffness_scale, shade, strength,
      lineage, born);
  }
};

/// Direct: PlantStepper's own; ShapeMatching: [Haedrich17]'s scheme, which no material drives
/// (shape_matching.h).
enum class Solver { Direct, ShapeMatching };

/// How a plant is integrated. Its joints are calibrated for exactly these numbers: calibrate_plant() chooses
/// rho_infinity and substeps so that every branch can swing as baked, and reports when they differ from the
/// defaults.
struct TimeScheme {
  double dt = 0.025;          ///< s, one step as the caller sees it
  double rho_infinity = 0.6;  ///< spectral radius of generalized-α at infinite frequency
  int substeps = 1;           ///< equal parts that dt is always cut into
  Solver solver = Solver::Direct;

  double substep() const { return dt / substeps; }

  template <class Archive>
  void persist(Archive& a) {
    a(dt, rho_infinity, substeps, solver);
  }
};

struct Plant {
  std::string name;
  TimeScheme scheme;
  MotionArray motion;                ///< one per particle
  ParticleArray particles;           ///< parents first
  std::vector<Branch> branches;      ///< parents first
  std::vector<WorldSpring> anchors;  ///< persist; contacts and grabs are given to each step anew
  std::vector<LineageId> lineage;    ///< one per particle; empty in plants put together by hand
  RemapLog removals;                 ///< what caches of slots have not taken yet

  LineageId lineage_of(ParticleId particle) const {
    return particle.index() < lineage.size() ? lineage[particle.index()] : LineageId();
  }

  template <class Archive>
  void persist(Archive& a) {
    a(name, scheme, motion, particles, branches, anchors, lineage, removals);
  }
};

}  // namespace liana
