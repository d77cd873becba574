#include "modal/cholesky.h"

#include <suitesparse/cholmod.h>

#include "mesher/base/error.h"

// Of OpenBLAS, when that is the BLAS in use: workers are threads already, a second layer only costs.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace liana {
namespace {

/// Dense blocks pay from about this size on: half the time at 2,800 dof, the same at 900 (OpenBLAS, one
/// thread).
constexpr int kSupernodalFrom = 1200;

struct Workspace {
  cholmod_common common;

  Workspace() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
    common.final_ll = 1;
    if (openblas_set_num_threads) openblas_set_num_threads(1);
  }
  ~Workspace() { cholmod_finish(&common); }
};

cholmod_common* workspace() {
  thread_local Workspace w;
  return &w.common;
}

}  // namespace

struct Cholesky::State {
  cholmod_factor* factor = nullptr;
  mutable cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;
  bool positive_definite = false;

  ~State() {
    cholmod_free_factor(&factor, workspace());
    cholmod_free_dense(&solution, workspace());
    cholmod_free_dense(&work_y, workspace());
    cholmod_free_dense(&work_e, workspace());
  }
};

Cholesky::Cholesky(const FreeMatrix& matrix) : state_(std::make_unique<State>()) {
  cholmod_common* common = workspace();
  cholmod_sparse a{};
  a.nrow = a.ncol = matrix.dof.size();
  a.nzmax = matrix.row.size();
  a.p = const_cast<int*>(matrix.start.data());
  a.i = const_cast<int*>(matrix.row.data());
  a.x = const_cast<double*>(matrix.value.data());
  a.stype = 1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = a.packed = 1;
  common->supernodal = matrix.size() < kSupernodalFrom ? CHOLMOD_SIMPLICIAL : CHOLMOD_SUPERNODAL;
  state_->factor = cholmod_analyze(&a, common);
  require(state_->factor, "CHOLMOD ran out of memory");
  cholmod_factorize(&a, state_->factor, common);
  state_->positive_definite = common->status == CHOLMOD_OK && state_->factor->minor == state_->factor->n;
}

Cholesky::~Cholesky() = default;

bool Cholesky::positive_definite() const {
  return state_->positive_definite;
}

void Cholesky::solve(Eigen::MatrixXd& b) const {
  cholmod_dense rhs{};
  rhs.nrow = rhs.d = b.rows();
  rhs.ncol = b.cols();
  rhs.nzmax = b.size();
  rhs.x = b.data();
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  const int solved = cholmod_solve2(CHOLMOD_A, state_->factor, &rhs, nullptr, &state_->solution, nullptr,
                                    &state_->work_y, &state_->work_e, workspace());
  require(solved, "CHOLMOD cannot solve");
  b = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(state_->solution->x), b.rows(), b.cols());
}

}  // namespace liana
