// What was inferred, as text, JSON and a table to plot.
#pragma once

#include <string>

#include "materials/video/infer.h"

namespace liana {

std::string infer_json(const InferResult& result);
/// CSV: point, frequency_hz, amplitude_px (of a sinusoid that would show this height), one line per bin.
std::string spectrum_csv(const InferResult& result);
/// For a terminal: one line per point, one per group.
std::string infer_table(const InferResult& result);

}  // namespace liana
