#include "tests/support/solids/skins.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace liana {
namespace {

double distance_to(const SkinTube& tube, const Vec3& p) {
  const Vec3 axis = tube.tip - tube.root;
  const double length = axis.norm(), along = (p - tube.root).dot(axis) / length;
  const double radius = tube.root_radius + along / length * (tube.tip_radius - tube.root_radius);
  const double across = (p - tube.root - along / length * axis).norm() - radius;
  return std::max({across, -along, along - length});
}

/// The union: the least distance, rounded by a polynomial where two are nearer than `blend`.
double value_at(const std::vector<SkinTube>& tubes, const Vec3& p, double blend) {
  double least = 1e30;
  for (const SkinTube& tube : tubes) {
    const double d = distance_to(tube, p);
    const double overlap = blend > 0 ? std::max(blend - std::abs(d - least), 0.0) : 0;
    least = std::min(least, d) - (blend > 0 ? overlap * overlap / (4 * blend) : 0);
  }
  return least;
}

}  // namespace

Mesh make_skin(const std::vector<SkinTube>& tubes, double cell, double blend) {
  Eigen::AlignedBox3d box;
  for (const SkinTube& tube : tubes)
    for (const Vec3& end : {tube.root, tube.tip}) {
      const Vec3 reach = Vec3::Constant(std::max(tube.root_radius, tube.tip_radius) + 2.37 * cell);
      box.extend(end - reach), box.extend(end + reach);
    }
  const Eigen::Array3i count = (box.sizes() / cell).array().ceil().cast<int>() + 1;
  const auto index = [&](int x, int y, int z) { return uint32_t((z * count.y() + y) * count.x() + x); };
  const auto place = [&](uint32_t i) {
    return Vec3(box.min() + cell * Vec3(i % count.x(), i / count.x() % count.y(), i / count.x() / count.y()));
  };
  std::vector<double> value(size_t(count.prod()));
  for (uint32_t i = 0; i < value.size(); ++i) value[i] = value_at(tubes, place(i), blend);

  Mesh mesh;
  std::unordered_map<uint64_t, uint32_t> vertex_on;
  const auto crossing = [&](uint32_t in, uint32_t out) {
    const auto [it, is_new] =
        vertex_on.try_emplace(uint64_t{in} << 32 | out, static_cast<uint32_t>(mesh.positions.size()));
    if (is_new) {
      // Away from the grid's points: no triangle without area.
      const double part = std::clamp(value[in] / (value[in] - value[out]), 0.05, 0.95);
      mesh.positions.push_back(place(in) + part * (place(out) - place(in)));
    }
    return it->second;
  };
  const auto emit = [&](uint32_t a, uint32_t b, uint32_t c, const Vec3& outward) {
    const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
    mesh.triangles.push_back((q - p).cross(r - p).dot(outward) > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  };
  constexpr int kPaths[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};  // Kuhn's tets: 0, ., ., 7
  for (int z = 0; z + 1 < count.z(); ++z)
    for (int y = 0; y + 1 < count.y(); ++y)
      for (int x = 0; x + 1 < count.x(); ++x)
        for (const auto& path : kPaths) {
          std::vector<uint32_t> in, out;
          for (const int corner : {0, path[0], path[1], 7}) {
            const uint32_t i = index(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1));
            (value[i] < 0 ? in : out).push_back(i);
          }
          if (in.empty() || out.empty()) continue;
          const Vec3 outward = place(out[0]) - place(in[0]);
          if (in.size() == 2) {
            const uint32_t a = crossing(in[0], out[0]), b = crossing(in[0], out[1]),
                           c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
            emit(a, b, c, outward), emit(a, c, d, outward);
          } else {
            const bool one_in = in.size() == 1;
            const uint32_t tip = one_in ? in[0] : out[0];
            const std::vector<uint32_t>& base = one_in ? out : in;
            uint32_t v[3];
            for (int k = 0; k < 3; ++k) v[k] = one_in ? crossing(tip, base[k]) : crossing(base[k], tip);
            emit(v[0], v[1], v[2], outward);
          }
        }
  return mesh;
}

}  // namespace liana
