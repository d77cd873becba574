// What holds plants: the user's hand, and the grabs of the scene that are under way.
#pragma once

#include <optional>
#include <vector>

#include "runtime/world/garden.h"

namespace liana {

class Grabs {
 public:
  /// The user holds a point of a plant until let_go(). The particle is named as it was when it was first
  /// held: it may be of a part that came off since.
  void hold(Garden& garden, size_t plant, const WorldSpring& spring);
  void let_go() { hand_.reset(); }

  /// A grab of the scene begins: the `number`-th. `from` (m): where it was grabbed.
  void begin(size_t number, size_t plant, const WorldSpring& spring, const Vec3& from);
  /// Moves what holds along the paths of the scene, to where it is at the end of a step from time (s) to time
  /// + dt, and ends what is over. Wakes what it holds.
  void lead(const std::vector<SceneGrab>& script, double time, double dt, Garden& garden);

  void add_to(size_t plant, std::vector<WorldSpring>& springs) const;
  bool hold_on_to(size_t plant) const;

  void follow(const Detachment& cut);
  void forget(size_t plant);  ///< it is gone; those behind it moved up

  template <class Archive>
  void persist(Archive& a) {
    a(hand_, led_);
  }

 private:
  struct Grab {
    size_t plant = 0;
    WorldSpring spring;
    template <class Archive>
    void persist(Archive& a) {
      a(plant, spring);
    }
  };
  struct Hand : Grab {
    size_t asked_plant = 0;  // as the caller knows it
    ParticleId asked_particle;
    template <class Archive>
    void persist(Archive& a) {
      Grab::persist(a);
      a(asked_plant, asked_particle);
    }
  };
  struct Led : Grab {
    size_t number = 0;         // in the scene
    Vec3 from = Vec3::Zero();  // m
    template <class Archive>
    void persist(Archive& a) {
      Grab::persist(a);
      a(number, from);
    }
  };
  template <class Do>
  void each(const Do& act) {
    if (hand_) act(static_cast<Grab&>(*hand_));
    for (Led& led : led_) act(static_cast<Grab&>(led));
  }

  std::optional<Hand> hand_;
  std::vector<Led> led_;
};

}  // namespace liana
