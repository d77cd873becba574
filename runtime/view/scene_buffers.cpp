#include "runtime/view/scene_buffers.h"

#include <epoxy/gl.h>

#include "runtime/picture/leaf_mesh.h"
#include "runtime/picture/smooth_normals.h"

namespace liana {
namespace {

struct LeafInstance {
  glm::vec3 base;
  glm::vec4 orientation;  // x y z w
  glm::vec3 size;         // length, width, curl
  glm::u8vec4 color;
};

struct StreakInstance {
  glm::vec3 from, to;
  glm::u8vec4 color;
};

struct MeshVertex {
  glm::vec3 position, normal;
};

template <class T>
void fill(GLenum target, const GlObject& buffer, const std::vector<T>& values) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, GLsizeiptr(values.size() * sizeof(T)), values.data(), GL_STREAM_DRAW);
}

void attribute(int location, int count, size_t stride, size_t offset, bool per_instance = false,
               bool bytes = false) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, count, bytes ? GL_UNSIGNED_BYTE : GL_FLOAT, bytes, GLsizei(stride),
                        reinterpret_cast<const void*>(offset));
  if (per_instance) glVertexAttribDivisor(location, 1);
}

}  // namespace

SceneBuffers::SceneBuffers() {
  glBindVertexArray(tube_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, tube_vertices_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, tube_indices_.id());
  attribute(0, 3, sizeof(TubeVertex), offsetof(TubeVertex, position));
  attribute(1, 3, sizeof(TubeVertex), offsetof(TubeVertex, normal));
  attribute(2, 3, sizeof(TubeVertex), offsetof(TubeVertex, bark));
  attribute(3, 4, sizeof(TubeVertex), offsetof(TubeVertex, color), false, true);

  for (int outline = 0; outline < kLeafOutlineCount; ++outline) {
    Leaves& leaves = leaves_[outline];
    const LeafShape& shape = leaf_shape(LeafOutline(outline));
    glBindVertexArray(leaves.array.id());
    fill(GL_ARRAY_BUFFER, leaves.shape, shape.points);
    attribute(0, 2, sizeof(glm::vec2), 0);
    fill(GL_ELEMENT_ARRAY_BUFFER, leaves.indices, shape.triangles);
    leaves.index_count = int(3 * shape.triangles.size());
    glBindBuffer(GL_ARRAY_BUFFER, leaves.instances.id());
    attribute(1, 3, sizeof(LeafInstance), offsetof(LeafInstance, base), true);
    attribute(2, 4, sizeof(LeafInstance), offsetof(LeafInstance, orientation), true);
    attribute(3, 3, sizeof(LeafInstance), offsetof(LeafInstance, size), true);
    attribute(4, 4, sizeof(LeafInstance), offsetof(LeafInstance, color), true, true);
  }

  glBindVertexArray(mesh_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, mesh_vertices_.id());
  attribute(0, 3, sizeof(MeshVertex), offsetof(MeshVertex, position));
  attribute(1, 3, sizeof(MeshVertex), offsetof(MeshVertex, normal));

  glBindVertexArray(streak_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, streak_instances_.id());
  attribute(0, 3, sizeof(StreakInstance), offsetof(StreakInstance, from), true);
  attribute(1, 3, sizeof(StreakInstance), offsetof(StreakInstance, to), true);
  attribute(2, 4, sizeof(StreakInstance), offsetof(StreakInstance, color), true, true);
  glBindVertexArray(0);
}

void SceneBuffers::upload(const DrawScene& scene, int tube_sides) {
  box_ = bounding_box(scene);
  to_sun_ = scene.to_sun.norm() > 0 ? Vec3(scene.to_sun.normalized()) : Vec3(Vec3::UnitY());
  ground_ = scene.ground;

  tube_mesh_.vertices.clear();
  tube_mesh_.triangles.clear();
  for (const DrawTube& tube : scene.tubes) append_tube(tube, tube_sides, tube_mesh_);
  glBindVertexArray(tube_array_.id());
  fill(GL_ARRAY_BUFFER, tube_vertices_, tube_mesh_.vertices);
  fill(GL_ELEMENT_ARRAY_BUFFER, tube_indices_, tube_mesh_.triangles);
  tube_index_count_ = int(3 * tube_mesh_.triangles.size());

  std::vector<LeafInstance> instances[kLeafOutlineCount];
  for (const DrawLeaf& leaf : scene.leaves)
    instances[int(leaf.outline)].push_back({to_glm_float(leaf.base), to_glm_float(leaf.orientation),
                                            glm::vec3(leaf.length, leaf.width, leaf.curl),
                                            packed_color(leaf.color)});
  for (int outline = 0; outline < kLeafOutlineCount; ++outline) {
    fill(GL_ARRAY_BUFFER, leaves_[outline].instances, instances[outline]);
    leaves_[outline].instance_count = int(instances[outline].size());
  }

  std::vector<StreakInstance> streaks;
  for (const DrawStreak& streak : scene.streaks)
    streaks.push_back(
        {to_glm_float(streak.from), to_glm_float(streak.to), packed_color(streak.color, streak.opacity)});
  fill(GL_ARRAY_BUFFER, streak_instances_, streaks);
  streak_count_ = int(streaks.size());

  std::vector<MeshVertex> vertices;
  mesh_ranges_.clear();
  for (const DrawMesh& mesh : scene.meshes) {
    const std::vector<Vec3> normals = corner_normals(mesh.mesh);
    mesh_ranges_.push_back(
        {int(vertices.size()), int(normals.size()), to_glm_float(mesh.color), mesh.bricks});
    for (size_t corner = 0; corner < normals.size(); ++corner)
      vertices.push_back({to_glm_float(mesh.mesh.positions[mesh.mesh.triangles[corner / 3][corner % 3]]),
                          to_glm_float(normals[corner])});
  }
  fill(GL_ARRAY_BUFFER, mesh_vertices_, vertices);
}

void SceneBuffers::draw_tubes() const {
  glBindVertexArray(tube_array_.id());
  glDrawElements(GL_TRIANGLES, tube_index_count_, GL_UNSIGNED_INT, nullptr);
}

void SceneBuffers::draw_leaves(LeafOutline outline) const {
  const Leaves& leaves = leaves_[int(outline)];
  if (leaves.instance_count == 0) return;
  glBindVertexArray(leaves.array.id());
  glDrawElementsInstanced(GL_TRIANGLES, leaves.index_count, GL_UNSIGNED_INT, nullptr, leaves.instance_count);
}

void SceneBuffers::draw_streaks() const {
  if (streak_count_ == 0) return;
  glBindVertexArray(streak_array_.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, streak_count_);
}

void SceneBuffers::draw_mesh(const MeshRange& range) const {
  glBindVertexArray(mesh_array_.id());
  glDrawArrays(GL_TRIANGLES, range.first, range.count);
}

}  // namespace liana
