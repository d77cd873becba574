#include "mesher/solids/skins/branch_axes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesher/base/error.h"
#include "mesher/geometry/disjoint_sets.h"
#include "mesher/geometry/weld.h"
#include "mesher/plant/segmented_plant.h"
#include "mesher/solids/repair/clean_shell.h"
#include "mesher/solids/repair/mend.h"
#include "mesher/solids/sections/slice.h"
#include "mesher/solids/solidify/cap.h"
#include "mesher/solids/solidify/geodesic.h"
#include "mesher/solids/solidify/parent_surface.h"
#include "mesher/solids/solidify/root_interface.h"

namespace liana {
namespace {

/// A side branch stands out by more than its thickness; what is flatter than this is a lobe of a leaf, not a
/// branch (4π area / perimeter²: circle 1, square 0.79, an ellipse of 1 : 10 0.3).
constexpr double kStub = 1.0, kLeastRoundness = 0.2;

/// The joining of superlevel sets, vertex by vertex from the highest down.
class MergeTree {
 public:
  explicit MergeTree(const SkinField& field)
      : field_(field), rank_(field.distance.size()), sets_(rank_.size()) {
    order_.resize(rank_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    // Equal distances are ordered by index, so that no two vertices are equally high.
    std::sort(order_.begin(), order_.end(), [&](uint32_t a, uint32_t b) {
      return std::tie(field_.distance[a], a) > std::tie(field_.distance[b], b);
    });
    for (uint32_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = i;
    axis_of_.assign(rank_.size(), -1);
  }

  std::vector<BranchAxis> run() {
    for (const uint32_t v : order_) add(v);
    // The last one standing is the trunk. Saddles fall as the sweep goes on: in reverse, parents come first.
    std::vector<int> sequence;
    const int trunk = axis_of_[sets_.find(order_.back())];
    axes_[trunk].parent = -1;
    sequence.push_back(trunk);
    for (size_t i = joined_.size(); i-- > 0;) sequence.push_back(joined_[i]);
    std::vector<int> place(axes_.size(), -1);
    for (size_t i = 0; i < sequence.size(); ++i) place[sequence[i]] = static_cast<int>(i);
    std::vector<BranchAxis> result;
    for (const int i : sequence) {
      result.push_back(axes_[i]);
      if (result.back().parent >= 0) result.back().parent = place[axes_[i].parent];
    }
    return result;
  }

 private:
  struct Arm {
    uint32_t set;        // the component
    uint32_t neighbour;  // of the saddle, in the component
    double rise;         // m, from the saddle to the tip
    double diameter = 0;
    bool is_branch = false;
  };

  void add(uint32_t v) {
    std::vector<Arm> arms;
    for (const uint32_t i : field_.around.of(v))
      for (const uint32_t u : field_.mesh.triangles[i]) {
        if (rank_[u] >= rank_[v]) continue;
        const uint32_t set = sets_.find(u);
        if (std::none_of(arms.begin(), arms.end(), [&](const Arm& a) { return a.set == set; }))
          arms.push_back({set, u, field_.distance[axes_[axis_of_[set]].tip] - field_.distance[v]});
      }
    if (arms.empty()) {  // a tip
      axis_of_[v] = static_cast<int>(axes_.size());
      axes_.push_back({.tip = v});
      return;
    }
    const int axis = arms.size() == 1 ? axis_of_[arms[0].set] : join(v, arms);
    for (const Arm& arm : arms) sets_.unite(arm.set, v);
    axis_of_[sets_.find(v)] = axis;
  }

  /// The axis that goes on below the saddle v; the other branches become its children, the rest is bumps.
  int join(uint32_t v, std::vector<Arm>& arms) {
    std::sort(arms.begin(), arms.end(), [](const Arm& a, const Arm& b) { return a.rise > b.rise; });
    int branches = 0;
    for (Arm& arm : arms) measure(v, arm), branches += arm.is_branch;
    if (branches == 0) return axis_of_[arms[0].set];
    const Arm* main = nullptr;
    double best = -1;
    const Vec3 below = branches > 1 ? direction_below(v, arms) : Vec3::Zero();
    for (const Arm& arm : arms) {
      if (!arm.is_branch) continue;
      const double score = branches > 1 ? fitness(v, arm, below) : 0;
      if (score > best) best = score, main = &arm;
    }
    const int axis = axis_of_[main->set];
    for (const Arm& arm : arms) {
      if (!arm.is_branch || &arm == main) continue;
      BranchAxis& side = axes_[axis_of_[arm.set]];
      side.crotch = v, side.base = field_.distance[v], side.diameter = arm.diameter, side.parent = axis;
      joined_.push_back(axis_of_[arm.set]);
    }
    return axis;
  }

  /// How thick the arm is just above the saddle.
  void measure(uint32_t v, Arm& arm) const {
    if (!(arm.rise > 1e-6 * field_.distance[order_.front()])) return;
    const double level = field_.distance[v];
    const VertexValue value = [&](uint32_t u) {
      const double over = field_.distance[u] - level;
      return rank_[u] < rank_[v] ? std::max(over, 0.0) : std::min(over, -1e-300);
    };
    const auto loop = trace_loop(field_.mesh, field_.adjacency, value, v, arm.neighbour,
                                 field_.triangle_at_edge(v, arm.neighbour));
    if (!loop) return;
    const double around = perimeter(*loop);
    arm.diameter = around / kPi;
    const double area = polygon_moments(polygon_of(*loop)).area;
    arm.is_branch = arm.rise > kStub * arm.diameter && 4 * kPi * area > kLeastRoundness * around * around;
  }

  struct Ring {
    Vec3 middle;
    double diameter;  // m; 0 if there is no ring
  };
  Ring ring(const std::vector<uint32_t>& way, double base, double level, const Vec3& otherwise) const {
    const auto loop = loop_across(field_, way, base, [&](uint32_t u) { return field_.distance[u] - level; });
    if (!loop) return {otherwise, 0};
    const PolygonMoments moments = polygon_moments(polygon_of(*loop));
    return {moments.area > 0 ? moments.centroid : otherwise, perimeter(*loop) / kPi};
  }

  Vec3 direction_below(uint32_t v, const std::vector<Arm>& arms) const {
    double thickest = 0;
    for (const Arm& arm : arms) thickest = std::max(thickest, arm.diameter);
    const double f = field_.distance[v];
    const std::vector<uint32_t> way = way_down(field_, v);
    const Ring high = ring(way, 0, f - 0.5 * thickest, field_.mesh.positions[v]);
    const Ring low = ring(way, 0, std::max(0.05 * f, f - 1.5 * thickest), field_.mesh.positions[field_.root]);
    return (high.middle - low.middle).normalized();
  }

  /// Thick and straight. At the crotch itself the level lines are oblique, most on the arm that turns most:
  /// thickness is taken where the arm stands free.
  double fitness(uint32_t v, const Arm& arm, const Vec3& below) const {
    const uint32_t tip = axes_[axis_of_[arm.set]].tip;
    const std::vector<uint32_t> way = way_down(field_, tip);
    const double f = field_.distance[v], d = arm.diameter;
    const Ring low = ring(way, f, f + std::min(0.3 * d, 0.3 * arm.rise), field_.mesh.positions[v]);
    const Ring high = ring(way, f, f + std::min(1.3 * d, 0.8 * arm.rise), field_.mesh.positions[tip]);
    const double thickness = high.diameter > 0 ? std::min(d, high.diameter) : d;
    return thickness * (0.5 + 0.5 * below.dot((high.middle - low.middle).normalized()));
  }

  const SkinField& field_;
  std::vector<uint32_t> order_, rank_;  // highest first
  DisjointSets sets_;                   // components of what lies above
  std::vector<int> axis_of_;            // per set
  std::vector<BranchAxis> axes_;
  std::vector<int> joined_;
};

/// Of the area. A skin that would lose more is left whole: the repair ladder mends it and says so.
constexpr double kMostLost = 0.02;

bool closed_skin(const Mesh& shell, SkinField& field) {
  Mesh& skin = field.mesh;
  Adjacency& adjacency = field.adjacency;
  double lost_volume = 0;  // m³
  if (shell.triangles.size() < 8) return false;
  skin = compacted(shell);
  adjacency = find_adjacency(skin);
  if (!adjacency.manifold || !adjacency.oriented) {
    try {
      const Mended mended = mend(skin);
      CleanShell cleaned = clean_shell(mended.mesh, "skin");
      if (mended.dropped > kMostLost || cleaned.kept < 1 - kMostLost) return false;
      field.lost_area = 1 - (1 - mended.dropped) * cleaned.kept;
      lost_volume = mended.dropped_volume + cleaned.lost_volume;
      skin = std::move(cleaned.mesh);
    } catch (const Error&) {
      return false;
    }
    adjacency = find_adjacency(skin);
  }
  if (!adjacency.closed) {
    for (const std::vector<uint32_t>& loop : border_loops(skin, adjacency)) add_lid(skin, loop);
    adjacency = find_adjacency(skin);
    if (!adjacency.manifold || !adjacency.oriented || !adjacency.closed) return false;
  }
  uint32_t parts = 0;
  connected_parts(adjacency, &parts);
  if (parts != 1) return false;
  if (signed_volume(skin) < 0) {
    for (Triangle& t : skin.triangles) std::swap(t[1], t[2]);
    adjacency = find_adjacency(skin);
  }
  field.lost_volume = lost_volume / signed_volume(skin);
  return true;
}

}  // namespace

uint32_t SkinField::triangle_at_edge(uint32_t a, uint32_t b) const {
  for (const uint32_t i : around.of(a)) {
    const Triangle& t = mesh.triangles[i];
    if (t[0] == b || t[1] == b || t[2] == b) return i;
  }
  return Adjacency::kNone;
}

bool make_skin_field(const Mesh& shell, SkinField& field) {
  if (!closed_skin(shell, field)) return false;
  const Mesh& mesh = field.mesh;
  SegmentedPlant ground;
  ground.domains.emplace_back();
  const ParentSurface support(ground, DomainId(0));
  const std::vector<uint8_t> is_root = root_end(mesh, field.adjacency, support);
  std::vector<uint8_t> source(mesh.positions.size(), 0);
  for (size_t i = 0; i < is_root.size(); ++i)
    if (is_root[i])
      for (const uint32_t v : mesh.triangles[i]) source[v] = 1, field.root = v;
  field.distance = geodesic_distance(mesh, source);
  for (double& d : field.distance)
    if (!std::isfinite(d)) d = 0;  // of vertices that no triangle uses
  field.around = VertexTriangles(mesh);
  return true;
}

std::vector<BranchAxis> find_branch_axes(const SkinField& field) {
  return MergeTree(field).run();
}

std::vector<uint32_t> way_down(const SkinField& field, uint32_t from) {
  std::vector<uint32_t> way{from};
  for (uint32_t v = from;;) {
    uint32_t lowest = v;
    for (const uint32_t i : field.around.of(v))
      for (const uint32_t u : field.mesh.triangles[i])
        if (field.distance[u] < field.distance[lowest]) lowest = u;
    if (lowest == v) return way;
    way.push_back(v = lowest);
  }
}

std::optional<LevelLoop> loop_across(const SkinField& field, const std::vector<uint32_t>& way, double base,
                                     const VertexValue& value) {
  std::optional<std::pair<uint32_t, uint32_t>> crossed;  // below, above
  for (size_t i = 0; i + 1 < way.size(); ++i) {
    const double high = value(way[i]), low = value(way[i + 1]);
    if (!(high >= 0 && low < 0)) continue;
    const double f = field.distance[way[i + 1]] +
                     -low / (high - low) * (field.distance[way[i]] - field.distance[way[i + 1]]);
    if (f > base) crossed = {way[i + 1], way[i]};
  }
  if (!crossed) return {};
  return trace_loop(field.mesh, field.adjacency, value, crossed->first, crossed->second,
                    field.triangle_at_edge(crossed->first, crossed->second));
}

}  // namespace liana
