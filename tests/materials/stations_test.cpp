#include "materials/pipeline/stations.h"

#include <gtest/gtest.h>

#include <cmath>

namespace liana {
namespace {

const std::vector<Section> kStraight = {{Vec3(0, 0, 0), 0.04, 0.01, Vec3::UnitZ()},
                                        {Vec3(0, 1, 0), 0.02, 0.005, Vec3::UnitZ()}};

TEST(FlatNormal, IsTheSoftDirectionMadePerpendicular) {
  const Vec3 normal = flat_normal(kStraight, Vec3(0, 0.6, -0.8));
  EXPECT_NEAR((normal - Vec3::UnitZ()).norm(), 0, 1e-15);
}

// An eigenvector has no sign of its own.
TEST(FlatNormal, DoesNotDependOnTheSignOfTheMode) {
  const Vec3 soft = Vec3(0.3, 0.1, -0.9).normalized();
  EXPECT_EQ(flat_normal(kStraight, soft), flat_normal(kStraight, -soft));
}

TEST(FlatNormal, FallsBackToTheThinAxisForMotionAlongTheDomain) {
  EXPECT_NEAR((flat_normal(kStraight, Vec3::UnitY()) - Vec3::UnitZ()).norm(), 0, 1e-15);
}

TEST(Stations, KeepHalfAxesAlongTheThinAxis) {
  const std::vector<Station> result = stations(kStraight, Vec3::UnitZ());
  ASSERT_EQ(result.size(), 2u);
  EXPECT_DOUBLE_EQ(result[0].half_width, 0.04);
  EXPECT_DOUBLE_EQ(result[0].half_thickness, 0.01);
  EXPECT_EQ(result[1].position, Vec3(0, 1, 0));
}

TEST(Stations, SwapHalfAxesAcrossIt) {
  const std::vector<Station> result = stations(kStraight, Vec3::UnitX());
  EXPECT_DOUBLE_EQ(result[0].half_width, 0.01);
  EXPECT_DOUBLE_EQ(result[0].half_thickness, 0.04);
}

// At 45° both are √((w² + t²)/2) = √((16 + 1)/2) cm.
TEST(Stations, TurnSecondMomentsWithTheNormal) {
  const std::vector<Station> result = stations(kStraight, Vec3(1, 0, 1).normalized());
  EXPECT_NEAR(result[0].half_width, 0.01 * std::sqrt(8.5), 1e-15);
  EXPECT_NEAR(result[0].half_thickness, 0.01 * std::sqrt(8.5), 1e-15);
}

}  // namespace
}  // namespace liana
