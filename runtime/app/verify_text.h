// The closed loop's verdict as a table for people and as JSON.
#pragma once

#include <string>

#include "runtime/sim/check/verify.h"

namespace liana {

/// One row per level (or per domain), then the worst errors, what misses its bar, and what calibration
/// decided.
std::string verify_table(const Bake& bake, const VerifyReport& report, const VerifyOptions& options,
                         bool every_domain);

/// {"domains":[{"id","nu_baked","nu_measured","xi_baked","xi_measured"}],"max_frequency_error","max_damping_error"}
/// and more: name, level, errors, dt, rho_infinity, substeps, passed. Not measured: null.
std::string verify_json(const Bake& bake, const VerifyReport& report);

}  // namespace liana
