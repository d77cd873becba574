#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "materials/bake/bake_file.h"
#include "materials/law/species_file.h"
#include "materials/pipeline/bake_plant.h"
#include "materials/pipeline/baked_solids.h"
#include "mesher/base/files.h"
#include "mesher/io/plant_file.h"
#include "modal/elements/interpolation.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"
#include "runtime/app/writable.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/check/particle_modes.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

struct ModesArguments {
  fs::path plant, json, vtu;
  std::string species;
  int count = 6;
};

/// The plant as the simulator has it, with a step so fine that its joints are those of continuous time.
Plant fine_plant(const Bake& bake) {
  PlacementOptions options;
  options.scheme.dt = 1e-5;
  options.gravity = Vec3::Zero();
  return make_plant(bake, options);
}

std::vector<Vec3> at_centres(const std::vector<Vec6>& shape) {
  std::vector<Vec3> translations;
  for (const Vec6& motion : shape) translations.push_back(motion.head<3>());
  return translations;
}

/// What the FE mesh of a particle's domain does at the particle's centre, per mode.
std::vector<std::vector<Vec3>> at_centres(const UnitedModes& modes, const Plant& plant) {
  std::vector<std::vector<Vec3>> shapes(modes.frequencies.size());
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    const size_t part = plant.particles[i].branch.index();
    const auto weights = interpolate_at(modes.meshes[part], plant.motion[i].position);
    for (size_t m = 0; m < shapes.size(); ++m) {
      Vec3 u = Vec3::Zero();
      for (const auto& [node, weight] : weights)
        u += weight * modes.shapes[part].block<3, 1>(3 * node, static_cast<Eigen::Index>(m));
      shapes[m].push_back(u);
    }
  }
  return shapes;
}

struct Pair {
  double fe, particles;  ///< Hz
  size_t particle_mode;  ///< the one most alike
  double mac;            ///< with it
  double group_mac;  ///< with all within 5 % of its frequency together: modes of a round stem come in pairs
};

std::vector<Pair> compare(const UnitedModes& fe, const ParticleModes& particles, const Plant& plant) {
  const std::vector<std::vector<Vec3>> shapes = at_centres(fe, plant);
  std::vector<Pair> pairs;
  for (size_t m = 0; m < shapes.size(); ++m) {
    std::vector<double> mac;
    for (const std::vector<Vec6>& shape : particles.shapes)
      mac.push_back(assurance(plant, shapes[m], at_centres(shape)));
    const size_t best = std::max_element(mac.begin(), mac.end()) - mac.begin();
    double group = 0;
    for (size_t k = 0; k < mac.size(); ++k)
      if (std::abs(particles.frequencies[k] / particles.frequencies[best] - 1) < 0.05) group += mac[k];
    pairs.push_back({fe.frequencies[m], particles.frequencies[best], best, mac[best], std::min(1.0, group)});
  }
  return pairs;
}

void print_pairs(const std::vector<Pair>& pairs) {
  fmt::print("mode  FE, Hz     particles, Hz  (its mode)  difference  MAC    MAC of its group\n");
  for (size_t m = 0; m < pairs.size(); ++m) {
    const Pair& p = pairs[m];
    fmt::print("{:4}  {:<9.4g}  {:<13.4g}  {:10}  {:+9.2f}%  {:.3f}  {:.3f}\n", m + 1, p.fe, p.particles,
               p.particle_mode + 1, 100 * (p.particles / p.fe - 1), p.mac, p.group_mac);
  }
}

Bake bake_of(const ModesArguments& arguments, SegmentedPlant& plant) {
  plant = read_plant(arguments.plant);
  TerminalProgress progress;
  return bake_plant(plant, read_species(arguments.species), {}, progress).bake;
}

int modes(const ModesArguments& arguments) {
  for (const fs::path& path : {arguments.json, arguments.vtu})
    if (!path.empty()) require_writable_folder(path);
  const bool is_bake = arguments.plant.extension() == ".bake";
  if (!is_bake && arguments.species.empty())
    throw Error(Error::Kind::Usage, "a plant needs a species", "--species NAME, see liana inspect --species");
  if (is_bake && !arguments.vtu.empty())
    throw Error(Error::Kind::Usage, "a bake has no tets to write", "give the plant (.glb) it was made from");
  SegmentedPlant plant;
  const Bake bake = is_bake ? read_bake(arguments.plant) : bake_of(arguments, plant);
  const Plant particles = fine_plant(bake);
  nlohmann::ordered_json json{{"plant", bake.plant}, {"domains", bake.domains.size()}};

  if (is_bake) {
    const ParticleModes found = particle_modes(particles, arguments.count);
    fmt::print("{}: {} particles; a bake has no tets: the particle model alone\n", bake.plant,
               particles.particles.size());
    for (size_t m = 0; m < found.frequencies.size(); ++m)
      fmt::print("{:4}  {:.4g} Hz\n", m + 1, found.frequencies[m]);
    json["particles_hz"] = found.frequencies;
  } else {
    const std::vector<UnitedPart> parts = baked_solids(plant, bake);
    const UnitedModes fe = united_modes(parts, arguments.count);
    // A few more, so that an FE mode finds its like though the order differs.
    const ParticleModes found = particle_modes(particles, 2 * arguments.count);
    const std::vector<Pair> pairs = compare(fe, found, particles);
    fmt::print("{} as {}: {} domains, {} dof, {} root nodes tied to their parents; {} particles\n\n",
               bake.plant, bake.law.species, parts.size(), fe.dof, fe.tied_nodes, particles.particles.size());
    print_pairs(pairs);
    if (!fe.converged) fmt::print("note: the FE modes did not converge\n");
    json.update({{"united_by", "root nodes tied to the parent's mesh"},
                 {"dof", fe.dof},
                 {"tied_nodes", fe.tied_nodes},
                 {"fe_converged", fe.converged},
                 {"fe_hz", fe.frequencies},
                 {"particles_hz", found.frequencies},
                 {"pairs", nlohmann::ordered_json::array()}});
    for (const Pair& p : pairs)
      json["pairs"].push_back({{"fe_hz", p.fe},
                               {"particles_hz", p.particles},
                               {"particle_mode", p.particle_mode + 1},
                               {"mac", p.mac},
                               {"group_mac", p.group_mac}});
    if (!arguments.vtu.empty()) write_vtu(united_vtu(bake, parts, fe), arguments.vtu);
  }
  if (!arguments.json.empty())
    write_file(arguments.json,
               json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  return bake.failed.empty() ? kSuccess : kPartial;
}

}  // namespace

void add_modes_verb(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ModesArguments>();
  CLI::App* verb = app.add_subcommand(
      "modes", "The lowest modes of a whole plant by finite elements and by the simulator's particles");
  verb->add_option("plant", arguments->plant,
                   "The plant (.glb, .gltf), or a .bake for the particles' modes alone")
      ->required();
  verb->add_option("-s,--species", arguments->species, "A preset's name or a .toml file")
      ->option_text("NAME");
  verb->add_option("--count", arguments->count, "How many modes")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  verb->add_option("--json", arguments->json, "Also write frequencies and likeness as JSON");
  verb->add_option("--vtu", arguments->vtu,
                   "Also write the tets with mode shapes and materials for ParaView");
  verb->footer(
      "Example:\n"
      "  liana modes data/plants/apple_small.glb --species apple --count 6 --vtu modes.vtu\n\n"
      "The domains' T10 meshes, each of its baked material, are tied together at their root interfaces.\n"
      "MAC is 1 where both models move alike. Neither has gravity or damping.\n"
      "Exit code: 0 done, 1 bad input, 2 bad command line, 3 done but for some domains");
  verb->callback([arguments, &exit_code] { exit_code = modes(*arguments); });
}

}  // namespace liana
