#include "materials/report/model_comparison.h"

#include <fmt/core.h>

#include "materials/law/power_law.h"

namespace liana {
namespace {

/// A text as one field: quotes doubled, and quotes around it.
std::string quoted(const std::string& text) {
  std::string field = "\"";
  for (const char letter : text) field += letter == '"' ? "\"\"" : std::string(1, letter);
  return field + "\"";
}

}  // namespace

ModelComparison compare_models(const Bake& bake) {
  std::vector<ModelledDomain> domains;
  for (const BakedDomain& d : bake.domains)
    domains.push_back({d.group, d.kind, d.level, d.length, d.default_frequency});
  ModelComparison comparison;
  for (size_t i = 0; i < comparison.models.size(); ++i) {
    SpeciesLaw law = bake.law;
    law.model.model = kMaterialModels[i];
    comparison.models[i] = model_frequencies(law, domains);
  }
  return comparison;
}

std::string comparison_csv(const Bake& bake, const ModelComparison& comparison) {
  std::string text = "id,name,kind,level,group,length_m,nu_default_hz";
  for (const MaterialModel model : kMaterialModels)
    text += fmt::format(",nu_{0}_hz,youngs_{0}_pa,xi_{0}", model_name(model));
  text += "\n";
  for (size_t id = 0; id < bake.domains.size(); ++id) {
    const BakedDomain& d = bake.domains[id];
    text += fmt::format("{},{},{},{},{},{:.6g},{:.6g}", id, quoted(d.name),
                        d.kind == DomainKind::Leaf ? "leaf" : "branch", d.level, quoted(d.group), d.length,
                        d.default_frequency);
    for (const ModelFrequencies& model : comparison.models) {
      const double nu = model.frequencies[id];
      const DomainMaterial material = evaluate_at(bake.law.group(d.group), d.length, nu);
      const double alpha_k = stiffness_scaling(material.mass_scaling, nu, d.default_frequency);
      text += fmt::format(",{:.6g},{:.6g},{:.6g}", nu, alpha_k * bake.law.default_material.youngs_modulus,
                          material.damping_factor);
    }
    text += "\n";
  }
  return text;
}

}  // namespace liana
