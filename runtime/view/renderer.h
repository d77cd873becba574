// Draws a DrawScene: shadow map, plants, obstacles, ground, sky, and for stills ambient occlusion and smooth
// edges.
#pragma once

#include <memory>

#include "runtime/picture/camera.h"
#include "runtime/view/frame_target.h"
#include "runtime/view/gl_context_headless.h"
#include "runtime/view/scene_buffers.h"
#include "runtime/view/shadow_map.h"

namespace liana {

struct FrameOptions {
  int width = 1280, height = 720;  ///< pixels
  int samples = 1;                 ///< 4: smooth edges
  int shadow_size = 2048;          ///< pixels of the shadow map's side
  int shadow_taps = 2;  ///< samples across a shadow's edge; each already blends four pixels of the map
  double shadow_softness = 0.02;  ///< m, half width of a shadow's blurred edge
  bool ambient_occlusion = false;
};

/// The picture to keep: everything on.
FrameOptions still_frame(int width, int height);

/// Needs an OpenGL 3.3 core context, current on the calling thread from before its making until after its
/// end.
class Renderer {
 public:
  Renderer();

  /// tube_sides: vertices around a branch; 6 or 7 while moving, 10 for stills.
  void set_scene(const DrawScene& scene, int tube_sides = 7) { buffers_.upload(scene, tube_sides); }
  void draw(const Camera& camera, const FrameOptions& options);
  Image read() const;                                ///< the frame drawn last
  void copy_to_screen(int width, int height) const;  ///< the same, to the window

 private:
  void draw_shadows(const SunView& sun);
  void draw_plants(ShaderProgram& tubes, ShaderProgram& leaves);
  void draw_surroundings(const Camera& camera, const FrameOptions& options);
  void draw_streaks(const FrameOptions& options);
  void draw_occlusion(const Camera& camera, const FrameOptions& options);

  SceneBuffers buffers_;
  ShaderProgram tube_{"tube.vert", "tube.frag"}, leaf_{"leaf.vert", "leaf.frag"},
      mesh_{"mesh.vert", "mesh.frag"};
  ShaderProgram ground_{"ground.vert", "ground.frag"}, sky_{"sky.vert", "sky.frag"};
  ShaderProgram streak_{"streak.vert", "streak.frag"};
  ShaderProgram occlusion_{"sky.vert", "occlusion.frag"};
  ShaderProgram tube_shadow_{"tube.vert", "shadow.frag"}, leaf_shadow_{"leaf.vert", "shadow.frag"};
  ShaderProgram mesh_shadow_{"mesh.vert", "shadow.frag"};
  GlObject no_vertices_{GlKind::VertexArray};
  std::unique_ptr<ShadowMap> shadow_;
  std::unique_ptr<FrameTarget> target_, finished_;
  const FrameTarget* last_ = nullptr;
};

/// Pictures without a screen.
class HeadlessRenderer {
 public:
  Image render(const DrawScene& scene, const Camera& camera, const FrameOptions& options);
  const std::string& description() const { return context_.description(); }

 private:
  HeadlessContext context_;
  Renderer renderer_;
};

}  // namespace liana
