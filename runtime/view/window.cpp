#include "runtime/view/window.h"

#include <epoxy/gl.h>
// After epoxy, which stands in for the system's OpenGL header.
#include <GLFW/glfw3.h>

#include <chrono>
#include <memory>
#include <optional>
#include <tuple>

#include "mesher/base/error.h"
#include "runtime/view/overlays.h"

namespace liana {
namespace {

std::string glfw_reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason given";
}

/// GLFW and one window with a current OpenGL 3.3 core context.
class Window {
 public:
  explicit Window(const EditorOptions& options) {
    if (!glfwInit())
      throw Error(Error::Kind::Usage, "no display to open a window on (" + glfw_reason() + ")",
                  "use `liana simulate SCENE --png FILE` or `--mp4 FILE`: they draw without one");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
    if (!window_) {
      const std::string reason = glfw_reason();
      glfwTerminate();
      throw Error(Error::Kind::Output, "no window with OpenGL 3.3 can be opened (" + reason + ")",
                  "install the Debian package libgl1-mesa-dri, or use `liana simulate SCENE --png FILE`");
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  GLFWwindow* get() const { return window_; }
  void framebuffer_size(int& width, int& height) const { glfwGetFramebufferSize(window_, &width, &height); }

 private:
  GLFWwindow* window_ = nullptr;
};

EditorCore& core_of(GLFWwindow* window) {
  return *static_cast<EditorCore*>(glfwGetWindowUserPointer(window));
}

/// Mouse positions come in screen units; the picture's pixels may be finer.
std::pair<double, double> pixels(GLFWwindow* window, double x, double y) {
  int width = 1, height = 1;
  glfwGetWindowSize(window, &width, &height);
  const EditorCore& core = core_of(window);
  return {x * core.width() / std::max(1, width), y * core.height() / std::max(1, height)};
}

void on_button(GLFWwindow* window, int button, int action, int modifiers) {
  double x = 0, y = 0;
  glfwGetCursorPos(window, &x, &y);
  std::tie(x, y) = pixels(window, x, y);
  const MouseButton which = button == GLFW_MOUSE_BUTTON_LEFT     ? MouseButton::Left
                            : button == GLFW_MOUSE_BUTTON_MIDDLE ? MouseButton::Middle
                                                                 : MouseButton::Right;
  core_of(window).handle(ButtonEvent{which, action == GLFW_PRESS, x, y, (modifiers & GLFW_MOD_SHIFT) != 0,
                                     (modifiers & GLFW_MOD_ALT) != 0});
}

void on_move(GLFWwindow* window, double x, double y) {
  std::tie(x, y) = pixels(window, x, y);
  core_of(window).handle(MoveEvent{x, y});
}

std::optional<Key> key_of(int code) {
  switch (code) {
    case GLFW_KEY_SPACE:
      return Key::Pause;
    case GLFW_KEY_PERIOD:
    case GLFW_KEY_RIGHT:
      return Key::Step;
    case GLFW_KEY_F:
    case GLFW_KEY_HOME:
      return Key::FrameAll;
    case GLFW_KEY_S:
      return Key::Stats;
    case GLFW_KEY_X:
      return Key::Cut;
    case GLFW_KEY_ESCAPE:
    case GLFW_KEY_Q:
      return Key::Quit;
    default:
      return {};
  }
}

void on_key(GLFWwindow* window, int code, int, int action, int) {
  const std::optional<Key> key = key_of(code);
  // Holding a key repeats single steps, nothing else.
  if (key && (action == GLFW_PRESS || (action == GLFW_REPEAT && *key == Key::Step)))
    core_of(window).handle(KeyEvent{*key});
}

void listen(GLFWwindow* window, EditorCore& core) {
  glfwSetWindowUserPointer(window, &core);
  glfwSetMouseButtonCallback(window, on_button);
  glfwSetCursorPosCallback(window, on_move);
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double dy) { core_of(w).handle(ScrollEvent{dy}); });
  glfwSetKeyCallback(window, on_key);
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int width, int height) {
    core_of(w).handle(ResizeEvent{width, height});
  });
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

int run_editor(Simulation& simulation, const EditorOptions& options) {
  const Window window(options);
  EditorOptions sized = options;
  window.framebuffer_size(sized.width, sized.height);
  EditorCore core(simulation, sized);
  listen(window.get(), core);
  float scale_x = 1, scale_y = 1;
  glfwGetWindowContentScale(window.get(), &scale_x, &scale_y);
  Renderer renderer;
  Overlay overlay;

  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now(), last_change = last, last_frame = last;
  OverlayText text;
  while (!core.quit_wanted() && !glfwWindowShouldClose(window.get())) {
    if (core.paused() && !core.changed())
      glfwWaitEventsTimeout(0.1);
    else
      glfwPollEvents();
    const Clock::time_point now = Clock::now();
    core.advance(seconds_between(last, now));
    last = now;
    if (core.changed()) last_change = now;
    const Clock::time_point before_draw = Clock::now();
    if (!core.draw(renderer, seconds_between(last_change, now))) {
      if (!core.paused()) glfwWaitEventsTimeout(0.25 * simulation.time_step());
      continue;
    }
    renderer.copy_to_screen(core.width(), core.height());
    text.stats = simulation.stats();
    text.paused = core.paused();
    text.grabbing = core.grab().has_value();
    text.stats_shown = core.stats_shown();
    overlay.draw(text, core.width(), core.height(), scale_x);
    glFinish();  // the time measured is the drawing's, not the display's
    const double drawing = seconds_between(before_draw, Clock::now());
    glfwSwapBuffers(window.get());
    core.report_frame_time(drawing);
    text.draw_ms = 1e3 * drawing;
    const double frame = seconds_between(last_frame, Clock::now());
    last_frame = Clock::now();
    text.frames_per_second =
        text.frames_per_second > 0 ? 0.9 * text.frames_per_second + 0.1 / frame : 1 / frame;
  }
  return 0;
}

}  // namespace liana
