#include "runtime/sim/check/verify.h"

#include <algorithm>

#include "mesher/base/error.h"
#include "mesher/base/parallel.h"
#include "runtime/sim/calibrate/plant_from_bake.h"

namespace liana {
namespace {

DomainVerdict judge(const Branch& branch, const ProbeResult& result, const VerifyOptions& options) {
  DomainVerdict v;
  v.id = branch.domain;
  v.frequency_baked = branch.material.frequency;
  v.damping_baked = branch.material.damping_factor;
  v.frequency_measured = result.swing.frequency;
  v.damping_measured = result.swing.damping_factor;
  v.residual = result.swing.residual;
  v.measured = result.swing.found;
  v.particles = static_cast<int>(branch.particles.size());
  v.steps = result.steps;
  const double damping_unit = v.damping_baked < 0.02 ? 0.04 : v.damping_baked;
  v.frequency_error = v.measured ? std::abs(v.frequency_measured - v.frequency_baked) / v.frequency_baked : 1;
  v.damping_error = v.measured ? std::abs(v.damping_measured - v.damping_baked) / damping_unit : 1;
  v.within = v.frequency_error <= options.frequency_bar && v.damping_error <= options.damping_bar;
  return v;
}

}  // namespace

VerifyReport verify_bake(const Bake& bake, const VerifyOptions& options, unsigned threads,
                         Progress& progress) {
  if (bake.domains.empty())
    throw Error(Error::Kind::Input, "bake of '" + bake.plant + "': it has no domains",
                "bake the plant again");
  VerifyReport report;
  const Plant plant = make_plant(bake, {.scheme = options.scheme}, &report.calibration);
  const std::vector<double> carried = carried_masses(plant);
  report.domains.resize(plant.branches.size());
  if (threads == 0) threads = default_thread_count();
  std::vector<HeldChain> chains(threads);

  progress.begin("pluck", plant.branches.size());
  parallel_for(plant.branches.size(), threads, [&](size_t i, unsigned worker) {
    progress.throw_if_cancelled();
    HeldChain& chain = chains[worker];
    chain.build(plant, BranchId(i), carried);
    chain.lowest_eigenvalue();
    report.domains[i] = judge(plant.branches[i], probe(chain, options.probe), options);
    progress.advance();
  });
  for (const DomainVerdict& v : report.domains) {
    report.max_frequency_error = std::max(report.max_frequency_error, v.frequency_error);
    report.max_damping_error = std::max(report.max_damping_error, v.damping_error);
    report.within = report.within && v.within;
  }
  report.standing = check_standing(plant, progress);
  return report;
}

}  // namespace liana
