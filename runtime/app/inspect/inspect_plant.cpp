#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "mesher/base/hash.h"
#include "runtime/app/inspect/inspect.h"

namespace liana {
namespace {

using Box = Eigen::AlignedBox3d;

Box box_of(const Mesh& mesh) {
  Box box;
  for (const Vec3& position : mesh.positions) box.extend(position);
  return box;
}

/// "closed", or how it is not: edges with one triangle are open, with three or more branching.
std::string closedness(const Mesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> sides;
  for (const Triangle& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner)
      sides.push_back(std::minmax(triangle[corner], triangle[(corner + 1) % 3]));
  std::sort(sides.begin(), sides.end());
  size_t open = 0, branching = 0;
  for (size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end] == sides[i]) ++end;
    open += end - i == 1, branching += end - i > 2;
  }
  if (open == 0 && branching == 0) return "closed";
  std::string text;
  if (open > 0) text = fmt::format("open ({} edges)", open);
  if (branching > 0) text += fmt::format("{}{} branching edges", text.empty() ? "" : ", ", branching);
  return text;
}

struct Row {
  size_t count = 0, triangles = 0, closed = 0;
  double least = 1e300, most = 0;  // m, diagonals
};

std::string size_range(const Row& row) {
  const std::string least = fmt::format("{:.3g}", row.least), most = fmt::format("{:.3g}", row.most);
  return least == most ? least : least + "-" + most;
}

std::string summary(const SegmentedPlant& plant) {
  std::map<std::tuple<int, DomainKind, std::string>, Row> rows;
  for (const Domain& domain : plant.domains) {
    Row& row = rows[{domain.level, domain.kind, domain.group}];
    const double size = box_of(domain.surface).diagonal().norm();
    ++row.count;
    row.triangles += domain.surface.triangles.size();
    row.closed += closedness(domain.surface) == "closed";
    row.least = std::min(row.least, size), row.most = std::max(row.most, size);
  }
  constexpr const char* kLine = "{:>5}  {:<7} {:<12} {:>6} {:>10} {:>16} {:>12}\n";
  std::string text = fmt::format(kLine, "level", "kind", "group", "count", "triangles", "size, m", "closed");
  for (const auto& [key, row] : rows) {
    const auto& [level, kind, group] = key;
    text += fmt::format(kLine, level, kind == DomainKind::Leaf ? "leaf" : "branch", group, row.count,
                        row.triangles, size_range(row), fmt::format("{}/{}", row.closed, row.count));
  }
  return text;
}

std::string domain_list(const SegmentedPlant& plant) {
  constexpr const char* kLine = "{:>5}  {:<24} {:>6} {:>5}  {:<7} {:>5}  {:<10} {:>9} {:>9}  {}\n";
  std::string text = fmt::format(kLine, "id", "name", "parent", "sure", "kind", "level", "group", "triangles",
                                 "size, m", "surface");
  for (size_t id = 0; id < plant.domains.size(); ++id) {
    const Domain& domain = plant.domains[id];
    text += fmt::format(
        kLine, id, domain.name, domain.parent.valid() ? std::to_string(domain.parent.value) : "-",
        fmt::format("{:.2f}", domain.parent_confidence), domain.kind == DomainKind::Leaf ? "leaf" : "branch",
        domain.level, domain.group, domain.surface.triangles.size(),
        fmt::format("{:.3g}", box_of(domain.surface).diagonal().norm()), closedness(domain.surface));
  }
  return text;
}

/// Domains whose parent is more likely wrong than right, the least sure first.
std::string doubtful_list(const SegmentedPlant& plant) {
  std::vector<size_t> doubtful;
  for (size_t id = 0; id < plant.domains.size(); ++id)
    if (plant.domains[id].parent_confidence < 0.5) doubtful.push_back(id);
  if (doubtful.empty()) return "";
  std::stable_sort(doubtful.begin(), doubtful.end(), [&](size_t a, size_t b) {
    return plant.domains[a].parent_confidence < plant.domains[b].parent_confidence;
  });
  constexpr size_t kShown = 20;
  std::string text = fmt::format("\ndoubtful parents ({}):\n", doubtful.size());
  for (size_t i = 0; i < std::min(doubtful.size(), kShown); ++i) {
    const Domain& domain = plant.domains[doubtful[i]];
    text += fmt::format("  {:<24} on {:<24} {:.2f}\n", domain.name,
                        domain.parent.valid() ? plant.domains[domain.parent.index()].name : "the ground",
                        domain.parent_confidence);
  }
  if (doubtful.size() > kShown) text += fmt::format("  and {} more\n", doubtful.size() - kShown);
  return text;
}

}  // namespace

std::string inspect_plant(const std::filesystem::path& path, const InspectOptions& options) {
  const SegmentedPlant plant = load_plant(path, options.load);
  Box box;
  size_t triangles = 0;
  for (const Domain& domain : plant.domains) {
    box.extend(box_of(domain.surface));
    triangles += domain.surface.triangles.size();
  }
  const Vec3 size = box.sizes();
  std::string text = fmt::format(
      "{}: a plant\n{} domains, {} triangles (welded by position), {:.3g} x {:.3g} x {:.3g} m "
      "(height is y; "
      "metres, +Y up)\nhash {}\n\n",
      path.string(), plant.domains.size(), triangles, size.x(), size.y(), size.z(),
      hash_text(plant.source_hash));
  for (const std::string& note : plant.notes) text += "- " + note + "\n";
  if (!plant.notes.empty()) text += "\n";
  text += summary(plant);
  text += doubtful_list(plant);
  if (options.all_domains) return text + "\n" + domain_list(plant);
  return text + "(every domain: --domains)\n";
}

}  // namespace liana
