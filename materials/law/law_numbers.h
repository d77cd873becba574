// Every number of a species law, once: its name in files, its unit and what is not absurd.
//
// The reader, the bake file, the checks and `liana inspect` all go through these lists.
#pragma once

#include <cmath>
#include <string>

#include "materials/law/species_law.h"

namespace liana {

/// What a number is called and the closed range it must lie in.
struct NumberRange {
  const char* key;
  const char* unit;
  double min, max;
};

inline constexpr const char* kModulusOfRupture = "modulus_of_rupture";

/// visit(NumberRange, double&) for E, ρ and Poisson's ratio.
template <class Material, class Visit>
void for_each_number_of_material(Material& material, Visit&& visit) {
  visit(NumberRange{"youngs_modulus", "Pa", 1e3, 1e12}, material.youngs_modulus);
  visit(NumberRange{"density", "kg/m³", 1, 5000}, material.density);
  visit(NumberRange{"poisson_ratio", "", 0, 0.495}, material.poisson_ratio);
}

/// visit(NumberRange, double&) for Eq. 8 and 9 of one group.
template <class Group, class Visit>
void for_each_number_of_group(Group& group, Visit&& visit) {
  visit(NumberRange{"reference_frequency", "Hz", 1e-3, 1e3}, group.reference_frequency);
  visit(NumberRange{"reference_length", "m", 1e-4, 1e3}, group.reference_length);
  visit(NumberRange{"epsilon1", "", -4, 4}, group.epsilon1);
  visit(NumberRange{"c2", "m^-epsilon2", 1e-6, 1e6}, group.c2);
  visit(NumberRange{"epsilon2", "", -4, 4}, group.epsilon2);
}

/// visit(NumberRange, double&) for what a group may leave out: the median model's ν, Eq. 11, and what it
/// bears.
template <class Group, class Visit>
void for_each_optional_number_of_group(Group& group, Visit&& visit) {
  visit(NumberRange{"median_frequency", "Hz", 0, 1e3}, group.median_frequency);
  visit(NumberRange{"s_max", "", 1e-3, 1e3}, group.taper.root_scaling);
  visit(NumberRange{"s_min", "", 1e-3, 1e3}, group.taper.tip_scaling);
  visit(NumberRange{"epsilon3", "", 0, 100}, group.taper.epsilon3);
  visit(NumberRange{kModulusOfRupture, "Pa", 0, 1e10}, group.modulus_of_rupture);
}

/// visit(NumberRange, double&) for what the models beside the power law need; all may be left out.
template <class Model, class Visit>
void for_each_number_of_model(Model& model, Visit&& visit) {
  visit(NumberRange{"trunk_frequency", "Hz", 0, 1e3}, model.trunk_frequency);
  visit(NumberRange{"depth_scale", "", 0, 1e12}, model.depth_scale);
  visit(NumberRange{"depth_discount", "", 1e-6, 1}, model.depth_discount);
}

/// visit(NumberRange, double&) for Eq. 13 and 14 of one group, or for its constant d_M and d_K.
template <class Damping, class Visit>
void for_each_number_of_damping(Damping& damping, Visit&& visit) {
  if (damping.constant_rayleigh) {
    visit(NumberRange{"mass_damping", "1/s", 0, 1e3}, damping.mass_damping);
    visit(NumberRange{"stiffness_damping", "s", 0, 10}, damping.stiffness_damping);
    return;
  }
  visit(NumberRange{"low_frequency", "Hz", 0, 1e3}, damping.low_frequency);
  visit(NumberRange{"high_frequency", "Hz", 0, 1e3}, damping.high_frequency);
  visit(NumberRange{"low_factor", "", 0, 5}, damping.low_factor);
  visit(NumberRange{"high_factor", "", 0, 5}, damping.high_factor);
  visit(NumberRange{"kappa", "", 1 + 1e-6, 100}, damping.kappa);
  visit(NumberRange{"delta", "", 0.01, 100}, damping.delta);
}

/// What is wrong with a number, e.g. "is -3 kg/m³; it must lie in [1, 5000]"; empty when nothing is.
std::string range_problem(const NumberRange& range, double value);
/// The same for what ties two numbers: ν_low ≤ ν_high, and δ in [1/κ, κ], outside which Eq. 15 gives negative
/// damping.
std::string damping_problem(const DampingLaw& damping);

/// All of the above. Throws Error{Input} that names `where`, the group and the number.
void check(const GroupLaw& law, const std::string& where);
void check(const SpeciesLaw& law, const std::string& where);

}  // namespace liana
