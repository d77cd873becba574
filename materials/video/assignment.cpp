#include "materials/video/assignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "materials/video/tracks/csv_line.h"
#include "mesher/base/error.h"
#include "mesher/base/nearest_word.h"

namespace liana {
namespace {

[[noreturn]] void fail(const PointAssignment& a, const std::string& what, const std::string& hint) {
  throw Error(Error::Kind::Usage, fmt::format("point '{}' = '{}': {}", a.point, printable(a.target), what),
              hint);
}

const std::string kForms = "give a domain of --plant, GROUP:LENGTH such as level1:0.82 (m), or still";

int level_of_group(const std::string& group) {
  constexpr int kLeaf = 1000, kNamed = 1;  // leaves come last; a named group is some branch's
  if (group == "leaf") return kLeaf;
  if (!group.starts_with("level")) return kNamed;
  int level = kNamed;
  std::from_chars(group.data() + 5, group.data() + group.size(), level);
  return std::clamp(level, 0, kLeaf);
}

PointTarget by_length(const PointAssignment& a, size_t colon, const SpeciesLaw& base) {
  constexpr double kShortest = 1e-4, kLongest = 1e3;  // m, as the laws' own range
  PointTarget target{a.point, "", a.target.substr(0, colon), 0, 0};
  const auto length = parse_number(trimmed(std::string_view(a.target).substr(colon + 1)));
  if (!length || !(*length >= kShortest && *length <= kLongest))
    fail(a, fmt::format("the length must be a number of metres between {} and {}", kShortest, kLongest),
         kForms);
  target.length = *length;
  target.level = level_of_group(target.group);
  base.group(target.group);  // throws for a group that the species does not know
  return target;
}

PointTarget by_domain(const PointAssignment& a, const Bake* plant) {
  if (!plant) fail(a, "names a domain, but no plant is given", kForms);
  std::vector<size_t> found;
  std::vector<std::string> names;
  for (size_t i = 0; i < plant->domains.size(); ++i) {
    const std::string& name = plant->domains[i].name;
    if (a.target == name || a.target == fmt::format("#{}", i)) found.push_back(i);
    names.push_back(name);
  }
  if (found.empty())
    fail(a, fmt::format("the plant has no such domain among its {}", names.size()),
         fmt::format("did you mean '{}'? liana inspect lists them; or {}", nearest_word(a.target, names),
                     kForms));
  if (found.size() > 1)
    fail(a, fmt::format("{} domains have this name", found.size()),
         fmt::format("say which by its number: {}=#{}", a.point, found.front()));
  const BakedDomain& domain = plant->domains[found.front()];
  return {a.point, domain.name, domain.group, domain.level, domain.length};
}

}  // namespace

PointAssignment parse_assignment(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw Error(Error::Kind::Usage, fmt::format("'{}' assigns no point", printable(text)),
                "write NAME=TARGET, for example P0=level1:0.82");
  return {std::string(trimmed(text.substr(0, equals))), std::string(trimmed(text.substr(equals + 1)))};
}

std::vector<PointAssignment> parse_assignments(std::string_view text, const std::string& file) {
  std::vector<PointAssignment> assignments;
  for_each_line(text, [&](std::string_view line, size_t number) {
    if (is_blank(line) || line.front() == '#') return;
    const std::vector<std::string> fields = split_csv_line(line);
    if (fields.size() != 2 || fields[0].empty() || fields[1].empty())
      throw Error(Error::Kind::Input, fmt::format("{}:{}: a line of this file is point,target", file, number),
                  "for example: P0,level1:0.82");
    if (assignments.empty() && fields[0] == "point" && fields[1] == "target") return;
    assignments.push_back({fields[0], fields[1]});
  });
  return assignments;
}

std::vector<PointTarget> resolve_targets(const PointTracks& tracks,
                                         const std::vector<PointAssignment>& assignments, const Bake* plant,
                                         const SpeciesLaw& base) {
  std::vector<PointTarget> targets;
  std::set<std::string> known;
  for (const PointAssignment& a : assignments) {
    tracks.point(a.point);  // throws for an unknown one
    if (!known.insert(a.point).second) fail(a, "the point is assigned twice", "assign every point once");
    if (a.target == kStillTarget) continue;
    const size_t colon = a.target.rfind(':');
    targets.push_back(colon == std::string::npos ? by_domain(a, plant) : by_length(a, colon, base));
  }
  return targets;
}

}  // namespace liana
