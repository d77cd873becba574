#include "tests/support/solids/block_tets.h"

#include <algorithm>
#include <map>

namespace liana {

TetMesh make_block(int nx, int ny, int nz, const std::function<Vec3(const Vec3&)>& map) {
  TetMesh mesh;
  const auto vertex = [&](int i, int j, int k) {
    return static_cast<uint32_t>((k * (ny + 1) + j) * (nx + 1) + i);
  };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        mesh.positions.push_back(map(Vec3(double(i) / nx, double(j) / ny, double(k) / nz)));
  // Kuhn's six tets share the diagonal of the cell; each walks the axes in one order. Neighbours mirror each
  // other.
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (int order = 0; order < 6; ++order) {
          const std::array<int, 3> cell = {i, j, k};
          std::array<int, 3> at;
          for (int axis = 0; axis < 3; ++axis) at[axis] = cell[axis] + cell[axis] % 2;
          std::array<uint32_t, 4> tet;
          tet[0] = vertex(at[0], at[1], at[2]);
          for (int step = 0; step < 3; ++step) {
            const int axis = kOrders[order][step];
            at[axis] += cell[axis] % 2 ? -1 : 1;
            tet[step + 1] = vertex(at[0], at[1], at[2]);
          }
          if ((order >= 3) != ((i + j + k) % 2 == 1)) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
  for (const auto& t : mesh.tets)
    for (const auto& f : {std::array{t[1], t[2], t[3]}, std::array{t[0], t[3], t[2]},
                          std::array{t[0], t[1], t[3]}, std::array{t[0], t[2], t[1]}})
      if (f[0] % (nx + 1) == 0 && f[1] % (nx + 1) == 0 && f[2] % (nx + 1) == 0) mesh.root_faces.push_back(f);
  return mesh;
}

TetMesh refined(const TetMesh& mesh) {
  TetMesh fine;
  fine.positions = mesh.positions;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [entry, added] =
        middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(fine.positions.size()));
    if (added) fine.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
    return entry->second;
  };
  for (const auto& [a, b, c, d] : mesh.tets) {
    const uint32_t ab = middle(a, b), ac = middle(a, c), ad = middle(a, d), bc = middle(b, c),
                   bd = middle(b, d), cd = middle(c, d);
    // Corners, then the octahedron between them about its diagonal ac-bd.
    for (std::array<uint32_t, 4> tet : {std::array{a, ab, ac, ad},
                                        {ab, b, bc, bd},
                                        {ac, bc, c, cd},
                                        {ad, bd, cd, d},
                                        {ac, bd, ab, ad},
                                        {ac, bd, ad, cd},
                                        {ac, bd, cd, bc},
                                        {ac, bd, bc, ab}}) {
      const Vec3& o = fine.positions[tet[0]];
      const Vec3 u = fine.positions[tet[1]] - o, v = fine.positions[tet[2]] - o,
                 w = fine.positions[tet[3]] - o;
      if (u.cross(v).dot(w) < 0) std::swap(tet[2], tet[3]);
      fine.tets.push_back(tet);
    }
  }
  for (const auto& [a, b, c] : mesh.root_faces) {
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& face : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
      fine.root_faces.push_back(face);
  }
  return fine;
}

}  // namespace liana
