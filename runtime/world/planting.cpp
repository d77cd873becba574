#include "runtime/world/planting.h"

#include <fmt/core.h>

#include <cmath>

#include "materials/bake/bake_file.h"
#include "materials/law/species_file.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "runtime/sim/calibrate/plant_from_bake.h"

namespace liana {
namespace {

uint64_t hash_of_file(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  return hash_bytes(text.data(), text.size());
}

}  // namespace

Planted plant_baked(const Scene& scene, const ScenePlant& entry, std::vector<std::string>& notes) {
  Planted planted{std::make_unique<PlantInstance>(ContactOptions{.weights = scene.contact_weights}), {}};
  Plant& plant = planted.instance->plant;
  PlacementOptions placement;
  placement.position = entry.position;
  placement.yaw = entry.yaw;
  placement.gravity = scene.gravity;
  placement.scheme.dt = scene.time_step;
  placement.scheme.solver = scene.solver;
  CalibrationReport calibration;
  const Bake bake = read_bake(entry.bake);
  plant = make_plant(bake, placement, &calibration);
  if (!calibration.note.empty()) notes.push_back(plant.name + ": " + calibration.note);
  if (!calibration.out_of_range.empty())
    notes.push_back(
        fmt::format("{}: {} of {} domains are too fast for a step of {} s and move as near as it can",
                    plant.name, calibration.out_of_range.size(), calibration.branches, scene.time_step));
  planted.origin.look = plant_look(bake.law.species);
  planted.origin.source = hash_of_file(entry.bake);
  for (const BakedDomain& domain : bake.domains) planted.origin.domains.push_back(domain.name);
  const size_t unknown = set_strengths(plant, bake.law, entry.breaking);
  if (entry.breaking > 0 && unknown > 0)
    notes.push_back(
        fmt::format("{}: {} branches and leaves have no modulus of rupture in their law: they do not break",
                    plant.name, unknown));
  return planted;
}

Planted plant_climber(const Scene& scene, const SceneClimber& entry, uint64_t seed,
                      std::vector<std::string>& notes) {
  Planted planted{std::make_unique<PlantInstance>(ContactOptions{.weights = scene.contact_weights}), {}};
  SpeciesLaw law = entry.bake.empty() ? read_species(entry.species) : read_bake(entry.bake).law;
  Plant& plant = planted.instance->plant;
  plant.name = law.species;
  plant.scheme.dt = scene.time_step;
  plant.scheme.solver = scene.solver;
  ClimberParameters parameters;
  parameters.max_particles = entry.max_particles;
  parameters.gravity = scene.gravity;
  parameters.first_shoots = entry.first_shoots;
  parameters.longest_free = entry.longest_free;
  parameters.weight_grown_in = entry.weight_grown_in;
  law.default_material.youngs_modulus *= entry.stiffness;
  for (auto& [group, numbers] : law.groups) numbers.reference_frequency *= std::sqrt(entry.stiffness);
  if (entry.breaking > 0) {
    parameters.strength = modulus_of_rupture(law, "level0") / entry.breaking;
    parameters.leaf_strength = modulus_of_rupture(law, "leaf") / entry.breaking;
    if (parameters.strength == 0)
      notes.push_back(law.species + ": its law has no modulus of rupture: it does not break");
  }
  planted.instance->climber.emplace(parameters, law, entry.position, seed);
  planted.origin.look = plant_look(law.species);
  planted.origin.growth_speed = entry.growth_speed;
  planted.origin.source = hash_of_file(entry.bake.empty() ? find_species(entry.species) : entry.bake);
  return planted;
}

}  // namespace liana
