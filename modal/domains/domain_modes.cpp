#include "modal/domains/domain_modes.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "mesher/base/error.h"
#include "mesher/base/parallel.h"
#include "modal/domains/beam_mode.h"
#include "modal/elements/taper_field.h"

namespace liana {
namespace {

/// The copy to take the solution from.
struct Source {
  size_t solid;
  Similarity similarity;  ///< from the source to the copy
};

/// For each solid the first of its shape. Candidates share the connectivity and lie within a window of one
/// number that all copies share, so that thousands of branches with equal connectivity and different shapes
/// do not meet pairwise.
std::vector<Source> find_sources(const std::vector<Solid>& solids, bool share) {
  // The area and volume of a copy within tolerance differ by a few times that tolerance.
  constexpr double kWindow = 0.02;
  struct Candidate {
    size_t solid;
    double slenderness;
  };
  std::map<uint64_t, std::multimap<double, Candidate>> known;
  std::vector<Source> sources;
  for (size_t i = 0; i < solids.size(); ++i) {
    sources.push_back({i, {}});
    const ShapeSignature signature = shape_signature(solids[i]);
    if (!share || !std::isfinite(signature.compactness)) continue;  // tetrahedralize() will say what is wrong
    const double slenderness = signature.extent / signature.thickness;
    auto& candidates = known[signature.connectivity];
    const auto end = candidates.upper_bound(signature.compactness * (1 + kWindow));
    for (auto c = candidates.lower_bound(signature.compactness * (1 - kWindow)); c != end; ++c) {
      if (std::abs(c->second.slenderness / slenderness - 1) > kWindow) continue;
      if (const auto similarity = find_similarity(solids[c->second.solid], solids[i])) {
        sources.back() = {c->second.solid, *similarity};
        break;
      }
    }
    if (sources.back().solid == i) candidates.emplace(signature.compactness, Candidate{i, slenderness});
  }
  return sources;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Seconds {
  double tets = 0, modes = 0;
};

DomainModes result_of(Modes&& modes) {
  DomainModes result;
  result.frequencies = std::move(modes.frequencies);
  result.tip_direction = std::move(modes.tip_direction);
  result.sway = modes.sway;
  result.dof = modes.dof;
  result.iterations = modes.iterations;
  result.residual = modes.residual;
  result.converged = modes.converged;
  return result;
}

/// Sections that hold far less than their ellipse: of a folded sheet, stiff only as long as its wings do not
/// flap, of which a beam knows nothing (10 times too fast: 0.3 × 0.1 m, 0.3 mm thick, folded by 0.4 rad).
bool is_folded(const std::vector<Section>& line) {
  const auto folded = std::count_if(line.begin(), line.end(), [](const Section& s) {
    return s.area > 0 && s.area < 0.6 * kPi * s.half_width * s.half_thickness;
  });
  return 2 * static_cast<size_t>(folded) >= line.size();
}

/// `reason`: why there are no tets; empty if the solid is a beam from the start.
DomainModes solve_beam(const Solid& solid, const ElasticMaterial& material, const DomainModesOptions& options,
                       const std::string& reason) {
  DomainModes result;
  try {
    // The line of a solid runs on beyond a closed tip; its volume says where it ends.
    const std::vector<Section> line = solid.is_beam
                                          ? std::vector<Section>(solid.line.begin(), solid.line.end())
                                          : carried_to_ends(solid.line);
    result = result_of(
        beam_modes(line, solid.is_beam ? 0 : solid.volume, material, solid.carried, options.modes.modes));
    result.as_beam = true;
    if (!reason.empty()) result.note = "+solved-as-beam (" + reason + ")";
    if (is_folded(line)) result.note += "+rough-beam (of a folded sheet)";
    if (!solid.taper.uniform()) result.note += "+taper-left-out";
    if (!result.converged) result.failure = "the beam's lowest mode did not converge";
  } catch (const Error& error) {
    result.failure = reason.empty() ? error.what() : reason;
  }
  return result;
}

DomainModes solve(const Solid& solid, const ElasticMaterial& material, const DomainModesOptions& options,
                  Seconds& seconds) {
  if (solid.is_beam) return solve_beam(solid, material, options, "");
  DomainModes result;
  auto start = std::chrono::steady_clock::now();
  try {
    const TetMesh tets = tetrahedralize(*solid.surface, solid.is_root, options.tets);
    seconds.tets += seconds_since(start);
    start = std::chrono::steady_clock::now();
    std::vector<ElementScaling> scaling;
    if (!solid.taper.uniform()) scaling = tapered(tets, solid.taper);
    result = result_of(lowest_modes(tets, material, solid.carried, options.modes, scaling));
    seconds.modes += seconds_since(start);
    result.tets = static_cast<uint32_t>(tets.tets.size());
    if (tets.polished) result.note = "+polished-tets";
    if (!result.converged)
      result.failure = fmt::format("its lowest mode did not converge (residual {:.1e})", result.residual);
  } catch (const Error& error) {
    result.failure = error.what();
  }
  if (result.failure.empty() || solid.line.empty()) return result;
  const DomainModes beam = solve_beam(solid, material, options, result.failure);
  return beam.failure.empty() ? beam : result;
}

}  // namespace

DomainModes moved(const DomainModes& original, const Similarity& similarity) {
  DomainModes copy = original;
  for (double& f : copy.frequencies) f /= similarity.scale;
  for (double& f : copy.sway.frequencies) f /= similarity.scale;
  for (Vec3& d : copy.tip_direction) d = similarity.rotation * d;
  for (Vec3& d : copy.sway.directions) d = similarity.rotation * d;
  return copy;
}

AllModes solve_domains(const std::vector<Solid>& solids, const ElasticMaterial& material,
                       const DomainModesOptions& options, Progress& progress) {
  const std::vector<Source> sources = find_sources(solids, options.share_equal_shapes);
  std::vector<size_t> unique;
  for (size_t i = 0; i < solids.size(); ++i)
    if (sources[i].solid == i) unique.push_back(i);
  // Large ones first, so that no worker ends on one alone.
  std::stable_sort(unique.begin(), unique.end(), [&](size_t a, size_t b) {
    return solids[a].surface->triangles.size() > solids[b].surface->triangles.size();
  });

  AllModes all;
  all.domains.resize(solids.size());
  progress.begin("modes", unique.size());
  const unsigned threads = options.threads ? options.threads : default_thread_count();
  std::vector<Seconds> seconds(threads);
  parallel_for(unique.size(), threads, [&](size_t k, unsigned worker) {
    progress.throw_if_cancelled();
    all.domains[unique[k]] = solve(solids[unique[k]], material, options, seconds[worker]);
    progress.advance();
  });
  for (size_t i = 0; i < solids.size(); ++i) {
    const size_t source = sources[i].solid;
    if (source != i) all.domains[i] = moved(all.domains[source], sources[i].similarity);
    all.domains[i].solved_as = source;
  }
  for (const Seconds& s : seconds) all.tet_seconds += s.tets, all.mode_seconds += s.modes;
  return all;
}

}  // namespace liana
