#include "tests/support/plants/abused_garden.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/parallel.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/model/topology.h"
#include "runtime/sim/step/joints.h"
#include "tests/support/plants/plant_energy.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana::test {
namespace {

constexpr double kDt = 0.025;
constexpr double kTooFast = 3000;  // m/s: a support carried 3 m within a step of 1 ms whips no tip faster

Plant fresh_plant() {
  return make_plant(synthetic_bake({.branches = 2, .twigs = 2, .leaves = 1}));
}

Vec3 random_vector(Random& random) {
  Vec3 v;  // one after the other: compilers evaluate arguments in the order they like
  for (double& x : v) x = random.uniform(-1, 1);
  return v;
}

}  // namespace

AbusedGarden::Victim::Victim(uint64_t seed)
    : plant(fresh_plant()), random(seed, "tests/abused_garden"), rest_energy(visible_energy(plant)) {}

AbusedGarden::AbusedGarden(uint64_t seed, size_t plants, unsigned threads) : threads_(threads) {
  for (size_t i = 0; i < plants; ++i) victims_.emplace_back(seed + i);
}

void AbusedGarden::spell() {
  parallel_for(victims_.size(), threads_, [&](size_t i, unsigned) {
    torment(victims_[i]);
    rest(victims_[i]);
  });
  report_ = {};
  for (const Victim& victim : victims_) {
    const GardenReport& r = victim.report;
    report_.steps += r.steps, report_.redone += r.redone, report_.projected += r.projected;
    report_.lost += r.lost, report_.cuts += r.cuts, report_.spells += r.spells;
    report_.seconds = std::max(report_.seconds, r.seconds);
    report_.top_speed = std::max(report_.top_speed, r.top_speed);
    report_.top_growth = std::max(report_.top_growth, r.top_growth);
    if (report_.broken.empty()) report_.broken = victim.broken;
  }
}

void AbusedGarden::torment(Victim& victim) {
  victim.abuse = static_cast<Abuse>(victim.random.next() % 7);
  const Vec3 home = victim.plant.particles[0].joint.on_parent;
  for (int i = 0; i < 60; ++i) {
    victim.springs.clear();
    act(victim, i);
    const bool jitter = victim.abuse == Abuse::Jitter || victim.random.next() % 8 == 0;
    advance(victim, jitter ? std::pow(10, victim.random.uniform(-3, -1)) : kDt);
  }
  victim.springs.clear();
  victim.plant.particles[0].joint.on_parent = home;
}

void AbusedGarden::act(Victim& v, int step) {
  const size_t n = v.plant.motion.size();
  const auto any = [&] { return v.random.next() % n; };
  switch (v.abuse) {
    case Abuse::Impulse:
      if (step % 10 == 0) {
        const Vec3 kick = 100 * random_vector(v.random).normalized();
        const size_t first = any();
        for (size_t k = first; k < std::min(first + 4, n); ++k) v.plant.motion[k].velocity += kick;
      }
      break;
    case Abuse::Teleport:
      if (step % 15 == 5) v.plant.particles[0].joint.on_parent += 2 * random_vector(v.random);
      break;
    case Abuse::Shake:
    case Abuse::Pinch: {  // a pinch holds two points with springs of very different stiffness
      const size_t holds = v.abuse == Abuse::Shake ? 1 : 2;
      for (size_t g = 0; g < holds; ++g) {
        const size_t k = g == 0 ? n - 1 : n / 2;
        v.springs.push_back({.particle = ParticleId(k),
                             .target = v.plant.motion[k].position + 0.5 * random_vector(v.random),
                             .stiffness = (g == 0 ? 1e4 : 1e6) * Mat3::Identity(),
                             .damping = 10 * Mat3::Identity(),
                             .target_velocity = 5 * random_vector(v.random)});
      }
      break;
    }
    case Abuse::Storm: {
      const Vec3 wind = 60 * Vec3(std::cos(0.1 * step), 0.2 * std::sin(step), std::sin(0.1 * step));
      for (size_t k = 0; k < n; ++k) {
        const Particle& p = v.plant.particles[k];
        const double drag = 2.4 * p.half_length * p.half_width * (wind - v.plant.motion[k].velocity).norm();
        v.springs.push_back({.particle = ParticleId(k),
                             .target = v.plant.motion[k].position,
                             .damping = drag * Mat3::Identity(),
                             .target_velocity = wind});
      }
      break;
    }
    case Abuse::Jitter:
      if (step % 20 == 0) v.plant.motion[any()].velocity += 10 * random_vector(v.random);
      break;
    case Abuse::Cut:
      if (step % 20 == 0) cut(v);
      break;
  }
}

void AbusedGarden::cut(Victim& v) {
  if (v.plant.particles.size() < 20) {  // nothing left to cut: another plant takes its place
    v.plant = fresh_plant();
    v.pieces.clear();
    v.piece_steppers.clear();
    return;
  }
  const ParticleId at(1 + v.random.next() % (v.plant.particles.size() - 1));
  v.pieces.push_back(detach_subtree(v.plant, at));
  v.piece_steppers.emplace_back();
  ++v.report.cuts;
  if (v.pieces.size() > 4) {  // taken away
    v.pieces.erase(v.pieces.begin());
    v.piece_steppers.erase(v.piece_steppers.begin());
  }
}

void AbusedGarden::advance(Victim& v, double dt) {
  const auto look = [&](const Plant& plant, const StepReport& step) {
    ++v.report.steps;
    v.report.redone += step.redone > 0;
    v.report.projected += static_cast<size_t>(step.projected);
    v.report.lost += !step.finite;
    for (const Motion& m : plant.motion) {
      const double speed = m.velocity.norm();
      v.report.top_speed = std::max(v.report.top_speed, speed);
      if (!(speed < kTooFast && m.position.allFinite() && m.orientation.coeffs().allFinite() &&
            m.angular_velocity.allFinite()) &&
          v.broken.empty())
        v.broken = fmt::format(
            "a particle of {} at {:.3g} m/s, abuse {}, after {:.2f} s, in a step of {:.2g} s that was "
            "redone {} times, {} joints projected",
            plant.motion.size(), speed, static_cast<int>(v.abuse), v.report.seconds, dt, step.redone,
            step.projected);
    }
    if (!step.finite && v.broken.empty())
      v.broken = fmt::format("a step was lost after {:.2f} s", v.report.seconds);
  };
  look(v.plant, v.stepper.step(v.plant, {}, v.springs, {.dt = dt}));
  for (size_t i = 0; i < v.pieces.size(); ++i) {
    // Pieces fall onto level ground at −1 m, by weight: a spring that throws a leaf of 0.1 g would be work,
    // too.
    std::vector<WorldSpring> ground;
    for (size_t k = 0; k < v.pieces[i].motion.size(); ++k) {
      const Vec3& x = v.pieces[i].motion[k].position;
      const double weight = v.pieces[i].particles[k].mass / kDt;
      if (x.y() < -1)
        ground.push_back({.particle = ParticleId(k),
                          .target = {x.x(), -1, x.z()},
                          .stiffness = 0.1 * weight / kDt * Mat3::Identity(),
                          .damping = weight * Mat3::Identity()});
    }
    look(v.pieces[i], v.piece_steppers[i].step(v.pieces[i], {}, ground, {.dt = dt}));
  }
  v.report.seconds += dt;
}

// Left alone, at even steps: within a swing the step's own energy differs from the one here by (ωh)²/4 of a
// mode's, so a quarter for the fastest that it resolves.
void AbusedGarden::rest(Victim& v) {
  constexpr double kSlack = 0.25, kSmall = 0.05;  // -, J
  for (int i = 0; i < 4; ++i) advance(v, kDt);    // the support's return is work
  const double floor = std::min(v.rest_energy, visible_energy(v.plant));
  const double start = visible_energy(v.plant) - floor + kSmall;
  for (int i = 0; i < 40; ++i) {
    advance(v, kDt);
    const double growth = (visible_energy(v.plant) - floor) / start;
    v.report.top_growth = std::max(v.report.top_growth, growth);
    if (growth > 1 + kSlack && v.broken.empty())
      v.broken = fmt::format("energy grew {:.3g} times in rest, after abuse {} at {:.2f} s", growth,
                             static_cast<int>(v.abuse), v.report.seconds);
  }
  ++v.report.spells;
}

uint64_t AbusedGarden::hash() const {
  uint64_t hash = 0;
  for (const Victim& victim : victims_) {
    hash = state_hash(victim.plant, hash);
    for (const Plant& piece : victim.pieces) hash = state_hash(piece, hash);
  }
  return hash;
}

}  // namespace liana::test
