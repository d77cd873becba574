#include "materials/law/material_model.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "materials/law/power_law.h"
#include "mesher/base/error.h"
#include "mesher/base/fixed_math.h"
#include "mesher/base/nearest_word.h"

namespace liana {
namespace {

using Domains = std::vector<ModelledDomain>;

const ModelledDomain& main_trunk(const Domains& domains) {
  const auto lesser = [](const ModelledDomain& a, const ModelledDomain& b) {
    const bool leaf_a = a.kind == DomainKind::Leaf, leaf_b = b.kind == DomainKind::Leaf;
    if (leaf_a != leaf_b) return leaf_a;
    return a.level != b.level ? a.level > b.level : a.length < b.length;
  };
  return *std::max_element(domains.begin(), domains.end(), lesser);
}

ModelFrequencies power_law(const SpeciesLaw& law, const Domains& domains) {
  ModelFrequencies result;
  for (const ModelledDomain& domain : domains)
    result.frequencies.push_back(frequency_of_length(law.group(domain.group), domain.length));
  return result;
}

/// [Wang17] §4.4: ν = ν_default √(s μ^level). The constant model is μ = 1.
ModelFrequencies scaled(const Domains& domains, double s, double mu) {
  ModelFrequencies result;
  for (const ModelledDomain& domain : domains)
    result.frequencies.push_back(domain.default_frequency * std::sqrt(s * fixed::pow(mu, domain.level)));
  return result;
}

ModelFrequencies constant(const SpeciesLaw& law, const Domains& domains) {
  const ModelledDomain& trunk = main_trunk(domains);
  const bool given = law.model.trunk_frequency > 0;
  const double wanted =
      given ? law.model.trunk_frequency : frequency_of_length(law.group(trunk.group), trunk.length);
  const double s = fixed::pow(wanted / trunk.default_frequency, 2);
  ModelFrequencies result = scaled(domains, s, 1);
  result.notes.push_back(
      fmt::format("constant model: Young's modulus scaled by {:.4g}, so that the main trunk has {:.4g} Hz{}",
                  s, wanted, given ? "" : ", as by the power law"));
  return result;
}

ModelFrequencies depth(const SpeciesLaw& law, const Domains& domains) {
  const ModelledDomain& trunk = main_trunk(domains);
  double s = law.model.depth_scale;
  const double mu = law.model.depth_discount;
  const bool given = s > 0;
  if (!given) {
    const double wanted = frequency_of_length(law.group(trunk.group), trunk.length);
    s = fixed::pow(wanted / trunk.default_frequency, 2) / fixed::pow(mu, trunk.level);
  }
  ModelFrequencies result = scaled(domains, s, mu);
  result.notes.push_back(fmt::format("depth model: s = {:.4g}{}, mu = {:.4g}", s,
                                     given ? "" : " (the main trunk has its frequency by the power law)",
                                     mu));
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// The power law with C₁ = ν_med ℓ_med and ε₁ = -1.
ModelFrequencies medians(const SpeciesLaw& law, const Domains& domains) {
  std::map<std::string, std::vector<double>> lengths;
  for (const ModelledDomain& domain : domains) lengths[domain.group].push_back(domain.length);
  ModelFrequencies result;
  std::map<std::string, double> c1;
  for (const auto& [name, in_group] : lengths) {
    const GroupLaw& group = law.group(name);
    const double length = median(in_group);
    const bool given = group.median_frequency > 0;
    const double frequency = given ? group.median_frequency : frequency_of_length(group, length);
    c1[name] = frequency * length;
    result.notes.push_back(fmt::format("median model: {} has {:.4g} Hz at its median length of {:.4g} m{}",
                                       name, frequency, length, given ? "" : ", as by the power law"));
  }
  for (const ModelledDomain& domain : domains) result.frequencies.push_back(c1[domain.group] / domain.length);
  return result;
}

}  // namespace

const char* model_name(MaterialModel model) {
  constexpr const char* kNames[] = {"power", "constant", "depth", "median"};
  return kNames[static_cast<size_t>(model)];
}

std::string model_name_problem(const std::string& name) {
  std::vector<std::string> known;
  for (const MaterialModel model : kMaterialModels) known.push_back(model_name(model));
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  return fmt::format("is '{}'; there are {}, {}, {} and {}: did you mean '{}'?", name, known[0], known[1],
                     known[2], known[3], nearest_word(name, known));
}

MaterialModel model_named(const std::string& name) {
  for (const MaterialModel model : kMaterialModels)
    if (name == model_name(model)) return model;
  throw Error(Error::Kind::Input, "the material model " + model_name_problem(name));
}

ModelFrequencies model_frequencies(const SpeciesLaw& law, const Domains& domains) {
  if (domains.empty()) return {};
  switch (law.model.model) {
    case MaterialModel::PowerLaw:
      return power_law(law, domains);
    case MaterialModel::Constant:
      return constant(law, domains);
    case MaterialModel::Depth:
      return depth(law, domains);
    case MaterialModel::Median:
      break;
  }
  return medians(law, domains);
}

}  // namespace liana
