#include "runtime/obstacles/pieces.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "runtime/obstacles/closed_mesh.h"

namespace liana {
namespace {

constexpr size_t kMostSolids = 64;

struct Piece {
  Mesh mesh;
  double volume = 0;  // m³
  bool solid = false;
};

/// Pieces that share welded vertices, in the order of their first triangle.
std::vector<Piece> connected_pieces(const Mesh& mesh) {
  std::vector<uint32_t> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const Triangle& t : mesh.triangles)
    for (const int k : {1, 2}) root[find(t[k])] = find(t[0]);
  std::map<uint32_t, size_t> number;
  std::vector<Piece> pieces;
  std::vector<uint32_t> renamed(mesh.positions.size(), ~0u);
  for (const Triangle& t : mesh.triangles) {
    const auto [found, is_new] = number.try_emplace(find(t[0]), pieces.size());
    if (is_new) pieces.emplace_back();
    Mesh& piece = pieces[found->second].mesh;
    Triangle own;
    for (int k = 0; k < 3; ++k) {
      uint32_t& name = renamed[t[k]];
      if (name == ~0u) {
        name = static_cast<uint32_t>(piece.positions.size());
        piece.positions.push_back(mesh.positions[t[k]]);
      }
      own[k] = name;
    }
    piece.triangles.push_back(own);
  }
  return pieces;
}

/// Every edge walked as often one way as the other, and a volume that looks outwards.
void judge(Piece& piece) {
  std::map<std::pair<uint32_t, uint32_t>, int> balance;
  for (const Triangle& t : piece.mesh.triangles) {
    const Vec3 a = piece.mesh.positions[t[0]] - piece.mesh.positions[0];
    const Vec3 b = piece.mesh.positions[t[1]] - piece.mesh.positions[0];
    const Vec3 c = piece.mesh.positions[t[2]] - piece.mesh.positions[0];
    piece.volume += a.dot(b.cross(c)) / 6;
    for (int k = 0; k < 3; ++k) balance[std::minmax(t[k], t[(k + 1) % 3])] += t[k] < t[(k + 1) % 3] ? 1 : -1;
  }
  piece.solid = piece.volume > 0 && std::all_of(balance.begin(), balance.end(),
                                                [](const auto& edge) { return edge.second == 0; });
}

}  // namespace

Pieces pieces_of(const Mesh& mesh) {
  std::vector<Piece> pieces = connected_pieces(ClosedMesh(mesh, true).mesh());
  std::vector<double> volumes;
  for (Piece& piece : pieces) {
    judge(piece);
    if (piece.solid) volumes.push_back(piece.volume);
  }
  std::sort(volumes.rbegin(), volumes.rend());
  const double least = volumes.size() > kMostSolids ? volumes[kMostSolids - 1] : 0;

  Pieces result;
  Mesh& rest = result.sheets;
  for (Piece& piece : pieces) {
    if (piece.solid && piece.volume >= least && result.solids.size() < kMostSolids) {
      result.solids.push_back(std::move(piece.mesh));
      continue;
    }
    const auto first = static_cast<uint32_t>(rest.positions.size());
    rest.positions.insert(rest.positions.end(), piece.mesh.positions.begin(), piece.mesh.positions.end());
    for (const Triangle& t : piece.mesh.triangles)
      rest.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    ++result.sheet_count;
  }
  return result;
}

}  // namespace liana
