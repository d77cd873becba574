// How a touched surface answers.
#pragma once

namespace liana {

/// Of a surface, an obstacle's or a plant's. Both in [0, 1], zero the lowest and one the highest response
/// ([Haedrich17] §5.2).
struct ContactMaterial {
  double friction = 0.6;   ///< Coulomb's coefficient: a push of the normal force times this holds
  double restitution = 0;  ///< speed of leaving over that of arriving, along the normal

  bool operator==(const ContactMaterial&) const = default;
};

}  // namespace liana
