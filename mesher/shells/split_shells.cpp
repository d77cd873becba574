#include "mesher/shells/split_shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <unordered_map>

#include "mesher/base/memory.h"
#include "mesher/geometry/disjoint_sets.h"
#include "mesher/geometry/edge_key.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"
#include "mesher/io/leaf_names.h"

namespace liana {
namespace {

/// One of the three edges of a triangle; `edge` packs its two ends, the smaller number first.
struct Side {
  uint64_t edge;
  uint32_t triangle;
  uint8_t corner;  // the edge runs from this corner to the next
  bool forward;    // from the smaller number to the larger
};

Side side_of(const Triangle& t, uint32_t triangle, uint8_t corner) {
  const uint32_t a = t[corner], b = t[(corner + 1) % 3];
  return {edge_key(a, b), triangle, corner, a < b};
}

template <class Body>
void for_each_edge(std::vector<Side>& sides, Body body) {
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.edge, a.triangle, a.corner) < std::tie(b.edge, b.triangle, b.corner);
  });
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    body(std::span<Side>(sides.data() + i, end - i));
    i = end;
  }
}

/// The soup on its places, without flat and doubled triangles, and the sets that grow over it.
class Splitter {
 public:
  explicit Splitter(const TriangleSoup& soup) : soup_(soup), sets_(0) {
    Eigen::AlignedBox3d box;
    double reach = 0;
    for (const Vec3& p : soup.positions) box.extend(p), reach = std::max(reach, p.cwiseAbs().maxCoeff());
    // What separate roundings to single precision, or to six digits, leave between copies of one vertex.
    place_ =
        find_places(soup.positions, std::max(2e-7 * reach, 1e-9 * box.diagonal().norm()), mesh_.positions);
    keep_triangles();
    std::map<std::string, uint32_t> objects;
    for (const SoupLabel& label : soup.labels) {
      object_.push_back(objects.try_emplace(label.object, objects.size()).first->second);
      leaf_.push_back(named_as_leaf(label.material) ||
                      (!named_as_branch(label.material) && named_as_leaf(label.object)));
    }
    sets_ = DisjointSets(mesh_.triangles.size());
  }

  Shells split() {
    join_by_number();
    sets_.numbered(&count_), result_.index_parts = count_;
    join_at_seams();
    count_welded();
    collect();
    return std::move(result_);
  }

 private:
  void keep_triangles() {
    std::vector<std::pair<Triangle, uint32_t>> sorted;
    for (uint32_t i = 0; i < soup_.triangles.size(); ++i) {
      Triangle t;
      for (int k = 0; k < 3; ++k) t[k] = place_[soup_.triangles[i][k]];
      std::sort(t.begin(), t.end());
      if (t[0] == t[1] || t[1] == t[2])
        ++result_.flat;
      else
        sorted.push_back({t, i});
    }
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 0; i < sorted.size(); ++i) {
      if (i > 0 && sorted[i].first == sorted[i - 1].first)
        ++result_.doubled;
      else
        kept_.push_back(sorted[i].second);
    }
    std::sort(kept_.begin(), kept_.end());
    for (const uint32_t i : kept_) {
      const Triangle& t = soup_.triangles[i];
      mesh_.triangles.push_back({place_[t[0]], place_[t[1]], place_[t[2]]});
    }
  }

  uint32_t label(uint32_t triangle) const { return soup_.label[kept_[triangle]]; }
  bool same_kind(const Side& a, const Side& b) const {
    return leaf_[label(a.triangle)] == leaf_[label(b.triangle)];
  }
  bool same_object(const Side& a, const Side& b) const {
    return object_[label(a.triangle)] == object_[label(b.triangle)];
  }

  /// Cosine of the angle by which the surface turns from one side to the other: 1 runs straight on.
  double straightness(const Side& a, const Side& b) const {
    const Vec3 m = area_vector(mesh_, mesh_.triangles[a.triangle]),
               n = area_vector(mesh_, mesh_.triangles[b.triangle]);
    const double cosine = m.dot(n) / std::max(m.norm() * n.norm(), 1e-300);
    return a.forward == b.forward ? -cosine : cosine;
  }

  /// Pairs the sides of one edge, the straightest first; `join` takes each pair, the rest are `left`.
  template <class Join>
  void pair_sides(std::span<Side> sides, std::vector<Side>& left, Join join) {
    constexpr size_t kMaxSides = 12;  // more share no surface in any sense
    std::array<bool, kMaxSides> used{};
    size_t pairs = sides.size() <= kMaxSides ? sides.size() / 2 : 0;
    for (; pairs > 0; --pairs) {
      double best = -2;
      std::pair<size_t, size_t> pair{0, 0};
      for (size_t i = 0; i < sides.size(); ++i)
        for (size_t j = i + 1; j < sides.size(); ++j) {
          if (used[i] || used[j] || !same_kind(sides[i], sides[j])) continue;
          const double own = sets_.find(sides[i].triangle) == sets_.find(sides[j].triangle) ? 3 : 0;
          const double value = sides.size() == 2 ? 1 : straightness(sides[i], sides[j]) + own;
          if (value > best) best = value, pair = {i, j};
        }
      if (best < -1.5 || !join(sides[pair.first], sides[pair.second])) break;
      used[pair.first] = used[pair.second] = true;
    }
    for (size_t i = 0; i < sides.size(); ++i)
      if (i >= kMaxSides || !used[i]) left.push_back(sides[i]);
  }

  void join_by_number() {
    std::vector<Side> sides, left;
    sides.reserve(3 * kept_.size());
    for (uint32_t i = 0; i < kept_.size(); ++i)
      for (uint8_t k = 0; k < 3; ++k) sides.push_back(side_of(soup_.triangles[kept_[i]], i, k));
    for_each_edge(sides, [&](std::span<Side> edge) {
      pair_sides(edge, left, [&](const Side& a, const Side& b) {
        sets_.unite(a.triangle, b.triangle);
        return true;
      });
    });
    for (const Side& s : left) open_.push_back(side_of(mesh_.triangles[s.triangle], s.triangle, s.corner));
  }

  void join_at_seams() {
    // A part's own seam closes first: what is left of its border are its true ends.
    std::vector<std::pair<Side, Side>> contacts;
    std::vector<Side> border;
    for_each_edge(open_, [&](std::span<Side> edge) {
      pair_sides(edge, border, [&](const Side& a, const Side& b) {
        if (sets_.find(a.triangle) == sets_.find(b.triangle)) return true;
        if (same_object(a, b)) contacts.push_back({a, b});
        border.push_back(a), border.push_back(b);
        return true;
      });
    });
    join_contacts(contacts, border);
  }

  /// Border sides of one part that hang together by their ends are one loop.
  void join_contacts(const std::vector<std::pair<Side, Side>>& contacts, const std::vector<Side>& border) {
    DisjointSets loops(border.size());
    std::unordered_map<uint64_t, uint32_t> at_place;  // part and place -> side
    std::unordered_map<uint64_t, uint32_t> at_side;   // triangle and corner -> side
    for (uint32_t i = 0; i < border.size(); ++i) {
      const uint64_t part = uint64_t{sets_.find(border[i].triangle)} << 32;
      at_side[uint64_t{border[i].triangle} * 4 + border[i].corner] = i;
      for (const uint64_t place : {border[i].edge >> 32, border[i].edge & 0xffffffff})
        loops.unite(i, at_place.try_emplace(part | place, i).first->second);
    }
    std::vector<uint32_t> sides_of_loop(border.size(), 0);
    std::unordered_map<uint32_t, uint32_t> sides_of_part;
    std::unordered_map<uint32_t, Eigen::AlignedBox3d> loop_box, part_box;
    for (uint32_t i = 0; i < border.size(); ++i) {
      ++sides_of_loop[loops.find(i)];
      ++sides_of_part[sets_.find(border[i].triangle)];
    }
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> shared;  // sides that two loops have in common
    const auto loop_of = [&](const Side& s) {
      return loops.find(at_side[uint64_t{s.triangle} * 4 + s.corner]);
    };
    for (const auto& [a, b] : contacts) {
      ++shared[std::minmax(loop_of(a), loop_of(b))];
      for (const Side& s : {a, b}) part_box[sets_.find(s.triangle)];
    }
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      if (const auto box = part_box.find(sets_.find(t)); box != part_box.end())
        for (const uint32_t v : mesh_.triangles[t]) box->second.extend(mesh_.positions[v]);
    for (const auto& [a, b] : contacts)
      for (const Side& s : {a, b})
        for (const uint64_t place : {s.edge >> 32, s.edge & 0xffffffff})
          loop_box[loop_of(s)].extend(mesh_.positions[place]);

    std::vector<std::pair<uint32_t, uint32_t>> joined;
    for (const auto& [a, b] : contacts) {
      const uint32_t la = loop_of(a), lb = loop_of(b), common = shared[std::minmax(la, lb)];
      const bool whole = common == sides_of_loop[la] && common == sides_of_loop[lb];
      // A lid or a tip: nothing else is open on it, and it stands out by little.
      const auto fills = [&](const Side& s, uint32_t loop) {
        const uint32_t part = sets_.find(s.triangle);
        return sides_of_part[part] == sides_of_loop[loop] &&
               part_box[part].diagonal().norm() <= 3 * loop_box[loop].diagonal().norm();
      };
      if (!whole || fills(a, la) || fills(b, lb)) joined.push_back({a.triangle, b.triangle});
    }
    for (const auto& [a, b] : joined) sets_.unite(a, b);
  }

  void count_welded() {
    DisjointSets welded(mesh_.triangles.size());
    std::vector<Side> sides;
    sides.reserve(3 * kept_.size());
    for (uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      for (uint8_t k = 0; k < 3; ++k) sides.push_back(side_of(mesh_.triangles[i], i, k));
    for_each_edge(sides, [&](std::span<Side> edge) {
      for (const Side& s : edge) welded.unite(s.triangle, edge.front().triangle);
    });
    uint32_t count = 0;
    welded.numbered(&count);
    result_.welded_parts = count;
  }

  void collect() {
    const std::vector<uint32_t> number = sets_.numbered(&count_);
    result_.shells.resize(count_);
    std::vector<std::vector<uint32_t>> triangles(count_);
    for (uint32_t t = 0; t < number.size(); ++t) triangles[number[t]].push_back(t);
    std::vector<uint32_t> local(mesh_.positions.size()), owner(mesh_.positions.size(), Id<Shell>::kNone);
    for (uint32_t s = 0; s < count_; ++s) {
      Mesh& surface = result_.shells[s].surface;
      std::map<uint32_t, size_t> votes;
      for (const uint32_t t : triangles[s]) {
        Triangle moved;
        for (int k = 0; k < 3; ++k) {
          const uint32_t place = mesh_.triangles[t][k];
          if (owner[place] != s) {
            owner[place] = s, local[place] = static_cast<uint32_t>(surface.positions.size());
            surface.positions.push_back(mesh_.positions[place]);
          }
          moved[k] = local[place];
        }
        surface.triangles.push_back(moved);
        ++votes[label(t)];
      }
      result_.shells[s].label = std::max_element(votes.begin(), votes.end(), [](auto& a, auto& b) {
                                  return a.second < b.second;
                                })->first;
    }
  }

  const TriangleSoup& soup_;
  std::vector<uint32_t> place_, kept_;
  std::vector<uint32_t> object_;  // per label
  std::vector<uint8_t> leaf_;     // per label: its names say leaf
  Mesh mesh_;                     // places, and the triangles kept
  DisjointSets sets_;
  std::vector<Side> open_;  // sides without neighbour by number, in places
  uint32_t count_ = 0;
  Shells result_;
};

}  // namespace

Shells split_shells(const TriangleSoup& soup) {
  require_memory(300 * soup.triangles.size(),
                 "splitting " + std::to_string(soup.triangles.size()) + " triangles");
  return Splitter(soup).split();
}

}  // namespace liana
