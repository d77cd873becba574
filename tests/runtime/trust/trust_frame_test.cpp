// A whole tree and a bent rod against independent mechanics: beam finite elements, and the elastica.
#include <gtest/gtest.h>

#include <array>

#include "runtime/sim/check/particle_modes.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/step/time_step.h"
#include "tests/support/plants/frame_beams.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

// A trunk that forks into two unequal branches, out of one plane: bending and twist couple.
test::Frame forked_frame(int elements) {
  const Vec3 fork(0, 1, 0);
  return {
      {Vec3::Zero(), fork, fork + 0.8 * Vec3(0.6, 0.8, 0), fork + 0.6 * Vec3(-0.3, 0.6, 0.742).normalized()},
      {{0, 1, elements, 0.02}, {1, 2, elements, 0.015}, {1, 3, elements, 0.012}},
      8.77e9,
      0.3,
      745};
}

// The same as particles with their physical stiffness, `count` to a branch. A joint stands for the rod
// between the middles of its two particles; at the fork the trunk's last half particle is a particle of its
// own, cut short, so that both branches share its bending.
Plant forked_plant(const test::Frame& frame, int count) {
  Plant plant;
  ParticleId trunk_end;
  for (const test::FrameBeam& beam : frame.beams) {
    const Vec3 from = frame.nodes[static_cast<size_t>(beam.from)],
               along = frame.nodes[static_cast<size_t>(beam.to)] - from;
    const Quat orientation = Quat::FromTwoVectors(Vec3::UnitY(), along);
    const RodSection section =
        rod_section(frame.youngs_modulus, frame.poisson_ratio, beam.radius, beam.radius, 1);
    const bool trunk = beam.from == 0;
    const double step = along.norm() / count;
    std::vector<double> lengths(static_cast<size_t>(count), step);
    if (trunk) lengths.back() = 0.99 * step, lengths.push_back(0.01 * step);
    Branch branch;
    ParticleId parent = trunk ? ParticleId() : trunk_end;
    double way = 0, before = 0;  // before: what of the parent the joint stands for
    for (const double length : lengths) {
      const bool first = way == 0;
      Particle p;
      p.parent = parent;
      p.branch = BranchId(plant.branches.size());
      p.half_length = length / 2;
      p.half_width = p.half_thickness = beam.radius;
      p.mass = frame.density * kPi * beam.radius * beam.radius * length;
      p.inertia = rod_inertia(p.mass, length / 2, beam.radius, beam.radius);
      if (parent.valid()) {
        p.joint.on_parent = {0, plant.particles[parent.index()].half_length, 0};
        p.joint.rest =
            first ? plant.motion[parent.index()].orientation.conjugate() * orientation : Quat::Identity();
      }
      p.joint.on_self = {0, -length / 2, 0};
      set_section(p.joint, section, before + length / 2);
      before = length / 2;
      parent = ParticleId(plant.particles.size());
      branch.particles.push_back(parent);
      plant.particles.push_back(p);
      plant.motion.push_back(
          {.position = from + (way + length / 2) * along.normalized(), .orientation = orientation});
      way += length;
    }
    if (trunk) trunk_end = parent;
    plant.branches.push_back(std::move(branch));
  }
  return plant;
}

TEST(WholePlantModes, BeamElementsConverge) {
  const std::vector<double> coarse = test::frame_frequencies(forked_frame(8), 10),
                            fine = test::frame_frequencies(forked_frame(16), 10);
  for (size_t i = 0; i < 10; ++i) EXPECT_NEAR(coarse[i], fine[i], 3e-4 * fine[i]);
  // One beam alone: 1.8751² / (2π) √(EI/ρA) / L², less 0.03 % of shear and rotary inertia at r/L = 0.02.
  const test::Frame cantilever{{Vec3::Zero(), Vec3(0.6, 0.8, 0)}, {{0, 1, 8, 0.02}}, 8.77e9, 0.3, 745};
  const double closed = 1.8751 * 1.8751 / (2 * kPi) * std::sqrt(8.77e9 / 745) * 0.02 / 2;
  EXPECT_NEAR(test::frame_frequencies(cantilever, 1)[0], closed, 1e-3 * closed);
}

// Chains of rigid segments converge with the square of their number: 20 are within 0.5 % in the tenth mode.
TEST(WholePlantModes, FirstTenOfAForkedTreeAreThoseOfBeams) {
  const test::Frame frame = forked_frame(16);
  const std::vector<double> beams = test::frame_frequencies(frame, 10);
  for (const int count : {20, 40}) {
    const ParticleModes modes = particle_modes(forked_plant(frame, count), 10);
    ASSERT_TRUE(modes.converged);
    double worst = 0;
    for (size_t i = 0; i < 10; ++i) worst = std::max(worst, std::abs(modes.frequencies[i] / beams[i] - 1));
    RecordProperty("worst_of_" + std::to_string(count), std::to_string(worst));
    EXPECT_LT(worst, count == 20 ? 0.01 : 0.0025) << count << " particles a branch";
  }
}

// The stepped motion, not only the matrices: let go in its lowest mode, the tree swings at the beams'
// frequency.
TEST(WholePlantModes, SteppedTreeSwingsAtTheLowestOfThem) {
  const test::Frame frame = forked_frame(16);
  Plant plant = forked_plant(frame, 12);
  const ParticleModes modes = particle_modes(plant, 1);
  const double wanted = test::frame_frequencies(frame, 1)[0], dt = 0.01 / wanted;
  plant.scheme = {.dt = dt, .rho_infinity = 1};
  for (size_t i = 0; i < plant.motion.size(); ++i)
    plant.motion[i].velocity = 1e-4 * modes.shapes[0][i].head<3>();
  for (size_t i = 0; i < plant.motion.size(); ++i)
    plant.motion[i].angular_velocity = 1e-4 * modes.shapes[0][i].tail<3>();
  const Vec3 start = plant.motion.back().position, direction = plant.motion.back().velocity.normalized();
  PlantStepper stepper;
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int i = 1; crossings < 9; ++i) {
    ASSERT_LT(i, 1000);
    stepper.step(plant, {}, {}, {.dt = dt, .gravity = Vec3::Zero()});
    const double x = direction.dot(plant.motion.back().position - start);
    if (before * x < 0) {
      last = (i - x / (x - before)) * dt;
      if (crossings++ == 0) first = last;
    }
    before = x;
  }
  // A hundred steps a swing warp it by (ωh)²/12 = 0.03 %; 12 particles a branch by 0.2 %.
  EXPECT_NEAR(8 / (2 * (last - first)), wanted, 0.005 * wanted);
}

// A rod clamped level that sags under its own weight: EI θ'' = −w (L − s) cos θ, θ(0) = 0, θ'(L) = 0, by
// Runge-Kutta and shooting. Returns the tip (along, down) in lengths for w L³/EI.
std::array<double, 2> elastica_tip(double load) {
  constexpr int kSteps = 2000;
  const auto shoot = [&](double curvature, std::array<double, 2>& tip) {
    const double h = 1.0 / kSteps;
    double angle = 0, k = curvature;
    tip = {0, 0};
    const auto bend = [&](double s, double a) { return -load * (1 - s) * std::cos(a); };
    for (int i = 0; i < kSteps; ++i) {
      const double s = i * h;
      const double k1 = bend(s, angle), a1 = k;
      const double k2 = bend(s + h / 2, angle + h / 2 * a1), a2 = k + h / 2 * k1;
      const double k3 = bend(s + h / 2, angle + h / 2 * a2), a3 = k + h / 2 * k2;
      const double k4 = bend(s + h, angle + h * a3), a4 = k + h * k3;
      const double next = angle + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4), middle = (angle + next) / 2;
      tip[0] += h * (std::cos(angle) + 4 * std::cos(middle) + std::cos(next)) / 6;
      tip[1] += h * (std::sin(angle) + 4 * std::sin(middle) + std::sin(next)) / 6;
      angle = next;
      k += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return k;  // at the tip: zero for the right one
  };
  std::array<double, 2> tip{};
  double low = 0, high = load;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (shoot(middle, tip) < 0 ? low : high) = middle;
  }
  return tip;
}

TEST(StaticSag, ElasticaOfASmallLoadIsTheBeamFormula) {
  EXPECT_NEAR(elastica_tip(0.01)[1], 0.01 / 8, 1e-6);  // w L⁴ / 8 EI
}

TEST(StaticSag, CantileverUnderItsWeightTakesTheShapeOfTheElastica) {
  for (const double load : {0.5, 5.0, 20.0}) {  // w L³/EI: the tip sags by 6 %, 47 % and 76 % of the length
    constexpr int kCount = 40;
    constexpr double kRadius = 0.01, kDensity = 745;
    const double area = kPi * kRadius * kRadius, I = area * kRadius * kRadius / 4;
    const double E = kDensity * area * 9.81 / (I * load);  // L = 1 m
    Plant plant = test::rod_plant({.radius = kRadius, .youngs_modulus = E, .density = kDensity}, kCount);
    const Quat level(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()));  // y to x
    plant.particles[0].joint.rest = level;
    for (Motion& m : plant.motion) {
      m.position = level * m.position;
      m.orientation = level;
    }
    for (Particle& p : plant.particles) p.mass_damping = 6;  // 1/s: near critical for the lowest mode
    PlantStepper stepper;
    int steps = 0;
    for (double speed = 1; speed > 1e-7 && steps < 4000; ++steps) {
      ASSERT_TRUE(stepper.step(plant, {}, {}, {}).finite);
      if (steps > 40) speed = plant.motion.back().velocity.norm();
    }
    const Motion& last = plant.motion.back();
    const Vec3 tip = last.position + last.orientation * Vec3(0, 0.5 / kCount, 0);
    const auto [along, down] = elastica_tip(load);
    RecordProperty("sag_error_at_" + std::to_string(load), std::to_string(-tip.y() / down - 1));
    EXPECT_NEAR(tip.x(), along, 0.01 * along) << "load " << load;
    EXPECT_NEAR(-tip.y(), down, 0.01 * down) << "load " << load;
  }
}

}  // namespace
}  // namespace liana
