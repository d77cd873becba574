// Any triangles -> a solid, a beam, or an Error.
//
// Bytes: [flags][vertex count][xyz: 3 bytes each, or copies of earlier vertices][triangles: 3 bytes each]
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "mesher/base/error.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/solids/skins/skin_cut.h"
#include "mesher/solids/solidify/solid_domain.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace liana;
  if (size < 12) return 0;
  const uint8_t flags = data[0];
  const size_t count = 4 + data[1] % 60;
  size_t at = 2;
  const auto next = [&]() -> uint8_t { return at < size ? data[at++] : 0; };
  Mesh mesh;
  for (size_t i = 0; i < count; ++i) {
    const double x = next(), y = next(), z = next();
    mesh.positions.push_back(Vec3(x, y, z) * 1e-3);
  }
  while (at < size && mesh.triangles.size() < 200) {
    const auto a = uint32_t(next() % count), b = uint32_t(next() % count), c = uint32_t(next() % count);
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});  // as weld() leaves them
  }
  SegmentedPlant plant;
  Domain domain;
  domain.name = "fuzzed";
  domain.group = "level0";
  domain.kind = flags & 1 ? DomainKind::Leaf : DomainKind::Branch;
  domain.surface = mesh;
  plant.domains.push_back(domain);
  try {
    const SolidDomain solid = make_solid(plant, DomainId(0));
    if (!solid.is_beam) {
      const Adjacency adjacency = find_adjacency(solid.surface);
      if (!adjacency.closed || !adjacency.manifold || self_intersects(solid.surface) || !(solid.volume > 0))
        std::abort();
    }
    if (solid.centreline.size() < 2 || !(solid.length > 0)) std::abort();
  } catch (const Error&) {
  }
  if (flags & 2) cut_skin(mesh);
  return 0;
}
