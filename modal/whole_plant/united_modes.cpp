#include "modal/whole_plant/united_modes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "modal/elements/interpolation.h"
#include "modal/solve/eigenpairs.h"

namespace liana {
namespace {

class Union {
 public:
  explicit Union(const std::vector<UnitedPart>& parts) : parts_(parts) {
    Eigen::AlignedBox3d box;
    for (const UnitedPart& part : parts)
      for (const Vec3& p : part.mesh.positions) box.extend(p);
    const ElasticMaterial& unit = parts.front().material;
    system_.length = box.sizes().maxCoeff();
    system_.time = system_.length * std::sqrt(unit.density / unit.youngs_modulus);
    system_.mass_unit = unit.density * std::pow(system_.length, 3);
    stiffness_unit_ = unit.youngs_modulus * system_.length;
  }

  UnitedModes solve(int count) {
    UnitedModes modes;
    for (size_t p = 0; p < parts_.size(); ++p) {
      modes.meshes.push_back(make_nodes(parts_[p].mesh, Element::T10));
      express_nodes(p, modes);
    }
    for (size_t p = 0; p < parts_.size(); ++p) add(p, modes.meshes[p]);
    compress();
    const EigenResult pairs = lowest_eigenpairs(system_, held_, {.modes = count});
    modes.dof = pairs.dof;
    modes.converged = pairs.converged;
    for (const double lambda : pairs.eigenvalues)
      modes.frequencies.push_back(std::sqrt(std::max(0.0, lambda)) / (2 * kPi * system_.time));
    for (const std::vector<std::vector<NodeWeight>>& nodes : masters_) {
      NodalVectors shape = NodalVectors::Zero(3 * nodes.size(), pairs.vectors.cols());
      for (size_t n = 0; n < nodes.size(); ++n)
        for (const auto& [master, weight] : nodes[n])
          shape.middleRows<3>(3 * n) += weight * pairs.vectors.middleRows<3>(3 * master);
      modes.shapes.push_back(shape / std::sqrt(system_.mass_unit));
    }
    return modes;
  }

 private:
  /// Every node of a part by nodes of the united system: itself, or for a child's root those of its parent.
  void express_nodes(size_t p, UnitedModes& modes) {
    const UnitedPart& part = parts_[p];
    const NodeMesh& mesh = modes.meshes[p];
    if (part.mesh.root_faces.empty())
      throw Error(Error::Kind::Input, fmt::format("part {} has no root interface", p),
                  "mark the faces nearest the parent as root");
    require(part.parent < static_cast<int>(p), "parents come before children");
    std::vector<uint8_t> used(mesh.positions.size(), 0);
    for (const uint32_t n : mesh.elements) used[n] = 1;
    std::vector<std::vector<NodeWeight>>& nodes = masters_.emplace_back(mesh.positions.size());
    for (size_t n = 0; n < nodes.size(); ++n) {
      if (mesh.on_root[n] && part.parent >= 0) {
        for (const auto& [of_parent, weight] : interpolate_at(modes.meshes[part.parent], mesh.positions[n]))
          for (const auto& [master, share] : masters_[part.parent][of_parent])
            nodes[n].push_back({master, weight * share});
        ++modes.tied_nodes;
        continue;
      }
      nodes[n].push_back({static_cast<uint32_t>(held_.size() / 3), 1.0});
      held_.insert(held_.end(), 3, mesh.on_root[n] || !used[n]);
    }
  }

  void add(size_t p, const NodeMesh& mesh) {
    const UnitedPart& part = parts_[p];
    const System own = assemble(mesh, Element::T10, part.material, part.scaling);
    const double stiffness = part.material.youngs_modulus * own.length / stiffness_unit_;
    const double mass = own.mass_unit / system_.mass_unit;
    for (uint32_t c = 0; c < own.nodes(); ++c)
      for (uint32_t e = own.start[c]; e < own.start[c + 1]; ++e) {
        const uint32_t r = own.row[e];
        const Mat3 K = stiffness * own.stiffness[e];
        const double m = mass * own.mass[e];
        for (const auto& [i, wi] : masters_[p][r])
          for (const auto& [j, wj] : masters_[p][c]) {
            const double w = wi * wj;
            if (r == c && i < j) continue;  // the other half of a symmetric block
            if (i >= j) add_block(i, j, w * K, w * m);
            if (r != c && i <= j) add_block(j, i, w * K.transpose(), w * m);
          }
      }
  }

  void add_block(uint32_t row, uint32_t column, const Mat3& stiffness, double mass) {
    places_.push_back({uint64_t{column} << 32 | row, static_cast<uint32_t>(stiffness_.size())});
    stiffness_.push_back(stiffness), mass_.push_back(mass);
  }

  /// Sums the blocks of each place, in the order they came, and gives them to the system.
  void compress() {
    std::stable_sort(places_.begin(), places_.end(),
                     [](const Place& a, const Place& b) { return a.key < b.key; });
    const size_t nodes = held_.size() / 3;
    uint64_t last = UINT64_MAX;
    for (const auto& [key, block] : places_) {
      const uint32_t column = static_cast<uint32_t>(key >> 32);
      while (system_.start.size() <= column)
        system_.start.push_back(static_cast<uint32_t>(system_.row.size()));
      if (key != last) {
        system_.row.push_back(static_cast<uint32_t>(key));
        system_.stiffness.push_back(Mat3::Zero()), system_.mass.push_back(0);
        last = key;
      }
      system_.stiffness.back() += stiffness_[block];
      system_.mass.back() += mass_[block];
    }
    while (system_.start.size() <= nodes) system_.start.push_back(static_cast<uint32_t>(system_.row.size()));
  }

  struct Place {
    uint64_t key;  ///< column << 32 | row
    uint32_t block;
  };

  const std::vector<UnitedPart>& parts_;
  std::vector<std::vector<std::vector<NodeWeight>>> masters_;  // per part and node
  std::vector<uint8_t> held_;                                  // per dof of the united system
  std::vector<Place> places_;
  std::vector<Mat3> stiffness_;
  std::vector<double> mass_;
  System system_;
  double stiffness_unit_;  // N/m
};

}  // namespace

UnitedModes united_modes(const std::vector<UnitedPart>& parts, int count) {
  if (parts.empty())
    throw Error(Error::Kind::Input, "a plant without parts has no modes", "bake it first: liana bake");
  return Union(parts).solve(count);
}

}  // namespace liana
