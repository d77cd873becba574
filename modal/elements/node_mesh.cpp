#include "modal/elements/node_mesh.h"

#include <algorithm>

#include "mesher/base/error.h"

namespace liana {
namespace {

/// Numbers edges in the order they are first asked for. Each edge hangs in a list at its lower vertex.
class EdgeNumbers {
 public:
  EdgeNumbers(size_t vertices, size_t expected_edges) : first_(vertices, kEnd) {
    edges_.reserve(expected_edges);
  }

  uint32_t number(uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);
    for (uint32_t e = first_[a]; e != kEnd; e = edges_[e].next)
      if (edges_[e].upper == b) return e;
    edges_.push_back({a, b, first_[a]});
    return first_[a] = static_cast<uint32_t>(edges_.size() - 1);
  }
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Edge& e : edges_) visit(e.lower, e.upper);
  }

 private:
  static constexpr uint32_t kEnd = UINT32_MAX;
  struct Edge {
    uint32_t lower, upper, next;
  };
  std::vector<uint32_t> first_;
  std::vector<Edge> edges_;
};

}  // namespace

NodeMesh make_nodes(const TetMesh& mesh, Element element) {
  NodeMesh nodes;
  nodes.corners = mesh.positions.size();
  nodes.positions = mesh.positions;
  nodes.nodes_per_element = element == Element::T10 ? 10 : 4;
  nodes.elements.reserve(mesh.tets.size() * nodes.nodes_per_element);
  const auto corners = static_cast<uint32_t>(nodes.corners);
  EdgeNumbers edges(nodes.corners, element == Element::T10 ? 2 * mesh.tets.size() + 16 : 0);
  for (const auto& tet : mesh.tets) {
    nodes.elements.insert(nodes.elements.end(), tet.begin(), tet.end());
    if (element == Element::T4) continue;
    for (const auto& [a, b] : kTetEdges) nodes.elements.push_back(corners + edges.number(tet[a], tet[b]));
  }
  edges.for_each([&](uint32_t a, uint32_t b) {
    nodes.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
  });

  nodes.on_root.assign(nodes.positions.size(), 0);
  for (const auto& face : mesh.root_faces) {
    for (int k = 0; k < 3; ++k) {
      nodes.on_root[face[k]] = 1;
      if (element == Element::T10) {
        const uint32_t node = corners + edges.number(face[k], face[(k + 1) % 3]);
        require(node < nodes.positions.size(), "a root face is not a face of the tet mesh");
        nodes.on_root[node] = 1;
      }
    }
  }
  return nodes;
}

}  // namespace liana
