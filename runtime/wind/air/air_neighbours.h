// Who is near whom in the air: the two passes over neighbours, in chunks of work for several threads.
#pragma once

#include <vector>

#include "runtime/wind/air/air_cells.h"

namespace liana {

class AirNeighbours {
 public:
  AirNeighbours(const SphPasses& passes, const AirConstants& constants, size_t capacity, unsigned threads);

  /// Divides the sorted particles into chunks.
  void divide(const AirCells& cells);
  size_t chunks() const { return chunks_.size(); }

  /// Densities of a chunk's particles by their neighbours; calls finish(begin, end, cell) for the particles
  /// of each cell. `nobody`: a state that is far away. The pass that follows needs the lists that this one
  /// makes.
  template <class Finish>
  void densities(size_t chunk, const AirCells& cells, const AirState* state, int32_t nobody,
                 const Finish& finish);
  /// Accelerations of a chunk's particles, four floats each (see ForcePass).
  void accelerations(size_t chunk, const AirState* state) {
    const Chunk& c = chunks_[chunk];
    passes_.force(c.first, c.last, constants_, state, list_begin_.data(), list_end_.data(), c.list.data(),
                  acceleration_.data());
  }

  struct Range {
    uint32_t first, last;
  };
  Range particles(size_t chunk) const { return {chunks_[chunk].first, chunks_[chunk].last}; }
  float* density() { return density_.data(); }
  const float* density() const { return density_.data(); }
  const float* acceleration() const { return acceleration_.data(); }

 private:
  struct Chunk {  // particles of some neighbouring cells: one task
    uint32_t first_cell = 0, last_cell = 0, first = 0, last = 0;
    std::vector<float> x, y, z;  // candidates
    std::vector<int32_t> index, list;
  };

  const SphPasses& passes_;
  AirConstants constants_;
  std::vector<Chunk> chunks_;
  std::vector<uint32_t> list_begin_, list_end_;
  std::vector<float> density_, acceleration_;
};

template <class Finish>
void AirNeighbours::densities(size_t number, const AirCells& cells, const AirState* state, int32_t nobody,
                              const Finish& finish) {
  Chunk& chunk = chunks_[number];
  const Candidates near{chunk.x.data(), chunk.y.data(), chunk.z.data(), chunk.index.data()};
  uint32_t used = 0;
  for (uint32_t cell = chunk.first_cell; cell < chunk.last_cell; ++cell) {
    const uint32_t begin = cells.begin(cell), end = cells.begin(cell + 1);
    if (begin == end) continue;
    uint32_t run_begin[9], run_end[9];
    cells.runs_around(cell, run_begin, run_end);
    const uint32_t count =
        passes_.gather(begin, end, run_begin, run_end, constants_, cells.xs(), cells.ys(), cells.zs(), near);
    const size_t room = used + size_t(end - begin) * (count + 16);
    if (chunk.list.size() < room) chunk.list.resize(2 * room);
    used = passes_.density(begin, end, near, count, nobody, constants_, state, density_.data(),
                           list_begin_.data(), list_end_.data(), chunk.list.data(), used);
    finish(begin, end, cell);
  }
}

}  // namespace liana
