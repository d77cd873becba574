// From any triangles to one consistently wound manifold shell.
#pragma once

#include <string>

#include "mesher/geometry/mesh.h"

namespace liana {

struct CleanShell {
  Mesh mesh;                  ///< an oriented manifold, open or closed, without duplicated or flat triangles
  bool double_sided = false;  ///< faces came in pairs back to back
  double kept = 1;            ///< the part's share of the area of all parts
  double lost_volume = 0;     ///< m³ in the other parts
  std::string notes;          ///< what was done, each with a leading "+"; empty if nothing
};

/// Drops duplicated triangles (of a pair back to back one stays), removes flat ones, winds neighbours alike
/// and keeps the part with the largest area. Throws Error{Input} starting with `where` if an edge has three
/// triangles or the surface has one side only.
CleanShell clean_shell(const Mesh& welded, const std::string& where);

}  // namespace liana
