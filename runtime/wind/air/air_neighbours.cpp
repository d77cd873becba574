#include "runtime/wind/air/air_neighbours.h"

namespace liana {
namespace {

constexpr int kTasksPerWorker = 4;

}  // namespace

AirNeighbours::AirNeighbours(const SphPasses& passes, const AirConstants& constants, size_t capacity,
                             unsigned threads)
    : passes_(passes), constants_(constants), chunks_(size_t{kTasksPerWorker} * threads) {
  const size_t padded = capacity + 16;
  list_begin_.resize(padded), list_end_.resize(padded);
  density_.resize(padded), acceleration_.resize(4 * padded);
  for (Chunk& chunk : chunks_) {
    chunk.list.resize(64 * capacity / chunks_.size() + 65536);
    for (auto* values : {&chunk.x, &chunk.y, &chunk.z}) values->resize(padded);
    chunk.index.resize(padded);
  }
}

void AirNeighbours::divide(const AirCells& cells) {
  const auto last_cell = static_cast<uint32_t>(cells.size());
  const size_t count = cells.begin(last_cell);
  uint32_t cell = 0;
  for (size_t c = 0; c < chunks_.size(); ++c) {
    const size_t until = count * (c + 1) / chunks_.size();
    chunks_[c].first_cell = cell, chunks_[c].first = cells.begin(cell);
    while (cell < last_cell && (cells.begin(cell) < until || c + 1 == chunks_.size())) ++cell;
    chunks_[c].last_cell = cell, chunks_[c].last = cells.begin(cell);
  }
}

}  // namespace liana
