// A plant whose branches and leaves are separate surfaces: what the offline stage starts from.
#pragma once

#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// One branch or leaf: a surface of one material.
struct Domain {
  std::string name;
  DomainId parent;  ///< invalid for a trunk; parents come before children
  double parent_confidence =
      1;  ///< that the parent is the right one, 0 to 1; 1 where the file says so itself
  DomainKind kind = DomainKind::Branch;
  int level = 0;            ///< depth in the domain tree, 0 for a trunk
  std::string group;        ///< material group; never empty: as given, else "leaf" or "level<N>"
  double thickness = 3e-4;  ///< m, of a leaf given as a sheet
  Mesh surface;             ///< world frame, welded by position, as modelled (may be open or a sheet)
};

struct SegmentedPlant {
  std::string name;
  std::vector<Domain> domains;
  std::vector<std::string> notes;  ///< what reading it guessed, mended or passed over; one line each
  uint64_t source_hash = 0;        ///< of the file it was read from
};

}  // namespace liana
