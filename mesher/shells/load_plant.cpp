#include "mesher/shells/load_plant.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "mesher/io/graph_file.h"
#include "mesher/io/mtg_file.h"
#include "mesher/io/plant_file.h"
#include "mesher/io/text_cursor.h"
#include "mesher/shells/segment.h"
#include "mesher/shells/unit_guess.h"
#include "mesher/solids/skins/branch_tubes.h"

namespace liana {
namespace {
namespace fs = std::filesystem;

constexpr size_t kMaxFileBytes = size_t{4} << 30;

enum class Format { Unknown, Gltf, Obj, Ply, Mtg, Graph };

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

Format format_of(const fs::path& path, std::string_view bytes) {
  const std::string extension = lower_extension(path);
  if (bytes.starts_with("glTF") || extension == ".glb" || extension == ".gltf") return Format::Gltf;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r") || extension == ".ply") return Format::Ply;
  if (extension == ".obj") return Format::Obj;
  if (extension == ".mtg") return Format::Mtg;
  const std::string_view text = without_outer_blanks(bytes.substr(0, 4096));
  if (text.starts_with("{") && text.find("\"liana_graph\"") != std::string_view::npos) return Format::Graph;
  if (text.starts_with("{") && bytes.find("\"meshes\"") != std::string_view::npos) return Format::Gltf;
  if (text.starts_with("CODE") && bytes.find("ENTITY-CODE") != std::string_view::npos) return Format::Mtg;
  return Format::Unknown;
}

/// Turns +Z up into +Y up.
void stand_up(std::vector<Vec3>& positions) {
  for (Vec3& p : positions) p = Vec3(p.x(), p.z(), -p.y());
}

SegmentedPlant load_gltf_plant(const std::string& bytes, const fs::path& path, const LoadOptions& options) {
  const double scale = options.unit == Unit::Auto ? 1 : metres(options.unit);
  GltfPlant gltf = read_gltf_plant(bytes, path, scale, options.ignore_hierarchy);
  const bool turn = options.up == UpAxis::Z;
  if (!gltf.segmented) {
    if (turn) stand_up(gltf.soup.positions);
    SegmentedPlant plant = segment(gltf.soup, Unit::Metre, path.string());
    plant.source_hash = gltf.source_hash;
    return plant;
  }
  if (turn)
    for (Domain& domain : gltf.plant.domains) stand_up(domain.surface.positions);
  return std::move(gltf.plant);
}

SegmentedPlant load_soup(TriangleSoup soup, Format format, const fs::path& path, const LoadOptions& options) {
  const UpAxis up = options.up != UpAxis::Auto ? options.up : format == Format::Ply ? UpAxis::Z : UpAxis::Y;
  if (up == UpAxis::Z) stand_up(soup.positions);
  SegmentedPlant plant = segment(soup, options.unit, path.string());
  if (options.up == UpAxis::Auto)
    plant.notes.push_back(fmt::format("up is taken to be +{}, as {} files usually have it (--up y or z)",
                                      up == UpAxis::Z ? 'Z' : 'Y', format == Format::Ply ? "PLY" : "OBJ"));
  return plant;
}

/// Positions come in the file's unit; an MTG's radii are metres already (its diameters are millimetres).
SegmentedPlant load_skeleton(PlantGraph graph, Format format, const fs::path& path,
                             const LoadOptions& options) {
  const bool mtg = format == Format::Mtg;
  const Unit unit = options.unit != Unit::Auto ? options.unit : mtg ? Unit::Centimetre : Unit::Metre;
  const bool z_up = options.up == UpAxis::Z || (options.up == UpAxis::Auto && mtg);
  for (GraphNode& node : graph.nodes) {
    node.position *= metres(unit);
    if (z_up) node.position = Vec3(node.position.x(), node.position.z(), -node.position.y());
    if (!mtg) node.radius *= metres(unit);
    if (!(node.position.cwiseAbs().maxCoeff() <= 1e4))
      throw Error(Error::Kind::Input, path.string() + ": reaches further than 10 km",
                  "say its unit with --unit m, cm or mm");
  }
  if (mtg)
    graph.notes.push_back(
        fmt::format("positions taken as {}{}, diameters as millimetres, up as +{}", name_of(unit),
                    options.unit == Unit::Auto ? ", as MTG files usually have them" : "", z_up ? 'Z' : 'Y'));
  if (const size_t filled = fill_radii(graph); filled == graph.nodes.size())
    graph.notes.push_back(
        fmt::format("no diameter is given: tips are taken to be {:.2g} mm thick, all else by the pipe model; "
                    "frequencies follow from it, so give at least the trunk's",
                    2e3 * kTipRadius));
  else if (filled > 0)
    graph.notes.push_back(
        fmt::format("{} of {} diameters are missing: filled along the axes and by the pipe model", filled,
                    graph.nodes.size()));
  return branch_tubes(graph, path.string());
}

}  // namespace

bool is_plant_file(const fs::path& path, std::string_view bytes) {
  return format_of(path, bytes) != Format::Unknown;
}

SegmentedPlant load_plant(const fs::path& path, const LoadOptions& options) {
  const std::string bytes = read_file(path, kMaxFileBytes);
  const std::string file = path.string();
  const Format format = format_of(path, bytes);
  SegmentedPlant plant;
  if (format == Format::Gltf)
    plant = load_gltf_plant(bytes, path, options);
  else if (format == Format::Obj)
    plant = load_soup(parse_obj(bytes, file), format, path, options);
  else if (format == Format::Ply)
    plant = load_soup(parse_ply(bytes, file), format, path, options);
  else if (format == Format::Mtg)
    plant = load_skeleton(parse_mtg(bytes, file), format, path, options);
  else if (format == Format::Graph)
    plant = load_skeleton(parse_graph(bytes, file), format, path, options);
  else
    throw Error(Error::Kind::Input, file + ": is not a plant in a known format",
                "give a mesh (.obj, .ply, .glb, .gltf) or a skeleton (.mtg, .json)");
  if (plant.source_hash == 0) plant.source_hash = hash_bytes(bytes.data(), bytes.size());
  plant.name = path.stem().string();
  return plant;
}

}  // namespace liana
