// A scene that lives: its plants grow, feel wind, touch obstacles and move, step by step.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "runtime/growth/climber.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/plant_drawing.h"
#include "runtime/picture/simulation_view.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/sim/contact/plant_contacts.h"
#include "runtime/sim/model/breaking.h"
#include "runtime/sim/model/topology.h"
#include "runtime/world/scene_file.h"
#include "runtime/world/world_wind.h"

namespace liana {

/// Seconds of work since the start, summed over threads.
struct PhaseSeconds {
  double growth = 0, collision = 0, physics = 0;
  double touching = 0;  ///< plants with plants; wall clock
  double wind = 0;      ///< air particles; wall clock
};

/// What happened since the start.
struct WorldReport {
  size_t steps = 0, particles = 0, anchors = 0;
  size_t contacts = 0;               ///< with obstacles and the ground, in the last step
  size_t plant_contacts = 0;         ///< pairs of particles that touched in the last step
  size_t grown_together = 0;         ///< pairs that overlap since they were made, and do not push each other
  double max_overlap = 0;            ///< m, of two plant parts that touch
  double max_penetration = 0;        ///< m, deepest that any particle ever was in an obstacle or the ground
  size_t redone_steps = 0;           ///< steps that the solver took again with finer substeps
  size_t contact_passes = 0;         ///< taken again because a contact showed only at the step's end
  std::optional<SphWindReport> air;  ///< absent without emitters
  size_t reseated_joints = 0;        ///< closed by hand where the finest substeps did not hold them
  size_t lost_steps = 0;             ///< steps that did not stay finite and were stopped
  size_t broken = 0, shed = 0, cut = 0;  ///< branches and leaves that broke off, parts cut off
  size_t fallen = 0, asleep = 0;         ///< such parts that are there now, and how many of them lie still
  size_t removed = 0;                    ///< taken away: after their time at rest, or blown out of the scene
  PhaseSeconds seconds;
};

/// Deterministic for a scene: the same states with any number of threads.
class World final : public Simulation {
 public:
  /// Reads the bakes and species that the scene names. threads = 0: one per core. Throws Error.
  explicit World(const Scene& scene, unsigned threads = 0);

  void step() override;
  double time_step() const override { return scene_.time_step; }
  void draw(DrawScene& scene) const override;
  size_t plant_count() const override { return inhabitants_.size(); }
  const Plant& plant(size_t i) const override { return inhabitants_[i]->plant; }
  void set_grab(size_t plant, const WorldSpring& spring) override;
  void clear_grab() override { grabbed_.reset(); }
  /// Cuts a particle and all that grows from it off. It becomes the last of the plants, and falls.
  void cut(size_t plant, ParticleId particle) override;
  SimulationStats stats() const override;

  /// As draw(), with every branch and leaf named when `names`.
  DrawScene drawing(bool names = false) const;
  Camera camera() const;  ///< the scene's, or one that sees everything
  WorldReport report() const;
  uint64_t state_hash() const;
  /// What calibration changed or could not serve, a sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Inhabitant {
    explicit Inhabitant(const ContactOptions& contacts) : stepper(contacts) {}

    Plant plant;
    ContactStepper stepper;
    std::optional<Climber> climber;
    double growth_speed = 1;
    PlantLook look;
    std::vector<WorldSpring> springs;      // wind, grab and contacts of the step
    std::vector<Wrench> wrenches;          // the air's pressure
    std::vector<uint8_t> growing;          // per particle, of a climber
    std::vector<std::string> domains;      // of its bake: names by DomainId
    std::vector<Fracture> fractures;       // of the last step
    bool fallen = false;                   // broken or cut off
    double fallen_for = 0, still_for = 0;  // s
    std::vector<Vec3> lay;                 // m, where a part's particles were when it last moved
    WorldReport report;

    bool asleep() const;
  };
  struct Pluck {
    size_t plant;
    BranchId branch;
    size_t step;  // before which it happens
    Vec3 velocity;
  };
  struct Grab {
    size_t plant;
    WorldSpring spring;
    size_t asked_plant;  // as the caller knows it: the particle may have moved to a fallen part since
    ParticleId asked_particle;
  };
  struct ScriptedGrab {
    size_t plant;
    WorldSpring spring;
    Vec3 from;  // m, where it was grabbed
    const SceneGrab* script;
  };

  double time() const { return static_cast<double>(steps_) * scene_.time_step; }
  std::vector<const SdfObstacle*> those_that_move(bool move) const;
  void move_obstacles();
  void add_baked(const ScenePlant& entry);
  void add_climber(const SceneClimber& entry, uint64_t seed);
  void grow(Inhabitant& self);
  void add_pluck(const ScenePluck& entry, const Bake& bake);
  void pluck(size_t index);
  void step_inhabitant(size_t index, unsigned threads, StepWorkspace& workspace);
  void add_to(DrawScene& scene, bool names) const;
  static void add(const WorldReport& own, WorldReport& total);
  // world_parts.cpp
  void check_point(const ScenePoint& point, const char* table) const;
  std::optional<std::pair<size_t, ParticleId>> find(const ScenePoint& point) const;
  void start_events();
  void lead_grabs();
  void break_what_is_overloaded();
  void take_off(size_t index, ParticleId particle);
  void let_rest(Inhabitant& part) const;
  void remove_parts();

  Scene scene_;
  std::vector<std::string> notes_;
  unsigned threads_;
  std::vector<size_t> obstacle_of_;  // of the solids that move, which come first: in the scene
  std::vector<std::unique_ptr<SdfObstacle>> obstacles_;
  std::vector<const SdfObstacle*> solids_;
  PlantContacts touching_;
  PlantContactReport touched_;
  double max_overlap_ = 0, touching_seconds_ = 0;  // m, s
  std::vector<const Plant*> all_plants_;
  std::vector<std::vector<WorldSpring>*> all_springs_;
  WorldWind wind_;
  std::vector<std::unique_ptr<Inhabitant>> inhabitants_;
  std::vector<StepWorkspace> workspaces_;  // one per thread
  std::vector<PlantInWind> in_wind_;
  std::optional<Grab> grabbed_;
  std::vector<ScriptedGrab> scripted_;
  size_t broken_ = 0, shed_ = 0, cut_ = 0, removed_ = 0;
  WorldReport departed_;  // what happened to parts that were removed
  std::vector<Pluck> plucks_;
  size_t steps_ = 0;
  PhaseSeconds last_step_;
};

}  // namespace liana
