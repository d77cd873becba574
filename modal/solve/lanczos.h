// Many modes at once, of a whole plant for instance: implicitly restarted Lanczos on (K + σ M)⁻¹ M.
#pragma once

#include "modal/solve/eigenpairs.h"
#include "modal/solve/free_problem.h"

namespace liana {

/// [Ericsson and Ruhe 1980] with Spectra's restarts. One starting vector meets only one vector of a multiple
/// eigenvalue, and a plant's equal leaves have many: searches in what is M-orthogonal to all that is found go
/// on until one finds nothing below the highest mode asked for. The eigenvalues are those of K + σ M.
EigenResult lanczos(FreeProblem& problem, const EigenOptions& options);

}  // namespace liana
