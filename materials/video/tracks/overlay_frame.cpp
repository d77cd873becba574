#include "materials/video/tracks/overlay_frame.h"

#include <array>
#include <opencv2/imgproc.hpp>

namespace liana {
namespace {

// Eight hues that stay apart for colour-blind eyes [Okabe & Ito], RGB.
const std::array<cv::Scalar, 8> kColors = {
    cv::Scalar(230, 159, 0), cv::Scalar(86, 180, 233), cv::Scalar(0, 158, 115),   cv::Scalar(240, 228, 66),
    cv::Scalar(0, 114, 178), cv::Scalar(213, 94, 0),   cv::Scalar(204, 121, 167), cv::Scalar(255, 255, 255)};

cv::Point to_pixel(const Vec2& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

}  // namespace

std::vector<uint8_t> overlay_frame(const GrayFrame& frame, const TrackedVideo& video, size_t index) {
  const cv::Mat gray(frame.height, frame.width, CV_8UC1, const_cast<uint8_t*>(frame.pixels.data()));
  cv::Mat picture;
  cv::cvtColor(gray, picture, cv::COLOR_GRAY2RGB);
  for (const Vec2& p : video.background)
    cv::drawMarker(picture, to_pixel(p), cv::Scalar(150, 150, 150), cv::MARKER_CROSS, 5);
  const auto trail = static_cast<size_t>(video.seen.frames_per_second);
  for (size_t i = 0; i < video.seen.points.size(); ++i) {
    const PointTrack& track = video.seen.points[i];
    const cv::Scalar& color = kColors[i % kColors.size()];
    for (size_t n = index > trail ? index - trail : 0; n + 1 <= index; ++n)
      if (track.seen(n) && track.seen(n + 1))
        cv::line(picture, to_pixel(track.path[n]), to_pixel(track.path[n + 1]), color, 1, cv::LINE_AA);
    if (!track.seen(index)) continue;
    const cv::Point at = to_pixel(track.path[index]);
    cv::circle(picture, at, 5, color, 1, cv::LINE_AA);
    cv::putText(picture, track.name, at + cv::Point(8, -6), cv::FONT_HERSHEY_SIMPLEX, 0.4, color, 1,
                cv::LINE_AA);
  }
  return {picture.datastart, picture.dataend};
}

}  // namespace liana
