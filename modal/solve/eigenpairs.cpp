#include "modal/solve/eigenpairs.h"

#include "mesher/base/error.h"
#include "modal/solve/inverse_iteration.h"
#include "modal/solve/lanczos.h"

namespace liana {

EigenResult lowest_eigenpairs(const System& system, std::span<const uint8_t> held,
                              const EigenOptions& options) {
  require(held.size() == 3 * system.nodes(), "held must have one entry a dof");
  FreeProblem problem(system, held, options.shift);
  EigenResult result =
      options.modes <= kFewModes ? inverse_iteration(problem, options) : lanczos(problem, options);
  result.dof = static_cast<uint32_t>(problem.size());
  result.eigenvalues.array() -= options.shift;
  result.sway_eigenvalues.array() -= options.shift;
  result.vectors = problem.on_all_nodes(result.vectors, system.nodes());
  return result;
}

}  // namespace liana
