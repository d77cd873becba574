#include "materials/video/infer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "materials/law/species_writer.h"
#include "materials/video/assignment.h"
#include "materials/video/tracks/camera_motion.h"
#include "mesher/base/error.h"

namespace liana {
namespace {

std::vector<std::string> still_points(const std::vector<PointAssignment>& assignments) {
  std::vector<std::string> names;
  for (const PointAssignment& a : assignments)
    if (a.target == kStillTarget) names.push_back(a.point);
  return names;
}

double length_of_trunk(const Bake* plant, double given) {
  if (given > 0 || !plant) return given;
  double longest = 0;
  for (const BakedDomain& domain : plant->domains)
    if (domain.level == 0) longest = std::max(longest, domain.length);
  return longest;
}

std::string confidence_of(double relative_uncertainty) {
  return relative_uncertainty < 0.03 ? "high" : relative_uncertainty < 0.1 ? "medium" : "low";
}

}  // namespace

InferResult infer(const PointTracks& tracks, const SpeciesLaw& base, const Bake* plant,
                  const InferOptions& options) {
  InferResult result{tracks.source, tracks.frames_per_second, tracks.frames(), {}, {}, {}, {}, 0};
  const std::vector<PointTarget> targets = resolve_targets(tracks, options.assignments, plant, base);
  const PointTracks steady = without_camera_motion(tracks, still_points(options.assignments));

  std::vector<BranchMotion> branches;
  std::optional<Error> first_problem;
  for (const PointTrack& track : steady.points) {
    const auto target = std::find_if(targets.begin(), targets.end(),
                                     [&](const PointTarget& t) { return t.point == track.name; });
    try {
      PointModes motion = point_modes(steady, track, options.motion);
      if (target == targets.end())
        result.unassigned.push_back(std::move(motion));
      else
        branches.push_back({*target, std::move(motion), {}, {}});
    } catch (const Error& error) {
      result.notes.push_back(
          fmt::format("left out: {}{}{}", error.what(), error.hint.empty() ? "" : "; try: ", error.hint));
      result.left_out += target != targets.end();
      if (!first_problem) first_problem = error;
    }
  }
  if (first_problem && (targets.empty() ? result.unassigned.empty() : branches.empty())) throw *first_problem;

  result.tree = tree_modes(std::move(branches), options.wind);
  result.groups = fit_law(result.tree, base, length_of_trunk(plant, options.trunk_length));
  result.notes.insert(result.notes.end(), result.tree.notes.begin(), result.tree.notes.end());
  if (!targets.empty() && result.groups.empty())
    throw Error(Error::Kind::Input,
                fmt::format("{}: no assigned point shows a frequency of its own", tracks.source),
                "see the frequencies found: leave out -o and --assign; or say what the wind's is (--wind)");
  return result;
}

SpeciesFile inferred_species(const SpeciesFile& base, const InferResult& result, const std::string& name) {
  SpeciesFile species = base;
  species.law.species = name;
  species.description =
      fmt::format("Inferred from {}; what it does not show is of '{}'", result.source, base.law.species);
  species.law.model.model = MaterialModel::PowerLaw;  // what was fitted
  for (const FittedGroup& group : result.groups) {
    const std::string where = "groups." + group.group + ".";
    const GroupLaw law = base.law.group(group.group);
    const bool is_new = !species.law.groups.contains(group.group);
    GroupLaw& own = species.law.groups[group.group] = law;
    double log_length = 0;
    for (const FittedBranch& b : group.branches)
      log_length += std::log(b.length) / static_cast<double>(group.branches.size());
    own.reference_length = std::exp(log_length);
    own.reference_frequency = group.c1 * std::pow(own.reference_length, group.epsilon1);
    own.damping = group.damping;
    own.median_frequency = 0;    // as Eq. 8 gives it
    if (is_new) own.match = {};  // the group it was copied from claims its domains itself

    const std::string from =
        fmt::format("video {}: {} tracked point{}, C1 = {:.4g} +- {:.2g} (95 %), residual {:.3g} Hz (2-norm)",
                    result.source, group.branches.size(), group.branches.size() == 1 ? "" : "s", group.c1,
                    kCoverage95 * group.c1_sigma, group.residual);
    const double spread =
        std::hypot(group.c1_sigma / group.c1, group.residual / own.reference_frequency /
                                                  std::sqrt(static_cast<double>(group.branches.size())));
    for (const char* key : {"reference_frequency", "reference_length"})
      set_source(species, where + key, from, confidence_of(spread));
    double damping_spread = 0;
    for (const FittedBranch& b : group.branches)
      damping_spread = std::max(
          damping_spread, b.measured.damping_sigma / std::max(1e-3, std::abs(b.measured.damping_factor)));
    for (const char* key : {"low_frequency", "high_frequency", "low_factor", "high_factor"})
      set_source(
          species, where + "damping." + key,
          fmt::format("video {}: decay or width of resonance, uncertain by {:.0f} % (one standard deviation)",
                      result.source, 100 * damping_spread),
          confidence_of(damping_spread));
    if (is_new)
      for (const char* key : {"epsilon1", "c2", "epsilon2", "damping.kappa", "damping.delta"})
        set_source(species, where + key, fmt::format("as the level above it in '{}'", base.law.species),
                   "low");
  }
  return species;
}

}  // namespace liana
