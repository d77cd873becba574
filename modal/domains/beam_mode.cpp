#include "modal/domains/beam_mode.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr int kElements = 32;

using Matrix12 = Eigen::Matrix<double, 12, 12>;

double area_of(const Section& s) {
  return s.area > 0 ? s.area : kPi * s.half_width * s.half_thickness;
}

Section between(const Section& a, const Section& b, double part) {
  const auto mix = [&](double x, double y) { return (1 - part) * x + part * y; };
  const Vec3 other = a.thin_axis.dot(b.thin_axis) < 0 ? Vec3(-b.thin_axis) : b.thin_axis;
  return {(1 - part) * a.centre + part * b.centre, mix(a.half_width, b.half_width),
          mix(a.half_thickness, b.half_thickness), Vec3((1 - part) * a.thin_axis + part * other).normalized(),
          mix(area_of(a), area_of(b))};
}

/// kElements + 1 sections, evenly along the line, up to where they hold `volume`.
std::vector<Section> resample(std::span<const Section> line, double volume) {
  std::vector<double> along{0};
  double length = 0, held = 0;
  for (size_t i = 1; i < line.size(); ++i) {
    const double step = (line[i].centre - line[i - 1].centre).norm();
    const double a = area_of(line[i - 1]), b = area_of(line[i]);
    along.push_back(along.back() + step);
    if (volume > 0 && held + step * (a + b) / 2 >= volume) {
      // The root of a x + (b − a) x² / (2 step) = volume − held, in a form that stands b = a.
      const double rest = volume - held, slope = (b - a) / step;
      length = along[i - 1] + 2 * rest / (a + std::sqrt(std::max(0.0, a * a + 2 * slope * rest)));
      break;
    }
    held += step * (a + b) / 2;
    length = along.back();
  }
  if (!(length > 0) || !std::isfinite(length))
    throw Error(Error::Kind::Input, "its centreline has no length", "give the domain a surface");
  std::vector<Section> sections;
  size_t i = 0;
  for (int k = 0; k <= kElements; ++k) {
    const double s = length * k / kElements;
    while (i + 2 < along.size() && along[i + 1] < s) ++i;
    const double step = along[i + 1] - along[i];
    sections.push_back(between(line[i], line[i + 1], step > 0 ? std::min(1.0, (s - along[i]) / step) : 0));
    const Section& last = sections.back();
    if (!(last.half_thickness > 0) || !(last.half_width > 0) || !last.centre.allFinite())
      throw Error(Error::Kind::Input, "a section of its centreline has no size", "give the domain a surface");
  }
  return sections;
}

/// K and M in units of E ℓ and ρ ℓ³, 6 dof a node (displacement over ℓ, rotation), the first node held.
class Beam {
 public:
  Beam(std::span<const Section> line, double volume, const ElasticMaterial& material)
      : sections_(resample(line, volume)), material_(material) {
    for (int e = 0; e < kElements; ++e) unit_ += (sections_[e + 1].centre - sections_[e].centre).norm();
    stiffness_ = mass_ = Eigen::MatrixXd::Zero(6 * (kElements + 1), 6 * (kElements + 1));
    for (int e = 0; e < kElements; ++e) add_element(e);
  }

  void carry(const CarriedMass& carried) {
    int best = 0;
    double best_part = 0, nearest = std::numeric_limits<double>::infinity();
    for (int e = 0; e < kElements; ++e) {
      const Vec3 a = sections_[e].centre, along = sections_[e + 1].centre - a;
      const double part = std::clamp((carried.position - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double distance = (a + part * along - carried.position).norm();
      if (distance < nearest) nearest = distance, best = e, best_part = part;
    }
    for (const auto& [node, share] : {std::pair{best, 1 - best_part}, std::pair{best + 1, best_part}}) {
      // u = u_node + θ × arm
      const Vec3 arm = (carried.position - sections_[node].centre) / unit_;
      Eigen::Matrix<double, 3, 6> rigid;
      rigid << Mat3::Identity(), -cross(arm);
      const double m = share * carried.mass / (material_.density * std::pow(unit_, 3));
      mass_.block<6, 6>(6 * node, 6 * node) += m * rigid.transpose() * rigid;
    }
  }

  Modes solve(int count) const;

 private:
  static Mat3 cross(const Vec3& a) {
    Mat3 m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
  }

  /// Local axes: x along, y wide, z thin. Bending in y is resisted by I_w, in z by I_t.
  void add_element(int e) {
    const Section s = between(sections_[e], sections_[e + 1], 0.5);
    const Vec3 step = (sections_[e + 1].centre - sections_[e].centre) / unit_, x = step.normalized();
    Vec3 z = s.thin_axis - s.thin_axis.dot(x) * x;
    z = z.norm() > 1e-6 ? Vec3(z.normalized()) : x.unitOrthogonal();
    Mat3 axes;  // rows
    axes << x.transpose(), z.cross(x).transpose(), z.transpose();

    const double h = step.norm(), a = s.half_width / unit_, b = s.half_thickness / unit_,
                 A = s.area / (unit_ * unit_), I_w = kPi * a * a * a * b / 4, I_t = kPi * a * b * b * b / 4,
                 J = kPi * std::pow(a * b, 3) / (a * a + b * b), nu = material_.poisson_ratio,
                 G = 1 / (2 * (1 + nu)), kappa = 6 * (1 + nu) / (7 + 6 * nu);
    // A wide band cannot curl at its clamp: of 1 / (1 - ν²) as much as fits cantilevered plates of width over
    // length x = 1/3, 1/2, 1 within 0.3 % (Leissa 1969, table 4.59: ω a² √(ρ h / D) = 3.43, 3.44, 3.47
    // against 3.354 of a beam).
    const double x_wide = 2 * a / 1.1414,
                 restraint = 1 + (1 / std::sqrt(1 - nu * nu) - 1) * x_wide / (x_wide + 0.37),
                 flat = (a * a - b * b) / (a * a + b * b),
                 K_t = I_t * (1 + flat * (restraint * restraint - 1));
    Matrix12 k = Matrix12::Zero(), m = Matrix12::Zero();
    const auto pair = [](Matrix12& matrix, int i, double own, double other) {
      matrix(i, i) += own, matrix(i + 6, i + 6) += own;
      matrix(i, i + 6) += other, matrix(i + 6, i) += other;
    };
    pair(k, 0, A / h, -A / h);
    pair(k, 3, G * J / h, -G * J / h);
    // Bending in y turns about +z, in z about −y.
    bend(k, 1, 5, 1, I_w, 12 * I_w / (kappa * G * A * h * h), h);
    bend(k, 2, 4, -1, K_t, 12 * K_t / (kappa * G * A * h * h), h);
    for (int i = 0; i < 3; ++i) pair(m, i, A * h / 3, A * h / 6);
    pair(m, 3, (I_w + I_t) * h / 3, (I_w + I_t) * h / 6);
    pair(m, 4, I_t * h / 3, I_t * h / 6);
    pair(m, 5, I_w * h / 3, I_w * h / 6);

    Matrix12 turn = Matrix12::Zero();
    for (int i = 0; i < 4; ++i) turn.block<3, 3>(3 * i, 3 * i) = axes;
    stiffness_.block<12, 12>(6 * e, 6 * e) += turn.transpose() * k * turn;
    mass_.block<12, 12>(6 * e, 6 * e) += turn.transpose() * m * turn;
  }

  /// Exact for loads at the ends [Przemieniecki 1968, §5.6]. v: deflection, r: rotation, sign: dv/dx = sign
  /// r.
  static void bend(Matrix12& k, int v, int r, double sign, double I, double phi, double h) {
    const double c = I / (h * h * h * (1 + phi));
    const int at[4] = {v, r, v + 6, r + 6};
    const double factor[4] = {1, sign, 1, sign};
    const double own = (4 + phi) * h * h, other = (2 - phi) * h * h;
    const double entries[4][4] = {{12, 6 * h, -12, 6 * h},
                                  {6 * h, own, -6 * h, other},
                                  {-12, -6 * h, 12, -6 * h},
                                  {6 * h, other, -6 * h, own}};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) k(at[i], at[j]) += c * factor[i] * factor[j] * entries[i][j];
  }

  std::vector<Section> sections_;
  ElasticMaterial material_;
  double unit_ = 0;  // m, the length of the line
  Eigen::MatrixXd stiffness_, mass_;
};

Modes Beam::solve(int count) const {
  const Eigen::Index n = 6 * kElements;
  const Eigen::MatrixXd K = stiffness_.bottomRightCorner(n, n), M = mass_.bottomRightCorner(n, n);
  const Eigen::LLT<Eigen::MatrixXd> factor(K);
  if (factor.info() != Eigen::Success)
    throw Error(Error::Kind::Input, "the beam through its sections has no stiffness", "give it thickness");
  // Static deflections under uniform and under angular acceleration.
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(n, 6);
  for (Eigen::Index node = 0; node < kElements; ++node) {
    X.block<3, 3>(6 * node, 0) = Mat3::Identity();
    const Vec3 arm = (sections_[node + 1].centre - sections_[0].centre) / unit_;
    X.block<3, 3>(6 * node, 3) = -cross(arm);
    X.block<3, 3>(6 * node + 3, 3) = Mat3::Identity();
  }
  const double time = unit_ * std::sqrt(material_.density / material_.youngs_modulus);
  const auto frequency = [&](double lambda) { return std::sqrt(std::max(0.0, lambda)) / (2 * kPi * time); };
  const auto ritz = [&](Eigen::MatrixXd& vectors) -> Eigen::VectorXd {
    const Eigen::MatrixXd k = vectors.transpose() * K * vectors, m = vectors.transpose() * M * vectors;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small((k + k.transpose()) / 2,
                                                                          (m + m.transpose()) / 2);
    vectors = vectors * small.eigenvectors();
    return small.eigenvalues();
  };
  Modes modes;
  Eigen::MatrixXd sway = factor.solve(M * X.leftCols(3));
  const Eigen::VectorXd sway_values = ritz(sway);
  for (int i = 0; i < 2; ++i) {
    Vec3 mean = Vec3::Zero();
    for (Eigen::Index node = 0; node < kElements; ++node) mean += sway.col(i).segment<3>(6 * node);
    modes.sway.frequencies[i] = frequency(sway_values[i]);
    modes.sway.directions[i] = mean.normalized();
  }

  count = std::min(count, 4);
  Eigen::VectorXd values;
  for (modes.iterations = 1; modes.iterations <= 60; ++modes.iterations) {
    X = factor.solve(M * X);
    values = ritz(X);
    modes.residual = 0;
    for (int i = 0; i < count; ++i) {
      const Eigen::VectorXd kx = K * X.col(i);
      modes.residual = std::max(modes.residual, (kx - values[i] * (M * X.col(i))).norm() / kx.norm());
    }
    if (modes.residual < 1e-6) break;
  }
  modes.dof = static_cast<uint32_t>(n);
  modes.converged = std::isfinite(values[0]) && values[0] > 0 && modes.residual < 1e-3;
  const double mass_unit = material_.density * std::pow(unit_, 3);
  for (int i = 0; i < count; ++i) {
    modes.frequencies.push_back(frequency(values[i]));
    Eigen::VectorXd shape = Eigen::VectorXd::Zero(3 * (kElements + 1));  // displacements of the sections
    Vec3 largest = Vec3::Zero();
    for (Eigen::Index node = 0; node < kElements; ++node) {
      const Vec3 u = X.col(i).segment<3>(6 * node);
      shape.segment<3>(3 * (node + 1)) = u / std::sqrt(mass_unit);
      if (u.squaredNorm() > largest.squaredNorm()) largest = u;
    }
    modes.shapes.push_back(shape);
    modes.tip_direction.push_back(largest.normalized());
  }
  return modes;
}

}  // namespace

Modes beam_modes(std::span<const Section> line, double volume, const ElasticMaterial& material,
                 std::span<const CarriedMass> carried, int modes) {
  require(line.size() >= 2, "a beam has two ends");
  Beam beam(line, volume, material);
  for (const CarriedMass& mass : carried) beam.carry(mass);
  return beam.solve(modes);
}

std::vector<Section> carried_to_ends(std::span<const Section> line) {
  std::vector<Section> result(line.begin(), line.end());
  const auto carry_on = [](Section& end, const Section& inner) {
    // Half a step from the inner one to where it was cut, half a step on to the end.
    const auto on = [](double at, double before) { return std::max(2 * at - before, 0.2 * at); };
    const double area = area_of(end) / (end.half_width * end.half_thickness);
    end.half_width = on(end.half_width, inner.half_width);
    end.half_thickness = on(end.half_thickness, inner.half_thickness);
    end.area = area * end.half_width * end.half_thickness;
  };
  if (line.size() < 4) return result;
  carry_on(result.front(), line[1]);
  carry_on(result.back(), line[line.size() - 2]);
  return result;
}

}  // namespace liana
