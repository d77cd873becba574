#include "runtime/sim/model/state_hash.h"

#include "mesher/base/hash.h"

namespace liana {

uint64_t state_hash(const Plant& plant, uint64_t seed) {
  uint64_t sum = 0;
  for (size_t i = 0; i < plant.motion.size(); ++i) {
    const Motion& m = plant.motion[i];
    const LineageId lineage = plant.lineage_of(ParticleId(i));
    Eigen::Matrix<double, 19, 1> numbers;
    numbers << m.position, m.orientation.coeffs(), m.velocity, m.angular_velocity, m.acceleration,
        m.angular_acceleration;
    sum += hash_bytes(numbers.data(), sizeof(double) * 19, lineage.valid() ? lineage.value : i);
  }
  return hash_bytes(&sum, sizeof sum, seed);
}

}  // namespace liana
