// parse_graph on any bytes, and what it gives written and read again.
#include "mesher/base/error.h"
#include "mesher/io/graph_file.h"
#include "mesher/solids/skins/branch_tubes.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    liana::PlantGraph graph = liana::parse_graph({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    liana::require(liana::parse_graph(liana::graph_text(graph), "again").nodes.size() == graph.nodes.size(),
                   "reads what it writes");
    liana::fill_radii(graph);
    for (const liana::Domain& domain : liana::branch_tubes(graph, "fuzz.json", 3).domains)
      for (const liana::Triangle& t : domain.surface.triangles)
        for (const uint32_t v : t) liana::require(v < domain.surface.positions.size(), "valid corners");
  } catch (const liana::Error&) {
  }
  return 0;
}
