#include "mesher/tets/tetrahedralize.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/base/hash.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/tets/slivers.h"

namespace liana {
namespace {

/// TetGen sees the surface at this extent, each vertex moved by up to kJitter of the solid's thickness.
constexpr double kPreparedExtent = 0.999, kJitter = 3e-7;
constexpr double kVolumeTolerance = 1e-6;
/// Of the solid's thickness and volume; see remove_slivers(). Frequencies change by less than 0.1 %.
constexpr double kSliverHeight = 1e-3, kSliverVolume = 1e-4;

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
  for (const auto& [a, b, c] : surface.triangles)
    if (a == b || b == c || c == a) refuse("a triangle uses a vertex twice");
  const Adjacency adjacency = find_adjacency(surface);
  if (!adjacency.manifold || !adjacency.oriented)
    refuse("an edge has more than two triangles, or neighbours of opposite orientation");
  for (size_t i = 0; i < surface.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (adjacency.across[i][k] != Adjacency::kNone) continue;
      const Triangle& t = surface.triangles[i];
      const Vec3 place = (surface.positions[t[k]] + surface.positions[t[(k + 1) % 3]]) / 2;
      refuse(fmt::format("it is open at ({:.4g}, {:.4g}, {:.4g})", place.x(), place.y(), place.z()));
    }
}

/// The vertices in use, scaled to an extent below 1 about the origin and moved by up to `jitter`: regular
/// rings are cospherical, which makes TetGen 15 times slower and leaves slivers.
Mesh prepare(const Mesh& surface, const Measures& m, double jitter, std::vector<uint32_t>& source) {
  Mesh prepared;
  std::vector<uint32_t> index(surface.positions.size(), UINT32_MAX);
  const double scale = kPreparedExtent / m.extent;
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

void orient(TetGenResult& mesh) {  // TetGen counts the other handedness as positive
  const std::vector<Vec3>& p = mesh.positions;
  for (auto& [a, b, c, d] : mesh.tets)
    if (six_volumes(p[a], p[b], p[c], p[d]) < 0) std::swap(c, d);
}

double volume_of(const TetGenResult& mesh) {
  double volume = 0;
  const std::vector<Vec3>& p = mesh.positions;
  for (const auto& [a, b, c, d] : mesh.tets) volume += six_volumes(p[a], p[b], p[c], p[d]) / 6;
  return volume;
}

/// In the prepared mesh's units.
TetGenResult fill(const Mesh& prepared, std::span<const uint8_t> is_root, const TetOptions& options,
                  double volume, double thickness, bool& polished) {
  for (const Polish polish : {Polish::Flips, Polish::Points}) {
    polished = polish == Polish::Points;
    TetGenResult filled = run_tetgen(prepared.positions, prepared.triangles, is_root, options, polish);
    if (!filled.failure.empty()) refuse(filled.failure);
    if (filled.tets.empty()) refuse("TetGen found no inside");
    orient(filled);
    const double found = volume_of(filled);
    if (!(std::abs(found / volume - 1) < kVolumeTolerance))
      refuse(fmt::format("the tetrahedra fill {:.9g} of its volume", found / volume));
    if (remove_slivers(filled, kSliverHeight * thickness, kSliverVolume * volume)) return filled;
  }
  refuse("it is too thin somewhere: tetrahedra without volume cannot be avoided");
}

}  // namespace

TetMesh tetrahedralize(const Mesh& surface, std::span<const uint8_t> is_root, const TetOptions& options) {
  check_indices_and_numbers(surface, is_root);
  check_closed(surface);
  const Measures m = measure(surface);
  if (!(m.extent > 0) || !std::isfinite(m.extent)) refuse("it has no extent");
  const double thickness = 2 * m.volume / m.area;  // half a rod's diameter, a sheet's thickness
  if (thickness < -1e-7 * m.extent) refuse("it is oriented inward");
  if (!(thickness > 1e-7 * m.extent)) refuse("it is flat");

  std::vector<uint32_t> source;
  const Mesh prepared = prepare(surface, m, kJitter * thickness / m.extent, source);
  // After the jitter: what TetGen will see is what must not cross.
  if (self_intersects(prepared)) refuse("it crosses itself");
  const double scale = m.extent / kPreparedExtent;
  TetMesh mesh;
  TetGenResult filled =
      fill(prepared, is_root, options, m.volume / std::pow(scale, 3), thickness / scale, mesh.polished);
  for (const Vec3& p : filled.positions) mesh.positions.push_back(m.centre + scale * p);
  for (size_t i = 0; i < source.size(); ++i) mesh.positions[i] = surface.positions[source[i]];
  mesh.tets = std::move(filled.tets);
  for (const BoundaryFace& f : filled.boundary)
    if (f.is_root) mesh.root_faces.push_back(f.corners);
  const std::vector<Vec3>& p = mesh.positions;
  for (const auto& [a, b, c, d] : mesh.tets)
    if (!(six_volumes(p[a], p[b], p[c], p[d]) > 0)) refuse("it is too thin somewhere");
  return mesh;
}

}  // namespace liana
