#include "mesher/solids/solidify/refine_sheet.h"

#include <cmath>
#include <queue>
#include <tuple>

#include "mesher/geometry/edge_key.h"
#include "mesher/geometry/half_edge.h"

namespace liana {
namespace {

constexpr double kAlong = 1 / 8., kAcross = 1 / 4.;  // of the length, of the width
constexpr double kNarrow = 1 / 20.;                  // across over along: a narrower blade bends as a beam
constexpr double kRounding = 1.01;
/// A diagonal alone in its square must be shorter, as in a card of 20 by 8 squares: by the sum of its sides.
constexpr double kDiagonal = 0.9;
/// It is longer than the sides by this, and this much of it goes either way.
constexpr double kLongest = 1.1, kOblique = 0.3;

class Bisection {
 public:
  Bisection(MarkedSurface& surface, double along, double across, double least)
      : surface_(surface), edges_(surface.mesh), along_(along), across_(across), least_(least) {
    for (uint32_t h = 0; h < edges_.half_edge_count(); h += 2) enter(HalfEdge(h));
  }

  int run() {
    int count = 0;
    while (!longest_.empty()) {
      const auto [size, key, edge] = longest_.top();
      longest_.pop();
      if (~key == key_of(edge) && is_too_long(edge)) bisect(edge), ++count;
    }
    surface_.mesh.triangles = edges_.triangles();
    return count;
  }

 private:
  uint64_t key_of(HalfEdge h) const { return edge_key(edges_.from(h), edges_.to(h)); }

  struct Size {
    double along, across;  // of what they may be
    double norm() const { return std::hypot(along, across); }
  };

  Size size_of(HalfEdge h) const {
    const auto [a, b] = edge_ends(key_of(h));  // to the last bit the same from both sides
    const double rise = surface_.distance[a] - surface_.distance[b];
    const double square = (surface_.mesh.positions[a] - surface_.mesh.positions[b]).squaredNorm();
    if (square < least_ * least_) return {0, 0};
    return {std::abs(rise) / along_, std::sqrt(std::max(0.0, square - rise * rise)) / across_};
  }

  void enter(HalfEdge h) {
    const Size size = size_of(h);
    // Coarse enough that rounding makes no difference between copies of a sheet; then by number.
    if (size.along + size.across > kDiagonal)
      longest_.push({std::lround(64 * std::log2(size.norm())), ~key_of(h), edges_.first_side(h)});
  }

  bool is_too_long(HalfEdge h) const {
    const Size size = size_of(h);
    if (size.norm() > kRounding) return true;
    if (std::min(size.along, size.across) < kOblique * size.norm()) return false;
    for (const HalfEdge side : {h, edges_.opposite(h)}) {
      if (edges_.triangle(side) == HalfEdgeMesh::kNone) return false;
      const HalfEdge second = edges_.next(side);
      for (const HalfEdge other : {second, edges_.next(second)})
        if (size.norm() < kLongest * size_of(other).norm()) return false;
    }
    return true;
  }

  void bisect(HalfEdge h) {
    if (edges_.from(h) > edges_.to(h)) h = edges_.opposite(h);
    const uint32_t a = edges_.from(h), b = edges_.to(h);
    std::vector<Vec3>& positions = surface_.mesh.positions;
    const auto middle = static_cast<uint32_t>(positions.size());
    positions.push_back((positions[a] + positions[b]) / 2);
    surface_.distance.push_back((surface_.distance[a] + surface_.distance[b]) / 2);
    const HalfEdge first = edges_.first_side(h);
    for (const HalfEdge side : {first, edges_.opposite(first)})
      if (const uint32_t halved = edges_.triangle(side); halved != HalfEdgeMesh::kNone)
        surface_.is_root.push_back(surface_.is_root[halved]);
    edges_.split(h, middle);
    for (const HalfEdge out : edges_.leaving(edges_.opposite(h))) enter(out);
  }

  MarkedSurface& surface_;
  HalfEdgeMesh edges_;
  double along_, across_, least_;
  std::priority_queue<std::tuple<long, uint64_t, HalfEdge>> longest_;  // size, complement of the key
};

}  // namespace

int refine_sheet(MarkedSurface& surface, double length, double least) {
  const double along = kAlong * length, width = surface_area(surface.mesh) / length;
  return Bisection(surface, along, std::max(kAcross * width, kNarrow * along), least).run();
}

}  // namespace liana
