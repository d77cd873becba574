#include "mesher/io/graph_file.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "mesher/base/error.h"
#include "mesher/base/memory.h"

namespace liana {
namespace {

using Json = nlohmann::json;

constexpr size_t kMaxNodes = 5'000'000;
const char* const kForm =
    R"(it reads {"liana_graph": 1, "nodes": [{"parent": null, "position": [x, y, z], "radius": r}, ...]}, parents first)";

GraphNode node_from(const Json& json, size_t index, const std::string& file) {
  const auto fail = [&](const std::string& reason) {
    return Error(Error::Kind::Input, fmt::format("{}: node {} {}", file, index, reason), kForm);
  };
  if (!json.is_object()) throw fail("is not an object");
  GraphNode node;
  bool has_position = false;
  for (const auto& [key, value] : json.items()) {
    if (key == "position") {
      if (!value.is_array() || value.size() != 3) throw fail("has a position that is not three numbers");
      for (size_t k = 0; k < 3; ++k) {
        if (!value[k].is_number()) throw fail("has a position that is not three numbers");
        node.position[static_cast<long>(k)] = value[k].get<double>();
      }
      if (!node.position.allFinite()) throw fail("has a position that is not finite");
      has_position = true;
    } else if (key == "parent") {
      if (value.is_null()) continue;
      if (!value.is_number_integer() || value.get<int64_t>() < 0 ||
          value.get<int64_t>() >= static_cast<int64_t>(index))
        throw fail("has a parent that is not the index of a node before it");
      node.parent = static_cast<int>(value.get<int64_t>());
    } else if (key == "radius") {
      if (!value.is_number() || !(value.get<double>() > 0) || !std::isfinite(value.get<double>()))
        throw fail("has a radius that is not a positive number");
      node.radius = value.get<double>();
    } else if (key == "begins_axis") {
      if (!value.is_boolean()) throw fail("has a begins_axis that is not true or false");
      node.begins_axis = value.get<bool>();
    } else {
      throw fail(fmt::format("has an unknown key '{}'", key.substr(0, 24)));
    }
  }
  if (!has_position) throw fail("has no position");
  return node;
}

}  // namespace

PlantGraph parse_graph(std::string_view bytes, const std::string& file) {
  require_memory(8 * bytes.size(), file + ": reading it");
  Json json;
  try {
    json = Json::parse(bytes);
  } catch (const Json::exception& reason) {
    throw Error(Error::Kind::Input,
                fmt::format("{}: is not JSON (byte {})", file,
                            dynamic_cast<const Json::parse_error*>(&reason)
                                ? static_cast<const Json::parse_error&>(reason).byte
                                : 0),
                kForm);
  }
  if (!json.is_object() || !json.contains("liana_graph") || json["liana_graph"] != 1 ||
      !json.contains("nodes") || !json["nodes"].is_array())
    throw Error(Error::Kind::Input, file + ": is not a plant graph of version 1", kForm);
  const Json& nodes = json["nodes"];
  if (nodes.size() < 2 || nodes.size() > kMaxNodes)
    throw Error(Error::Kind::Input, fmt::format("{}: has {} nodes", file, nodes.size()),
                fmt::format("a plant graph has 2 to {}", kMaxNodes));
  PlantGraph graph;
  graph.nodes.reserve(nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) graph.nodes.push_back(node_from(nodes[i], i, file));
  return graph;
}

std::string graph_text(const PlantGraph& graph) {
  std::string text = "{\"liana_graph\": 1, \"nodes\": [\n";
  for (size_t i = 0; i < graph.nodes.size(); ++i) {
    const GraphNode& node = graph.nodes[i];
    text += fmt::format("{{\"parent\": {}, \"position\": [{}, {}, {}]",
                        node.parent < 0 ? "null" : std::to_string(node.parent), node.position.x(),
                        node.position.y(), node.position.z());
    if (node.radius > 0) text += fmt::format(", \"radius\": {}", node.radius);
    if (node.begins_axis) text += ", \"begins_axis\": true";
    text += i + 1 < graph.nodes.size() ? "},\n" : "}\n";
  }
  return text + "]}\n";
}

}  // namespace liana
