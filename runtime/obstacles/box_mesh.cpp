#include "runtime/obstacles/box_mesh.h"

#include <fmt/core.h>

#include "mesher/base/error.h"

namespace liana {

Mesh box_mesh(const Vec3& low, const Vec3& high) {
  if (!((high - low).minCoeff() > 0) || !low.allFinite() || !high.allFinite())
    throw Error(Error::Kind::Input,
                fmt::format("a box from ({}, {}, {}) to ({}, {}, {}) has no volume", low.x(), low.y(),
                            low.z(), high.x(), high.y(), high.z()),
                "give the lower corner first and a thickness in every axis");
  Mesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner)  // bit a of the corner: high in axis a
    mesh.positions.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                corner & 4 ? high.z() : low.z());
  for (unsigned axis = 0; axis < 3; ++axis) {
    const unsigned n = 1u << axis, u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
    mesh.triangles.push_back({0, v, u + v});  // the low side looks backwards
    mesh.triangles.push_back({0, u + v, u});
    mesh.triangles.push_back({n, n + u, n + u + v});
    mesh.triangles.push_back({n, n + u + v, n + v});
  }
  return mesh;
}

}  // namespace liana
