#include "runtime/world/touching_solids.h"

#include <Eigen/Dense>
#include <algorithm>

#include "mesher/exact/self_intersection.h"
#include "mesher/exact/solid_union.h"
#include "runtime/obstacles/sdf_obstacle.h"

namespace liana {
namespace {

constexpr double kGrow = 1e-4;  // m
constexpr double kThin = 1e-6;  // m
constexpr double kCoarser = 2;  // times a solid's own voxel, that it bears
constexpr size_t kMostTriangles = 20000;

/// The same faces further out by kGrow; at sharp tips, less.
Mesh grown(const Mesh& mesh) {
  std::vector<std::vector<Vec3>> normals(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.positions[t[0]];
    const Vec3 normal = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
    for (const uint32_t corner : t) {
      auto& known = normals[corner];
      if (std::none_of(known.begin(), known.end(), [&](const Vec3& n) { return n.dot(normal) > 0.9999; }))
        known.push_back(normal);
    }
  }
  Mesh result = mesh;
  for (size_t i = 0; i < normals.size(); ++i) {
    if (normals[i].empty()) continue;
    Eigen::MatrixX3d planes(normals[i].size(), 3);
    for (size_t k = 0; k < normals[i].size(); ++k) planes.row(k) = normals[i][k].transpose();
    Vec3 way = planes.completeOrthogonalDecomposition().solve(
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(normals[i].size()), kGrow));
    if (way.norm() > 3 * kGrow) way *= 3 * kGrow / way.norm();
    result.positions[i] += way;
  }
  return result;
}

struct Candidate {
  Mesh grown;
  Vec3 low, high;    // m, corners of a box around it
  double voxel = 0;  // m, of its own distance field
  bool may_unite = false;
};

Candidate candidate(const Mesh& mesh) {
  Candidate c;
  if (mesh.triangles.size() > kMostTriangles || self_intersects(mesh)) return c;
  c.grown = grown(mesh);
  c.may_unite = !self_intersects(c.grown);
  c.low = c.high = c.grown.positions.front();
  for (const Vec3& p : c.grown.positions) c.low = c.low.cwiseMin(p), c.high = c.high.cwiseMax(p);
  c.voxel = geometric_voxel(mesh, 0);
  return c;
}

}  // namespace

void unite_touching(std::vector<StandingSolid>& solids) {
  std::vector<Candidate> candidates;
  for (const StandingSolid& solid : solids) candidates.push_back(candidate(solid.mesh));
  std::vector<StandingSolid> united;
  std::vector<uint8_t> taken(solids.size(), 0);
  for (size_t first = 0; first < solids.size(); ++first) {
    if (taken[first]) continue;
    StandingSolid group = solids[first];
    if (candidates[first].may_unite) {
      SolidUnion all(candidates[first].grown);
      std::vector<size_t> members{first};
      double finest = candidates[first].voxel;
      const auto joins = [&](size_t other) {
        const Candidate& c = candidates[other];
        if (taken[other] || !c.may_unite || !(solids[other].material == group.material)) return false;
        const bool near = std::any_of(members.begin(), members.end(), [&](size_t member) {
          const Candidate& m = candidates[member];
          return (m.low.array() <= c.high.array()).all() && (c.low.array() <= m.high.array()).all();
        });
        if (!near || c.voxel > kCoarser * finest || finest > kCoarser * c.voxel) return false;
        return all.add(c.grown);
      };
      // What it does not touch now it may touch through another.
      for (bool more = true; more;) {
        more = false;
        for (size_t other = first + 1; other < solids.size(); ++other) {
          if (!joins(other)) continue;
          taken[other] = more = true;
          members.push_back(other);
          finest = std::min(finest, candidates[other].voxel);
        }
      }
      if (members.size() > 1) {
        group.mesh = all.mesh(kThin);
        group.voxel = finest;
      }
    }
    united.push_back(std::move(group));
  }
  solids = std::move(united);
}

}  // namespace liana
