#include "modal/elements/boundary_faces.h"

#include <algorithm>

namespace liana {

std::vector<std::array<uint32_t, 3>> boundary_faces(const TetMesh& mesh) {
  using Face = std::array<uint32_t, 3>;
  std::vector<std::pair<Face, Face>> faces;  // sorted corners, corners
  faces.reserve(4 * mesh.tets.size());
  for (const auto& [a, b, c, d] : mesh.tets)
    for (const Face& face : {Face{b, c, d}, Face{a, d, c}, Face{a, b, d}, Face{a, c, b}}) {
      Face key = face;
      std::sort(key.begin(), key.end());
      faces.push_back({key, face});
    }
  std::sort(faces.begin(), faces.end());
  std::vector<Face> boundary;
  for (size_t i = 0; i < faces.size(); ++i) {
    const bool again = (i > 0 && faces[i - 1].first == faces[i].first) ||
                       (i + 1 < faces.size() && faces[i + 1].first == faces[i].first);
    if (!again) boundary.push_back(faces[i].second);
  }
  return boundary;
}

}  // namespace liana
