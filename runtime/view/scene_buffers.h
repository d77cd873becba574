// The graphics card's copy of a DrawScene.
#pragma once

#include "runtime/picture/draw_scene.h"
#include "runtime/picture/tube_mesh.h"
#include "runtime/view/gl_objects.h"

namespace liana {

class SceneBuffers {
 public:
  SceneBuffers();
  void upload(const DrawScene& scene, int tube_sides);

  struct MeshRange {
    int first, count;  ///< vertices
    glm::vec3 color;
    bool bricks;
  };

  void draw_tubes() const;
  void draw_leaves(LeafOutline outline) const;
  void draw_mesh(const MeshRange& range) const;
  void draw_streaks() const;
  const std::vector<MeshRange>& meshes() const { return mesh_ranges_; }
  const BoundingBox& box() const { return box_; }  ///< of all that casts a shadow
  const Vec3& to_sun() const { return to_sun_; }   ///< unit
  bool ground() const { return ground_; }

 private:
  struct Leaves {
    GlObject array{GlKind::VertexArray}, shape{GlKind::Buffer}, indices{GlKind::Buffer},
        instances{GlKind::Buffer};
    int index_count = 0, instance_count = 0;
  };

  GlObject tube_array_{GlKind::VertexArray}, tube_vertices_{GlKind::Buffer}, tube_indices_{GlKind::Buffer};
  int tube_index_count_ = 0;
  Leaves leaves_[kLeafOutlineCount];
  GlObject mesh_array_{GlKind::VertexArray}, mesh_vertices_{GlKind::Buffer};
  GlObject streak_array_{GlKind::VertexArray}, streak_instances_{GlKind::Buffer};
  int streak_count_ = 0;
  std::vector<MeshRange> mesh_ranges_;
  BoundingBox box_;
  Vec3 to_sun_ = Vec3::UnitY();
  bool ground_ = true;
  TubeMesh tube_mesh_;  // kept to reuse its memory
};

}  // namespace liana
