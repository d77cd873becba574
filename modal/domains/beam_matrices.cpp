#include "modal/domains/beam_matrices.h"

#include <algorithm>
#include <cmath>

namespace liana {
namespace {

/// An element along x, its width along y, its thickness along z: 6 dof at either end.
struct Element12 {
  double k[12][12] = {}, m[12][12] = {};
};

void pair(double (&matrix)[12][12], int i, double own, double other) {
  matrix[i][i] += own, matrix[i + 6][i + 6] += own;
  matrix[i][i + 6] += other, matrix[i + 6][i] += other;
}

/// v: deflection, r: rotation, sign: dv/dx = sign r.
void bend(double (&k)[12][12], int v, int r, double sign, double I, double phi, double h) {
  const double c = I / (h * h * h * (1 + phi));
  const int at[4] = {v, r, v + 6, r + 6};
  const double factor[4] = {1, sign, 1, sign};
  const double own = (4 + phi) * h * h, other = (2 - phi) * h * h;
  const double entries[4][4] = {{12, 6 * h, -12, 6 * h},
                                {6 * h, own, -6 * h, other},
                                {-12, -6 * h, 12, -6 * h},
                                {6 * h, other, -6 * h, own}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) k[at[i]][at[j]] += c * factor[i] * factor[j] * entries[i][j];
}

/// a, b: half axes, A: area, h: length; dimensionless. Bending in y is resisted by I_w, in z by I_t.
Element12 element(double a, double b, double A, double h, double nu) {
  const double I_w = kPi * a * a * a * b / 4, I_t = kPi * a * b * b * b / 4,
               J = kPi * std::pow(a * b, 3) / (a * a + b * b), G = 1 / (2 * (1 + nu)),
               kappa = 6 * (1 + nu) / (7 + 6 * nu);
  // A wide band cannot curl at its clamp: of 1 / (1 - ν²) as much as fits cantilevered plates of width over
  // length x = 1/3, 1/2, 1 within 0.3 % (Leissa 1969, table 4.59: ω a² √(ρ h / D) = 3.43, 3.44, 3.47
  // against 3.354 of a beam).
  const double x_wide = 2 * a / 1.1414,
               restraint = 1 + (1 / std::sqrt(1 - nu * nu) - 1) * x_wide / (x_wide + 0.37),
               flat = (a * a - b * b) / (a * a + b * b), K_t = I_t * (1 + flat * (restraint * restraint - 1));
  Element12 e;
  pair(e.k, 0, A / h, -A / h);
  pair(e.k, 3, G * J / h, -G * J / h);
  // Bending in y turns about +z, in z about −y.
  bend(e.k, 1, 5, 1, I_w, 12 * I_w / (kappa * G * A * h * h), h);
  bend(e.k, 2, 4, -1, K_t, 12 * K_t / (kappa * G * A * h * h), h);
  for (int i = 0; i < 3; ++i) pair(e.m, i, A * h / 3, A * h / 6);
  pair(e.m, 3, (I_w + I_t) * h / 3, (I_w + I_t) * h / 6);
  pair(e.m, 4, I_t * h / 3, I_t * h / 6);
  pair(e.m, 5, I_w * h / 3, I_w * h / 6);
  return e;
}

/// Adds an element, turned: axes has the local x, y and z as rows. Block by block, as products of whole 12 ×
/// 12 matrices of fixed size take the compiler half a minute.
void add(const double (&local)[12][12], const Mat3& axes, Eigen::Index at, Eigen::MatrixXd& whole) {
  for (int i = 0; i < 12; i += 3)
    for (int j = 0; j < 12; j += 3) {
      Mat3 block;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) block(r, c) = local[i + r][j + c];
      whole.block<3, 3>(at + i, at + j) += axes.transpose() * block * axes;
    }
}

void carry(const std::vector<Section>& sections, const CarriedMass& carried, double density,
           BeamMatrices& beam) {
  size_t best = 0;
  double best_part = 0, nearest = std::numeric_limits<double>::infinity();
  for (size_t e = 0; e + 1 < sections.size(); ++e) {
    const Vec3 a = sections[e].centre, along = sections[e + 1].centre - a;
    const double part = std::clamp((carried.position - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (a + part * along - carried.position).norm();
    if (distance < nearest) nearest = distance, best = e, best_part = part;
  }
  for (const auto& [node, share] : {std::pair{best, 1 - best_part}, std::pair{best + 1, best_part}}) {
    // u = u_node + θ × arm
    const Mat3 turning = -cross_matrix((carried.position - sections[node].centre) / beam.unit);
    const double m = share * carried.mass / (density * std::pow(beam.unit, 3));
    const auto at = static_cast<Eigen::Index>(6 * node);
    beam.mass.block<3, 3>(at, at) += m * Mat3::Identity();
    beam.mass.block<3, 3>(at, at + 3) += m * turning;
    beam.mass.block<3, 3>(at + 3, at) += m * turning.transpose();
    beam.mass.block<3, 3>(at + 3, at + 3) += m * turning.transpose() * turning;
  }
}

}  // namespace

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

BeamMatrices beam_matrices(const std::vector<Section>& sections, const ElasticMaterial& material,
                           std::span<const CarriedMass> carried) {
  BeamMatrices beam;
  for (size_t e = 0; e + 1 < sections.size(); ++e)
    beam.unit += (sections[e + 1].centre - sections[e].centre).norm();
  const auto dof = static_cast<Eigen::Index>(6 * sections.size());
  beam.stiffness = beam.mass = Eigen::MatrixXd::Zero(dof, dof);
  for (size_t e = 0; e + 1 < sections.size(); ++e) {
    const Section s = between(sections[e], sections[e + 1], 0.5);
    const Vec3 step = (sections[e + 1].centre - sections[e].centre) / beam.unit, x = step.normalized();
    Vec3 z = s.thin_axis - s.thin_axis.dot(x) * x;
    z = z.norm() > 1e-6 ? Vec3(z.normalized()) : x.unitOrthogonal();
    Mat3 axes;  // rows
    axes << x.transpose(), z.cross(x).transpose(), z.transpose();
    const Element12 own = element(s.half_width / beam.unit, s.half_thickness / beam.unit,
                                  s.area / (beam.unit * beam.unit), step.norm(), material.poisson_ratio);
    add(own.k, axes, static_cast<Eigen::Index>(6 * e), beam.stiffness);
    add(own.m, axes, static_cast<Eigen::Index>(6 * e), beam.mass);
  }
  for (const CarriedMass& mass : carried) carry(sections, mass, material.density, beam);
  return beam;
}

}  // namespace liana
