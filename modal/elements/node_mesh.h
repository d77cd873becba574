// Tetrahedra -> the nodes of linear (T4) or straight-sided quadratic (T10) elements.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/tets/tet_mesh.h"

namespace liana {

enum class Element { T10, T4 };

/// The edges that carry a T10 element's nodes 4..9, by its corners.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

struct NodeMesh {
  std::vector<Vec3> positions;  ///< m; the tet mesh's vertices first, then the mid-edge nodes
  size_t corners = 0;           ///< how many of the nodes are vertices of the tet mesh
  int nodes_per_element = 10;   ///< 10 or 4
  std::vector<uint32_t>
      elements;  ///< nodes_per_element each: 4 corners, then mid-edge nodes in kTetEdges' order
  std::vector<uint8_t> on_root;  ///< per node: 1 on a root face, mid-edge nodes included

  size_t element_count() const { return elements.size() / nodes_per_element; }
  std::span<const uint32_t> element(size_t e) const {
    return {&elements[e * nodes_per_element], size_t(nodes_per_element)};
  }
};

NodeMesh make_nodes(const TetMesh& mesh, Element element);

}  // namespace liana
