// Triangles of any shape through splitting and hierarchy: parents first, no cycle, or an Error. The bytes are
// coordinates on a coarse lattice, so that vertices and edges coincide often.
#include <cmath>

#include "mesher/base/error.h"
#include "mesher/shells/segment.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 20 || size > 4000) return 0;
  liana::TriangleSoup soup;
  const size_t vertices = 3 + data[0] % 64;
  soup.labels = {{"plant", data[1] & 1 ? "bark" : ""},
                 {data[1] & 2 ? "leaf" : "plant", data[1] & 4 ? "leaf" : ""}};
  size_t at = 2;
  for (; at + 3 <= size && soup.positions.size() < vertices; at += 3)
    soup.positions.push_back(liana::Vec3(data[at] % 16, data[at + 1] % 32, data[at + 2] % 16) / 10);
  for (; at + 3 <= size; at += 3) {
    liana::Triangle t;
    for (size_t k = 0; k < 3; ++k) t[k] = static_cast<uint32_t>(data[at + k] % soup.positions.size());
    soup.triangles.push_back(t), soup.label.push_back(data[at] >> 7);
  }
  if (soup.triangles.empty()) return 0;
  try {
    const liana::SegmentedPlant plant = liana::segment(soup, liana::Unit::Auto, "fuzz");
    for (size_t i = 0; i < plant.domains.size(); ++i) {
      const liana::Domain& domain = plant.domains[i];
      liana::require(!domain.parent.valid() || domain.parent.index() < i, "parents first");
      liana::require(domain.kind == liana::DomainKind::Branch || domain.parent.valid(),
                     "leaves have parents");
      liana::require(domain.parent_confidence >= 0 && domain.parent_confidence <= 1, "a confidence");
    }
  } catch (const liana::Error&) {
  }
  return 0;
}
