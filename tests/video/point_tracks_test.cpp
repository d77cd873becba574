// Point tracks as files, gaps and cameras.
#include "materials/video/tracks/point_tracks.h"

#include <gtest/gtest.h>

#include "materials/video/modes/main_direction.h"
#include "materials/video/tracks/camera_motion.h"
#include "materials/video/tracks/similarity.h"
#include "mesher/base/error.h"
#include "tests/support/synthetic_tracks.h"

namespace liana {
namespace {

/// What the reader says of a bad file: "what | hint".
std::string complaint(const std::string& text) {
  try {
    parse_point_tracks(text, "t.csv", 30);
  } catch (const Error& error) {
    return std::string(error.what()) + " | " + error.hint;
  }
  return "nothing";
}

TEST(PointTracks, ReadsAnyOrderOfColumnsCrlfQuotesAndGaps) {
  const PointTracks tracks = parse_point_tracks(
      "\xEF\xBB\xBF# by hand\r\nx, y ,point,frame,who\r\n1,2,\"P 0\",7,me\r\n3,,\"P 0\",8,me\r\n5,6,\"P "
      "0\",10,me\r\n0,0,b,7,\r\n",
      "t.csv", 30);
  ASSERT_EQ(tracks.points.size(), 2u);
  EXPECT_EQ(tracks.first_frame, 7);
  EXPECT_EQ(tracks.frames(), 4u);
  const PointTrack& p = tracks.point("P 0");
  EXPECT_EQ(p.path[0], Vec2(1, 2));
  EXPECT_FALSE(p.seen(1));
  EXPECT_FALSE(p.seen(2));
  EXPECT_EQ(p.path[3], Vec2(5, 6));
}

TEST(PointTracks, WrittenTableReadsBackTheSame) {
  Random random(1, "tracks");
  PointTracks tracks = test::tracks_of({{"a", test::decaying_path({.seconds = 1}, random)},
                                        {"b", test::decaying_path({.seconds = 1}, random)}},
                                       30);
  tracks.points[1].path[4].setConstant(std::nan(""));
  const PointTracks back = parse_point_tracks(point_tracks_csv(tracks), "t.csv", 30);
  for (size_t i = 0; i < 2; ++i)
    for (size_t n = 0; n < tracks.frames(); ++n) {
      EXPECT_EQ(back.points[i].seen(n), tracks.points[i].seen(n));
      if (back.points[i].seen(n)) {
        EXPECT_LT((back.points[i].path[n] - tracks.points[i].path[n]).norm(),
                  1e-4);  // four digits are written
      }
    }
}

TEST(PointTracks, BadTablesAreRefusedByLine) {
  EXPECT_EQ(complaint("frame,point,x,y\n1,P,1,2\n1,P,1,2\n").substr(0, 49),
            "t.csv:3: frame 1 of point 'P' comes after frame 1");
  EXPECT_EQ(complaint("frame,point,x,y\n4,P,1,2\n3,P,1,2\n").substr(0, 8), "t.csv:3:");
  EXPECT_EQ(complaint("frame,point,x\n").substr(0, 40), "t.csv:1: the header has no column 'y' | ");
  EXPECT_EQ(complaint("0,P,left,2\n").substr(0, 31), "t.csv:1: x = 'left' is no numbe");
  EXPECT_EQ(complaint("1.5,P,1,2\n").substr(0, 32), "t.csv:1: '1.5' is no frame numbe");
  EXPECT_EQ(complaint("0,P,1e9,2\n").substr(0, 12), "t.csv:1: x =");
  EXPECT_EQ(complaint("0,P,1\n").substr(0, 14), "t.csv:1: has 3");
  EXPECT_EQ(complaint("").substr(0, 30), "t.csv: holds no tracked point ");
  EXPECT_NE(complaint("0,P,1,2\n99999999999,P,1,2\n").find("more than 2000000 positions"), std::string::npos);
}

TEST(Stretch, ShortGapsAreBridgedLongOnesBreakTheRecord) {
  PointTrack track{"P", {}};
  for (int n = 0; n < 30; ++n) track.path.emplace_back(n, 2 * n);
  for (const int unseen : {3, 4, 10, 11, 12, 13, 14})
    track.path[static_cast<size_t>(unseen)].setConstant(std::nan(""));
  const Stretch part = longest_stretch(track, 0, 30, 3);
  EXPECT_EQ(part.first, 15u);
  EXPECT_EQ(part.path.size(), 15u);
  const Stretch whole = longest_stretch(track, 0, 30, 5);
  EXPECT_EQ(whole.path.size(), 30u);
  EXPECT_EQ(whole.bridged, 7u);
  EXPECT_LT((whole.path[12] - Vec2(12, 24)).norm(), 1e-12);
}

TEST(CameraMotion, StillPointsTakeShiftTurnAndZoomOut) {
  Random random(2, "camera");
  const auto truth = test::decaying_path({.seconds = 2, .noise = 0, .swings = {{1, 0.05, 10}}}, random);
  PointTracks tracks = test::tracks_of({{"P", {}}, {"rock", {}}, {"wall", {}}}, 30);
  for (size_t n = 0; n < truth.size(); ++n) {
    const double angle = n ? 0.02 * random.normal() : 0, zoom = n ? 1 + 0.01 * random.normal() : 1;
    const Eigen::Rotation2D<double> turn(angle);
    const Vec2 shift = n ? Vec2(5 * random.normal(), 5 * random.normal()) : Vec2::Zero();
    const auto filmed = [&](const Vec2& p) -> Vec2 { return zoom * (turn * p) + shift; };
    tracks.points[0].path.push_back(filmed(truth[n]));
    tracks.points[1].path.push_back(filmed({40, 300}));
    tracks.points[2].path.push_back(filmed({500, 20}));
  }
  const PointTracks steady = without_camera_motion(tracks, {"rock", "wall"});
  ASSERT_EQ(steady.points.size(), 1u);
  for (size_t n = 0; n < truth.size(); ++n) EXPECT_LT((steady.points[0].path[n] - truth[n]).norm(), 1e-9);
}

TEST(Similarity, IsFoundAmongPointsThatMostlyMoveOtherwise) {
  Random random(3, "similarity");
  std::vector<Vec2> before, now;
  const Eigen::Affine2d camera =
      Eigen::Translation2d(7, -3) * Eigen::Rotation2Dd(0.03) * Eigen::Scaling(1.02);
  for (int i = 0; i < 100; ++i) {
    before.emplace_back(random.uniform(0, 640), random.uniform(0, 480));
    const bool background = i % 10 < 4;
    now.push_back(camera * before.back() +
                  (background ? 0.2 : 30.0) * Vec2(random.normal(), random.normal()));
  }
  const auto fit = fit_similarity(now, before, 1, 8);
  ASSERT_TRUE(fit.has_value());
  // 40 points of 0.2 pixels: the corner of the picture is met within a few tenths.
  for (const Vec2& corner : {Vec2(0, 0), Vec2(640, 480)})
    EXPECT_LT((fit->transform * (camera * corner) - corner).norm(), 0.4);
  EXPECT_GE(fit->inliers, 35u);
}

}  // namespace
}  // namespace liana
