#include "materials/video/modes/point_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "materials/video/modes/decay_fit.h"
#include "materials/video/modes/gust_fit.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr double kSwings = 3;  // of the slowest frequency that a record must hold
constexpr size_t kFewestFrames = 32;
constexpr double kStill = 0.02;   // pixels rms: what a tracker sees of a point at rest
constexpr double kBridged = 0.1;  // s: longer gaps break a record

[[noreturn]] void fail(const PointTracks& tracks, const PointTrack& track, const std::string& what,
                       const std::string& hint) {
  throw Error(Error::Kind::Input, fmt::format("{}: point '{}' {}", tracks.source, track.name, what), hint);
}

Stretch usable_part(const PointTracks& tracks, const PointTrack& track, const MotionOptions& options) {
  const double fps = tracks.frames_per_second;
  const auto from = static_cast<size_t>(std::lround(options.from * fps));
  const auto to = options.to > 0 ? static_cast<size_t>(std::lround(options.to * fps)) : tracks.frames();
  const auto gap = static_cast<size_t>(std::max(2.0, std::round(kBridged * fps)));
  Stretch part = longest_stretch(track, from, to, gap);
  const double seconds = static_cast<double>(part.path.size()) / fps;
  const auto seen = static_cast<size_t>(
      std::count_if(track.path.begin(), track.path.end(), [](const Vec2& p) { return p.allFinite(); }));
  const bool broken =
      part.path.size() + 2 * gap < std::min(to, tracks.frames()) - std::min(from, tracks.frames());
  const std::string where =
      broken ? fmt::format("vanishes: it is seen in {} of {} frames, at most {:.2f} s without a break", seen,
                           tracks.frames(), seconds)
             : fmt::format("is tracked for {:.2f} s only", seconds);
  if (part.path.size() < kFewestFrames)
    fail(tracks, track, fmt::format("{}; {} frames in a row are needed at least", where, kFewestFrames),
         broken ? "track it through the gaps, choose a point that stays in sight, or give the rate of the "
                  "rows as --fps"
                : "film longer or with more frames per second");
  if (options.low > 0 && seconds * options.low < kSwings)
    fail(tracks, track,
         fmt::format("{}; to find {} Hz, {:.1f} s are needed (three swings)", where, options.low,
                     kSwings / options.low),
         fmt::format("film longer, or ask from {:.2f} Hz on (--between)", kSwings / seconds));
  return part;
}

/// Where a free decay begins: at the largest deflection.
size_t start_of_decay(const std::vector<double>& signal) {
  const auto largest = std::max_element(signal.begin(), signal.end(),
                                        [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<size_t>(largest - signal.begin());
}

std::vector<double> projected(const std::vector<Vec2>& path, const Vec2& direction) {
  std::vector<double> signal;
  for (const Vec2& p : path) signal.push_back(direction.dot(p - path.front()));
  return signal;
}

double energy(std::span<const double> signal) {
  return std::inner_product(signal.begin(), signal.end(), signal.begin(), 0.0);
}

/// A free decay takes up nearly all of the motion; what swings most loses its swing, and in the end it is
/// calm.
bool is_decay(const DecayFit& fit, std::span<const double> signal, size_t start) {
  constexpr double kExplained = 0.9, kCalm = 0.25;
  const size_t quarter = (signal.size() - start) / 4;
  return start < signal.size() / 2 && !fit.modes.empty() && fit.explained > kExplained &&
         fit.modes.front().damping_factor > kCoverage95 * fit.modes.front().damping_sigma &&
         energy(signal.last(quarter)) < kCalm * energy(signal.subspan(start, quarter));
}

std::vector<double> peak_frequencies(std::span<const double> signal, double dt, double low, double high) {
  constexpr size_t kMostModes = 5;
  constexpr double kWeakest = 1e-4;  // of the strongest one's power: 1 % of its amplitude
  // Parts as long as telling `low` from its neighbours needs; a tenth of a longer record.
  const auto count = static_cast<double>(signal.size());
  const auto part = static_cast<size_t>(std::min(count, std::max(count / 10, kSwings / (low * dt))));
  std::vector<double> frequencies;
  double strongest = 0;
  for (const SpectrumPeak& peak : spectrum_peaks(welch_spectrum(signal, dt, part), low, high, 4)) {
    strongest = std::max(strongest, peak.power);
    if (frequencies.size() < kMostModes && peak.power > kWeakest * strongest)
      frequencies.push_back(peak.frequency);
  }
  return frequencies;
}

/// The motion of a stretch above the slowest frequency asked for.
struct Swing {
  Stretch part;
  std::vector<Vec2> fast;  // without drift
  MainDirection main;
};

/// The band that was asked for, as far as the record can tell it.
void choose_band(const PointTracks& tracks, const PointTrack& track, const MotionOptions& options,
                 size_t frames, PointModes& result) {
  const double fps = tracks.frames_per_second;
  result.lowest = options.low > 0 ? options.low : kSwings / (static_cast<double>(frames) * (1 / fps));
  result.highest = options.high > 0 ? std::min(options.high, 0.5 * fps) : 0.4 * fps;
  if (result.lowest >= result.highest)
    fail(
        tracks, track,
        fmt::format(
            "is filmed at {} frames per second: only up to {} Hz can be told, from {:.2f} Hz on it was asked",
            fps, result.highest, result.lowest),
        "film with more frames per second, or longer");
}

Swing swing_of(const PointTracks& tracks, const PointTrack& track, Stretch part, double lowest) {
  Swing swing{std::move(part), {}, {}};
  swing.fast = without_drift(swing.part.path, tracks.frames_per_second, lowest);
  swing.main = main_direction(swing.fast);
  const std::vector<double>& signal = swing.main.signal;
  double variance = 0;
  for (const double value : signal) variance += value * value / static_cast<double>(signal.size());
  if (std::sqrt(variance) < kStill)
    fail(tracks, track,
         fmt::format("does not move: {:.3f} pixels rms above {:.2f} Hz", std::sqrt(variance), lowest),
         "choose a point that swings, film closer, or check that the plant moves at all");
  return swing;
}

/// The motion from `start` on as a free decay; no modes where too little of it is left and that is not what
/// was asked for.
DecayFit decay_from(const PointTracks& tracks, const PointTrack& track, const Swing& swing, size_t start,
                    Excitation asked, const PointModes& band) {
  const double dt = 1 / tracks.frames_per_second;
  const size_t left = swing.main.signal.size() - start;
  if (left < kFewestFrames || static_cast<double>(left) * dt * band.lowest < kSwings / 2) {
    if (asked == Excitation::FreeDecay)
      fail(tracks, track, "is deflected most at the end of the record: nothing of its decay is left",
           "give the seconds in which it swings freely: --from and --to");
    return {};
  }
  const auto from = static_cast<std::ptrdiff_t>(start);
  const std::vector<Vec2> rest(swing.part.path.begin() + from, swing.part.path.end());
  const std::vector<Vec2> rest_fast(swing.fast.begin() + from, swing.fast.end());
  const Vec2 direction = main_direction(rest_fast).direction;
  return fit_decay(projected(rest, direction), dt, {band.lowest, band.highest});
}

std::vector<MeasuredMode> gust_modes(const Swing& swing, double dt, const PointModes& band) {
  const std::vector<double> signal = projected(swing.part.path, swing.main.direction);
  std::vector<MeasuredMode> modes =
      fit_gusts(signal, dt, peak_frequencies(signal, dt, band.lowest, band.highest), band.lowest / kSwings,
                band.highest)
          .modes;
  std::erase_if(modes, [&](const MeasuredMode& m) { return m.frequency < band.lowest; });
  return modes;
}

/// What of the record was used, and what it looks like.
void describe(const Swing& swing, double fps, PointModes& result) {
  result.first_frame = swing.part.first;
  result.frames = swing.part.path.size();
  result.bridged = swing.part.bridged;
  result.direction = swing.main.direction;
  result.direction_share = swing.main.share;
  result.resolution = fps / static_cast<double>(swing.part.path.size());
  result.spectrum = power_spectrum(swing.main.signal, 1 / fps, Window::Hann);
}

}  // namespace

PointModes point_modes(const PointTracks& tracks, const PointTrack& track, const MotionOptions& options) {
  const double fps = tracks.frames_per_second;
  PointModes result;
  result.point = track.name;
  Stretch part = usable_part(tracks, track, options);
  choose_band(tracks, track, options, part.path.size(), result);
  Swing swing = swing_of(tracks, track, std::move(part), result.lowest);

  const bool may_decay = options.excitation != Excitation::Wind;
  const size_t start = may_decay ? start_of_decay(swing.main.signal) : 0;
  const DecayFit decay =
      may_decay ? decay_from(tracks, track, swing, start, options.excitation, result) : DecayFit{};
  result.explained = decay.explained;
  if (options.excitation == Excitation::FreeDecay || is_decay(decay, swing.main.signal, start)) {
    result.excitation = Excitation::FreeDecay;
    result.modes = decay.modes;
    swing.part.path.erase(swing.part.path.begin(),
                          swing.part.path.begin() + static_cast<std::ptrdiff_t>(start));
    swing.part.first += start;
    swing.main = main_direction(without_drift(swing.part.path, fps, result.lowest));
  } else {
    result.excitation = Excitation::Wind;
    result.modes = gust_modes(swing, 1 / fps, result);
  }
  describe(swing, fps, result);
  if (result.modes.empty())
    fail(tracks, track,
         fmt::format("shows no frequency between {:.2f} and {:.2f} Hz that stands out", result.lowest,
                     result.highest),
         "film longer or closer, pull the branch and let go, or widen --between");
  return result;
}

}  // namespace liana
