#include "modal/solve/lanczos.h"

#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <numeric>

#include "mesher/base/error.h"
#include "modal/solve/rayleigh_ritz.h"

namespace liana {
namespace {

using Eigen::Index;

/// M as Spectra asks for it.
class Mass {
 public:
  using Scalar = double;

  explicit Mass(const FreeProblem& problem) : problem_(problem), x_(problem.rows(), 1) {}
  Index rows() const { return problem_.rows(); }
  Index cols() const { return problem_.rows(); }
  void perform_op(const double* x, double* y) const {
    x_.col(0) = Eigen::Map<const Eigen::VectorXd>(x, rows());
    problem_.multiply_mass(x_, y_);
    Eigen::Map<Eigen::VectorXd>(y, rows()) = y_.col(0);
  }

 private:
  const FreeProblem& problem_;
  mutable NodalVectors x_, y_;
};

/// Eigenvectors found, M-orthonormal, lowest first.
struct Found {
  Eigen::MatrixXd vectors, mass_times;  // M times the vectors
  Eigen::VectorXd values;
};

/// (K + σ M)⁻¹ as Spectra asks for it, on what is M-orthogonal to the eigenvectors found.
class Inverse {
 public:
  using Scalar = double;

  Inverse(FreeProblem& problem, const Found& found) : problem_(problem), found_(found), b_(rows(), 1) {}
  Index rows() const { return problem_.rows(); }
  Index cols() const { return problem_.rows(); }
  void set_shift(double) {}  // factored at it already
  void perform_op(const double* b, double* x) const {
    b_.col(0) = Eigen::Map<const Eigen::VectorXd>(b, rows());
    problem_.solve(b_, x_);
    Eigen::Map<Eigen::VectorXd> out(x, rows());
    out = x_.col(0);
    out -= found_.vectors * (found_.mass_times.transpose() * out);
  }

 private:
  FreeProblem& problem_;
  const Found& found_;
  mutable NodalVectors b_, x_;
};

class Lanczos {
 public:
  Lanczos(FreeProblem& problem, const EigenOptions& options)
      : problem_(problem), options_(options), modes_(std::min<Index>(options.modes, problem.size() / 2)) {
    found_.vectors.resize(problem.rows(), 0), found_.mass_times.resize(problem.rows(), 0);
  }

  EigenResult run() {
    EigenResult result;
    result.iterations = search(modes_);
    // A few at a time: what a first search misses are copies of what it found.
    for (Index before = 0; before != found_.values.size() && something_is_missed();) {
      before = found_.values.size();
      result.iterations += search(std::max<Index>(2, modes_ / 8));
    }
    polish(result);
    sway(result);
    return result;
  }

 private:
  using Solver = Spectra::SymGEigsShiftSolver<Inverse, Mass, Spectra::GEigsMode::ShiftInvert>;

  /// Calls body with the solver after it has looked for the lowest `count` of those not found yet. Every step
  /// reads the whole factor: a basis not much larger than what is asked for costs fewer than no restarts.
  template <class Body>
  void solve(Index count, double tolerance, const Body& body) {
    const Index left = problem_.size() - found_.values.size();
    count = std::min(count, left - 1);
    if (count < 1) return;
    Mass mass(problem_);
    Inverse inverse(problem_, found_);
    Solver solver(inverse, mass, count, std::min(left, count + kSpare), 0);
    const NodalVectors noise = problem_.noise(1, static_cast<uint32_t>(found_.values.size()));
    Eigen::VectorXd start(noise.rows());
    inverse.perform_op(noise.data(), start.data());
    solver.init(start.data());
    solver.compute(Spectra::SortRule::LargestMagn, options_.max_iterations, tolerance,
                   Spectra::SortRule::SmallestAlge);
    body(solver);
  }

  /// What a value must be below to belong to the modes asked for.
  double highest() const {
    return found_.values.size() < modes_ ? std::numeric_limits<double>::infinity()
                                         : found_.values[modes_ - 1] * (1 - kSameValue);
  }

  /// Adds the lowest `count` of those not found yet, as far as they belong to the modes asked for. Returns
  /// the number of restarts.
  int search(Index count) {
    int restarts = 0;
    solve(count, options_.tolerance * kSearchMargin, [&](const Solver& solver) {
      const Eigen::VectorXd values = solver.eigenvalues();
      const double limit = highest();
      Index below = 0;
      while (below < values.size() && values[below] < limit) ++below;
      add(values.head(below), solver.eigenvectors(below));
      restarts = static_cast<int>(solver.num_iterations());
    });
    return restarts;
  }

  /// Whether an eigenvalue not found yet lies below the highest mode asked for. Its Ritz value does not lie
  /// below it, and is by the square of the tolerance too high.
  bool something_is_missed() {
    bool missed = false;
    solve(1, kProbeTolerance, [&](const Solver& solver) {
      const Eigen::VectorXd values = solver.eigenvalues();
      missed = values.size() > 0 && values[0] < highest();
    });
    return missed;
  }

  void add(const Eigen::VectorXd& values, const Eigen::MatrixXd& vectors) {
    const Index old = found_.values.size(), count = old + values.size();
    Eigen::VectorXd all_values(count);
    all_values << found_.values, values;
    Eigen::MatrixXd all(problem_.rows(), count);
    all << found_.vectors, vectors;
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return all_values[a] < all_values[b]; });
    found_.values.resize(count), found_.vectors.resize(all.rows(), count),
        found_.mass_times.resize(all.rows(), count);
    NodalVectors product;
    for (Index i = 0; i < count; ++i) {
      found_.values[i] = all_values[order[i]], found_.vectors.col(i) = all.col(order[i]);
      problem_.multiply_mass(found_.vectors.col(i), product);
      found_.mass_times.col(i) = product.col(0);
    }
  }

  /// One step of inverse iteration with Rayleigh-Ritz on all that was found: it measures the residual, and
  /// gives the values an error that is its square.
  void polish(EigenResult& result) {
    NodalVectors X = found_.vectors, X_mass = found_.mass_times, Y, Y_mass;
    problem_.solve(X_mass, Y);
    problem_.multiply_mass(Y, Y_mass);
    const Index modes = std::min(modes_, found_.values.size());
    result.residual = largest_change(X, X_mass, Y, Y_mass, found_.values, modes);
    result.converged = modes == modes_ && result.residual < options_.tolerance;
    const RitzPairs ritz = rayleigh_ritz(X_mass, Y, Y_mass);
    result.eigenvalues = ritz.values.head(modes);
    result.vectors = Y * ritz.rotation.leftCols(modes);
  }

  void sway(EigenResult& result) {
    NodalVectors X = problem_.translations(), X_mass, Y, Y_mass;
    if (!(X.colwise().squaredNorm().array() > 0).all()) return;  // an axis is held everywhere
    problem_.multiply_mass(X, X_mass);
    problem_.solve(X_mass, Y);
    problem_.multiply_mass(Y, Y_mass);
    find_sways(X_mass, Y, Y_mass, result);
  }

  static constexpr Index kSpare = 12;              // dimensions of the basis beyond the modes looked for
  static constexpr double kSearchMargin = 1 / 3.;  // of the tolerance: the last step measures what is left
  static constexpr double kProbeTolerance = 1e-3;
  static constexpr double kSameValue = 1e-8;  // relative

  FreeProblem& problem_;
  const EigenOptions& options_;
  Index modes_;
  Found found_;
};

}  // namespace

EigenResult lanczos(FreeProblem& problem, const EigenOptions& options) {
  require(options.modes >= 1, "ask for at least one mode");
  return Lanczos(problem, options).run();
}

}  // namespace liana
