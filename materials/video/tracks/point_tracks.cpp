#include "materials/video/tracks/point_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "materials/video/tracks/csv_line.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/nearest_word.h"

namespace liana {
namespace {

constexpr double kFar = 1e6;                  // pixels
constexpr size_t kMostPositions = 2'000'000;  // frames times points
constexpr int64_t kLastFrame = int64_t{1} << 40;
const Vec2 kUnseen = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());

constexpr std::array<std::string_view, 4> kColumns = {"frame", "point", "x", "y"};

struct Row {
  int64_t frame;
  Vec2 at;
  size_t line;
};

class TrackParser {
 public:
  explicit TrackParser(std::string file) : file_(std::move(file)) {}

  void add_line(std::string_view text, size_t line) {
    if (is_blank(text) || text.front() == '#') return;
    const std::vector<std::string> fields = split_csv_line(text);
    const bool first = !std::exchange(started_, true);
    if (first && std::find(fields.begin(), fields.end(), "frame") != fields.end())
      return read_header(fields, line);
    if (fields.size() <= *std::max_element(column_.begin(), column_.end()))
      fail(line, fmt::format("has {} columns where frame, point, x and y are needed", fields.size()),
           "write for example: 12,P0,310.5,92.25");
    const std::string& name = fields[column_[1]];
    if (name.empty()) fail(line, "the point has no name", "name it in the column 'point'");
    const Row row{frame_of(fields[column_[0]], line),
                  {coordinate(fields[column_[2]], "x", line), coordinate(fields[column_[3]], "y", line)},
                  line};
    const auto [entry, is_new] = index_.try_emplace(name, rows_.size());
    if (is_new) rows_.emplace_back(), names_.push_back(name);
    std::vector<Row>& rows = rows_[entry->second];
    if (!rows.empty() && row.frame <= rows.back().frame)
      fail(line,
           fmt::format("frame {} of point '{}' comes after frame {} (line {})", row.frame, name,
                       rows.back().frame, rows.back().line),
           "every point needs increasing frame numbers, each once: sort the file by frame");
    rows.push_back(row);
  }

  PointTracks finish(double frames_per_second) const {
    int64_t first = kLastFrame, last = -1;
    for (const auto& rows : rows_)
      first = std::min(first, rows.front().frame), last = std::max(last, rows.back().frame);
    if (rows_.empty()) throw Error(Error::Kind::Input, file_ + ": holds no tracked point", layout());
    const auto frames = static_cast<size_t>(last - first + 1);
    if (frames > kMostPositions / rows_.size())
      throw Error(Error::Kind::Input,
                  fmt::format("{}: {} points over the frames {} to {} are more than {} positions", file_,
                              rows_.size(), first, last, kMostPositions),
                  "check the frame numbers, or give a shorter part of the record");
    PointTracks tracks{file_, frames_per_second, first, {}};
    for (size_t i = 0; i < rows_.size(); ++i) {
      PointTrack track{names_[i], std::vector<Vec2>(frames, kUnseen)};
      for (const Row& row : rows_[i]) track.path[static_cast<size_t>(row.frame - first)] = row.at;
      tracks.points.push_back(std::move(track));
    }
    return tracks;
  }

 private:
  static std::string layout() {
    return "a CSV table with the columns frame,point,x,y is needed, one line per frame and point";
  }

  [[noreturn]] void fail(size_t line, const std::string& what, const std::string& hint) const {
    throw Error(Error::Kind::Input, fmt::format("{}:{}: {}", file_, line, what), hint);
  }

  void read_header(const std::vector<std::string>& fields, size_t line) {
    for (size_t c = 0; c < kColumns.size(); ++c) {
      const auto found = std::find(fields.begin(), fields.end(), kColumns[c]);
      if (found == fields.end())
        fail(line, fmt::format("the header has no column '{}'", kColumns[c]), layout());
      column_[c] = static_cast<size_t>(found - fields.begin());
    }
  }

  int64_t frame_of(const std::string& field, size_t line) const {
    int64_t frame = 0;
    const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), frame);
    if (code != std::errc() || end != field.data() + field.size() || frame < 0 || frame > kLastFrame)
      fail(line, fmt::format("'{}' is no frame number", printable(field)), layout());
    return frame;
  }

  double coordinate(const std::string& field, const char* column, size_t line) const {
    if (field.empty()) return kUnseen.x();
    const std::optional<double> value = parse_number(field);
    if (!value)
      fail(line, fmt::format("{} = '{}' is no number", column, printable(field)),
           "leave it empty where the point was not seen");
    if (std::abs(*value) > kFar)
      fail(line, fmt::format("{} = {} is beyond {} pixels", column, *value, kFar),
           "coordinates are in pixels");
    return *value;
  }

  std::string file_;
  bool started_ = false;
  std::array<size_t, 4> column_ = {0, 1, 2, 3};
  std::map<std::string, size_t> index_;
  std::vector<std::string> names_;
  std::vector<std::vector<Row>> rows_;
};

}  // namespace

const PointTrack& PointTracks::point(const std::string& name) const {
  std::vector<std::string> names;
  for (const PointTrack& track : points) {
    if (track.name == name) return track;
    names.push_back(track.name);
  }
  throw Error(
      Error::Kind::Usage, fmt::format("{} has no point '{}'", source, name),
      fmt::format("did you mean '{}'? There are: {}", nearest_word(name, names), fmt::join(names, ", ")));
}

PointTracks parse_point_tracks(std::string_view text, const std::string& file, double frames_per_second) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  TrackParser parser(file);
  for_each_line(text, [&](std::string_view line, size_t number) { parser.add_line(line, number); });
  return parser.finish(frames_per_second);
}

PointTracks read_point_tracks(const std::filesystem::path& path, double frames_per_second) {
  return parse_point_tracks(read_file(path, size_t{1} << 30), path.string(), frames_per_second);
}

std::string point_tracks_csv(const PointTracks& tracks) {
  std::string text = "frame,point,x,y\n";
  for (size_t frame = 0; frame < tracks.frames(); ++frame)
    for (const PointTrack& track : tracks.points)
      if (track.seen(frame))
        text += fmt::format("{},{},{:.4f},{:.4f}\n", tracks.first_frame + static_cast<int64_t>(frame),
                            track.name, track.path[frame].x(), track.path[frame].y());
  return text;
}

}  // namespace liana
