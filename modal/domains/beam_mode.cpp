#include "modal/domains/beam_mode.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "modal/domains/beam_matrices.h"
#include "modal/solve/rayleigh_ritz.h"

namespace liana {
namespace {

using Dense = Eigen::MatrixXd;

constexpr int kElements = 32;
constexpr int kMostModes = 4;  // of the six vectors that are iterated

/// Inverse iteration of six vectors on the nodes that are not held.
class BeamIteration {
 public:
  BeamIteration(const std::vector<Section>& sections, const BeamMatrices& beam)
      : K_(beam.stiffness.bottomRightCorner(6 * kElements, 6 * kElements)),
        M_(beam.mass.bottomRightCorner(6 * kElements, 6 * kElements)),
        factor_(K_) {
    if (factor_.info() != Eigen::Success)
      throw Error(Error::Kind::Input, "the beam through its sections has no stiffness", "give it thickness");
    // Uniform acceleration along each axis, and angular acceleration about it.
    X_ = Dense::Zero(6 * kElements, 6);
    for (Eigen::Index node = 0; node < kElements; ++node) {
      X_.block<3, 3>(6 * node, 0) = Mat3::Identity();
      X_.block<3, 3>(6 * node, 3) =
          -cross_matrix((sections[node + 1].centre - sections[0].centre) / beam.unit);
      X_.block<3, 3>(6 * node + 3, 3) = Mat3::Identity();
    }
  }

  /// Rayleigh-Ritz on the static deflections under uniform acceleration: values, and vectors as columns.
  std::pair<Eigen::VectorXd, Dense> sways() const {
    Dense deflections = factor_.solve(M_ * X_.leftCols(3));
    const Eigen::VectorXd values = ritz(deflections);
    return {values, deflections};
  }

  /// Fills in iterations and residual; the eigenpairs are values() and vectors().
  void iterate(int count, Modes& modes) {
    for (modes.iterations = 1; modes.iterations <= 60; ++modes.iterations) {
      X_ = factor_.solve(M_ * X_);
      values_ = ritz(X_);
      modes.residual = 0;
      for (int i = 0; i < count; ++i) {
        const Eigen::VectorXd kx = K_ * X_.col(i);
        modes.residual = std::max(modes.residual, (kx - values_[i] * (M_ * X_.col(i))).norm() / kx.norm());
      }
      if (modes.residual < 1e-6) break;
    }
    modes.dof = static_cast<uint32_t>(K_.rows());
    modes.converged = std::isfinite(values_[0]) && values_[0] > 0 && modes.residual < 1e-3;
  }

  const Eigen::VectorXd& values() const { return values_; }
  const Dense& vectors() const { return X_; }

 private:
  Eigen::VectorXd ritz(Dense& vectors) const {
    const Dense k = vectors.transpose() * K_ * vectors, m = vectors.transpose() * M_ * vectors;
    const RitzPairs pairs = small_eigenpairs((k + k.transpose()) / 2, (m + m.transpose()) / 2);
    vectors = vectors * pairs.rotation;
    return pairs.values;
  }

  Dense K_, M_;
  Eigen::LLT<Dense> factor_;
  Dense X_;
  Eigen::VectorXd values_;
};

Vec3 mean_displacement(const Eigen::VectorXd& vector) {
  Vec3 mean = Vec3::Zero();
  for (Eigen::Index node = 0; node < kElements; ++node) mean += vector.segment<3>(6 * node);
  return mean.normalized();
}

/// Appends displacements of all sections, the held one first, and the direction of the largest.
void add_shape(const Eigen::VectorXd& vector, double mass_unit, Modes& modes) {
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(3 * (kElements + 1));
  Vec3 largest = Vec3::Zero();
  for (Eigen::Index node = 0; node < kElements; ++node) {
    const Vec3 u = vector.segment<3>(6 * node);
    shape.segment<3>(3 * (node + 1)) = u / std::sqrt(mass_unit);
    if (u.squaredNorm() > largest.squaredNorm()) largest = u;
  }
  modes.shapes.push_back(shape);
  modes.tip_direction.push_back(largest.normalized());
}

}  // namespace

Modes beam_modes(std::span<const Section> line, double volume, const ElasticMaterial& material,
                 std::span<const CarriedMass> carried, int count) {
  require(line.size() >= 2, "a beam has two ends");
  const std::vector<Section> sections = resample(line, volume, kElements);
  const BeamMatrices beam = beam_matrices(sections, material, carried);
  BeamIteration iteration(sections, beam);
  const double time = beam.unit * std::sqrt(material.density / material.youngs_modulus);
  const auto frequency = [&](double lambda) { return std::sqrt(std::max(0.0, lambda)) / (2 * kPi * time); };

  Modes modes;
  const auto [sway_values, sways] = iteration.sways();
  for (int i = 0; i < 2; ++i) {
    modes.sway.frequencies[i] = frequency(sway_values[i]);
    modes.sway.directions[i] = mean_displacement(sways.col(i));
  }
  count = std::min(count, kMostModes);
  iteration.iterate(count, modes);
  for (int i = 0; i < count; ++i) {
    modes.frequencies.push_back(frequency(iteration.values()[i]));
    add_shape(iteration.vectors().col(i), material.density * std::pow(beam.unit, 3), modes);
  }
  return modes;
}

}  // namespace liana
