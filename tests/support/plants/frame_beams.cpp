#include "tests/support/plants/frame_beams.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace liana::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Mat12 = Eigen::Matrix<double, 12, 12>;

struct Section {
  double E, G, rho, area, I, polar;
};

// Bending in one plane, degrees of freedom (w₁, θ₁, w₂, θ₂) with θ = dw/ds ([Przemieniecki 1968] §5.6, §11.7;
// the mass is that of the cubic shapes with their rotary inertia).
void add_bending(const Section& s, double L, const int (&at)[4], const double (&sign)[4], Mat12& K,
                 Mat12& M) {
  const double phi = 12 * s.E * s.I / (s.G * s.area * L * L), k = s.E * s.I / (L * L * L * (1 + phi));
  const double stiffness[4][4] = {{12, 6 * L, -12, 6 * L},
                                  {6 * L, (4 + phi) * L * L, -6 * L, (2 - phi) * L * L},
                                  {-12, -6 * L, 12, -6 * L},
                                  {6 * L, (2 - phi) * L * L, -6 * L, (4 + phi) * L * L}};
  const double mass[4][4] = {{156, 22 * L, 54, -13 * L},
                             {22 * L, 4 * L * L, 13 * L, -3 * L * L},
                             {54, 13 * L, 156, -22 * L},
                             {-13 * L, -3 * L * L, -22 * L, 4 * L * L}};
  const double rotary[4][4] = {{36, 3 * L, -36, 3 * L},
                               {3 * L, 4 * L * L, -3 * L, -L * L},
                               {-36, -3 * L, 36, -3 * L},
                               {3 * L, -L * L, -3 * L, 4 * L * L}};
  const double m = s.rho * s.area * L / 420, r = s.rho * s.I / (30 * L);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const double both = sign[i] * sign[j];
      K(at[i], at[j]) += both * k * stiffness[i][j];
      M(at[i], at[j]) += both * (m * mass[i][j] + r * rotary[i][j]);
    }
}

// Local axes: x along the element; degrees of freedom (u, v, w, θx, θy, θz) per node. θz = dv/dx, θy =
// −dw/dx.
void element(const Section& s, double L, Mat12& K, Mat12& M) {
  K.setZero();
  M.setZero();
  add_bending(s, L, {1, 5, 7, 11}, {1, 1, 1, 1}, K, M);
  add_bending(s, L, {2, 4, 8, 10}, {1, -1, 1, -1}, K, M);
  const auto add_bar = [&](int a, int b, double stiffness, double mass) {
    K(a, a) += stiffness, K(b, b) += stiffness, K(a, b) -= stiffness, K(b, a) -= stiffness;
    M(a, a) += mass / 3, M(b, b) += mass / 3, M(a, b) += mass / 6, M(b, a) += mass / 6;
  };
  add_bar(0, 6, s.E * s.area / L, s.rho * s.area * L);
  add_bar(3, 9, s.G * s.polar / L, s.rho * s.polar * L);
}

}  // namespace

std::vector<double> frame_frequencies(const Frame& frame, int count) {
  Eigen::Index nodes = static_cast<Eigen::Index>(frame.nodes.size());
  for (const FrameBeam& beam : frame.beams) nodes += beam.elements - 1;
  MatrixXd K = MatrixXd::Zero(6 * nodes, 6 * nodes), M = K;
  Eigen::Index next = static_cast<Eigen::Index>(frame.nodes.size());
  for (const FrameBeam& beam : frame.beams) {
    const double r2 = beam.radius * beam.radius, pi = std::numbers::pi;
    const Section section{frame.youngs_modulus, frame.youngs_modulus / (2 * (1 + frame.poisson_ratio)),
                          frame.density,        pi * r2,
                          pi * r2 * r2 / 4,     pi * r2 * r2 / 2};
    const Vector3d along =
        frame.nodes[static_cast<size_t>(beam.to)] - frame.nodes[static_cast<size_t>(beam.from)];
    const double L = along.norm() / beam.elements;
    Eigen::Matrix3d axes;  // rows: the element's
    axes.row(0) = along.normalized();
    axes.row(1) = Vector3d(along.normalized().unitOrthogonal());
    axes.row(2) = Vector3d(axes.row(0)).cross(Vector3d(axes.row(1)));
    Mat12 k, m, T = Mat12::Zero();
    element(section, L, k, m);
    for (int b = 0; b < 4; ++b) T.block<3, 3>(3 * b, 3 * b) = axes;
    k = (T.transpose() * k * T).eval();
    m = (T.transpose() * m * T).eval();
    Eigen::Index from = beam.from;
    for (int e = 0; e < beam.elements; ++e) {
      const Eigen::Index to = e + 1 < beam.elements ? next++ : beam.to;
      const Eigen::Index at[2] = {6 * from, 6 * to};
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
          K.block<6, 6>(at[a], at[b]) += k.block<6, 6>(6 * a, 6 * b);
          M.block<6, 6>(at[a], at[b]) += m.block<6, 6>(6 * a, 6 * b);
        }
      from = to;
    }
  }
  const Eigen::Index free = 6 * (nodes - 1);  // node 0 is clamped
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(MatrixXd(K.bottomRightCorner(free, free)),
                                                                 MatrixXd(M.bottomRightCorner(free, free)),
                                                                 Eigen::EigenvaluesOnly);
  std::vector<double> frequencies;
  for (int i = 0; i < count; ++i)
    frequencies.push_back(std::sqrt(modes.eigenvalues()[i]) / (2 * std::numbers::pi));
  return frequencies;
}

}  // namespace liana::test
