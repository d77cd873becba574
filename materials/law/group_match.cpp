// Which group of a species a domain belongs to.
#include <fmt/core.h>
#include <fnmatch.h>

#include "materials/law/species_law.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

/// How well a group fits; -1 when it does not. Whatever is given must fit; a name outweighs a level, a level
/// a kind.
int fit(const GroupMatch& match, const std::string& name, DomainKind kind, int level) {
  if (match.empty()) return -1;
  const bool fits = (match.name.empty() || fnmatch(match.name.c_str(), name.c_str(), 0) == 0) &&
                    (!match.kind || *match.kind == kind) && (match.level < 0 || match.level == level);
  if (!fits) return -1;
  return 4 * !match.name.empty() + 2 * (match.level >= 0) + match.kind.has_value();
}

constexpr int kFitOfGivenName = 2;

}  // namespace

std::string SpeciesLaw::group_of(const std::string& name, DomainKind kind, int level,
                                 const std::string& given) const {
  std::string best, rival;
  int best_fit = 0;
  for (const auto& [key, law] : groups) {
    const int found = std::max(fit(law.match, name, kind, level), key == given ? kFitOfGivenName : -1);
    if (found > best_fit)
      best = key, best_fit = found, rival.clear();
    else if (found == best_fit)
      rival = key;
  }
  if (!rival.empty())
    throw Error(Error::Kind::Input,
                fmt::format("species '{}': the groups '{}' and '{}' claim domain '{}' with equal right",
                            species, best, rival, name),
                "narrow the match of one of them: a name goes before a level, a level before a kind");
  if (!best.empty()) return best;
  group(given);  // throws when there is none
  return given;
}

}  // namespace liana
