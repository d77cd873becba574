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
  row.reserve(system.row.size());
  for (const uint32_t column : nodes) {
    const size_t begin = row.size();
    for (uint32_t e = system.start[column]; e < system.start[column + 1]; ++e)
      if (compact[system.row[e]] != kNone) row.push_back(static_cast<int>(compact[system.row[e]]));
    std::sort(row.begin() + begin, row.end());
    start.push_back(static_cast<int>(row.size()));
  }
  std::vector<int> permutation(nodes.size());
  if (!nodes.empty()) {
    const int status = amd_order(static_cast<int>(nodes.size()), start.data(), row.data(), permutation.data(),
                                 nullptr, nullptr);
    require(status == AMD_OK, "AMD refuses the graph of nodes");
  }
  std::vector<uint32_t> ordered;
  for (const int p : permutation) ordered.push_back(nodes[p]);
  return ordered;
}

/// One block of the permuted upper triangle.
struct Block {
  uint32_t place;  ///< of its row node in the order
  uint32_t entry;  ///< of the system
  bool transposed;
};

}  // namespace

FreeMatrix free_matrix(const System& system, std::span<const uint8_t> held, double shift) {
  std::vector<uint8_t> free_count(system.nodes());
  for (size_t n = 0; n < system.nodes(); ++n)
    free_count[n] = 3 - (!!held[3 * n] + !!held[3 * n + 1] + !!held[3 * n + 2]);
  const std::vector<uint32_t> order = order_nodes(system, free_count);
  std::vector<uint32_t> place(system.nodes(), kNone);
  for (uint32_t p = 0; p < order.size(); ++p) place[order[p]] = p;

  std::vector<std::vector<Block>> columns(order.size());
  for (std::vector<Block>& c : columns) c.reserve(24);
  for (uint32_t column = 0; column < system.nodes(); ++column) {
    if (place[column] == kNone) continue;
    for (uint32_t e = system.start[column]; e < system.start[column + 1]; ++e) {
      const uint32_t p = place[system.row[e]], q = place[column];
      if (p == kNone) continue;
      columns[std::max(p, q)].push_back({std::min(p, q), e, p > q});
    }
  }

  FreeMatrix matrix;
  std::vector<uint32_t> first(order.size() + 1, 0);
  for (uint32_t p = 0; p < order.size(); ++p) first[p + 1] = first[p] + free_count[order[p]];
  matrix.start.reserve(first.back() + 1);
  matrix.start.push_back(0);
  matrix.row.reserve(9 * system.row.size());
  matrix.value.reserve(9 * system.row.size());
  for (uint32_t q = 0; q < order.size(); ++q) {
    std::sort(columns[q].begin(), columns[q].end(),
              [](const Block& a, const Block& b) { return a.place < b.place; });
    for (int j = 0; j < 3; ++j) {
      if (held[3 * order[q] + j]) continue;
      for (const Block& block : columns[q]) {
        const Mat3& K = system.stiffness[block.entry];
        uint32_t row = first[block.place];
        for (int i = 0; i < 3; ++i) {
          if (held[3 * order[block.place] + i]) continue;
          if (block.place != q || i <= j) {
            const double m = i == j ? shift * system.mass[block.entry] : 0;
            matrix.row.push_back(static_cast<int>(row));
            matrix.value.push_back((block.transposed ? K(j, i) : K(i, j)) + m);
          }
          ++row;
        }
      }
      matrix.start.push_back(static_cast<int>(matrix.row.size()));
      matrix.dof.push_back(3 * order[q] + j);
    }
  }
  return matrix;
}

}  // namespace liana
