// The node hierarchy of a glTF file: checked to be a forest, with transforms composed.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/types.h"

namespace tinygltf {
class Model;
}

namespace liana {

struct GltfNode {
  std::string name;  ///< as given, else "node<index>"; not yet unique
  int parent = -1;   ///< index of the node, -1 at the top
  int mesh = -1;
  bool in_scene = false;  ///< reached from the file's scene (from anywhere if it has none)
  Affine3 to_world = Affine3::Identity();
};

/// Indexed as in the file. Throws Error{Input} naming file and node: cycles, two parents, children that do
/// not exist, transforms that are not finite or flatten what they carry.
std::vector<GltfNode> gltf_nodes(const tinygltf::Model& model, const std::string& file);

}  // namespace liana
