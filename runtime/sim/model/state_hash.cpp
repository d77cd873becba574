#include "runtime/sim/model/state_hash.h"

#include "mesher/base/hash.h"

namespace liana {

uint64_t state_hash(const Plant& plant, uint64_t seed) {
  for (const Motion& m : plant.motion) {
    Eigen::Matrix<double, 19, 1> numbers;
    numbers << m.position, m.orientation.coeffs(), m.velocity, m.angular_velocity, m.acceleration,
        m.angular_acceleration;
    seed = hash_bytes(numbers.data(), sizeof(double) * 19, seed);
  }
  return seed;
}

}  // namespace liana
