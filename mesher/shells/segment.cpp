#include "mesher/shells/segment.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_set>

#include "mesher/base/error.h"
#include "mesher/base/parallel.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/io/leaf_names.h"
#include "mesher/shells/hierarchy.h"
#include "mesher/shells/split_shells.h"
#include "mesher/shells/unit_guess.h"
#include "mesher/solids/skins/skin_cut.h"

namespace liana {
namespace {

constexpr double kMaxExtent = 1e4;  // m

/// Shells with what was found of each, in one order.
struct Parts {
  std::vector<Shell> shells;
  std::vector<ShellShape> shapes;
  std::vector<DomainKind> kinds;
};

/// Lines of triangles without area are no surface.
size_t drop_flat(std::vector<Shell>& shells) {
  return std::erase_if(shells, [](const Shell& shell) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : shell.surface.positions) box.extend(p);
    return !(surface_area(shell.surface) > 1e-12 * box.diagonal().squaredNorm());
  });
}

Parts parts_of(std::vector<Shell> shells, const std::vector<SoupLabel>& labels) {
  Parts parts;
  parts.shells = std::move(shells);
  parts.shapes.resize(parts.shells.size());
  parallel_for(
      parts.shells.size(), 0,
      [&](size_t s, unsigned) { parts.shapes[s] = shape_of(parts.shells[s].surface); }, 16);
  for (size_t s = 0; s < parts.shells.size(); ++s) {
    const SoupLabel& label = labels[parts.shells[s].label];
    const auto says = [&](bool (*named)(const std::string&)) {  // the material before the object
      return named(label.material) ||
             (!named_as_leaf(label.material) && !named_as_branch(label.material) && named(label.object));
    };
    const bool leaf = says(named_as_leaf) || (!says(named_as_branch) && parts.shapes[s].sheet);
    parts.kinds.push_back(leaf ? DomainKind::Leaf : DomainKind::Branch);
  }
  return parts;
}

/// Cuts the skins that hold several branches; every piece becomes a shell. Returns how many skins there were.
size_t cut_skins(Parts& parts, const std::vector<SoupLabel>& labels, std::vector<std::string>& notes) {
  std::vector<std::vector<SkinPiece>> pieces(parts.shells.size());
  parallel_for(parts.shells.size(), 0, [&](size_t s, unsigned) {
    if (parts.kinds[s] != DomainKind::Branch || !parts.shapes[s].forks) return;
    if (is_branching_skin(parts.shells[s].surface)) pieces[s] = cut_skin(parts.shells[s].surface);
  });
  size_t skins = 0;
  std::vector<Shell> shells;
  for (size_t s = 0; s < pieces.size(); ++s) {
    const auto first = static_cast<int>(shells.size());
    if (pieces[s].size() < 2) {
      shells.push_back(std::move(parts.shells[s]));
      continue;
    }
    ++skins;
    if (const SkinPiece& root = pieces[s][0]; root.lost_area > 1e-6)
      notes.push_back(
          fmt::format("mending a skin of {} branches cost it {:.2g} % of its area and {:.2g} % of its volume",
                      pieces[s].size(), 100 * root.lost_area, 100 * root.lost_volume));
    for (SkinPiece& piece : pieces[s])
      shells.push_back(
          {std::move(piece.surface), parts.shells[s].label, piece.parent < 0 ? -1 : first + piece.parent});
  }
  if (skins == 0) {
    parts.shells = std::move(shells);
    return 0;
  }
  parts = parts_of(std::move(shells), labels);
  for (size_t s = 0; s < parts.shells.size(); ++s) {  // a piece is a branch however flat
    const int parent = parts.shells[s].grows_from;
    const bool carrier = parent >= 0 && !parts.shapes[parent].bones.empty();
    if (parent >= 0 && !carrier) parts.shells[s].grows_from = -1;
    if (carrier) parts.kinds[s] = DomainKind::Branch, parts.kinds[parent] = DomainKind::Branch;
  }
  return skins;
}

double median(std::vector<double> values, double quantile = 0.5) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<ptrdiff_t>(quantile * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

PlantSizes sizes_of(const Parts& parts, const std::vector<Vec3>& positions) {
  PlantSizes sizes;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : positions) box.extend(p);
  sizes.height = box.sizes().maxCoeff();
  std::vector<double> leaves, branches;
  for (size_t s = 0; s < parts.shapes.size(); ++s) {
    const std::vector<ShellEnd>& ends = parts.shapes[s].ends;
    if (parts.kinds[s] == DomainKind::Leaf)
      leaves.push_back((ends[0].point - ends[1].point).norm());
    else if (!parts.shapes[s].bones.empty())
      branches.push_back(2 * std::max(ends[0].radius, ends[1].radius));
  }
  sizes.leaf_length = median(leaves), sizes.thin_branch = median(branches, 0.1);
  return sizes;
}

/// Metres per unit of the file; says what was guessed.
double find_scale(const Parts& parts, const TriangleSoup& soup, Unit unit, const std::string& file,
                  std::vector<std::string>& notes) {
  const PlantSizes sizes = sizes_of(parts, soup.positions);
  if (unit == Unit::Auto) {
    const UnitGuess guess = guess_unit(sizes);
    unit = guess.unit;
    notes.push_back(fmt::format("unit guessed: {} ({}){}", name_of(unit), guess.reason,
                                guess.doubt > 0.1 ? "; not sure: say it with --unit m, cm or mm" : ""));
  }
  if (!(sizes.height * metres(unit) <= kMaxExtent))
    throw Error(Error::Kind::Input, fmt::format("{}: is {:.3g} m large", file, sizes.height * metres(unit)),
                "say in which unit it is with --unit cm or mm, or scale it");
  return metres(unit);
}

std::string count(size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

void note_shells(const Shells& found, std::vector<std::string>& notes) {
  notes.push_back(fmt::format("{} found in the merged mesh ({} by vertex number, {} if all were welded)",
                              count(found.shells.size(), "shell", "shells"), found.index_parts,
                              found.welded_parts));
  if (found.doubled)
    notes.push_back(count(found.doubled, "doubled triangle", "doubled triangles") + " removed");
  if (found.flat) notes.push_back(count(found.flat, "triangle", "triangles") + " without area removed");
}

void note_growth(const SegmentedPlant& plant, std::vector<std::string>& notes) {
  size_t trunks = 0, doubtful = 0;
  std::string names;
  for (const Domain& domain : plant.domains) {
    trunks += !domain.parent.valid();
    if (domain.parent_confidence >= 0.5) continue;
    if (++doubtful <= 5)
      names +=
          fmt::format("{}'{}' ({:.2f})", names.empty() ? "" : ", ", domain.name, domain.parent_confidence);
  }
  notes.push_back(fmt::format("hierarchy found by contact: {}; {}", count(trunks, "trunk", "trunks"),
                              doubtful ? fmt::format("{} of {} parents doubtful: {}{}", doubtful,
                                                     plant.domains.size(), names, doubtful > 5 ? ", ..." : "")
                                       : "no parent is doubtful"));
}

/// Shells in an order with parents first, by depth and then as in the file.
std::vector<uint32_t> parents_first(const std::vector<Growth>& growth, std::vector<int>& depth) {
  depth.assign(growth.size(), -1);
  for (size_t s = 0; s < growth.size(); ++s) {
    std::vector<size_t> chain;
    size_t at = s;
    while (depth[at] < 0 && growth[at].parent >= 0)
      chain.push_back(at), at = static_cast<size_t>(growth[at].parent);
    int d = depth[at] < 0 ? (depth[at] = 0) : depth[at];
    for (; !chain.empty(); chain.pop_back()) depth[chain.back()] = ++d;
  }
  std::vector<uint32_t> order(growth.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return depth[a] < depth[b]; });
  return order;
}

SegmentedPlant domains_of(Parts parts, const std::vector<Growth>& growth,
                          const std::vector<SoupLabel>& labels, double scale) {
  std::map<std::string, size_t> shells_of_object;
  for (const Shell& shell : parts.shells) ++shells_of_object[labels[shell.label].object];
  std::vector<int> depth;
  const std::vector<uint32_t> order = parents_first(growth, depth);
  std::vector<uint32_t> place(order.size());
  SegmentedPlant plant;
  std::unordered_set<std::string> names;
  size_t branches = 0, leaves = 0;
  for (const uint32_t s : order) {
    place[s] = static_cast<uint32_t>(plant.domains.size());
    Domain domain;
    domain.kind = parts.kinds[s];
    const bool leaf = domain.kind == DomainKind::Leaf;
    const std::string& object = labels[parts.shells[s].label].object;
    domain.name = fmt::format("{}{}", leaf ? "leaf" : "branch", leaf ? ++leaves : ++branches);
    if (!object.empty() && shells_of_object[object] == 1) domain.name = object;
    const std::string name = domain.name;
    for (int i = 2; !names.insert(domain.name).second; ++i) domain.name = fmt::format("{}~{}", name, i);
    domain.level = depth[s];
    domain.group = leaf ? "leaf" : fmt::format("level{}", domain.level);
    if (growth[s].parent >= 0) domain.parent = DomainId(place[static_cast<size_t>(growth[s].parent)]);
    domain.parent_confidence = growth[s].confidence;
    domain.surface = std::move(parts.shells[s].surface);
    for (Vec3& p : domain.surface.positions) p *= scale;
    plant.domains.push_back(std::move(domain));
  }
  return plant;
}

}  // namespace

SegmentedPlant segment(const TriangleSoup& soup, Unit unit, const std::string& file) {
  Shells found = split_shells(soup);
  std::vector<std::string> notes = soup.notes;
  const size_t flat = drop_flat(found.shells);
  note_shells(found, notes);
  if (flat) notes.push_back(count(flat, "shell", "shells") + " without area left out");
  Parts parts = parts_of(std::move(found.shells), soup.labels);
  if (const size_t skins = cut_skins(parts, soup.labels, notes))
    notes.push_back(count(skins, "skin that holds", "skins that hold") +
                    fmt::format(" several branches cut: {} parts in all", parts.shells.size()));
  const auto leaves =
      static_cast<size_t>(std::count(parts.kinds.begin(), parts.kinds.end(), DomainKind::Leaf));
  const bool any_branch = std::any_of(parts.shapes.begin(), parts.shapes.end(), [&](const ShellShape& shape) {
    return !shape.bones.empty() && parts.kinds[&shape - parts.shapes.data()] == DomainKind::Branch;
  });
  if (parts.shells.empty())
    throw Error(Error::Kind::Input, file + ": none of its triangles has an area",
                "look at it in the program that made it: is it scaled to nothing?");
  if (!any_branch)
    throw Error(Error::Kind::Input,
                fmt::format("{}: none of its {} is a branch: all are sheets or named as leaves", file,
                            count(parts.shells.size(), "shell", "shells")),
                "a plant needs a branch or stem with a round surface for its leaves to grow from");
  notes.push_back(count(parts.shells.size() - leaves, "branch", "branches") + ", " +
                  count(leaves, "leaf", "leaves"));
  const double scale = find_scale(parts, soup, unit, file, notes);
  std::vector<int> known;
  for (const Shell& shell : parts.shells) known.push_back(shell.grows_from);
  const std::vector<Growth> growth = find_growth(parts.shapes, parts.kinds, known, Vec3::UnitY());
  SegmentedPlant plant = domains_of(std::move(parts), growth, soup.labels, scale);
  note_growth(plant, notes);
  plant.notes = std::move(notes);
  return plant;
}

}  // namespace liana
