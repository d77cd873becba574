// Tracked points made in code: swings of known frequency and damping, noise, wind, a shaken camera.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "materials/video/tracks/point_tracks.h"
#include "mesher/base/random.h"
#include "mesher/base/types.h"

namespace liana::test {

struct Swing {
  double frequency, damping_factor;
  double amplitude;  ///< pixels
  double phase = -0.3;
};

/// A point on a line of the picture at an angle, let go at `start`; after it sum of the swings, and white
/// noise.
struct TrackShape {
  double fps = 30, seconds = 12, start = 0, angle = 0.5;
  double noise = 0.1;  ///< pixels, standard deviation
  std::vector<Swing> swings;
};

inline std::vector<Vec2> decaying_path(const TrackShape& shape, Random& random) {
  const Vec2 along(std::cos(shape.angle), std::sin(shape.angle));
  std::vector<Vec2> path;
  for (int n = 0; n < static_cast<int>(std::lround(shape.seconds * shape.fps)); ++n) {
    const double t = n / shape.fps - shape.start;
    double s = 0;
    for (const Swing& swing : shape.swings) {
      const double omega = 2 * kPi * swing.frequency, xi = swing.damping_factor;
      if (t >= 0)
        s += swing.amplitude * std::exp(-xi * omega * t) *
             std::cos(omega * std::sqrt(1 - xi * xi) * t + swing.phase);
    }
    path.push_back(Vec2(300, 200) + s * along + shape.noise * Vec2(random.normal(), random.normal()));
  }
  return path;
}

/// The displacement of an oscillator pushed by white noise, from its stationary distribution: the exact
/// discrete recurrence of x'' + 2ξω x' + ω² x = w, root mean square 1. Also slow gusts for frequency 0: e^(−t
/// / time).
inline std::vector<double> pushed_oscillator(double frequency, double xi, double dt, size_t count,
                                             Random& random) {
  // Twenty substeps by semi-implicit Euler are exact enough: the error of ν is (ω dt/20)²/24.
  const double omega = 2 * kPi * frequency, h = dt / 20;
  double x = 0, v = 0, squares = 0;
  std::vector<double> record;
  const auto settle = static_cast<size_t>(5 / (xi * omega * dt)) + 1;
  for (size_t n = 0; n < settle + count; ++n) {
    for (int k = 0; k < 20; ++k) {
      v += h * (-2 * xi * omega * v - omega * omega * x) + std::sqrt(h) * random.normal();
      x += h * v;
    }
    if (n >= settle) record.push_back(x), squares += x * x;
  }
  for (double& value : record) value /= std::sqrt(squares / static_cast<double>(count));
  return record;
}

inline std::vector<double> slow_gusts(double time, double dt, size_t count, Random& random) {
  const double keep = std::exp(-dt / time);
  std::vector<double> record;
  double x = random.normal();
  for (size_t n = 0; n < count; ++n) {
    record.push_back(x);
    x = keep * x + std::sqrt(1 - keep * keep) * random.normal();
  }
  return record;
}

inline PointTracks tracks_of(std::vector<PointTrack> points, double fps) {
  return {"made.csv", fps, 0, std::move(points)};
}

}  // namespace liana::test
