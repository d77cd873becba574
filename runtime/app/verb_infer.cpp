#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "materials/bake/bake_file.h"
#include "materials/law/species_writer.h"
#include "materials/video/assignment.h"
#include "materials/video/infer_report.h"
#include "materials/video/tracks/csv_line.h"
#include "materials/video/tracks/overlay_frame.h"
#include "materials/video/tracks/track_video.h"
#include "mesher/base/files.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"
#include "runtime/view/video.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct InferArguments {
  fs::path input, plant, map, preset, json, spectrum, tracks, overlay;
  std::string species = "apple", name, wind = "auto", motion = "auto";
  std::vector<std::string> points, assign;
  std::vector<double> between;
  double fps = 0;
  size_t detect = 0;
  bool still_camera = false;
  InferOptions options;
};

[[noreturn]] void usage(const std::string& what, const std::string& hint) {
  throw Error(Error::Kind::Usage, what, hint);
}

/// "X,Y" or "X,Y=TARGET": a point named P0, P1, ... in the order given.
PickedPoint picked_point(const std::string& text, size_t index, std::vector<PointAssignment>& assignments) {
  const size_t equals = text.find('=');
  const std::vector<std::string> xy = split_csv_line(std::string_view(text).substr(0, equals));
  const auto x = xy.size() == 2 ? parse_number(xy[0]) : std::nullopt,
             y = xy.size() == 2 ? parse_number(xy[1]) : std::nullopt;
  if (!x || !y)
    usage("--point " + text + " has no place",
          "write --point X,Y=BRANCH, for example --point 412,96=level1:0.82");
  const PickedPoint point{fmt::format("P{}", index), {*x, *y}};
  if (equals != std::string::npos) assignments.push_back(parse_assignment(point.name + text.substr(equals)));
  return point;
}

WindOptions wind_options(const std::string& text) {
  if (text == "auto") return {WindRule::Auto, 0};
  if (text == "none") return {WindRule::None, 0};
  if (text == "lowest") return {WindRule::Lowest, 0};
  const auto below = parse_number(text);
  if (!below || !(*below > 0 && *below < 1000))
    usage("--wind " + text + " says no frequency", "write auto, none, lowest, or a number of Hz");
  return {WindRule::Below, *below};
}

InferOptions infer_options(const InferArguments& arguments) {
  InferOptions options = arguments.options;
  options.wind = wind_options(arguments.wind);
  options.motion.excitation = arguments.motion == "decay"   ? Excitation::FreeDecay
                              : arguments.motion == "gusts" ? Excitation::Wind
                                                            : Excitation::Auto;
  if (!arguments.between.empty()) {
    options.motion.low = arguments.between[0], options.motion.high = arguments.between[1];
    if (options.motion.low >= options.motion.high)
      usage("--between needs the lower frequency first", "for example --between 0.5 8");
  }
  if (options.motion.to > 0 && options.motion.to <= options.motion.from)
    usage("--to is not after --from", "give seconds of the record");
  if (!arguments.map.empty())
    for (const PointAssignment& a :
         parse_assignments(read_file(arguments.map, 1 << 20), arguments.map.string()))
      options.assignments.push_back(a);
  for (const std::string& text : arguments.assign) options.assignments.push_back(parse_assignment(text));
  return options;
}

void write_overlay(const fs::path& path, const fs::path& source, const TrackedVideo& video,
                   Progress& progress) {
  VideoReader reader(source);
  GrayFrame frame;
  for (int64_t skipped = 0; skipped < video.seen.first_frame && reader.next(frame); ++skipped) continue;
  const int width = reader.width() / 2 * 2, height = reader.height() / 2 * 2;
  VideoWriter writer(path, width, height, reader.frames_per_second());
  progress.begin("overlay", video.seen.frames());
  for (size_t index = 0; index < video.seen.frames() && reader.next(frame); ++index) {
    progress.throw_if_cancelled();
    const std::vector<uint8_t> rgb = overlay_frame(frame, video, index);
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
      const auto row = rgb.begin() + 3 * static_cast<std::ptrdiff_t>(y) * frame.width;
      image.pixels.insert(image.pixels.end(), row, row + 3 * static_cast<std::ptrdiff_t>(width));
    }
    writer.add(image);
    progress.advance(1);
  }
  writer.finish();
}

PointTracks tracks_of_video(const InferArguments& arguments, InferOptions& options,
                            std::vector<std::string>& notes) {
  TrackOptions track{
      {}, arguments.detect, arguments.still_camera, options.motion.from, options.motion.to, arguments.fps};
  for (size_t i = 0; i < arguments.points.size(); ++i)
    track.points.push_back(picked_point(arguments.points[i], i, options.assignments));
  for (const PointAssignment& a : options.assignments) track.steady_camera |= a.target == kStillTarget;
  if (track.points.empty() && track.detect == 0) track.detect = 12;
  options.motion.from = options.motion.to = 0;  // the video was cut already
  TerminalProgress progress;
  const TrackedVideo video = track_video(arguments.input, track, progress);
  notes = video.notes;
  if (video.largest_camera_shift > 0)
    notes.push_back(
        fmt::format("the camera moved by up to {:.1f} pixels; {} features of the background tell how",
                    video.largest_camera_shift, video.background.size()));
  if (!arguments.overlay.empty()) write_overlay(arguments.overlay, arguments.input, video, progress);
  return video.steady;
}

PointTracks tracks_of(const InferArguments& arguments, InferOptions& options,
                      std::vector<std::string>& notes) {
  if (arguments.input.extension() != ".csv") return tracks_of_video(arguments, options, notes);
  if (!(arguments.fps > 0))
    usage("point tracks need their frame rate",
          "add --fps 30 (frames per second of the video they come from)");
  if (!arguments.points.empty() || arguments.detect > 0 || !arguments.overlay.empty())
    usage("--point, --detect and --overlay are for videos",
          "assign tracked points with --assign NAME=BRANCH");
  return read_point_tracks(arguments.input, arguments.fps);
}

bool assigns_a_branch(const InferArguments& arguments, const InferOptions& options) {
  const std::string still = "=" + kStillTarget;
  return std::any_of(
             arguments.points.begin(), arguments.points.end(),
             [&](const std::string& p) { return p.find('=') != std::string::npos && !p.ends_with(still); }) ||
         std::any_of(options.assignments.begin(), options.assignments.end(),
                     [](const PointAssignment& a) { return a.target != kStillTarget; });
}

int infer_verb(const InferArguments& arguments) {
  for (const fs::path& output :
       {arguments.preset, arguments.json, arguments.spectrum, arguments.tracks, arguments.overlay})
    if (!output.empty()) require_writable_folder(output);
  InferOptions options = infer_options(arguments);
  if (!arguments.preset.empty() && !assigns_a_branch(arguments, options))
    usage("no point is assigned to a branch: there is no law to write",
          "add --point X,Y=BRANCH or --assign NAME=BRANCH");
  const SpeciesFile base = read_species_file(find_species(arguments.species));
  std::optional<Bake> plant;
  if (!arguments.plant.empty()) plant = read_bake(arguments.plant);

  std::vector<std::string> notes;
  const PointTracks tracks = tracks_of(arguments, options, notes);
  if (!arguments.tracks.empty()) write_file(arguments.tracks, point_tracks_csv(tracks));
  InferResult result = infer(tracks, base.law, plant ? &*plant : nullptr, options);
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  if (!arguments.json.empty()) write_file(arguments.json, infer_json(result));
  if (!arguments.spectrum.empty()) write_file(arguments.spectrum, spectrum_csv(result));
  fmt::print("{}", infer_table(result));
  if (!arguments.preset.empty()) {
    const SpeciesFile species = inferred_species(
        base, result, arguments.name.empty() ? arguments.preset.stem().string() : arguments.name);
    write_file(arguments.preset,
               species_toml(species, "Written by liana infer. " + species.description + "."));
    fmt::print("wrote {}: liana bake PLANT --species {}\n", arguments.preset.string(),
               arguments.preset.string());
  }
  return result.left_out > 0 ? kPartial : kSuccess;
}

void add_options(CLI::App& verb, InferArguments& a) {
  verb.add_option("input", a.input, "A video, or point tracks (.csv with the columns frame, point, x, y)")
      ->required();
  verb.add_option("--fps", a.fps, "Frames per second [what the video says]; needed for tracks")
      ->check(CLI::Range(1.0, 10000.0));
  verb.add_option(
          "--point", a.points,
          "X,Y=BRANCH: follow this pixel of a video's first frame; again for each point (P0, P1, ...)")
      ->allow_extra_args(false);
  verb.add_option("--detect", a.detect, "Also follow so many points that move most [12 when none is picked]")
      ->check(CLI::Range(1, 100));
  verb.add_option("--assign", a.assign,
                  "NAME=BRANCH: what a point of the tracks sits on; again for each point")
      ->allow_extra_args(false);
  verb.add_option("--map", a.map, "The same from a file: lines of point,branch");
  verb.add_option("--plant", a.plant, "The bake whose branches are named (their lengths are needed)");
  verb.add_option("--trunk-length", a.options.trunk_length,
                  "m, of a trunk seen only in how its branches move [the plant's]")
      ->check(CLI::Range(1e-4, 1e3));
  verb.add_option("--species", a.species,
                  "Preset or file that gives exponents and all that the video does not show")
      ->capture_default_str();
  verb.add_option("-o,--output", a.preset, "Write a species file for liana bake --species");
  verb.add_option("--name", a.name, "Its name [that of the file]");
  verb.add_option("--between", a.between,
                  "Lowest and highest frequency to look for, Hz [three swings of the record, 0.4 fps]")
      ->expected(2)
      ->check(CLI::Range(1e-3, 1e4));
  verb.add_option("--from", a.options.motion.from, "First second used")->check(CLI::Range(0.0, 1e6));
  verb.add_option("--to", a.options.motion.to, "Last second used [the end]")->check(CLI::Range(0.0, 1e6));
  verb.add_option(
          "--wind", a.wind,
          "Which frequency is the wind's: auto, none, lowest (that all share), or all up to so many Hz")
      ->capture_default_str();
  verb.add_option("--motion", a.motion, "How it moves: decay (let go), gusts (pushed all the time)")
      ->check(CLI::IsMember({"auto", "decay", "gusts"}))
      ->capture_default_str();
  verb.add_flag("--still-camera", a.still_camera, "The camera stood still: take no motion of it out");
  verb.add_option("--json", a.json, "Write all results as JSON");
  verb.add_option("--spectrum", a.spectrum,
                  "Write the spectra as CSV to plot (point, frequency_hz, amplitude_px)");
  verb.add_option("--tracks", a.tracks, "Write the tracked points as CSV");
  verb.add_option("--overlay", a.overlay, "Write the video with the tracked points drawn in (.mp4)");
}

}  // namespace

void add_infer_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<InferArguments>();
  CLI::App* verb =
      app.add_subcommand("infer", "Frequencies and damping of branches from a video, as a species for bake");
  add_options(*verb, *arguments);
  verb->footer(
      "BRANCH is a branch of --plant by name or #number, GROUP:LENGTH such as level1:0.82 (m; level0 is the "
      "trunk),\n"
      "or still: something that does not move, to take the camera's motion out.\n\n"
      "Examples:\n"
      "  liana infer palm.mp4 --overlay check.mp4 --spectrum spectrum.csv\n"
      "      what moves in a video, and how fast; look at check.mp4 and choose points\n"
      "  liana infer tracks.csv --fps 30 --assign P0=level0:5.2 --assign P1=level1:2.1 --species palm -o "
      "mypalm.toml\n"
      "      points tracked elsewhere become a species: liana bake PLANT --species mypalm.toml\n\n"
      "A plant that is pulled and let go in still air tells frequency and damping best; in gusts film a "
      "minute or more.\n"
      "Exit code: 0 done, 1 bad input, 2 bad command line, 3 done but for points that are named, 130 stopped "
      "by Ctrl-C");
  verb->callback([arguments, &exit_code] { exit_code = infer_verb(*arguments); });
}

}  // namespace liana
