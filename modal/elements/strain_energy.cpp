#include "modal/elements/strain_energy.h"

#include "modal/elements/element_matrices.h"

namespace liana {
namespace {

/// The four points that integrate quadratics exactly: one barycentric coordinate kHigh, the others kLow.
constexpr double kHigh = 0.58541019662496845446, kLow = 0.13819660112501051518;

double density(const Mat3& gradient, const LameConstants& lame) {
  const Mat3 strain = (gradient + gradient.transpose()) / 2;
  const double trace = strain.trace();
  return lame.lambda * trace * trace + 2 * lame.mu * strain.squaredNorm();
}

}  // namespace

Eigen::VectorXd stiffness_quotients(const NodeMesh& mesh, const System& system, double poisson_ratio,
                                    const NodalVectors& shapes, std::span<const ElementScaling> scaling) {
  const LameConstants uniform = LameConstants::of(1, poisson_ratio);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(shapes.cols());
  for (size_t e = 0; e < mesh.element_count(); ++e) {
    const auto nodes = mesh.element(e);
    const LameConstants lame = uniform.scaled(scaling.empty() ? 1 : scaling[e].stiffness);
    const TetGeometry tet = element_geometry(mesh, e, system.length);
    for (Eigen::Index column = 0; column < shapes.cols(); ++column) {
      const auto u = [&](int a) -> Vec3 { return shapes.block<3, 1>(3 * nodes[a], column); };
      Mat3 linear = Mat3::Zero();  // ∇u of the corners, from differences
      for (int k = 1; k < 4; ++k) linear += (u(k) - u(0)) * tet.gradients[k].transpose();
      if (nodes.size() == 4) {
        sums[column] += tet.volume * density(linear, lame);
        continue;
      }
      std::array<Vec3, 6> bulge;  // of the mid-edge nodes out of the straight edges
      for (int i = 0; i < 6; ++i) bulge[i] = 4 * u(4 + i) - 2 * (u(kTetEdges[i][0]) + u(kTetEdges[i][1]));
      for (int point = 0; point < 4; ++point) {
        Mat3 gradient = linear;
        for (int i = 0; i < 6; ++i) {
          const auto [c, d] = kTetEdges[i];
          gradient += bulge[i] * ((c == point ? kHigh : kLow) * tet.gradients[d] +
                                  (d == point ? kHigh : kLow) * tet.gradients[c])
                                     .transpose();
        }
        sums[column] += tet.volume / 4 * density(gradient, lame);
      }
    }
  }
  return sums;
}

}  // namespace liana
