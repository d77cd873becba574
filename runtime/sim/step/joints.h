// The joint between a particle and its parent: strains, their rates, and the wrench they make.
//
// Symbols, with F = R_p R_rest the joint's frame, P the child's anchor point, r_c and r_p the levers to P
// from the centres of child and parent:
//   e_s = Fᵀ [(x_c + R_c a_c) − (x_p + R_p a_p)]     shear, stretch, shear (m)
//   e_b = log(Fᵀ R_c)                                bend, twist, bend (rad)
//   de_s/dt = Fᵀ (velocity of the child's P − velocity of P as a point of the parent)
//   de_b/dt = B Fᵀ (ω_c − ω_p),  B = rate of the rotation vector
// The wrench on the child at P is −(C e + d_K C de/dt − rest load), the parent feels the opposite at the same
// point: linear and angular momentum are conserved exactly. The stiffness is Gauss-Newton's Jᵀ C J.
#pragma once

#include <algorithm>

#include "runtime/sim/model/plant.h"
#include "runtime/sim/model/rotation.h"
#include "runtime/sim/step/lanes/step_view.h"

namespace liana {

using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< translation and rotation

/// Where a rigid body is and how it moves at the moment when a joint is looked at. World frame.
struct BodyPose {
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
};

struct JointStrain {
  Mat3 frame;                    ///< F
  Vec3 from_child, from_parent;  ///< r_c, r_p, world, m
  Vec3 shear;                    ///< e_s
  RotationLog bend;              ///< e_b is bend.vector
};

/// e of a joint; `parent` is the identity body at rest for a root.
inline JointStrain joint_strain(const Joint& joint, const BodyPose& parent, const BodyPose& child) {
  JointStrain e;
  const Quat frame = parent.orientation * joint.rest;
  e.frame = frame.toRotationMatrix();
  e.from_child = child.orientation * joint.on_self;
  e.from_parent = child.position + e.from_child - parent.position;
  e.shear = e.frame.transpose() * (e.from_parent - parent.orientation * joint.on_parent);
  e.bend = rotation_log(frame.conjugate() * child.orientation);
  return e;
}

/// The joint seen by a linear solve: F C_s Fᵀ and F Bᵀ C_b B Fᵀ, and what it exerts on the child at P. World
/// frame.
struct JointAction {
  Mat3 shear, bend;    ///< N/m, N·m/rad
  Vec3 force, moment;  ///< N, N·m
};

inline JointAction joint_action(const Joint& joint, double stiffness_damping, const JointStrain& e,
                                const BodyPose& parent, const BodyPose& child) {
  const Mat3& F = e.frame;
  const Mat3 H = e.bend.rate() * F.transpose();  // de_b = H dθ
  const Vec3 slip = child.velocity + child.angular_velocity.cross(e.from_child) - parent.velocity -
                    parent.angular_velocity.cross(e.from_parent);
  const Vec3 shear_rate = F.transpose() * slip;
  const Vec3 bend_rate = H * (child.angular_velocity - parent.angular_velocity);
  const auto& C_s = joint.shear_stiffness;
  const auto& C_b = joint.bend_stiffness;
  JointAction a;
  a.shear.noalias() = F * C_s.asDiagonal() * F.transpose();
  a.bend.noalias() = H.transpose() * C_b.asDiagonal() * H;
  a.force = F * (joint.rest_force - C_s.cwiseProduct(e.shear + stiffness_damping * shear_rate));
  a.moment =
      H.transpose() * (joint.rest_moment - C_b.cwiseProduct(e.bend.vector + stiffness_damping * bend_rate));
  return a;
}

/// Distance between the joint's two anchor points, m.
inline double joint_gap(const Joint& joint, const Vec3& parent_position, const Quat& parent_orientation,
                        const Vec3& child_position, const Quat& child_orientation) {
  return (child_position + child_orientation * joint.on_self - parent_position -
          parent_orientation * joint.on_parent)
      .norm();
}

/// What a joint's gap is measured against, m: the length of the particle, with its petiole if it has one.
inline double gap_scale(const Particle& particle) {
  const double half = particle.half_length;
  return std::max(half + std::max(half, particle.joint.on_self.norm()), lanes::kLeastGapScale);
}

/// N: what opens a particle's joint by a part of what a time step bears, and so what a contact may push with.
/// Where a growing stem is wedged in, it stays a little inside rather than being torn off.
inline double bearable_force(const Particle& particle) {
  constexpr double kBearableGap = 5e-3;  // of gap_scale()
  const double stiffness = particle.joint.shear_stiffness.minCoeff();
  return stiffness > 0 ? kBearableGap * gap_scale(particle) * stiffness : HUGE_VAL;
}

}  // namespace liana
