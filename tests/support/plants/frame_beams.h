// An independent beam finite-element model of a frame: Timoshenko elements, assembled densely. What the modes
// of particles are checked against. Shares no code with the simulator.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace liana::test {

/// A straight piece of round rod between two nodes, cut into `elements` equal elements.
struct FrameBeam {
  int from, to;  ///< nodes
  int elements;
  double radius;  ///< m
};

struct Frame {
  std::vector<Eigen::Vector3d> nodes;  ///< m; node 0 is clamped
  std::vector<FrameBeam> beams;
  double youngs_modulus, poisson_ratio, density;  ///< Pa, -, kg/m³
};

/// The lowest natural frequencies, Hz, ascending. The shear area is the whole section, as in the joints of a
/// plant.
std::vector<double> frame_frequencies(const Frame& frame, int count);

}  // namespace liana::test
