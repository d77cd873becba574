#include "modal/elements/assembly.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"
#include "modal/elements/element_matrices.h"

namespace liana {
namespace {

/// Where the blocks of the elements go: per element and node pair, entry << 1 | transposed.
using Slots = std::vector<uint32_t>;

/// Elements at every node, compressed: elements_at[first[n] .. first[n+1]).
struct NodeElements {
  std::vector<uint32_t> first, element;
};

NodeElements elements_at_nodes(const NodeMesh& mesh) {
  NodeElements at;
  at.first.assign(mesh.positions.size() + 1, 0);
  for (const uint32_t n : mesh.elements) ++at.first[n + 1];
  for (size_t n = 0; n + 1 < at.first.size(); ++n) at.first[n + 1] += at.first[n];
  at.element.resize(mesh.elements.size());
  std::vector<uint32_t> next(at.first.begin(), at.first.end() - 1);
  for (size_t i = 0; i < mesh.elements.size(); ++i)
    at.element[next[mesh.elements[i]]++] = static_cast<uint32_t>(i / mesh.nodes_per_element);
  return at;
}

/// Fills start and row of the system; one pass over the elements of each node finds pattern and slots
/// together.
Slots make_pattern(const NodeMesh& mesh, System& system) {
  const NodeElements at = elements_at_nodes(mesh);
  const int n = mesh.nodes_per_element;
  Slots slots(mesh.element_count() * pair_count(n));
  std::vector<uint32_t> entry_of_row(mesh.positions.size()),
      seen_in_column(mesh.positions.size(), UINT32_MAX);
  system.start.reserve(mesh.positions.size() + 1);
  system.start.push_back(0);
  for (uint32_t column = 0; column < mesh.positions.size(); ++column) {
    const auto entry = [&](uint32_t row) {
      if (seen_in_column[row] != column) {
        seen_in_column[row] = column;
        entry_of_row[row] = static_cast<uint32_t>(system.row.size());
        system.row.push_back(row);
      }
      return entry_of_row[row];
    };
    entry(column);
    for (uint32_t i = at.first[column]; i < at.first[column + 1]; ++i) {
      const uint32_t e = at.element[i];
      const auto nodes = mesh.element(e);
      const int b = static_cast<int>(std::find(nodes.begin(), nodes.end(), column) - nodes.begin());
      for (int a = 0; a < n; ++a) {
        if (nodes[a] < column) continue;
        // The element's block (a, b) has its larger local index first; the system's its larger global one.
        const bool transposed = a < b;
        slots[e * pair_count(n) + pair_index(std::max(a, b), std::min(a, b))] =
            entry(nodes[a]) << 1 | transposed;
      }
    }
    system.start.push_back(static_cast<uint32_t>(system.row.size()));
  }
  return slots;
}

double largest_extent(const NodeMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  return box.sizes().maxCoeff();
}

}  // namespace

System assemble(const NodeMesh& mesh, Element element, const ElasticMaterial& material,
                std::span<const ElementScaling> scaling) {
  require(scaling.empty() || scaling.size() == mesh.element_count(), "one scaling for each element");
  System system;
  system.length = largest_extent(mesh);
  system.time = system.length * std::sqrt(material.density / material.youngs_modulus);
  system.mass_unit = material.density * std::pow(system.length, 3);
  const Slots slots = make_pattern(mesh, system);
  system.stiffness.assign(system.row.size(), Mat3::Zero());
  system.mass.assign(system.row.size(), 0);

  const LameConstants uniform = LameConstants::of(1, material.poisson_ratio);
  const std::span<const double> mass = unit_mass(element);
  const int pairs = pair_count(mesh.nodes_per_element);
  std::array<Mat3, pair_count(10)> blocks;
  for (size_t e = 0; e < mesh.element_count(); ++e) {
    const TetGeometry tet = element_geometry(mesh, e, system.length);
    const ElementScaling own = scaling.empty() ? ElementScaling() : scaling[e];
    element_stiffness(element, tet, uniform.scaled(own.stiffness), blocks);
    const double element_mass = own.density * tet.volume;
    for (int pair = 0; pair < pairs; ++pair) {
      const uint32_t slot = slots[e * pairs + pair], entry = slot >> 1;
      if (slot & 1)
        system.stiffness[entry] += blocks[pair].transpose();
      else
        system.stiffness[entry] += blocks[pair];
      system.mass[entry] += element_mass * mass[pair];
    }
  }
  return system;
}

NodalVectors System::multiply_mass(const NodalVectors& x) const {
  const Eigen::Index width = 3 * x.cols();
  NodalVectors y = NodalVectors::Zero(x.rows(), x.cols());
  for (size_t j = 0; j < nodes(); ++j) {
    const double* xj = x.data() + j * width;
    double* yj = y.data() + j * width;
    for (Eigen::Index k = 0; k < width; ++k) yj[k] += mass[start[j]] * xj[k];
    for (uint32_t e = start[j] + 1; e < start[j + 1]; ++e) {
      const double m = mass[e];
      const double* xi = x.data() + row[e] * width;
      double* yi = y.data() + row[e] * width;
      for (Eigen::Index k = 0; k < width; ++k) {
        yi[k] += m * xj[k];
        yj[k] += m * xi[k];
      }
    }
  }
  return y;
}

NodalVectors System::multiply_stiffness(const NodalVectors& x) const {
  NodalVectors y = NodalVectors::Zero(x.rows(), x.cols());
  for (size_t j = 0; j < nodes(); ++j) {
    y.middleRows<3>(3 * j) += stiffness[start[j]] * x.middleRows<3>(3 * j);
    for (uint32_t e = start[j] + 1; e < start[j + 1]; ++e) {
      y.middleRows<3>(3 * row[e]) += stiffness[e] * x.middleRows<3>(3 * j);
      y.middleRows<3>(3 * j) += stiffness[e].transpose() * x.middleRows<3>(3 * row[e]);
    }
  }
  return y;
}

}  // namespace liana
