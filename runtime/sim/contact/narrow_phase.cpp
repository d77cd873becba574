#include "runtime/sim/contact/narrow_phase.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/sim/contact/ellipsoids.h"

namespace liana {
namespace {

/// Shapes are softer and thicker than what they stand for. Found by trial on fence.toml (leaves of three
/// ivies) and the tests of contact_plants_test.cpp; a leaf that bends within itself, rather than as one
/// plate, would answer them.
struct ProxyWeights {
  double stem_soft = 0.15;    ///< of both's thickness: deeper than that stems resist harder
  double blade_depth = 0.05;  ///< of a blade's smaller half: at least that thick is it to others
  double round = 0.8;    ///< the same, to find where it is pushed: nearly a ball, so that the place is steady
  double deepest = 0.5;  ///< of a blade's half width: deeper than that it has been passed for good
  double drawn = 0.01;   ///< of closest points of nearly parallel stems, to their middles
};
constexpr ProxyWeights kWeights;
constexpr double kLeast = 1e-6;  // m, of a half: keeps axes invertible

struct ClosestPoints {
  double s, t;  // in [-1, 1] along each axis
};

/// Of the segments p + s u and q + t v, drawn a little to their middles: of nearly parallel ones the closest
/// points would jump from end to end.
ClosestPoints closest_points(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const Vec3 w = p - q;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double area = (1 + kWeights.drawn) * (1 + kWeights.drawn) * uu * vv - uv * uv;
  const double s = std::clamp((uv * vw - (1 + kWeights.drawn) * vv * uw) / area, -1.0, 1.0);
  const double t = std::clamp((vw + s * uv) / vv, -1.0, 1.0);
  return {s, t};
}

/// Half the thickness of a stem's elliptical cross-section along a unit direction of the world.
double reach_across(const Proxy& stem, const Vec3& n) {
  const Particle& p = stem.particle;
  if (p.half_width == p.half_thickness) return p.half_width;
  const Vec3 local = stem.motion.orientation.conjugate() * n;
  return fixed::hypot(p.half_width * local.x(), p.half_thickness * local.z());
}

Vec3 axis_of(const Proxy& proxy) {
  return proxy.motion.orientation * Vec3(0, proxy.particle.half_length, 0);
}

ContactGeometry contact_as_capsules(const Proxy& a, const Proxy& b, const Vec3* side) {
  const Vec3 axis_a = axis_of(a), axis_b = axis_of(b);
  const auto [s, t] = closest_points(a.motion.position, axis_a, b.motion.position, axis_b);
  ContactGeometry met;
  met.arm_a = s * axis_a, met.arm_b = t * axis_b;
  const Vec3 between = a.motion.position + met.arm_a - b.motion.position - met.arm_b;
  double distance = between.norm();
  met.normal = distance > 1e-9 ? Vec3(between / distance)
               : side          ? *side
                               : axis_a.cross(axis_b).stableNormalized();
  if (side && met.normal.dot(*side) < 0) met.normal = -met.normal, distance = -distance;
  const double thickness = reach_across(a, met.normal) + reach_across(b, met.normal);
  met.gap = distance - thickness;
  met.soft = kWeights.stem_soft * (thickness + kLeast);
  return met;
}

/// Half of it, m; of a blade it is `least` times its smaller half at least.
double thickness_of(const Proxy& proxy, double least) {
  const Particle& p = proxy.particle;
  return proxy.blade ? std::max(p.half_thickness, least * std::min(p.half_width, p.half_length))
                     : p.half_thickness;
}

/// Of a stem a little longer than it is, so that the next one overlaps it.
Ellipsoid ellipsoid_of(const Proxy& proxy, double least_thickness) {
  const Particle& p = proxy.particle;
  const double beyond = proxy.blade ? 0 : p.half_width;
  const Vec3 halves(p.half_width, p.half_length + beyond, thickness_of(proxy, least_thickness));
  return {proxy.motion.position,
          proxy.motion.orientation.toRotationMatrix() * halves.cwiseMax(kLeast).asDiagonal()};
}

/// The arm to the point of a stem's axis or of a blade's plane that is nearest to a point, nearly.
Vec3 arm_to(const Proxy& proxy, const Vec3& at) {
  const Particle& p = proxy.particle;
  Vec3 local = proxy.motion.orientation.conjugate() * (at - proxy.motion.position);
  if (!proxy.blade)
    return proxy.motion.orientation * Vec3(0, std::clamp(local.y(), -p.half_length, p.half_length), 0);
  local.z() = 0;
  return proxy.motion.orientation *
         Vec3(local / std::max(1.0, fixed::hypot(local.x() / std::max(kLeast, p.half_width),
                                                 local.y() / p.half_length)));
}

ContactGeometry contact_as_ellipsoids(const Proxy& a, const Proxy& b, const Vec3* side, double far) {
  const Ellipsoid of_a = ellipsoid_of(a, kWeights.blade_depth), of_b = ellipsoid_of(b, kWeights.blade_depth);
  const auto width = [](const Proxy& s) { return s.blade ? s.particle.half_width : HUGE_VAL; };
  const double soft = std::max(kLeast, std::min(width(a), width(b))),
               deepest = side ? kWeights.deepest * soft : 0;
  const EllipsoidTouch found = touch(of_a, of_b, std::max(far, deepest));
  ContactGeometry met{found.normal, found.gap, soft, Vec3::Zero(), Vec3::Zero()};
  if (side && met.normal.dot(*side) < 0) {
    const double back = met.gap + 2 * (of_a.reach(met.normal) + of_b.reach(met.normal));
    if (back < deepest) met.normal = -met.normal, met.gap = -back;
  }
  if (met.gap > far) return met;
  // Where two flat things touch wanders across them as they tilt; a blade that bends is pushed over an area.
  const Vec3 at = touch(ellipsoid_of(a, kWeights.round), ellipsoid_of(b, kWeights.round), HUGE_VAL).at;
  met.arm_a = arm_to(a, at), met.arm_b = arm_to(b, at);
  return met;
}

}  // namespace

Outline::Outline(const Proxy& proxy) : centre(proxy.motion.position.cast<float>()), blade(proxy.blade) {
  const Particle& p = proxy.particle;
  const Vec3 halves(p.half_width, p.half_length, thickness_of(proxy, kWeights.blade_depth));
  axes = (proxy.motion.orientation.toRotationMatrix() * halves.asDiagonal()).cast<float>();
}

Eigen::Vector3f Outline::half_box() const {
  if (blade) return axes.rowwise().norm();
  return axes.col(1).cwiseAbs().array() + radius();
}

// Of a blade's ellipsoid or around a stem's capsule.
float Outline::reach(const Eigen::Vector3f& n) const {
  return blade ? (axes.transpose() * n).norm() : std::abs(axes.col(1).dot(n)) + radius();
}

bool Outline::apart(const Outline& other, float gap) const {
  constexpr float kRounding = 1e-5f;  // m
  const Eigen::Vector3f r = centre - other.centre;
  const float enough = gap + kRounding;
  const auto parted_along = [&](const Eigen::Vector3f& n) {
    return std::abs(n.dot(r)) - reach(n) - other.reach(n) > enough;
  };
  if (parted_along(r.stableNormalized())) return true;
  if (blade && parted_along(axes.col(2).stableNormalized())) return true;
  if (other.blade && parted_along(other.axes.col(2).stableNormalized())) return true;
  if (blade || other.blade) return false;
  // Across both: what the closest points of two lines are apart by, at least.
  const Eigen::Vector3f across = axes.col(1).cross(other.axes.col(1));
  const float size = across.norm();
  return size > 0 && std::abs(across.dot(r)) / size - radius() - other.radius() > enough;
}

ContactGeometry narrow_phase(const Proxy& a, const Proxy& b, const Vec3* side, double far) {
  return a.blade || b.blade ? contact_as_ellipsoids(a, b, side, far) : contact_as_capsules(a, b, side);
}

}  // namespace liana
