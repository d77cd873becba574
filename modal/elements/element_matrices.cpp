#include "modal/elements/element_matrices.h"

namespace liana {
namespace {

/// One term c g_k g_lᵀ of a T10 block, as (k, l, c).
struct Term {
  int k, l;
  double c;
};
struct Terms {
  std::array<Term, 4> terms;
  int count;
};

/// ∇N_a = Σ over at most two corners of (linear weight) g_k; this expands ∫ ∇N_a ∇N_bᵀ dV / V.
constexpr std::array<Terms, 55> make_t10_terms() {
  // ∫ L_k L_l dV / V and, with the corners' −1, the averages of (4 L_a − 1)(4 L_b − 1) and (4 L_a − 1) L_c.
  const auto mean = [](int k, int l) { return k == l ? 0.1 : 0.05; };
  std::array<Terms, 55> table{};
  for (int a = 0; a < 10; ++a) {
    for (int b = 0; b <= a; ++b) {
      Terms& t = table[pair_index(a, b)];
      if (a < 4) {
        t = {{{{a, b, a == b ? 0.6 : -0.2}}}, 1};
      } else if (b < 4) {
        const auto [c, d] = kTetEdges[a - 4];
        t = {{{{d, b, 4 * (4 * mean(b, c) - 0.25)}, {c, b, 4 * (4 * mean(b, d) - 0.25)}}}, 2};
      } else {
        const auto [c, d] = kTetEdges[a - 4];
        const auto [e, f] = kTetEdges[b - 4];
        t = {{{{d, f, 16 * mean(c, e)},
               {d, e, 16 * mean(c, f)},
               {c, f, 16 * mean(d, e)},
               {c, e, 16 * mean(d, f)}}},
             4};
      }
    }
  }
  return table;
}

constexpr std::array<double, 55> make_t10_mass() {
  // V/420 times: corners 6 (same), 1; corner and edge −4 (on it), −6; edges 32 (same), 16 (sharing a
  // corner), 8.
  std::array<double, 55> mass{};
  for (int a = 0; a < 10; ++a) {
    for (int b = 0; b <= a; ++b) {
      double value = a == b ? 6 : 1;
      if (a >= 4 && b < 4) {
        const auto [c, d] = kTetEdges[a - 4];
        value = b == c || b == d ? -4 : -6;
      } else if (b >= 4) {
        const auto [c, d] = kTetEdges[a - 4];
        const auto [e, f] = kTetEdges[b - 4];
        value = a == b ? 32 : (c == e || c == f || d == e || d == f) ? 16 : 8;
      }
      mass[pair_index(a, b)] = value / 420;
    }
  }
  return mass;
}

constexpr std::array<double, 10> make_t4_mass() {
  std::array<double, 10> mass{};
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b <= a; ++b) mass[pair_index(a, b)] = a == b ? 0.1 : 0.05;
  return mass;
}

constexpr auto kT10Terms = make_t10_terms();
constexpr auto kT10Mass = make_t10_mass();
constexpr auto kT4Mass = make_t4_mass();

}  // namespace

TetGeometry tet_geometry(const std::array<Vec3, 4>& corners) {
  const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0], w = corners[3] - corners[0];
  const Vec3 vw = v.cross(w), wu = w.cross(u), uv = u.cross(v);
  const double six_volumes = u.dot(vw);
  TetGeometry tet;
  tet.volume = six_volumes / 6;
  tet.gradients[1] = vw / six_volumes;
  tet.gradients[2] = wu / six_volumes;
  tet.gradients[3] = uv / six_volumes;
  tet.gradients[0] = -(tet.gradients[1] + tet.gradients[2] + tet.gradients[3]);
  return tet;
}

TetGeometry element_geometry(const NodeMesh& mesh, size_t element, double length) {
  const auto nodes = mesh.element(element);
  std::array<Vec3, 4> corners;
  for (int k = 0; k < 4; ++k) corners[k] = (mesh.positions[nodes[k]] - mesh.positions[nodes[0]]) / length;
  return tet_geometry(corners);
}

void element_stiffness(Element element, const TetGeometry& tet, const LameConstants& lame,
                       std::span<Mat3> blocks) {
  // Q_kl = V (λ g_k g_lᵀ + μ g_l g_kᵀ + μ (g_k·g_l) I); the map from outer products to blocks is linear.
  Mat3 Q[4][4];
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l <= k; ++l) {
      const Mat3 P = tet.volume * tet.gradients[k] * tet.gradients[l].transpose();
      Q[k][l] = lame.lambda * P + lame.mu * P.transpose();
      Q[k][l].diagonal().array() += lame.mu * P.trace();
      if (k != l) Q[l][k] = Q[k][l].transpose();
    }
  }
  if (element == Element::T4) {
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b <= a; ++b) blocks[pair_index(a, b)] = Q[a][b];
    return;
  }
  for (int pair = 0; pair < 55; ++pair) {
    const Terms& t = kT10Terms[pair];
    blocks[pair] = t.terms[0].c * Q[t.terms[0].k][t.terms[0].l];
    for (int i = 1; i < t.count; ++i) blocks[pair] += t.terms[i].c * Q[t.terms[i].k][t.terms[i].l];
  }
}

std::span<const double> unit_mass(Element element) {
  if (element == Element::T10) return kT10Mass;
  return kT4Mass;
}

}  // namespace liana
