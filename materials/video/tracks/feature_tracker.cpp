#include "materials/video/tracks/feature_tracker.h"

#include <deque>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace liana {
namespace {

using Pyramid = std::vector<cv::Mat>;

const cv::Size kWindow(15, 15);
constexpr int kLevels = 3;          // with the window: up to about 60 pixels a frame
constexpr double kWayBack = 0.5;    // pixels: forward and backward may disagree by
constexpr double kFlattest = 1e-4;  // least eigenvalue of the window's gradients, as OpenCV scales it
constexpr size_t kRemembered = 7;   // frames

cv::Mat as_image(const GrayFrame& frame) {
  return {frame.height, frame.width, CV_8UC1, const_cast<uint8_t*>(frame.pixels.data())};
}

Pyramid pyramid_of(const GrayFrame& frame) {
  Pyramid pyramid;
  cv::buildOpticalFlowPyramid(as_image(frame).clone(), pyramid, kWindow, kLevels);
  return pyramid;
}

cv::Point2f to_cv(const Vec2& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

bool is_near(const cv::Point2f& a, const cv::Point2f& b, double distance) {
  return cv::norm(a - b) < distance;
}

struct Flow {
  std::vector<cv::Point2f> to;
  std::vector<uint8_t> found;
};

Flow flow(const Pyramid& a, const Pyramid& b, const std::vector<cv::Point2f>& from) {
  Flow result;
  std::vector<float> error;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.002);
  cv::calcOpticalFlowPyrLK(a, b, from, result.to, result.found, error, kWindow, kLevels, until, 0, kFlattest);
  return result;
}

/// Small errors of each frame add up; the first frame's look of a point, where it is still recognised within
/// a pixel, takes them back.
void anchor(const Pyramid& first, const Pyramid& now, const std::vector<cv::Point2f>& home,
            std::vector<cv::Point2f>& at) {
  constexpr double kSame = 1.5;  // pixels
  if (home.empty()) return;
  std::vector<cv::Point2f> there = at, back = home;
  std::vector<uint8_t> found, found_back;
  std::vector<float> error;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.002);
  const int flags = cv::OPTFLOW_USE_INITIAL_FLOW;
  cv::calcOpticalFlowPyrLK(first, now, home, there, found, error, kWindow, 0, until, flags, kFlattest);
  cv::calcOpticalFlowPyrLK(now, first, there, back, found_back, error, kWindow, 0, until, flags, kFlattest);
  for (size_t k = 0; k < at.size(); ++k)
    if (found[k] && found_back[k] && is_near(there[k], at[k], kSame) && is_near(back[k], home[k], kWayBack))
      at[k] = there[k];
}

std::vector<Vec2> corners(const cv::Mat& image, const cv::Mat& mask, int most, double spacing) {
  std::vector<cv::Point2f> found;
  constexpr double kQuality = 0.01;  // of the best corner's
  cv::goodFeaturesToTrack(image, found, most, kQuality, spacing, mask, 5);
  std::vector<Vec2> points;
  for (const cv::Point2f& p : found) points.emplace_back(p.x, p.y);
  return points;
}

}  // namespace

std::vector<Vec2> good_features(const GrayFrame& frame, size_t most, double spacing) {
  constexpr int kAcross = 8, kDown = 6;
  const cv::Mat image = as_image(frame);
  const int of_cell = static_cast<int>(most) / (kAcross * kDown) + 1;
  std::vector<Vec2> points;
  for (int row = 0; row < kDown; ++row)
    for (int column = 0; column < kAcross; ++column) {
      const int x0 = column * frame.width / kAcross, x1 = (column + 1) * frame.width / kAcross;
      const int y0 = row * frame.height / kDown, y1 = (row + 1) * frame.height / kDown;
      if (x1 - x0 < 8 || y1 - y0 < 8) continue;
      for (const Vec2& p : corners(image(cv::Rect(x0, y0, x1 - x0, y1 - y0)), {}, of_cell, spacing))
        points.push_back(p + Vec2(x0, y0));
    }
  return points;
}

std::optional<Vec2> feature_near(const GrayFrame& frame, const Vec2& point, double distance) {
  cv::Mat mask = cv::Mat::zeros(frame.height, frame.width, CV_8UC1);
  cv::circle(mask, cv::Point(to_cv(point)), static_cast<int>(distance), 255, cv::FILLED);
  const std::vector<Vec2> found = corners(as_image(frame), mask, 1, 1);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

struct FeatureTracker::State {
  struct Point {
    Vec2 last;
    size_t age = 1;  // frames since it was seen
  };
  Pyramid first;
  std::vector<cv::Point2f> home;  // in the first frame
  std::deque<Pyramid> before;     // the latest first
  std::vector<Point> points;
};

FeatureTracker::FeatureTracker(const GrayFrame& first, const std::vector<Vec2>& points)
    : state_(std::make_unique<State>()) {
  state_->first = pyramid_of(first);
  state_->before.push_front(state_->first);
  for (const Vec2& p : points) state_->points.push_back({p, 1}), state_->home.push_back(to_cv(p));
}

FeatureTracker::~FeatureTracker() = default;

std::vector<Vec2> FeatureTracker::advance(const GrayFrame& next) {
  const Pyramid now = pyramid_of(next);
  auto& points = state_->points;
  std::vector<Vec2> found(points.size(), Vec2::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (size_t age = 1; age <= state_->before.size(); ++age) {
    std::vector<size_t> ids;
    std::vector<cv::Point2f> from;
    for (size_t i = 0; i < points.size(); ++i)
      if (points[i].age == age) ids.push_back(i), from.push_back(to_cv(points[i].last));
    if (ids.empty()) continue;
    const Pyramid& before = state_->before[age - 1];
    const Flow there = flow(before, now, from), back = flow(now, before, there.to);
    std::vector<size_t> trusted;
    std::vector<cv::Point2f> home, at;
    const cv::Rect2f picture(0, 0, static_cast<float>(next.width), static_cast<float>(next.height));
    for (size_t k = 0; k < ids.size(); ++k)
      if (there.found[k] && back.found[k] && picture.contains(there.to[k]) &&
          is_near(back.to[k], from[k], kWayBack))
        trusted.push_back(ids[k]), home.push_back(state_->home[ids[k]]), at.push_back(there.to[k]);
    anchor(state_->first, now, home, at);
    for (size_t k = 0; k < trusted.size(); ++k) found[trusted[k]] = Vec2(at[k].x, at[k].y);
  }
  for (size_t i = 0; i < points.size(); ++i)
    if (found[i].allFinite())
      points[i] = {found[i], 1};
    else
      ++points[i].age;
  state_->before.push_front(now);
  if (state_->before.size() > kRemembered) state_->before.pop_back();
  return found;
}

}  // namespace liana
