#include "materials/pipeline/baked_solids.h"

#include <algorithm>

#include "mesher/base/parallel.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "mesher/tets/tetrahedralize.h"
#include "modal/elements/taper_field.h"
#include "modal/solve/lowest_mode.h"

namespace liana {
namespace {

/// Displacement as a field of three components, its largest 1.
std::vector<double> unit_field(const NodalVectors& shape, Eigen::Index mode) {
  std::vector<double> values(shape.rows());
  for (Eigen::Index r = 0; r < shape.rows(); ++r) values[r] = shape(r, mode);
  return values;
}

void scale_to_one(std::vector<double>& displacement) {
  double largest = 0;
  for (size_t i = 0; i + 2 < displacement.size(); i += 3)
    largest = std::max(largest, Vec3(displacement[i], displacement[i + 1], displacement[i + 2]).norm());
  if (largest > 0)
    for (double& value : displacement) value /= largest;
}

/// Points, cells and materials of all parts.
VtuMesh with_materials(const Bake& bake, const std::vector<UnitedPart>& parts,
                       const std::vector<NodeMesh>& meshes) {
  VtuMesh vtu;
  VtuField nu{"nu", 1, {}}, youngs{"E", 1, {}}, density{"density", 1, {}}, domain{"domain", 1, {}};
  for (size_t p = 0; p < parts.size(); ++p) {
    const auto offset = static_cast<uint32_t>(vtu.points.size());
    vtu.points.insert(vtu.points.end(), meshes[p].positions.begin(), meshes[p].positions.end());
    for (const uint32_t n : meshes[p].elements) vtu.cells.push_back(offset + n);
    for (size_t e = 0; e < meshes[p].element_count(); ++e) {
      const ElementScaling s = parts[p].scaling.empty() ? ElementScaling() : parts[p].scaling[e];
      nu.values.push_back(bake.domains[p].material.frequency);
      youngs.values.push_back(s.stiffness * parts[p].material.youngs_modulus);
      density.values.push_back(s.density * parts[p].material.density);
      domain.values.push_back(static_cast<double>(p));
    }
  }
  vtu.cell_fields = {nu, youngs, density, domain};
  return vtu;
}

}  // namespace

std::vector<UnitedPart> baked_solids(const SegmentedPlant& plant, const Bake& bake) {
  std::vector<DomainId> sources;
  size_t index = 0;  // the bake's domains are the plant's in order, less those left out
  for (const BakedDomain& baked : bake.domains) {
    while (index < plant.domains.size() && plant.domains[index].name != baked.name) ++index;
    if (index == plant.domains.size())
      throw Error(Error::Kind::Input, "domain '" + baked.name + "' of the bake is not in " + plant.name,
                  "bake this plant again");
    sources.push_back(DomainId(index++));
  }
  std::vector<UnitedPart> parts(sources.size());
  parallel_for(parts.size(), 0, [&](size_t i, unsigned) {
    const BakedDomain& baked = bake.domains[i];
    const SolidDomain solid = make_solid(plant, sources[i]);
    if (solid.is_beam)
      throw Error(
          Error::Kind::Input,
          plant.name + ": domain '" + baked.name + "' could only be made a beam, which has no tetrahedra",
          "mend its surface, or bake without --vtu and compare with liana modes FILE.bake");
    parts[i] = {.mesh = tetrahedralize(solid.surface, solid.is_root),
                .material = {baked.youngs_modulus, baked.density, bake.law.default_material.poisson_ratio},
                .scaling = {},
                .parent = baked.parent.valid() ? static_cast<int>(baked.parent.index()) : -1};
    if (const TaperLaw& taper = bake.law.group(baked.group).taper; !taper.uniform())
      parts[i].scaling = tapered(parts[i].mesh, taper);
  });
  return parts;
}

VtuMesh domains_vtu(const Bake& bake, const std::vector<UnitedPart>& parts) {
  std::vector<NodeMesh> meshes(parts.size());
  std::vector<std::vector<double>> shapes(parts.size());
  parallel_for(parts.size(), 0, [&](size_t p, unsigned) {
    meshes[p] = make_nodes(parts[p].mesh, Element::T10);
    const Modes modes = lowest_modes(parts[p].mesh, parts[p].material, {}, {}, parts[p].scaling);
    shapes[p].assign(modes.shapes[0].begin(), modes.shapes[0].end());
    scale_to_one(shapes[p]);
  });
  VtuField mode{"mode", 3, {}};
  for (const std::vector<double>& shape : shapes)
    mode.values.insert(mode.values.end(), shape.begin(), shape.end());
  VtuMesh vtu = with_materials(bake, parts, meshes);
  vtu.point_fields.push_back(std::move(mode));
  return vtu;
}

VtuMesh united_vtu(const Bake& bake, const std::vector<UnitedPart>& parts, const UnitedModes& modes) {
  VtuMesh vtu = with_materials(bake, parts, modes.meshes);
  for (size_t m = 0; m < modes.frequencies.size(); ++m) {
    VtuField field{"mode" + std::to_string(m + 1), 3, {}};
    for (const NodalVectors& shape : modes.shapes) {
      const std::vector<double> values = unit_field(shape, static_cast<Eigen::Index>(m));
      field.values.insert(field.values.end(), values.begin(), values.end());
    }
    scale_to_one(field.values);
    vtu.point_fields.push_back(std::move(field));
  }
  vtu.numbers.push_back({"frequencies", 1, modes.frequencies});
  return vtu;
}

}  // namespace liana
