#include "runtime/sim/joints.h"

namespace liana {

JointStrain joint_strain(const Joint& joint, const BodyPose& parent, const BodyPose& child) {
  JointStrain e;
  const Quat frame = parent.orientation * joint.rest;
  e.frame = frame.toRotationMatrix();
  e.from_child = child.orientation * joint.on_self;
  e.from_parent = child.position + e.from_child - parent.position;
  e.shear = e.frame.transpose() * (e.from_parent - parent.orientation * joint.on_parent);
  e.bend = rotation_log(frame.conjugate() * child.orientation);
  return e;
}

JointAction joint_action(const Joint& joint, double stiffness_damping, const JointStrain& e,
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

double joint_gap(const Joint& joint, const Vec3& parent_position, const Quat& parent_orientation,
                 const Vec3& child_position, const Quat& child_orientation) {
  return (child_position + child_orientation * joint.on_self - parent_position -
          parent_orientation * joint.on_parent)
      .norm();
}

}  // namespace liana
