#include "runtime/picture/smooth_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace liana {

std::vector<Vec3> corner_normals(const Mesh& mesh) {
  const double kSharpest = std::cos(40 * kPi / 180);
  std::vector<Vec3> areas;  // face normals times twice the area
  for (const Triangle& t : mesh.triangles)
    areas.push_back(
        (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]));

  // Corners sorted by position: those of one place stand side by side.
  std::vector<uint32_t> corners(3 * mesh.triangles.size());
  std::iota(corners.begin(), corners.end(), 0u);
  const auto position = [&](uint32_t corner) -> const Vec3& {
    return mesh.positions[mesh.triangles[corner / 3][corner % 3]];
  };
  const auto before = [&](uint32_t a, uint32_t b) {
    const Vec3 &p = position(a), &q = position(b);
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::stable_sort(corners.begin(), corners.end(), before);

  std::vector<Vec3> normals(corners.size(), Vec3::UnitY());
  for (size_t first = 0, last; first < corners.size(); first = last) {
    last = first + 1;
    while (last < corners.size() && position(corners[last]) == position(corners[first])) ++last;
    for (size_t i = first; i < last; ++i) {
      const Vec3 own = areas[corners[i] / 3].normalized();
      Vec3 sum = Vec3::Zero();
      for (size_t j = first; j < last; ++j) {
        const Vec3& other = areas[corners[j] / 3];
        if (other.dot(own) >= kSharpest * other.norm()) sum += other;
      }
      if (sum.norm() > 0) normals[corners[i]] = sum.normalized();
    }
  }
  return normals;
}

}  // namespace liana
