#include "runtime/view/renderer.h"

#include <epoxy/gl.h>

#include "mesher/base/error.h"
#include "runtime/picture/glm_types.h"
#include "runtime/picture/leaf_mesh.h"

namespace liana {
namespace {

/// A target or shadow map that fits, kept from frame to frame.
const FrameTarget& fitting(std::unique_ptr<FrameTarget>& kept, int width, int height, int samples) {
  if (!kept || kept->width() != width || kept->height() != height || kept->samples() != samples)
    kept = std::make_unique<FrameTarget>(width, height, samples);
  return *kept;
}

/// ray_corner + x ray_right + y ray_up is the ray through pixel (x, y), y counted from below.
void set_rays(ShaderProgram& program, const Camera& camera, int width, int height) {
  const double pixel = camera.pixel_size(1, height);
  const Vec3 corner = camera.forward() - pixel * (width / 2.0 * camera.right() + height / 2.0 * camera.up());
  program.set("ray_corner", to_glm_float(corner));
  program.set("ray_right", to_glm_float(pixel * camera.right()));
  program.set("ray_up", to_glm_float(pixel * camera.up()));
}

}  // namespace

FrameOptions still_frame(int width, int height) {
  return {.width = width,
          .height = height,
          .samples = 4,
          .shadow_size = 4096,
          .shadow_taps = 4,
          .ambient_occlusion = true};
}

Renderer::Renderer() = default;

void Renderer::draw(const Camera& camera, const FrameOptions& options) {
  const FrameTarget& target = fitting(target_, options.width, options.height, options.samples);
  if (!shadow_ || shadow_->size() != options.shadow_size)
    shadow_ = std::make_unique<ShadowMap>(options.shadow_size);
  const SunView sun = sun_view(buffers_.box(), buffers_.to_sun());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glCullFace(GL_BACK);
  draw_shadows(sun);

  target.bind();
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow_->texture());
  const glm::mat4 view_projection = camera.projection(double(options.width) / options.height) * camera.view();
  const double texel = sun.extent / options.shadow_size;
  for (ShaderProgram* program : {&tube_, &leaf_, &mesh_, &ground_, &sky_, &streak_}) {
    program->use();
    program->set("view_projection", view_projection);
    program->set("light_matrix", sun.to_texture);
    program->set("eye", to_glm_float(camera.eye()));
    program->set("to_sun", to_glm_float(buffers_.to_sun()));
    program->set("shadow_texel", float(texel));
    // Half a pixel at least, so that the filter always blurs the map's own grid.
    program->set("shadow_softness", float(std::max(0.5, options.shadow_softness / texel / 2)));
    program->set("shadow_taps", options.shadow_taps);
    program->set("shadow_map", 0);
  }
  draw_plants(tube_, leaf_);
  draw_surroundings(camera, options);
  draw_streaks(options);
  target.resolve();
  last_ = &target;
  if (options.ambient_occlusion) draw_occlusion(camera, options);
}

void Renderer::draw_shadows(const SunView& sun) {
  shadow_->bind_and_clear();
  for (ShaderProgram* program : {&tube_shadow_, &leaf_shadow_, &mesh_shadow_}) {
    program->use();
    program->set("view_projection", sun.to_clip);
  }
  draw_plants(tube_shadow_, leaf_shadow_);
  mesh_shadow_.use();
  for (const SceneBuffers::MeshRange& range : buffers_.meshes()) buffers_.draw_mesh(range);
}

void Renderer::draw_plants(ShaderProgram& tubes, ShaderProgram& leaves) {
  // What is under the ground is cut away rather than hidden: the ground is seen from above only.
  if (buffers_.ground()) glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_CULL_FACE);
  tubes.use();
  buffers_.draw_tubes();
  glDisable(GL_CULL_FACE);
  leaves.use();
  leaves.set("fold", kLeafFold);
  for (int outline = 0; outline < kLeafOutlineCount; ++outline) {
    leaves.set("outline", outline);
    buffers_.draw_leaves(LeafOutline(outline));
  }
  glDisable(GL_CLIP_DISTANCE0);
}

void Renderer::draw_surroundings(const Camera& camera, const FrameOptions& options) {
  mesh_.use();
  for (const SceneBuffers::MeshRange& range : buffers_.meshes()) {
    mesh_.set("base_color", range.color);
    mesh_.set("bricks", int(range.bricks));
    buffers_.draw_mesh(range);
  }
  glBindVertexArray(no_vertices_.id());
  if (buffers_.ground()) {
    glEnable(GL_CULL_FACE);
    ground_.use();
    set_rays(ground_, camera, options.width, options.height);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_CULL_FACE);
  }
  sky_.use();
  set_rays(sky_, camera, options.width, options.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::draw_streaks(const FrameOptions& options) {
  streak_.use();
  streak_.set("half_pixel", glm::vec2(1.0f / float(options.width), 1.0f / float(options.height)));
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDepthMask(GL_FALSE);
  buffers_.draw_streaks();
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Renderer::draw_occlusion(const Camera& camera, const FrameOptions& options) {
  const FrameTarget& finished = fitting(finished_, options.width, options.height, 1);
  finished.bind();
  glDisable(GL_DEPTH_TEST);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, target_->color());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, target_->depth());
  const glm::mat4 projection = camera.projection(double(options.width) / options.height);
  occlusion_.use();
  occlusion_.set("color_picture", 0);
  occlusion_.set("depth_picture", 1);
  occlusion_.set("slopes", glm::vec2(1 / projection[0][0], 1 / projection[1][1]));
  occlusion_.set("depth_terms", glm::vec2(projection[2][2], projection[3][2]));
  occlusion_.set("reach", float(0.035 * camera.distance));
  glBindVertexArray(no_vertices_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glActiveTexture(GL_TEXTURE0);
  last_ = &finished;
}

Image Renderer::read() const {
  require(last_, "Renderer::read before draw");
  return last_->read();
}

void Renderer::copy_to_screen(int width, int height) const {
  require(last_, "Renderer::copy_to_screen before draw");
  last_->copy_to_screen(width, height);
}

Image HeadlessRenderer::render(const DrawScene& scene, const Camera& camera, const FrameOptions& options) {
  context_.make_current();
  renderer_.set_scene(scene, options.samples > 1 ? 10 : 7);
  renderer_.draw(camera, options);
  return renderer_.read();
}

}  // namespace liana
