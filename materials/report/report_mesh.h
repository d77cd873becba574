// A plant's triangles, small enough for a page.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mesher/plant/segmented_plant.h"

namespace liana {

/// Leaves that share their triangles share one shape.
struct ReportMesh {
  struct Piece {
    int64_t id;       ///< in the bake, or -1
    size_t vertices;  ///< its own
    size_t shape;     ///< its triangles, counted from its first vertex
  };
  Vec3 origin;                                ///< m; position = origin + step · integers
  double step;                                ///< m
  std::vector<Piece> pieces;                  ///< per domain of the plant
  std::vector<std::array<size_t, 2>> shapes;  ///< first triangle and their number
  int index_bytes;                            ///< 2 or 4
  std::string positions;                      ///< base64 of uint16 x, y, z
  std::string triangles;                      ///< base64 of uint16 or uint32
};

ReportMesh report_mesh(const SegmentedPlant& plant, const std::vector<DomainId>& baked_as);

}  // namespace liana
