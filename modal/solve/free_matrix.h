// The part of K + σ M that belongs to the free dof, as a scalar sparse matrix ordered for little fill-in.
#pragma once

#include <span>
#include <vector>

#include "modal/elements/assembly.h"

namespace liana {

/// A pattern in compressed columns.
struct Pattern {
  std::vector<int> start, row;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

/// Lower triangle, compressed columns, rows in any order: what supernodal CHOLMOD factors without a
/// transpose.
struct FreeMatrix {
  std::vector<int> start, row;
  std::vector<double> value;
  std::vector<uint32_t> dof;    ///< per column: the system's dof, 3 node + axis
  std::vector<uint32_t> order;  ///< nodes with free dof as they are eliminated; a place is an index into it
  std::vector<uint32_t> slot;   ///< per column: 3 place + axis
  /// The graph of its nodes in the same order, diagonal included.
  Pattern upper_nodes, lower_nodes;
  std::vector<double> mass;  ///< per entry of lower_nodes
  bool whole_nodes =
      true;  ///< all three dof of every node are free: the scalar pattern is the graph's, 3 by 3

  int size() const { return static_cast<int>(dof.size()); }
};

/// held: per dof (3 a node), 1 if it is fixed at zero. Approximate minimum degree on the graph of nodes: a
/// third of the rows and a ninth of the entries of the scalar matrix, which halves the time of ordering.
FreeMatrix free_matrix(const System& system, std::span<const uint8_t> held, double shift);

}  // namespace liana
