#include "runtime/world/script.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/base/error.h"
#include "mesher/base/nearest_word.h"

namespace liana {
namespace {

bool names(const std::string& text, const std::vector<std::string>& domains, size_t index) {
  return text == domains[index] || text == "#" + std::to_string(index);
}

size_t step_at(double time, double dt) {
  return static_cast<size_t>(std::lround(time / dt));
}

}  // namespace

Script::Script(const Scene& scene, const Garden& garden) : scene_(scene) {
  for (const SceneImpulse& entry : scene.impulses) impulses_.push_back(impulse_of(entry, garden));
  for (const SceneCut& cut : scene.cuts) check_point(cut.where, "[[cut]]", garden);
  for (const SceneGrab& grab : scene.grabs) check_point(grab.where, "[[grab]]", garden);
}

void Script::fail_unknown(const char* table, const std::string& name, const std::string& plant,
                          const std::vector<std::string>& known) const {
  throw Error(Error::Kind::Input,
              fmt::format("{}: {} names '{}', but '{}' has no such branch or leaf", scene_.file.string(),
                          table, name, plant),
              fmt::format("did you mean '{}'?", nearest_word(name, known)));
}

void Script::check_point(const ScenePoint& point, const char* table, const Garden& garden) const {
  if (point.domain.empty()) return;
  const std::vector<std::string>& domains = garden.origin_of(garden[point.index]).domains;
  for (size_t i = 0; i < domains.size(); ++i)
    if (names(point.domain, domains, i)) return;
  fail_unknown(table, point.domain, garden[point.index].plant.name, domains);
}

Script::Impulse Script::impulse_of(const SceneImpulse& entry, const Garden& garden) const {
  const Plant& plant = garden[entry.plant].plant;
  const std::vector<std::string>& domains = garden.origin_of(garden[entry.plant]).domains;
  std::vector<std::string> there;
  for (size_t i = 0; i < plant.branches.size(); ++i) {
    const DomainId domain = plant.branches[i].domain;
    if (!domain.valid()) continue;
    if (names(entry.domain, domains, domain.index()))
      return {entry.plant, BranchId(i), step_at(entry.time, scene_.time_step), entry.velocity};
    there.push_back(domains[domain.index()]);
  }
  fail_unknown("[[impulse]]", entry.domain, plant.name, there);
}

bool Script::is_now(double time, size_t step) const {
  return step_at(time, scene_.time_step) == step;
}

std::optional<PlantPoint> Script::find(const ScenePoint& point, const Garden& garden) const {
  const size_t index = point.index + (point.climber ? scene_.plants.size() : 0);
  const Plant& plant = garden[index].plant;
  const std::vector<std::string>& domains = garden.origin_of(garden[index]).domains;
  ParticleId best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const Branch& branch : plant.branches) {
    if (!point.domain.empty()) {
      if (!branch.domain.valid() || !names(point.domain, domains, branch.domain.index())) continue;
      const size_t count = branch.particles.size();
      return PlantPoint{
          index,
          branch
              .particles[std::min(count - 1, static_cast<size_t>(point.along * static_cast<double>(count)))]};
    }
    if (branch.kind == DomainKind::Leaf) continue;
    for (const ParticleId id : branch.particles) {
      const double distance = (plant.motion[id.index()].position - point.at).norm();
      if (distance < best_distance) best = id, best_distance = distance;
    }
  }
  if (!best.valid()) return std::nullopt;
  return PlantPoint{index, best};
}

void Script::strike(size_t number, Plant& plant, size_t step) const {
  for (const Impulse& impulse : impulses_) {
    if (impulse.plant != number || impulse.step != step) continue;
    const Branch& branch = plant.branches[impulse.branch.index()];
    double length = 0, before = 0;
    for (const ParticleId id : branch.particles) length += 2 * plant.particles[id.index()].half_length;
    for (const ParticleId id : branch.particles) {
      Motion& motion = plant.motion[id.index()];
      const double half = plant.particles[id.index()].half_length, way = (before + half) / length;
      before += 2 * half;
      motion.velocity += way * way * impulse.velocity;
      // The slope of that velocity along the branch turns the particle.
      const Vec3 axis = motion.orientation * Vec3::UnitY();
      motion.angular_velocity += axis.cross(2 * way / length * impulse.velocity);
    }
  }
}

void Script::follow(const Detachment& cut, const Garden& garden, size_t step,
                    std::vector<std::string>& notes) {
  std::erase_if(impulses_, [&](Impulse& impulse) {
    if (impulse.plant != cut.plant || impulse.step < step) return false;
    impulse.branch = cut.change.branches[impulse.branch.index()];
    if (impulse.branch.valid()) return false;
    notes.push_back(
        fmt::format("a branch that [[impulse]] names had come off {} before", garden[cut.plant].plant.name));
    return true;
  });
}

}  // namespace liana
