// One substep for four particles at a time: poses, joints, the linear-time direct solve, the new state.
//
//   minimise over a:  Σ_i ½ a_iᵀ A_i a_i − b_iᵀ a_i  +  Σ_joints ½ Σ_k w_k s_k²,
//   T_c a_c = T_p a_p + Σ_k d_k s_k
//
// Symbols: a_i motion of a particle, (translation of its centre, rotation), world axes; T(r) = [1 −[r]×; 0 1]
// moves a motion from the centre to the joint's point P at lever r; d_k the joint's six directions, F e_k and
// F B⁻¹ e_k (joints.h), in which its stiffness w is diagonal; A, b inertia and load of a particle and all
// that hangs on it, seen at P.
//
// A joint of six directions is six springs in a row. Each takes one rank from the inertia that the parent
// feels, A ← A − A d dᵀA / (dᵀA d + w), which keeps its digits when w is much larger than A (articulated-body
// inertia; the Schur complement w − w²/(A+w) of the same value cancels). Going back, s = (dᵀb − dᵀA g) /
// (dᵀA d + w) for each spring, g the motion of its parent's side.
#pragma once

#include "runtime/sim/step/lanes/lanes.h"
#include "runtime/sim/step/lanes/step_view.h"

namespace liana::LIANA_LANES {

using lanes::AdvanceResult;
using lanes::Pack;
using lanes::StepView;
using namespace lanes;  // strides

// Record of a pack: Lanes at these places. In a large plant the records are most of what moves between memory
// and processor, so nothing is kept that another number gives.
constexpr int kFrame = 0;         // F, its first two columns: 6
constexpr int kBendFrame = 6;     // D = F B⁻¹: 9
constexpr int kLeverChild = 15;   // r_c: 3
constexpr int kLeverParent = 18;  // r_p: 3
constexpr int kSpring = 21;       // w, later dᵀb / c: 6
constexpr int kGapWeight = 27;    // 1 / gap_scale()², 0 where nothing closes the joint
constexpr int kRow = 28;          // dᵀA / c of each spring: 36
constexpr int kAction = 28;       // before: force and moment of the joint on the child at P: 6

inline Vec3L load3(const double* at) {
  return {load(at), load(at + 4), load(at + 8)};
}
inline void store3(const Vec3L& v, double* at) {
  store(v.x, at), store(v.y, at + 4), store(v.z, at + 8);
}

// Joint direction k: F e_k, then D e_k.
inline Vec3L direction(const double* record, int k) {
  if (k == 2) return cross(load3(record + 4 * kFrame), load3(record + 4 * (kFrame + 3)));
  return load3(record + 4 * (k < 2 ? kFrame + 3 * k : kBendFrame + 3 * (k - 3)));
}

// Calls data into the second-level cache. The processor drops requests that come faster than a dozen at a
// time, so they are strewn among the arithmetic.
template <int numbers, int write = 0>
inline void fetch(const double* at) {
  for (int i = 0; i < numbers; i += 8) __builtin_prefetch(at + i, write, 2);
}

// Packs from the one at work to those whose data is asked for, and to the record that is written next.
constexpr size_t kNear = 8, kNearRecord = 4;

// What belongs to another pack, piece by piece: by lane, or an eighth of its record.
struct Fetch {
  const StepView& view;
  const Pack& pack;

  Fetch(const StepView& v, size_t i) : view(v), pack(v.packs[i < v.pack_count ? i : v.pack_count - 1]) {}
  void particle(int lane) const { fetch<kParticleStride>(particle_at(lane)); }
  void joint(int lane) const { fetch<6>(particle_at(lane) + 10); }  // its two anchor points
  void from(int lane) const {
    fetch<kMotionStride>(view.from + std::size_t(kMotionStride) * pack.self[lane]);
  }
  void to(int lane) const { fetch<kMotionStride, 1>(view.to + std::size_t(kMotionStride) * pack.self[lane]); }
  void record(int part) const { fetch<kPart>(record_at(part)); }
  void record_to_write(int part) const { fetch<kPart, 1>(record_at(part)); }

 private:
  static constexpr int kPart = 4 * kRecordLanes / 8;

  const double* particle_at(int lane) const {
    return view.particle + std::size_t(kParticleStride) * pack.self[lane];
  }
  const double* record_at(int part) const {
    return view.record + (&pack - view.packs) * (4 * kRecordLanes) + part * kPart;
  }
};

struct PoseL {
  Vec3L position, velocity, angular_velocity;
  QuatL orientation;
};
inline PoseL get_pose(const Rows<double>& rows) {
  PoseL p;
  Lanes pad, pad2;
  rows.get(0, p.position.x, p.position.y, p.position.z, pad);
  rows.get(4, p.orientation.v.x, p.orientation.v.y, p.orientation.v.z, p.orientation.w);
  rows.get(8, p.velocity.x, p.velocity.y, p.velocity.z, p.angular_velocity.x);
  rows.get(12, p.angular_velocity.y, p.angular_velocity.z, pad, pad2);
  return p;
}
inline void set_pose(const Rows<double>& rows, int lanes, const PoseL& p) {
  const Lanes zero = all(0);
  rows.set(0, lanes, p.position.x, p.position.y, p.position.z, zero);
  rows.set(4, lanes, p.orientation.v.x, p.orientation.v.y, p.orientation.v.z, p.orientation.w);
  rows.set(8, lanes, p.velocity.x, p.velocity.y, p.velocity.z, p.angular_velocity.x);
  rows.set(12, lanes, p.angular_velocity.y, p.angular_velocity.z, zero, zero);
}

struct MotionL {
  Vec3L position, velocity, angular_velocity, acceleration, angular_acceleration;
  QuatL orientation;
};
inline MotionL get_motion(const Rows<const double>& rows) {
  MotionL m;
  Lanes pad;
  rows.get(0, m.position.x, m.position.y, m.position.z, pad);
  rows.get(4, m.orientation.v.x, m.orientation.v.y, m.orientation.v.z, m.orientation.w);
  rows.get(8, m.velocity.x, m.velocity.y, m.velocity.z, m.angular_velocity.x);
  rows.get(12, m.angular_velocity.y, m.angular_velocity.z, m.acceleration.x, m.acceleration.y);
  rows.get(16, m.acceleration.z, m.angular_acceleration.x, m.angular_acceleration.y,
           m.angular_acceleration.z);
  return m;
}
inline void set_motion(const Rows<double>& rows, int lanes, const MotionL& m) {
  rows.set(0, lanes, m.position.x, m.position.y, m.position.z, all(0));
  rows.set(4, lanes, m.orientation.v.x, m.orientation.v.y, m.orientation.v.z, m.orientation.w);
  rows.set(8, lanes, m.velocity.x, m.velocity.y, m.velocity.z, m.angular_velocity.x);
  rows.set(12, lanes, m.angular_velocity.y, m.angular_velocity.z, m.acceleration.x, m.acceleration.y);
  rows.set(16, lanes, m.acceleration.z, m.angular_acceleration.x, m.angular_acceleration.y,
           m.angular_acceleration.z);
}

// Poses at the moment of balance if a₁ were 0, and every particle's own block and load.
inline void predict(const StepView& view, size_t begin, size_t end) {
  const double t = (1 - view.alpha_f) * view.h, t2 = t * view.h * view.before, tv = t * (1 - view.gamma);
  const Vec3L gravity{all(view.gravity[0]), all(view.gravity[1]), all(view.gravity[2])};
  for (size_t i = begin; i < end; ++i) {
    const Pack& pack = view.packs[i];
    const Fetch next(view, i + kNear);
    const int lanes = static_cast<int>(pack.count);
    const MotionL m = get_motion({view.from, kMotionStride, pack.self});
    const Rows<const double> particle(view.particle, kParticleStride, pack.self);
    Lanes mass, d_M, skip, skip2, skip3;
    Vec3L inertia;
    particle.get(4, mass, inertia.x, inertia.y, inertia.z);
    particle.get(8, d_M, skip, skip2, skip3);

    PoseL pose;
    pose.position = m.position + t * m.velocity + t2 * m.acceleration;
    next.particle(0), next.from(0);
    pose.orientation = rotation_exp(t * m.angular_velocity + t2 * m.angular_acceleration) * m.orientation;
    pose.velocity = m.velocity + tv * m.acceleration;
    pose.angular_velocity = m.angular_velocity + tv * m.angular_acceleration;
    set_pose({view.pose, kPoseStride, pack.slot}, lanes, pose);
    next.particle(1), next.from(1);

    const Mat3L R = matrix(pose.orientation);
    const Vec3L* r = R.column;
    const Vec3L s[3] = {inertia.x * r[0], inertia.y * r[1], inertia.z * r[2]};
    const Lanes xx = s[0].x * r[0].x + s[1].x * r[1].x + s[2].x * r[2].x;  // J = R I Rᵀ
    const Lanes yx = s[0].y * r[0].x + s[1].y * r[1].x + s[2].y * r[2].x;
    const Lanes yy = s[0].y * r[0].y + s[1].y * r[1].y + s[2].y * r[2].y;
    const Lanes zx = s[0].z * r[0].x + s[1].z * r[1].x + s[2].z * r[2].x;
    const Lanes zy = s[0].z * r[0].y + s[1].z * r[1].y + s[2].z * r[2].y;
    const Lanes zz = s[0].z * r[0].z + s[1].z * r[1].z + s[2].z * r[2].z;
    next.particle(2), next.from(2);
    const Vec3L spin = all(-view.alpha_m) * m.angular_acceleration - d_M * pose.angular_velocity;
    const Vec3L force = mass * (gravity - view.alpha_m * m.acceleration - d_M * pose.velocity);
    const Vec3L torque{xx * spin.x + yx * spin.y + zx * spin.z, yx * spin.x + yy * spin.y + zy * spin.z,
                       zx * spin.x + zy * spin.y + zz * spin.z};
    const Lanes implicit = all(1 - view.alpha_m) + view.velocity_rate * d_M, zero = all(0);
    const Lanes M = implicit * mass;
    const Rows<double> block(view.block, kBlockStride, pack.slot);
    next.particle(3), next.from(3);
    block.set(0, lanes, M, zero, M, zero);
    block.set(4, lanes, zero, M, zero, zero);
    block.set(8, lanes, zero, implicit * xx, zero, zero);
    block.set(12, lanes, zero, implicit * yx, implicit * yy, zero);
    block.set(16, lanes, zero, zero, implicit * zx, implicit * zy);
    block.set(20, lanes, implicit * zz, force.x, force.y, force.z);
    block.set(24, lanes, torque.x, torque.y, torque.z, zero);
  }
}

struct JointL {
  Lanes half_length, d_K;
  Vec3L on_parent, on_self, C_s, C_b, rest_force, rest_moment;
  QuatL rest;
};
[[gnu::always_inline]] inline JointL get_joint(const Rows<const double>& particle) {
  JointL j;
  Lanes skip, skip2, skip3;
  particle.get(0, skip, j.half_length, skip2, skip3);
  particle.get(8, skip, j.d_K, j.on_parent.x, j.on_parent.y);
  particle.get(12, j.on_parent.z, j.on_self.x, j.on_self.y, j.on_self.z);
  particle.get(16, j.rest.v.x, j.rest.v.y, j.rest.v.z, j.rest.w);
  particle.get(20, j.C_s.x, j.C_s.y, j.C_s.z, j.C_b.x);
  particle.get(24, j.C_b.y, j.C_b.z, j.rest_force.x, j.rest_force.y);
  particle.get(28, j.rest_force.z, j.rest_moment.x, j.rest_moment.y, j.rest_moment.z);
  return j;
}

// What each joint exerts, and how the solve sees it.
inline void assemble(const StepView& view, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    const Pack& pack = view.packs[i];
    double* record = view.record + i * (4 * kRecordLanes);
    const Fetch next(view, i + view.ahead), near(view, i + kNearRecord);
    const PoseL child = get_pose({view.pose, kPoseStride, pack.slot});
    const PoseL parent = get_pose({view.pose, kPoseStride, pack.parent});
    const auto [half_length, d_K, on_parent, on_self, C_s, C_b, rest_force, rest_moment, rest] =
        get_joint({view.particle, kParticleStride, pack.self});
    next.particle(0), near.record_to_write(0);

    const QuatL frame = parent.orientation * rest;
    const Mat3L F = matrix(frame);
    const Vec3L r_c = rotate(child.orientation, on_self);
    const Vec3L r_p = child.position + r_c - parent.position;
    const Vec3L e_s = transposed_times(F, r_p - rotate(parent.orientation, on_parent));
    const RotationLogL log = rotation_log(conjugate(frame) * child.orientation);
    const Vec3L& phi = log.vector;
    next.from(0), near.record_to_write(1), near.record_to_write(2);

    const Vec3L slip = child.velocity + cross(child.angular_velocity, r_c) - parent.velocity -
                       cross(parent.angular_velocity, r_p);
    const Vec3L shear_rate = transposed_times(F, slip);
    const Vec3L turning = transposed_times(F, child.angular_velocity - parent.angular_velocity);
    next.particle(1), near.record_to_write(3);
    const Vec3L about = cross(phi, turning);
    const Vec3L bend_rate = turning - 0.5 * about + log.rate2 * cross(phi, about);
    const Vec3L force = F * (rest_force - times(C_s, e_s + d_K * shear_rate));
    const Vec3L m = rest_moment - times(C_b, phi + d_K * bend_rate), back = cross(phi, m);
    const Vec3L moment = F * (m + 0.5 * back + log.rate2 * cross(phi, back));  // F Bᵀ m
    next.from(1), near.record_to_write(4);

    // D e_k = F B⁻¹ e_k, with [φ]× e_k written out
    const Lanes zero = all(0);
    const Vec3L a[3] = {{zero, phi.z, -phi.y}, {-phi.z, zero, phi.x}, {phi.y, -phi.x, zero}};
    for (int k = 0; k < 3; ++k) {
      Vec3L d = log.turn1 * a[k] + log.turn2 * cross(phi, a[k]);
      (k == 0 ? d.x : k == 1 ? d.y : d.z) += all(1);
      if (k < 2) store3(F.column[k], record + 4 * (kFrame + 3 * k));
      store3(F * d, record + 4 * (kBendFrame + 3 * k));
    }
    store3(r_c, record + 4 * kLeverChild);
    near.record_to_write(5), near.record_to_write(6);
    store3(r_p, record + 4 * kLeverParent);
    const Lanes implicit = all(view.position_rate) + view.velocity_rate * d_K;
    store3(implicit * C_s, record + 4 * kSpring);
    store3(implicit * C_b, record + 4 * (kSpring + 3));
    store3(force, record + 4 * kAction);
    near.record_to_write(7);
    store3(moment, record + 4 * (kAction + 3));
    const Lanes length = max(half_length + max(half_length, root(dot(r_c, r_c))), all(kLeastGapScale));
    store(max(max(C_s.x, C_s.y), C_s.z) > zero ? all(1) / (length * length) : zero, record + 4 * kGapWeight);
  }
}

// A symmetric 6×6 matrix [P Qᵀ; Q R].
struct InertiaL {
  Lanes P[6];     // xx yx yy zx zy zz
  Lanes Q[3][3];  // rotation × translation
  Lanes R[6];
};

// Xᵀ A X with X = [1 [s]×; 0 1]: N = Q − [s]×P, [P Nᵀ; N R + N[s]× − [s]×Qᵀ].
inline void shift(InertiaL& a, const Vec3L& s) {
  const Lanes* P = a.P;
  const Lanes full[3][3] = {{P[0], P[1], P[3]}, {P[1], P[2], P[4]}, {P[3], P[4], P[5]}};
  Lanes N[3][3], SQ[3][3];
  for (int j = 0; j < 3; ++j) {
    N[0][j] = a.Q[0][j] + (s.z * full[1][j] - s.y * full[2][j]);
    N[1][j] = a.Q[1][j] + (s.x * full[2][j] - s.z * full[0][j]);
    N[2][j] = a.Q[2][j] + (s.y * full[0][j] - s.x * full[1][j]);
    SQ[0][j] = s.y * a.Q[j][2] - s.z * a.Q[j][1];
    SQ[1][j] = s.z * a.Q[j][0] - s.x * a.Q[j][2];
    SQ[2][j] = s.x * a.Q[j][1] - s.y * a.Q[j][0];
  }
  for (int i = 0, k = 0; i < 3; ++i) {
    const Lanes NS[3] = {N[i][1] * s.z - N[i][2] * s.y, N[i][2] * s.x - N[i][0] * s.z,
                         N[i][0] * s.y - N[i][1] * s.x};
    for (int j = 0; j <= i; ++j, ++k) a.R[k] += NS[j] - SQ[i][j];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a.Q[i][j] = N[i][j];
}

inline Vec3L symmetric_times(const Lanes (&m)[6], const Vec3L& v) {
  return {m[0] * v.x + m[1] * v.y + m[3] * v.z, m[1] * v.x + m[2] * v.y + m[4] * v.z,
          m[3] * v.x + m[4] * v.y + m[5] * v.z};
}

// A ← A − A d dᵀA/c, b ← b − A d dᵀb/c for a direction that A u = (ut, ur), dᵀA d + w = c and dᵀb = t belong
// to; what the way back needs goes into the record. A direction that nothing resists stays at rest.
inline void take_rank(InertiaL& A, Vec3L& force, Vec3L& moment, const Vec3L& ut, const Vec3L& ur, Lanes c,
                      Lanes t, double* row, double* strain) {
  const Lanes inverse = c > all(0) ? all(1) / c : all(0);
  const Vec3L vt = inverse * ut, vr = inverse * ur;
  const Lanes s = inverse * t;
  store3(vt, row);
  store3(vr, row + 12);
  store(s, strain);
  const Lanes a[3] = {ut.x, ut.y, ut.z}, b[3] = {ur.x, ur.y, ur.z};
  const Lanes p[3] = {vt.x, vt.y, vt.z}, q[3] = {vr.x, vr.y, vr.z};
  for (int i = 0, k = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j, ++k) {
      A.P[k] -= a[i] * p[j];
      A.R[k] -= b[i] * q[j];
    }
    for (int j = 0; j < 3; ++j) A.Q[i][j] -= b[i] * p[j];
  }
  force = force - s * ut;
  moment = moment - s * ur;
}

[[gnu::always_inline]] inline void get_block(const Rows<double>& rows, InertiaL& A, Vec3L& force,
                                             Vec3L& moment) {
  Lanes pad;
  rows.get(0, A.P[0], A.P[1], A.P[2], A.P[3]);
  rows.get(4, A.P[4], A.P[5], A.Q[0][0], A.Q[0][1]);
  rows.get(8, A.Q[0][2], A.R[0], A.Q[1][0], A.Q[1][1]);
  rows.get(12, A.Q[1][2], A.R[1], A.R[2], A.Q[2][0]);
  rows.get(16, A.Q[2][1], A.Q[2][2], A.R[3], A.R[4]);
  rows.get(20, A.R[5], force.x, force.y, force.z);
  rows.get(24, moment.x, moment.y, moment.z, pad);
}
[[gnu::always_inline]] inline void add_block(const Rows<double>& rows, int lanes, const InertiaL& A,
                                             const Vec3L& force, const Vec3L& moment) {
  rows.add(0, lanes, A.P[0], A.P[1], A.P[2], A.P[3]);
  rows.add(4, lanes, A.P[4], A.P[5], A.Q[0][0], A.Q[0][1]);
  rows.add(8, lanes, A.Q[0][2], A.R[0], A.Q[1][0], A.Q[1][1]);
  rows.add(12, lanes, A.Q[1][2], A.R[1], A.R[2], A.Q[2][0]);
  rows.add(16, lanes, A.Q[2][1], A.Q[2][2], A.R[3], A.R[4]);
  rows.add(20, lanes, A.R[5], force.x, force.y, force.z);
  rows.add(24, lanes, moment.x, moment.y, moment.z, all(0));
}

// Leaves to root: every pack out of the system, its inertia and load passed on to its parents.
inline void factor(const StepView& view, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    const Pack& pack = view.packs[i];
    double* record = view.record + i * (4 * kRecordLanes);
    const Fetch next(view, i + view.ahead);
    InertiaL A;
    Vec3L force, moment;
    get_block({view.block, kBlockStride, pack.slot}, A, force, moment);

    const Vec3L r_c = load3(record + 4 * kLeverChild), r_p = load3(record + 4 * kLeverParent);
    shift(A, r_c);
    next.particle(2);
    moment = moment - cross(r_c, force);
    const Vec3L joint_force = load3(record + 4 * kAction), joint_moment = load3(record + 4 * (kAction + 3));
    force = force + joint_force;
    moment = moment + joint_moment;
    for (int k = 0; k < 3; ++k) {
      const Vec3L d = direction(record, k);
      const Vec3L ut = symmetric_times(A.P, d);
      const Vec3L ur{A.Q[0][0] * d.x + A.Q[0][1] * d.y + A.Q[0][2] * d.z,
                     A.Q[1][0] * d.x + A.Q[1][1] * d.y + A.Q[1][2] * d.z,
                     A.Q[2][0] * d.x + A.Q[2][1] * d.y + A.Q[2][2] * d.z};
      double* spring = record + 4 * (kSpring + k);
      take_rank(A, force, moment, ut, ur, dot(d, ut) + load(spring), dot(d, force),
                record + 4 * (kRow + 6 * k), spring);
      if (k == 0) next.from(2);
      if (k == 2) next.particle(3);
    }
    for (int k = 3; k < 6; ++k) {
      const Vec3L d = direction(record, k);
      const Vec3L ut{A.Q[0][0] * d.x + A.Q[1][0] * d.y + A.Q[2][0] * d.z,
                     A.Q[0][1] * d.x + A.Q[1][1] * d.y + A.Q[2][1] * d.z,
                     A.Q[0][2] * d.x + A.Q[1][2] * d.y + A.Q[2][2] * d.z};
      const Vec3L ur = symmetric_times(A.R, d);
      double* spring = record + 4 * (kSpring + k);
      take_rank(A, force, moment, ut, ur, dot(d, ur) + load(spring), dot(d, moment),
                record + 4 * (kRow + 6 * k), spring);
    }
    force = force - joint_force;
    next.from(3);
    moment = moment - joint_moment;
    shift(A, -r_p);
    moment = moment + cross(r_p, force);

    add_block({view.block, kBlockStride, pack.up}, static_cast<int>(pack.count), A, force, moment);
  }
}

struct AccelerationL {
  Vec3L linear, angular;
};

inline AccelerationL substitute_pack(const double* record, const AccelerationL& parent) {
  Vec3L turn = parent.angular, move = parent.linear + cross(turn, load3(record + 4 * kLeverParent));
  for (int k = 5; k >= 0; --k) {
    const double* row = record + 4 * (kRow + 6 * k);
    const Lanes s = load(record + 4 * (kSpring + k)) - (dot(load3(row), move) + dot(load3(row + 12), turn));
    const Vec3L d = direction(record, k);
    if (k >= 3)
      turn = turn + s * d;
    else
      move = move + s * d;
  }
  return {move - cross(turn, load3(record + 4 * kLeverChild)), turn};
}

// Root to leaves: accelerations alone, into the last eight numbers of each pose.
inline void substitute(const StepView& view, size_t begin, size_t end) {
  for (size_t i = end; i-- > begin;) {
    const Pack& pack = view.packs[i];
    const Rows<double> up(view.pose, kPoseStride, pack.parent), own(view.pose, kPoseStride, pack.slot);
    AccelerationL parent;
    Lanes pad, pad2;
    up.get(8, parent.linear.x, parent.linear.y, parent.linear.z, parent.angular.x);
    up.get(12, parent.angular.y, parent.angular.z, pad, pad2);
    const AccelerationL a = substitute_pack(view.record + i * (4 * kRecordLanes), parent);
    const int lanes = static_cast<int>(pack.count);
    own.set(8, lanes, a.linear.x, a.linear.y, a.linear.z, a.angular.x);
    own.set(12, lanes, a.angular.y, a.angular.z, all(0), all(0));
  }
}

// Root to leaves: accelerations, the new state, its largest gap. Of a particle that is done, its pose holds
// the new position and orientation and, in place of the velocities, the accelerations.
inline AdvanceResult advance(const StepView& view, size_t begin, size_t end) {
  const double h = view.h, h2 = h * h, b0 = view.before, b1 = view.after, c = view.gamma;
  Lanes gap = all(0), unfinite = all(0);
  for (size_t i = end; i-- > begin;) {
    const Pack& pack = view.packs[i];
    const double* record = view.record + i * (4 * kRecordLanes);
    const Fetch next(view, i < kNear ? 0 : i - kNear);
    next.record(7), next.from(0);
    const PoseL parent = get_pose({view.pose, kPoseStride, pack.parent});
    const AccelerationL a1 = substitute_pack(record, {parent.velocity, parent.angular_velocity});
    next.record(5), next.from(1), next.joint(1);
    const MotionL m = get_motion({view.from, kMotionStride, pack.self});
    next.record(6), next.to(0), next.joint(0);
    MotionL n;
    n.acceleration = a1.linear;
    n.angular_acceleration = a1.angular;
    n.position = m.position + h * m.velocity + h2 * (b0 * m.acceleration + b1 * n.acceleration);
    next.record(4), next.to(1);
    const Vec3L turn =
        h * m.angular_velocity + h2 * (b0 * m.angular_acceleration + b1 * n.angular_acceleration);
    n.orientation = normalized(rotation_exp(turn) * m.orientation);
    next.record(3), next.from(2), next.joint(2);
    n.velocity = m.velocity + h * ((1 - c) * m.acceleration + c * n.acceleration);
    n.angular_velocity =
        m.angular_velocity + h * ((1 - c) * m.angular_acceleration + c * n.angular_acceleration);

    const int lanes = static_cast<int>(pack.count);
    next.record(2), next.to(2);
    set_motion({view.to, kMotionStride, pack.self}, lanes, n);
    set_pose({view.pose, kPoseStride, pack.slot}, lanes,
             {n.position, n.acceleration, n.angular_acceleration, n.orientation});
    next.record(1), next.from(3), next.joint(3);

    const Rows<const double> particle(view.particle, kParticleStride, pack.self);
    Vec3L on_parent, on_self;
    Lanes skip, skip2;
    particle.get(8, skip, skip2, on_parent.x, on_parent.y);
    particle.get(12, on_parent.z, on_self.x, on_self.y, on_self.z);
    next.record(0), next.to(3);
    const Vec3L open =
        n.position + rotate(n.orientation, on_self) - parent.position - rotate(parent.orientation, on_parent);
    gap = max(dot(open, open) * load(record + 4 * kGapWeight), gap);
    unfinite =
        unfinite + all(0) * (dot(n.velocity, n.velocity) + dot(n.angular_velocity, n.angular_velocity) +
                             dot(n.position, n.position) + n.orientation.w);
  }
  AdvanceResult result;
  gap = root(gap);
  for (int k = 0; k < 4; ++k) {
    if (gap[k] > result.gap) result.gap = gap[k];
    if (!(unfinite[k] == 0)) result.finite = false;
  }
  return result;
}

}  // namespace liana::LIANA_LANES
