// Random numbers in named streams: what one part of a program draws does not shift what another part gets.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "mesher/base/types.h"

namespace liana {

/// A PCG-XSH-RR 64/32 generator [O'Neill 2014]. Equal seed and name give the same numbers on every machine.
class Random {
 public:
  Random(uint64_t seed, std::string_view stream) {
    uint64_t name = 14695981039346656037ull;  // FNV-1a
    for (char c : stream) name = (name ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    increment_ = (name << 1) | 1;
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
    const double radius = std::sqrt(-2 * std::log((next() + 1.0) * 0x1p-32));
    return radius * std::cos(2 * kPi * uniform());
  }

  template <class Archive>
  void persist(Archive& a) {
    a(state_, increment_);
  }

 private:
  uint64_t state_ = 0, increment_ = 1;
};

}  // namespace liana
