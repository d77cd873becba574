// Four numbers at once, and vectors, quaternions and matrices of them: one particle per lane.
//
// Compiled more than once, for different processors: whatever includes this names its copy with LIANA_LANES
// (a namespace) first, so that no copy can stand in for another. Every operation is one rounding of IEEE 754
// in the same order everywhere, so all copies give the same bits.
#pragma once

#include <cstddef>

#ifndef LIANA_LANES
#error "name this copy: #define LIANA_LANES"
#endif

namespace liana::LIANA_LANES {

typedef double Lanes __attribute__((vector_size(32)));

inline Lanes all(double value) {
  return Lanes{value, value, value, value};
}
inline Lanes root(Lanes v) {
  Lanes r;
  for (int k = 0; k < 4; ++k) r[k] = __builtin_sqrt(v[k]);
  return r;
}
inline Lanes max(Lanes a, Lanes b) {
  return a > b ? a : b;
}

inline Lanes load(const double* from) {
  Lanes v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
inline void store(Lanes v, double* to) {
  __builtin_memcpy(to, &v, sizeof v);
}

/// Rows become columns: four numbers of each of four particles, one particle per lane, and back.
inline void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Lanes ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lanes cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// The records of four particles in an array of records, `stride` numbers apart.
template <class Number>
struct Rows {
  Number* row[4];

  Rows(Number* base, unsigned stride, const unsigned* index)
      : row{base + std::size_t(stride) * index[0], base + std::size_t(stride) * index[1],
            base + std::size_t(stride) * index[2], base + std::size_t(stride) * index[3]} {}

  void get(int at, Lanes& a, Lanes& b, Lanes& c, Lanes& d) const {
    a = load(row[0] + at), b = load(row[1] + at), c = load(row[2] + at), d = load(row[3] + at);
    transpose(a, b, c, d);
  }
  void set(int at, int lanes, Lanes a, Lanes b, Lanes c, Lanes d) const {
    transpose(a, b, c, d);
    store(a, row[0] + at);
    if (lanes > 1) store(b, row[1] + at);
    if (lanes > 2) store(c, row[2] + at);
    if (lanes > 3) store(d, row[3] + at);
  }
  void add(int at, int lanes, Lanes a, Lanes b, Lanes c, Lanes d) const {  // lanes may share a row
    transpose(a, b, c, d);
    store(load(row[0] + at) + a, row[0] + at);
    if (lanes > 1) store(load(row[1] + at) + b, row[1] + at);
    if (lanes > 2) store(load(row[2] + at) + c, row[2] + at);
    if (lanes > 3) store(load(row[3] + at) + d, row[3] + at);
  }
};

struct Vec3L {
  Lanes x, y, z;
};
inline Vec3L operator+(const Vec3L& a, const Vec3L& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3L operator-(const Vec3L& a, const Vec3L& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3L operator-(const Vec3L& a) {
  return {-a.x, -a.y, -a.z};
}
inline Vec3L operator*(Lanes s, const Vec3L& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Vec3L operator*(double s, const Vec3L& a) {
  return all(s) * a;
}
inline Lanes dot(const Vec3L& a, const Vec3L& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3L times(const Vec3L& a, const Vec3L& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Vec3L cross(const Vec3L& a, const Vec3L& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Mat3L {
  Vec3L column[3];
};
inline Vec3L operator*(const Mat3L& m, const Vec3L& v) {
  return v.x * m.column[0] + v.y * m.column[1] + v.z * m.column[2];
}
inline Vec3L transposed_times(const Mat3L& m, const Vec3L& v) {
  return {dot(m.column[0], v), dot(m.column[1], v), dot(m.column[2], v)};
}

struct QuatL {
  Vec3L v;
  Lanes w;
};
inline QuatL operator*(const QuatL& a, const QuatL& b) {
  return {a.w * b.v + b.w * a.v + cross(a.v, b.v), a.w * b.w - dot(a.v, b.v)};
}
inline QuatL conjugate(const QuatL& q) {
  return {-q.v, q.w};
}
inline Mat3L matrix(const QuatL& q) {
  const Vec3L d = q.v + q.v;  // 2v
  const Lanes xx = d.x * q.v.x, yy = d.y * q.v.y, zz = d.z * q.v.z, xy = d.x * q.v.y, xz = d.x * q.v.z,
              yz = d.y * q.v.z, wx = d.x * q.w, wy = d.y * q.w, wz = d.z * q.w, one = all(1);
  return {{{one - (yy + zz), xy + wz, xz - wy},
           {xy - wz, one - (xx + zz), yz + wx},
           {xz + wy, yz - wx, one - (xx + yy)}}};
}
inline Vec3L rotate(const QuatL& q, const Vec3L& v) {
  const Vec3L t = cross(q.v, v), d = t + t;
  return v + q.w * d + cross(q.v, d);
}
inline QuatL normalized(const QuatL& q) {
  const Lanes s = all(1) / root(dot(q.v, q.v) + q.w * q.w);
  return {s * q.v, s * q.w};
}

/// Polynomial in u, coefficients from the constant on.
template <int n>
inline Lanes polynomial(const double (&c)[n], Lanes u) {
  Lanes sum = all(c[n - 1]);
  for (int k = n - 2; k >= 0; --k) sum = sum * u + all(c[k]);
  return sum;
}

/// The rotation by |v| radians about v; unit to rounding for turns below half a circle, to 1e-15 × turns
/// beyond.
inline QuatL rotation_exp(const Vec3L& v) {
  // cos √x and sin(√x)/√x by Taylor: the next terms are below 2e-17 at x = 2.5
  constexpr double kCos[] = {1.,
                             -1. / 2,
                             1. / 24,
                             -1. / 720,
                             1. / 40320,
                             -1. / 3628800,
                             1. / 479001600,
                             -1. / 87178291200,
                             1. / 20922789888000,
                             -1. / 6402373705728000,
                             1. / 2432902008176640000};
  constexpr double kSin[] = {1.,
                             -1. / 6,
                             1. / 120,
                             -1. / 5040,
                             1. / 362880,
                             -1. / 39916800,
                             1. / 6227020800,
                             -1. / 1307674368000,
                             1. / 355687428096000,
                             -1. / 121645100408832000,
                             1. / 51090942171709440000.};
  Lanes x = all(0.25) * dot(v, v);  // half the angle, squared
  double largest = x[0];
  for (int k = 1; k < 4; ++k) largest = x[k] > largest ? x[k] : largest;
  int halvings = 0;
  for (; largest > 2.5 && halvings < 30; ++halvings) largest *= 0.25;
  Lanes scale = all(0.5);
  for (int k = 0; k < halvings; ++k) x *= all(0.25), scale *= all(0.5);
  Lanes c = polynomial(kCos, x), s = scale * polynomial(kSin, x);  // sin(…)/angle
  for (int k = 0; k < halvings; ++k) {
    s = all(2) * s * c;
    const Lanes sine2 = s * s * dot(v, v);
    c = all(2) * c * c - all(1);
    if (k + 1 < halvings) {  // keep the pair on the circle while it doubles
      const Lanes fix = all(1) / root(c * c + sine2);
      c *= fix, s *= fix;
    }
  }
  return {s * v, c};
}

/// A rotation's vector φ (|φ| ≤ π) with the coefficients of its two Jacobians:
/// dφ = (1 − ½[φ]× + rate2 [φ]×²) dθ and dθ = (1 + turn1 [φ]× + turn2 [φ]×²) dφ, dθ applied from the left.
struct RotationLogL {
  Vec3L vector;
  Lanes rate2, turn1, turn2;
};

inline RotationLogL rotation_log(const QuatL& q) {
  // atan(√u)/√u for u ≤ tan²(π/8), interpolated at Chebyshev points to 2e-18
  constexpr double kAtan[] = {1,
                              -0.33333333333333121,
                              0.19999999999940904,
                              -0.14285714279252212,
                              0.11111110744993317,
                              -0.09090896810458074,
                              0.076920453493070695,
                              -0.066629520271787507,
                              0.058468803372631842,
                              -0.050351153392916785,
                              0.037965704557720352,
                              -0.017806035956011459};
  const Lanes one = all(1);
  const Lanes sign = q.w < all(0) ? -one : one;  // q and −q are one rotation: take the one of |φ| ≤ π
  const Vec3L v = sign * q.v;
  const Lanes w = sign * q.w, s2 = dot(v, v);
  // tan of a quarter and of an eighth of the angle
  const Lanes below = w + root(w * w + s2), t2 = s2 / (below * below), eighth = one + root(one + t2);
  const Lanes g = all(4) * polynomial(kAtan, t2 / (eighth * eighth)) / (below * eighth);  // ½|φ| / |v|
  const Lanes h2 = g * g * s2, phi2 = all(4) * h2, safe = phi2 > all(1e-7) ? phi2 : one;
  RotationLogL log;
  log.vector = (g + g) * v;
  const Lanes gw = g * w;  // h cot h; and sin|φ|/|φ| = w/g
  // Below 3e-4 rad the first term alone, of which the next is 1e-9 and counts times φ².
  log.rate2 = phi2 > all(1e-7) ? (one - gw) / safe : all(1.0 / 12);
  log.turn1 = all(0.5) / (g * g);
  log.turn2 = phi2 > all(1e-7) ? (one - w / g) / safe : all(1.0 / 6);
  return log;
}

}  // namespace liana::LIANA_LANES
