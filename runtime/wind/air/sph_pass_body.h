// The loops behind sph_pass.h, included once per instruction set with LIANA_TARGET and namespace LIANA_ISA
// defined. No include guard, no includes and no inline function of other headers: what is compiled for a
// newer processor must not leak out.
namespace liana::LIANA_ISA {

#define LIANA_INLINE static inline __attribute__((always_inline)) LIANA_TARGET

LIANA_INLINE Float8 spread(float a) {
  return Float8{a, a, a, a, a, a, a, a};
}
LIANA_INLINE Float8 load(const float* p) {
  return *reinterpret_cast<const Float8Loose*>(p);
}
LIANA_INLINE Float8 positive(Float8 a) {
  return a > 0 ? a : Float8{};
}

// In an order of its own, the same for both instruction sets.
LIANA_INLINE float sum(Float8 a) {
  const float u = (a[0] + a[4]) + (a[1] + a[5]), v = (a[2] + a[6]) + (a[3] + a[7]);
  return u + v;
}

LIANA_INLINE Float8 row(const float* low, const float* high) {
  const Float4 l = *reinterpret_cast<const Float4Loose*>(low),
               h = *reinterpret_cast<const Float4Loose*>(high);
  return __builtin_shufflevector(l, h, 0, 1, 2, 3, 4, 5, 6, 7);
}

// Rows of four floats from eight places, turned into four columns of eight.
LIANA_INLINE void gather4(const float* const* p, Float8& a, Float8& b, Float8& c, Float8& d) {
  const Float8 r0 = row(p[0], p[4]), r1 = row(p[1], p[5]), r2 = row(p[2], p[6]), r3 = row(p[3], p[7]);
  const Float8 u0 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 u1 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 v0 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 v1 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(u0, u1, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(u0, u1, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(v0, v1, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(v0, v1, 2, 3, 10, 11, 6, 7, 14, 15);
}

LIANA_TARGET static uint32_t gather(uint32_t begin, uint32_t end, const uint32_t (&run_begin)[9],
                                    const uint32_t (&run_end)[9], const AirConstants& k, const float* x,
                                    const float* y, const float* z, const Candidates& to) {
  const Int8 lane = {0, 1, 2, 3, 4, 5, 6, 7};
  const Float8 h2 = spread(k.support * k.support);
  float low[3] = {x[begin], y[begin], z[begin]}, high[3] = {x[begin], y[begin], z[begin]};
  for (uint32_t i = begin + 1; i < end; ++i) {
    const float place[3] = {x[i], y[i], z[i]};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = place[axis] < low[axis] ? place[axis] : low[axis];
      high[axis] = place[axis] > high[axis] ? place[axis] : high[axis];
    }
  }
  const Float8 x0 = spread(low[0]), y0 = spread(low[1]), z0 = spread(low[2]);
  const Float8 x1 = spread(high[0]), y1 = spread(high[1]), z1 = spread(high[2]);
  uint32_t n = 0;
  for (int run = 0; run < 9; ++run)
    for (uint32_t i = run_begin[run]; i < run_end[run]; i += 8) {
      const Float8 xs = load(x + i), ys = load(y + i), zs = load(z + i);
      // Distance to the box, rounded as the distance to a particle in it would be: none that counts is lost.
      const Float8 dx = positive(x0 - xs) + positive(xs - x1), dy = positive(y0 - ys) + positive(ys - y1),
                   dz = positive(z0 - zs) + positive(zs - z1);
      const Float8 left = h2 - (dx * dx + dy * dy + dz * dz);
      const Int8 number = lane + static_cast<int32_t>(i);
      const Int8 own = number < static_cast<int32_t>(run_end[run]);
      n = append_positive(own ? left : Float8{}, xs, ys, zs, number, to, n);
    }
  for (; n % 8 != 0; ++n) to.x[n] = to.y[n] = to.z[n] = kFarAway;
  return n;
}

LIANA_TARGET static uint32_t density(uint32_t begin, uint32_t end, const Candidates& near, uint32_t count,
                                     int32_t nobody, const AirConstants& k, const AirState* state,
                                     float* density, uint32_t* list_begin, uint32_t* list_end, int32_t* list,
                                     uint32_t used) {
  const Float8 h2 = spread(k.support * k.support);
  const float *xs = near.x, *ys = near.y, *zs = near.z;
  const int32_t* index = near.index;
  for (uint32_t i = begin; i < end; ++i) {
    const Float8 x = spread(state[i].x), y = spread(state[i].y), z = spread(state[i].z);
    Float8 rho = {};
    list_begin[i] = used;
    for (uint32_t c = 0; c < count; c += 8) {
      const Float8 dx = load(xs + c) - x, dy = load(ys + c) - y, dz = load(zs + c) - z;
      const Float8 left = h2 - (dx * dx + dy * dy + dz * dz);
      const Float8 inside = positive(left);
      rho += inside * inside * inside;
      used = append_positive(left, index + c, list, used);
    }
    density[i] = k.density_factor * sum(rho);
    while (used % 8 != 0) list[used++] = nobody;
    list_end[i] = used;
  }
  return used;
}

LIANA_TARGET static void force(uint32_t begin, uint32_t end, const AirConstants& k, const AirState* state,
                               const uint32_t* list_begin, const uint32_t* list_end, const int32_t* list,
                               float* acceleration) {
  const Float8 h = spread(k.support), tiny = spread(1e-20f), half = spread(0.5f), mu = spread(k.viscosity);
  for (uint32_t i = begin; i < end; ++i) {
    const AirState& self = state[i];
    const Float8 x = spread(self.x), y = spread(self.y), z = spread(self.z), p = spread(self.pressure);
    const Float8 vx = spread(self.vx), vy = spread(self.vy), vz = spread(self.vz),
                 volume = spread(self.specific_volume);
    Float8 ax = {}, ay = {}, az = {};
    for (uint32_t n = list_begin[i]; n < list_end[i]; n += 8) {
      const float* place[8];
      const float* motion[8];
      for (int j = 0; j < 8; ++j) {
        place[j] = &state[list[n + j]].x;
        motion[j] = &state[list[n + j]].vx;
      }
      Float8 xj, yj, zj, pj, vxj, vyj, vzj, volume_j;
      gather4(place, xj, yj, zj, pj);
      gather4(motion, vxj, vyj, vzj, volume_j);
      const Float8 dx = x - xj, dy = y - yj, dz = z - zj;
      const Float8 r = square_root(dx * dx + dy * dy + dz * dz + tiny);
      const Float8 near = positive(h - r);
      // Force over 45 m²/(π h⁶): (h−r) / (ρ_i ρ_j) ((p_i+p_j)/2 (h−r)/r x_ij − μ v_ij)
      const Float8 share = near * (volume * volume_j);
      const Float8 push = share * ((p + pj) * half) * (near / r), drag = share * mu;
      ax += push * dx - drag * (vx - vxj);
      ay += push * dy - drag * (vy - vyj);
      az += push * dz - drag * (vz - vzj);
    }
    // Eq. 11 divides by ρ_i, which the pair's factor holds already.
    acceleration[4 * i] = k.force_factor * sum(ax);
    acceleration[4 * i + 1] = k.force_factor * sum(ay);
    acceleration[4 * i + 2] = k.force_factor * sum(az);
  }
}

LIANA_TARGET static uint32_t ellipsoid(uint32_t begin, uint32_t end, const float* x, const float* y,
                                       const float* z, const float (&centre)[3], const float (&G)[9],
                                       int32_t* index, float* depth, uint32_t used) {
  const Int8 lane = {0, 1, 2, 3, 4, 5, 6, 7};
  const Float8 x0 = spread(centre[0]), y0 = spread(centre[1]), z0 = spread(centre[2]), one = spread(1);
  for (uint32_t i = begin; i < end; i += 8) {
    const Float8 dx = load(x + i) - x0, dy = load(y + i) - y0, dz = load(z + i) - z0;
    const Float8 u = dx * G[0] + dy * G[1] + dz * G[2];
    const Float8 v = dx * G[3] + dy * G[4] + dz * G[5];
    const Float8 w = dx * G[6] + dy * G[7] + dz * G[8];
    const Float8 inside = one - square_root(u * u + v * v + w * w);
    const Int8 number = lane + static_cast<int32_t>(i);
    const Int8 own = number < static_cast<int32_t>(end);
    used = append_positive(own ? inside : Float8{}, number, index, depth, used);
  }
  return used;
}

#undef LIANA_INLINE

}  // namespace liana::LIANA_ISA
