#include "runtime/sim/model/remap.h"

namespace liana {

void Remap::then(const Remap& next) {
  for (ParticleId& particle : particles)
    if (particle.valid()) particle = next(particle);
  for (BranchId& branch : branches)
    if (branch.valid()) branch = next(branch);
  std::erase_if(shortened, [&](BranchId& branch) {
    branch = next(branch);
    return !branch.valid();
  });
  for (const BranchId branch : next.shortened)
    if (!was_shortened(branch)) shortened.push_back(branch);
}

Remap RemapLog::since(uint64_t epoch) const {
  require(epoch >= dropped_ && epoch < this->epoch(), "removals of that epoch are kept");
  const auto first = removals_.begin() + static_cast<std::ptrdiff_t>(epoch - dropped_);
  Remap all = *first;
  for (auto later = first + 1; later != removals_.end(); ++later) all.then(*later);
  return all;
}

}  // namespace liana
