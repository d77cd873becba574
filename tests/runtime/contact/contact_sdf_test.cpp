#include <gtest/gtest.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "mesher/base/error.h"
#include "mesher/base/random.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/obstacles/pieces.h"
#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {
namespace {

const Vec3 kLow(-0.5, 0, -0.1), kHigh(0.7, 1.1, 0.1);

double box_distance(const Vec3& x) {
  const Vec3 q = (x - (kLow + kHigh) / 2).cwiseAbs() - (kHigh - kLow) / 2;
  return q.cwiseMax(0).norm() + std::min(0.0, q.maxCoeff());
}

/// Longitudes and latitudes, poles as fans.
Mesh sphere_mesh(double radius, int parts) {
  Mesh mesh;
  const auto at = [&](int i, int j) {
    return 1 + uint32_t((i - 1) * 2 * parts + (j + 2 * parts) % (2 * parts));
  };
  mesh.positions.emplace_back(0, radius, 0);
  for (int i = 1; i < parts; ++i)
    for (int j = 0; j < 2 * parts; ++j) {
      const double theta = kPi * i / parts, phi = kPi * j / parts;
      mesh.positions.push_back(
          radius * Vec3(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)));
    }
  mesh.positions.emplace_back(0, -radius, 0);
  const uint32_t south = uint32_t(mesh.positions.size()) - 1;
  for (int j = 0; j < 2 * parts; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({south, at(parts - 1, j + 1), at(parts - 1, j)});
    for (int i = 1; i + 1 < parts; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

std::vector<Vec3> points_around(size_t count, double margin) {
  Random random(7, "sdf points");
  std::vector<Vec3> points;
  while (points.size() < count)
    points.push_back(Vec3(random.uniform(kLow.x() - margin, kHigh.x() + margin),
                          random.uniform(kLow.y() - margin, kHigh.y() + margin),
                          random.uniform(kLow.z() - margin, kHigh.z() + margin)));
  return points;
}

TEST(SdfObstacle, MatchesTheBoxWithinATenthOfAVoxelInItsBand) {
  const SdfObstacle box(box_mesh(kLow, kHigh), {.voxel = 0.02, .band = 0.06});
  for (const Vec3& x : points_around(20000, 0.1)) {
    const double exact = box_distance(x);
    if (std::abs(exact) >= box.band()) continue;
    EXPECT_NEAR(box.distance(x), exact, 0.1 * box.voxel()) << x.transpose();
  }
}

TEST(SdfObstacle, BeyondItsBandKeepsSignAndIsALowerBound) {
  const SdfObstacle box(box_mesh({0, 0, 0}, {1, 1, 1}), {.voxel = 0.02, .band = 0.04});
  Random random(3, "far");
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
    const Vec3 q = (x - Vec3::Constant(0.5)).cwiseAbs() - Vec3::Constant(0.5);
    const double exact = q.cwiseMax(0).norm() + std::min(0.0, q.maxCoeff());
    if (std::abs(exact) <= box.band()) continue;
    EXPECT_GT(box.distance(x) * exact, 0);
    // Single precision values near the band's end, of a size of 1 m.
    EXPECT_LE(std::abs(box.distance(x)), std::abs(exact) + 1e-6);
    EXPECT_GE(std::abs(box.distance(x)), box.band() - 0.1 * box.voxel());
  }
}

TEST(SdfObstacle, SignIsRightCloseToEdgesAndCorners) {
  const SdfObstacle box(box_mesh(kLow, kHigh), {.voxel = 0.04});
  Random random(11, "edges");
  for (int i = 0; i < 3000; ++i) {
    Vec3 x(random.uniform() < 0.5 ? kLow.x() : kHigh.x(), random.uniform() < 0.5 ? kLow.y() : kHigh.y(),
           random.uniform() < 0.5 ? kLow.z() : kHigh.z());
    if (i % 2) x.y() = random.uniform(kLow.y(), kHigh.y());
    x += 1e-3 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double exact = box_distance(x);
    if (std::abs(exact) > 1e-7) {
      EXPECT_GT(box.distance(x) * exact, 0) << x.transpose();
    }
    EXPECT_NEAR(box.closest_point(x).distance, exact, 1e-12);
  }
}

TEST(SdfObstacle, MatchesTheSphereWithinItsFacets) {
  const double radius = 0.3;
  const SdfObstacle sphere(sphere_mesh(radius, 48), {.voxel = 0.01, .band = 0.05});
  // A facet's sides are h = πr/48 long: it lies at most h²/4r inside the sphere (h²/8r for each direction).
  const double h = kPi * radius / 48, facets = h * h / (4 * radius);
  Random random(5, "sphere");
  for (int i = 0; i < 5000; ++i) {
    const Vec3 way = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const double exact = random.uniform(-0.045, 0.045);
    const SdfSample found = sphere.sample((radius + exact) * way);
    EXPECT_NEAR(found.distance, exact, facets + 0.1 * sphere.voxel());
    EXPECT_GT(found.gradient.dot(way), 0.98);
  }
}

TEST(SdfObstacle, GradientPointsOutAlongFlatFaces) {
  const SdfObstacle box(box_mesh(kLow, kHigh), {.voxel = 0.04});
  for (double z : {0.095, 0.1, 0.105, 0.12})
    EXPECT_LT((box.sample({0.1, 0.5, z}).gradient - Vec3::UnitZ()).norm(), 1e-3);
}

TEST(SdfObstacle, ClosestPointIsExactFarAway) {
  const SdfObstacle box(box_mesh(kLow, kHigh), {.voxel = 0.04});
  const SurfacePoint found = box.closest_point({30, 0.4, 0.05});
  EXPECT_LT((found.point - Vec3(0.7, 0.4, 0.05)).norm(), 1e-9);
  EXPECT_NEAR(found.distance, 29.3, 1e-9);
}

TEST(SdfObstacle, IsTheSameWithAnyNumberOfThreads) {
  const Mesh mesh = sphere_mesh(0.2, 12);
  const SdfObstacle one(mesh, {.voxel = 0.02, .threads = 1}), three(mesh, {.voxel = 0.02, .threads = 3});
  for (const Vec3& x : points_around(2000, 0)) EXPECT_EQ(one.distance(x), three.distance(x));
}

TEST(SdfObstacle, ShadesWhatIsBehindIt) {
  const SdfObstacle box(box_mesh(kLow, kHigh), {.voxel = 0.04});
  EXPECT_TRUE(box.shades({0, 0.5, -0.3}, Vec3::UnitZ()));
  EXPECT_FALSE(box.shades({0, 0.5, 0.3}, Vec3::UnitZ()));
}

TEST(SdfObstacle, LeavesTheFloatingPointModeAlone) {
#if defined(__SSE2__)
  // Bits 0-5 only note what happened; the rest are modes.
  const unsigned before = _mm_getcsr() & ~0x3fu;
  const SdfObstacle box(box_mesh(kLow, kHigh), {.voxel = 0.04, .threads = 1});
  box.closest_point({1, 2, 3});
  box.shades({1, 2, 3}, Vec3::UnitX());
  EXPECT_EQ(_mm_getcsr() & ~0x3fu, before);
#else
  GTEST_SKIP() << "no SSE control register here";
#endif
}

TEST(SdfObstacle, OfAScaledAndTurnedBoxIsItsAnalyticDistance) {
  // 1 m cubes scaled to (0.3, 1, 0.05), turned, moved; then moved again as an obstacle that moves.
  const Vec3 size(0.3, 1, 0.05);
  const Affine3 affine = Eigen::Translation3d(0.2, -0.1, 0.4) *
                         Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()) * Eigen::Scaling(size);
  Mesh mesh = box_mesh(Vec3::Constant(-0.5), Vec3::Constant(0.5));
  for (Vec3& p : mesh.positions) p = affine * p;
  SdfObstacle box(mesh, {.voxel = 0.01, .band = 0.05});
  ObstaclePose pose;
  pose.rotation = Quat(Eigen::AngleAxisd(-1.1, Vec3(0.3, 1, 0).normalized()));
  pose.position = {1, 2, 3};
  box.place(pose);
  Random random(9, "affine");
  for (int i = 0; i < 5000; ++i) {
    const Vec3 local = 0.5 * size + Vec3::Constant(0.1);
    const Vec3 in_box(random.uniform(-local.x(), local.x()), random.uniform(-local.y(), local.y()),
                      random.uniform(-local.z(), local.z()));
    const Vec3 q = in_box.cwiseAbs() - size / 2;
    const double exact = q.cwiseMax(0).norm() + std::min(0.0, q.maxCoeff());
    const Vec3 x = pose.rotation * (affine * in_box.cwiseQuotient(size)) + pose.position;
    const SdfSample found = box.sample(x);
    EXPECT_NEAR(box.closest_point(x).distance, exact, 1e-9);
    if (std::abs(exact) < box.band()) {
      EXPECT_NEAR(found.distance, exact, 0.1 * box.voxel());
      EXPECT_NEAR(found.gradient.norm(), 1, 1e-9);
    } else {
      EXPECT_LE(std::abs(found.distance), std::abs(exact) + 0.1 * box.voxel());
    }
    EXPECT_TRUE((x.array() >= box.low().array() - 0.3).all());
    if (exact < 0) {
      EXPECT_TRUE((x.array() >= box.low().array() - 1e-9).all() &&
                  (x.array() <= box.high().array() + 1e-9).all());
    }
  }
}

TEST(SdfObstacle, AnOpenSheetHasTheThicknessItIsGiven) {
  Mesh sheet;  // 1 m square in the plane z = 0
  sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const SdfObstacle obstacle(sheet, {.sheet = 0.006});
  for (const double z : {-0.02, -0.004, 0.001, 0.0035, 0.03}) {
    const SdfSample found = obstacle.sample({0.4, 0.3, z});
    EXPECT_NEAR(found.distance, std::abs(z) - 0.003, 2e-4) << z;
    EXPECT_NEAR(found.gradient.z(), z > 0 ? 1 : -1, 1e-3) << z;
  }
  EXPECT_NEAR(obstacle.distance({1.01, 0.5, 0}), 0.007, 2e-4) << "rounded at its rim";
}

TEST(Shells, ClosedPiecesAreSolidAndOpenOnesSheets) {
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  const auto add = [&](const Mesh& more) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const Triangle& t : more.triangles)
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  };
  add(box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}));  // overlaps the first
  Mesh open = box_mesh({3, 0, 0}, {4, 1, 1});
  open.triangles.pop_back();
  add(open);
  const Pieces pieces = pieces_of(mesh);
  ASSERT_EQ(pieces.solids.size(), 2u);
  EXPECT_EQ(pieces.sheet_count, 1u);
  double nearest = 1;
  for (const Mesh& solid : pieces.solids)
    nearest = std::min(nearest, SdfObstacle(solid).closest_point({0.75, 0.75, 0.75}).distance);
  EXPECT_NEAR(nearest, -0.25, 1e-9);
  const SdfObstacle hollow(pieces.sheets, {.sheet = 0.01});
  EXPECT_GT(hollow.distance({3.5, 0.5, 0.5}), 0) << "an open box is hollow";
}

TEST(SdfObstacle, FindsItsResolutionFromItsThinnestParts) {
  // A 1 cm bar of 2 m; a 2 m block.
  EXPECT_LT(geometric_voxel(box_mesh({0, 0, 0}, {2, 0.01, 0.01}), 0), 0.005);
  EXPECT_GT(geometric_voxel(box_mesh({0, 0, 0}, {2, 2, 2}), 0), 0.01);
}

std::string refusal(const Mesh& mesh) {
  try {
    SdfObstacle obstacle(mesh);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SdfObstacle, RefusesSurfacesWithoutAnInside) {
  Mesh open = box_mesh(kLow, kHigh);
  open.triangles.pop_back();
  EXPECT_NE(refusal(open).find("not closed: 3 of"), std::string::npos) << refusal(open);

  Mesh inside_out = box_mesh(kLow, kHigh);
  for (Triangle& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_NE(refusal(inside_out).find("inside out"), std::string::npos) << refusal(inside_out);

  EXPECT_NE(refusal({}).find("no triangles"), std::string::npos);
  Mesh broken = box_mesh(kLow, kHigh);
  broken.positions[3].x() = std::nan("");
  EXPECT_NE(refusal(broken).find("not a finite point"), std::string::npos);
  EXPECT_THROW(box_mesh(kHigh, kLow), Error);
}

TEST(SdfObstacle, RefusesVoxelsThatWouldNotFit) {
  EXPECT_THROW(SdfObstacle(box_mesh(kLow, kHigh), {.voxel = 1e-5}), Error);
}

}  // namespace
}  // namespace liana
