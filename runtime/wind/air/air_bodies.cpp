// SphAir's part for solid bodies in it: anisotropic kernels, Eq. 13.
#include <cmath>

#include "runtime/wind/air/sph_air.h"
#include "runtime/wind/air/sph_kernels.h"

namespace liana {

// Glossary: η = G (x_j − x_b), G = diag(1/(h + a), 1/(h + b), 1/(h + c)) Rᵀ [Owen 1997], so that the support
// reaches h beyond the body's surface; W(x) = |G| W₁(|η|) with W₁ of unit support, ∇W = |G| Gᵀ ∇W₁(η).
void SphAir::find_body_pairs(std::span<const AirBody> bodies) {
  body_pairs_.clear();
  const double h = support_;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const AirBody& body = bodies[b];
    const Vec3 reach = body.half_axes + Vec3::Constant(h);
    const Mat3 to_world = body.orientation.toRotationMatrix();
    const Eigen::Matrix3f G = (reach.cwiseInverse().asDiagonal() * to_world.transpose()).cast<float>();
    const double volume = 4 * kPi / 3 * body.half_axes.prod(), share = volume / reach.prod();
    const auto density_factor = static_cast<float>(options_.rest_density * share * poly6_factor(1));
    const auto gradient_factor = static_cast<float>(-share * spiky_factor(1));
    const Vec3 box = (to_world.cwiseAbs2() * reach.cwiseAbs2()).cwiseSqrt();
    const Eigen::Vector3f centre = (body.position - options_.low).cast<float>(), half = box.cast<float>();
    for_ranges(centre - half, centre + half, [&](uint32_t begin, uint32_t end) {
      for (uint32_t j = begin; j < end; ++j) {
        const Eigen::Vector3f eta = G * (Eigen::Vector3f(x_[j], y_[j], z_[j]) - centre);
        const float r2 = eta.squaredNorm(), q = 1 - r2;
        if (q <= 0) continue;
        extra_density_[j] += density_factor * q * q * q;
        const float r = std::sqrt(r2 + 1e-20f);
        const Eigen::Vector3f slope = gradient_factor * (1 - r) * (1 - r) / r * (G.transpose() * eta);
        body_pairs_.push_back({static_cast<uint32_t>(b), j, {slope.x(), slope.y(), slope.z()}});
      }
    });
  }
}

// Müller's pressure force with the body's pressure mirrored from the air: −m V_b p_j/ρ_j ∇W on the air, the
// opposite on the body.
void SphAir::push_bodies(std::span<AirBody> bodies, double dt) {
  for (const BodyPair& pair : body_pairs_) {
    const AirState& air = state_[pair.particle];
    const float pressure = -air.pressure * air.specific_volume;
    Vec3 acceleration;
    for (int k = 0; k < 3; ++k) {
      const float a = pressure * pair.volume_gradient[k];
      extra_acceleration_[4 * pair.particle + k] += a;
      acceleration[k] = a;
    }
    bodies[pair.body].impulse -= mass_ * dt * acceleration;
  }
}

}  // namespace liana
