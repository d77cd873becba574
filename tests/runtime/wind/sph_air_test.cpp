#include <gtest/gtest.h>

#include <cstring>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "mesher/base/random.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/wind/air/sph_kernels.h"
#include "runtime/wind/air/sph_wind.h"

namespace liana {
namespace {

AirOptions roomy(double spacing = 0.1) {
  AirOptions options;
  options.spacing = spacing;
  options.low = Vec3::Constant(-2), options.high = Vec3::Constant(2);
  options.capacity = 20000;
  return options;
}

/// n³ particles from `corner` on, `spacing` apart.
template <class Velocity>
void fill(SphAir& air, int n, double spacing, const Vec3& corner, const Velocity& velocity) {
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < n; ++z) {
        const Vec3 place = corner + spacing * Vec3(x, y, z);
        ASSERT_TRUE(air.add(place, velocity(place)));
      }
}

size_t nearest(const SphAir& air, const Vec3& place) {
  size_t best = 0;
  for (size_t i = 1; i < air.size(); ++i)
    if ((air.position(i) - place).norm() < (air.position(best) - place).norm()) best = i;
  return best;
}

uint64_t hash_of(const SphAir& air) {
  return hash_bytes(air.states(), air.size() * sizeof(AirState));
}

TEST(SphKernels, WallIntegralsAreThoseOfTheHalfSpace) {
  // Rings about the wall's normal, 400 x 400 of them: the midpoint rule is good to 1e-5 of the value at the
  // wall.
  for (const double d : {0.0, 0.3, 0.7}) {
    WallIntegrals sum = {0, 0, 0};
    const int n = 400;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double z = d + (1 - d) * (i + 0.5) / n, s = (j + 0.5) / n, r = std::hypot(z, s);
        if (r >= 1) continue;
        const double ring = 2 * kPi * s / n * (1 - d) / n;
        sum.density += ring * poly6_factor(1) * std::pow(1 - r * r, 3);
        sum.pressure += ring * spiky_factor(1) * (1 - r) * (1 - r) * z / r;
        sum.viscosity += ring * spiky_factor(1) * (1 - r);
      }
    const WallIntegrals closed = wall_integrals(d);
    EXPECT_NEAR(sum.density, closed.density, 1e-4);
    EXPECT_NEAR(sum.pressure, closed.pressure, 1e-4 * wall_integrals(0).pressure);
    EXPECT_NEAR(sum.viscosity, closed.viscosity, 1e-4 * wall_integrals(0).viscosity);
  }
  EXPECT_NEAR(wall_integrals(0).density, 0.5, 1e-12);
}

TEST(SphAir, ALatticeHasTheRestDensity) {
  SphAir air(roomy());
  fill(air, 9, 0.1, Vec3::Constant(-0.4), [](const Vec3&) { return Vec3(0, 0, 0); });
  air.step(1e-6);
  EXPECT_NEAR(air.density(nearest(air, Vec3::Zero())), 1.3, 1.3e-5);  // sums of 27 floats
}

TEST(SphAir, AWallCountsAsStillAir) {
  // The integral stands for the layers that are missing below: the sums over
  // planes one spacing apart are off by 3 %.
  const AirWalls ground({-2, -2, -2}, {2, 2, 2}, 0.05, 0.2, {}, -0.45, 1);
  SphAir air(roomy(), &ground);
  fill(air, 9, 0.1, Vec3::Constant(-0.4), [](const Vec3&) { return Vec3(0, 0, 0); });
  air.step(1e-6);
  EXPECT_NEAR(air.density(nearest(air, {0, -0.4, 0})), 1.3, 0.03 * 1.3);
}

TEST(SphAir, ConservesItsMomentum) {
  // Pushed together by a fifth, so that it flies apart at about the speed of sound.
  SphAir air(roomy());
  Random random(3, "test");
  const auto jitter = [&](const Vec3&) { return Vec3(random.normal(), random.normal(), random.normal()); };
  fill(air, 14, 0.08, Vec3::Constant(-0.5), jitter);
  const Vec3 before = air.momentum();
  for (int i = 0; i < 20; ++i) air.step(air.longest_step());
  double moving = 0;
  for (size_t i = 0; i < air.size(); ++i) moving += air.particle_mass() * air.velocity(i).norm();
  EXPECT_EQ(air.left(), 0u);
  EXPECT_GT(moving, 2 * air.particle_mass() * double(air.size())) << "it did fly apart";
  EXPECT_LT((air.momentum() - before).norm(), 1e-6 * moving);
}

TEST(SphAir, AShearWaveDecaysAsViscosityTellsIt) {
  // v_x = V sin(kz) decays as exp(-ν k² t). 24 layers, a wave over 16 of them. Müller's Laplacian is short
  // by 1.2 % on this lattice and by (k h)²/56 = 1.1 % for the wave's own curvature (the next moment of the
  // kernel).
  AirOptions options = roomy();
  options.viscosity = 0.13, options.sound_speed = 15;
  SphAir air(options);
  const double k = 2 * kPi / 1.6, nu = options.viscosity / options.rest_density, speed = 0.02;
  fill(air, 24, 0.1, Vec3::Constant(-1.15),
       [&](const Vec3& x) { return Vec3(speed * std::sin(k * x.z()), 0, 0); });
  const double end = 0.4, dt = 0.004;
  for (double t = 0; t < end - 1e-9; t += dt) air.step(dt);
  // Far from the faces of the block: what is missing there reaches √(2 ν t) = 0.28 m inwards.
  double along = 0, all = 0;
  for (size_t i = 0; i < air.size(); ++i) {
    if (air.position(i).cwiseAbs().maxCoeff() > 0.41) continue;
    const double wave = std::sin(k * air.position(i).z());
    along += wave * air.velocity(i).x(), all += wave * wave;
  }
  const double expected = std::exp(-nu * k * k * end);
  EXPECT_NEAR(std::log(along / all / speed) / std::log(expected), 1, 0.04);
}

TEST(SphAir, TwoThreadsAndPlainCodeGiveTheSameBits) {
  uint64_t hashes[4];
  for (int run = 0; run < 4; ++run) {
    AirOptions options = roomy();
    options.threads = run == 1 ? 2 : 1;
    options.portable = run == 2;
    SphAir air(options);
    Random random(5, "test");
    fill(air, 10, 0.09, Vec3::Constant(-0.5),
         [&](const Vec3&) { return Vec3(random.normal(), random.normal(), random.normal()); });
    for (int i = 0; i < 12; ++i) air.step(air.longest_step());
    hashes[run] = hash_of(air);
  }
  EXPECT_EQ(hashes[0], hashes[1]) << "two threads";
  EXPECT_EQ(hashes[0], hashes[2]) << "without AVX2";
  EXPECT_EQ(hashes[0], hashes[3]) << "again";
}

TEST(SphAir, ComesToRestInABoxAtItsLongestStep) {
  std::vector<std::unique_ptr<SdfObstacle>> sides;
  std::vector<const SdfObstacle*> solids;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Vec3 low = Vec3::Constant(-0.3), high = Vec3::Constant(1.3);
      (side == 0 ? high : low)[axis] = side;
      sides.push_back(std::make_unique<SdfObstacle>(box_mesh(low, high), SdfOptions{.voxel = 0.05}));
      solids.push_back(sides.back().get());
    }
  AirOptions options = roomy();
  options.viscosity = 0.005 * 1.3 * options.sound_speed * 0.2;  // SphWindParameters::viscosity_ratio
  const AirWalls walls(options.low, options.high, 0.05, 0.2, solids, {}, 1);
  SphAir air(options, &walls);
  Random random(1, "test");
  fill(air, 10, 0.1, Vec3::Constant(0.05),
       [&](const Vec3&) { return Vec3(random.normal(), random.normal(), random.normal()); });
  for (int i = 0; i < 600; ++i) air.step(air.longest_step());
  double fastest = 0;
  for (size_t i = 0; i < air.size(); ++i) {
    fastest = std::max(fastest, air.velocity(i).norm());
    EXPECT_GT(air.position(i).minCoeff(), 0);
    EXPECT_LT(air.position(i).maxCoeff(), 1);
  }
  EXPECT_EQ(air.size(), 1000u);
  EXPECT_LT(fastest, 0.15) << "of 1.7 m/s at the start";
  EXPECT_EQ(air.limited(), 0u);
}

TEST(SphAir, LosesWhatLeavesItsDomainOrIsNoNumber) {
  SphAir air(roomy());
  EXPECT_TRUE(air.add({1.99, 0, 0}, {10, 0, 0}));
  EXPECT_TRUE(air.add({0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(air.add({2.1, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(air.add({0, std::nan(""), 0}, {0, 0, 0}));
  EXPECT_FALSE(air.add({0, 0, 0}, {0, std::nan(""), 0}));
  for (int i = 0; i < 3; ++i) air.step(air.longest_step());
  EXPECT_EQ(air.size(), 1u);
  EXPECT_EQ(air.left(), 1u);
  AirOptions bad = roomy();
  bad.spacing = 0;
  EXPECT_THROW(SphAir{bad}, Error);
}

SphWindParameters jet() {
  SphWindParameters parameters;
  parameters.low = {-0.5, -1.5, -1.5}, parameters.high = {3.5, 1.5, 1.5};
  parameters.spacing = 0.12;
  EmitterParameters emitter;
  emitter.center = {0, 0, 0}, emitter.direction = {2, 0, 0};
  emitter.speed = 4, emitter.radius = 0.5;
  parameters.emitters = {emitter};
  return parameters;
}

void blow(SphWind& wind, double seconds) {
  for (double t = 0; t < seconds; t += 0.025) wind.step(0.025);
}

TEST(SphWind, BlowsAtItsSpeedAndIsRecycled) {
  SphWindParameters parameters = jet();
  parameters.max_particles = 4000;
  SphWind wind(parameters);
  blow(wind, 3);
  const SphWindReport report = wind.report();
  EXPECT_EQ(report.emitted, report.particles + report.left);
  EXPECT_GT(report.left, 500u) << "it was blown through";
  EXPECT_EQ(report.refused, 0u);
  EXPECT_EQ(report.limited, 0u);
  // The core of the jet: turbulence of 10 %, averaged over places.
  double sum = 0;
  for (int i = 0; i < 10; ++i) sum += wind.velocity({0.5 + 0.15 * i, 0, 0}, 0).x() / 10;
  EXPECT_NEAR(sum, 4, 0.4);
  EXPECT_EQ(wind.velocity({0, 1.4, 1.4}, 0), Vec3::Zero()) << "beside it";
}

TEST(SphWind, IsStoppedByAWall) {
  const SdfObstacle wall(box_mesh({1.5, -1.4, -1.4}, {1.6, 1.4, 1.4}), {.voxel = 0.05});
  const SdfObstacle* solids[] = {&wall};
  SphWind wind(jet(), solids);
  double before = 0;
  for (int i = 0; i < 100; ++i) {
    wind.step(0.025);
    for (size_t k = 0; k < wind.air().size(); ++k) {
      const Vec3 x = wind.air().position(k);
      if (x.tail<2>().cwiseAbs().maxCoeff() < 1.3) {
        EXPECT_LT(x.x(), 1.5 + 0.01);
      }
      before += x.x() > 1 && x.x() < 1.5;
    }
  }
  EXPECT_GT(before, 1000) << "it did blow against it";
  EXPECT_LT(wind.velocity({2.2, 0, 0}, 0).norm(), 1e-9) << "behind the wall";
  EXPECT_GT(wind.velocity({1.35, 0.9, 0}, 0).y(), 0.5) << "it turns aside";
}

TEST(SphWind, IsTheSameForOneAndTwoThreads) {
  uint64_t hash[2];
  for (unsigned threads : {1u, 2u}) {
    SphWindParameters parameters = jet();
    parameters.threads = threads;
    SphWind wind(parameters);
    blow(wind, 1);
    hash[threads - 1] = hash_of(wind.air());
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(SphWind, GustsChangeTheSpeedByTheirShare) {
  EmitterParameters parameters = jet().emitters[0];
  parameters.gust = 0.3, parameters.gust_period = 3;
  const Emitter emitter(parameters, 1);
  double sum = 0, squares = 0;
  const int n = 60000;  // 10 min
  for (int i = 0; i < n; ++i) {
    const double u = emitter.speed_at(0.01 * i) / parameters.speed - 1;
    sum += u / n, squares += u * u / n;
  }
  EXPECT_NEAR(sum, 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares), 0.3, 0.01);
}

}  // namespace
}  // namespace liana
