#include "runtime/wind/air/air_bodies.h"

#include <cmath>

#include "runtime/wind/air/sph_kernels.h"

namespace liana {

AirBodies::AirBodies(const Vec3& domain_low, double support, double rest_density, size_t capacity)
    : low_(domain_low),
      support_(support),
      rest_density_(rest_density),
      density_(capacity + 16),
      acceleration_(4 * (capacity + 16)) {}

// Glossary: η = G (x_j − x_b), G = diag(1/(h + a), 1/(h + b), 1/(h + c)) Rᵀ [Owen 1997], so that the support
// reaches h beyond the body's surface; W(x) = |G| W₁(|η|) with W₁ of unit support, ∇W = |G| Gᵀ ∇W₁(η).
void AirBodies::find(std::span<const AirBody> bodies, const AirCells& cells) {
  pairs_.clear();
  for (size_t b = 0; b < bodies.size(); ++b) {
    const AirBody& body = bodies[b];
    const Vec3 reach = body.half_axes + Vec3::Constant(support_);
    const Mat3 to_world = body.orientation.toRotationMatrix();
    const Eigen::Matrix3f G = (reach.cwiseInverse().asDiagonal() * to_world.transpose()).cast<float>();
    const double volume = 4 * kPi / 3 * body.half_axes.prod(), share = volume / reach.prod();
    const auto density_factor = static_cast<float>(rest_density_ * share * poly6_factor(1));
    const auto gradient_factor = static_cast<float>(-share * spiky_factor(1));
    const Vec3 box = (to_world.cwiseAbs2() * reach.cwiseAbs2()).cwiseSqrt();
    const Eigen::Vector3f centre = (body.position - low_).cast<float>(), half = box.cast<float>();
    cells.for_ranges(centre - half, centre + half, [&](uint32_t begin, uint32_t end) {
      for (uint32_t j = begin; j < end; ++j) {
        const Eigen::Vector3f place(cells.xs()[j], cells.ys()[j], cells.zs()[j]);
        const Eigen::Vector3f eta = G * (place - centre);
        const float r2 = eta.squaredNorm(), q = 1 - r2;
        if (q <= 0) continue;
        density_[j] += density_factor * q * q * q;
        const float r = std::sqrt(r2 + 1e-20f);
        const Eigen::Vector3f slope = gradient_factor * (1 - r) * (1 - r) / r * (G.transpose() * eta);
        pairs_.push_back({static_cast<uint32_t>(b), j, {slope.x(), slope.y(), slope.z()}});
      }
    });
  }
}

// Müller's pressure force with the body's pressure mirrored from the air: −m V_b p_j/ρ_j ∇W on the air, the
// opposite on the body.
void AirBodies::push(std::span<AirBody> bodies, const AirState* state, double mass, double dt) {
  for (const Pair& pair : pairs_) {
    const AirState& air = state[pair.particle];
    const float pressure = -air.pressure * air.specific_volume;
    Vec3 acceleration;
    for (int k = 0; k < 3; ++k) {
      const float a = pressure * pair.volume_gradient[k];
      acceleration_[4 * pair.particle + k] += a;
      acceleration[k] = a;
    }
    bodies[pair.body].impulse -= mass * dt * acceleration;
  }
}

void AirBodies::clear() {
  for (const Pair& pair : pairs_) {
    density_[pair.particle] = 0;
    std::fill_n(&acceleration_[4 * pair.particle], 4, 0.0f);
  }
}

}  // namespace liana
