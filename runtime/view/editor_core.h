// The editor without its window: it takes input events, runs the simulation and knows what to draw. Driven by
// window.cpp with a real mouse and by tests without one.
#pragma once

#include <optional>
#include <variant>

#include "runtime/picture/picking.h"
#include "runtime/picture/simulation_view.h"
#include "runtime/view/renderer.h"

namespace liana {

enum class MouseButton : uint8_t { Left, Middle, Right };
enum class Key : uint8_t { Pause, Step, FrameAll, Stats, Cut, Quit };

/// Positions are pixels of the picture, from the upper left corner.
struct ButtonEvent {
  MouseButton button;
  bool down;
  double x, y;
  bool shift = false, alt = false;
};
struct MoveEvent {
  double x, y;
};
struct ScrollEvent {
  double notches;  ///< positive comes nearer
};
struct KeyEvent {
  Key key;
};
struct ResizeEvent {
  int width, height;
};
using InputEvent = std::variant<ButtonEvent, MoveEvent, ScrollEvent, KeyEvent, ResizeEvent>;

struct EditorOptions {
  std::string title = "liana";
  int width = 1280, height = 720;
  std::optional<Camera> camera;  ///< none: all of the scene fills the picture
  bool paused = false;
};

class EditorCore {
 public:
  EditorCore(Simulation& simulation, const EditorOptions& options);

  void handle(const InputEvent& event);
  /// Lets `elapsed` seconds of real time pass: as many steps as fit, at most kMostSteps, so a slow machine
  /// shows slow motion instead of falling ever further behind.
  void advance(double elapsed);
  static constexpr int kMostSteps = 4;

  /// Draws if anything changed since the last frame, or once more, finely, after things came to rest.
  /// Returns whether there is a new frame. `seconds_at_rest`: how long nothing has changed.
  bool draw(Renderer& renderer, double seconds_at_rest);
  /// How long the last frame took, s: slow machines get a coarser picture while things move.
  void report_frame_time(double seconds);

  const Camera& camera() const { return camera_; }
  bool paused() const { return paused_; }
  bool stats_shown() const { return stats_shown_; }
  bool quit_wanted() const { return quit_wanted_; }
  bool changed() const { return world_changed_ || view_changed_; }  ///< since the last draw()
  bool refined() const { return refined_; }                         ///< the last frame was the fine one
  const std::optional<Pick>& grab() const { return grab_; }
  const Simulation& simulation() const { return simulation_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  enum class Drag { None, Orbit, Pan, Grab };

  void on(const ButtonEvent& event);
  void on(const MoveEvent& event);
  void on(const ScrollEvent& event);
  void on(const KeyEvent& event);
  void on(const ResizeEvent& event);
  bool try_grab(double x, double y);
  void move_grab(double x, double y);
  void release_grab();
  void cut();
  void step();
  void frame_all();
  const DrawScene& scene();

  Simulation& simulation_;
  Camera camera_;
  int width_, height_;
  bool paused_, stats_shown_ = true, quit_wanted_ = false;
  bool world_changed_ = true, view_changed_ = true, scene_is_old_ = true, refined_ = false;
  double waiting_ = 0;       // s of real time not yet simulated
  double moving_scale_ = 1;  // of the picture's sides while things move
  Drag drag_ = Drag::None;
  MouseButton drag_button_ = MouseButton::Left;
  double mouse_x_ = 0, mouse_y_ = 0;
  std::optional<Pick> grab_;
  WorldSpring spring_;
  DrawScene scene_;
};

}  // namespace liana
