// read_plant: nodes with meshes become domains.
#include <fmt/core.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <queue>
#include <unordered_set>

#include "mesher/base/error.h"
#include "mesher/base/weld.h"
#include "mesher/io/gltf_model.h"
#include "mesher/io/gltf_nodes.h"
#include "mesher/io/plant_file.h"

namespace liana {
namespace {

constexpr size_t kMaxTriangles = 50'000'000;  // of all domains: shared meshes could multiply a small file
constexpr double kMaxCoordinate = 1e4;        // m

/// "leaf", "leaves", "blade" or "petal", any case, as a whole word of the name or at its start ("Leaf.012").
bool named_as_leaf(const std::string& name) {
  std::string lower(name.size(), ' ');
  std::transform(name.begin(), name.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto is_letter = [&](size_t i) { return i < lower.size() && std::isalpha((unsigned char)lower[i]); };
  for (const std::string_view word : {"leaf", "leaves", "blade", "petal"})
    for (size_t at = lower.find(word); at != std::string::npos; at = lower.find(word, at + 1))
      if (at == 0 || (!is_letter(at - 1) && !is_letter(at + word.size()))) return true;
  return false;
}

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

Mesh world_surface(const tinygltf::Model& model, const GltfNode& node, const std::string& where) {
  Mesh mesh = gltf_mesh(model, node.mesh, where);
  for (Vec3& p : mesh.positions) {
    p = node.to_world * p;
    if (!(p.cwiseAbs().maxCoeff() <= kMaxCoordinate))
      throw Error(Error::Kind::Input, fmt::format("{}: reaches further than {} m", where, kMaxCoordinate),
                  "lengths are in metres: scale the plant");
  }
  if (node.to_world.linear().determinant() < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  Mesh welded = weld(mesh);
  double area = 0;
  for (const Triangle& t : welded.triangles) {
    const Vec3& a = welded.positions[t[0]];
    area += (welded.positions[t[1]] - a).cross(welded.positions[t[2]] - a).norm() / 2;
  }
  if (!(area > 1e-18))
    throw Error(Error::Kind::Input, where + ": its surface has no area",
                "remove the node or give it a surface");
  return welded;
}

}  // namespace

SegmentedPlant read_plant(const std::filesystem::path& path) {
  const std::string file = path.string();
  tinygltf::Model model;
  SegmentedPlant plant;
  plant.source_hash = load_gltf(path, model);
  plant.name = path.stem().string();
  const std::vector<GltfNode> nodes = gltf_nodes(model, file);

  std::vector<DomainId> domain_of(nodes.size());  // of the node or of its nearest ancestor with a mesh
  std::unordered_set<std::string> names;
  size_t triangles = 0;
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
    domain.surface = world_surface(model, node, where);
    domain.name = unique_name(node.name, names);
    triangles += domain.surface.triangles.size();
    if (triangles > kMaxTriangles)
      throw Error(Error::Kind::Input, fmt::format("{}: more than {} triangles", file, kMaxTriangles),
                  "simplify the plant");
    domain_of[index] = DomainId(plant.domains.size());
    plant.domains.push_back(std::move(domain));
  }
  return plant;
}

}  // namespace liana
