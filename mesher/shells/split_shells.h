// A merged mesh taken apart into its connected surfaces.
#pragma once

#include <string>
#include <vector>

#include "mesher/io/triangle_soup.h"

namespace liana {

struct Shell {
  Mesh surface;        ///< welded by position, in the soup's unit
  uint32_t label = 0;  ///< of most of its triangles, index into the soup's labels
};

struct Shells {
  std::vector<Shell> shells;     ///< in order of their first triangle
  size_t index_parts = 0;        ///< parts that share vertices by number
  size_t welded_parts = 0;       ///< parts that share places: what plain welding would give
  size_t doubled = 0, flat = 0;  ///< triangles removed: the same three places again; without three places
};

/// Triangles belong together when they share an edge by vertex number, or by position where that looks like a
/// seam (vertices split for texture or shading) rather than like two branches that meet in a ring:
/// - at an edge with more than two triangles the pair that runs on most straightly belongs together;
/// - two parts that touch in part of their borders are one, as are a tube and the lid or tip that fills its
/// end;
/// - two tubes whose end rings coincide stay two;
/// - parts of differing objects, or of which one only is named a leaf, stay apart.
Shells split_shells(const TriangleSoup& soup);

}  // namespace liana
