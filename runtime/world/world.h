// A scene that lives: its plants grow, sway in the wind, touch obstacles and move, step by step.
//
// What it is made of has rooms of its own: obstacles, garden (plants), script (what the scene does to them
// when), grabs, severing (cuts and breaks), weather. step() shows the order in which they work.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/picture/simulation_view.h"
#include "runtime/world/grabs.h"
#include "runtime/world/script.h"
#include "runtime/world/severing.h"
#include "runtime/world/weather.h"
#include "runtime/world/world_obstacles.h"
#include "runtime/world/world_report.h"
#include "runtime/world/world_state.h"

namespace liana {

/// Deterministic for a scene: the same states with any number of threads.
class World final : public Simulation {
 public:
  /// Reads the bakes and species that the scene names. The scene needs its solids (Scene::solids). threads =
  /// 0: one per core. Throws Error.
  explicit World(Scene scene, unsigned threads = 0);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void step() override;
  double time_step() const override { return scene_.time_step; }
  Vec3 gravity() const override { return scene_.gravity; }
  void draw(DrawScene& scene) const override;
  size_t plant_count() const override { return garden_.size(); }
  const Plant& plant(size_t i) const override { return garden_[i].plant; }
  void set_grab(size_t plant, const WorldSpring& spring) override { grabs_.hold(garden_, plant, spring); }
  void clear_grab() override { grabs_.let_go(); }
  /// Cuts a particle and all that grows from it off. It becomes the last of the plants, and falls.
  void cut(size_t plant, ParticleId particle) override;
  SimulationStats stats() const override;

  double time() const { return time_of(steps_); }
  const Scene& scene() const { return scene_; }
  const Garden& garden() const { return garden_; }
  const Weather& weather() const { return weather_; }
  WorldReport report() const;
  /// What was taken for what, what calibration could not serve, what the script did not find: a sentence
  /// each.
  const std::vector<std::string>& notes() const { return notes_; }
  /// One number for how plants and air move.
  uint64_t state_hash() const;

  /// All of the state, between two steps. In a world of the same scene that loads it everything goes on to
  /// the bit as it does here, with any number of threads. load() throws Error{Input} for the state of another
  /// scene.
  void save(WorldState& into) const;
  WorldState save() const;
  void load(const WorldState& state);

  template <class Archive>
  void persist(Archive& a) {
    a(steps_, notes_, garden_, weather_, script_, grabs_, severing_);
    // not state: obstacles_: where they are follows from the number of steps
    // not state: scene_, identity_, threads_: of the scene and the machine
    // not state: last_step_: of a clock on the wall
    // not state: workspaces_: working memory of one step
    if constexpr (Archive::kReads)
      if (steps_ > 0) obstacles_.move(time_of(steps_ - 1), time_of(steps_ - 1) + scene_.time_step);
  }

 private:
  double time_of(size_t step) const { return static_cast<double>(step) * scene_.time_step; }
  void begin_acts();
  void move(size_t plant, unsigned threads, StepWorkspace& workspace);
  void follow(const Detachment& cut, size_t next_step);

  Scene scene_;
  std::vector<std::string> notes_;
  unsigned threads_;
  WorldObstacles obstacles_;
  Garden garden_;
  Weather weather_;
  Script script_;
  Grabs grabs_;
  Severing severing_;
  std::vector<StepWorkspace> workspaces_;  // one per thread
  uint64_t identity_;
  size_t steps_ = 0;
  PhaseSeconds last_step_;
};

}  // namespace liana
