#include "mesher/solids/solidify/refine_sheet.h"

#include <array>
#include <cmath>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "mesher/geometry/mesh_checks.h"

namespace liana {
namespace {

constexpr double kAlong = 1 / 8., kAcross = 1 / 4.;  // of the length, of the width
constexpr double kNarrow = 1 / 20.;                  // across over along: a narrower blade bends as a beam
constexpr double kRounding = 1.01;
/// A diagonal alone in its square must be shorter, as in a card of 20 by 8 squares: by the sum of its sides.
constexpr double kDiagonal = 0.9;
/// It is longer than the sides by this, and this much of it goes either way.
constexpr double kLongest = 1.1, kOblique = 0.3;
constexpr uint32_t kNone = Adjacency::kNone;

class Bisection {
 public:
  Bisection(MarkedSurface& surface, double along, double across, double least)
      : surface_(surface), along_(along), across_(across), least_(least) {
    const std::vector<Triangle>& triangles = surface.mesh.triangles;
    for (uint32_t i = 0; i < triangles.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        std::array<uint32_t, 2>& two = beside_
                                           .try_emplace(key(triangles[i][k], triangles[i][(k + 1) % 3]),
                                                        std::array<uint32_t, 2>{kNone, kNone})
                                           .first->second;
        (two[0] == kNone ? two[0] : two[1]) = i;
      }
    for (const auto& [edge, two] : beside_) enter(edge);
  }

  int run() {
    int count = 0;
    while (!longest_.empty()) {
      const uint64_t edge = ~std::get<1>(longest_.top());
      longest_.pop();
      if (beside_.contains(edge) && is_too_long(edge)) bisect(edge), ++count;
    }
    return count;
  }

 private:
  static uint64_t key(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

  struct Size {
    double along, across;  // of what they may be
    double norm() const { return std::hypot(along, across); }
  };

  Size size_of(uint64_t edge) const {
    const auto a = static_cast<uint32_t>(edge >> 32), b = static_cast<uint32_t>(edge);
    const double rise = surface_.distance[a] - surface_.distance[b];
    const double square = (surface_.mesh.positions[a] - surface_.mesh.positions[b]).squaredNorm();
    if (square < least_ * least_) return {0, 0};
    return {std::abs(rise) / along_, std::sqrt(std::max(0.0, square - rise * rise)) / across_};
  }

  void enter(uint64_t edge) {
    const Size size = size_of(edge);
    // Coarse enough that rounding makes no difference between copies of a sheet; then by number.
    if (size.along + size.across > kDiagonal)
      longest_.push({std::lround(64 * std::log2(size.norm())), ~edge});
  }

  bool is_too_long(uint64_t edge) const {
    const Size size = size_of(edge);
    if (size.norm() > kRounding) return true;
    if (std::min(size.along, size.across) < kOblique * size.norm()) return false;
    for (const uint32_t triangle : beside_.at(edge)) {
      if (triangle == kNone) return false;
      const Triangle& t = surface_.mesh.triangles[triangle];
      for (int k = 0; k < 3; ++k)
        if (const uint64_t side = key(t[k], t[(k + 1) % 3]);
            side != edge && size.norm() < kLongest * size_of(side).norm())
          return false;
    }
    return true;
  }

  void bisect(uint64_t edge) {
    const auto a = static_cast<uint32_t>(edge >> 32), b = static_cast<uint32_t>(edge);
    const std::array<uint32_t, 2> two = beside_.extract(edge).mapped();
    Mesh& mesh = surface_.mesh;
    const auto middle = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
    surface_.distance.push_back((surface_.distance[a] + surface_.distance[b]) / 2);
    std::array<uint32_t, 2>&near_a = beside_[key(a, middle)] = {kNone, kNone},
                         &near_b = beside_[key(b, middle)] = {kNone, kNone};
    std::vector<uint64_t> fresh{key(a, middle), key(b, middle)};
    for (int side = 0; side < 2; ++side) {
      if (two[side] == kNone) continue;
      const uint32_t old = two[side], added = static_cast<uint32_t>(mesh.triangles.size());
      Triangle t = mesh.triangles[old], u = t;
      uint32_t c = 0;
      for (uint32_t& v : t) {
        if (v == b)
          v = middle;
        else if (v != a)
          c = v;
      }
      for (uint32_t& v : u)
        if (v == a) v = middle;
      mesh.triangles[old] = t;
      mesh.triangles.push_back(u);
      surface_.is_root.push_back(surface_.is_root[old]);
      near_a[side] = old, near_b[side] = added;
      for (uint32_t& beside : beside_.at(key(b, c)))
        if (beside == old) beside = added;
      beside_.emplace(key(middle, c), std::array<uint32_t, 2>{old, added});
      fresh.push_back(key(middle, c));
    }
    for (const uint64_t e : fresh) enter(e);
  }

  MarkedSurface& surface_;
  double along_, across_, least_;
  std::unordered_map<uint64_t, std::array<uint32_t, 2>> beside_;  // triangles of an edge
  std::priority_queue<std::tuple<long, uint64_t>> longest_;       // size, complement of the edge
};

}  // namespace

int refine_sheet(MarkedSurface& surface, double length, double least) {
  const double along = kAlong * length, width = surface_area(surface.mesh) / length;
  return Bisection(surface, along, std::max(kAcross * width, kNarrow * along), least).run();
}

}  // namespace liana
