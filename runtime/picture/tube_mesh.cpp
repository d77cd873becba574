#include "runtime/picture/tube_mesh.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr double kLeastStep = 1e-6;    // m
constexpr double kLeastRadius = 1e-5;  // m, so that normals stay defined

/// A cross-section: centre, the plane's axes, radius and how fast it widens along the tube.
struct Ring {
  Vec3 centre, tangent, side;
  double radius, widening, along;
};

/// Carries `side` from one tangent to the next by the smallest rotation.
Vec3 transported(const Vec3& side, const Vec3& from, const Vec3& to) {
  const Vec3 turned = Quat::FromTwoVectors(from, to) * side;
  return (turned - turned.dot(to) * to).normalized();
}

std::vector<Ring> rings_of(const DrawTube& tube) {
  std::vector<Ring> rings;
  for (size_t i = 0; i < tube.points.size(); ++i) {
    if (!rings.empty() && (tube.points[i] - rings.back().centre).norm() < kLeastStep) continue;
    const double along =
        rings.empty() ? 0 : rings.back().along + (tube.points[i] - rings.back().centre).norm();
    rings.push_back(
        {tube.points[i], Vec3::Zero(), Vec3::Zero(), std::max(tube.radii[i], kLeastRadius), 0, along});
  }
  if (rings.size() < 2) return {};
  const size_t last = rings.size() - 1;
  for (size_t i = 0; i <= last; ++i) {
    const Ring &before = rings[i == 0 ? 0 : i - 1], &after = rings[std::min(i + 1, last)];
    // Directions, not differences, are averaged, so a short step beside a long one keeps its say.
    const Vec3 in = (rings[i].centre - before.centre).normalized(),
               out = (after.centre - rings[i].centre).normalized();
    const Vec3 sum = in + out;
    rings[i].tangent = sum.norm() > 1e-3 ? Vec3(sum.normalized()) : (i == last ? in : out);
    rings[i].widening = (after.radius - before.radius) / (after.along - before.along);
  }
  rings[0].side = rings[0].tangent.unitOrthogonal();
  for (size_t i = 1; i <= last; ++i)
    rings[i].side = transported(rings[i - 1].side, rings[i - 1].tangent, rings[i].tangent);
  return rings;
}

}  // namespace

void append_tube(const DrawTube& tube, int sides, TubeMesh& mesh) {
  require(sides >= 3 && tube.points.size() == tube.radii.size(), "append_tube: bad tube");
  std::vector<Ring> rings = rings_of(tube);
  if (rings.empty()) return;

  // Round tip: one more ring at 45 degrees of a hemisphere, then its pole.
  const Ring end = rings.back();
  const double part = end.radius * std::sqrt(0.5);
  rings.push_back({end.centre + part * end.tangent, end.tangent, end.side, part, -1, end.along + part});

  const auto first = uint32_t(mesh.vertices.size());
  const glm::u8vec4 color = packed_color(tube.color);
  const auto pole = [&](const Vec3& position, const Vec3& normal, double along) {
    mesh.vertices.push_back({to_glm_float(position), to_glm_float(normal), {0, 0, float(along)}, color});
    return uint32_t(mesh.vertices.size() - 1);
  };
  for (const Ring& ring : rings) {
    const Vec3 other = ring.tangent.cross(ring.side);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * kPi * k / sides, c = std::cos(angle), s = std::sin(angle);
      const Vec3 outwards = c * ring.side + s * other;
      mesh.vertices.push_back({to_glm_float(ring.centre + ring.radius * outwards),
                               to_glm_float((outwards - ring.widening * ring.tangent).normalized()),
                               {float(ring.radius * c), float(ring.radius * s), float(ring.along)},
                               color});
    }
  }
  for (size_t i = 0; i + 1 < rings.size(); ++i) {
    for (int k = 0; k < sides; ++k) {
      const uint32_t a = first + uint32_t(i * sides + k), b = first + uint32_t(i * sides + (k + 1) % sides);
      mesh.triangles.push_back({a, b, b + uint32_t(sides)});
      mesh.triangles.push_back({a, b + uint32_t(sides), a + uint32_t(sides)});
    }
  }
  const uint32_t root = pole(rings.front().centre, -rings.front().tangent, 0);
  const uint32_t tip = pole(end.centre + end.radius * end.tangent, end.tangent, end.along + end.radius);
  const uint32_t last = first + uint32_t((rings.size() - 1) * sides);
  for (int k = 0; k < sides; ++k) {
    const uint32_t next = uint32_t(k + 1) % sides;
    mesh.triangles.push_back({root, first + next, first + k});
    mesh.triangles.push_back({tip, last + k, last + next});
  }
}

}  // namespace liana
