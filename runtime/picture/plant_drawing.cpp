#include "runtime/picture/plant_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

/// A number in [-1, 1] that belongs to an id.
double variation(uint32_t id, uint32_t stream) {
  const uint32_t key[2] = {id, stream};
  return double(hash_bytes(key, sizeof key) >> 11) * 0x1p-52 - 1;
}

struct PlantView {
  const Plant& plant;

  const Particle& particle(ParticleId id) const { return plant.particles[id.index()]; }
  const Motion& motion(ParticleId id) const { return plant.motion[id.index()]; }
  /// A point of the particle's own axis, y in m from its centre.
  Vec3 on_axis(ParticleId id, double y) const {
    return motion(id).position + motion(id).orientation * Vec3(0, y, 0);
  }
  Vec3 tail(ParticleId id) const { return on_axis(id, -particle(id).half_length); }
  Vec3 head(ParticleId id) const { return on_axis(id, particle(id).half_length); }
  double radius(ParticleId id) const { return (particle(id).half_width + particle(id).half_thickness) / 2; }
  /// Where the particle's joint meets its parent's axis. Needs a parent.
  Vec3 foot(ParticleId id) const {
    const Particle& self = particle(id);
    const double reach = particle(self.parent).half_length;
    return on_axis(self.parent, std::clamp(self.joint.on_parent.y(), -reach, reach));
  }
};

/// The knots of a branch's curve: its foot, the joints between its particles, its tip.
DrawTube knots_of(const PlantView& view, const Branch& branch) {
  const std::vector<ParticleId>& chain = branch.particles;
  DrawTube knots;
  const auto add = [&](const Vec3& point, double radius) {
    knots.points.push_back(point);
    knots.radii.push_back(radius);
  };
  const ParticleId first = chain.front(), last = chain.back();
  const double root_radius = view.radius(first);
  const ParticleId parent = view.particle(first).parent;
  if (parent.valid()) {
    const Vec3 foot = view.foot(first);
    // Inside the parent, no thicker than it; a step shorter than its own radius would only kink the curve.
    if ((foot - view.tail(first)).norm() > 0.5 * root_radius)
      add(foot, std::min(1.1 * root_radius, 0.95 * view.radius(parent)));
  } else {
    add(view.on_axis(first, -view.particle(first).half_length - 2 * root_radius), 1.15 * root_radius);
  }
  add(view.tail(first), root_radius);
  for (size_t i = 1; i < chain.size(); ++i)
    add((view.head(chain[i - 1]) + view.tail(chain[i])) / 2,
        (view.radius(chain[i - 1]) + view.radius(chain[i])) / 2);
  const double end = view.radius(last),
               before = chain.size() > 1 ? view.radius(chain[chain.size() - 2]) : end;
  add(view.head(last), std::clamp(end - (before - end) / 2, 0.3 * end, end));
  return knots;
}

/// Catmull-Rom curve through the knots; radii are interpolated linearly, so they never overshoot.
void smooth_into(const DrawTube& knots, int points_per_span, DrawTube& tube) {
  const size_t last = knots.points.size() - 1;
  const auto slope = [&](size_t i, size_t span) -> Vec3 {
    const Vec3 &before = knots.points[i == 0 ? 0 : i - 1], &after = knots.points[std::min(i + 1, last)];
    // Spans differ in length (a short foot beside long particles): the slope keeps to this span's own.
    const double here = (knots.points[span + 1] - knots.points[span]).norm(),
                 around = (after - before).norm();
    return around > 0 ? Vec3((after - before) * (here / around)) : Vec3(Vec3::Zero());
  };
  for (size_t i = 0; i < last; ++i) {
    const Vec3 &p = knots.points[i], &q = knots.points[i + 1], u = slope(i, i), v = slope(i + 1, i);
    for (int k = 0; k < points_per_span; ++k) {
      const double t = double(k) / points_per_span, s = 1 - t;
      tube.points.push_back(s * s * (1 + 2 * t) * p + t * t * (3 - 2 * t) * q + s * s * t * u -
                            s * t * t * v);
      tube.radii.push_back(s * knots.radii[i] + t * knots.radii[i + 1]);
    }
  }
  tube.points.push_back(knots.points[last]);
  tube.radii.push_back(knots.radii[last]);
}

Vec3 stem_color(const PlantLook& look, double radius, uint32_t id) {
  const double woody = std::clamp((radius - 0.0012) / 0.0025, 0.0, 1.0);
  return ((1 - woody) * look.green_stem + woody * look.bark) * (1 + 0.12 * variation(id, 1));
}

DrawLeaf blade_of(const PlantView& view, const Branch& branch, const PlantLook& look) {
  const ParticleId first = branch.particles.front(), last = branch.particles.back();
  const uint32_t shade_id = branch.shade == Branch::kNoShade ? first.value : branch.shade;
  DrawLeaf leaf;
  leaf.outline = look.outline;
  leaf.base = view.tail(first);
  leaf.length = leaf.width = 0;
  for (const ParticleId id : branch.particles) {
    leaf.length += 2 * view.particle(id).half_length;
    leaf.width = std::max(leaf.width, 2 * view.particle(id).half_width);
  }
  const Quat& base = view.motion(first).orientation;
  const Vec3 tip_way = base.conjugate() * (view.motion(last).orientation * Vec3::UnitY());
  // The turn between the middles of the first and the last particle, continued to base and tip.
  const double count = double(branch.particles.size());
  const double bend = count > 1 ? std::atan2(-tip_way.z(), tip_way.y()) * count / (count - 1) : 0;
  const double at_rest = look.leaf_curl * (1 + 0.5 * variation(shade_id, 2));
  leaf.curl = at_rest + bend;
  // Turned back by half of what the first particle's own length bends, so the blade lies along the particles.
  const double back = (at_rest + bend / count) / 2;
  leaf.orientation = base * Quat(Eigen::AngleAxisd(back, Vec3::UnitX()));
  const double shade = 1 + 0.28 * variation(shade_id, 3), yellow = 0.5 + 0.5 * variation(shade_id, 4);
  leaf.color = shade * look.leaf.cwiseProduct(Vec3(1 + 0.35 * yellow, 1 + 0.08 * yellow, 1));
  return leaf;
}

}  // namespace

PlantLook plant_look(std::string_view species) {
  if (species == "ivy")
    return {{0.17, 0.115, 0.065}, {0.17, 0.15, 0.07}, {0.058, 0.150, 0.036}, LeafOutline::Ivy, 0.45};
  if (species == "birch")
    return {{0.62, 0.60, 0.55}, {0.17, 0.12, 0.07}, {0.130, 0.225, 0.045}, LeafOutline::Ovate, 0.3};
  if (species == "walnut")
    return {{0.25, 0.215, 0.175}, {0.16, 0.17, 0.07}, {0.110, 0.185, 0.045}, LeafOutline::Ovate, 0.4};
  if (species == "wisteria")
    return {{0.22, 0.18, 0.13}, {0.15, 0.20, 0.07}, {0.115, 0.220, 0.055}, LeafOutline::Ovate, 0.6};
  if (species == "palm")
    return {{0.27, 0.21, 0.14}, {0.17, 0.21, 0.07}, {0.085, 0.190, 0.045}, LeafOutline::Ovate, 0.7};
  if (species == "schefflera")
    return {{0.23, 0.19, 0.13}, {0.14, 0.20, 0.07}, {0.055, 0.160, 0.035}, LeafOutline::Ovate, 0.6};
  return {};
}

void add_plant(const Plant& plant, const PlantLook& look, const PlantDrawingOptions& options,
               DrawScene& scene) {
  require(options.points_per_particle >= 1, "add_plant: points_per_particle < 1");
  const PlantView view{plant};
  for (uint32_t i = 0; i < plant.branches.size(); ++i) {
    const Branch& branch = plant.branches[i];
    if (branch.particles.empty()) continue;  // a bud that has not grown yet
    const ParticleId first = branch.particles.front();
    if (branch.kind == DomainKind::Branch) {
      DrawTube tube;
      smooth_into(knots_of(view, branch), options.points_per_particle, tube);
      tube.color = stem_color(look, view.radius(first), branch.shade == Branch::kNoShade ? i : branch.shade);
      if (options.names) tube.name = fmt::format("{} branch {}", plant.name, i);
      scene.tubes.push_back(std::move(tube));
      continue;
    }
    DrawLeaf leaf = blade_of(view, branch, look);
    if (options.names) leaf.name = fmt::format("{} leaf {}", plant.name, i);
    if (view.particle(first).parent.valid()) {
      const Vec3 foot = view.foot(first);
      const double thick =
          std::clamp(0.012 * leaf.length, 0.0004, 0.9 * view.radius(view.particle(first).parent));
      if ((leaf.base - foot).norm() > 1.5 * view.radius(view.particle(first).parent))
        scene.tubes.push_back({{foot, leaf.base},
                               {1.3 * thick, thick},
                               look.green_stem,
                               options.names ? leaf.name + " stalk" : ""});
    }
    scene.leaves.push_back(std::move(leaf));
  }
}

}  // namespace liana
