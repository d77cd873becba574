// What is done to a world while it lives, on file with the state after every step, and done again.
#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "runtime/world/world.h"

namespace liana {

/// A world whose every act is written down before it is done. One JSON object a line, flushed, so that what
/// was done survives a crash: {"grab": ...}, {"release": true}, {"cut": ...}, {"step": 1, "state": hash}.
class SessionRecorder final : public Simulation {
 public:
  /// Begins the file, replacing an old one. Everything that is done to the world from here on must be done
  /// through this. Throws Error{Output}, now or whenever a line cannot be written.
  SessionRecorder(World& world, const std::filesystem::path& file);

  void step() override;
  void set_grab(size_t plant, const WorldSpring& spring) override;
  void clear_grab() override;
  void cut(size_t plant, ParticleId particle) override;

  double time_step() const override { return world_.time_step(); }
  Vec3 gravity() const override { return world_.gravity(); }
  void draw(DrawScene& scene) const override { world_.draw(scene); }
  size_t plant_count() const override { return world_.plant_count(); }
  const Plant& plant(size_t index) const override { return world_.plant(index); }
  SimulationStats stats() const override { return world_.stats(); }

 private:
  void write(const std::string& line);

  World& world_;
  std::filesystem::path file_;
  std::ofstream out_;
};

/// A recorded session, to be done again step by step.
class SessionReplay {
 public:
  /// Throws Error{Input} with file and line. A last line that a crash cut short is left out.
  explicit SessionReplay(std::filesystem::path file);

  size_t steps() const { return steps_.size(); }

  /// Does what was done before the world's next step, and the step. Throws Error{Input} naming the step and
  /// the line when the world is then in another state than it was, or cannot do what was done; also before
  /// the first step when it starts differently. The world must be at a step below steps().
  void step(World& world);

 private:
  struct Act {
    enum class Kind { Grab, Release, Cut } kind = Kind::Release;
    size_t line = 0, plant = 0;
    WorldSpring spring;  // of a cut: only its particle
  };
  struct Step {
    std::vector<Act> acts;  // before it
    size_t line = 0;
    std::string state;  // after it
  };
  void read(const std::string& text);
  void act(const Act& act, World& world);
  [[noreturn]] void fail(size_t line, const std::string& what, const std::string& hint = {}) const;

  std::filesystem::path file_;
  std::string start_;  // state before the first step
  double time_step_ = 0;
  std::vector<Step> steps_;
  std::optional<std::pair<size_t, ParticleId>> held_;  // as asked for: it may be elsewhere since
};

}  // namespace liana
