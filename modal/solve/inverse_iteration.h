// One or two modes of a single domain: inverse iteration of three vectors at once with Rayleigh-Ritz.
#pragma once

#include "modal/solve/eigenpairs.h"
#include "modal/solve/free_problem.h"

namespace liana {

constexpr int kFewModes = 2;

/// [Bathe 1973]. Starts from the deflections under uniform acceleration, which are the bending modes of most
/// branches: 3-5 steps. A third vector speeds up the second. The eigenvalues are those of K + σ M.
EigenResult inverse_iteration(FreeProblem& problem, const EigenOptions& options);

}  // namespace liana
