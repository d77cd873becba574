#include "modal/solve/inverse_iteration.h"

#include <algorithm>

#include "mesher/base/error.h"
#include "modal/solve/rayleigh_ritz.h"

namespace liana {
namespace {

/// Sway values this many times the lowest bring nothing to the lowest modes: their vectors start again at
/// random. Between a round rod's pair (1) and its second bending mode (39).
constexpr double kFarAbove = 4;

/// A step never counts for more than this: what it removes first are the components far above, and those that
/// remain shrink less.
constexpr double kBestContraction = 0.03;

class InverseIteration {
 public:
  InverseIteration(FreeProblem& problem, const EigenOptions& options)
      : options_(options), problem_(problem) {}

  EigenResult run() {
    EigenResult result;
    const int modes = options_.modes;
    start_vectors();
    double last_change = std::numeric_limits<double>::infinity();
    for (result.iterations = 1; result.iterations <= options_.max_iterations; ++result.iterations) {
      problem_.solve(X_mass_, Y_);
      problem_.multiply_mass(Y_, Y_mass_);
      const bool first = result.iterations == 1;
      if (first && can_sway_) find_sways(X_mass_, Y_, Y_mass_, result);
      if (!first) {
        const double change = largest_change(X_, X_mass_, Y_, Y_mass_, eigenvalues_, modes);
        result.residual = change * std::clamp(change / last_change, kBestContraction, 1.0);
        last_change = change;
      }
      const RitzPairs ritz = rayleigh_ritz(X_mass_, Y_, Y_mass_);
      eigenvalues_ = ritz.values;
      X_.noalias() = Y_.lazyProduct(ritz.rotation);
      X_mass_.noalias() = Y_mass_.lazyProduct(ritz.rotation);
      if (!first && result.residual < options_.tolerance) {
        result.converged = true;
        break;
      }
      if (first && can_sway_) refresh_far_vectors(result);
    }
    result.eigenvalues = eigenvalues_.head(modes);
    result.vectors = X_.leftCols(modes);
    return result;
  }

 private:
  void start_vectors() {
    X_ = problem_.translations();
    can_sway_ = (X_.colwise().squaredNorm().array() > 0).all();
    if (!can_sway_) {  // an axis that is held everywhere starts at random
      const NodalVectors random = problem_.noise(3, 0);
      for (int c = 0; c < 3; ++c)
        if (!(X_.col(c).squaredNorm() > 0)) X_.col(c) = random.col(c);
    }
    problem_.multiply_mass(X_, X_mass_);
  }

  /// After the first step: a round rod goes on with its pair of bending vectors; otherwise the stiff sways
  /// give way to random vectors. A little noise in the others, so that no symmetry hides a mode from them.
  void refresh_far_vectors(const EigenResult& result) {
    int near = 1;
    const Vec3 sways = result.sway_eigenvalues.array() - options_.shift;
    while (near < 3 && sways[near] < kFarAbove * sways[0]) ++near;
    if (near >= 2) X_ = X_.leftCols(near).eval();
    const NodalVectors random = problem_.noise(X_.cols(), 1000);
    for (int c = 0; c < X_.cols(); ++c) {
      if (c >= near)
        X_.col(c) = random.col(c);
      else
        X_.col(c) += 1e-3 * X_.col(c).lpNorm<Eigen::Infinity>() * random.col(c);
    }
    problem_.multiply_mass(X_, X_mass_);
  }

  const EigenOptions& options_;
  FreeProblem& problem_;
  NodalVectors X_, X_mass_, Y_, Y_mass_;
  Eigen::VectorXd eigenvalues_;
  bool can_sway_ = false;  // no axis is held everywhere
};

}  // namespace

EigenResult inverse_iteration(FreeProblem& problem, const EigenOptions& options) {
  require(options.modes >= 1 && options.modes <= kFewModes, "inverse iteration is for one or two modes");
  return InverseIteration(problem, options).run();
}

}  // namespace liana
