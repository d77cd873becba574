#include "materials/cache/cache_entries.h"

#include <cmath>

#include "materials/bake/byte_stream.h"
#include "mesher/base/hash.h"

// Structures are taken apart by name: one that gains a member no longer compiles here until its member is
// kept, too.
namespace liana {
namespace {

enum class Content : uint8_t { Copy, Solid };

template <class T>
constexpr bool kGrows = requires(T& list) {
  list.push_back(list[0]);
};

/// Bytes of plain numbers, as they lie in memory.
class Packer {
 public:
  template <class T>
  Packer& add(const T& value) {
    if constexpr (requires { value.data(), value.size(); }) {
      if constexpr (kGrows<T>) writer_.number(static_cast<uint32_t>(value.size()));
      for (const auto& element : value) add(element);
    } else {
      static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
      writer_.number(value);
    }
    return *this;
  }
  const std::string& bytes() const { return writer_.bytes(); }

 private:
  ByteWriter writer_;
};

class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : reader_(bytes, "cache") {}

  template <class T>
  Unpacker& get(T& value) {
    if constexpr (requires { value.data(), value.size(); }) {
      if constexpr (kGrows<T>) value.resize(reader_.count(1));
      for (auto& element : value) get(element);
    } else {
      value = reader_.number<T>();
    }
    return *this;
  }

 private:
  ByteReader reader_;
};

/// 40 bits of the mantissa.
double rounded(double value) {
  int exponent = 0;
  return std::ldexp(std::round(std::ldexp(std::frexp(value, &exponent), 40)), exponent - 40);
}

class KeyHash {
 public:
  explicit KeyHash(uint64_t seed) : hash_(seed) {}
  template <class... Numbers>
  KeyHash& add(const Numbers&... numbers) {
    ((hash_ = hash_bytes(&numbers, sizeof numbers, hash_)), ...);
    return *this;
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_;
};

}  // namespace

std::vector<uint64_t> geometry_keys(const SegmentedPlant& plant) {
  std::vector<uint64_t> surfaces, keys;
  for (const Domain& domain : plant.domains) {
    const Mesh& mesh = domain.surface;
    surfaces.push_back(hash_span<Triangle>(
        mesh.triangles, hash_bytes(mesh.positions.data(), mesh.positions.size() * sizeof(Vec3))));
    const uint64_t parent = domain.parent.valid() ? surfaces[domain.parent.index()] : 0;
    keys.push_back(KeyHash(surfaces.back()).add(parent, domain.kind, domain.thickness).value());
  }
  return keys;
}

std::string encode(const CachedCopy& copy) {
  const auto& [rotation, scale, translation] = copy.similarity;
  Packer packer;
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> turn(rotation.data());
  packer.add(Content::Copy)
      .add(copy.source_key)
      .add(Eigen::Matrix<double, 9, 1>(turn))
      .add(scale)
      .add(translation);
  return packer.bytes();
}

std::string encode(const SolidDomain& solid, bool with_surface) {
  const auto& [surface, is_root, root, length, volume, centreline, route, is_beam, lost_area, lost_volume] =
      solid;
  const auto& [positions, triangles] = with_surface ? surface : Mesh{};
  Packer packer;
  packer.add(Content::Solid)
      .add(positions)
      .add(triangles)
      .add(with_surface ? is_root : std::vector<uint8_t>{});
  packer.add(root)
      .add(length)
      .add(volume)
      .add(route)
      .add(uint8_t{is_beam})
      .add(lost_area)
      .add(lost_volume)
      .add(static_cast<uint32_t>(centreline.size()));
  for (const auto& [centre, half_width, half_thickness, thin_axis, area] : centreline)
    packer.add(centre).add(half_width).add(half_thickness).add(thin_axis).add(area);
  return packer.bytes();
}

std::variant<CachedCopy, SolidDomain> decode_geometry(std::string_view bytes) {
  Unpacker unpacker(bytes);
  Content content;
  unpacker.get(content);
  if (content == Content::Copy) {
    CachedCopy copy;
    Similarity& s = copy.similarity;
    std::array<double, 9> rotation;
    unpacker.get(copy.source_key).get(rotation).get(s.scale).get(s.translation);
    s.rotation = Mat3(rotation.data());
    return copy;
  }
  SolidDomain solid;
  uint32_t sections;
  uint8_t is_beam;
  unpacker.get(solid.surface.positions).get(solid.surface.triangles).get(solid.is_root);
  unpacker.get(solid.root)
      .get(solid.length)
      .get(solid.volume)
      .get(solid.route)
      .get(is_beam)
      .get(solid.lost_area)
      .get(solid.lost_volume)
      .get(sections);
  solid.is_beam = is_beam != 0;
  solid.centreline.resize(sections);
  for (auto& [centre, half_width, half_thickness, thin_axis, area] : solid.centreline)
    unpacker.get(centre).get(half_width).get(half_thickness).get(thin_axis).get(area);
  return solid;
}

uint64_t modes_key(uint64_t geometry_key, const Solid& solid, const ElasticMaterial& material,
                   const DomainModesOptions& options) {
  const auto& [surface, is_root, carried, taper, line, volume, is_beam] = solid;
  const auto& [root_scaling, tip_scaling, epsilon3] = taper;
  const auto& [youngs_modulus, density, poisson_ratio] = material;
  const auto& [mode_options, tets, share, threads] = options;
  const auto& [element, modes] = mode_options;
  const auto& [radius_edge_ratio, min_dihedral] = tets;
  KeyHash key(geometry_key);
  key.add(poisson_ratio, element, modes, radius_edge_ratio, min_dihedral, share);
  if (!taper.uniform()) key.add(root_scaling, tip_scaling, epsilon3);
  for (const auto& [position, mass] : carried)
    key.add(position.x(), position.y(), position.z(), rounded(mass / density));
  return key.value();
}

std::string encode(const CachedModes& cached, const ElasticMaterial& material) {
  const auto& [frequencies, tip_direction, sway, tets, dof, iterations, residual, converged, solved_as,
               failure, as_beam, note] = cached.modes;
  const auto& [sway_frequencies, sway_directions] = sway;
  Packer packer;
  packer.add(cached.source_key).add(material.youngs_modulus).add(material.density);
  packer.add(frequencies).add(tip_direction).add(sway_frequencies).add(sway_directions);
  packer.add(tets)
      .add(dof)
      .add(iterations)
      .add(residual)
      .add(uint8_t{converged})
      .add(failure)
      .add(uint8_t{as_beam})
      .add(note);
  return packer.bytes();
}

CachedModes decode_modes(std::string_view bytes, const ElasticMaterial& material) {
  CachedModes cached;
  DomainModes& m = cached.modes;
  double youngs_modulus, density;
  uint8_t converged, as_beam;
  Unpacker unpacker(bytes);
  unpacker.get(cached.source_key).get(youngs_modulus).get(density);
  unpacker.get(m.frequencies).get(m.tip_direction).get(m.sway.frequencies).get(m.sway.directions);
  unpacker.get(m.tets)
      .get(m.dof)
      .get(m.iterations)
      .get(m.residual)
      .get(converged)
      .get(m.failure)
      .get(as_beam)
      .get(m.note);
  m.converged = converged != 0;
  m.as_beam = as_beam != 0;
  const double faster = std::sqrt(material.youngs_modulus / youngs_modulus * (density / material.density));
  for (double& f : m.frequencies) f *= faster;
  for (double& f : m.sway.frequencies) f *= faster;
  return cached;
}

}  // namespace liana
