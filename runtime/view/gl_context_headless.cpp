#include "runtime/view/gl_context_headless.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <vector>

#include "mesher/base/error.h"

namespace liana {
namespace {

struct Candidate {
  EGLDisplay display;
  std::string name;
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> found;
  if (!epoxy_has_egl() || !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) return found;
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                     "surfaceless"});
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (eglQueryDevicesEXT(16, devices, &count))
      for (EGLint i = 0; i < count; ++i)
        found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr),
                         fmt::format("device {}", i)});
  }
  return found;
}

/// A current context, or the reason why not.
EGLContext try_context(EGLDisplay display, std::string& reason) {
  const auto failed = [&](const char* step) {
    reason = fmt::format("{} failed, EGL error {:#x}", step, eglGetError());
    return EGL_NO_CONTEXT;
  };
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return failed("eglInitialize");
  if (!eglBindAPI(EGL_OPENGL_API)) return failed("eglBindAPI");
  const EGLint config_wish[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  const EGLint context_wish[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  if (!eglChooseConfig(display, config_wish, &config, 1, &count) || count == 0)
    return failed("eglChooseConfig");
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_wish);
  if (context == EGL_NO_CONTEXT) return failed("OpenGL 3.3 core");
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    failed("eglMakeCurrent without a surface");
    eglDestroyContext(display, context);
    return EGL_NO_CONTEXT;
  }
  return context;
}

}  // namespace

HeadlessContext::HeadlessContext() {
  std::string tried;
  for (const Candidate& candidate : candidates()) {
    std::string reason;
    const EGLContext context = try_context(candidate.display, reason);
    if (context != EGL_NO_CONTEXT) {
      display_ = candidate.display;
      context_ = context;
      description_ =
          fmt::format("{}, {}", reinterpret_cast<const char*>(glGetString(GL_RENDERER)), candidate.name);
      return;
    }
    tried += fmt::format("{}{}: {}", tried.empty() ? "" : "; ", candidate.name, reason);
  }
  throw Error(
      Error::Kind::Output,
      fmt::format("no OpenGL 3.3 for drawing without a screen ({})",
                  tried.empty() ? "no EGL platform" : tried),
      "install the Debian packages libegl1 and libgl1-mesa-dri (software drawing, no graphics card needed)");
}

HeadlessContext::~HeadlessContext() {
  // No eglTerminate: it unloads the driver, whose last allocations then look like leaks.
  if (eglGetCurrentContext() == context_)
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

void HeadlessContext::make_current() {
  require(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_), "eglMakeCurrent failed");
}

}  // namespace liana
