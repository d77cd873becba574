// What is asked of the surroundings is a pure function of mesh and question, on every processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "mesher/base/hash.h"
#include "mesher/base/parallel.h"
#include "mesher/base/random.h"
#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {
namespace {

/// A ring around the y axis: points on it are as far from 96 triangles at once.
Mesh ring_mesh(double radius, double thickness, uint32_t around, uint32_t across) {
  Mesh mesh;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t j = 0; j < across; ++j) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * j / across, r = radius + thickness * std::cos(v);
      mesh.positions.emplace_back(r * std::cos(u), thickness * std::sin(v), r * std::sin(u));
      const auto at = [&](uint32_t a, uint32_t b) { return a % around * across + b % across; };
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return mesh;
}

/// Around the ring, on its axis, on its corners and edges, and far away.
std::vector<Vec3> questions(const Mesh& mesh) {
  Random random(11, "queries");
  std::vector<Vec3> points;
  for (int i = 0; i < 1500; ++i)
    points.emplace_back(random.uniform(-0.7, 0.7), random.uniform(-0.3, 0.3), random.uniform(-0.7, 0.7));
  for (int i = 0; i < 40; ++i) points.emplace_back(0, 0.02 * (i - 20), 0);
  for (size_t i = 0; i < mesh.positions.size(); i += 7) {
    points.push_back(mesh.positions[i]);
    points.push_back((mesh.positions[i] + mesh.positions[(i + 1) % mesh.positions.size()]) / 2);
  }
  for (int i = 0; i < 40; ++i)
    points.push_back(40 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  return points;
}

/// All that there is to ask at one point.
uint64_t answers(const SdfObstacle& solid, const Vec3& x) {
  const SdfSample field = solid.sample(x);
  const SurfacePoint closest = solid.closest_point(x);
  const Vec3 half(0.03, 0.02, 0.05);
  std::vector<double> numbers{field.distance, closest.distance, double(closest.triangle),
                              solid.least(x, half)};
  for (const Vec3& v : {field.gradient, closest.point, closest.normal})
    numbers.insert(numbers.end(), v.data(), v.data() + 3);
  // Rays at the mesh's own corners and edges, which a rounding more or less meets or misses.
  const std::vector<Vec3>& corners = solid.mesh().positions;
  for (size_t i = 0; i < corners.size(); i += 97)
    for (const Vec3& target : {corners[i], Vec3((corners[i] + corners[i + 1]) / 2)})
      if ((target - x).norm() > 1e-6) numbers.push_back(solid.shades(x, (target - x).normalized()));
  numbers.push_back(solid.shades(x, Vec3::UnitX()));
  return hash_span(std::span<const double>(numbers));
}

class Queries : public testing::TestWithParam<double> {  // thickness of a sheet, m; 0: a solid
 protected:
  const Mesh mesh_ = ring_mesh(0.4, 0.1, 48, 24);
  const std::vector<Vec3> points_ = questions(mesh_);

  SdfObstacle obstacle(const char* device = "threads=1", unsigned threads = 1) const {
    return SdfObstacle(mesh_, {.voxel = 0.02, .sheet = GetParam(), .device = device, .threads = threads});
  }
  std::vector<uint64_t> ask(const SdfObstacle& solid) const {
    std::vector<uint64_t> all;
    for (const Vec3& x : points_) all.push_back(answers(solid, x));
    return all;
  }
};

TEST_P(Queries, HaveTheSameBitsWhateverWasAskedBefore) {
  const std::vector<uint64_t> expected = ask(obstacle());
  for (int turn = 0; turn < 3; ++turn) {
    const SdfObstacle fresh = obstacle("threads=1", 2);
    std::vector<size_t> order(points_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    Random random(static_cast<uint64_t>(turn), "order");
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
    std::vector<uint64_t> found(points_.size());
    parallel_for(order.size(), 2,
                 [&](size_t i, unsigned) { found[order[i]] = answers(fresh, points_[order[i]]); });
    EXPECT_EQ(found, expected) << "order " << turn;
  }
}

TEST_P(Queries, HaveTheSameBitsOnEveryProcessor) {
  const std::vector<uint64_t> expected = ask(obstacle());
  std::vector<const char*> devices{"threads=1,isa=sse2", "threads=2", "threads=1,max_isa=sse4.2"};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx")) devices.push_back("threads=1,isa=avx");
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    devices.push_back("threads=1,isa=avx2");
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    devices.push_back("threads=1,isa=avx512");
#endif
  for (const char* device : devices) EXPECT_EQ(ask(obstacle(device)), expected) << device;
}

TEST_P(Queries, ClosestPointsAndRaysAreThoseOfAllTriangles) {
  const SdfObstacle solid = obstacle();
  const double half = GetParam() / 2;
  for (size_t i = 0; i < points_.size(); i += 5) {
    const Vec3& x = points_[i];
    double nearest = std::numeric_limits<double>::infinity();
    uint32_t first = 0;
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [a, b, c] = solid.mesh().triangles[t];
      const auto& p = solid.mesh().positions;
      const double squared = closest_on_triangle(x, p[a], p[b], p[c]).squared_distance;
      if (squared < nearest) nearest = squared, first = t;
    }
    const SurfacePoint found = solid.closest_point(x);
    EXPECT_EQ(found.triangle, first);
    EXPECT_EQ(std::abs(found.distance), half > 0 ? std::abs(std::sqrt(nearest) - half) : std::sqrt(nearest));
    // From the ring's axis outwards: the ring is met at its height, unless it is passed above or below.
    const Vec3 on_axis(0, x.y(), 0);
    Vec3 out(x.x(), 0, x.z());
    if (out.norm() < 1e-9) continue;
    if (std::abs(x.y()) < 0.095)
      EXPECT_TRUE(solid.shades(on_axis, out.normalized())) << x.transpose();
    else if (std::abs(x.y()) > 0.1)
      EXPECT_FALSE(solid.shades(on_axis, out.normalized())) << x.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(SolidAndSheet, Queries, testing::Values(0.0, 0.01));

}  // namespace
}  // namespace liana
