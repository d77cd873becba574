#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mesher/base/error.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/repair/clean_shell.h"
#include "mesher/solids/sections/centreline.h"
#include "mesher/solids/solidify/cap.h"
#include "mesher/solids/solidify/geodesic.h"
#include "mesher/solids/solidify/grade.h"
#include "mesher/solids/solidify/parent_surface.h"
#include "mesher/solids/solidify/refine_sheet.h"
#include "mesher/solids/solidify/root_interface.h"
#include "mesher/solids/solidify/sheet.h"
#include "mesher/solids/solidify/solid_attempt.h"

namespace liana {
namespace {

/// A closed surface with distances and root, and the two lengths that everything after is measured in.
struct Rooted {
  MarkedSurface surface;
  double length = 0;    ///< m, longest geodesic
  double diameter = 0;  ///< m, of the root interface
  std::string route;
};

/// Distances on the surface from the vertices of the marked triangles.
std::vector<double> distance_from_root(const Mesh& mesh, const std::vector<uint8_t>& is_root) {
  std::vector<uint8_t> source(mesh.positions.size(), 0);
  for (size_t i = 0; i < is_root.size(); ++i)
    if (is_root[i])
      for (const uint32_t v : mesh.triangles[i]) source[v] = 1;
  return geodesic_distance(mesh, source);
}

/// Closes the open ends, turns the surface outward and finds the root on it.
Rooted body(const Mesh& shell, const Adjacency& adjacency, const std::vector<std::vector<uint32_t>>& loops,
            const ParentSurface& support, const std::string& where) {
  Rooted result;
  Mesh& mesh = result.surface.mesh;
  mesh = shell;
  const size_t modelled = mesh.positions.size();
  const size_t root = root_loop(mesh, loops, support);
  std::vector<uint8_t>& is_root = result.surface.is_root;
  is_root.assign(mesh.triangles.size(), 0);
  for (size_t i = 0; i < loops.size(); ++i) is_root.insert(is_root.end(), add_lid(mesh, loops[i]), i == root);
  // V / A^1.5 is 0.14 √(d/ℓ) of a branch and t / (2 √A) of a plate: 1e-7 is thinner than anything that grows.
  const double volume = signed_volume(mesh);
  if (!(std::abs(volume) > 1e-7 * std::pow(surface_area(mesh), 1.5)))
    throw Error(Error::Kind::Input, where + ": its surface encloses no volume",
                "give it thickness, or model it as an open sheet");
  if (volume < 0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    result.route = "+turned-outward";
  }
  result.route = (loops.empty() ? "closed" : "capped") + result.route;
  if (root == loops.size())
    is_root = root_end(mesh, loops.empty() ? adjacency : find_adjacency(mesh), support);

  double root_area = 0;
  for (size_t i = 0; i < is_root.size(); ++i)
    if (is_root[i]) root_area += area_vector(mesh, mesh.triangles[i]).norm();
  result.diameter = 2 * std::sqrt(root_area / kPi);
  result.surface.distance = distance_from_root(mesh, is_root);
  // The lids are ours: the branch is as long as its modelled surface.
  const std::vector<double>& distance = result.surface.distance;
  result.length = *std::max_element(distance.begin(), distance.begin() + static_cast<ptrdiff_t>(modelled));
  if (const int lines = grade(result.surface, result.length, result.diameter))
    result.route += fmt::format("+{}-rings", lines);
  return result;
}

/// Directed border edges.
using Edges = std::set<std::pair<uint32_t, uint32_t>>;

/// The edges at the root of the sheet; a pointed base is cut where its root ends.
Edges root_edges(Mesh& mesh, std::vector<std::vector<uint32_t>> loops, const ParentSurface& support) {
  const SheetRoot found = sheet_root(mesh, loops, support);
  const bool pointed = found.point != Id<Mesh>::kNone;
  const Vec3 point = pointed ? mesh.positions[found.point] : Vec3::Zero();
  constexpr double kSnap = 0.25;
  if (pointed) {
    std::vector<uint8_t> source(mesh.positions.size(), 0);
    source[found.point] = 1;
    MarkedSurface cut{mesh, geodesic_distance(mesh, source), std::vector<uint8_t>(mesh.triangles.size(), 0)};
    cut_along(cut, found.strip, kSnap * found.strip);
    mesh = compacted(cut.mesh);
    loops = border_loops(mesh, find_adjacency(mesh));
  }
  Edges root;
  for (size_t l = 0; l < loops.size(); ++l)
    for (size_t i = 0; i < loops[l].size(); ++i) {
      const uint32_t a = loops[l][i], b = loops[l][(i + 1) % loops[l].size()];
      const auto near = [&](uint32_t v) {
        return (mesh.positions[v] - point).norm() < (1 + kSnap) * found.strip;
      };
      if (pointed ? near(a) && near(b) : found.edges[l][i]) root.insert({a, b});
    }
  return root;
}

/// Finds the root on the sheet's border, grades and refines the sheet and gives it its thickness.
Rooted sheet(const Mesh& shell, const std::vector<std::vector<uint32_t>>& loops, double thickness,
             const ParentSurface& support) {
  Rooted result;
  result.route = "sheet-extruded";
  MarkedSurface graded{shell, {}, {}};
  const Edges root = root_edges(graded.mesh, loops, support);
  std::vector<uint8_t> source(graded.mesh.positions.size(), 0);
  for (const auto& [a, b] : root) {
    source[a] = source[b] = 1;
    result.diameter += (graded.mesh.positions[a] - graded.mesh.positions[b]).norm();
  }
  graded.distance = geodesic_distance(graded.mesh, source);
  graded.is_root.assign(graded.mesh.triangles.size(), 0);
  const auto farthest = [&] { return *std::max_element(graded.distance.begin(), graded.distance.end()); };
  const int bisected = refine_sheet(graded, farthest(), 2 * thickness);
  if (bisected) {  // the middle of two vertices at distance 0 has distance 0
    source.clear();
    for (const double d : graded.distance) source.push_back(d == 0);
    graded.distance = geodesic_distance(graded.mesh, source);
  }
  result.length = farthest();
  if (const int lines = grade(graded, result.length, result.diameter))
    result.route += fmt::format("+{}-rings", lines);
  if (bisected) result.route += fmt::format("+{}-edges-bisected", bisected);

  const Adjacency adjacency = find_adjacency(graded.mesh);
  const std::vector<std::vector<uint32_t>> border = border_loops(graded.mesh, adjacency);
  result.surface.mesh = extrude_sheet(graded.mesh, border, thickness);
  result.surface.distance = graded.distance;
  result.surface.distance.insert(result.surface.distance.end(), graded.distance.begin(),
                                 graded.distance.end());
  result.surface.is_root.assign(2 * graded.mesh.triangles.size(), 0);
  // Where the border has distance 0 it is the root: bisection has given its middles 0, too.
  for (const std::vector<uint32_t>& loop : border)
    for (size_t i = 0; i < loop.size(); ++i)
      result.surface.is_root.insert(
          result.surface.is_root.end(), 2,
          graded.distance[loop[i]] == 0 && graded.distance[loop[(i + 1) % loop.size()]] == 0);
  return result;
}

Vec3 centre_of_root(const MarkedSurface& surface) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (size_t i = 0; i < surface.is_root.size(); ++i) {
    if (!surface.is_root[i]) continue;
    const Triangle& t = surface.mesh.triangles[i];
    const double a = area_vector(surface.mesh, t).norm();
    sum +=
        a / 3 * (surface.mesh.positions[t[0]] + surface.mesh.positions[t[1]] + surface.mesh.positions[t[2]]);
    area += a;
  }
  return sum / area;
}

}  // namespace

SolidDomain attempt_solid(const Domain& domain, const Mesh& surface, const ParentSurface& support,
                          Attempt& attempt) {
  const std::string where = fmt::format("domain '{}'", domain.name);
  const auto fail = [&](const std::string& reason, const std::string& hint) {
    return Error(Error::Kind::Input, where + ": " + reason, hint);
  };

  CleanShell shell = clean_shell(surface, where);
  attempt.kept = shell.kept;
  attempt.lost_volume = shell.lost_volume;
  const Adjacency adjacency = find_adjacency(shell.mesh);
  const std::vector<std::vector<uint32_t>> loops = border_loops(shell.mesh, adjacency);
  const bool flat = !loops.empty() && is_sheet(shell.mesh, loops);
  attempt.is_sheet = flat;
  Rooted rooted = flat ? sheet(shell.mesh, loops, domain.thickness, support)
                       : body(shell.mesh, adjacency, loops, support, where);

  SolidDomain solid;
  solid.length = rooted.length;
  solid.volume = signed_volume(rooted.surface.mesh);
  if (!std::isfinite(solid.length) || !(solid.length > 0))
    throw fail("it has no length", "check its surface");
  const Adjacency closed = find_adjacency(rooted.surface.mesh);
  if (!closed.manifold || !closed.oriented || !closed.closed)
    throw fail("its surface touches itself where it is open",
               "separate the edges of its holes, or close them");
  if (self_intersects(rooted.surface.mesh)) {
    attempt.crossing = std::move(rooted.surface.mesh);
    throw fail("its surface passes through itself once closed",
               "straighten bends sharper than the branch is thick, or remove inner faces");
  }
  solid.root = centre_of_root(rooted.surface);
  solid.centreline = find_centreline(rooted.surface, solid.root, solid.length, rooted.diameter);
  solid.surface = std::move(rooted.surface.mesh);
  solid.is_root = std::move(rooted.surface.is_root);
  solid.route = rooted.route + shell.notes;
  return solid;
}

}  // namespace liana
