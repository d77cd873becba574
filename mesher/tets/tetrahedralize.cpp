#include "mesher/tets/tetrahedralize.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "mesher/surface/self_intersection.h"
#include "mesher/tets/tetgen_driver.h"

namespace liana {
namespace {

constexpr double kVolumeTolerance = 1e-6;

[[noreturn]] void refuse(const std::string& reason) {
  throw Error(Error::Kind::Input, "cannot fill the surface with tetrahedra: " + reason,
              "the surface must be closed, oriented outward and free of self-intersection");
}

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

struct Measures {
  Vec3 centre;
  double extent, volume, area;
};

Measures measure(const Mesh& surface) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : surface.triangles)
    for (const uint32_t v : t) box.extend(surface.positions[v]);
  Measures m{box.center(), box.sizes().maxCoeff(), 0, 0};
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3 &p = surface.positions[a], &q = surface.positions[b], &r = surface.positions[c];
    m.volume += six_volumes(m.centre, p, q, r) / 6;
    m.area += (q - p).cross(r - p).norm() / 2;
  }
  return m;
}

void check_indices_and_numbers(const Mesh& surface, std::span<const uint8_t> is_root) {
  require(is_root.size() == surface.triangles.size(), "is_root must have one entry a triangle");
  if (surface.triangles.size() < 4) refuse(fmt::format("it has {} triangles", surface.triangles.size()));
  for (const Triangle& t : surface.triangles)
    for (const uint32_t v : t) {
      if (v >= surface.positions.size())
        refuse(fmt::format("a triangle names vertex {} of {}", v, surface.positions.size()));
      if (!surface.positions[v].allFinite()) refuse(fmt::format("vertex {} is not a finite point", v));
    }
}

/// Every directed edge once, and its opposite once: closed, consistently oriented, no edge with 3 or more
/// faces.
void check_closed(const Mesh& surface) {
  std::vector<uint64_t> edges;
  edges.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) {
      const uint64_t from = t[k], to = t[(k + 1) % 3];
      if (from == to) refuse("a triangle uses a vertex twice");
      edges.push_back(from << 32 | to);
    }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end())
    refuse("an edge has more than two triangles, or neighbours of opposite orientation");
  for (const uint64_t e : edges)
    if (!std::binary_search(edges.begin(), edges.end(), e << 32 | e >> 32)) {
      const Vec3 place = (surface.positions[e >> 32] + surface.positions[e & 0xffffffff]) / 2;
      refuse(fmt::format("it is open at ({:.4g}, {:.4g}, {:.4g})", place.x(), place.y(), place.z()));
    }
}

/// The vertices in use, scaled to an extent below 1 about the origin and moved by up to `jitter`: regular
/// rings are cospherical, which makes TetGen 15 times slower and leaves slivers.
Mesh prepare(const Mesh& surface, const Measures& m, double jitter, std::vector<uint32_t>& source) {
  Mesh prepared;
  std::vector<uint32_t> index(surface.positions.size(), UINT32_MAX);
  const double scale = 0.999 / m.extent;
  for (const Triangle& t : surface.triangles) {
    Triangle& mapped = prepared.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      uint32_t& i = index[t[k]];
      if (i == UINT32_MAX) {
        i = static_cast<uint32_t>(source.size());
        source.push_back(t[k]);
        Vec3 offset;
        for (uint32_t axis = 0; axis < 3; ++axis) {
          const uint32_t key[2] = {i, axis};
          offset[axis] = 2 * (hash_bytes(key, sizeof key) >> 11) * 0x1p-53 - 1;
        }
        prepared.positions.push_back(scale * (surface.positions[t[k]] - m.centre) + jitter * offset);
      }
      mapped[k] = i;
    }
  }
  return prepared;
}

void check_result(const TetMesh& mesh, double surface_volume) {
  double volume = 0;
  for (const auto& [a, b, c, d] : mesh.tets) {
    const double v = six_volumes(mesh.positions[a], mesh.positions[b], mesh.positions[c], mesh.positions[d]);
    if (!(v > 0)) refuse("it is too thin somewhere: a tetrahedron has no volume");
    volume += v / 6;
  }
  if (!(std::abs(volume / surface_volume - 1) < kVolumeTolerance))
    refuse(fmt::format("the tetrahedra fill {:.9g} m³ of its {:.9g} m³", volume, surface_volume));
}

}  // namespace

TetMesh tetrahedralize(const Mesh& surface, std::span<const uint8_t> is_root, const TetOptions& options) {
  check_indices_and_numbers(surface, is_root);
  check_closed(surface);
  const Measures m = measure(surface);
  if (!(m.extent > 0) || !std::isfinite(m.extent)) refuse("it has no extent");
  const double thickness = 2 * m.volume / m.area;  // half a rod's diameter, a sheet's thickness
  if (m.volume < 0) refuse("it is oriented inward");
  if (!(thickness > 1e-7 * m.extent)) refuse("it is flat");

  std::vector<uint32_t> source;
  const Mesh prepared = prepare(surface, m, 3e-7 * thickness / m.extent, source);
  // After the jitter: what TetGen will see is what must not cross.
  if (self_intersects(prepared)) refuse("it crosses itself");

  TetGenResult filled = run_tetgen(prepared.positions, prepared.triangles, is_root, options);
  if (!filled.failure.empty()) refuse(filled.failure);
  if (filled.tets.empty()) refuse("TetGen found no inside");

  TetMesh mesh;
  const double scale = m.extent / 0.999;
  for (const Vec3& p : filled.positions) mesh.positions.push_back(m.centre + scale * p);
  for (size_t i = 0; i < source.size(); ++i) mesh.positions[i] = surface.positions[source[i]];
  mesh.tets = std::move(filled.tets);
  mesh.root_faces = std::move(filled.root_faces);
  for (auto& [a, b, c, d] : mesh.tets)  // TetGen counts the other handedness as positive
    if (six_volumes(filled.positions[a], filled.positions[b], filled.positions[c], filled.positions[d]) < 0)
      std::swap(c, d);
  check_result(mesh, m.volume);
  return mesh;
}

}  // namespace liana
