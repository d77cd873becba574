#include "tests/support/solids/damage.h"

#include "mesher/geometry/mesh_checks.h"

namespace liana {

void split_one_side(Mesh& mesh, size_t triangle, double gap) {
  const Triangle t = mesh.triangles[triangle];
  const auto middle = static_cast<uint32_t>(mesh.positions.size());
  const Vec3 normal = area_vector(mesh, t).normalized();
  mesh.positions.push_back((mesh.positions[t[0]] + mesh.positions[t[1]]) / 2 + gap * normal);
  mesh.triangles[triangle] = {t[0], middle, t[2]};
  mesh.triangles.push_back({middle, t[1], t[2]});
}

void add_fin(Mesh& mesh, size_t triangle, double height) {
  const Triangle t = mesh.triangles[triangle];
  const auto tip = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back((mesh.positions[t[0]] + mesh.positions[t[1]]) / 2 +
                           height * area_vector(mesh, t).normalized());
  mesh.triangles.push_back({t[0], t[1], tip});
}

void add_septum(Mesh& mesh, int sides, int ring) {
  const auto n = static_cast<uint32_t>(sides), first = static_cast<uint32_t>(ring) * n;
  for (uint32_t i = 1; i + 1 < n; ++i) mesh.triangles.push_back({first, first + i, first + i + 1});
}

Mesh stem_of_pieces(int sides, double length, double diameter, int count, double overlap) {
  Mesh stem;
  const double piece = (length + (count - 1) * overlap) / count;
  for (int i = 0; i < count; ++i) {
    const Affine3 place(Eigen::Translation3d(0, i * (piece - overlap), 0));
    const Mesh part = transformed(make_prism(sides, piece, diameter).mesh, place);
    const auto base = static_cast<uint32_t>(stem.positions.size());
    stem.positions.insert(stem.positions.end(), part.positions.begin(), part.positions.end());
    for (const Triangle& t : part.triangles)
      stem.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  return stem;
}

void harm(Mesh& mesh, std::mt19937& random) {
  const size_t t = random() % mesh.triangles.size(), v = random() % mesh.positions.size();
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  const double size = box.diagonal().norm();
  switch (random() % 11) {
    case 0:
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<ptrdiff_t>(t));
      break;
    case 1:
      std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
      break;
    case 2:
      mesh.triangles.push_back(mesh.triangles[t]);
      break;
    case 3:
      mesh.positions[v] = mesh.positions[random() % mesh.positions.size()];
      break;
    case 4:
      mesh.positions[v] += 0.01 * size * Vec3(double(random() % 5) - 2, double(random() % 5) - 2, 1);
      break;
    case 5:
      mesh.triangles[t][random() % 3] = static_cast<uint32_t>(v);
      break;
    case 6:
      split_one_side(mesh, t, 1e-4 * size * double(random() % 3));
      break;
    case 7:
      add_fin(mesh, t, 0.1 * size);
      break;
    case 8: {  // a crossing copy
      const Mesh copy = transformed(mesh, Affine3(Eigen::Translation3d(0.02 * size, 0.1 * size, 0) *
                                                  Eigen::AngleAxisd(0.3, Vec3::UnitX())));
      const auto base = static_cast<uint32_t>(mesh.positions.size());
      if (base > 2000) break;
      mesh.positions.insert(mesh.positions.end(), copy.positions.begin(), copy.positions.end());
      for (const Triangle& c : copy.triangles)
        mesh.triangles.push_back({c[0] + base, c[1] + base, c[2] + base});
      break;
    }
    case 9: {  // a seam: the triangle's own copy of a vertex, a little off
      const uint32_t old = mesh.triangles[t][0];
      mesh.triangles[t][0] = static_cast<uint32_t>(mesh.positions.size());
      mesh.positions.push_back(mesh.positions[old] + 1e-3 * size * Vec3(1, 1, 0));
      break;
    }
    case 10:
      mesh.triangles.push_back({mesh.triangles[t][1], mesh.triangles[t][0], static_cast<uint32_t>(v)});
      break;
  }
}

}  // namespace liana
