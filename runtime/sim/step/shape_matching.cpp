#include "runtime/sim/step/shape_matching.h"

#include <Eigen/SVD>
#include <algorithm>

#include "runtime/sim/model/rotation.h"
#include "runtime/sim/step/time_step.h"

namespace liana {
namespace {

bool held(const Particle& particle) {
  return !particle.parent.valid() && !particle.joint.shear_stiffness.isZero(0);
}

// Eq. 15: the second moment of an ellipsoid, turned from its rest orientation to its present one. The paper
// prints diag R; ∫ ρ (R x)(R̄ x)ᵀ dV is R diag R̄ᵀ.
Mat3 ellipsoid_moment(const Particle& p, const Quat& orientation, const Quat& rest) {
  const Vec3 radii(p.half_width, p.half_length, p.half_thickness);
  const Vec3 diagonal = p.mass / 5 * radii.cwiseAbs2();
  return orientation.toRotationMatrix() * diagonal.asDiagonal() * rest.toRotationMatrix().transpose();
}

// det A < 0, or too far from the guess for Newton's method.
Quat rotation_by_svd(const Mat3& A, const Quat& guess) {
  if (!A.allFinite() || A.isZero(0)) return guess;
  const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  return Quat(Mat3(U * svd.matrixV().transpose()));
}

}  // namespace

// Maximises tr(RᵀA) over rotations by Newton's method: with B = A Rᵀ, a small turn t (from the left) changes
// it by t·g − ½ tᵀ H t, g the axial vector of B, H = tr(B) − sym(B). From one step to the next a group turns
// little, so two or three iterations do.
Quat polar_rotation(const Mat3& A, const Quat& guess) {
  constexpr double kConverged = 1e-20, kTooFar = 0.5;  // rad², rad²
  Quat q = guess;
  for (int i = 0; i < 8; ++i) {
    const Mat3 B = A * q.toRotationMatrix().transpose();
    const Vec3 g(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1));
    const double xx = B(1, 1) + B(2, 2), yy = B(0, 0) + B(2, 2), zz = B(0, 0) + B(1, 1);
    const double xy = -(B(0, 1) + B(1, 0)) / 2, xz = -(B(0, 2) + B(2, 0)) / 2, yz = -(B(1, 2) + B(2, 1)) / 2;
    const double c0 = yy * zz - yz * yz, c1 = yz * xz - xy * zz, c2 = xy * yz - yy * xz;  // cofactors
    const double minor = xx * yy - xy * xy, determinant = xx * c0 + xy * c1 + xz * c2;
    if (!(xx > 0 && minor > 0 && determinant > 0)) return rotation_by_svd(A, guess);
    const double d1 = xx * zz - xz * xz, d2 = xy * xz - xx * yz;
    const Vec3 turn = Vec3(c0 * g.x() + c1 * g.y() + c2 * g.z(), c1 * g.x() + d1 * g.y() + d2 * g.z(),
                           c2 * g.x() + d2 * g.y() + minor * g.z()) /
                      determinant;
    const double size = turn.squaredNorm();
    if (!(size < kTooFar)) return rotation_by_svd(A, guess);
    q = rotation_exp(turn) * q;
    if (size < kConverged) return q.normalized();
  }
  return rotation_by_svd(A, guess);
}

StepReport ShapeMatchingStepper::step(Plant& plant, std::span<const Wrench> external,
                                      std::span<const WorldSpring> transient,
                                      const StepOptions& options) noexcept {
  StepReport report;
  report.calibrated = false;
  age(plant.particles.size(), options.dt);
  find_rest(plant);
  for (int i = 0; i < plant.scheme.substeps && report.finite; ++i) {
    report.finite = substep(plant, external, transient, options.dt / plant.scheme.substeps, options.gravity);
    ++report.solves;
  }
  if (!report.finite)
    for (Motion& m : plant.motion) m = {.position = m.position, .orientation = m.orientation};
  return report;
}

void ShapeMatchingStepper::age(size_t particles, double dt) {
  if (age_.empty() || particles < age_.size()) age_.assign(particles, options_.maturing_time);
  age_.resize(particles, 0.0);
  for (double& seconds : age_) seconds += dt;
}

// Growth and cuts change the rest shape between steps, so it is laid out anew, root to tips.
void ShapeMatchingStepper::find_rest(const Plant& plant) {
  const size_t n = plant.particles.size();
  rest_position_.resize(n);
  rest_orientation_.resize(n);
  position_.resize(n);
  orientation_.resize(n);
  ellipsoid_.resize(n);
  group_.resize(n);
  goal_.resize(n);
  for (size_t i = 0; i < n; ++i) {
    const Particle& p = plant.particles[i];
    const Joint& joint = p.joint;
    const bool root = !p.parent.valid();
    const Quat up = root ? Quat::Identity() : rest_orientation_[p.parent.index()];
    const Vec3 below = root ? Vec3(Vec3::Zero()) : rest_position_[p.parent.index()];
    rest_orientation_[i] = up * joint.rest;
    rest_position_[i] = below + up * joint.on_parent - rest_orientation_[i] * joint.on_self;
  }
  // Weights by mass and by position in the branch: parents count more than children, so that particles follow
  // their parents. The paper gives no numbers; ours fall from m at a branch's root to m/2 at its tip.
  for (const Branch& branch : plant.branches) {
    double before = 0;
    const auto count = static_cast<double>(branch.particles.size());
    for (const ParticleId id : branch.particles)
      group_[id.index()].weight = plant.particles[id.index()].mass * (1 - before++ / (2 * count));
  }
}

bool ShapeMatchingStepper::substep(Plant& plant, std::span<const Wrench> external,
                                   std::span<const WorldSpring> transient, double h, const Vec3& gravity) {
  const size_t n = plant.particles.size();
  for (size_t i = 0; i < n; ++i) {
    const Particle& p = plant.particles[i];
    const Motion& m = plant.motion[i];
    if (held(p)) {
      position_[i] = rest_position_[i];
      orientation_[i] = rest_orientation_[i];
      continue;
    }
    Vec3 acceleration = gravity;
    if (i < external.size() && p.mass > 0) acceleration += external[i].force / p.mass;
    position_[i] = m.position + m.velocity * h + acceleration * (h * h / 2);  // Eq. 1
    orientation_[i] = rotation_exp(h * m.angular_velocity) * m.orientation;   // Eq. 16
  }
  for (const WorldSpring& spring : plant.anchors) attach(plant, spring, h);
  for (const WorldSpring& spring : transient) attach(plant, spring, h);
  for (int pass = 0; pass < options_.passes; ++pass) match(plant);

  for (size_t i = 0; i < n; ++i)
    if (!position_[i].allFinite() || !orientation_[i].coeffs().allFinite()) return false;
  for (size_t i = 0; i < n; ++i) {
    Motion& m = plant.motion[i];
    const Vec3 velocity = (position_[i] - m.position) / h;                                   // Eq. 17
    const Vec3 spin = rotation_log(orientation_[i] * m.orientation.conjugate()).vector / h;  // Eq. 19
    m.acceleration = (velocity - m.velocity) / h;
    m.angular_acceleration = (spin - m.angular_velocity) / h;
    m.velocity = velocity;
    m.angular_velocity = spin;
    m.position = position_[i];        // Eq. 18
    m.orientation = orientation_[i];  // Eq. 20
  }
  return true;
}

// Eq. 5, with φ a matrix where the spring is not the same in all directions.
void ShapeMatchingStepper::attach(const Plant& plant, const WorldSpring& spring, double h) {
  const size_t i = spring.particle.index();
  const Particle& p = plant.particles[i];
  if (held(p) || !(p.mass > 0)) return;
  const Mat3 k = h * h * spring.stiffness, c = h * spring.damping;
  const Vec3 lever = orientation_[i] * spring.on_particle;
  const Vec3 moved = position_[i] - plant.motion[i].position;
  const Vec3 wanted = k * (spring.target - position_[i] - lever) + c * (h * spring.target_velocity - moved);
  position_[i] += (p.mass * Mat3::Identity() + k + c).ldlt().solve(wanted);
}

// One pass over all groups. A particle belongs to its own group, its parent's and its children's, so sums
// over groups and over the goals of a particle run along the edges.
void ShapeMatchingStepper::match(const Plant& plant) {
  const size_t n = plant.particles.size();
  // Eq. 14: A = Σ (A_i + m x x̄ᵀ) − M c c̄ᵀ.
  for (size_t i = 0; i < n; ++i) {
    const double m = plant.particles[i].mass;
    Group& own = group_[i];
    ellipsoid_[i].noalias() = ellipsoid_moment(plant.particles[i], orientation_[i], rest_orientation_[i]) +
                              m * position_[i] * rest_position_[i].transpose();
    own.mass = m;
    own.centre = m * position_[i];
    own.rest_centre = m * rest_position_[i];
    own.moment = ellipsoid_[i];
    if (!plant.particles[i].parent.valid()) continue;
    const size_t parent = plant.particles[i].parent.index();
    Group& above = group_[parent];
    const double parent_mass = plant.particles[parent].mass;
    above.mass += m;
    above.centre += own.centre;
    above.rest_centre += own.rest_centre;
    above.moment += own.moment;
    own.mass += parent_mass;
    own.centre += parent_mass * position_[parent];
    own.rest_centre += parent_mass * rest_position_[parent];
    own.moment += ellipsoid_[parent];
  }
  for (size_t i = 0; i < n; ++i) {
    Group& g = group_[i];
    if (!(g.mass > 0)) continue;  // weightless, so it pulls nobody
    g.centre /= g.mass;
    g.rest_centre /= g.mass;
    g.moment -= g.mass * g.centre * g.rest_centre.transpose();
    const Quat turned = orientation_[i] * rest_orientation_[i].conjugate();
    const Quat R = polar_rotation(g.moment, turned);
    g.moment = R.toRotationMatrix();
    if (!held(plant.particles[i])) orientation_[i] = R * rest_orientation_[i];
    // Eq. 3: x_t = R (x̄ − c̄) + c = R x̄ + centre from here on.
    g.centre -= g.moment * g.rest_centre;
  }
  // Eq. 4, and how far a particle of stiffness s may follow (§4.3).
  for (size_t i = 0; i < n; ++i) {
    const Group& own = group_[i];
    const auto target = [&](const Group& g, size_t k) { return g.moment * rest_position_[k] + g.centre; };
    goal_[i] = {own.weight * target(own, i), own.weight};
    if (!plant.particles[i].parent.valid()) continue;
    const size_t parent = plant.particles[i].parent.index();
    goal_[i].position += group_[parent].weight * target(group_[parent], i);
    goal_[i].weight += group_[parent].weight;
    goal_[parent].position += own.weight * target(own, parent);
    goal_[parent].weight += own.weight;
  }
  for (size_t i = 0; i < n; ++i) {
    if (held(plant.particles[i]) || !(goal_[i].weight > 0)) continue;
    const double grown = std::min(1.0, age_[i] / options_.maturing_time);
    const double s = options_.stiffness * (options_.youngest + (1 - options_.youngest) * grown);
    position_[i] += s * (goal_[i].position / goal_[i].weight - position_[i]);
  }
}

}  // namespace liana
