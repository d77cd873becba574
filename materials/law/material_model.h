// The material models of [Wang17] side by side: how the frequency of a domain follows from its shape and
// place.
//
// ν frequency (Hz); ν_default that of the domain with the default material, its mass scaled as Eq. 9 says; ℓ
// length (m); s, μ global stiffness and discount per level of the depth model; ν_med, ℓ_med frequency and
// length of the median domain of a group. Eq. 10 then makes ν true whatever the model.
#pragma once

#include <string>
#include <vector>

#include "materials/law/species_law.h"

namespace liana {

constexpr MaterialModel kMaterialModels[] = {MaterialModel::PowerLaw, MaterialModel::Constant,
                                             MaterialModel::Depth, MaterialModel::Median};

const char* model_name(MaterialModel model);  ///< "power", "constant", "depth" or "median"
/// What is wrong with a name, with the nearest that is known; empty when nothing is.
std::string model_name_problem(const std::string& name);
MaterialModel model_named(const std::string& name);  ///< of a name without problem

/// What the models look at of one domain.
struct ModelledDomain {
  std::string group;  ///< as SpeciesLaw::group_of gives it
  DomainKind kind = DomainKind::Branch;
  int level = 0;
  double length = 0;             ///< ℓ, m
  double default_frequency = 0;  ///< ν_default, Hz
};

struct ModelFrequencies {
  std::vector<double> frequencies;  ///< ν of every domain, Hz
  std::vector<std::string> notes;   ///< what the species left open, and what was taken
};

/// ν of all domains of a plant by one model. The main trunk is the longest branch of the lowest level.
ModelFrequencies model_frequencies(const SpeciesLaw& law, const std::vector<ModelledDomain>& domains);

}  // namespace liana
