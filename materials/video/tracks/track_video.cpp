#include "materials/video/tracks/track_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "materials/video/modes/main_direction.h"
#include "materials/video/tracks/feature_tracker.h"
#include "materials/video/tracks/similarity.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr size_t kFeatures = 400;  // followed besides the picked points
constexpr size_t kMostFrames = 100'000;
constexpr double kSnap = 6;  // pixels from a picked point to a corner that can be followed

using Paths = std::vector<std::vector<Vec2>>;  // per point, per frame

/// The first frame used and what is followed from it.
struct Start {
  GrayFrame frame;
  std::vector<Vec2> points;  // picked ones first
};

Start start_of(const GrayFrame& frame, const TrackOptions& options, const std::string& file,
               std::vector<std::string>& notes) {
  Start start{frame, {}};
  for (const PickedPoint& point : options.points) {
    if (point.at.x() < 0 || point.at.y() < 0 || point.at.x() >= frame.width || point.at.y() >= frame.height)
      throw Error(Error::Kind::Usage,
                  fmt::format("point '{}' at {},{} lies outside the picture of {} x {} pixels", point.name,
                              point.at.x(), point.at.y(), frame.width, frame.height),
                  "count pixels from the upper left corner: --point X,Y=BRANCH");
    const auto corner = feature_near(frame, point.at, kSnap);
    if (!corner)
      notes.push_back(fmt::format(
          "point '{}': the picture is flat there; a corner or a tip is followed better", point.name));
    start.points.push_back(corner.value_or(point.at));
  }
  const double spacing = std::max(5.0, 0.01 * std::max(frame.width, frame.height));
  const std::vector<Vec2> features = good_features(frame, kFeatures, spacing);
  start.points.insert(start.points.end(), features.begin(), features.end());
  if (start.points.empty())
    throw Error(Error::Kind::Input, file + ": the first frame shows nothing that can be followed",
                "give the seconds that show the plant: --from");
  return start;
}

Paths follow(VideoReader& reader, const TrackOptions& options, double fps, const std::string& file,
             std::vector<std::string>& notes, Progress& progress, GrayFrame& first) {
  GrayFrame frame;
  const auto from = static_cast<size_t>(std::lround(options.from * fps));
  for (size_t i = 0; i <= from; ++i)
    if (!reader.next(frame))
      throw Error(
          Error::Kind::Input,
          fmt::format("{}: the video ends after {} frames ({:.2f} s)", file, i, static_cast<double>(i) / fps),
          "choose an earlier --from");
  const size_t most = options.to > 0
                          ? static_cast<size_t>(std::max(1.0, std::round((options.to - options.from) * fps)))
                          : kMostFrames;
  const Start start = start_of(frame, options, file, notes);
  first = frame;
  Paths paths;
  for (const Vec2& p : start.points) paths.push_back({p});
  FeatureTracker tracker(frame, start.points);
  progress.begin("track", 1);  // how long it is shows at its end
  for (size_t count = 1; count < most && reader.next(frame); ++count) {
    progress.throw_if_cancelled();
    const std::vector<Vec2> now = tracker.advance(frame);
    for (size_t i = 0; i < now.size(); ++i) paths[i].push_back(now[i]);
  }
  progress.advance(1);
  return paths;
}

double spread(const std::vector<Vec2>& path) {
  double squares = 0, seen = 0;
  for (const Vec2& p : path)
    if (p.allFinite()) squares += (p - path.front()).squaredNorm(), seen += 1;
  return seen < 0.9 * static_cast<double>(path.size()) ? std::numeric_limits<double>::infinity()
                                                       : std::sqrt(squares / seen);
}

struct Camera {
  std::vector<Eigen::Affine2d> back;  // per frame, to the first; empty: the camera is still
  std::vector<Vec2> background;
  double largest_shift = 0;
  std::string note;
};

/// A fifth of the features at rest all the time: the camera is still. Else what most features do together.
Camera camera_of(const Paths& features, const GrayFrame& first) {
  constexpr double kAtRest = 0.5, kAgree = 1.0;  // pixels
  constexpr size_t kFewest = 8;
  Camera camera;
  for (const auto& path : features)
    if (spread(path) < kAtRest) camera.background.push_back(path.front());
  if (camera.background.size() >= kFewest && 5 * camera.background.size() >= features.size()) return camera;

  camera.background.clear();
  std::vector<Vec2> before, now(features.size());
  for (const auto& path : features) before.push_back(path.front());
  std::vector<size_t> agreed(features.size(), 0);
  const size_t frames = features.empty() ? 0 : features.front().size();
  const Vec2 centre(first.width / 2.0, first.height / 2.0);
  for (size_t frame = 0; frame < frames; ++frame) {
    for (size_t i = 0; i < features.size(); ++i) now[i] = features[i][frame];
    const auto fit = fit_similarity(now, before, kAgree, kFewest);
    if (!fit) {
      camera.back.clear();
      camera.note = fmt::format(
          "the camera's motion cannot be told from frame {} on (too few features agree): it is taken to be "
          "still; pick points that rest with --point X,Y=still",
          frame);
      return camera;
    }
    camera.back.push_back(fit->transform);
    camera.largest_shift = std::max(camera.largest_shift, (fit->transform * centre - centre).norm());
    for (size_t i = 0; i < features.size(); ++i) agreed[i] += fit->inlier[i];
  }
  for (size_t i = 0; i < features.size(); ++i)
    if (10 * agreed[i] >= 9 * frames) camera.background.push_back(before[i]);
  if (camera.background.size() < kFewest)
    camera.note = fmt::format("the camera's motion rests on {} features only: check it in --overlay",
                              camera.background.size());
  return camera;
}

/// The features that move most, apart from one another.
std::vector<size_t> liveliest(const Paths& steady, size_t most, double fps) {
  std::vector<std::pair<double, size_t>> ranked;
  for (size_t i = 0; i < steady.size(); ++i) {
    if (!std::isfinite(spread(steady[i]))) continue;
    const Stretch part = longest_stretch({"", steady[i]}, 0, steady[i].size(), 3);
    const auto fast = without_drift(part.path, fps, 3 * fps / static_cast<double>(part.path.size()));
    double squares = 0;
    for (const Vec2& p : fast) squares += p.squaredNorm() / static_cast<double>(fast.size());
    ranked.emplace_back(-std::sqrt(squares), i);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<size_t> chosen;
  constexpr double kApart = 15, kMoves = 0.05;  // pixels
  for (const auto& [motion, i] : ranked) {
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](size_t j) {
      return (steady[i].front() - steady[j].front()).norm() > kApart;
    });
    if (chosen.size() < most && apart && -motion > kMoves) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace

TrackedVideo track_video(const std::filesystem::path& path, const TrackOptions& options, Progress& progress) {
  VideoReader reader(path);
  TrackedVideo video;
  GrayFrame first;
  const double fps = options.frames_per_second > 0 ? options.frames_per_second : reader.frames_per_second();
  const Paths paths = follow(reader, options, fps, path.string(), video.notes, progress, first);
  const auto picked = static_cast<std::ptrdiff_t>(options.points.size());

  Camera camera;
  if (!options.steady_camera) camera = camera_of(Paths(paths.begin() + picked, paths.end()), first);
  video.background = camera.background;
  video.largest_camera_shift = camera.largest_shift;
  if (!camera.note.empty()) video.notes.push_back(camera.note);
  Paths steady = paths;
  for (auto& one : steady)
    for (size_t frame = 0; frame < camera.back.size(); ++frame) one[frame] = camera.back[frame] * one[frame];

  const auto first_frame = static_cast<int64_t>(std::lround(options.from * fps));
  video.seen = video.steady = {path.string(), fps, first_frame, {}};
  const auto keep = [&](const std::string& name, size_t i) {
    video.seen.points.push_back({name, paths[i]});
    video.steady.points.push_back({name, steady[i]});
  };
  for (size_t i = 0; i < options.points.size(); ++i) keep(options.points[i].name, i);
  if (options.detect > 0) {
    const Paths features(steady.begin() + picked, steady.end());
    for (const size_t i : liveliest(features, options.detect, fps)) {
      const Vec2 at = paths[i + options.points.size()].front();
      keep(fmt::format("{:.0f};{:.0f}", at.x(), at.y()), i + options.points.size());
    }
  }
  if (video.seen.points.empty())
    throw Error(Error::Kind::Input,
                fmt::format("{}: nothing moves in {} frames", path.string(), paths.front().size()),
                "film closer, or pick points: --point X,Y=BRANCH");
  return video;
}

}  // namespace liana
