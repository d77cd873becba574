// What a scene is: obstacles, baked plants, climbers, sun, wind, camera, and what is done to them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"
#include "runtime/growth/climber_parameters.h"
#include "runtime/sim/contact/contact_response.h"
#include "runtime/sim/model/plant.h"
#include "runtime/wind/air/sph_wind.h"
#include "runtime/world/scene/obstacle_motion.h"

namespace liana {

struct SceneObstacle {
  std::string name;
  Mesh mesh;  ///< world frame, m: scaled, rotated and placed, before it moves
  Vec3 color = Vec3::Zero();
  bool bricks = false;
  ContactMaterial contact_material = {};
  std::optional<double> thickness;  ///< m, of the parts that have no inside
  std::optional<ObstacleMotion> motion;

  template <class Archive>
  void persist(Archive& a) {
    a(motion);
    // not state: mesh, contact_material, thickness: in the scene's solids
    // not state: name, color, bricks: only seen
  }
};

/// A plant from a bake, standing at a place.
struct ScenePlant {
  std::filesystem::path bake;
  Vec3 position = Vec3::Zero();
  double yaw = 0;       ///< rad, about +Y
  double breaking = 0;  ///< t_s of [Haedrich17] in [0, 1]: 1 breaks as its wood does, 0 never

  template <class Archive>
  void persist(Archive& a) {
    a(position, yaw, breaking);
    // not state: bake: a place; what is in the file counts
  }
};

/// A climber that grows from a seed, with the law of a bake or of a species preset.
struct SceneClimber {
  std::filesystem::path bake;  ///< empty when a species is named
  std::string species;
  Vec3 position = Vec3::Zero();
  double growth_speed = 1;  ///< multiple of the climber's normal pace
  size_t max_particles = 4000;
  double breaking = 0;         ///< as of a plant
  double stiffness = 1;        ///< multiple of what its law gives; frequencies go with the root
  double weight_grown_in = 1;  ///< share of its weight that does not bend it, for it grew under it
  unsigned first_shoots = ClimberParameters().first_shoots;
  double longest_free = ClimberParameters().longest_free;  ///< m that a shoot grows without hold

  template <class Archive>
  void persist(Archive& a) {
    a(species, position, growth_speed, max_particles, breaking, stiffness, weight_grown_in, first_shoots,
      longest_free);
    // not state: bake: a place; what is in the file counts
  }
};

/// A piece of the obstacles, ready to make a distance field of.
struct SceneSolid {
  Mesh mesh;  ///< closed, outward; of a sheet, its middle, which may be open
  ContactMaterial contact_material = {};
  double voxel = 0;                  ///< m, of its distance field; 0: as its shape suggests
  double sheet = 0;                  ///< m, its thickness; 0: a solid
  std::optional<size_t> moves_with;  ///< which obstacle of the scene it is a piece of, when that moves

  template <class Archive>
  void persist(Archive& a) {
    a(mesh.positions, mesh.triangles, contact_material.friction, contact_material.restitution, voxel, sheet,
      moves_with);
  }
};

/// All of the obstacles: first what moves, then the solids that stand still, then the sheets that do.
struct SceneSolids {
  std::vector<SceneSolid> pieces;
  std::vector<std::string> notes;  ///< what was taken for what, a sentence each

  template <class Archive>
  void persist(Archive& a) {
    a(pieces);
    // not state: notes: only read
  }
};

/// A branch or leaf is struck: its particles get a velocity that grows from nothing at its root with the
/// square of the way to its tip (much like its lowest mode, so that it swings at its own frequency).
struct SceneImpulse {
  size_t plant;        ///< which [[plant]], from 0
  std::string domain;  ///< name, or "#id", of a domain of its bake
  double time;         ///< s
  Vec3 velocity;       ///< of the tip, m/s

  template <class Archive>
  void persist(Archive& a) {
    a(plant, domain, time, velocity);
  }
};

/// A place on a plant or climber.
struct ScenePoint {
  bool climber;            ///< of [[climber]] rather than of [[plant]]
  size_t index;            ///< which of these, from 0
  std::string domain;      ///< of a plant: name, or "#id", of a domain; empty: `at`
  double along = 0;        ///< in [0, 1], of that domain's length
  Vec3 at = Vec3::Zero();  ///< m, world: the particle of a stem nearest to it when it is needed

  template <class Archive>
  void persist(Archive& a) {
    a(climber, index, domain, along, at);
  }
};

/// What grows from a place is cut off.
struct SceneCut {
  ScenePoint where;
  double time;  ///< s

  template <class Archive>
  void persist(Archive& a) {
    a(where, time);
  }
};

/// A place is held and led along a path by a spring.
struct SceneGrab {
  ScenePoint where;
  double time, seconds;    ///< s, from when, for how long
  std::vector<Vec3> path;  ///< m, from where it was grabbed; passed at an even pace per leg
  double strength;         ///< 1: a spring that the whole plant's weight would stretch by 2 cm

  template <class Archive>
  void persist(Archive& a) {
    a(where, time, seconds, path, strength);
  }
};

/// What becomes of broken and cut parts.
struct SceneDetached {
  double roots_hold = 2;    ///< s, for which a climber's cut off part still clings
  double remove_after = 0;  ///< s at rest, after which a part is taken away; 0: never

  template <class Archive>
  void persist(Archive& a) {
    a(roots_hold, remove_after);
  }
};

/// The wind everywhere (none when the velocity is zero), and air particles that emitters blow.
struct SceneWind {
  enum class Kind { Gust, Ambient };
  Kind kind = Kind::Gust;
  Vec3 velocity = Vec3::Zero();  ///< mean, m/s
  double gust = 0.4;             ///< Gust: standard deviation of the speed over its mean
  double gust_period = 6;        ///< Gust: s, from one strong gust to the next, about
  AmbientParameters ambient;     ///< Ambient: mean and seed are set from this table and the scene
  std::optional<SphWindParameters> air;
  bool show_air = false;  ///< draw the air particles

  template <class Archive>
  void persist(Archive& a) {
    a(kind, velocity, gust, gust_period, ambient, air);
    // not state: show_air: only seen
  }
};

struct SceneCamera {
  Vec3 eye, target;
  double vertical_angle;  ///< rad, field of view
};

/// What it does to a world is listed in persist(), so that the state of one scene is not taken for another's.
struct Scene {
  std::filesystem::path file;
  std::string title;
  uint64_t seed = 1;
  double time_step = 0.025;  ///< s
  double seconds = 60;       ///< how long `simulate` runs unless told otherwise
  Vec3 gravity = {0, -9.81, 0};
  Solver solver = Solver::Direct;
  Vec3 to_sun = {0.4, 0.8, 0.45};
  SceneWind wind;
  std::vector<SceneObstacle> obstacles;
  /// What the obstacles are in the world. Absent in a scene as it is read: with_united_solids() of
  /// runtime/app/scene or with_separate_solids() of scene_solids.h adds it.
  std::optional<SceneSolids> solids;
  bool plant_contacts = false;  ///< plants touch each other and themselves
  ContactMaterial plant_contact_material;
  ContactWeights contact_weights;  ///< not in the file: for tests/tools/fit_contacts.cpp
  std::vector<ScenePlant> plants;
  std::vector<SceneClimber> climbers;
  std::vector<SceneImpulse> impulses;
  std::vector<SceneCut> cuts;
  std::vector<SceneGrab> grabs;
  SceneDetached detached;
  std::optional<SceneCamera> camera;  ///< absent: frame everything

  template <class Archive>
  void persist(Archive& a) {
    a(seed, time_step, gravity, solver, to_sun, wind, obstacles, solids, plant_contacts,
      plant_contact_material.friction, plant_contact_material.restitution, contact_weights, plants, climbers,
      impulses, cuts, grabs, detached);
    // not state: file, title, seconds, camera: how it is found, run and seen
  }
};

}  // namespace liana
