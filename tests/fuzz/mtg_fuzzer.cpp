// parse_mtg on any bytes: nodes with parents before them, or an Error.
#include "mesher/base/error.h"
#include "mesher/io/mtg_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    liana::PlantGraph graph = liana::parse_mtg({reinterpret_cast<const char*>(data), size}, "fuzz.mtg");
    liana::fill_radii(graph);
    for (size_t i = 0; i < graph.nodes.size(); ++i) {
      liana::require(graph.nodes[i].parent < static_cast<int>(i), "parents first");
      liana::require(graph.nodes[i].radius > 0, "a radius everywhere");
    }
  } catch (const liana::Error&) {
  }
  return 0;
}
