#include "mesher/solids/solidify/sheet.h"

#include "mesher/geometry/mesh_checks.h"
#include "mesher/solids/solidify/cap.h"

namespace liana {

bool is_sheet(const Mesh& mesh, const std::vector<std::vector<uint32_t>>& loops) {
  // Lids over area: tube of length L, radius r: r/L (0.5 when as long as wide); cup: at most 0.5; flat sheet:
  // 1; a sheet bent to a half cylinder: 0.64.
  constexpr double kSheetRatio = 0.57;
  double lids = 0;
  for (const std::vector<uint32_t>& loop : loops) lids += lid_area(mesh, loop);
  return lids > kSheetRatio * surface_area(mesh);
}

Mesh extrude_sheet(const Mesh& sheet, const std::vector<std::vector<uint32_t>>& loops, double thickness) {
  const auto n = static_cast<uint32_t>(sheet.positions.size());
  // Offset o_v = (t/2) n_v A_v / |N_v|, with N_v the sum of the area vectors around v, A_v of the areas: then
  // the first-order volume Σ_f Σ_{v in f} (2/3) A_f n_f·o_v is t Σ A_f exactly.
  std::vector<Vec3> normal(n, Vec3::Zero());
  std::vector<double> area(n, 0);
  for (const Triangle& t : sheet.triangles) {
    const Vec3 vector = area_vector(sheet, t);
    for (const uint32_t v : t) {
      normal[v] += vector;
      area[v] += vector.norm();
    }
  }
  Mesh solid;
  solid.positions.resize(2 * size_t{n});
  for (uint32_t v = 0; v < n; ++v) {
    const double length =
        std::max(normal[v].norm(), 0.3 * area[v]);  // a sharper fold than 145° is not mitred out
    const Vec3 offset = thickness / 2 * area[v] / (length * length) * normal[v];
    solid.positions[v] = sheet.positions[v] + offset;
    solid.positions[v + n] = sheet.positions[v] - offset;
  }
  solid.triangles = sheet.triangles;
  for (const Triangle& t : sheet.triangles) solid.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
  for (const std::vector<uint32_t>& loop : loops)
    for (size_t i = 0; i < loop.size(); ++i) {
      const uint32_t a = loop[i], b = loop[(i + 1) % loop.size()];
      solid.triangles.push_back({b, a, a + n});
      solid.triangles.push_back({b, a + n, b + n});
    }
  return solid;
}

}  // namespace liana
