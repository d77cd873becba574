#include "tests/support/plants/tree_solver.h"

namespace liana {
namespace {

constexpr int at(int row, int column) {
  return row * (row + 1) / 2 + column;
}  // row ≥ column, packed

// out = Xᵀ A X with X = [1 [s]×; 0 1], in 3×3 parts: A = [P Qᵀ; Q R], N = Q − [s]×P,
// out = [P Nᵀ; N R + N[s]× − [s]×Qᵀ].
inline void shift(const double* a, const Vec3& s, double* out) {
  const double x = s.x(), y = s.y(), z = s.z();
  const double P[3][3] = {{a[0], a[1], a[3]}, {a[1], a[2], a[4]}, {a[3], a[4], a[5]}};
  const double Q[3][3] = {{a[6], a[7], a[8]}, {a[10], a[11], a[12]}, {a[15], a[16], a[17]}};
  double N[3][3], SQ[3][3];
  for (int j = 0; j < 3; ++j) {
    N[0][j] = Q[0][j] + z * P[1][j] - y * P[2][j];
    N[1][j] = Q[1][j] - z * P[0][j] + x * P[2][j];
    N[2][j] = Q[2][j] + y * P[0][j] - x * P[1][j];
    SQ[0][j] = y * Q[j][2] - z * Q[j][1];
    SQ[1][j] = z * Q[j][0] - x * Q[j][2];
    SQ[2][j] = x * Q[j][1] - y * Q[j][0];
  }
  for (int k = 0; k < 6; ++k) out[k] = a[k];
  for (int i = 0; i < 3; ++i) {
    const double NS[3] = {N[i][1] * z - N[i][2] * y, N[i][2] * x - N[i][0] * z, N[i][0] * y - N[i][1] * x};
    for (int j = 0; j < 3; ++j) out[at(3 + i, j)] = N[i][j];
    for (int j = 0; j <= i; ++j) out[at(3 + i, 3 + j)] = a[at(3 + i, 3 + j)] + NS[j] - SQ[i][j];
  }
}

// In place: A = L D Lᵀ, L strictly below the diagonal, 1/D on it. A direction that nothing resists (pivot not
// positive) gets 0 for its inverse pivot and so stays at rest.
inline void factorise(double* a) {
  for (int j = 0; j < 6; ++j) {
    double scaled[6];
    double pivot = a[at(j, j)];
    for (int k = 0; k < j; ++k) {
      scaled[k] = a[at(j, k)];
      a[at(j, k)] *= a[at(k, k)];
      pivot -= scaled[k] * a[at(j, k)];
    }
    for (int i = j + 1; i < 6; ++i)
      for (int k = 0; k < j; ++k) a[at(i, j)] -= a[at(i, k)] * a[at(j, k)];
    a[at(j, j)] = pivot > 0 ? 1 / pivot : 0;
  }
}

// v = (L D Lᵀ)⁻¹ v
inline void solve_factored(const double* l, double* v) {
  for (int i = 1; i < 6; ++i)
    for (int k = 0; k < i; ++k) v[i] -= l[at(i, k)] * v[k];
  for (int i = 0; i < 6; ++i) v[i] *= l[at(i, i)];
  for (int i = 4; i >= 0; --i)
    for (int k = i + 1; k < 6; ++k) v[i] -= l[at(k, i)] * v[k];
}

inline void add_symmetric(const Mat3& m, int corner, double* a) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) a[at(corner + i, corner + j)] += m(i, j);
}

}  // namespace

void TreeSolver::reset(size_t node, double mass, const Mat3& inertia, const Vec3& force,
                       const Vec3& torque) noexcept {
  Node& n = nodes_[node];
  for (double& value : n.inertia) value = 0;
  for (int i = 0; i < 3; ++i) n.inertia[at(i, i)] = mass;
  add_symmetric(inertia, 3, n.inertia);
  for (int i = 0; i < 3; ++i) n.load[i] = force[i], n.load[3 + i] = torque[i];
}

void TreeSolver::add_point(size_t node, const Vec3& lever, const Mat3& stiffness) noexcept {
  double at_point[kPacked] = {}, at_centre[kPacked];
  add_symmetric(stiffness, 0, at_point);
  shift(at_point, -lever, at_centre);
  for (int k = 0; k < kPacked; ++k) nodes_[node].inertia[k] += at_centre[k];
}

void TreeSolver::add_load(size_t node, const Vec3& force, const Vec3& torque) noexcept {
  double* load = nodes_[node].load;
  for (int i = 0; i < 3; ++i) load[i] += force[i], load[3 + i] += torque[i];
}

void TreeSolver::eliminate(size_t node, uint32_t parent, const TreeJoint& joint) noexcept {
  Node& n = nodes_[node];
  n.from_self = joint.from_self;
  n.from_parent = joint.from_parent;
  n.parent = parent;

  // Inertia and load seen at the joint: Ā, b̄.
  double A[kPacked];
  shift(n.inertia, joint.from_self, A);
  const Vec3 force(n.load[0], n.load[1], n.load[2]);
  const Vec3 moment = Vec3(n.load[3], n.load[4], n.load[5]) - joint.from_self.cross(force);
  for (int k = 0; k < kPacked; ++k) n.inertia[k] = n.factor[k] = A[k];
  for (int i = 0; i < 3; ++i) n.load[3 + i] = moment[i];
  add_symmetric(joint.shear, 0, n.factor);
  add_symmetric(joint.bend, 3, n.factor);
  factorise(n.factor);
  if (parent == kRoot) return;

  // X = L⁻¹ [Ā b̄], rows of eight (one unused) so that vector lanes fill; then the lower triangle of
  // S = Ā − (L⁻¹Ā)ᵀ D⁻¹ X and b' = b̄ − (L⁻¹Ā)ᵀ D⁻¹ L⁻¹ b̄, in pairs of columns.
  double X[6][8], Y[6][8];
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) X[i][j] = A[i >= j ? at(i, j) : at(j, i)];
    X[i][6] = n.load[i];
    X[i][7] = 0;
    for (int k = 0; k < i; ++k) {
      const double l = n.factor[at(i, k)];
      for (int j = 0; j < 8; ++j) X[i][j] -= l * X[k][j];
    }
  }
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 8; ++j) Y[k][j] = n.factor[at(k, k)] * X[k][j];
  double passed[kPacked], load[6];
  for (int i = 0; i < 6; ++i) {
    double row[6] = {}, last = 0;
    for (int k = 0; k < 6; ++k) {
      for (int j = 0; j < (i + 2) / 2 * 2; ++j) row[j] += X[k][i] * Y[k][j];
      last += X[k][i] * Y[k][6];
    }
    for (int j = 0; j <= i; ++j) passed[at(i, j)] = A[at(i, j)] - row[j];
    load[i] = n.load[i] - last;
  }

  double at_parent[kPacked];
  shift(passed, -joint.from_parent, at_parent);
  Node& p = nodes_[parent];
  for (int k = 0; k < kPacked; ++k) p.inertia[k] += at_parent[k];
  const Vec3 passed_force(load[0], load[1], load[2]), passed_moment(load[3], load[4], load[5]);
  add_load(parent, passed_force, passed_moment + joint.from_parent.cross(passed_force));
}

const Vec6& TreeSolver::substitute(size_t node) noexcept {
  Node& n = nodes_[node];
  Vec6 g = Vec6::Zero();  // the joint's point, moved by the parent as one body
  if (n.parent != kRoot) {
    const Vec6& p = nodes_[n.parent].motion;
    const Vec3 turn = p.tail<3>();
    g << p.head<3>() + turn.cross(n.from_parent), turn;
  }
  double strain[6];  // y − g = (Ā+W)⁻¹ (b̄ − Ā g)
  for (int i = 0; i < 6; ++i) {
    strain[i] = n.load[i];
    for (int j = 0; j < 6; ++j) strain[i] -= n.inertia[i >= j ? at(i, j) : at(j, i)] * g[j];
  }
  solve_factored(n.factor, strain);
  const Vec3 turn = g.tail<3>() + Vec3(strain[3], strain[4], strain[5]);
  const Vec3 point = g.head<3>() + Vec3(strain[0], strain[1], strain[2]);
  n.motion << point - turn.cross(n.from_self), turn;
  return n.motion;
}

}  // namespace liana
