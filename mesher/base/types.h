// Vectors, ids and the conventions of the whole system: SI units, right-handed, +Y up (as glTF).
#pragma once

#include <Eigen/Dense>
#include <compare>
#include <cstdint>
#include <limits>

namespace liana {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using Affine3 = Eigen::Affine3d;

/// A 32-bit index that cannot be mistaken for an index into another array. Invalid until set.
template <class Tag>
struct Id {
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(size_t index) : value(static_cast<uint32_t>(index)) {}
  constexpr bool valid() const { return value != kNone; }
  constexpr size_t index() const { return value; }
  constexpr auto operator<=>(const Id&) const = default;
};

using DomainId = Id<struct DomainTag>;      ///< a branch or leaf of a segmented or baked plant
using BranchId = Id<struct BranchTag>;      ///< a chain of particles in the simulator (a branch or a leaf)
using ParticleId = Id<struct ParticleTag>;  ///< an oriented particle of one simulated plant

enum class DomainKind : uint8_t { Branch, Leaf };

constexpr double kPi = 3.14159265358979323846;

}  // namespace liana
