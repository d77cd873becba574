// A triangle surface with normals at every closest point: of a closed one, they tell inside from outside.
#pragma once

#include <array>

#include "mesher/geometry/mesh.h"

namespace liana {

/// The part of a triangle a closest point lies on: its face, edge 0..2 (from corner i to i+1) or corner 0..2.
struct TriangleFeature {
  enum Kind : uint8_t { Face, Edge, Corner } kind = Face;
  uint8_t index = 0;
};

/// The point of triangle abc closest to x.
struct TrianglePoint {
  Vec3 point;
  TriangleFeature feature;
  double squared_distance;
};
TrianglePoint closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

/// Vertices welded by exact position. The angle-weighted pseudonormals of [Baerentzen & Aanaes 2005]: with x
/// outside of a closed mesh, (x - c)·normal(c) > 0 for its closest point c, whatever feature c lies on.
class ClosedMesh {
 public:
  /// Throws Error{Input} for an empty or non-finite mesh, and unless `may_be_open` for an open or inside-out
  /// one, saying where.
  explicit ClosedMesh(const Mesh& mesh, bool may_be_open = false);

  const Mesh& mesh() const { return mesh_; }
  const Vec3& face_normal(uint32_t triangle) const { return face_normals_[triangle]; }
  const Vec3& pseudonormal(uint32_t triangle, TriangleFeature feature) const;  ///< unit

 private:
  Mesh mesh_;
  std::vector<Vec3> face_normals_, corner_normals_;
  std::vector<std::array<Vec3, 3>> edge_normals_;  ///< one triple per triangle
};

}  // namespace liana
