#include "mesher/solids/skins/skin_cut.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mesher/geometry/weld.h"
#include "mesher/solids/sections/slice.h"
#include "mesher/solids/skins/branch_axes.h"
#include "mesher/solids/solidify/cap.h"

namespace liana {
namespace {

constexpr double kSnapAlong = 0.15;  // of an edge: a cut this near to a vertex goes through it,
constexpr double kSnapAcross = 0.1;  // if that is no farther than this part of the branch's diameter

uint64_t edge_key(uint32_t a, uint32_t b) {
  return a < b ? uint64_t{a} << 32 | b : uint64_t{b} << 32 | a;
}

/// Where a branch is cut off.
struct Cut {
  LevelLoop loop;
  double diameter;
  bool snaps = true, dropped = false;
  int below = 0;  // label of what remains below
};

/// Of the plane cuts across the branch, from its crotch outward, the first that stays on it and on triangles
/// that no other cut crosses; else a level line of the distance.
class CutFinder {
 public:
  explicit CutFinder(const SkinField& field) : field_(field), taken_(field.mesh.triangles.size(), 0) {}

  std::optional<LevelLoop> find(const BranchAxis& axis) {
    const std::vector<uint32_t> way = way_down(field_, axis.tip);
    const double f = axis.base, rise = field_.distance[axis.tip] - f, d = axis.diameter;
    const auto level = [&](double height) {
      return loop_across(field_, way, f, [&, height](uint32_t u) { return field_.distance[u] - f - height; });
    };
    const auto near = level(std::min(0.3 * d, 0.2 * rise)), far = level(std::min(1.3 * d, 0.8 * rise));
    if (near && far) {
      const Vec3 from = polygon_moments(polygon_of(*near)).centroid,
                 to = polygon_moments(polygon_of(*far)).centroid, along = (to - from).normalized();
      const double crotch = (field_.mesh.positions[axis.crotch] - from).dot(along);
      for (int step = 1; step <= 24; ++step) {
        const double place = crotch + 0.05 * step * d;
        if (place > (to - from).norm()) break;
        // Around a branch that stands off at right angles f begins below that of the crotch, by its diameter.
        const double lowest = f - 1.2 * d;
        const auto loop = loop_across(field_, way, lowest, [&](uint32_t u) {
          return (field_.mesh.positions[u] - from).dot(along) - place;
        });
        if (loop && accept(*loop, lowest, d)) return loop;
      }
    }
    for (const double height : {0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0}) {
      const auto loop = level(std::min(height * d, 0.8 * height * rise));
      if (loop && accept(*loop, f, d)) return loop;
    }
    return {};
  }

 private:
  bool accept(const LevelLoop& loop, double base, double diameter) {
    if (perimeter(loop) > 1.6 * kPi * diameter) return false;
    for (const EdgeCrossing& c : loop) {
      const Vec3 &low = field_.mesh.positions[c.below], &high = field_.mesh.positions[c.above];
      const double part = (c.point - low).norm() / (high - low).norm();
      const double f = (1 - part) * field_.distance[c.below] + part * field_.distance[c.above];
      if (f < base || taken_[c.triangle]) return false;
    }
    for (const EdgeCrossing& c : loop) taken_[c.triangle] = 1;
    return true;
  }

  const SkinField& field_;
  std::vector<uint8_t> taken_;
};

/// The pieces as a partition of the skin's triangles, some of them split along the cuts.
class Partition {
 public:
  Partition(const SkinField& field, std::vector<Cut>& cuts) : field_(field), cuts_(cuts) {}

  std::vector<SkinPiece> run() {
    for (;;) {
      if (!label_vertices()) continue;
      split_triangles();
      if (loops_are_simple()) break;
    }
    return pieces();
  }

 private:
  struct Crossing {
    uint32_t cut, below, above;
    Vec3 point;
    double part;  // of the way from below to above
    uint32_t vertex = Id<Mesh>::kNone;
  };

  /// Spreads the labels from the root over every edge; 0 is the trunk, k + 1 what lies beyond cut k. False if
  /// a cut does not separate (a handle of the skin): it is dropped, and all has to start again.
  bool label_vertices() {
    const Mesh& mesh = field_.mesh;
    crossings_.clear();
    for (uint32_t k = 0; k < cuts_.size(); ++k)
      if (!cuts_[k].dropped)
        for (const EdgeCrossing& c : cuts_[k].loop) {
          const Vec3 &low = mesh.positions[c.below], &high = mesh.positions[c.above];
          crossings_.emplace(
              edge_key(c.below, c.above),
              Crossing{k, c.below, c.above, c.point, (c.point - low).norm() / (high - low).norm()});
        }
    label_.assign(mesh.positions.size(), -1);
    std::vector<uint32_t> stack{field_.root};
    label_[field_.root] = 0;
    while (!stack.empty()) {
      const uint32_t v = stack.back();
      stack.pop_back();
      for (uint32_t i = field_.first[v]; i < field_.first[v + 1]; ++i)
        for (const uint32_t u : mesh.triangles[field_.around[i]]) {
          if (u == v) continue;
          const auto crossing = crossings_.find(edge_key(u, v));
          int wanted = label_[v];
          if (crossing != crossings_.end()) {
            Cut& cut = cuts_[crossing->second.cut];
            const int beyond = static_cast<int>(crossing->second.cut) + 1;
            if (v == crossing->second.below) {
              if (label_[u] < 0) cut.below = label_[v];
              wanted = beyond;
              if (cut.below != label_[v]) return cut.dropped = true, false;
            } else {
              wanted = cut.below;
              if (label_[v] != beyond) return cut.dropped = true, false;
            }
          }
          if (label_[u] >= 0 && label_[u] != wanted) return drop_any(crossing), false;
          if (label_[u] < 0) label_[u] = wanted, stack.push_back(u);
        }
    }
    return true;
  }

  using Found = std::unordered_map<uint64_t, Crossing>::iterator;
  void drop_any(Found crossing) {
    if (crossing != crossings_.end()) {
      cuts_[crossing->second.cut].dropped = true;
      return;
    }
    for (size_t k = cuts_.size(); k-- > 0;)  // the last one that is left: the finest
      if (!cuts_[k].dropped) {
        cuts_[k].dropped = true;
        return;
      }
  }

  /// Vertices so near to a cut that it goes through them.
  void snap() {
    on_cut_.assign(field_.mesh.positions.size(), -1);
    for (auto& [key, c] : crossings_) {
      const Cut& cut = cuts_[c.cut];
      const double length = (field_.mesh.positions[c.above] - field_.mesh.positions[c.below]).norm();
      const auto near = [&](double part) {
        return part < 1e-3 || (cut.snaps && part < kSnapAlong && part * length < kSnapAcross * cut.diameter);
      };
      if (near(c.part))
        on_cut_[c.below] = static_cast<int>(c.cut);
      else if (near(1 - c.part))
        on_cut_[c.above] = static_cast<int>(c.cut);
    }
  }

  void split_triangles() {
    snap();
    positions_ = field_.mesh.positions;
    triangles_.clear();
    labels_.clear();
    for (auto& [key, c] : crossings_) c.vertex = Id<Mesh>::kNone;
    for (const Triangle& t : field_.mesh.triangles) {
      const Crossing* any = nullptr;
      for (int k = 0; k < 3 && !any; ++k) {
        const auto found = crossings_.find(edge_key(t[k], t[(k + 1) % 3]));
        if (found != crossings_.end()) any = &found->second;
      }
      if (any)
        split(t, static_cast<int>(any->cut));
      else
        add(t, label_[t[0]]);
    }
  }

  void add(const Triangle& t, int label) {
    triangles_.push_back(t);
    labels_.push_back(label);
  }

  uint32_t point_on(uint32_t a, uint32_t b) {
    Crossing& c = crossings_.at(edge_key(a, b));
    if (c.vertex == Id<Mesh>::kNone) {
      c.vertex = static_cast<uint32_t>(positions_.size());
      positions_.push_back(c.point);
    }
    return c.vertex;
  }

  void split(const Triangle& t, int cut) {
    const int beyond = cut + 1, below = cuts_[cut].below;
    const auto side = [&](uint32_t v) { return on_cut_[v] == cut ? 0 : label_[v] == beyond ? 1 : -1; };
    const auto label = [&](int s) { return s > 0 ? beyond : below; };
    const std::array<int, 3> s = {side(t[0]), side(t[1]), side(t[2])};
    const int highest = *std::max_element(s.begin(), s.end()), lowest = *std::min_element(s.begin(), s.end());
    if (highest <= 0 || lowest >= 0) return add(t, label(highest));
    const auto zero = std::find(s.begin(), s.end(), 0) - s.begin();
    if (zero < 3) {
      const uint32_t o = t[zero], p = t[(zero + 1) % 3], q = t[(zero + 2) % 3], m = point_on(p, q);
      add({o, p, m}, label(s[(zero + 1) % 3]));
      add({o, m, q}, label(s[(zero + 2) % 3]));
      return;
    }
    const int lone = s[0] + s[1] + s[2] > 0 ? -1 : 1;
    const auto k = std::find(s.begin(), s.end(), lone) - s.begin();
    const uint32_t o = t[k], p = t[(k + 1) % 3], q = t[(k + 2) % 3], m = point_on(o, p), n = point_on(o, q);
    add({o, m, n}, label(lone));
    if ((positions_[m] - positions_[q]).squaredNorm() <= (positions_[n] - positions_[p]).squaredNorm()) {
      add({m, p, q}, label(-lone));
      add({m, q, n}, label(-lone));
    } else {
      add({m, p, n}, label(-lone));
      add({p, q, n}, label(-lone));
    }
  }

  /// Every cut must leave one simple loop on the side beyond; one that does not is done again without
  /// snapping, then dropped.
  bool loops_are_simple() {
    rims_.assign(cuts_.size(), {});
    std::unordered_map<uint64_t, int> owner;  // of directed edges
    for (size_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k)
        owner[uint64_t{triangles_[i][k]} << 32 | triangles_[i][(k + 1) % 3]] = labels_[i];
    std::vector<std::unordered_map<uint32_t, uint32_t>> next(cuts_.size());
    std::vector<size_t> edges(cuts_.size(), 0);
    for (size_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const uint32_t a = triangles_[i][k], b = triangles_[i][(k + 1) % 3];
        const int own = labels_[i], other = owner[uint64_t{b} << 32 | a];
        if (own == other || own == 0 || cuts_[own - 1].below != other) continue;
        next[own - 1][a] = b;
        ++edges[own - 1];
      }
    bool simple = true;
    for (size_t k = 0; k < cuts_.size(); ++k) {
      if (cuts_[k].dropped) continue;
      std::vector<uint32_t>& rim = rims_[k];
      if (!next[k].empty()) {
        uint32_t start = next[k].begin()->first;
        for (const auto& [a, b] : next[k]) start = std::min(start, a);
        uint32_t v = start;
        do {
          rim.push_back(v);
          const auto step = next[k].find(v);
          v = step == next[k].end() ? Id<Mesh>::kNone : step->second;
        } while (v != start && v != Id<Mesh>::kNone && rim.size() <= edges[k]);
        if (v == start && rim.size() == edges[k] && rim.size() >= 3) continue;
      }
      simple = false;
      (cuts_[k].snaps ? cuts_[k].snaps = false : cuts_[k].dropped = true);
    }
    return simple;
  }

  /// In the order of the cuts, which is parents first.
  std::vector<SkinPiece> pieces() {
    std::vector<int> place(cuts_.size() + 1, 0);
    std::vector<Mesh> surfaces(1);
    std::vector<int> parent{-1};
    for (size_t k = 0; k < cuts_.size(); ++k) {
      if (cuts_[k].dropped) continue;
      place[k + 1] = static_cast<int>(surfaces.size());
      parent.push_back(cuts_[k].below);
      surfaces.emplace_back();
    }
    for (size_t i = 0; i < triangles_.size(); ++i)
      surfaces[place[labels_[i]]].triangles.push_back(triangles_[i]);
    Mesh all{positions_, {}};
    for (size_t k = 0; k < cuts_.size(); ++k) {
      if (cuts_[k].dropped) continue;
      const size_t count = add_lid(all, rims_[k]);
      for (size_t i = all.triangles.size() - count; i < all.triangles.size(); ++i) {
        const Triangle t = all.triangles[i];
        surfaces[place[k + 1]].triangles.push_back(t);
        surfaces[place[cuts_[k].below]].triangles.push_back({t[0], t[2], t[1]});
      }
    }
    std::vector<SkinPiece> result;
    for (size_t p = 0; p < surfaces.size(); ++p)
      result.push_back(
          {local(all.positions, surfaces[p].triangles), parent[p] < 0 ? -1 : place[parent[p]], 0, 0});
    return result;
  }

  /// compacted() looks at every vertex of the whole for each piece; this only at the piece's.
  static Mesh local(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    Mesh mesh;
    std::unordered_map<uint32_t, uint32_t> place;
    for (const Triangle& t : triangles) {
      Triangle moved;
      for (int k = 0; k < 3; ++k) {
        const auto [it, is_new] = place.try_emplace(t[k], static_cast<uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(positions[t[k]]);
        moved[k] = it->second;
      }
      mesh.triangles.push_back(moved);
    }
    return mesh;
  }

  const SkinField& field_;
  std::vector<Cut>& cuts_;
  std::unordered_map<uint64_t, Crossing> crossings_;  // by edge
  std::vector<int> label_, on_cut_;                   // per vertex of the skin
  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
  std::vector<int> labels_;  // per triangle
  std::vector<std::vector<uint32_t>>
      rims_;  // per cut: border of what lies beyond, in its triangles' direction
};

}  // namespace

bool is_branching_skin(const Mesh& shell) {
  SkinField field;
  return make_skin_field(shell, field) && find_branch_axes(field).size() > 1;
}

std::vector<SkinPiece> cut_skin(const Mesh& shell) {
  SkinField field;
  if (!make_skin_field(shell, field)) return {{compacted(shell), -1, 0, 0}};
  std::vector<Cut> cuts;
  CutFinder finder(field);
  for (const BranchAxis& axis : find_branch_axes(field)) {
    if (axis.parent < 0) continue;
    if (auto loop = finder.find(axis)) cuts.push_back({std::move(*loop), axis.diameter});
  }
  std::vector<SkinPiece> pieces = Partition(field, cuts).run();
  pieces[0].lost_area = field.lost_area, pieces[0].lost_volume = field.lost_volume;
  return pieces;
}

}  // namespace liana
