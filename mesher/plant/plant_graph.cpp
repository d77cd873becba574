#include "mesher/plant/plant_graph.h"

#include <algorithm>
#include <cmath>

namespace liana {
namespace {

bool known(double radius) {
  return radius > 0;
}  // not NaN, not 0

/// Between a node and its nearest ancestor on the same axis that both have radii.
/// Walks no stretch twice: `reached`.
void interpolate_from(PlantGraph& graph, const std::vector<double>& given, size_t end,
                      std::vector<uint8_t>& reached) {
  std::vector<size_t> unknown;
  std::vector<double> way{0};
  size_t at = end;
  while (!graph.nodes[at].begins_axis && graph.nodes[at].parent >= 0) {
    const auto below = static_cast<size_t>(graph.nodes[at].parent);
    way.push_back(way.back() + (graph.nodes[at].position - graph.nodes[below].position).norm());
    at = below;
    if (known(given[at]) || reached[at]) break;
    reached[at] = 1;
    unknown.push_back(at);
  }
  if (unknown.empty() || !known(given[at])) return;
  for (size_t i = 0; i < unknown.size(); ++i) {
    const double share = way.back() > 0 ? way[i + 1] / way.back() : 0.5;
    graph.nodes[unknown[i]].radius = given[end] + share * (given[at] - given[end]);
  }
}

}  // namespace

size_t fill_radii(PlantGraph& graph) {
  std::vector<double> given;
  double thinnest = std::numeric_limits<double>::infinity();
  size_t missing = 0;
  for (GraphNode& node : graph.nodes) {
    if (!known(node.radius))
      node.radius = std::numeric_limits<double>::quiet_NaN(), ++missing;
    else
      thinnest = std::min(thinnest, node.radius);
    given.push_back(node.radius);
  }
  if (missing == 0) return 0;
  if (!std::isfinite(thinnest)) thinnest = kTipRadius;
  std::vector<uint8_t> reached(graph.nodes.size(), 0);
  for (size_t i = graph.nodes.size(); i-- > 0;) {
    const int parent = graph.nodes[i].parent;
    if (!known(given[i]) || parent < 0 || known(given[parent]) || reached[parent]) continue;
    interpolate_from(graph, given, i, reached);
  }
  std::vector<double> carried(graph.nodes.size(), 0);  // m², sum of squared radii
  for (size_t i = graph.nodes.size(); i-- > 0;) {
    GraphNode& node = graph.nodes[i];
    if (!known(node.radius)) {
      node.radius = std::max(std::sqrt(carried[i]), thinnest);
      given[i] = -1;  // by the pipe model: bounded below
    }
    if (node.parent >= 0) carried[node.parent] += node.radius * node.radius;
  }
  for (size_t i = 0; i < graph.nodes.size(); ++i) {
    GraphNode& node = graph.nodes[i];
    if (given[i] == -1 && node.parent >= 0)
      node.radius = std::min(node.radius, graph.nodes[node.parent].radius);
  }
  return missing;
}

}  // namespace liana
