#include "mesher/tets/tetgen_driver.h"

#include <fmt/core.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "mesher/base/error.h"
#include "mesher/tets/assertion_guard.h"
#define TETLIBRARY
#include <tetgen.h>

namespace liana {
namespace {

constexpr int kRootMarker = 2, kOtherMarker = 1;

/// TetGen's exact predicates keep their error bounds in globals that every call to its tetrahedralize()
/// writes again, passing through wrong values: two threads would corrupt each other. They are set once here,
/// for extents of 1, which are safe bounds for anything smaller.
void initialise_predicates() {
  static std::once_flag once;
  std::call_once(once, [] { exactinit(0, 0, 0, 1, 1, 1); });
}

/// A random insertion order keeps incremental Delaunay fast. TetGen's own uses rand(), whose state all
/// threads share: results would depend on the schedule.
std::vector<uint32_t> insertion_order(size_t count) {
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  uint64_t state = count;
  for (size_t i = count; i > 1; --i) {
    state = state * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX generator
    std::swap(order[i - 1], order[(state >> 33) % i]);
  }
  return order;
}

void fill_input(tetgenio& in, std::span<const Vec3> positions, std::span<const Triangle> triangles,
                std::span<const uint8_t> is_root, const std::vector<uint32_t>& order) {
  std::vector<int> place(order.size());
  for (size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);

  in.numberofpoints = static_cast<int>(positions.size());
  in.pointlist = new REAL[3 * positions.size()];
  for (size_t i = 0; i < order.size(); ++i) Eigen::Map<Vec3>(in.pointlist + 3 * i) = positions[order[i]];

  in.numberoffacets = static_cast<int>(triangles.size());
  in.facetlist = new tetgenio::facet[triangles.size()];
  in.facetmarkerlist = new int[triangles.size()];
  for (size_t t = 0; t < triangles.size(); ++t) {
    in.facetmarkerlist[t] = is_root[t] ? kRootMarker : kOtherMarker;
    tetgenio::facet& facet = in.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new int[3];
    for (int k = 0; k < 3; ++k) facet.polygonlist[0].vertexlist[k] = place[triangles[t][k]];
  }
}

/// The steps of TetGen's tetrahedralize() for the switches p, Y and q, without its exactinit() and rand().
void mesh_volume(tetgenbehavior& behavior, bool refine, tetgenio& in, tetgenio& out) {
  // When TetGen throws or fails an assertion, its own destructor reads freed memory: such a mesh is given up
  // as it is.
  auto* mesh = new tetgenmesh;
  clock_t ticks = 0;
  mesh->b = &behavior;
  mesh->in = &in;
  mesh->initializepools();
  mesh->transfernodes();
  mesh->incrementaldelaunay(ticks);
  mesh->meshsurface();
  mesh->recoverboundary(ticks);
  mesh->carveholes();
  if (mesh->subvertstack->objects > 0) mesh->suppresssteinerpoints();
  mesh->recoverdelaunay();
  if (refine) mesh->delaunayrefinement();
  mesh->optimizemesh();
  mesh->outnodes(&out);
  mesh->outelements(&out);
  mesh->outsubfaces(&out);
  delete mesh;
}

}  // namespace

TetGenResult run_tetgen(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                        std::span<const uint8_t> is_root, const TetOptions& options, Polish polish) {
  initialise_predicates();
  TetGenResult result;
  const std::vector<uint32_t> order = insertion_order(positions.size());
  tetgenio in, out;
  fill_input(in, positions, triangles, is_root, order);

  tetgenbehavior behavior;
  std::string switches = fmt::format("pYq{}/{}Q", options.radius_edge_ratio, options.min_dihedral);
  require(behavior.parse_commandline(switches.data()), "TetGen refuses its switches");
  behavior.optscheme = polish == Polish::Flips ? 1 : 7;
  behavior.no_sort = 1;
  // Memory in blocks of the mesh's size; TetGen's default blocks spend a fifth of a small domain's time in
  // page faults.
  const int block = std::clamp(static_cast<int>(2 * positions.size()), 64, 8188);
  behavior.vertexperblock = behavior.shellfaceperblock = block;
  behavior.tetrahedraperblock = 4 * block;
  behavior.brio_hilbert = 0;
  try {
    if (!survives_tetgen_assertions([&] { mesh_volume(behavior, polish == Polish::Points, in, out); })) {
      result.failure = "TetGen failed an assertion of its own";
      return result;
    }
  } catch (int code) {
    result.failure =
        code == 3 ? "TetGen found a self-intersection" : fmt::format("TetGen gave up (code {})", code);
    return result;
  }

  const auto original = [&](int i) {
    return static_cast<size_t>(i) < order.size() ? order[i] : static_cast<uint32_t>(i);
  };
  result.positions.resize(out.numberofpoints);
  for (int i = 0; i < out.numberofpoints; ++i)
    result.positions[original(i)] = Eigen::Map<const Vec3>(out.pointlist + 3 * i);
  result.tets.resize(out.numberoftetrahedra);
  for (int t = 0; t < out.numberoftetrahedra; ++t)
    for (int k = 0; k < 4; ++k) result.tets[t][k] = original(out.tetrahedronlist[4 * t + k]);
  for (int f = 0; f < out.numberoftrifaces; ++f) {
    const int* face = out.trifacelist + 3 * f;
    result.boundary.push_back(
        {{original(face[0]), original(face[1]), original(face[2])}, out.trifacemarkerlist[f] == kRootMarker});
  }
  return result;
}

}  // namespace liana
