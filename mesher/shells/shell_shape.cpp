#include "mesher/shells/shell_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>

#include "mesher/geometry/disjoint_sets.h"
#include "mesher/geometry/mesh_checks.h"

namespace liana {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;

/// Vertices and the edges between them, as rows of neighbours.
struct EdgeGraph {
  std::vector<Edge> edges;         // each once
  std::vector<uint8_t> triangles;  // per edge, how many it has (at most 255)
  std::vector<uint32_t> first, neighbours;

  explicit EdgeGraph(const Mesh& mesh) {
    std::vector<Edge> all;
    all.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) all.push_back(std::minmax(t[k], t[(k + 1) % 3]));
    std::sort(all.begin(), all.end());
    for (const Edge& edge : all) {
      if (!edges.empty() && edges.back() == edge) {
        triangles.back() = static_cast<uint8_t>(std::min(triangles.back() + 1, 255));
      } else {
        edges.push_back(edge), triangles.push_back(1);
      }
    }
    first.assign(mesh.positions.size() + 1, 0);
    for (const auto& [a, b] : edges) ++first[a + 1], ++first[b + 1];
    for (size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
    neighbours.resize(2 * edges.size());
    std::vector<uint32_t> at(first.begin(), first.end() - 1);
    for (const auto& [a, b] : edges) neighbours[at[a]++] = b, neighbours[at[b]++] = a;
  }

  /// Shortest ways along edges from the sources; infinite where there is none.
  std::vector<double> distances(const Mesh& mesh, const std::vector<uint32_t>& sources) const {
    std::vector<double> distance(mesh.positions.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, uint32_t>, std::vector<std::pair<double, uint32_t>>, std::greater<>>
        queue;
    for (const uint32_t v : sources) distance[v] = 0, queue.push({0, v});
    while (!queue.empty()) {
      const auto [way, v] = queue.top();
      queue.pop();
      if (way > distance[v]) continue;
      for (uint32_t i = first[v]; i < first[v + 1]; ++i) {
        const uint32_t next = neighbours[i];
        const double longer = way + (mesh.positions[next] - mesh.positions[v]).norm();
        if (longer < distance[next]) distance[next] = longer, queue.push({longer, next});
      }
    }
    return distance;
  }
};

/// A connected stretch of border.
struct Rim {
  std::vector<uint32_t> vertices;
  Vec3 centre = Vec3::Zero();
  double radius = 0, lid = 0;
};

std::vector<Rim> rims_of(const Mesh& mesh, const EdgeGraph& graph) {
  std::vector<Edge> border;
  for (size_t i = 0; i < graph.edges.size(); ++i)
    if (graph.triangles[i] == 1) border.push_back(graph.edges[i]);
  std::map<uint32_t, uint32_t> local;
  for (const auto& [a, b] : border) local.try_emplace(a, local.size()), local.try_emplace(b, local.size());
  DisjointSets sets(local.size());
  for (const auto& [a, b] : border) sets.unite(local[a], local[b]);
  uint32_t count = 0;
  const std::vector<uint32_t> number = sets.numbered(&count);
  std::vector<Rim> rims(count);
  for (const auto& [vertex, l] : local) rims[number[l]].vertices.push_back(vertex);
  for (Rim& rim : rims) {
    for (const uint32_t v : rim.vertices) rim.centre += mesh.positions[v] / double(rim.vertices.size());
    for (const uint32_t v : rim.vertices)
      rim.radius += (mesh.positions[v] - rim.centre).norm() / double(rim.vertices.size());
  }
  for (const auto& [a, b] : border) {
    Rim& rim = rims[number[local[a]]];
    rim.lid += (mesh.positions[a] - rim.centre).cross(mesh.positions[b] - rim.centre).norm() / 2;
  }
  std::sort(rims.begin(), rims.end(), [](const Rim& a, const Rim& b) { return a.radius > b.radius; });
  return rims;
}

uint32_t farthest(const std::vector<double>& distance) {
  uint32_t best = 0;
  for (uint32_t v = 0; v < distance.size(); ++v)
    if (std::isfinite(distance[v]) && !(distance[v] <= distance[best])) best = v;
  return best;
}

/// The ends of a sheet's long axis, and of its wide one, which may be as long.
std::vector<ShellEnd> sheet_axis_ends(const Mesh& mesh, const Vec3& centre) {
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : mesh.positions) spread += (p - centre) * (p - centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);
  std::vector<ShellEnd> ends;
  double longest = 0;
  for (const int column : {2, 1}) {
    const Vec3 axis = axes.eigenvectors().col(column);
    double low = 0, high = 0;
    for (const Vec3& p : mesh.positions)
      low = std::min(low, axis.dot(p - centre)), high = std::max(high, axis.dot(p - centre));
    longest = std::max(longest, high - low);
    for (const double end : {low, high}) {
      const auto at_end = [&](const Vec3& p) {
        return std::abs(axis.dot(p - centre) - end) <= 0.1 * (high - low);
      };
      Vec3 sum = Vec3::Zero();
      double weight = 0, radius = 0;
      for (const Vec3& p : mesh.positions)
        if (at_end(p)) sum += p, ++weight;
      for (const Vec3& p : mesh.positions)
        if (at_end(p)) radius = std::max(radius, (p - sum / weight).norm());
      const double doubt = column == 2 ? 0 : 0.7 + 0.1 - 0.7 * (high - low) / std::max(longest, 1e-300);
      ends.push_back({sum / weight, radius, 0, doubt});
    }
  }
  return ends;
}

/// Where a sheet may be attached: the ends of its axes; of a card of few edges also the middle of each edge
/// and each sharp corner, the less likely the nearer it is to the card's middle.
std::vector<ShellEnd> sheet_ends(const Mesh& mesh, const EdgeGraph& graph) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : mesh.positions) centre += p / double(mesh.positions.size());
  std::vector<ShellEnd> ends = sheet_axis_ends(mesh, centre);
  std::vector<Edge> border;
  for (size_t i = 0; i < graph.edges.size(); ++i)
    if (graph.triangles[i] == 1) border.push_back(graph.edges[i]);
  constexpr size_t kFewEdges = 12;
  if (border.empty() || border.size() > kFewEdges) return ends;
  double widest = 0;
  std::map<uint32_t, Vec3> corner;  // sum of unit directions along the two edges
  for (const auto& [a, b] : border) {
    const Vec3 along = (mesh.positions[b] - mesh.positions[a]).normalized();
    corner.try_emplace(a, Vec3::Zero()).first->second += along;
    corner.try_emplace(b, Vec3::Zero()).first->second -= along;
    widest = std::max(widest, ((mesh.positions[a] + mesh.positions[b]) / 2 - centre).norm());
  }
  for (const auto& [a, b] : border) {
    const Vec3 middle = (mesh.positions[a] + mesh.positions[b]) / 2;
    const double doubt = 0.3 * (1 - (middle - centre).norm() / std::max(widest, 1e-300));
    ends.push_back({middle, (mesh.positions[b] - mesh.positions[a]).norm() / 2, 0, doubt});
  }
  for (const auto& [vertex, inward] : corner)
    if (inward.norm() > 1.53)  // 2 cos(40°): sharper than 80°
      ends.push_back({mesh.positions[vertex], 0.01 * widest, 0, 0.1});
  return ends;
}

struct Node {
  Vec3 centre = Vec3::Zero();
  double along = 0, radius = 0, count = 0;
};

/// Bones of a body from its distances; node_of takes the node of every vertex.
std::vector<Bone> skeleton(const Mesh& mesh, const EdgeGraph& graph, const std::vector<double>& distance,
                           double length, double radius, std::vector<uint32_t>& node_of,
                           std::vector<Node>& nodes) {
  const double levels = std::clamp(std::floor(length / (1.5 * radius)), 2.0, 400.0);
  std::vector<int> level(mesh.positions.size(), -1);
  for (size_t v = 0; v < level.size(); ++v)
    if (std::isfinite(distance[v]))
      level[v] = static_cast<int>(std::min(distance[v] / length * levels, levels - 1));
  DisjointSets sets(level.size());
  for (const auto& [a, b] : graph.edges)
    if (level[a] == level[b]) sets.unite(a, b);
  uint32_t count = 0;
  node_of = sets.numbered(&count);
  nodes.assign(count, {});
  for (size_t v = 0; v < level.size(); ++v) {
    Node& node = nodes[node_of[v]];
    node.centre += mesh.positions[v], node.along += std::min(distance[v], length), ++node.count;
  }
  for (Node& node : nodes) node.centre /= node.count, node.along /= node.count;
  for (size_t v = 0; v < level.size(); ++v) {  // without the spread along the axis
    Node& node = nodes[node_of[v]];
    node.radius += ((mesh.positions[v] - node.centre).squaredNorm() -
                    std::pow(std::min(distance[v], length) - node.along, 2)) /
                   node.count;
  }
  for (Node& node : nodes) node.radius = std::sqrt(std::max(node.radius, 0.0));
  std::vector<Edge> links;
  for (const auto& [a, b] : graph.edges)
    if (node_of[a] != node_of[b]) links.push_back(std::minmax(node_of[a], node_of[b]));
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  std::vector<Bone> bones;
  for (const auto& [a, b] : links)
    bones.push_back(
        {nodes[a].centre, nodes[b].centre, nodes[a].radius, nodes[b].radius, nodes[a].along, nodes[b].along});
  if (bones.empty())
    bones.push_back({nodes[0].centre, nodes[0].centre, nodes[0].radius, nodes[0].radius, 0, 0});
  return bones;
}

/// Whether three bones meet somewhere.
bool forks(const std::vector<Bone>& bones) {
  std::map<std::array<double, 3>, int> at;
  for (const Bone& bone : bones)
    for (const Vec3& p : {bone.from, bone.to})
      if (++at[{p.x(), p.y(), p.z()}] > 2) return true;
  return false;
}

/// Where a closed end is: the middle of the vertices nearest to the extreme.
ShellEnd closed_end(const Mesh& mesh, const std::vector<double>& from_extreme, double along, double reach) {
  ShellEnd end{Vec3::Zero(), 0, along};
  double count = 0;
  for (size_t v = 0; v < from_extreme.size(); ++v)
    if (from_extreme[v] <= reach) end.point += mesh.positions[v], ++count;
  end.point /= std::max(count, 1.0), end.radius = reach;
  return end;
}

/// Volume under lids on all rims, whatever the winding of the lids: fans from the rims' centres.
double capped_volume(const Mesh& mesh, const EdgeGraph& graph, const std::vector<Rim>& rims) {
  double volume = 6 * signed_volume(mesh);
  const Vec3 origin = mesh.positions[mesh.triangles[0][0]];
  std::map<uint32_t, size_t> rim_of;
  for (size_t r = 0; r < rims.size(); ++r)
    for (const uint32_t v : rims[r].vertices) rim_of[v] = r;
  if (rims.empty()) return std::abs(volume) / 6;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Edge edge = std::minmax(t[k], t[(k + 1) % 3]);
      const auto at = std::lower_bound(graph.edges.begin(), graph.edges.end(), edge) - graph.edges.begin();
      if (graph.triangles[at] != 1) continue;
      const Vec3 a = mesh.positions[t[(k + 1) % 3]] - origin, b = mesh.positions[t[k]] - origin;
      volume += a.dot(b.cross(rims[rim_of[t[k]]].centre - origin));
    }
  return std::abs(volume) / 6;
}

}  // namespace

ShellShape shape_of(const Mesh& mesh) {
  ShellShape shape;
  shape.area = surface_area(mesh);
  const EdgeGraph graph(mesh);
  const std::vector<Rim> rims = rims_of(mesh, graph);

  const bool open = !rims.empty();
  std::vector<uint32_t> sources =
      open ? rims[0].vertices : std::vector<uint32_t>{farthest(graph.distances(mesh, {0}))};
  std::vector<double> distance = graph.distances(mesh, sources);
  const uint32_t far = farthest(distance);
  shape.length = std::max(distance[far], 1e-300);

  double lids = 0;
  for (const Rim& rim : rims) lids += rim.lid;
  // Lids over area as in is_sheet; 4π V ℓ / A² is 1 for a round branch, π t / w for a closed leaf of
  // thickness t and width w, and does not mind bends.
  const double roundness =
      4 * kPi * capped_volume(mesh, graph, rims) * shape.length / std::pow(shape.area, 2);
  shape.sheet = open ? lids > 0.57 * shape.area : roundness < 0.3;
  if (shape.sheet) {
    shape.ends = sheet_ends(mesh, graph);
    return shape;
  }

  const double radius = std::max(shape.area / (2 * kPi * shape.length), 1e-3 * shape.length);
  std::vector<uint32_t> node_of;
  std::vector<Node> nodes;
  shape.bones = skeleton(mesh, graph, distance, shape.length, radius, node_of, nodes);
  shape.forks = forks(shape.bones);
  for (const Rim& rim : rims) {
    double along = 0;
    for (const uint32_t v : rim.vertices)
      along += std::min(distance[v], shape.length) / double(rim.vertices.size());
    shape.ends.push_back({rim.centre, rim.radius, along});
  }
  if (!open) shape.ends.push_back(closed_end(mesh, distance, 0, radius));
  double last = 0;
  for (const ShellEnd& end : shape.ends) last = std::max(last, end.along);
  if (last < shape.length - 2 * radius || shape.ends.size() < 2)
    shape.ends.push_back(closed_end(mesh, graph.distances(mesh, {far}), shape.length,
                                    std::max(nodes[node_of[far]].radius, 0.3 * radius)));
  return shape;
}

}  // namespace liana
