#include <gtest/gtest.h>

#include "mesher/base/error.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/step/time_step.h"
#include "runtime/wind/field/sheltered_wind.h"
#include "runtime/wind/field/steady_gust_wind.h"
#include "runtime/wind/field/wind_forces.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

class EvenWind : public WindField {
 public:
  explicit EvenWind(const Vec3& velocity) : velocity_(velocity) {}
  Vec3 velocity(const Vec3&, double) const override { return velocity_; }

 private:
  Vec3 velocity_;
};

/// A free blade of 5 × 4 cm, 0.3 mm, facing +Z.
Plant loose_leaf(double mass) {
  Plant plant;
  plant.branches.resize(1);
  plant.branches[0].kind = DomainKind::Leaf;
  plant.branches[0].particles = {ParticleId(0)};
  Particle leaf;
  leaf.branch = BranchId(0);
  leaf.half_length = 0.025, leaf.half_width = 0.02, leaf.half_thickness = 1.5e-4;
  leaf.mass = mass;
  leaf.inertia = rod_inertia(mass, 0.025, 0.02, 1.5e-4);
  plant.particles = {leaf};
  plant.motion.resize(1);
  return plant;
}

Vec3 drag(const Plant& plant, const Vec3& wind) {
  std::vector<WorldSpring> springs;
  add_wind(plant, EvenWind(wind), 0, {}, springs);
  return springs.empty() ? Vec3::Zero()
                         : Vec3(springs[0].damping * (springs[0].target_velocity - plant.motion[0].velocity));
}

TEST(WindForces, ProjectedAreaIsThatOfTheEllipsoid) {
  const Plant plant = loose_leaf(3e-4);
  const Particle& leaf = plant.particles[0];
  EXPECT_NEAR(projected_area(leaf, Vec3::UnitZ()), kPi * 0.025 * 0.02, 1e-12);
  EXPECT_NEAR(projected_area(leaf, Vec3::UnitY()), kPi * 0.02 * 1.5e-4, 1e-12);
}

TEST(WindForces, DragIsQuadraticThenLinearOnceTheBladeFolds) {
  const Plant plant = loose_leaf(3e-4);
  const DragOptions options;
  const double area = kPi * 0.025 * 0.02;
  EXPECT_NEAR(drag(plant, {0, 0, 2}).z(), 1.2 / 2 * options.leaf_coefficient * area * 4, 1e-12);
  EXPECT_NEAR(drag(plant, {0, 0, -2}).z(), -drag(plant, {0, 0, 2}).z(), 1e-15);
  EXPECT_NEAR(drag(plant, {0, 0, 3}).z() / drag(plant, {0, 0, 1.5}).z(), 4, 1e-9);
  EXPECT_NEAR(drag(plant, {0, 0, 16}).z() / drag(plant, {0, 0, 8}).z(), 2, 1e-9);
}

TEST(WindForces, ReconfigurationFollowsVogelsExponent) {
  const Plant plant = loose_leaf(3e-4);
  for (const double exponent : {-1.0, -0.5, 0.0}) {
    DragOptions options;
    options.leaf_vogel_exponent = exponent;
    const double slow = drag_factor(plant, ParticleId(0), {0, 0, 8}, options) * 8,
                 fast = drag_factor(plant, ParticleId(0), {0, 0, 16}, options) * 16;
    EXPECT_NEAR(std::log2(fast / slow), 2 + exponent, 1e-9);
  }
}

TEST(WindForces, LivelinessIsTheReciprocalOfMassScaling) {
  // [Wang17] §3.2: at a given frequency a rod of α_m times the mass is α_m times as stiff (Eq. 10), so the
  // same wind bends it 1/α_m as far. The wind's force is the same; by 5 % of 0.02 m / 1 m its own bending
  // changes that.
  double bend[2];
  for (int i = 0; i < 2; ++i) {
    Bake bake = test::rod_bake({.length = 1, .radius = 0.01, .frequency = 3, .damping_factor = 0.3});
    const double scaling = i == 0 ? 1 : 3;
    BakedDomain& rod = bake.domains[0];
    rod.mass *= scaling, rod.density *= scaling, rod.youngs_modulus *= scaling;
    rod.material.mass_scaling = scaling;
    Plant plant = make_plant(bake);
    const Vec3 tip = plant.motion.back().position;
    PlantStepper stepper;
    std::vector<WorldSpring> springs;
    for (int step = 0; step < 400; ++step) {
      springs.clear();
      add_wind(plant, EvenWind({8, 0, 0}), 0, {}, springs);
      stepper.step(plant, {}, springs, {});
    }
    bend[i] = (plant.motion.back().position - tip).x();
  }
  EXPECT_GT(bend[1], 1e-4);
  EXPECT_NEAR(bend[0] / bend[1], 3, 0.06);
}

TEST(WindForces, MassScalingDividesTheAcceleration) {
  // [Wang17] Eq. 3: α_m times the mass, 1/α_m times the acceleration by the same wind. A heavy blade, so that
  // its own motion changes the drag by less than 0.1 % within the step.
  double speed[2];
  for (int i = 0; i < 2; ++i) {
    Plant plant = loose_leaf(i == 0 ? 1.0 : 2.5);
    std::vector<WorldSpring> springs;
    add_wind(plant, EvenWind({0, 0, 2}), 0, {}, springs);
    StepOptions options;
    options.gravity = Vec3::Zero();
    PlantStepper().step(plant, {}, springs, options);
    speed[i] = plant.motion[0].velocity.z();
  }
  EXPECT_NEAR(speed[0] / speed[1], 2.5, 2.5e-3);
}

TEST(WindForces, TheLightestLeafNeverOvertakesTheWind) {
  Plant plant = loose_leaf(1e-6);
  PlantStepper stepper;
  StepOptions options;
  options.gravity = Vec3::Zero();
  for (int i = 0; i < 100; ++i) {
    std::vector<WorldSpring> springs;
    add_wind(plant, EvenWind({0, 0, 10}), 0, {}, springs);
    stepper.step(plant, {}, springs, options);
    // Generalized-α carries α_m of the last acceleration on: a twentieth, once.
    EXPECT_LT(plant.motion[0].velocity.z(), 10 * 1.06);
    EXPECT_GT(plant.motion[0].velocity.z(), 0);
  }
  EXPECT_NEAR(plant.motion[0].velocity.z(), 10, 0.5);
}

TEST(SteadyGustWind, HasItsMeanAndItsIntensity) {
  GustParameters parameters;
  parameters.mean = {3, 0, 1};
  parameters.intensity = 0.3;
  const SteadyGustWind wind(parameters);
  Vec3 sum = Vec3::Zero();
  double squares = 0;
  const Vec3 along = parameters.mean.normalized();
  const int count = 40000;  // an hour in steps of 0.1 s: some hundred periods of the slowest gust
  for (int i = 0; i < count; ++i) {
    const Vec3 u = wind.velocity({0.3, 1, -2}, 0.1 * i);
    sum += u;
    squares += std::pow((u - parameters.mean).dot(along), 2);
  }
  EXPECT_LT((sum / count - parameters.mean).norm(), 0.02 * parameters.mean.norm());
  // Frequencies are distinct, so their variances add; what is left of the cross terms is of the order of 1 /
  // periods.
  EXPECT_NEAR(std::sqrt(squares / count), 0.3 * parameters.mean.norm(), 0.05 * 0.3 * parameters.mean.norm());
}

TEST(SteadyGustWind, CarriesItsGustsAlong) {
  const SteadyGustWind wind;
  const Vec3 mean = GustParameters().mean, place(0.2, 1, 0.4);
  for (double time : {0.0, 3.0, 11.0})
    EXPECT_LT((wind.velocity(place, time) - wind.velocity(place + 2.5 * mean, time + 2.5)).norm(),
              1e-5);  // single precision
}

TEST(SteadyGustWind, IsSmoothAndDependsOnItsSeed) {
  GustParameters other;
  other.seed = 2;
  const SteadyGustWind wind, again, different(other);
  double change = 0, jump = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = wind.velocity({0, 1, 0}, 0.01 * i), b = wind.velocity({0, 1, 0}, 0.01 * i + 1e-6);
    jump = std::max(jump, (a - b).norm());
    change = std::max(change, (a - different.velocity({0, 1, 0}, 0.01 * i)).norm());
    EXPECT_EQ(a, again.velocity({0, 1, 0}, 0.01 * i));
  }
  EXPECT_LT(jump, 1e-4) << "m/s within a microsecond";
  EXPECT_GT(change, 0.1) << "m/s";
}

TEST(SteadyGustWind, RefusesNonsense) {
  GustParameters parameters;
  parameters.low_frequency = -1;
  EXPECT_THROW(SteadyGustWind{parameters}, Error);
  parameters = {};
  parameters.mean.x() = std::nan("");
  EXPECT_THROW(SteadyGustWind{parameters}, Error);
}

TEST(ShelteredWind, DiesDownAtAWallAndDoesNotBlowThroughIt) {
  const EvenWind open({2, 0, -3});
  const SdfObstacle wall(box_mesh({-2, -1, -0.2}, {2, 4, 0}));
  const ShelteredWind wind(open, {&wall}, 0.0);
  EXPECT_LT(wind.velocity({0, 2, 0}, 0).norm(), 1e-6);
  const Vec3 near = wind.velocity({0, 2, 0.03}, 0);
  EXPECT_GT(near.x(), 0.3);
  EXPECT_LT(near.x(), 2);
  EXPECT_LT(std::abs(near.z()), 0.2);
  EXPECT_EQ(wind.velocity({0, 2, 1}, 0), Vec3(2, 0, -3)) << "far from it";
  for (double d = 0.01; d < 0.29; d += 0.01)
    EXPECT_GT(wind.velocity({0, 2, d + 0.01}, 0).norm(), wind.velocity({0, 2, d}, 0).norm());
}

TEST(ShelteredWind, FollowsAWallThatMovesAndIsTakenAlongByIt) {
  const EvenWind open({2, 0, -3});
  SdfObstacle wall(box_mesh({-2, -1, -0.2}, {2, 4, 0}));
  const ShelteredWind wind(open, {&wall}, {});
  const Vec3 before = wind.velocity({0, 2, 0.03}, 0);
  wall.place({.position = {0, 0, 1}, .centre = {0, 0, 1}});
  EXPECT_LT(wind.velocity({0, 2, 0.9}, 0).norm(), 1e-6) << "inside now";
  EXPECT_LT((wind.velocity({0, 2, 1.03}, 0) - before).norm(), 1e-6);
  // Galilei: wind and wall with a velocity more give that velocity more.
  const Vec3 more(0.5, 1, 2), faster_wind = Vec3(2, 0, -3) + more;
  const EvenWind faster(faster_wind);
  const ShelteredWind moved(faster, {&wall}, {});
  wall.place({.position = {0, 0, 1}, .centre = {0, 0, 1}, .velocity = more});
  EXPECT_LT((moved.velocity({0, 2, 1.03}, 0) - before - more).norm(), 1e-6);
  EXPECT_LT((moved.velocity({0, 2, 0.99}, 0) - more).norm(), 1e-6) << "no slip";
  EXPECT_LT((moved.velocity({0, 2, 3}, 0) - faster_wind).norm(), 1e-12) << "far from it";
}

}  // namespace
}  // namespace liana
