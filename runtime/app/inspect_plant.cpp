#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "mesher/base/hash.h"
#include "mesher/io/plant_file.h"
#include "runtime/app/inspect.h"

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
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const Triangle& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner)
      ++edges[std::minmax(triangle[corner], triangle[(corner + 1) % 3])];
  size_t open = 0, branching = 0;
  for (const auto& [edge, triangles] : edges) open += triangles == 1, branching += triangles > 2;
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
  constexpr const char* kLine = "{:>5}  {:<24} {:>6}  {:<7} {:>5}  {:<10} {:>9} {:>9}  {}\n";
  std::string text =
      fmt::format(kLine, "id", "name", "parent", "kind", "level", "group", "triangles", "size, m", "surface");
  for (size_t id = 0; id < plant.domains.size(); ++id) {
    const Domain& domain = plant.domains[id];
    text += fmt::format(
        kLine, id, domain.name, domain.parent.valid() ? std::to_string(domain.parent.value) : "-",
        domain.kind == DomainKind::Leaf ? "leaf" : "branch", domain.level, domain.group,
        domain.surface.triangles.size(), fmt::format("{:.3g}", box_of(domain.surface).diagonal().norm()),
        closedness(domain.surface));
  }
  return text;
}

}  // namespace

std::string inspect_plant(const std::filesystem::path& path, const InspectOptions& options) {
  const SegmentedPlant plant = read_plant(path);
  Box box;
  size_t triangles = 0;
  for (const Domain& domain : plant.domains) {
    box.extend(box_of(domain.surface));
    triangles += domain.surface.triangles.size();
  }
  const Vec3 size = box.sizes();
  std::string text = fmt::format(
      "{}: a segmented plant\n{} domains, {} triangles (welded by position), {:.3g} x {:.3g} x {:.3g} m "
      "(height is y; "
      "metres, +Y up)\nhash {}\n\n",
      path.string(), plant.domains.size(), triangles, size.x(), size.y(), size.z(),
      hash_text(plant.source_hash));
  text += summary(plant);
  if (options.all_domains) return text + "\n" + domain_list(plant);
  return text + "(every domain: --domains)\n";
}

}  // namespace liana
