// Triangles as half-edges: who lies beside whom, kept up to date while edges are split, flipped and
// collapsed.
#pragma once

#include <memory>
#include <vector>

#include "mesher/geometry/mesh_checks.h"

namespace liana {

/// One side of an edge. It runs along its triangle counter-clockwise; the outer side of a border has none.
using HalfEdge = Id<struct HalfEdgeTag>;

/// The connectivity of a surface. Vertices and triangles keep the numbers they have in the mesh, whatever is
/// done to it; what is added gets the next ones. Positions are the caller's.
///
/// The kernel (OpenMesh) holds oriented manifolds only. A surface is taken apart first where fans touch at a
/// vertex, where neighbours are wound against one another and where more than two triangles share an edge:
/// there it has borders then. Ends of half-edges still go by the mesh's numbers.
class HalfEdgeMesh {
 public:
  explicit HalfEdgeMesh(const Mesh& mesh) : HalfEdgeMesh(mesh, find_adjacency(mesh)) {}
  HalfEdgeMesh(const Mesh& mesh, const Adjacency& adjacency);
  ~HalfEdgeMesh();
  HalfEdgeMesh(const HalfEdgeMesh&) = delete;
  HalfEdgeMesh& operator=(const HalfEdgeMesh&) = delete;

  static constexpr uint32_t kNone = Id<Mesh>::kNone;

  uint32_t triangle_count() const;  ///< those removed included
  uint32_t half_edge_count() const;
  bool removed(uint32_t triangle) const;
  Triangle corners(uint32_t triangle) const;
  std::vector<Triangle> triangles() const;  ///< those left, in order

  HalfEdge half_edge(uint32_t triangle, int k) const;  ///< from corner k to the next
  HalfEdge next(HalfEdge h) const;                     ///< around the triangle, or along the border
  HalfEdge opposite(HalfEdge h) const;
  uint32_t from(HalfEdge h) const;
  uint32_t to(HalfEdge h) const;
  uint32_t apex(HalfEdge h) const { return to(next(h)); }  ///< third corner of its triangle
  uint32_t triangle(HalfEdge h) const;                     ///< kNone on the outer side of a border
  /// The side of its edge that was there first.
  HalfEdge first_side(HalfEdge h) const { return HalfEdge(h.index() & ~size_t{1}); }

  /// Half-edges that leave `from(h)`, h first.
  std::vector<HalfEdge> leaving(HalfEdge h) const;

  /// Puts a vertex (its number is the caller's) on the edge of h, which then ends there. The triangles beside
  /// it keep the half at from(h); the other halves come last, first_side's before the other's.
  void split(HalfEdge h, uint32_t vertex);

  /// Turns the edge of h = (a, b): triangles (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c). False,
  /// and nothing done, on a border or if c and d have an edge already.
  bool flip(HalfEdge h);

  /// Moves from(h) onto to(h); the triangles beside the edge go. False, and nothing done, if the surface
  /// would not stay a manifold of the same topology.
  bool collapse(HalfEdge h);

  /// Vertices of every border, in the direction of their triangles' edges (the surface to the left, seen from
  /// outside), by first triangle. A vertex where two borders touch is in both.
  std::vector<std::vector<uint32_t>> border_loops() const;

 private:
  struct Kernel;
  std::unique_ptr<Kernel> kernel_;
};

}  // namespace liana
