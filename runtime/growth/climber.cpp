#include "runtime/growth/climber.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "runtime/growth/growth_weights.h"

namespace liana {
namespace {

void check(bool sound, const char* what) {
  if (!sound) throw Error(Error::Kind::Input, what, "the defaults of ClimberParameters grow an ivy");
}

}  // namespace

Climber::Climber(const ClimberParameters& parameters, const SpeciesLaw& law, const Vec3& seed_position,
                 uint64_t random_seed)
    : parameters_(parameters),
      ground_(seed_position.y()),
      shoots_(parameters, law, seed_position, random_seed),
      body_(parameters, law) {
  const ClimberParameters& p = parameters;
  check(seed_position.allFinite(), "a climber's seed is not at a finite place");
  check(p.elongation > 0 && p.elongation < 1, "a climber's elongation is not between 0 and 1 m/s");
  check(p.segment_length >= 5e-3 && p.segment_length <= 1, "a climber's segments are not 5 mm to 1 m long");
  check(p.tip_radius > 1e-5 && p.tip_radius < p.segment_length / 2,
        "a climber's tip is too thin or too thick");
  check(p.first_shoots >= 1 && p.first_shoots <= 64, "a climber needs 1 to 64 first shoots");
  check(p.pipe_exponent >= 1 && p.pipe_exponent <= 4, "a climber's pipe exponent is not between 1 and 4");
  check(p.leaves.step > 0 && p.leaves.length > 0 && p.leaves.width > 0 && p.leaves.thickness > 0 &&
            p.leaves.petiole > 0 && p.leaves.petiole_radius > 0 && p.leaves.seconds_to_full > 0 &&
            p.leaves.variation >= 0 && p.leaves.variation < 1,
        "a climber's leaves have no size");
  check(p.branching.variance >= 0 && p.branching.variance <= 1 && p.branching.falloff > 0 &&
            p.branching.falloff <= 1,
        "a climber's branching variance or falloff is not between 0 and 1");
  check(p.max_particles >= 1 && p.max_particles <= 1'000'000, "a climber may have 1 to 1,000,000 particles");
  law.group("level0"), law.group("leaf");
}

GrowthReport Climber::grow(Plant& plant, std::span<const SdfObstacle* const> obstacles, const Vec3& to_sun,
                           double dt) {
  const Surroundings around{obstacles, to_sun.normalized(), ground_};
  take(plant);
  if (!germinated_) shoots_.germinate(plant, around, body_);
  germinated_ = true;
  Anchors& anchors = shoots_.anchors();
  if (plant.particles.empty()) return {.released = anchors.released()};  // all of it was cut
  body_.begin(plant);
  const int parts = std::max(1, static_cast<int>(std::ceil(dt / kGrowth.longest_step - 1e-9)));
  for (int i = 0; i < parts; ++i) {
    shoots_.grow(plant, around, dt / parts, body_);
    body_.thicken_stems(plant, dt / parts);
  }
  anchors.update(plant, dt);
  const std::vector<BranchId> growing = shoots_.growing();
  const Recalibration done = body_.recalibrate_changed(plant, growing, dt);
  body_.end(plant, dt);
  return {.tips = growing.size(),
          .leaves = shoots_.leaves().count(),
          .anchors = anchors.count(),
          .released = anchors.released(),
          .recalibrated = done.branches,
          .out_of_range = done.out_of_range};
}

void Climber::take(const Plant& plant) {
  slots_.take(plant.removals, [&](const Remap& remap) {
    shoots_.follow(remap);
    body_.follow(remap);
  });
}

void Climber::mark_growing(const Plant& plant, std::vector<uint8_t>& growing) const {
  slots_.check(plant.removals);
  growing.assign(plant.particles.size(), 0);
  shoots_.mark_growing(plant, growing);
}

}  // namespace liana
