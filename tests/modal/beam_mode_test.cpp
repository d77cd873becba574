#include "modal/domains/beam_mode.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/base/error.h"
#include "tests/support/closed_forms.h"

namespace liana {
namespace {

/// A straight line of sections along +y with the n-gon's moments and area.
std::vector<Section> polygon_line(int sides, double length, double diameter, int count = 12) {
  std::vector<Section> line;
  const double radius = std::pow(4 * polygon_second_moment(sides, diameter) / kPi, 0.25);
  for (int i = 0; i < count; ++i)
    line.push_back(
        {Vec3(0, length * i / (count - 1), 0), radius, radius, Vec3::UnitZ(), polygon_area(sides, diameter)});
  return line;
}

TEST(BeamMode, MatchesTheClosedFormOfACantilever) {
  // Shear and rotary inertia lower it by about 2 (d / ℓ)²; linear interpolation of mass by (1.875 / 32)²
  // / 12.
  for (const double aspect : {30., 100., 1000.}) {
    const Modes modes = beam_modes(polygon_line(6, 1, 1 / aspect), 0, {}, {});
    EXPECT_TRUE(modes.converged);
    EXPECT_NEAR(modes.frequencies[0] / cantilever_frequency(6, 1, 1 / aspect), 1, 2 / aspect / aspect + 5e-4);
    EXPECT_NEAR(modes.frequencies[1], modes.frequencies[0], 1e-6 * modes.frequencies[0]);
    EXPECT_LT(std::abs(modes.tip_direction[0].y()), 1e-6);
    EXPECT_NEAR(modes.sway.frequencies[0] / modes.frequencies[0], 1, 0.01);
  }
}

TEST(BeamMode, CarriesAMassAtItsTip) {
  const double diameter = 0.01;
  const double mass = ElasticMaterial{}.density * polygon_area(8, diameter);
  for (const double mu : {0.1, 1.0, 10.0}) {
    const CarriedMass tip{Vec3(0, 1, 0), mu * mass};
    const Modes modes = beam_modes(polygon_line(8, 1, diameter), 0, {}, {{tip}});
    EXPECT_NEAR(modes.frequencies[0] / (cantilever_frequency(8, 1, diameter) * tip_mass_ratio(mu)), 1, 1e-3)
        << mu;
  }
}

TEST(BeamMode, BendsTheFlatWayFirst) {
  std::vector<Section> line = polygon_line(8, 1, 0.02);
  for (Section& s : line) s.half_width *= 3, s.area = 0;
  const Modes modes = beam_modes(line, 0, {}, {});
  EXPECT_NEAR(modes.frequencies[1] / modes.frequencies[0], 3, 0.02);
  EXPECT_NEAR(std::abs(modes.tip_direction[0].z()), 1, 1e-6);
  EXPECT_NEAR(std::abs(modes.tip_direction[1].x()), 1, 1e-6);
}

TEST(BeamMode, EndsWhereItHasHeldItsVolume) {
  const std::vector<Section> line = polygon_line(6, 1.2, 0.02);
  const Modes cut = beam_modes(line, 1.0 * polygon_area(6, 0.02), {}, {});
  EXPECT_NEAR(cut.frequencies[0] / cantilever_frequency(6, 1, 0.02), 1, 2e-3);
}

TEST(BeamMode, RefusesALineWithoutSize) {
  std::vector<Section> line = polygon_line(6, 1, 0.02);
  for (Section& s : line) s.half_thickness = 0;
  EXPECT_THROW(beam_modes(line, 0, {}, {}), Error);
  line = polygon_line(6, 0, 0.02);
  EXPECT_THROW(beam_modes(line, 0, {}, {}), Error);
}

}  // namespace
}  // namespace liana
