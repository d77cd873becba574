#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "mesher/base/stopwatch.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"
#include "runtime/export/gltf_export.h"
#include "runtime/view/renderer.h"
#include "runtime/view/video.h"
#include "runtime/world/session.h"
#include "runtime/world/world_drawing.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct SimulateArguments {
  fs::path scene, png, mp4, glb, report, record, replay;
  std::optional<double> seconds;
  double video_seconds = 8, sway_seconds = 4;
  std::vector<int> size = {1280, 720}, video_size = {854, 480};
  unsigned threads = 0;
  bool smooth_video = false;
};

constexpr double kFrameRate = 25;  // per second of video

/// Which steps are filmed: the run in fast motion, then its last seconds at their true pace.
class Film {
 public:
  Film(const SimulateArguments& arguments, size_t steps, double dt) {
    const double total = static_cast<double>(steps) * dt;
    const double sway = std::min(arguments.sway_seconds, std::min(total, arguments.video_seconds));
    const auto fast_frames = static_cast<size_t>(std::lround((arguments.video_seconds - sway) * kFrameRate));
    const auto sway_frames = static_cast<size_t>(std::lround(sway * kFrameRate));
    for (size_t i = 1; i <= fast_frames; ++i)
      times_.push_back((total - sway) * static_cast<double>(i) / static_cast<double>(fast_frames));
    for (size_t i = 1; i <= sway_frames; ++i)
      times_.push_back(total - sway + sway * static_cast<double>(i) / static_cast<double>(sway_frames));
    for (double& time : times_) time = std::min(time, total) - 1e-6 * dt;
  }
  size_t frames() const { return times_.size(); }
  /// Frames due at a time, after those taken before.
  size_t due(double time) {
    const size_t before = next_;
    while (next_ < times_.size() && times_[next_] <= time) ++next_;
    return next_ - before;
  }

 private:
  std::vector<double> times_;  // s
  size_t next_ = 0;
};

std::string report_json(const World& world, double total_seconds, double render_seconds) {
  const WorldReport report = world.report();
  nlohmann::ordered_json json;
  json["steps"] = report.steps;
  json["particles"] = report.particles;
  json["state_hash"] = hash_text(world.state_hash());
  json["max_penetration_m"] = report.max_penetration;
  json["contacts"] = report.contacts;
  json["plant_contacts"] = report.plant_contacts;
  json["grown_together"] = report.grown_together;
  json["max_overlap_m"] = report.max_overlap;
  json["anchors"] = report.anchors;
  json["redone_steps"] = report.redone_steps;
  json["contact_passes"] = report.contact_passes;
  json["projected_joints"] = report.projected_joints;
  json["lost_steps"] = report.lost_steps;
  json["parts"] = {{"broken", report.broken},     {"shed", report.shed},     {"cut", report.cut},
                   {"detached", report.detached}, {"asleep", report.asleep}, {"removed", report.removed}};
  json["seconds"] = {{"total", total_seconds},
                     {"physics", report.seconds.physics},
                     {"growth", report.seconds.growth},
                     {"collision", report.seconds.collision},
                     {"plant_contacts", report.seconds.touching},
                     {"wind", report.seconds.wind},
                     {"render", render_seconds}};
  if (report.air)
    json["air"] = {{"particles", report.air->particles}, {"substeps", report.air->substeps},
                   {"emitted", report.air->emitted},     {"refused", report.air->refused},
                   {"left", report.air->left},           {"limited", report.air->limited}};
  json["notes"] = world.notes();
  return json.dump(2) + "\n";
}

void print_summary(const World& world, double total_seconds, double render_seconds) {
  const WorldReport report = world.report();
  const PhaseSeconds& s = report.seconds;
  fmt::print("{} steps, {} particles, {} anchors, deepest penetration {:.2f} mm, state {}\n", report.steps,
             report.particles, report.anchors, 1e3 * report.max_penetration, hash_text(world.state_hash()));
  fmt::print("seconds: growth {:.2f}, collision {:.2f}, physics {:.2f}, render {:.2f}, total {:.2f}\n",
             s.growth, s.collision, s.physics, render_seconds, total_seconds);
  fmt::print(
      "contacts in the last step: {} with obstacles, {} between plant parts ({} grown together, deepest "
      "overlap "
      "{:.2f} mm, {:.2f} s)\n",
      report.contacts, report.plant_contacts, report.grown_together, 1e3 * report.max_overlap, s.touching);
  if (report.air) {
    fmt::print("air: {} particles, {} substeps in {:.2f} s; {} emitted, {} left the domain\n",
               report.air->particles, report.air->substeps, s.wind, report.air->emitted, report.air->left);
    if (report.air->refused > 0)
      fmt::print("note: {} air particles found no room (max_particles in [wind.air])\n", report.air->refused);
    if (report.air->limited > 0)
      fmt::print("note: {} air velocities were cut to twice the speed of sound\n", report.air->limited);
  }
  if (report.broken + report.shed + report.cut > 0)
    fmt::print(
        "came off: {} branches broke, {} leaves were shed, {} parts were cut; {} lie about ({} at rest)\n",
        report.broken, report.shed, report.cut, report.detached, report.asleep);
  if (report.removed > 0)
    fmt::print("note: {} detached parts were taken away, at rest for their time or blown out of the scene\n",
               report.removed);
  if (report.redone_steps > 0)
    fmt::print("note: {} steps were redone with finer substeps\n", report.redone_steps);
  if (report.projected_joints > 0)
    fmt::print("note: {} joints were torn open and closed by hand\n", report.projected_joints);
  if (report.lost_steps > 0)
    fmt::print("note: {} steps did not stay finite and were stopped\n", report.lost_steps);
  for (const std::string& note : world.notes()) fmt::print("note: {}\n", note);
}

void require_writable_outputs(const SimulateArguments& arguments) {
  for (const fs::path& output :
       {arguments.png, arguments.mp4, arguments.glb, arguments.report, arguments.record})
    if (!output.empty()) require_writable_folder(output);
}

int simulate(const SimulateArguments& arguments) {
  require_writable_outputs(arguments);
  const Stopwatch total;
  const Scene scene = load_scene(arguments.scene);
  World world(scene, arguments.threads);
  auto steps = static_cast<size_t>(std::lround(arguments.seconds.value_or(scene.seconds) / scene.time_step));
  std::optional<SessionReplay> replay;
  if (!arguments.replay.empty()) {
    replay.emplace(arguments.replay);
    steps = arguments.seconds ? std::min(steps, replay->steps()) : replay->steps();
  }
  std::optional<SessionRecorder> recorder;
  if (!arguments.record.empty()) recorder.emplace(world, arguments.record);
  Simulation& moving = recorder ? static_cast<Simulation&>(*recorder) : world;
  const int width = arguments.size[0], height = arguments.size[1];

  double render_seconds = 0;
  std::optional<HeadlessRenderer> renderer;
  std::optional<VideoWriter> video;
  if (!arguments.png.empty() || !arguments.mp4.empty()) renderer.emplace();
  FrameOptions video_frame;
  video_frame.width = arguments.video_size[0] / 2 * 2;
  video_frame.height = arguments.video_size[1] / 2 * 2;
  if (arguments.smooth_video) video_frame.samples = 4;
  if (!arguments.mp4.empty()) video.emplace(arguments.mp4, video_frame.width, video_frame.height, kFrameRate);
  Film film(arguments, steps, scene.time_step);
  const Camera camera = camera_of(world);

  {
    TerminalProgress progress;
    progress.begin("simulate", steps);
    for (size_t i = 1; i <= steps; ++i) {
      progress.throw_if_cancelled();
      if (replay)
        replay->step(world);
      else
        moving.step();
      const size_t due = film.due(static_cast<double>(i) * scene.time_step);
      if (video && due > 0) {
        const Stopwatch watch;
        const Image frame = renderer->render(drawing_of(world), camera, video_frame);
        for (size_t copy = 0; copy < due; ++copy) video->add(frame);
        render_seconds += watch.seconds();
      }
      progress.advance(1);
    }
  }
  const Stopwatch watch;
  if (video) video->finish();
  if (!arguments.png.empty())
    write_png(arguments.png, renderer->render(drawing_of(world), camera, still_frame(width, height)));
  render_seconds += watch.seconds();
  if (!arguments.glb.empty()) write_gltf(arguments.glb, drawing_of(world, true));
  if (!arguments.report.empty())
    write_file(arguments.report, report_json(world, total.seconds(), render_seconds));
  print_summary(world, total.seconds(), render_seconds);
  if (replay) fmt::print("replayed: the state after each of {} steps is the recorded one\n", steps);
  return kSuccess;
}

}  // namespace

void add_simulate_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* verb =
      app.add_subcommand("simulate", "Grow and move a scene without a display: picture, video, glTF");
  verb->add_option("scene", arguments->scene, "The scene (.toml); see data/scenes")->required();
  verb->add_option("--seconds", arguments->seconds, "Simulated time [what the scene says]")
      ->check(CLI::Range(0.0, 86400.0));
  verb->add_option("--png", arguments->png, "Write a picture of the end");
  verb->add_option("--mp4", arguments->mp4,
                   "Write a video: the run in fast motion, its end at its true pace");
  verb->add_option("--video-seconds", arguments->video_seconds, "Length of the video")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  verb->add_option("--true-pace", arguments->sway_seconds,
                   "How many of them are at the true pace, at the end")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  verb->add_option("--size", arguments->size, "Width and height of the picture in pixels [1280 720]")
      ->expected(2)
      ->check(CLI::Range(16, 8192));
  verb->add_option("--video-size", arguments->video_size, "Width and height of the video [854 480]")
      ->expected(2)
      ->check(CLI::Range(16, 4096));
  verb->add_flag("--smooth-video", arguments->smooth_video,
                 "Smooth edges in the video, as a camera sees them (slower)");
  verb->add_option("--export", arguments->glb, "Write the end as glTF (.glb)");
  verb->add_option("--report", arguments->report, "Write counts, state hash and timings as JSON");
  CLI::Option* replay = verb->add_option("--replay", arguments->replay,
                                         "Do again what was recorded, and stop with an error at the first "
                                         "step that differs [its --seconds: all]");
  verb->add_option("--record", arguments->record,
                   "Write the state after every step, to compare with --replay elsewhere")
      ->excludes(replay);
  verb->add_option("--threads", arguments->threads,
                   "Threads to use [all cores]; the result does not depend on it")
      ->check(CLI::Range(0, 1024));
  verb->footer(
      "Examples:\n"
      "  liana simulate data/scenes/wall.toml --seconds 60 --png wall.png --mp4 wall.mp4 --export wall.glb\n"
      "  liana simulate data/scenes/wall.toml --replay pulled.session --mp4 pulled.mp4\n\n"
      "Exit code: 0 done, 1 bad input, 2 bad command line, 130 stopped by Ctrl-C");
  verb->callback([arguments, &exit_code] { exit_code = simulate(*arguments); });
}

}  // namespace liana
