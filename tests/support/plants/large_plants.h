// Plants of any size: what the offline stage is timed on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesher/plant/segmented_plant.h"

namespace liana {

/// A plant as modelling tools export it: nodes that may share meshes.
struct InstancedPlant {
  struct Part {
    std::string name;
    DomainId parent;
    DomainKind kind = DomainKind::Branch;
    double thickness = 3e-4;  ///< m, of a leaf
    size_t mesh = 0;
    Affine3 place = Affine3::Identity();  ///< to world; uniform scale
  };
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Part> parts;  ///< parents first
};

/// `count` six-sided branches with `children` on each, no two of the same proportions: aspect 10-100, tapered
/// and bent. Open tubes of seven even rings whose base lies on the parent's centreline. Sizes are drawn from
/// a named random stream.
InstancedPlant make_branch_hierarchy(int count, int children = 3);

/// A palm of the size of [Wang17]'s: 6,085 domains and 328,000 triangles in world coordinates. A trunk, 44
/// fronds of different shape, and leaflets that are all one mesh, turned, moved and scaled with their
/// thickness.
InstancedPlant make_palm(int fronds = 44, int leaflets = 6040);

SegmentedPlant flatten(const InstancedPlant& plant);

/// As .glb, instances as nodes that share a mesh. Positions are floats in the mesh's own frame.
void write_instanced_plant(const InstancedPlant& plant, const std::filesystem::path& path);

}  // namespace liana
