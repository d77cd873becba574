#include "runtime/app/bake/bake_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>

namespace liana {
namespace {

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void add(double value) { least = std::min(least, value), most = std::max(most, value); }
  std::string text() const {
    return least == most ? fmt::format("{:.3g}", least) : fmt::format("{:.3g}-{:.3g}", least, most);
  }
};

struct Row {
  size_t count = 0;
  Range length, frequency, factor, youngs_modulus;
  double mass = 0;
};

const char* kind_name(DomainKind kind) {
  return kind == DomainKind::Leaf ? "leaf" : "branch";
}

}  // namespace

std::string bake_table(const Bake& bake) {
  std::map<std::pair<DomainKind, std::string>, Row> rows;
  double mass = 0;
  for (const BakedDomain& domain : bake.domains) {
    Row& row = rows[{domain.kind, domain.group}];
    ++row.count;
    row.length.add(domain.length);
    row.frequency.add(domain.material.frequency);
    row.factor.add(domain.material.damping_factor);
    row.youngs_modulus.add(domain.youngs_modulus / 1e9);
    row.mass += domain.mass, mass += domain.mass;
  }
  constexpr const char* kLine = "{:<10} {:<7} {:>6}  {:>13}  {:>12}  {:>13}  {:>15}  {:>10}\n";
  std::string text =
      fmt::format(kLine, "group", "kind", "count", "length, m", "nu, Hz", "xi", "E, GPa", "mass, kg");
  for (const auto& [key, row] : rows)
    text += fmt::format(kLine, key.second, kind_name(key.first), row.count, row.length.text(),
                        row.frequency.text(), row.factor.text(), row.youngs_modulus.text(),
                        fmt::format("{:.3g}", row.mass));
  text += fmt::format(kLine, "all", "", bake.domains.size(), "", "", "", "", fmt::format("{:.3g}", mass));
  if (!bake.failed.empty()) text += fmt::format("left out: {}\n", bake.failed.size());
  for (const std::string& failure : bake.failed) text += "  " + failure + "\n";
  return text;
}

std::string domain_table(const Bake& bake) {
  constexpr const char* kLine =
      "{:>5}  {:<20} {:>6}  {:<7} {:<8} {:>9} {:>10} {:>9} {:>9} {:>8} {:>10}  {}\n";
  std::string text = fmt::format(kLine, "id", "name", "parent", "kind", "group", "length, m", "mass, kg",
                                 "nu0, Hz", "nu, Hz", "xi", "stiff/soft", "made solid by");
  const auto number = [](double value) { return fmt::format("{:.4g}", value); };
  for (size_t id = 0; id < bake.domains.size(); ++id) {
    const BakedDomain& domain = bake.domains[id];
    text +=
        fmt::format(kLine, id, domain.name, domain.parent.valid() ? std::to_string(domain.parent.value) : "-",
                    kind_name(domain.kind), domain.group, number(domain.length), number(domain.mass),
                    number(domain.default_frequency), number(domain.material.frequency),
                    number(domain.material.damping_factor), number(domain.stiffness_ratio), domain.route);
  }
  return text;
}

}  // namespace liana
