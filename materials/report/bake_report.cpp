#include "materials/report/bake_report.h"

#include <nlohmann/json.hpp>

#include "mesher/base/hash.h"

namespace liana {
namespace {

using Json = nlohmann::ordered_json;

Json domain_json(const BakedDomain& domain, size_t id) {
  const DomainMaterial& material = domain.material;
  return {{"id", id},
          {"name", domain.name},
          {"parent", domain.parent.valid() ? Json(domain.parent.value) : Json(nullptr)},
          {"kind", domain.kind == DomainKind::Leaf ? "leaf" : "branch"},
          {"level", domain.level},
          {"group", domain.group},
          {"length_m", domain.length},
          {"mass_kg", domain.mass},
          {"tets", domain.tets},
          {"dof", domain.dof},
          {"nu_default_hz", domain.default_frequency},
          {"nu_hz", material.frequency},
          {"alpha_k", domain.stiffness_scaling},
          {"alpha_m", material.mass_scaling},
          {"youngs_pa", domain.youngs_modulus},
          {"density", domain.density},
          {"xi", material.damping_factor},
          {"d_m", material.mass_damping},
          {"d_k", material.stiffness_damping},
          {"route", domain.route},
          {"solved_as", domain.solved_as.value}};
}

}  // namespace

std::string bake_report(const BakeResult& result) {
  const Bake& bake = result.bake;
  const StageSeconds& s = result.seconds;
  Json report{{"plant", bake.plant},
              {"species", bake.law.species},
              {"seconds",
               {{"read", s.read},
                {"surface", s.surface},
                {"tets", s.tets},
                {"modal", s.modal},
                {"laws", s.laws},
                {"cache", s.cache},
                {"write", s.write},
                {"total", s.total}}},
              {"domains", Json::array()},
              {"failed", bake.failed},
              {"notes", result.notes},
              {"plant_hash", hash_text(bake.plant_hash)},
              {"species_hash", hash_text(bake.species_hash)}};
  for (size_t id = 0; id < bake.domains.size(); ++id)
    report["domains"].push_back(domain_json(bake.domains[id], id));
  // Names come from foreign files: bytes that are no UTF-8 are replaced rather than refused.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace liana
