#include "runtime/sim/contact/probes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "runtime/sim/contact/make_room.h"

namespace liana {
namespace {

// Neighbours in the arrays are neighbours in space: a box around so many is tried first. No answer depends on
// it.
constexpr size_t kAtOnce = 32;
// m a step, below which the solid is a half space: half of a bar of 1 cm, which is so not passed.
constexpr double kSlow = 5e-3;
constexpr uint64_t kBetween = 3;  // the probe between the ends
// m, at which a sweep has arrived: less than half of what ContactStepOptions::tolerance lets a step end
// inside by.
constexpr double kTouch = 2e-4;
// Of a unit vector, that must be across the axis to give a direction: 2°, where rounding of the field's
// gradient (a tenth of a voxel over a voxel's length, at worst 0.1) would decide.
constexpr double kAcross = 0.03;

/// A plane that touches a solid where it is closest to a point.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  // m, of the point
  Vec3 normal = Vec3::UnitY();
};

Nearest nearest(const SdfObstacle& solid, const Vec3& x, double reach) {
  const SdfSample field = solid.sample(x);
  if (field.distance > reach) return {};
  if (std::abs(field.distance) < solid.band()) return {field.distance, field.gradient};
  const SurfacePoint exact = solid.closest_point(x);
  if (exact.distance > reach) return {};
  const Vec3 away = x - exact.point;
  return {exact.distance, std::abs(exact.distance) > 1e-9 ? Vec3(away / exact.distance) : exact.normal};
}

/// The point of an elliptical cross-section furthest along -normal, in the particle's frame, from its axis.
Vec3 reach_towards(const Particle& particle, const Vec3& local_normal, double scale) {
  const double a = particle.half_width * scale, b = particle.half_thickness * scale;
  const Vec3 squared(a * a * local_normal.x(), 0, b * b * local_normal.z());
  const double reach = std::sqrt(squared.x() * local_normal.x() + squared.z() * local_normal.z());
  return reach > 0 ? Vec3(-squared / reach) : Vec3::Zero();
}

double travel_of(const Particle& particle, const Motion& motion, double dt) {
  return dt * (motion.velocity.norm() + particle.half_length * motion.angular_velocity.norm() +
               dt * motion.acceleration.norm() / 2);
}

}  // namespace

const std::vector<Gap>& Probes::look(const Plant& plant, const CollisionScene& scene, double dt, size_t first,
                                     Clearances* clearances) {
  gaps_.clear();
  make_room(gaps_, plant.particles.size());
  if (clearances) clearances->begin(plant.particles.size(), scene.solids, scene.ground_height);
  for (size_t i = first; i < plant.particles.size(); i += kAtOnce)
    look(plant, scene, dt, i, std::min(i + kAtOnce, plant.particles.size()), clearances);
  return gaps_;
}

void Probes::look(const Plant& plant, const CollisionScene& scene, double dt, size_t first, size_t last,
                  Clearances* clearances) {
  std::array<bool, kAtOnce> clear{};
  if (clearances) {
    for (size_t i = first; i < last; ++i) clear[i - first] = clearances->clear(plant, i, dt);
    const bool any_moves = std::any_of(scene.solids.begin(), scene.solids.end(),
                                       [](const SdfObstacle* solid) { return solid->moves(); });
    if (!any_moves && std::all_of(clear.begin(), clear.begin() + (last - first), std::identity())) return;
  }
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (size_t i = first; i < last; ++i) {
    const Particle& particle = plant.particles[i];
    const double around = particle.half_length + std::max(particle.half_width, particle.half_thickness) +
                          travel_of(particle, plant.motion[i], dt);
    low = low.cwiseMin((plant.motion[i].position.array() - around).matrix());
    high = high.cwiseMax((plant.motion[i].position.array() + around).matrix());
  }
  near_.clear();
  for (uint32_t s = 0; s < scene.solids.size(); ++s) {
    const SdfObstacle& solid = *scene.solids[s];
    // It comes from where it was at the start of the step.
    const Vec3 half = (solid.high() - solid.low()) / 2;
    const double way = dt * (solid.pose().velocity.norm() +
                             solid.pose().angular_velocity.norm() *
                                 (half.norm() + (solid.low() + half - solid.pose().centre).norm()));
    if ((solid.low().array() - way <= high.array()).all() &&
        (low.array() <= solid.high().array() + way).all())
      near_.emplace_back(s + 1, &solid);
  }
  ground_ = scene.ground_height.value_or(-std::numeric_limits<double>::infinity());
  const bool near_ground = low.y() <= ground_;
  if (near_.empty() && !near_ground) return;

  for (size_t i = first; i < last; ++i) {
    const bool is_clear = clear[i - first];
    if (near_ground && !is_clear) look_at(plant, i, dt, nullptr, 0);
    for (const auto& [number, solid] : near_)
      if (!is_clear || solid->moves()) look_at(plant, i, dt, solid, number);
    if (clearances && !is_clear && dt > 0) clearances->learn(plant, i, scene.solids);
  }
}

/// What one particle sees of one solid.
class Probes::View {
 public:
  View(const Plant& plant, size_t i, double dt, const SdfObstacle* solid, double ground)
      : particle_(plant.particles[i]),
        motion_(plant.motion[i]),
        dt_(dt),
        solid_(solid),
        ground_(ground),
        blade_(plant.branches[particle_.branch.index()].kind == DomainKind::Leaf),
        axis_(motion_.orientation * Vec3(0, particle_.half_length, 0)) {}

  /// A point of the axis, and what of the solid is nearest to it when it is not beyond `reach`.
  struct Point {
    double along;  // in [-1, 1]
    Vec3 start, way;
    Nearest found;
    double slope = 0;  // of the distance, m per unit of `along`
  };

  // Seen from the solid, which stands where it will be, the point starts as far ahead as the solid moves.
  Point at(double along, double reach) const {
    const Vec3 arm = along * axis_, x = motion_.position + arm;
    const Vec3 surface = solid_ ? solid_->velocity_at(x) : Vec3::Zero();
    const Vec3 velocity = motion_.velocity + motion_.angular_velocity.cross(arm) - surface;
    Point point{along, x + dt_ * surface, dt_ * (velocity + dt_ / 2 * motion_.acceleration), {}};
    point.found = nearest_to(point.start, reach);
    point.slope = point.found.normal.dot(axis_);
    return point;
  }

  Nearest nearest_to(const Vec3& x, double reach) const {
    return solid_ ? nearest(*solid_, x, reach) : Nearest{x.y() - ground_, Vec3::UnitY()};
  }

  /// Where an edge of the solid crosses the axis between the middle and an end, or comes nearest to it. The
  /// distance to a convex solid along a line is convex: tangents meet below it.
  std::optional<Point> between(const Point& middle, const Point& head, double reach) const {
    double least = std::min({middle.found.distance, head.found.distance, reach + kTouch});
    const auto no_better = [&](double bound) { return bound > least - kTouch; };
    Point low = middle, high = head;
    if (middle.slope > 0) {
      if (no_better(middle.found.distance - middle.slope)) return {};
      high = middle;
      low = at(-1, kFar);
      least = std::min(least, low.found.distance);
    }
    std::optional<Point> best;
    constexpr int kMostCuts = 8;
    for (int i = 0; i < kMostCuts && low.slope < 0 && high.slope > 0; ++i) {
      const double meet =
          (high.found.distance - high.slope * high.along - low.found.distance + low.slope * low.along) /
          (low.slope - high.slope);
      if (no_better(low.found.distance + low.slope * (meet - low.along))) break;
      const Point cut = at(std::clamp(meet, low.along, high.along), kFar);
      if (cut.found.distance < least) least = cut.found.distance, best = cut;
      (cut.slope < 0 ? low : high) = cut;
    }
    return best;
  }

  /// Its gap, when it may touch within the step.
  std::optional<Gap> gap(const Point& point, bool crossed) const {
    // A blade is widest in the middle and ends in a point; a stem is a cylinder. Between its middle and its
    // ends a blade's axis counts alone: its rims would take turns.
    const double width = blade_ && point.along != 0 ? 0 : 1;
    const double radius = std::max(particle_.half_width, particle_.half_thickness) * width;
    const double length = point.way.norm(), reach = radius + length;
    Vec3 x = point.start;
    Nearest on_axis_found = point.found;
    if (on_axis_found.distance > reach) return {};
    // Fast ones are followed to where they arrive: a bar that they pass by is no wall.
    if (solid_ && length > kSlow && on_axis_found.distance > radius) {
      double gone = 0;
      for (int i = 0; i < 64; ++i) {
        const double free = on_axis_found.distance - radius;
        if (free < kTouch) break;
        gone += free;
        if (gone > length) return {};
        x = point.start + gone / length * point.way;
        on_axis_found = nearest_to(x, reach);
        if (!std::isfinite(on_axis_found.distance)) return {};
      }
    }
    const Vec3 arm = reach_towards(particle_, motion_.orientation.conjugate() * on_axis_found.normal, width);
    // Beside an edge the solid is no half space: what counts is the distance of the point itself.
    const Nearest found = nearest_to(x + motion_.orientation * arm, reach);
    if (found.distance > reach) return {};
    const double gap = found.distance + (point.start - x).dot(found.normal);
    Vec3 normal = found.normal;
    if (crossed && gap < 0) {
      // What an edge crosses goes out across itself: along the normals of the two faces that meet there it
      // would go to and fro, or be pushed along itself. A blade goes to the side that is sooner free.
      const Vec3 axis = motion_.orientation * Vec3::UnitY(), plane = motion_.orientation * Vec3::UnitZ();
      if (blade_) {
        const double ahead = nearest_to(x - 2 * gap * plane, kFar).distance;
        normal = ahead > nearest_to(x + 2 * gap * plane, kFar).distance ? plane : Vec3(-plane);
      } else if (const Vec3 across = normal - normal.dot(axis) * axis; across.norm() > kAcross) {
        normal = across.normalized();
      }
    }
    // A round stem is held at its axis: held at its skin, a point that turns with it, it would be rolled over
    // by its own weight.
    const Vec3 on_axis(0, point.along * particle_.half_length, 0);
    return Gap{0,
               0,
               solid_,
               blade_ ? Vec3(on_axis + arm) : on_axis,
               gap,
               normal,
               crossed && gap < 0,
               blade_ && point.along != 0};
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  const Particle& particle_;
  const Motion& motion_;
  double dt_;
  const SdfObstacle* solid_;
  double ground_;
  bool blade_;
  Vec3 axis_;
};

bool Probes::inside(const Vec3& x, std::optional<const SdfObstacle*> without) const {
  return (x.y() < ground_ && without != nullptr) ||
         std::any_of(near_.begin(), near_.end(),
                     [&](const auto& s) { return without != s.second && s.second->distance(x) < 0; });
}

// Where solids touch, the face that is nearest from within may lie against another solid: that is no way out.
// The way that it came in is: the plant itself leads there. False when another solid has to see to it.
bool Probes::lead_out(const Plant& plant, Gap& gap) const {
  const Particle& particle = plant.particles[gap.particle];
  const Motion& motion = plant.motion[gap.particle];
  const bool blade = plant.branches[particle.branch.index()].kind == DomainKind::Leaf;
  Vec3 within = motion.position + motion.orientation * gap.point;
  if (!blade) within -= particle.half_width * gap.normal;
  const Vec3 start = within;
  if (!inside(start - (gap.gap - kTouch) * gap.normal, gap.solid)) return true;
  constexpr int kFarthest = 8;
  Vec3 outside = start;
  ParticleId at(gap.particle);
  for (int i = 0; i < kFarthest && at.valid() && inside(outside); ++i) {
    const Particle& on_the_way = plant.particles[at.index()];
    outside = plant.motion[at.index()].position +
              plant.motion[at.index()].orientation * Vec3(0, -on_the_way.half_length, 0);
    at = on_the_way.parent;
  }
  if (inside(outside)) return true;  // as good as any
  for (int i = 0; i < 16; ++i) {
    const Vec3 middle = (within + outside) / 2;
    (inside(middle) ? within : outside) = middle;
  }
  const Nearest entry =
      gap.solid ? nearest(*gap.solid, within, 2 * kTouch) : Nearest{within.y() - ground_, Vec3::UnitY()};
  if (std::abs(entry.distance) > 2 * kTouch) return false;
  gap.normal = entry.normal;
  gap.gap = std::min(0.0, (start - within).dot(entry.normal));
  return true;
}

void Probes::look_at(const Plant& plant, size_t i, double dt, const SdfObstacle* solid, uint64_t number) {
  const Particle& particle = plant.particles[i];
  double travel = travel_of(particle, plant.motion[i], dt);
  if (solid && solid->moves())
    travel += dt * (solid->velocity_at(plant.motion[i].position).norm() +
                    solid->pose().angular_velocity.norm() * particle.half_length);
  const double reach = std::max(particle.half_width, particle.half_thickness) + travel;
  const View view(plant, i, dt, solid, ground_);
  const View::Point middle = view.at(0, reach + particle.half_length);
  if (!std::isfinite(middle.found.distance)) return;
  const auto note = [&](const View::Point& point, uint64_t probe) {
    auto gap = view.gap(point, probe == kBetween);
    if (!gap) return;
    gap->particle = i;
    gap->key = (uint64_t(i) << 16 | number) << 2 | probe;
    const bool alone = near_.size() + (ground_ > -std::numeric_limits<double>::infinity()) < 2;
    if (gap->gap >= 0 || alone || lead_out(plant, *gap)) gaps_.push_back(*gap);
  };
  const View::Point head = view.at(1, reach + 2 * particle.half_length);
  note(middle, 0);
  note(head, 1);
  // A tail is its parent's head, unless it is loose or on a petiole.
  const bool joined = particle.joint.on_self.y() > -1.01 * particle.half_length;
  if (!joined || particle.joint.shear_stiffness.isZero(0)) note(view.at(-1, reach), 2);
  if (solid)
    if (const auto crossed = view.between(middle, head, reach)) note(*crossed, kBetween);
}

}  // namespace liana
