// What a shell looks like: a sheet or a body, along which line it runs, where it ends.
#pragma once

#include <vector>

#include "mesher/geometry/mesh.h"

namespace liana {

/// A stretch of a body's skeleton: a cone with round ends.
struct Bone {
  Vec3 from, to;
  double from_radius, to_radius;
  double from_along, to_along;  ///< distance along the surface from the first end
};

/// A place where a shell may grow from something.
struct ShellEnd {
  Vec3 point;
  double radius;     ///< of the body there; of a sheet half the width of the edge
  double along = 0;  ///< distance along the surface from the first end
  double doubt = 0;  ///< 0 for the ends of the long axis; more for a sheet's sides
};

struct ShellShape {
  bool sheet = false;  ///< open and flat, or closed and thin: a leaf unless its names say otherwise
  double area = 0;
  double length = 0;           ///< longest distance along the surface between two ends
  std::vector<Bone> bones;     ///< of a body; a fork has more than two at a point
  std::vector<ShellEnd> ends;  ///< at least two
  bool forks = false;          ///< its bones do: perhaps several branches in one skin
};

/// The bones join the middles of the level sets of the distance from the first end (a Reeb graph), so that
/// forks and bends are followed. Any triangles are understood, open, unoriented and branching ones too.
ShellShape shape_of(const Mesh& shell);

}  // namespace liana
