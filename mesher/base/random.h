// Random numbers. Draws are pure functions of what they are for; Random is a stream with a name, for work
// that is done once in one order (the waves of a wind, a search for outliers).
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "mesher/base/fixed_math.h"
#include "mesher/base/ids.h"
#include "mesher/base/types.h"

namespace liana {

/// The numbers of one thing for one purpose: the n-th depends on (seed, whose, purpose, n) and nothing else,
/// so what others draw, or whether they are there, changes none of them. splitmix64 with a start of its own.
class Draws {
 public:
  Draws(uint64_t seed, LineageId whose, std::string_view purpose)
      : start_(mix_bits(mix_bits(seed ^ hash_name(purpose)) ^ whose.value)) {}

  uint64_t bits(uint64_t n) const { return mix_bits(start_ + (n + 1) * 0x9e3779b97f4a7c15ull); }
  /// In [0, 1), 53 random bits.
  double uniform(uint64_t n) const { return static_cast<double>(bits(n) >> 11) * 0x1p-53; }
  double uniform(uint64_t n, double low, double high) const { return low + (high - low) * uniform(n); }
  /// Mean 0, variance 1: Box-Muller, one of the pair, of 32 bits each.
  double normal(uint64_t n) const {
    const uint64_t both = bits(n);
    const double radius = std::sqrt(-2 * fixed::log((static_cast<double>(both >> 32) + 1) * 0x1p-32));
    return radius * fixed::cos(2 * kPi * static_cast<double>(both & 0xffffffffu) * 0x1p-32);
  }

 private:
  uint64_t start_;
};

/// A PCG-XSH-RR 64/32 generator [O'Neill 2014]. Equal seed and name give the same numbers on every machine.
class Random {
 public:
  Random(uint64_t seed, std::string_view stream) {
    increment_ = (hash_name(stream) << 1) | 1;
    next();
    state_ += seed;
    next();
  }

  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + increment_;
    const auto mixed = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<uint32_t>(old >> 59);
    return (mixed >> turn) | (mixed << ((-turn) & 31));
  }

  /// In [0, 1), 32 random bits.
  double uniform() { return next() * 0x1p-32; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Mean 0, variance 1: Box-Muller, one of the pair.
  double normal() {
    const double radius = std::sqrt(-2 * fixed::log((next() + 1.0) * 0x1p-32));
    return radius * fixed::cos(2 * kPi * uniform());
  }

  template <class Archive>
  void persist(Archive& a) {
    a(state_, increment_);
  }

 private:
  uint64_t state_ = 0, increment_ = 1;
};

}  // namespace liana
