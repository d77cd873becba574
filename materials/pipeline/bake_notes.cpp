#include "materials/pipeline/bake_notes.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "materials/law/damping.h"

namespace liana {
namespace {

/// Empty if nothing was lost.
std::string describe_losses(const SegmentedPlant& plant, const std::vector<DomainSolid>& solids,
                            const LeftOut& left_out) {
  constexpr double kNothing = 1e-6;
  std::vector<std::pair<double, size_t>> losses;
  for (const DomainId id : left_out.remaining())
    if (const SolidDomain& solid = solids[id.index()].solid;
        std::max(solid.lost_area, solid.lost_volume) > kNothing)
      losses.push_back({solid.lost_area, id.index()});
  if (losses.empty()) return {};
  std::sort(losses.rbegin(), losses.rend());
  constexpr size_t kNamed = 5;
  std::string names;
  for (size_t i = 0; i < std::min(kNamed, losses.size()); ++i) {
    const auto& [area, index] = losses[i];
    names += fmt::format("{}'{}' {:.2g} % of its area and {:.2g} % of its volume", i ? ", " : "",
                         plant.domains[index].name, 100 * area, 100 * solids[index].solid.lost_volume);
  }
  return fmt::format("{} {} something when mended: {}{}", losses.size(),
                     losses.size() == 1 ? "domain lost" : "domains lost", names,
                     losses.size() > kNamed ? ", ..." : "");
}

void note_laws(const BakeJob& job, std::vector<std::string>& notes) {
  for (const std::string& group : std::set<std::string>(job.groups.begin(), job.groups.end())) {
    const DampingLaw& damping = job.species.group(group).damping;
    if (!job.species.groups.contains(group))
      notes.push_back(fmt::format("{} has no law of its own in '{}': it takes that of the level above it",
                                  group, job.species.species));
    if (!is_monotonic(damping))
      notes.push_back(
          fmt::format("{}: with delta {} and kappa {} damping first falls, then rises as it stiffens", group,
                      damping.delta, damping.kappa));
  }
}

}  // namespace

std::vector<std::string> bake_notes(const BakeJob& job, const std::vector<DomainSolid>& solids,
                                    const std::vector<DomainModes>& modes, const LeftOut& left_out) {
  std::vector<std::string> notes;
  if (const std::string lost = describe_losses(job.plant, solids, left_out); !lost.empty())
    notes.push_back(lost);
  const std::vector<DomainId> domains = left_out.remaining();
  const auto rough = std::count_if(domains.begin(), domains.end(), [&](DomainId id) {
    return (solids[id.index()].solid.route + modes[id.index()].note).find("rough-beam") != std::string::npos;
  });
  if (rough)
    notes.push_back(fmt::format(
        "{} wide or folded sheets could only be solved as rough beams (route): their default frequencies "
        "may be far off",
        rough));
  note_laws(job, notes);
  return notes;
}

}  // namespace liana
