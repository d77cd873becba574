#include "runtime/view/editor_core.h"

#include <algorithm>

#include "runtime/sim/model/grab_spring.h"

namespace liana {
namespace {

constexpr double kRestBeforeFine = 0.25;  // s

}  // namespace

EditorCore::EditorCore(Simulation& simulation, const EditorOptions& options)
    : simulation_(simulation), width_(options.width), height_(options.height), paused_(options.paused) {
  camera_.elevation = 0.14;
  if (options.camera)
    camera_ = *options.camera;
  else
    frame_all();
}

void EditorCore::handle(const InputEvent& event) {
  std::visit([this](const auto& one) { on(one); }, event);
}

void EditorCore::on(const ButtonEvent& event) {
  mouse_x_ = event.x;
  mouse_y_ = event.y;
  if (!event.down) {
    if (event.button != drag_button_) return;
    if (drag_ == Drag::Grab) release_grab();
    drag_ = Drag::None;
    return;
  }
  if (drag_ != Drag::None) return;  // a second button does not disturb the drag
  drag_button_ = event.button;
  if (event.button == MouseButton::Right || event.shift)
    drag_ = Drag::Pan;
  else if (event.button == MouseButton::Left && !event.alt && try_grab(event.x, event.y))
    drag_ = Drag::Grab;
  else
    drag_ = Drag::Orbit;
}

void EditorCore::on(const MoveEvent& event) {
  const double dx = event.x - mouse_x_, dy = event.y - mouse_y_;
  mouse_x_ = event.x;
  mouse_y_ = event.y;
  if (drag_ == Drag::Orbit) camera_.orbit(dx, dy, height_);
  if (drag_ == Drag::Pan) camera_.pan(dx, dy, height_);
  if (drag_ == Drag::Grab) move_grab(event.x, event.y);
  if (drag_ == Drag::Orbit || drag_ == Drag::Pan) view_changed_ = true;
}

void EditorCore::on(const ScrollEvent& event) {
  camera_.zoom(event.notches);
  view_changed_ = true;
}

void EditorCore::on(const KeyEvent& event) {
  view_changed_ = true;  // the overlay tells what is on
  switch (event.key) {
    case Key::Pause:
      paused_ = !paused_;
      waiting_ = 0;
      break;
    case Key::Step:
      paused_ = true;
      step();
      break;
    case Key::FrameAll:
      frame_all();
      break;
    case Key::Stats:
      stats_shown_ = !stats_shown_;
      break;
    case Key::Cut:
      cut();
      break;
    case Key::Quit:
      quit_wanted_ = true;
      break;
  }
}

void EditorCore::on(const ResizeEvent& event) {
  width_ = std::max(1, event.width);  // a minimised window has no size
  height_ = std::max(1, event.height);
  view_changed_ = true;
}

bool EditorCore::try_grab(double x, double y) {
  grab_ = pick_particle(simulation_, scene().meshes, camera_, x, y, width_, height_);
  if (!grab_) return false;
  spring_ = grab_spring(simulation_.plant(grab_->plant), grab_->particle, grab_->on_particle,
                        simulation_.gravity(), simulation_.time_step());
  simulation_.set_grab(grab_->plant, spring_);
  return true;
}

void EditorCore::cut() {
  const auto pick = pick_particle(simulation_, scene().meshes, camera_, mouse_x_, mouse_y_, width_, height_);
  if (!pick) return;
  if (drag_ == Drag::Grab) {  // the ids that it holds may change
    release_grab();
    drag_ = Drag::None;
  }
  simulation_.cut(pick->plant, pick->particle);
  world_changed_ = scene_is_old_ = true;
}

void EditorCore::move_grab(double x, double y) {
  // The target stays in the plane through the grabbed point that faces the camera.
  const Ray ray = camera_.ray(x, y, width_, height_);
  const double depth = (grab_->point - ray.origin).dot(camera_.forward());
  spring_.target = ray.origin + depth / ray.direction.dot(camera_.forward()) * ray.direction;
  simulation_.set_grab(grab_->plant, spring_);
}

void EditorCore::release_grab() {
  simulation_.clear_grab();
  grab_.reset();
}

void EditorCore::step() {
  simulation_.step();
  world_changed_ = scene_is_old_ = true;
}

void EditorCore::advance(double elapsed) {
  if (paused_) return;
  const double time_step = simulation_.time_step();
  waiting_ = std::min(waiting_ + elapsed, kMostSteps * time_step);
  for (; waiting_ >= time_step; waiting_ -= time_step) step();
}

void EditorCore::frame_all() {
  BoundingBox box = bounding_box(scene());
  if (box.empty()) box.add({0, 0.5, 0}, 0.5);
  camera_.frame(box, double(width_) / height_);
}

const DrawScene& EditorCore::scene() {
  if (scene_is_old_) {
    scene_ = DrawScene{};
    simulation_.draw(scene_);
    scene_is_old_ = false;
  }
  return scene_;
}

bool EditorCore::draw(Renderer& renderer, double seconds_at_rest) {
  const bool refine = !changed() && !refined_ && paused_ && seconds_at_rest >= kRestBeforeFine;
  if (!changed() && !refine) return false;
  if (world_changed_) renderer.set_scene(scene());
  FrameOptions options;
  if (refine) {
    options = still_frame(width_, height_);
  } else {
    options.width = std::max(1, int(width_ * moving_scale_));
    options.height = std::max(1, int(height_ * moving_scale_));
  }
  renderer.draw(camera_, options);
  world_changed_ = view_changed_ = false;
  refined_ = refine;
  return true;
}

void EditorCore::report_frame_time(double seconds) {
  if (refined_) return;
  constexpr double kSlow = 0.09, kFast = 0.035;  // s
  if (seconds > kSlow) moving_scale_ = std::max(0.5, 0.8 * moving_scale_);
  if (seconds < kFast) moving_scale_ = std::min(1.0, 1.1 * moving_scale_);
}

}  // namespace liana
