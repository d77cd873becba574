#include "modal/solve/cholesky.h"

#include <suitesparse/cholmod.h>

#include "mesher/base/error.h"

// Of OpenBLAS, when that is the BLAS in use: workers are threads already, a second layer only costs.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
// Of GNU's OpenMP: what `#pragma omp teams thread_limit(n)` compiles to.
extern "C" void GOMP_teams_reg(void (*)(void*), void*, unsigned teams, unsigned thread_limit, unsigned flags)
    __attribute__((weak));

namespace liana {
namespace {

/// Dense blocks pay from about this size on (OpenBLAS, one thread).
constexpr int kSupernodalFrom = 600;

struct Workspace {
  cholmod_common common;

  Workspace() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
    common.final_ll = 1;
    // Supernodes of T10 nodes are small: merging more of them than CHOLMOD would by itself pays.
    common.nrelax[0] = 12, common.nrelax[1] = 24, common.nrelax[2] = 48;
    common.zrelax[0] = 0.8, common.zrelax[1] = 0.3, common.zrelax[2] = 0.1;
    if (openblas_set_num_threads) openblas_set_num_threads(1);
  }
  ~Workspace() { cholmod_finish(&common); }
};

cholmod_common* workspace() {
  thread_local Workspace w;
  return &w.common;
}

/// Calls `body`, in which OpenMP may not start threads: CHOLMOD asks for four at every supernode, and waking
/// them costs more than a small supernode does.
template <class Body>
void on_this_thread(Body&& body) {
  if (!GOMP_teams_reg) return body();
  GOMP_teams_reg([](void* data) { (*static_cast<std::remove_reference_t<Body>*>(data))(); }, &body, 1, 1, 0);
}

/// A square pattern. stype: 1 for the upper triangle, -1 for the lower.
cholmod_sparse view(const std::vector<int>& start, const std::vector<int>& row, int stype) {
  cholmod_sparse a{};
  a.nrow = a.ncol = start.size() - 1;
  a.nzmax = row.size();
  a.p = const_cast<int*>(start.data());
  a.i = const_cast<int*>(row.data());
  a.stype = stype;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_PATTERN;
  a.dtype = CHOLMOD_DOUBLE;
  a.packed = 1;
  return a;
}

/// Each node as three dof; entries below the diagonal are left in, CHOLMOD skips them.
Pattern three_by_three(const Pattern& nodes) {
  Pattern dof;
  dof.start.reserve(3 * nodes.size() + 1), dof.row.resize(9 * nodes.row.size());
  dof.start.push_back(0);
  int* row = dof.row.data();
  for (int q = 0; q < nodes.size(); ++q)
    for (int k = 0; k < 3; ++k) {
      for (int e = nodes.start[q]; e < nodes.start[q + 1]; ++e, row += 3)
        row[0] = 3 * nodes.row[e], row[1] = row[0] + 1, row[2] = row[0] + 2;
      dof.start.push_back(static_cast<int>(row - dof.row.data()));
    }
  return dof;
}

/// What cholmod_analyze() finds, from the graph of nodes: a ninth of the entries. Node p's parent in the
/// elimination tree and its column's length c become 3p → 3p + 1 → 3p + 2 → 3 parent, of 3c, 3c − 1 and 3c
/// − 2.
cholmod_factor* analyze_nodes(const FreeMatrix& matrix) {
  cholmod_common* common = workspace();
  cholmod_sparse upper = view(matrix.upper_nodes.start, matrix.upper_nodes.row, 1);
  cholmod_sparse lower = view(matrix.lower_nodes.start, matrix.lower_nodes.row, -1);
  const int n = matrix.upper_nodes.size();
  std::vector<int> parent(n), post(n), count(n), first(n), level(n);
  const bool found = cholmod_etree(&upper, parent.data(), common) &&
                     cholmod_postorder(parent.data(), n, nullptr, post.data(), common) == n &&
                     cholmod_rowcolcounts(&lower, nullptr, 0, parent.data(), post.data(), nullptr,
                                          count.data(), first.data(), level.data(), common);
  require(found, "CHOLMOD cannot analyse the graph of nodes");
  cholmod_factor* factor = cholmod_allocate_factor(3 * n, common);
  require(factor, "CHOLMOD ran out of memory");
  std::vector<int> scalar_parent(3 * n);
  for (int p = 0; p < n; ++p)
    for (int k = 0; k < 3; ++k) {
      static_cast<int*>(factor->ColCount)[3 * p + k] = 3 * count[p] - k;
      scalar_parent[3 * p + k] = k < 2 ? 3 * p + k + 1 : parent[p] < 0 ? -1 : 3 * parent[p];
    }
  if (common->supernodal == CHOLMOD_SUPERNODAL) {
    const Pattern upper_dof = three_by_three(matrix.upper_nodes);
    cholmod_sparse scalar = view(upper_dof.start, upper_dof.row, 1);
    require(cholmod_super_symbolic(&scalar, nullptr, scalar_parent.data(), factor, common),
            "CHOLMOD cannot find supernodes");
  }
  return factor;
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
  cholmod_sparse a = view(matrix.start, matrix.row, -1);
  a.x = const_cast<double*>(matrix.value.data());
  a.xtype = CHOLMOD_REAL;
  common->supernodal = matrix.size() < kSupernodalFrom ? CHOLMOD_SIMPLICIAL : CHOLMOD_SUPERNODAL;
  state_->factor = matrix.whole_nodes ? analyze_nodes(matrix) : cholmod_analyze(&a, common);
  require(state_->factor, "CHOLMOD ran out of memory");
  on_this_thread([&] { cholmod_factorize(&a, state_->factor, common); });
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
  int solved = 0;
  on_this_thread([&] {
    solved = cholmod_solve2(CHOLMOD_A, state_->factor, &rhs, nullptr, &state_->solution, nullptr,
                            &state_->work_y, &state_->work_e, workspace());
  });
  require(solved, "CHOLMOD cannot solve");
  b = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(state_->solution->x), b.rows(), b.cols());
}

}  // namespace liana
