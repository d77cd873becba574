// The closed loop: does what was baked move as baked? Every domain is let swing in the simulator and
// measured.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/progress.h"
#include "runtime/sim/calibrate/calibration.h"
#include "runtime/sim/check/frequency_probe.h"
#include "runtime/sim/check/standing.h"

namespace liana {

struct VerifyOptions {
  TimeScheme scheme;  ///< wanted; calibration may choose a finer one
  ProbeOptions probe;
  double frequency_bar = 0.01;  ///< relative
  double damping_bar = 0.05;    ///< relative; below ξ = 0.02 an absolute 0.04 damping_bar (0.002)
};

struct DomainVerdict {
  DomainId id;
  double frequency_baked = 0, frequency_measured = 0;  ///< Hz
  double damping_baked = 0, damping_measured = 0;      ///< ξ
  double frequency_error = 0;                          ///< |measured − baked| / baked
  double damping_error = 0;  ///< |measured − baked| / baked, below ξ = 0.02 / 0.04
  double residual = 0;       ///< of the fit to the recorded motion
  int particles = 0, steps = 0;
  bool measured = false;  ///< false when the recorded motion does not swing at all
  bool within = false;    ///< both errors within their bars
};

struct VerifyReport {
  std::vector<DomainVerdict> domains;  ///< in the bake's order
  CalibrationReport calibration;
  double max_frequency_error = 0, max_damping_error = 0;  ///< a domain that does not swing counts as 1
  bool within = true;
  Standing standing;  ///< of the whole plant under gravity; no part of `within`
};

/// Makes the plant, then per domain: parent held, descendants' mass lumped, struck, stepped, measured.
/// threads = 0: one per core; the result does not depend on it. Throws Error{Input} for a bake without
/// domains, Error{Cancelled}.
VerifyReport verify_bake(const Bake& bake, const VerifyOptions& options, unsigned threads,
                         Progress& progress);

}  // namespace liana
