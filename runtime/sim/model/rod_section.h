// Elastic stiffness of a rod's elliptic cross-section.
#pragma once

#include <cmath>

#include "runtime/sim/model/plant.h"

namespace liana {

/// Of a section, per unit of strain: (shear x, stretch, shear z) in N and (bend x, twist, bend z) in N·m².
struct RodSection {
  Vec3 shear, bend;
};

/// a: half width along x, b: half thickness along z (m). The softer bending is about x. stiffness_ratio:
/// bending about z over bending about x, measured rather than taken from the section (1 for a round rod;
/// (a/b)² for an ellipse).
inline RodSection rod_section(double youngs_modulus, double poisson_ratio, double a, double b,
                              double stiffness_ratio) {
  const double G = youngs_modulus / (2 * (1 + poisson_ratio)), area = kPi * a * b;
  const double I = kPi / 4 * a * b * b * b;  // ∫ z² dA
  const double torsion =
      kPi * a * a * a * b * b * b / (a * a + b * b);  // Saint-Venant's, exact for an ellipse
  return {{G * area, youngs_modulus * area, G * area},
          {youngs_modulus * I, G * torsion, stiffness_ratio * youngs_modulus * I}};
}

/// Sets a joint to a section over the length h (m) of rod that it stands for, times the branch's
/// stiffness_scale.
inline void set_section(Joint& joint, const RodSection& section, double h, double stiffness_scale = 1) {
  joint.shear_stiffness = stiffness_scale / h * section.shear;
  joint.bend_stiffness = stiffness_scale / h * section.bend;
}

/// Principal moments (kg·m²) about the centre of an elliptic cylinder along y of full length 2 half_length.
inline Vec3 rod_inertia(double mass, double half_length, double a, double b) {
  const double along = half_length * half_length / 3;
  return mass * Vec3(along + b * b / 4, (a * a + b * b) / 4, along + a * a / 4);
}

}  // namespace liana
