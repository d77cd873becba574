#include "materials/bake/bake_check.h"

#include <fmt/core.h>

#include <cmath>

#include "materials/law/law_numbers.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

bool positive(double value) {
  return value > 0 && std::isfinite(value);
}
bool not_negative(double value) {
  return value >= 0 && std::isfinite(value);
}

bool is_station(const Station& station) {
  return station.position.allFinite() && not_negative(station.half_width) &&
         not_negative(station.half_thickness);
}

/// What is wrong with one domain; empty when nothing is.
std::string problem(const Bake& bake, size_t index) {
  const BakedDomain& domain = bake.domains[index];
  if (domain.parent.valid() && domain.parent.index() >= index) return "comes before its parent";
  if (!domain.solved_as.valid() || domain.solved_as.index() >= bake.domains.size())
    return "shares modes with none";
  if (domain.kind != DomainKind::Branch && domain.kind != DomainKind::Leaf)
    return "is neither branch nor leaf";
  if (domain.level < 0) return "has a negative level";
  const DomainMaterial& material = domain.material;
  for (double value :
       {domain.length, domain.mass, domain.default_frequency, domain.stiffness_scaling, domain.youngs_modulus,
        domain.density, domain.stiffness_ratio, material.frequency, material.mass_scaling})
    if (!positive(value)) return fmt::format("holds {} where a positive number belongs", value);
  for (double value : {material.damping_factor, material.mass_damping, material.stiffness_damping})
    if (!not_negative(value)) return fmt::format("holds {} as its damping", value);
  if (domain.centreline.size() < 2) return "has no centreline";
  for (const Station& station : domain.centreline)
    if (!is_station(station)) return "has a centreline that is not finite or of negative width";
  if (!(std::abs(domain.flat_normal.norm() - 1) < 1e-6)) return "has no flat direction";
  return {};
}

}  // namespace

void check(const Bake& bake, const std::string& where) {
  check(bake.law, where);
  for (size_t i = 0; i < bake.domains.size(); ++i) {
    const std::string found = problem(bake, i);
    if (!found.empty())
      throw Error(Error::Kind::Input,
                  fmt::format("{}: domain {} '{}' {}", where, i, bake.domains[i].name, found),
                  "bake the plant again");
  }
}

}  // namespace liana
