#include "modal/free_matrix.h"

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

/// One block of the permuted triangle.
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

/// Blocks by their higher place, then by the lower: two counting sorts. Fills the graph's patterns as well.
std::vector<Block> sorted_blocks(const System& system, const std::vector<uint32_t>& order,
                                 FreeMatrix& matrix) {
  std::vector<uint32_t> place(system.nodes(), kNone);
  for (uint32_t p = 0; p < order.size(); ++p) place[order[p]] = p;
  std::vector<Block> blocks;
  blocks.reserve(system.row.size());
  std::vector<uint32_t> in_low(order.size(), 0), in_high(order.size(), 0);
  for (uint32_t column = 0; column < system.nodes(); ++column) {
    const uint32_t q = place[column];
    if (q == kNone) continue;
    for (uint32_t e = system.start[column]; e < system.start[column + 1]; ++e) {
      const uint32_t p = place[system.row[e]];
      if (p == kNone) continue;
      blocks.push_back({std::min(p, q), std::max(p, q), e, p > q});
      ++in_low[blocks.back().low], ++in_high[blocks.back().high];
    }
  }
  std::vector<Block> by_low(blocks.size());
  std::vector<uint32_t> next = running_sum(in_low);
  matrix.lower_nodes.start.assign(next.begin(), next.end());
  for (const Block& block : blocks) by_low[next[block.low]++] = block;
  next = running_sum(in_high);
  matrix.upper_nodes.start.assign(next.begin(), next.end());
  for (const Block& block : by_low) blocks[next[block.high]++] = block;
  for (const Block& block : by_low) matrix.lower_nodes.row.push_back(static_cast<int>(block.high));
  for (const Block& block : blocks) matrix.upper_nodes.row.push_back(static_cast<int>(block.low));
  return blocks;
}

}  // namespace

FreeMatrix free_matrix(const System& system, std::span<const uint8_t> held, double shift) {
  std::vector<uint8_t> free_count(system.nodes());
  for (size_t n = 0; n < system.nodes(); ++n)
    free_count[n] = 3 - (!!held[3 * n] + !!held[3 * n + 1] + !!held[3 * n + 2]);
  const std::vector<uint32_t> order = order_nodes(system, free_count);

  FreeMatrix matrix;
  matrix.lower_nodes.row.reserve(system.row.size()), matrix.upper_nodes.row.reserve(system.row.size());
  const std::vector<Block> blocks = sorted_blocks(system, order, matrix);
  std::vector<uint32_t> count;
  count.reserve(order.size());
  for (const uint32_t node : order) count.push_back(free_count[node]);
  const std::vector<uint32_t> first = running_sum(count);
  matrix.whole_nodes = first.back() == 3 * order.size();

  matrix.start.reserve(first.back() + 1);
  matrix.start.push_back(0);
  matrix.dof.reserve(first.back());
  matrix.row.resize(9 * blocks.size()), matrix.value.resize(9 * blocks.size());
  int end = 0;
  for (uint32_t q = 0; q < order.size(); ++q) {
    const std::span column(blocks.data() + matrix.upper_nodes.start[q],
                           blocks.data() + matrix.upper_nodes.start[q + 1]);
    for (int j = 0; j < 3; ++j) {
      if (held[3 * order[q] + j]) continue;
      for (const Block& block : column) {
        // The system holds (row, column) below its diagonal; this block is (low, high), above the new one.
        const Mat3& K = system.stiffness[block.entry];
        const double mass = shift * system.mass[block.entry];
        const uint8_t* fixed = &held[3 * order[block.low]];
        int row = static_cast<int>(first[block.low]);
        for (int i = 0; i < 3; ++i) {
          if (fixed[i]) continue;
          if (block.low != q || i <= j) {
            matrix.row[end] = row;
            matrix.value[end++] = (block.transposed ? K(j, i) : K(i, j)) + (i == j ? mass : 0);
          }
          ++row;
        }
      }
      matrix.start.push_back(end);
      matrix.dof.push_back(3 * order[q] + j);
    }
  }
  matrix.row.resize(end), matrix.value.resize(end);
  return matrix;
}

}  // namespace liana
