#include "runtime/world/grabs.h"

#include <algorithm>

namespace liana {
namespace {

/// m, where a grab that began at `from` is at a time (s).
Vec3 place_on_path(const SceneGrab& script, const Vec3& from, double time) {
  const std::vector<Vec3>& path = script.path;
  const double legs = static_cast<double>(path.size());
  const double way = std::clamp((time - script.time) / script.seconds, 0.0, 1.0) * legs;
  const size_t leg = std::min(static_cast<size_t>(way), path.size() - 1);
  const Vec3 start = leg == 0 ? Vec3(Vec3::Zero()) : path[leg - 1];
  return from + start + (way - static_cast<double>(leg)) * (path[leg] - start);
}

}  // namespace

void Grabs::hold(Garden& garden, size_t plant, const WorldSpring& spring) {
  const bool same = hand_ && hand_->asked_plant == plant && hand_->asked_particle == spring.particle;
  if (!same) hand_ = Hand{{plant, spring}, plant, spring.particle};
  const ParticleId particle = hand_->spring.particle;
  hand_->spring = spring;
  hand_->spring.particle = particle;
  garden[hand_->plant].wake();
}

void Grabs::begin(size_t number, size_t plant, const WorldSpring& spring, const Vec3& from) {
  led_.push_back({{plant, spring}, number, from});
}

void Grabs::lead(const std::vector<SceneGrab>& script, double time, double dt, Garden& garden) {
  std::erase_if(led_, [&](const Led& led) {
    return time > script[led.number].time + script[led.number].seconds + 1e-9;
  });
  for (Led& led : led_) {
    const SceneGrab& grab = script[led.number];
    led.spring.target = place_on_path(grab, led.from, time + dt);
    led.spring.target_velocity = (led.spring.target - place_on_path(grab, led.from, time)) / dt;
    garden[led.plant].wake();
  }
}

void Grabs::add_to(size_t plant, std::vector<WorldSpring>& springs) const {
  if (hand_ && hand_->plant == plant) springs.push_back(hand_->spring);
  for (const Led& led : led_)
    if (led.plant == plant) springs.push_back(led.spring);
}

bool Grabs::hold_on_to(size_t plant) const {
  return (hand_ && hand_->plant == plant) ||
         std::any_of(led_.begin(), led_.end(), [&](const Led& led) { return led.plant == plant; });
}

void Grabs::follow(const Detachment& cut) {
  each([&](Grab& grab) {
    if (grab.plant != cut.plant) return;
    const ParticleId old = grab.spring.particle;
    grab.spring.particle = cut.change.particles[old.index()];
    if (grab.spring.particle.valid()) return;
    const auto& taken = cut.origin.particles;
    grab.plant = cut.part;
    grab.spring.particle =
        ParticleId(static_cast<size_t>(std::lower_bound(taken.begin(), taken.end(), old) - taken.begin()));
  });
}

void Grabs::forget(size_t plant) {
  each([&](Grab& grab) { grab.plant -= grab.plant > plant; });
}

}  // namespace liana
