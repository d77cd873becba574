// What the scene does to its plants at given times: impulses, cuts and grabs.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/world/garden.h"

namespace liana {

/// A particle of one of a garden's plants.
struct PlantPoint {
  size_t plant;
  ParticleId particle;
};

class Script {
 public:
  /// The scene must outlive it. Throws Error{Input} for names of branches that the plants do not have.
  Script(const Scene& scene, const Garden& garden);

  /// Whether a time (s) of the scene is that of the begin of a step.
  bool is_now(double time, size_t step) const;
  /// Where a place of the scene is now; nothing when nothing of it is left.
  std::optional<PlantPoint> find(const ScenePoint& point, const Garden& garden) const;
  /// Strikes what is to be struck of a plant before this step.
  void strike(size_t number, Plant& plant, size_t step) const;

  /// Forgets impulses on branches that are gone, with a note each. `step`: the one that comes next.
  void follow(const Detachment& cut, const Garden& garden, size_t step, std::vector<std::string>& notes);

  template <class Archive>
  void persist(Archive& a) {
    a(impulses_);
    // not state: scene_: the scene
  }

 private:
  struct Impulse {
    size_t plant = 0;
    BranchId branch;
    size_t step = 0;  // before which it happens
    Vec3 velocity = Vec3::Zero();
    template <class Archive>
    void persist(Archive& a) {
      a(plant, branch, step, velocity);
    }
  };
  void check_point(const ScenePoint& point, const char* table, const Garden& garden) const;
  [[noreturn]] void fail_unknown(const char* table, const std::string& name, const std::string& plant,
                                 const std::vector<std::string>& known) const;
  Impulse impulse_of(const SceneImpulse& entry, const Garden& garden) const;

  const Scene& scene_;
  std::vector<Impulse> impulses_;
};

}  // namespace liana
