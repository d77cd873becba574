#include "runtime/sim/step/spring_load.h"

#include "runtime/sim/model/rotation.h"
#include "runtime/sim/step/lanes/step_view.h"

namespace liana {
namespace {

// The same resistance in all directions, at the centre: wind, mostly.
bool is_drag(const WorldSpring& spring) {
  const Mat3& d = spring.damping;
  return spring.stiffness.isZero(0) && spring.on_particle.isZero(0) && d(1, 1) == d(0, 0) &&
         d(2, 2) == d(0, 0) && d(0, 1) == 0 && d(0, 2) == 0 && d(1, 0) == 0 && d(1, 2) == 0 && d(2, 0) == 0 &&
         d(2, 1) == 0;
}

}  // namespace

void add_spring(const WorldSpring& spring, double position_rate, double velocity_rate, const double* pose,
                double* block) {
  using Row = Eigen::Map<const Vec3>;
  if (is_drag(spring)) {
    const double damping = spring.damping(0, 0);
    const Vec3 force = damping * (spring.target_velocity - Row(pose + 8));
    for (const int diagonal : {0, 2, 5}) block[diagonal] += velocity_rate * damping;
    for (int row = 0; row < 3; ++row) block[lanes::kBlockLoad + row] += force[row];
    return;
  }
  const Vec3 lever = Eigen::Map<const Quat>(pose + 4) * spring.on_particle;
  const Vec3 slip = Row(pose + 8) + Row(pose + 11).cross(lever) - spring.target_velocity;
  const Vec3 force = -spring.stiffness * (Row(pose) + lever - spring.target) - spring.damping * slip;
  const Mat3 S = position_rate * spring.stiffness + velocity_rate * spring.damping;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column <= row; ++column) *block++ += S(row, column);
  if (spring.on_particle.isZero(0)) {  // at the centre it turns nothing
    for (int row = 0; row < 3; ++row) block[15 + row] += force[row];
    return;
  }
  const Mat3 L = skew(lever), Q = L * S, R = Q * L.transpose();  // T(r)ᵀ [S 0; 0 0] T(r)
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) *block++ += Q(row, column);
    for (int column = 0; column <= row; ++column) *block++ += R(row, column);
  }
  const Vec3 torque = lever.cross(force);
  for (int row = 0; row < 3; ++row) *block++ += force[row];
  for (int row = 0; row < 3; ++row) *block++ += torque[row];
}

}  // namespace liana
