#include "modal/domains/same_shape.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/hash.h"

namespace liana {
namespace {

constexpr double kVertexTolerance = 2e-3;   // of the thickness: a plate's frequency grows with its thickness
constexpr double kCarriedTolerance = 1e-3;  // of the extent, and of the mass

/// Each mass of `from` must find its own partner.
bool carried_match(const Solid& from, const Solid& to, const Similarity& s, double extent) {
  std::vector<uint8_t> taken(to.carried.size(), 0);
  for (const CarriedMass& a : from.carried) {
    const Vec3 place = s.point(a.position);
    const double mass = a.mass * std::pow(s.scale, 3);
    bool found = false;
    for (size_t i = 0; i < to.carried.size() && !found; ++i) {
      const CarriedMass& b = to.carried[i];
      if (taken[i] || (b.position - place).norm() > kCarriedTolerance * extent) continue;
      if (std::abs(b.mass - mass) > kCarriedTolerance * mass) continue;
      taken[i] = found = true;
    }
    if (!found) return false;
  }
  return true;
}

}  // namespace

ShapeSignature shape_signature(const Solid& solid) {
  const Mesh& mesh = *solid.surface;
  ShapeSignature signature;
  signature.connectivity = hash_span<Triangle>(mesh.triangles, mesh.positions.size());
  signature.connectivity = hash_bytes(solid.is_root.data(), solid.is_root.size(), signature.connectivity);
  const uint64_t carried = solid.carried.size();
  signature.connectivity = hash_bytes(&carried, sizeof carried, signature.connectivity);

  const Vec3 centre = mesh.positions.empty() ? Vec3::Zero() : mean_position(mesh.positions);
  double variance = 0, volume = 0, area = 0;
  for (const Vec3& p : mesh.positions) variance += (p - centre).squaredNorm();
  for (const auto& [a, b, c] : mesh.triangles) {
    if (std::max({a, b, c}) >= mesh.positions.size()) continue;  // tetrahedralize() refuses it by name
    const Vec3 p = mesh.positions[a] - centre, q = mesh.positions[b] - centre, r = mesh.positions[c] - centre;
    volume += p.cross(q).dot(r) / 6;
    area += (q - p).cross(r - p).norm() / 2;
  }
  signature.extent = std::sqrt(variance / std::max<size_t>(1, mesh.positions.size()));
  signature.thickness = 2 * volume / area;
  signature.compactness = std::pow(area, 3) / (volume * volume);
  return signature;
}

std::optional<Similarity> find_similarity(const Solid& from, const Solid& to) {
  const Mesh &a = *from.surface, &b = *to.surface;
  if (a.positions.size() != b.positions.size() || a.triangles != b.triangles) return {};
  if (!std::equal(from.is_root.begin(), from.is_root.end(), to.is_root.begin(), to.is_root.end())) return {};
  if (!(from.taper == to.taper) || from.is_beam != to.is_beam) return {};
  if (from.carried.size() != to.carried.size() || a.positions.empty()) return {};
  const Similarity s = best_similarity(a.positions, b.positions);
  const ShapeSignature size = shape_signature(to);
  const double allowed = kVertexTolerance * size.thickness;
  for (size_t i = 0; i < a.positions.size(); ++i)
    if (!((s.point(a.positions[i]) - b.positions[i]).norm() <= allowed)) return {};  // also for NaN
  if (!carried_match(from, to, s, size.extent)) return {};
  return s;
}

}  // namespace liana
