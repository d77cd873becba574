// read_plant: nodes with meshes become domains.
#include <fmt/core.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_set>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"
#include "mesher/io/gltf_model.h"
#include "mesher/io/gltf_nodes.h"
#include "mesher/io/leaf_names.h"
#include "mesher/io/plant_file.h"

namespace liana {
namespace {

constexpr size_t kMaxTriangles = 50'000'000;  // of all domains: shared meshes could multiply a small file
constexpr double kMaxCoordinate = 1e4;        // m

/// kind, group and thickness from extras.liana, and the kind from the name where it is silent.
void read_extras(const tinygltf::Node& node, const std::string& where, Domain& domain) {
  domain.kind = named_as_leaf(domain.name) ? DomainKind::Leaf : DomainKind::Branch;
  if (!node.extras.IsObject() || !node.extras.Has("liana")) return;
  const auto fail = [&](const std::string& reason) {
    return Error(
        Error::Kind::Input, where + ": extras.liana " + reason,
        R"(it holds {"kind": "branch" or "leaf", "group": "name", "thickness": metres}, all optional)");
  };
  const tinygltf::Value& extras = node.extras.Get("liana");
  if (!extras.IsObject()) throw fail("is not an object");
  for (const std::string& key : extras.Keys()) {
    const tinygltf::Value& value = extras.Get(key);
    if (key == "kind") {
      const std::string kind = value.IsString() ? value.Get<std::string>() : "";
      if (kind != "leaf" && kind != "branch")
        throw fail("has a kind that is neither \"branch\" nor \"leaf\"");
      domain.kind = kind == "leaf" ? DomainKind::Leaf : DomainKind::Branch;
    } else if (key == "group") {
      domain.group = value.IsString() ? value.Get<std::string>() : "";
      if (domain.group.empty()) throw fail("has a group that is not a name");
    } else if (key == "thickness") {
      domain.thickness = value.IsNumber() ? value.GetNumberAsDouble() : NAN;
      if (!(domain.thickness > 0 && domain.thickness <= 1)) throw fail("has a thickness outside (0, 1] m");
    } else {
      throw fail(fmt::format("has an unknown key '{}'", key));
    }
  }
}

/// The nodes that are domains, parents first, otherwise in the file's order.
std::vector<int> domain_nodes(const std::vector<GltfNode>& nodes, const std::string& file) {
  std::vector<std::vector<int>> children(nodes.size());
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;  // smallest index first
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int index = static_cast<int>(i);
    if (nodes[i].parent < 0)
      ready.push(index);
    else
      children[nodes[i].parent].push_back(index);
  }
  std::vector<int> order;
  while (!ready.empty()) {
    const int node = ready.top();
    ready.pop();
    if (nodes[node].mesh >= 0 && nodes[node].in_scene) order.push_back(node);
    for (const int child : children[node]) ready.push(child);
  }
  if (order.empty())
    throw Error(Error::Kind::Input, file + ": no node of its scene holds a mesh",
                "a plant has one node with one mesh for every branch and leaf");
  return order;
}

std::string unique_name(const std::string& name, std::unordered_set<std::string>& taken) {
  std::string unique = name;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}~{}", name, i);
  return unique;
}

/// Positions in metres, wound as the node's transform leaves it.
Mesh world_mesh(const tinygltf::Model& model, const GltfNode& node, double scale, const std::string& where,
                std::vector<int>* materials = nullptr) {
  Mesh mesh = gltf_mesh(model, node.mesh, where, materials);
  for (Vec3& p : mesh.positions) {
    p = scale * (node.to_world * p);
    if (!(p.cwiseAbs().maxCoeff() <= kMaxCoordinate))
      throw Error(Error::Kind::Input, fmt::format("{}: reaches further than {} m", where, kMaxCoordinate),
                  "lengths are in metres: scale the plant, or say in which unit it is with --unit cm or mm");
  }
  if (node.to_world.linear().determinant() < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Mesh world_surface(const tinygltf::Model& model, const GltfNode& node, double scale,
                   const std::string& where) {
  Mesh welded = weld(world_mesh(model, node, scale, where));
  if (!(surface_area(welded) > 1e-18))
    throw Error(Error::Kind::Input, where + ": its surface has no area",
                "remove the node or give it a surface");
  return welded;
}

/// The meshes of the scene as one, for a file that does not say what grows from what.
TriangleSoup merged(const tinygltf::Model& model, const std::vector<GltfNode>& nodes, double scale,
                    const std::string& file) {
  TriangleSoup soup;
  for (const int index : domain_nodes(nodes, file)) {
    const GltfNode& node = nodes[index];
    std::vector<int> materials;
    const Mesh mesh =
        world_mesh(model, node, scale, fmt::format("{}: node '{}'", file, node.name), &materials);
    const auto first = static_cast<uint32_t>(soup.positions.size());
    soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle& t = mesh.triangles[i];
      soup.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      if (i == 0 || materials[i] != materials[i - 1]) {
        const bool named = materials[i] >= 0 && size_t(materials[i]) < model.materials.size();
        soup.labels.push_back({node.name, named ? model.materials[materials[i]].name : ""});
      }
      soup.label.push_back(static_cast<uint32_t>(soup.labels.size() - 1));
    }
    if (soup.triangles.size() > kMaxTriangles)
      throw Error(Error::Kind::Input, fmt::format("{}: more than {} triangles", file, kMaxTriangles),
                  "simplify the plant");
  }
  return soup;
}

bool is_one_shell(const tinygltf::Model& model, const GltfNode& node, const std::string& file) {
  uint32_t parts = 0;
  connected_parts(
      find_adjacency(weld(gltf_mesh(model, node.mesh, fmt::format("{}: node '{}'", file, node.name)))),
      &parts);
  return parts == 1;
}

/// Whether the file itself says which parts there are and what grows from what; see read_gltf_plant.
bool is_segmented(const tinygltf::Model& model, const std::vector<GltfNode>& nodes, const std::string& file) {
  const std::vector<int> domains = domain_nodes(nodes, file);
  size_t below = 0, whole = 0;
  for (const int index : domains) {
    const tinygltf::Value& extras = model.nodes[index].extras;
    if (extras.IsObject() && extras.Has("liana")) return true;
    bool hangs = false;
    for (int up = nodes[index].parent; up >= 0 && !hangs; up = nodes[up].parent) hangs = nodes[up].mesh >= 0;
    below += hangs;
  }
  if (below == 0 && domains.size() > 1) return false;
  for (const int index : domains) whole += is_one_shell(model, nodes[index], file);
  return 2 * whole >= domains.size();
}

SegmentedPlant segmented(const tinygltf::Model& model, const std::vector<GltfNode>& nodes, double scale,
                         const std::string& file) {
  SegmentedPlant plant;
  std::vector<DomainId> domain_of(nodes.size());  // of the node or of its nearest ancestor with a mesh
  std::unordered_set<std::string> names;
  size_t triangles = 0, renamed = 0;
  std::string first_renamed;
  for (const int index : domain_nodes(nodes, file)) {
    const GltfNode& node = nodes[index];
    const std::string where = fmt::format("{}: node '{}'", file, node.name);
    Domain domain;
    domain.name = node.name;
    for (int up = node.parent; up >= 0 && !domain.parent.valid(); up = nodes[up].parent)
      domain.parent = domain_of[up];
    read_extras(model.nodes[index], where, domain);
    if (domain.parent.valid()) domain.level = plant.domains[domain.parent.index()].level + 1;
    if (!domain.parent.valid() && domain.kind == DomainKind::Leaf)
      throw Error(Error::Kind::Input, where + ": is a leaf without a parent branch",
                  "parent it to the node of the branch it grows from; only trunks stand alone");
    if (domain.group.empty())
      domain.group = domain.kind == DomainKind::Leaf ? "leaf" : fmt::format("level{}", domain.level);
    domain.surface = world_surface(model, node, scale, where);
    domain.name = unique_name(node.name, names);
    if (domain.name != node.name && renamed++ == 0) first_renamed = domain.name;
    triangles += domain.surface.triangles.size();
    if (triangles > kMaxTriangles)
      throw Error(Error::Kind::Input, fmt::format("{}: more than {} triangles", file, kMaxTriangles),
                  "simplify the plant");
    domain_of[index] = DomainId(plant.domains.size());
    plant.domains.push_back(std::move(domain));
  }
  if (renamed > 0)
    plant.notes.push_back(fmt::format("{} of {} names were given before: numbered, as '{}'", renamed,
                                      plant.domains.size(), first_renamed));
  return plant;
}

}  // namespace

GltfPlant read_gltf_plant(const std::string& bytes, const std::filesystem::path& path, double scale,
                          bool ignore_hierarchy) {
  const std::string file = path.string();
  tinygltf::Model model;
  GltfPlant result;
  result.source_hash = load_gltf_bytes(bytes, path, model);
  const std::vector<GltfNode> nodes = gltf_nodes(model, file);
  result.segmented = !ignore_hierarchy && is_segmented(model, nodes, file);
  if (result.segmented)
    result.plant = segmented(model, nodes, scale, file);
  else
    result.soup = merged(model, nodes, scale, file);
  result.plant.source_hash = result.source_hash;
  result.plant.name = path.stem().string();
  return result;
}

SegmentedPlant read_plant(const std::filesystem::path& path) {
  tinygltf::Model model;
  const uint64_t hash = load_gltf(path, model);
  SegmentedPlant plant = segmented(model, gltf_nodes(model, path.string()), 1, path.string());
  plant.source_hash = hash;
  plant.name = path.stem().string();
  return plant;
}

}  // namespace liana
