#include "materials/pipeline/left_out.h"

#include <fmt/core.h>

#include <algorithm>

#include "mesher/base/error.h"

namespace liana {

bool LeftOut::add(const std::vector<std::string>& reasons) {
  require(reasons.size() == reasons_.size(), "LeftOut: one reason a domain");
  bool more = false;
  for (size_t i = 0; i < reasons.size(); ++i)
    if (reasons_[i].empty() && !reasons[i].empty()) reasons_[i] = reasons[i], more = true;
  return more;
}

std::vector<DomainId> LeftOut::remaining() const {
  std::vector<DomainId> domains;
  for (size_t index = 0; index < reasons_.size(); ++index)
    if (reasons_[index].empty()) domains.push_back(DomainId(index));
  return domains;
}

DomainId LeftOut::parent_of(const SegmentedPlant& plant, DomainId domain) const {
  DomainId parent = plant.domains[domain.index()].parent;
  while (parent.valid() && has(parent)) parent = plant.domains[parent.index()].parent;
  return parent;
}

void LeftOut::refuse(const SegmentedPlant& plant, bool strict) const {
  const auto first =
      std::find_if(reasons_.begin(), reasons_.end(), [](const std::string& r) { return !r.empty(); });
  if (first == reasons_.end()) return;
  if (strict)
    throw Error(Error::Kind::Input, plant.name + ": " + *first,
                "mend this domain, or leave out --strict to bake the others");
  if (remaining().empty())
    throw Error(Error::Kind::Input,
                fmt::format("{}: none of its {} domains could be baked; the first: {}", plant.name,
                            reasons_.size(), *first),
                "look at it with: liana inspect FILE");
}

std::string LeftOut::describe(const SegmentedPlant& plant, DomainId domain) const {
  const auto children = std::count_if(plant.domains.begin(), plant.domains.end(),
                                      [&](const Domain& d) { return d.parent == domain; });
  if (children == 0) return reason(domain);
  const DomainId parent = parent_of(plant, domain);
  const std::string to = parent.valid() ? "'" + plant.domains[parent.index()].name + "'" : "the ground";
  return reason(domain) + fmt::format("; what grew on it ({}) now attaches to {}", children, to);
}

}  // namespace liana
