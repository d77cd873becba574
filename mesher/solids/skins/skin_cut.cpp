#include "mesher/solids/skins/skin_cut.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mesher/geometry/edge_key.h"
#include "mesher/geometry/split_triangle.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/skins/cut_finder.h"
#include "mesher/solids/solidify/cap.h"

namespace liana {
namespace {

constexpr double kSnapAlong = 0.15;  // of an edge: a cut this near to a vertex goes through it,
constexpr double kSnapAcross = 0.1;  // if that is no farther than this part of the branch's diameter

/// Where a branch is cut off.
struct Cut {
  LevelLoop loop;
  double diameter;
  bool snaps = true, dropped = false;
  int below = 0;  // label of what remains below
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
      for (const uint32_t i : field_.around.of(v))
        for (const uint32_t u : mesh.triangles[i]) {
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
    const auto shorter = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
      return (positions_[a] - positions_[b]).squaredNorm() <= (positions_[c] - positions_[d]).squaredNorm();
    };
    split_triangle(
        t, s, [&](uint32_t a, uint32_t b) { return point_on(a, b); }, shorter,
        [&](const Triangle& part, int on) { add(part, label(on)); });
  }

  /// Every cut must leave one simple loop on the side beyond; one that does not is done again without
  /// snapping, then dropped.
  bool loops_are_simple() {
    rims_.assign(cuts_.size(), {});
    std::unordered_map<uint64_t, int> owner;  // of directed edges
    for (size_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k)
        owner[directed_edge_key(triangles_[i][k], triangles_[i][(k + 1) % 3])] = labels_[i];
    std::vector<std::unordered_map<uint32_t, uint32_t>> next(cuts_.size());
    std::vector<size_t> edges(cuts_.size(), 0);
    for (size_t i = 0; i < triangles_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const uint32_t a = triangles_[i][k], b = triangles_[i][(k + 1) % 3];
        const int own = labels_[i], other = owner[directed_edge_key(b, a)];
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
