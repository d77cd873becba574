// fit_contacts [SECONDS [SEEDS [FACTORS]]]: what each of ContactWeights does to the shipped scenes with
// contacts.
//
// Every weight is multiplied by FACTORS (default 0.5,1,2), the others kept; each scene runs SECONDS (default
// 10) from SEEDS (default 2) seeds. One line of a Markdown table each: deepest penetration of obstacles,
// deepest overlap of plant parts, steps taken again, redone with finer substeps, joints closed by hand; sums
// and maxima over the seeds. A weight is well chosen where no line beside it is better in one column and no
// worse in the others.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "runtime/app/scene/scene_preparation.h"
#include "runtime/world/world.h"

namespace liana {
namespace {

struct Weight {
  const char* name;
  double ContactWeights::*value;
};
constexpr Weight kWeights[] = {
    {"impact", &ContactWeights::impact},          {"gentlest", &ContactWeights::gentlest},
    {"longest", &ContactWeights::longest},        {"hardest", &ContactWeights::hardest},
    {"linger", &ContactWeights::linger},          {"bounce_speed", &ContactWeights::bounce_speed},
    {"stick_speed", &ContactWeights::stick_speed}};

struct Outcome {
  double penetration = 0, overlap = 0;  // m
  size_t passes = 0, redone = 0, projected = 0, lost = 0;
};

Outcome run(Scene scene, const ContactWeights& weights, double seconds, uint64_t seeds) {
  Outcome all;
  scene.contact_weights = weights;
  const uint64_t first = scene.seed;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    scene.seed = first + 1000 * seed;
    World world(scene);
    for (double t = 0; t < seconds; t += scene.time_step) world.step();
    const WorldReport report = world.report();
    all.penetration = std::max(all.penetration, report.max_penetration);
    all.overlap = std::max(all.overlap, report.max_overlap);
    all.passes += report.contact_passes;
    all.redone += report.redone_steps;
    all.projected += report.projected_joints;
    all.lost += report.lost_steps;
  }
  return all;
}

void print(const char* weight, double value, const char* scene, const Outcome& o) {
  fmt::print("| {} | {:g} | {} | {:.2f} | {:.2f} | {} | {} | {} | {} |\n", weight, value, scene,
             1e3 * o.penetration, 1e3 * o.overlap, o.passes, o.redone, o.projected, o.lost);
  std::fflush(stdout);
}

int fit(int count, char** arguments) {
  const double seconds = count > 1 ? std::atof(arguments[1]) : 10;
  const uint64_t seeds = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 2;
  std::stringstream list(count > 3 ? arguments[3] : "0.5,1,2");
  std::vector<double> factors;
  for (std::string factor; std::getline(list, factor, ',');) factors.push_back(std::atof(factor.c_str()));

  fmt::print("{} s, {} seeds\n\n", seconds, seeds);
  fmt::print("| weight | value | scene | penetration, mm | overlap, mm | again | redone | closed | lost |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const char* name : {"fence", "wall", "moving_cubes"}) {
    Scene scene = load_scene(fmt::format("data/scenes/{}.toml", name));
    print("none", 1, name, run(scene, {}, seconds, seeds));
    for (const Weight& weight : kWeights)
      for (const double factor : factors) {
        if (factor == 1) continue;
        ContactWeights changed;
        changed.*weight.value *= factor;
        print(weight.name, changed.*weight.value, name, run(scene, changed, seconds, seeds));
      }
  }
  return 0;
}

}  // namespace
}  // namespace liana

int main(int count, char** arguments) {
  return liana::fit(count, arguments);
}
