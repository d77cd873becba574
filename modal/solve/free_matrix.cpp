#include "modal/solve/free_matrix.h"

#include <suitesparse/amd.h>

#include <algorithm>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr uint32_t kNone = UINT32_MAX;

/// Free nodes in the order of elimination.
std::vector<uint32_t> order_nodes(const System& system, const std::vector<uint8_t>& free_count) {
  std::vector<uint32_t> nodes, compact(system.nodes(), kNone);
  for (uint32_t n = 0; n < system.nodes(); ++n)
    if (free_count[n] > 0) compact[n] = static_cast<uint32_t>(nodes.size()), nodes.push_back(n);
  std::vector<int> start{0}, row;
  start.reserve(nodes.size() + 1), row.reserve(system.row.size());
  for (const uint32_t column : nodes) {
    for (uint32_t e = system.start[column] + 1; e < system.start[column + 1]; ++e)
      if (compact[system.row[e]] != kNone) row.push_back(static_cast<int>(compact[system.row[e]]));
    start.push_back(static_cast<int>(row.size()));
  }
  std::vector<int> permutation(nodes.size());
  if (!nodes.empty()) {
    const int status = amd_order(static_cast<int>(nodes.size()), start.data(), row.data(), permutation.data(),
                                 nullptr, nullptr);
    require(status == AMD_OK || status == AMD_OK_BUT_JUMBLED, "AMD refuses the graph of nodes");
  }
  std::vector<uint32_t> ordered;
  ordered.reserve(nodes.size());
  for (const int p : permutation) ordered.push_back(nodes[p]);
  return ordered;
}

/// One block of the permuted triangle, rows of `high`, columns of `low`.
struct Block {
  uint32_t low, high;  ///< places of its nodes in the order, low <= high
  uint32_t entry;      ///< of the system
  bool transposed;     ///< the system's row node has the lower place
};

/// Sums of `counts` before each index, and the total.
std::vector<uint32_t> running_sum(const std::vector<uint32_t>& counts) {
  std::vector<uint32_t> sum(counts.size() + 1, 0);
  for (size_t i = 0; i < counts.size(); ++i) sum[i + 1] = sum[i] + counts[i];
  return sum;
}

/// The blocks of free nodes by their lower place. Fills the graph's patterns and its masses as well.
std::vector<Block> blocks_by_column(const System& system, FreeMatrix& matrix) {
  const size_t places = matrix.order.size();
  std::vector<uint32_t> place(system.nodes(), kNone);
  for (uint32_t p = 0; p < places; ++p) place[matrix.order[p]] = p;
  std::vector<Block> found;
  found.reserve(system.row.size());
  std::vector<uint32_t> in_low(places, 0), in_high(places, 0);
  for (uint32_t column = 0; column < system.nodes(); ++column) {
    const uint32_t q = place[column];
    if (q == kNone) continue;
    for (uint32_t e = system.start[column]; e < system.start[column + 1]; ++e) {
      const uint32_t p = place[system.row[e]];
      if (p == kNone) continue;
      found.push_back({std::min(p, q), std::max(p, q), e, p < q});
      ++in_low[found.back().low], ++in_high[found.back().high];
    }
  }
  std::vector<Block> blocks(found.size());
  std::vector<uint32_t> next = running_sum(in_low);
  matrix.lower_nodes.start.assign(next.begin(), next.end());
  for (const Block& block : found) blocks[next[block.low]++] = block;

  next = running_sum(in_high);
  matrix.upper_nodes.start.assign(next.begin(), next.end());
  matrix.upper_nodes.row.resize(blocks.size()), matrix.lower_nodes.row.resize(blocks.size());
  matrix.mass.resize(blocks.size());
  for (size_t b = 0; b < blocks.size(); ++b) {
    matrix.lower_nodes.row[b] = static_cast<int>(blocks[b].high);
    matrix.upper_nodes.row[next[blocks[b].high]++] = static_cast<int>(blocks[b].low);
    matrix.mass[b] = system.mass[blocks[b].entry];
  }
  return blocks;
}

/// Numbers the free dof. Returns for each place its first column, and the end.
std::vector<int> number_columns(std::span<const uint8_t> held, FreeMatrix& matrix) {
  std::vector<int> first;
  first.reserve(matrix.order.size() + 1);
  for (uint32_t place = 0; place < matrix.order.size(); ++place) {
    first.push_back(matrix.size());
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const uint32_t dof = 3 * matrix.order[place] + axis;
      if (!held[dof]) matrix.dof.push_back(dof), matrix.slot.push_back(3 * place + axis);
    }
  }
  first.push_back(matrix.size());
  return first;
}

}  // namespace

FreeMatrix free_matrix(const System& system, std::span<const uint8_t> held, double shift) {
  std::vector<uint8_t> free_count(system.nodes());
  for (size_t n = 0; n < system.nodes(); ++n)
    free_count[n] = 3 - (!!held[3 * n] + !!held[3 * n + 1] + !!held[3 * n + 2]);
  FreeMatrix matrix;
  matrix.order = order_nodes(system, free_count);
  matrix.dof.reserve(3 * matrix.order.size()), matrix.slot.reserve(3 * matrix.order.size());
  const std::vector<int> first = number_columns(held, matrix);
  matrix.whole_nodes = matrix.dof.size() == 3 * matrix.order.size();
  const std::vector<Block> blocks = blocks_by_column(system, matrix);

  matrix.start.reserve(matrix.dof.size() + 1);
  matrix.start.push_back(0);
  matrix.row.resize(9 * blocks.size()), matrix.value.resize(9 * blocks.size());
  for (uint32_t p = 0; p < matrix.order.size(); ++p) {
    const std::span column(blocks.data() + matrix.lower_nodes.start[p],
                           blocks.data() + matrix.lower_nodes.start[p + 1]);
    int entries = 0;  // of each of the node's columns, above its own dof not counted
    for (const Block& block : column) entries += first[block.high + 1] - first[block.high];
    std::array<int, 3> next;  // where the node's columns go on
    for (int c = first[p]; c < first[p + 1]; ++c) {
      next[c - first[p]] = matrix.start.back();
      matrix.start.push_back(matrix.start.back() + entries - (c - first[p]));
    }
    for (const Block& block : column) {
      const double* K = system.stiffness[block.entry].data();
      const int along_row = block.transposed ? 1 : 3, along_column = block.transposed ? 3 : 1;
      if (matrix.whole_nodes && block.high != p) {  // nearly all of them: nine numbers and nothing to ask
        const int r = first[block.high];
        for (int j = 0; j < 3; ++j) {
          int* row = &matrix.row[next[j]];
          double* value = &matrix.value[next[j]];
          row[0] = r, row[1] = r + 1, row[2] = r + 2;
          for (int i = 0; i < 3; ++i) value[i] = K[along_column * i + along_row * j];
          value[j] += shift * system.mass[block.entry];
          next[j] += 3;
        }
        continue;
      }
      for (int c = first[p]; c < first[p + 1]; ++c) {
        const uint32_t j = matrix.slot[c] - 3 * p;
        int& end = next[c - first[p]];
        for (int r = block.high == p ? c : first[block.high]; r < first[block.high + 1]; ++r) {
          const uint32_t i = matrix.slot[r] - 3 * block.high;
          matrix.row[end] = r;
          matrix.value[end++] =
              K[along_column * i + along_row * j] + (i == j ? shift * system.mass[block.entry] : 0);
        }
      }
    }
  }
  matrix.row.resize(matrix.start.back()), matrix.value.resize(matrix.start.back());
  return matrix;
}

}  // namespace liana
