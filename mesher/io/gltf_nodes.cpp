#include "mesher/io/gltf_nodes.h"

#include <fmt/core.h>
#include <tiny_gltf.h>

#include <cmath>

#include "mesher/base/error.h"

namespace liana {
namespace {

Error node_error(const std::string& file, const GltfNode& node, const std::string& reason,
                 const std::string& hint) {
  return Error(Error::Kind::Input, fmt::format("{}: node '{}' {}", file, node.name, reason), hint);
}

Affine3 local_transform(const tinygltf::Node& node, const GltfNode& named, const std::string& file) {
  const auto fits = [](const std::vector<double>& values, size_t size) {
    return values.empty() || values.size() == size;
  };
  if (!fits(node.matrix, 16) || !fits(node.translation, 3) || !fits(node.rotation, 4) || !fits(node.scale, 3))
    throw node_error(file, named, "has a transform with the wrong number of values", "export the file again");
  Affine3 transform = Affine3::Identity();
  if (!node.matrix.empty()) {
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());  // both column-major
    if ((transform.matrix().row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > 1e-9)
      throw node_error(file, named, "has a projective transform", "use translation, rotation and scale only");
  } else {
    if (!node.translation.empty()) transform.translate(Eigen::Map<const Vec3>(node.translation.data()));
    if (!node.rotation.empty()) {
      const Quat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
      if (!(rotation.norm() > 0.5 && rotation.norm() < 2))
        throw node_error(file, named, "has a rotation that is not a unit quaternion",
                         "export the file again");
      transform.rotate(rotation.normalized());
    }
    if (!node.scale.empty()) transform.scale(Eigen::Map<const Vec3>(node.scale.data()));
  }
  if (!transform.matrix().allFinite())
    throw node_error(file, named, "has a transform that is not finite", "reset the object's transform");
  const Vec3 sizes = transform.linear().colwise().norm();
  if (!(std::abs(transform.linear().determinant()) > 1e-9 * sizes.prod()))
    throw node_error(file, named, "has a transform that flattens it (a scale of 0)",
                     "reset the object's scale");
  return transform;
}

void find_parents(const tinygltf::Model& model, const std::string& file, std::vector<GltfNode>& nodes) {
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : model.nodes[i].children) {
      if (child < 0 || size_t(child) >= nodes.size())
        throw node_error(file, nodes[i], fmt::format("has child {}, which does not exist", child),
                         "export the file again, or remove the child from the node");
      if (nodes[child].parent >= 0)
        throw node_error(file, nodes[child],
                         fmt::format("hangs on two parents, '{}' and '{}'", nodes[nodes[child].parent].name,
                                     nodes[i].name),
                         "leave it under the one branch it grows from");
      nodes[child].parent = static_cast<int>(i);
    }
  }
}

/// Nodes from the tops down; a node that no top reaches is on a cycle or below one.
std::vector<int> parents_first(const tinygltf::Model& model, const std::string& file,
                               const std::vector<GltfNode>& nodes) {
  std::vector<int> order;
  std::vector<uint8_t> reached(nodes.size(), 0);
  for (size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent < 0) order.push_back(static_cast<int>(i));
  for (size_t next = 0; next < order.size(); ++next) {
    reached[order[next]] = 1;
    const std::vector<int>& children = model.nodes[order[next]].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  for (size_t i = 0; i < nodes.size(); ++i)
    if (!reached[i])
      throw node_error(file, nodes[i], "is its own ancestor (the parents form a cycle)",
                       "parent each node to the one branch it grows from");
  return order;
}

}  // namespace

std::vector<GltfNode> gltf_nodes(const tinygltf::Model& model, const std::string& file) {
  std::vector<GltfNode> nodes(model.nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].name = model.nodes[i].name.empty() ? fmt::format("node{}", i) : model.nodes[i].name;
    nodes[i].mesh = model.nodes[i].mesh;
  }
  find_parents(model, file, nodes);
  const std::vector<int> order = parents_first(model, file, nodes);

  std::vector<uint8_t> used(nodes.size(), model.scenes.empty());  // by any scene
  const size_t active = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
  for (size_t s = 0; s < model.scenes.size(); ++s) {
    for (const int top : model.scenes[s].nodes) {
      if (top < 0 || size_t(top) >= nodes.size())
        throw Error(Error::Kind::Input,
                    fmt::format("{}: scene {} names node {}, which does not exist", file, s, top),
                    "export the file again");
      used[top] = 1;
      nodes[top].in_scene = nodes[top].in_scene || s == active;
    }
  }
  for (const int i : order) {
    GltfNode& node = nodes[i];
    node.to_world = local_transform(model.nodes[i], node, file);
    if (node.parent >= 0) {
      const GltfNode& parent = nodes[node.parent];
      node.to_world = parent.to_world * node.to_world;
      node.in_scene = node.in_scene || parent.in_scene;
      used[i] = used[i] || used[node.parent];
    } else if (model.scenes.empty()) {
      node.in_scene = true;
    }
    if (node.mesh >= 0 && !used[i])
      throw node_error(file, node, "has neither a parent nor a place in a scene",
                       "parent it to the branch it grows from, or remove it");
  }
  return nodes;
}

}  // namespace liana
