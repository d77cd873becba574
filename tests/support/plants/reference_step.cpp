#include "tests/support/plants/reference_step.h"

#include "runtime/sim/step/generalized_alpha.h"

namespace liana::test {
namespace {
const BodyPose kWorldPose;
const Motion kWorld;
}  // namespace

// Balanced at t + (1−α_f) h, with x_f = x̂ + k₁ a₁, v_f = v̂ + k₂ a₁ (x̂, v̂ the prediction with a₁ = 0):
//   [ (1−α_m) M + k₂ D + k₁ K ] a₁ = F − α_m M a₀ − D v̂ − f(x̂),   k₁ = (1−α_f) β h²,   k₂ = (1−α_f) γ h
struct ReferenceStepper::Substep {
  double h;
  GeneralizedAlpha method;
  std::span<const Wrench> external;
  std::span<const WorldSpring> transient;
  Vec3 gravity;
  double position_rate = (1 - method.alpha_f) * method.beta * h * h;  // k₁, s²
  double velocity_rate = (1 - method.alpha_f) * method.gamma * h;     // k₂, s
};

bool ReferenceStepper::step(Plant& plant, std::span<const Wrench> external,
                            std::span<const WorldSpring> transient, const StepOptions& options) {
  solver_.resize(plant.particles.size());
  pose_.resize(plant.particles.size());
  next_.resize(plant.particles.size());
  gap_ = 0;
  const Substep part{options.dt / plant.scheme.substeps, GeneralizedAlpha(plant.scheme.rho_infinity),
                     external, transient, options.gravity};
  for (int i = 0; i < plant.scheme.substeps; ++i) {
    predict(plant, part);
    add_springs(plant.anchors, part);
    add_springs(transient, part);
    eliminate(plant, part);
    if (!advance(plant, part)) return false;
  }
  return true;
}

// Poses at the moment of balance if a₁ were 0, and every particle's own block and load.
void ReferenceStepper::predict(const Plant& plant, const Substep& step) {
  const auto& [alpha_m, alpha_f, gamma, beta, before] = step.method;
  const double t = (1 - alpha_f) * step.h, t2 = t * step.h * (0.5 - beta), tv = t * (1 - gamma);
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    const Motion& m = plant.motion[i];
    BodyPose& pose = pose_[i];
    pose.position = m.position + t * m.velocity + t2 * m.acceleration;
    pose.orientation = rotation_exp(t * m.angular_velocity + t2 * m.angular_acceleration) * m.orientation;
    pose.velocity = m.velocity + tv * m.acceleration;
    pose.angular_velocity = m.angular_velocity + tv * m.angular_acceleration;

    const Mat3 R = pose.orientation.toRotationMatrix();
    const Mat3 J = R * particle.inertia.asDiagonal() * R.transpose();
    const double d_M = particle.mass_damping, implicit = 1 - alpha_m + step.velocity_rate * d_M;
    Vec3 force = particle.mass * (step.gravity - alpha_m * m.acceleration - d_M * pose.velocity);
    Vec3 torque = -(J * (alpha_m * m.angular_acceleration + d_M * pose.angular_velocity));
    if (i < step.external.size()) force += step.external[i].force, torque += step.external[i].torque;
    solver_.reset(i, implicit * particle.mass, implicit * J, force, torque);
  }
}

void ReferenceStepper::add_springs(std::span<const WorldSpring> springs, const Substep& step) {
  for (const WorldSpring& spring : springs) {
    const size_t i = spring.particle.index();
    const BodyPose& pose = pose_[i];
    const Vec3 lever = pose.orientation * spring.on_particle;
    const Vec3 slip = pose.velocity + pose.angular_velocity.cross(lever) - spring.target_velocity;
    const Vec3 force = -spring.stiffness * (pose.position + lever - spring.target) - spring.damping * slip;
    solver_.add_point(i, lever, step.position_rate * spring.stiffness + step.velocity_rate * spring.damping);
    solver_.add_load(i, force, lever.cross(force));
  }
}

// Leaves to root: what each joint exerts, then the particle out of the system.
void ReferenceStepper::eliminate(const Plant& plant, const Substep& step) {
  for (size_t i = plant.particles.size(); i-- > 0;) {
    const Particle& particle = plant.particles[i];
    const bool root = !particle.parent.valid();
    const BodyPose& parent = root ? kWorldPose : pose_[particle.parent.index()];
    const JointStrain strain = joint_strain(particle.joint, parent, pose_[i]);
    const JointAction action =
        joint_action(particle.joint, particle.stiffness_damping, strain, parent, pose_[i]);
    solver_.add_load(i, action.force, strain.from_child.cross(action.force) + action.moment);
    if (!root)
      solver_.add_load(particle.parent.index(), -action.force,
                       -strain.from_parent.cross(action.force) - action.moment);
    const double implicit = step.position_rate + step.velocity_rate * particle.stiffness_damping;
    solver_.eliminate(
        i, particle.parent.value,
        {strain.from_child, strain.from_parent, implicit * action.shear, implicit * action.bend});
  }
}

// Root to leaves: accelerations, the new state, its largest gap. False when anything is not finite.
bool ReferenceStepper::advance(Plant& plant, const Substep& step) {
  const auto& [alpha_m, alpha_f, gamma, beta, before] = step.method;
  const double h = step.h, h2 = h * h;
  double sum = 0;  // finite exactly when every number added is
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const Particle& particle = plant.particles[i];
    const Motion& m = plant.motion[i];
    const Vec6& a1 = solver_.substitute(i);
    Motion& n = next_[i];
    n.acceleration = a1.head<3>();
    n.angular_acceleration = a1.tail<3>();
    n.position = m.position + h * m.velocity + h2 * ((0.5 - beta) * m.acceleration + beta * n.acceleration);
    const Vec3 turn =
        h * m.angular_velocity + h2 * ((0.5 - beta) * m.angular_acceleration + beta * n.angular_acceleration);
    n.orientation = (rotation_exp(turn) * m.orientation).normalized();
    n.velocity = m.velocity + h * ((1 - gamma) * m.acceleration + gamma * n.acceleration);
    n.angular_velocity =
        m.angular_velocity + h * ((1 - gamma) * m.angular_acceleration + gamma * n.angular_acceleration);

    const Motion& parent = particle.parent.valid() ? next_[particle.parent.index()] : kWorld;
    const double open =
        joint_gap(particle.joint, parent.position, parent.orientation, n.position, n.orientation);
    const bool free = particle.joint.shear_stiffness.isZero(0);
    if (!free) gap_ = std::max(gap_, open / gap_scale(particle));
    sum += open + n.velocity.sum() + n.angular_velocity.sum() + n.orientation.w();
  }
  plant.motion.swap(next_);
  return std::isfinite(sum);
}

}  // namespace liana::test
