#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runtime/app/scene/scene_preparation.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"
#include "runtime/view/window.h"
#include "runtime/world/session.h"
#include "runtime/world/world_drawing.h"

namespace liana {
namespace {

struct EditArguments {
  std::filesystem::path scene, record;
  std::vector<int> size = {1280, 720};
  std::string camera;
  bool paused = false;
  unsigned threads = 0;
};

int edit(const EditArguments& arguments) {
  if (!arguments.record.empty()) require_writable_folder(arguments.record);
  EditorOptions options;
  options.width = arguments.size[0];
  options.height = arguments.size[1];
  options.paused = arguments.paused;
  if (!arguments.camera.empty()) options.camera = Camera::parse(arguments.camera);
  const Scene scene = load_scene(arguments.scene);
  World world(scene, arguments.threads);
  options.title = "liana - " + arguments.scene.filename().string();
  if (!options.camera) options.camera = camera_of(world);
  if (arguments.record.empty()) return run_editor(world, options);
  SessionRecorder recorder(world, arguments.record);
  return run_editor(recorder, options);
}

}  // namespace

void add_edit_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<EditArguments>();
  CLI::App* verb =
      app.add_subcommand("edit", "Open a scene in a window: look around, pause, pull at branches");
  verb->add_option("scene", arguments->scene, "The scene (.toml); see data/scenes")->required();
  verb->add_option("--size", arguments->size, "Width and height of the window in pixels [1280 720]")
      ->expected(2)
      ->check(CLI::Range(64, 8192));
  verb->add_option(
      "--camera", arguments->camera,
      "Where to look from, as \"pivot 0 1 0 distance 5 azimuth 20 elevation 10\" [what the scene says]");
  verb->add_option(
      "--record", arguments->record,
      "Write all that is done, and the state after every step: liana simulate SCENE --replay FILE");
  verb->add_flag("--paused", arguments->paused, "Start paused");
  verb->add_option("--threads", arguments->threads, "Threads to use [all cores]")->check(CLI::Range(0, 1024));
  verb->footer(
      "Mouse: drag a branch to bend it; drag elsewhere or with the middle button to orbit, with shift or the "
      "right\n"
      "button to pan; wheel to zoom. Keys: space pause, . step, F frame all, S numbers, X cut, Q quit.\n\n"
      "Examples:\n"
      "  liana edit data/scenes/wall.toml\n"
      "  liana edit data/scenes/wall.toml --paused --size 1600 900\n"
      "  liana edit data/scenes/wall.toml --record pulled.session");
  verb->callback([arguments, &exit_code] { exit_code = edit(*arguments); });
}

}  // namespace liana
