#include "mesher/solids/skins/branch_tubes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"

namespace liana {
namespace {

struct Ring {
  Vec3 centre;
  double radius;
};

/// One axis: the nodes it runs through, root to tip.
struct Axis {
  std::vector<int> nodes;
  int carrier = -1;  // the node it starts on, of another axis
};

std::vector<std::vector<int>> children_of(const PlantGraph& graph) {
  std::vector<std::vector<int>> children(graph.nodes.size());
  for (size_t i = 0; i < graph.nodes.size(); ++i)
    if (graph.nodes[i].parent >= 0) children[graph.nodes[i].parent].push_back(static_cast<int>(i));
  return children;
}

/// The child that goes on from a node, -1 where the axis ends.
int next_on_axis(const PlantGraph& graph, const std::vector<int>& children, int node) {
  const GraphNode& here = graph.nodes[node];
  const Vec3 along =
      here.parent < 0 ? Vec3::Zero() : Vec3((here.position - graph.nodes[here.parent].position).normalized());
  int best = -1;
  double best_radius = 0, best_cosine = 0;
  for (const int child : children) {
    const GraphNode& next = graph.nodes[child];
    if (next.begins_axis) continue;
    const double cosine = along.dot((next.position - here.position).normalized());
    if (best < 0 || next.radius > best_radius || (next.radius == best_radius && cosine > best_cosine))
      best = child, best_radius = next.radius, best_cosine = cosine;
  }
  return best;
}

/// Parents first: an axis comes after the one that carries it.
std::vector<Axis> axes_of(const PlantGraph& graph) {
  const std::vector<std::vector<int>> children = children_of(graph);
  std::vector<Axis> axes;
  for (size_t i = 0; i < graph.nodes.size(); ++i)
    if (graph.nodes[i].parent < 0) axes.push_back({{static_cast<int>(i)}, -1});
  for (size_t a = 0; a < axes.size(); ++a) {
    for (int node = axes[a].nodes.back(); node >= 0;) {
      const int next = next_on_axis(graph, children[node], node);
      for (const int child : children[node])
        if (child != next) axes.push_back({{child}, node});
      if (next >= 0) axes[a].nodes.push_back(next);
      node = next;
    }
  }
  return axes;
}

Vec3 tangent(const std::vector<Ring>& rings, size_t i) {
  Vec3 sum = Vec3::Zero();
  if (i > 0) sum += (rings[i].centre - rings[i - 1].centre).normalized();
  if (i + 1 < rings.size()) sum += (rings[i + 1].centre - rings[i].centre).normalized();
  return sum.norm() > 1e-6 ? Vec3(sum.normalized())
                           : Vec3((rings[i].centre - rings[i - 1].centre).normalized());
}

/// Whether the disc of ring b lies wholly before that of ring a, seen along a's normal, and the other way
/// round.
bool discs_apart(const Ring& a, const Vec3& na, const Ring& b, const Vec3& nb) {
  const double cosine = std::clamp(na.dot(nb), -1.0, 1.0), sine = std::sqrt(1 - cosine * cosine);
  const Vec3 step = b.centre - a.centre;
  return cosine > 0 && na.dot(step) > 1.02 * b.radius * sine && nb.dot(step) > 1.02 * a.radius * sine;
}

/// Leaves out rings until none touch. The first and the last stay.
void thin_out(std::vector<Ring>& rings, size_t& dropped) {
  std::vector<Ring> kept{rings.front()};
  for (size_t i = 1; i < rings.size(); ++i) {
    const bool last = i + 1 == rings.size();
    const double least = std::max(0.5 * std::min(kept.back().radius, rings[i].radius), 1e-9);
    if ((rings[i].centre - kept.back().centre).norm() >= least)
      kept.push_back(rings[i]);
    else if (last && kept.size() > 1)
      kept.back() = rings[i], ++dropped;
    else
      ++dropped;
  }
  rings = std::move(kept);
  // Step back after each removal: its neighbours' tangents have changed.
  for (size_t i = 0; i + 1 < rings.size() && rings.size() > 2;) {
    if (discs_apart(rings[i], tangent(rings, i), rings[i + 1], tangent(rings, i + 1))) {
      ++i;
      continue;
    }
    const size_t gone = i + 2 < rings.size() ? i + 1 : i;
    rings.erase(rings.begin() + static_cast<ptrdiff_t>(gone == 0 ? 1 : gone));
    ++dropped;
    i -= std::min<size_t>(i, 2);
  }
}

/// Rings turned with the axis as little as possible (parallel transport), a fan at the tip.
Mesh tube(const std::vector<Ring>& rings, int sides) {
  Mesh mesh;
  Vec3 normal = tangent(rings, 0), side = normal.unitOrthogonal();
  for (size_t r = 0; r < rings.size(); ++r) {
    const Vec3 next = tangent(rings, r);
    side = Quat::FromTwoVectors(normal, next) * side;
    normal = next;
    side = (side - side.dot(normal) * normal).normalized();
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * kPi * k / sides;
      mesh.positions.push_back(rings[r].centre + rings[r].radius * (std::cos(angle) * side +
                                                                    std::sin(angle) * normal.cross(side)));
    }
  }
  const auto n = static_cast<uint32_t>(sides);
  for (uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t a = r * n + k, b = r * n + (k + 1) % n;
      mesh.triangles.push_back({a, b, a + n});
      mesh.triangles.push_back({b, b + n, a + n});
    }
  const uint32_t tip = static_cast<uint32_t>(rings.size() - 1) * n, middle = tip + n;
  mesh.positions.push_back(rings.back().centre);
  for (uint32_t k = 0; k < n; ++k) mesh.triangles.push_back({tip + k, tip + (k + 1) % n, middle});
  return mesh;
}

std::vector<Ring> rings_of(const PlantGraph& graph, const Axis& axis) {
  std::vector<Ring> rings;
  if (axis.carrier >= 0)
    rings.push_back({graph.nodes[axis.carrier].position,
                     std::min(graph.nodes[axis.carrier].radius, graph.nodes[axis.nodes.front()].radius)});
  for (const int node : axis.nodes) rings.push_back({graph.nodes[node].position, graph.nodes[node].radius});
  return rings;
}

}  // namespace

SegmentedPlant branch_tubes(const PlantGraph& graph, const std::string& file, int sides) {
  require(sides >= 3, "branch_tubes: at least three sides");
  SegmentedPlant plant;
  plant.notes = graph.notes;
  std::vector<DomainId> domain_of(graph.nodes.size());  // of the axis the node is on, or of what carries it
  size_t without_length = 0, dropped = 0;
  for (const Axis& axis : axes_of(graph)) {
    const DomainId carrier = axis.carrier >= 0 ? domain_of[axis.carrier] : DomainId();
    std::vector<Ring> rings = rings_of(graph, axis);
    if (rings.size() > 1) thin_out(rings, dropped);
    double length = 0, widest = 0;
    for (size_t i = 0; i + 1 < rings.size(); ++i) length += (rings[i + 1].centre - rings[i].centre).norm();
    for (const Ring& ring : rings) widest = std::max(widest, ring.radius);
    if (rings.size() < 2 || !(length > widest)) {  // stubs shorter than thick are no branches
      ++without_length;
      for (const int node : axis.nodes) domain_of[node] = carrier;
      continue;
    }
    Domain domain;
    domain.parent = carrier;
    domain.level = carrier.valid() ? plant.domains[carrier.index()].level + 1 : 0;
    domain.name = fmt::format("branch{}", plant.domains.size() + 1);
    domain.group = fmt::format("level{}", domain.level);
    domain.surface = tube(rings, sides);
    for (const int node : axis.nodes) domain_of[node] = DomainId(plant.domains.size());
    plant.domains.push_back(std::move(domain));
  }
  if (plant.domains.empty())
    throw Error(Error::Kind::Input, file + ": none of its axes is longer than it is thick",
                "check the units of its positions and diameters (--unit m, cm or mm)");
  plant.notes.push_back(fmt::format("{} axes became branches of {} sides", plant.domains.size(), sides));
  if (without_length)
    plant.notes.push_back(fmt::format("{} axes shorter than thick left out", without_length));
  if (dropped)
    plant.notes.push_back(fmt::format("{} points too close for a ring of their own left out", dropped));
  return plant;
}

}  // namespace liana
