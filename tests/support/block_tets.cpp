#include "tests/support/block_tets.h"

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

}  // namespace liana
