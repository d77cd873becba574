// An isotropic linear elastic material.
#pragma once

namespace liana {

/// The material that the modal analysis is done with before scaling; apple wood ([Niklas 1992] in [Wang17]).
struct ElasticMaterial {
  double youngs_modulus = 8.77e9;  ///< Pa
  double density = 745;            ///< kg/m³
  double poisson_ratio = 0.3;
};

}  // namespace liana
