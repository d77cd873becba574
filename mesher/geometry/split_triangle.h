// A triangle cut along a line that crosses it.
#pragma once

#include <array>

#include "mesher/geometry/mesh.h"

namespace liana {

/// Cuts a triangle whose corners lie on both sides of a line (`side` -1 or 1; 0 on it). point(a, b) gives the
/// vertex where the line crosses the edge ab; add(triangle, side) takes the parts, the one of a corner alone
/// on its side first. A quadrangle that remains is halved along the diagonal that `shorter(a, b, c, d)` says:
/// ab rather than cd.
template <class Point, class Shorter, class Add>
void split_triangle(const Triangle& t, const std::array<int, 3>& side, Point point, Shorter shorter,
                    Add add) {
  const int below = (side[0] < 0) + (side[1] < 0) + (side[2] < 0);
  const int above = (side[0] > 0) + (side[1] > 0) + (side[2] > 0);
  const int lone = below + above == 2 ? 0 : below == 1 ? -1 : 1;  // the corner cut from, by its side
  const uint32_t k = side[0] == lone ? 0 : side[1] == lone ? 1 : 2;
  const uint32_t o = t[k], p = t[(k + 1) % 3], q = t[(k + 2) % 3];
  if (lone == 0) {
    const uint32_t m = point(p, q);
    add(Triangle{o, p, m}, side[(k + 1) % 3]);
    add(Triangle{o, m, q}, side[(k + 2) % 3]);
    return;
  }
  const uint32_t m = point(o, p), n = point(o, q);
  add(Triangle{o, m, n}, lone);
  const bool through_m = shorter(m, q, n, p);
  add(through_m ? Triangle{m, p, q} : Triangle{m, p, n}, -lone);
  add(through_m ? Triangle{m, q, n} : Triangle{p, q, n}, -lone);
}

}  // namespace liana
