#include "mesher/solids/solidify/cap.h"

namespace liana {

Vec3 loop_middle(const Mesh& mesh, const std::vector<uint32_t>& loop) {
  Vec3 sum = Vec3::Zero();
  double length = 0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Vec3 &a = mesh.positions[loop[i]], &b = mesh.positions[loop[(i + 1) % loop.size()]];
    const double edge = (b - a).norm();
    sum += edge * (a + b) / 2;
    length += edge;
  }
  return sum / length;
}

double lid_area(const Mesh& mesh, const std::vector<uint32_t>& loop) {
  const Vec3 middle = loop_middle(mesh, loop);
  double area = 0;
  for (size_t i = 0; i < loop.size(); ++i) {
    const Vec3 &a = mesh.positions[loop[i]], &b = mesh.positions[loop[(i + 1) % loop.size()]];
    area += (a - middle).cross(b - middle).norm() / 2;
  }
  return area;
}

size_t add_lid(Mesh& mesh, const std::vector<uint32_t>& loop) {
  if (loop.size() == 3) {
    mesh.triangles.push_back({loop[2], loop[1], loop[0]});
    return 1;
  }
  const auto centre = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back(loop_middle(mesh, loop));
  for (size_t i = 0; i < loop.size(); ++i)
    mesh.triangles.push_back({centre, loop[(i + 1) % loop.size()], loop[i]});
  return loop.size();
}

}  // namespace liana
