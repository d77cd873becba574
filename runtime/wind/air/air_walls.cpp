#include "runtime/wind/air/air_walls.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/parallel.h"

namespace liana {

namespace {

/// Beyond the band an obstacle's value is a bound: it is asked exactly only where that could matter.
double distance_below(const SdfObstacle& obstacle, const Vec3& x, double least) {
  const double d = obstacle.distance(x);
  return d < least && std::abs(d) >= obstacle.band() ? obstacle.closest_point(x).distance : d;
}

}  // namespace

AirWalls::AirWalls(const Vec3& low, const Vec3& high, double spacing, double reach,
                   std::span<const SdfObstacle* const> obstacles, std::optional<double> ground_height,
                   unsigned threads)
    : low_(low), spacing_(static_cast<float>(spacing)) {
  if (obstacles.empty() && !ground_height) return;
  fill(high, spacing, reach, threads, [&](const Vec3& x) {
    double nearest = ground_height ? x.y() - *ground_height : reach;
    for (const SdfObstacle* obstacle : obstacles)
      nearest = std::min(nearest, distance_below(*obstacle, x, std::min(reach, nearest)));
    return nearest;
  });
}

AirWalls::AirWalls(const SdfObstacle& obstacle, double spacing, double reach, unsigned threads)
    : spacing_(static_cast<float>(spacing)) {
  Vec3 high = obstacle.mesh().positions.front();
  const double half_sheet = -obstacle.closest_point(obstacle.to_world(high)).distance;  // 0 of a solid
  low_ = high;
  for (const Vec3& p : obstacle.mesh().positions) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
  low_.array() -= reach + half_sheet, high.array() += reach + half_sheet;
  fill(high, spacing, reach, threads,
       [&](const Vec3& x) { return distance_below(obstacle, obstacle.to_world(x), reach); });
}

template <class Distance>
void AirWalls::fill(const Vec3& high, double spacing, double reach, unsigned threads,
                    const Distance& distance) {
  for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(std::ceil((high[k] - low_[k]) / spacing)) + 2;
  values_.resize(size_t(size_[0]) * size_[1] * size_[2]);
  parallel_for(
      size_t(size_[1]) * size_[2], threads,
      [&](size_t row, unsigned) {
        for (int i = 0; i < size_[0]; ++i) {
          const Vec3 x = low_ + spacing * Vec3(i, double(row % size_[1]), double(row / size_[1]));
          values_[row * size_[0] + i] = static_cast<float>(std::clamp(distance(x), -reach, reach));
        }
      },
      16);
}

AirWalls::Sample AirWalls::sample(float x, float y, float z) const {
  const float place[3] = {x / spacing_, y / spacing_, z / spacing_};
  int cell[3];
  float t[3];
  for (int k = 0; k < 3; ++k) {
    const float inside = std::clamp(place[k], 0.0f, static_cast<float>(size_[k] - 1) - 1e-3f);
    cell[k] = static_cast<int>(inside);
    t[k] = inside - static_cast<float>(cell[k]);
  }
  const float* v = &values_[cell[0] + size_t(size_[0]) * (cell[1] + size_t(size_[1]) * cell[2])];
  const size_t up = size_[0], far = size_t(size_[0]) * size_[1];
  const auto mix = [](float a, float b, float s) { return a + s * (b - a); };
  // Along x first, on the four edges; then y, then z.
  const float e00 = mix(v[0], v[1], t[0]), e10 = mix(v[up], v[up + 1], t[0]);
  const float e01 = mix(v[far], v[far + 1], t[0]), e11 = mix(v[far + up], v[far + up + 1], t[0]);
  const float gx = mix(mix(v[1] - v[0], v[up + 1] - v[up], t[1]),
                       mix(v[far + 1] - v[far], v[far + up + 1] - v[far + up], t[1]), t[2]);
  const float gy = mix(e10 - e00, e11 - e01, t[2]);
  const float f0 = mix(e00, e10, t[1]), f1 = mix(e01, e11, t[1]);
  const float gz = f1 - f0;
  const float length = std::sqrt(gx * gx + gy * gy + gz * gz);
  const float scale = length > 1e-6f ? 1 / length : 0;
  return {mix(f0, f1, t[2]), gx * scale, gy * scale, gz * scale};
}

}  // namespace liana
