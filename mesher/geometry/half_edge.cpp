#include "mesher/geometry/half_edge.h"

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <algorithm>

#include "mesher/geometry/fans.h"

namespace liana {
namespace {

using OpenMesh::FaceHandle;
using OpenMesh::VertexHandle;
using Half = OpenMesh::HalfedgeHandle;

Half handle(HalfEdge h) {
  return Half(static_cast<int>(h.value));
}
HalfEdge id(Half h) {
  return HalfEdge(static_cast<size_t>(h.idx()));
}
FaceHandle face(uint32_t triangle) {
  return FaceHandle(static_cast<int>(triangle));
}
bool is_flat(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Without the neighbours that run along their common edge in one direction.
Adjacency alike_only(const Mesh& mesh, Adjacency adjacency) {
  const auto runs = [&](uint32_t t, uint32_t from, uint32_t to) {
    const Triangle& c = mesh.triangles[t];
    return (c[0] == from && c[1] == to) || (c[1] == from && c[2] == to) || (c[2] == from && c[0] == to);
  };
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t k = 0; k < 3; ++k)
      if (uint32_t& other = adjacency.across[t][k]; other != Adjacency::kNone)
        if (!runs(other, mesh.triangles[t][(k + 1) % 3], mesh.triangles[t][k])) other = Adjacency::kNone;
  return adjacency;
}

}  // namespace

struct HalfEdgeMesh::Kernel : OpenMesh::TriConnectivity {
  std::vector<uint32_t> name;  // of a vertex, for others: several fans have the same

  VertexHandle new_name(uint32_t vertex) {
    name.push_back(vertex);
    return add_vertex();
  }

  void add(const Triangle& t) {
    if (!is_flat(t) && add_face(at(t[0]), at(t[1]), at(t[2])).is_valid()) return;
    // An edge whose ends are single fans, yet with more triangles than two.
    add_face(new_name(name[t[0]]), new_name(name[t[1]]), new_name(name[t[2]]));
  }

  static VertexHandle at(uint32_t v) { return VertexHandle(static_cast<int>(v)); }
  uint32_t name_of(VertexHandle v) const { return name[static_cast<size_t>(v.idx())]; }

  void link(FaceHandle f, Half first, Half second, Half third) {
    set_next_halfedge_handle(first, second);
    set_next_halfedge_handle(second, third);
    set_next_halfedge_handle(third, first);
    for (const Half h : {first, second, third}) set_face_handle(h, f);
  }

  /// The triangle (p, q, r) left of the edge h = (p, q), of which `middle` is about to be: (p, middle, r)
  /// stays, rest = (middle, q) gets the new one. Either way a corner that is replaced keeps its place in the
  /// order.
  void halve(Half h, Half rest, VertexHandle middle, bool towards) {
    const Half after = next_halfedge_handle(h), before = prev_halfedge_handle(h);
    if (is_boundary(h)) {
      set_boundary(rest);
      if (towards) {
        set_next_halfedge_handle(h, rest), set_next_halfedge_handle(rest, after);
      } else {
        set_next_halfedge_handle(before, rest), set_next_halfedge_handle(rest, h);
      }
      return;
    }
    const FaceHandle old = face_handle(h), added = new_face();
    const Half first = halfedge_handle(old);
    const VertexHandle apex = to_vertex_handle(after);
    if (towards) {
      const Half stays = new_edge(middle, apex), other = opposite_halfedge_handle(stays);
      link(old, h, stays, before), link(added, rest, after, other);
      set_halfedge_handle(old, first == after ? stays : first);
      set_halfedge_handle(added, first == h ? rest : first == after ? after : other);
    } else {
      const Half stays = new_edge(apex, middle), other = opposite_halfedge_handle(stays);
      link(old, h, after, stays), link(added, rest, other, before);
      set_halfedge_handle(old, first == before ? stays : first);
      set_halfedge_handle(added, first == h ? rest : first == before ? before : other);
    }
  }
};

HalfEdgeMesh::HalfEdgeMesh(const Mesh& mesh, const Adjacency& adjacency)
    : kernel_(std::make_unique<Kernel>()) {
  Fans fans = separate_fans(mesh, adjacency.oriented ? adjacency : alike_only(mesh, adjacency));
  kernel_->reserve(fans.vertex.size() + 64, 2 * fans.vertex.size() + mesh.triangles.size() + 128,
                   mesh.triangles.size() + 128);
  kernel_->resize(fans.vertex.size(), 0, 0);
  kernel_->name = std::move(fans.vertex);
  for (const Triangle& t : fans.triangles) kernel_->add(t);
}

HalfEdgeMesh::~HalfEdgeMesh() = default;

uint32_t HalfEdgeMesh::triangle_count() const {
  return static_cast<uint32_t>(kernel_->n_faces());
}

uint32_t HalfEdgeMesh::half_edge_count() const {
  return static_cast<uint32_t>(kernel_->n_halfedges());
}

bool HalfEdgeMesh::removed(uint32_t triangle) const {
  return kernel_->has_face_status() && kernel_->status(face(triangle)).deleted();
}

HalfEdge HalfEdgeMesh::half_edge(uint32_t triangle, int k) const {
  Half h = kernel_->halfedge_handle(face(triangle));  // ends at the first corner
  for (int i = 0; i <= k; ++i) h = kernel_->next_halfedge_handle(h);
  return id(h);
}

Triangle HalfEdgeMesh::corners(uint32_t triangle) const {
  Triangle t;
  Half h = kernel_->halfedge_handle(face(triangle));
  for (uint32_t& corner : t) {
    corner = kernel_->name_of(kernel_->to_vertex_handle(h));
    h = kernel_->next_halfedge_handle(h);
  }
  return t;
}

std::vector<Triangle> HalfEdgeMesh::triangles() const {
  std::vector<Triangle> all;
  all.reserve(triangle_count());
  for (uint32_t t = 0; t < triangle_count(); ++t)
    if (!removed(t)) all.push_back(corners(t));
  return all;
}

HalfEdge HalfEdgeMesh::next(HalfEdge h) const {
  return id(kernel_->next_halfedge_handle(handle(h)));
}
HalfEdge HalfEdgeMesh::opposite(HalfEdge h) const {
  return id(kernel_->opposite_halfedge_handle(handle(h)));
}
uint32_t HalfEdgeMesh::from(HalfEdge h) const {
  return kernel_->name_of(kernel_->from_vertex_handle(handle(h)));
}
uint32_t HalfEdgeMesh::to(HalfEdge h) const {
  return kernel_->name_of(kernel_->to_vertex_handle(handle(h)));
}
uint32_t HalfEdgeMesh::triangle(HalfEdge h) const {
  const FaceHandle f = kernel_->face_handle(handle(h));
  return f.is_valid() ? static_cast<uint32_t>(f.idx()) : kNone;
}

std::vector<HalfEdge> HalfEdgeMesh::leaving(HalfEdge h) const {
  std::vector<HalfEdge> all;
  Half at = handle(h);
  do {
    all.push_back(id(at));
    at = kernel_->cw_rotated_halfedge_handle(at);
  } while (at != handle(h));
  return all;
}

void HalfEdgeMesh::split(HalfEdge edge, uint32_t vertex) {
  Kernel& k = *kernel_;
  const Half h = handle(edge), o = k.opposite_halfedge_handle(h);
  const VertexHandle end = k.to_vertex_handle(h), middle = k.new_name(vertex);
  const bool forward = first_side(edge) == edge;
  // As of the edge, the first side of its new half is the first triangle's.
  const Half rest = forward ? k.new_edge(middle, end) : k.opposite_halfedge_handle(k.new_edge(end, middle));
  const Half back = k.opposite_halfedge_handle(rest);
  k.set_vertex_handle(h, middle);
  if (forward) k.halve(h, rest, middle, true);
  k.halve(o, back, middle, false);
  if (!forward) k.halve(h, rest, middle, true);
  // A vertex on the border names the half-edge that leaves it along the outside.
  k.set_halfedge_handle(middle, k.is_boundary(o) ? o : rest);
  if (k.halfedge_handle(end) == o) k.set_halfedge_handle(end, back);
}

bool HalfEdgeMesh::flip(HalfEdge h) {
  const OpenMesh::EdgeHandle edge = kernel_->edge_handle(handle(h));
  if (!kernel_->is_flip_ok(edge)) return false;
  kernel_->flip(edge);
  const Half own = handle(h), other = kernel_->opposite_halfedge_handle(own);
  kernel_->set_halfedge_handle(kernel_->face_handle(own), kernel_->next_halfedge_handle(own));
  kernel_->set_halfedge_handle(kernel_->face_handle(other), other);
  return true;
}

bool HalfEdgeMesh::collapse(HalfEdge h) {
  Kernel& k = *kernel_;
  if (!k.has_face_status()) {
    k.request_vertex_status(), k.request_halfedge_status();
    k.request_edge_status(), k.request_face_status();
  }
  const VertexHandle gone = k.from_vertex_handle(handle(h)), kept = k.to_vertex_handle(handle(h));
  if (!k.is_boundary(gone) && !k.is_boundary(kept) && k.valence(gone) + k.valence(kept) < 7)
    return false;  // a tetrahedron would fold up
  if (!k.is_collapse_ok(handle(h))) return false;
  k.collapse(handle(h));
  return true;
}

std::vector<std::vector<uint32_t>> HalfEdgeMesh::border_loops() const {
  std::vector<uint8_t> visited(half_edge_count(), 0);
  std::vector<std::vector<uint32_t>> loops;
  for (uint32_t t = 0; t < triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Half outer = handle(opposite(half_edge(t, k)));
      if (!kernel_->is_boundary(outer) || visited[static_cast<size_t>(outer.idx())]) continue;
      std::vector<uint32_t>& loop = loops.emplace_back();
      for (Half o = outer; !visited[static_cast<size_t>(o.idx())]; o = kernel_->prev_halfedge_handle(o)) {
        visited[static_cast<size_t>(o.idx())] = 1;
        loop.push_back(kernel_->name_of(kernel_->to_vertex_handle(o)));
      }
    }
  return loops;
}

}  // namespace liana
