#include "mesher/solids/solidify/root_interface.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "mesher/solids/solidify/cap.h"
#include "mesher/solids/solidify/geodesic.h"

namespace liana {
namespace {

std::vector<uint32_t> all_vertices(const Mesh& mesh) {
  std::vector<uint32_t> all(mesh.positions.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

/// The vertex farthest from another along the surface, and the distances of all.
uint32_t farthest(const Mesh& mesh, uint32_t from, std::vector<double>& distance) {
  std::vector<uint8_t> source(mesh.positions.size(), 0);
  source[from] = 1;
  distance = geodesic_distance(mesh, source);
  return static_cast<uint32_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
}

double marked_area(const Mesh& mesh, const std::vector<uint8_t>& marked) {
  double area = 0;
  for (size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) area += area_vector(mesh, mesh.triangles[i]).norm();
  return area;
}

/// Faces that look less than 60° away from `away` within `depth` of the end: where wrinkles stop a flood.
std::vector<uint8_t> end_slab(const Mesh& mesh, const Vec3& end, const Vec3& away, double radius) {
  double last = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : mesh.positions)
    if ((p - end).norm() < 3 * radius) last = std::max(last, (p - end).dot(away));
  std::vector<uint8_t> marked;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 middle = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    marked.push_back((middle - end).norm() < 3 * radius && (middle - end).dot(away) > last - 0.5 * radius &&
                     area_vector(mesh, t).normalized().dot(away) > 0.5);
  }
  return marked;
}

/// Faces connected to the seed over edges that turn by less than 35°, and that look less than 60° away from
/// it.
std::vector<uint8_t> flood_to_crease(const Mesh& mesh, const Adjacency& adjacency, uint32_t seed) {
  const double crease = std::cos(35 * kPi / 180), cone = std::cos(60 * kPi / 180);
  const auto normal = [&](uint32_t i) { return Vec3(area_vector(mesh, mesh.triangles[i]).normalized()); };
  const Vec3 axis = normal(seed);
  std::vector<uint8_t> marked(mesh.triangles.size(), 0);
  std::vector<uint32_t> stack{seed};
  marked[seed] = 1;
  while (!stack.empty()) {
    const uint32_t triangle = stack.back();
    stack.pop_back();
    for (const uint32_t next : adjacency.across[triangle]) {
      if (next == Adjacency::kNone || marked[next]) continue;
      const Vec3 n = normal(next);
      if (n.dot(normal(triangle)) < crease || n.dot(axis) < cone) continue;
      marked[next] = 1;
      stack.push_back(next);
    }
  }
  return marked;
}

/// A hole in the side of a branch looks across it, and the surface goes on past it, away from the tip.
bool is_in_the_side(const Mesh& mesh, const std::vector<uint32_t>& loop) {
  const Vec3 middle = loop_middle(mesh, loop);
  Vec3 normal = Vec3::Zero(), centroid = Vec3::Zero();
  for (size_t i = 0; i < loop.size(); ++i)
    normal += (mesh.positions[loop[i]] - middle).cross(mesh.positions[loop[(i + 1) % loop.size()]] - middle);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const double a = area_vector(mesh, t).norm();
    centroid += a / 3 * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    area += a;
  }
  const Vec3 inward = (centroid / area - middle).normalized();
  if (std::abs(inward.dot(normal.normalized())) > 0.35) return false;  // an end, cut at up to 70°
  std::vector<uint8_t> source(mesh.positions.size(), 0);
  for (const uint32_t v : loop) source[v] = 1;
  const std::vector<double> from_loop = geodesic_distance(mesh, source);
  uint32_t tip = loop[0];
  for (uint32_t v = 0; v < from_loop.size(); ++v)
    if (std::isfinite(from_loop[v]) && from_loop[v] > from_loop[tip]) tip = v;
  std::vector<double> from_tip;
  const uint32_t opposite = farthest(mesh, tip, from_tip);
  return from_tip[opposite] > 1.2 * from_loop[tip];
}

constexpr double kRootStrip = 0.04;  // of a sheet's length

/// Directions a sheet may be long in, from base to tip: both ways along its longest principal axis, or along
/// the sides of one that is about as wide as long.
std::vector<Vec3> long_axes(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops) {
  double area = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // over the area: by the three middles of the edges, exact for triangles
  const Vec3 origin = mesh.positions[loops[0][0]];
  for (const Triangle& t : mesh.triangles) {
    const double a = area_vector(mesh, t).norm();
    area += a;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = (mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]) / 2 - origin;
      first += a / 3 * p, second += a / 3 * p * p.transpose();
    }
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> spread(second / area - first * first.transpose() / (area * area));
  Vec3 u = spread.eigenvectors().col(2), v = spread.eigenvectors().col(1);
  // Square roots 1.15: a card of 1 by 1.15, below which the sides say more than the spread.
  if (spread.eigenvalues()[2] > 1.15 * 1.15 * spread.eigenvalues()[1]) return {u, -u};
  std::complex<double> sides = 0;  // turns by four times the angle: the same for all four sides of a card
  for (const std::vector<uint32_t>& loop : loops)
    for (size_t i = 0; i < loop.size(); ++i) {
      const Vec3 edge = mesh.positions[loop[(i + 1) % loop.size()]] - mesh.positions[loop[i]];
      const std::complex<double> e(edge.dot(u), edge.dot(v));
      if (std::abs(e) > 0) sides += std::pow(e / std::abs(e), 4) * std::abs(e);
    }
  const std::complex<double> turn = std::polar(1., std::arg(sides) / 4);
  const Vec3 x = turn.real() * u + turn.imag() * v, y = turn.real() * v - turn.imag() * u;
  return {x, -x, y, -y};
}

}  // namespace

size_t root_loop(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops,
                 const ParentSurface& support) {
  size_t best = loops.size();
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < loops.size(); ++i) {
    const double depth = support.depth(loop_middle(mesh, loops[i]));
    if (depth < least) {
      least = depth;
      best = i;
    }
  }
  if (best == loops.size()) return best;
  if (is_in_the_side(mesh, loops[best])) return loops.size();
  if (least < 0) return best;  // inside the parent
  // A closed root end lies nearer to the parent than the nearest hole, by more than the hole's width.
  const double width = 2 * std::sqrt(lid_area(mesh, loops[best]) / kPi);
  const uint32_t nearest = support.nearest(mesh, all_vertices(mesh));
  const bool at_loop = support.depth(mesh.positions[nearest]) > least - width;
  return at_loop ? best : loops.size();
}

std::vector<uint8_t> root_end(const Mesh& mesh, const Adjacency& adjacency, const ParentSurface& support) {
  // The nearest vertex may lie anywhere around the foot (the parent's bark cuts through it); the point
  // farthest from the tip is the end itself.
  std::vector<double> from_near, from_tip;
  uint32_t end = support.nearest(mesh, all_vertices(mesh));
  const uint32_t tip = farthest(mesh, end, from_near);
  const uint32_t opposite = farthest(mesh, tip, from_tip);
  if (from_near[opposite] < 0.3 * from_near[tip]) end = opposite;

  Vec3 away = Vec3::Zero();  // from what lies about a tenth of the length up to the end
  const double reach = 0.1 * from_tip[end];
  int count = 0;
  for (size_t v = 0; v < mesh.positions.size(); ++v)
    if (std::abs(from_tip[v] - (from_tip[end] - reach)) < reach / 2) {
      away += mesh.positions[end] - mesh.positions[v];
      ++count;
    }
  if (count == 0) away = mesh.positions[end] - mesh.positions[tip];
  const Vec3 around = away;
  away.normalize();

  uint32_t seed = 0;
  double best = -2;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (std::find(t.begin(), t.end(), end) == t.end()) continue;
    const double looks_away = area_vector(mesh, t).normalized().dot(away);
    if (looks_away > best) {
      best = looks_away;
      seed = i;
    }
  }
  // Mean square radius of what lies about a tenth up: of a tube's outline, r².
  double square = 0;
  for (size_t v = 0; v < mesh.positions.size() && count > 0; ++v)
    if (std::abs(from_tip[v] - (from_tip[end] - reach)) < reach / 2) {
      const Vec3 out = mesh.positions[v] - (mesh.positions[end] - around / count);
      square += (out - out.dot(away) * away).squaredNorm() / count;
    }
  if (best > 0.5) {
    std::vector<uint8_t> flood = flood_to_crease(mesh, adjacency, seed);
    if (marked_area(mesh, flood) > 0.3 * kPi * square) return flood;
    const std::vector<uint8_t> slab = end_slab(mesh, mesh.positions[end], away, std::sqrt(square));
    return marked_area(mesh, slab) > marked_area(mesh, flood) ? slab : flood;
  }
  std::vector<uint8_t> marked;  // a pointed end: the faces at the point
  for (const Triangle& t : mesh.triangles) marked.push_back(std::find(t.begin(), t.end(), end) != t.end());
  return marked;
}

SheetRoot sheet_root(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops,
                     const ParentSurface& support) {
  std::vector<uint32_t> border;
  for (const std::vector<uint32_t>& loop : loops) border.insert(border.end(), loop.begin(), loop.end());
  // A blade may touch its twig anywhere; its base is at an end of its long axis and at the parent.
  Vec3 axis = Vec3::Zero();
  double best = -std::numeric_limits<double>::infinity(), base = 0, length = 0;
  for (const Vec3& candidate : long_axes(mesh, loops)) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const uint32_t v : border) {
      low = std::min(low, mesh.positions[v].dot(candidate));
      high = std::max(high, mesh.positions[v].dot(candidate));
    }
    double height = 0;
    int count = 0;
    for (const uint32_t v : border)
      if (mesh.positions[v].dot(candidate) <= low + kRootStrip * (high - low))
        height += support.height(mesh.positions[v]), ++count;
    if (const double score = high - low - 2 * height / count; score > best)
      best = score, axis = candidate, base = low, length = high - low;
  }
  const auto along = [&](uint32_t v) { return mesh.positions[v].dot(axis) - base; };

  SheetRoot root;
  root.strip = kRootStrip * length;
  bool any = false;
  for (const std::vector<uint32_t>& loop : loops) {
    root.edges.emplace_back();
    for (size_t i = 0; i < loop.size(); ++i) {
      const uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      const double edge = (mesh.positions[a] - mesh.positions[b]).norm();  // the sides rise by more than half
      root.edges.back().push_back(std::max(along(a), along(b)) <= root.strip &&
                                  std::abs(along(a) - along(b)) <= 0.7 * edge);
      any = any || root.edges.back().back();
    }
  }
  if (!any)
    root.point = *std::min_element(border.begin(), border.end(),
                                   [&](uint32_t a, uint32_t b) { return along(a) < along(b); });
  return root;
}

}  // namespace liana
