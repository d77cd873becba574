// The drag of moving air on a plant's particles, as dashpots to the air for the next time step.
#pragma once

#include <vector>

#include "runtime/sim/model/plant.h"
#include "runtime/wind/field/wind_field.h"

namespace liana {

struct DragOptions {
  double air_density = 1.2;       ///< kg/m³
  double stem_coefficient = 1.1;  ///< C_d of a cylinder across the flow
  double leaf_coefficient = 0.6;  ///< C_d of a flexible blade
  double leaf_yield_speed = 4;    ///< m/s, above which blades fold and roll up: reconfiguration
  /// V of [Vogel 1989], "Drag and reconfiguration of broad leaves in high winds", J. Exp. Bot. 40: above the
  /// yield speed drag grows as u^(2+V). Broad leaves and plants range from about -0.2 to -1.2 [de Langre
  /// 2008].
  double leaf_vogel_exponent = -1;
};

/// Area (m²) of an ellipsoid's shadow along the unit direction u: π √((bc u_x)² + (ac u_y)² + (ab u_z)²),
/// [Haedrich17]'s particle shape; both in the particle's frame.
double projected_area(const Particle& particle, const Vec3& u);

/// N·s/m: the drag of air that passes a particle at `relative` (m/s, world frame) is this times `relative`,
/// ½ ρ C_d A |u|, with blades yielding.
double drag_factor(const Plant& plant, ParticleId particle, const Vec3& relative, const DragOptions& options);

/// The dashpot that gives a particle the force factor * (air - velocity at the end of the step), N.
WorldSpring drag_dashpot(const Plant& plant, ParticleId particle, double factor, const Vec3& air);

/// Appends one dashpot per particle: F = ½ ρ C_d A |u| (wind - velocity). Linear in the velocity at the end
/// of the step, so no leaf, however light, is driven past the wind's own speed (by a twentieth for one step,
/// when let go into it).
///
/// F is the physical force. [Wang17] Eq. 3 divides external forces by α_m; here the particles' masses already
/// hold α_m, so the acceleration F/(α_m m) is scaled by 1/α_m by itself: no factor here. Gravity scales with
/// the mass.
void add_wind(const Plant& plant, const WindField& wind, double time, const DragOptions& options,
              std::vector<WorldSpring>& springs);

}  // namespace liana
