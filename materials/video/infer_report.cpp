#include "materials/video/infer_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace liana {
namespace {

using Json = nlohmann::ordered_json;

Json mode_json(const MeasuredMode& mode) {
  return {{"nu_hz", mode.frequency},
          {"nu_95_hz", kCoverage95 * mode.frequency_sigma},
          {"xi", mode.damping_factor},
          {"xi_95", kCoverage95 * mode.damping_sigma},
          {"amplitude_px", mode.amplitude}};
}

Json motion_json(const PointModes& motion) {
  return {{"point", motion.point},
          {"motion", motion.excitation == Excitation::FreeDecay ? "free decay" : "gusts"},
          {"first_frame", motion.first_frame},
          {"frames", motion.frames},
          {"bridged_frames", motion.bridged},
          {"direction", {motion.direction.x(), motion.direction.y()}},
          {"direction_share", motion.direction_share},
          {"resolution_hz", motion.resolution}};
}

Json group_json(const FittedGroup& group) {
  Json json = {{"group", group.group},
               {"epsilon1", group.epsilon1},
               {"c1", group.c1},
               {"c1_95", kCoverage95 * group.c1_sigma},
               {"residual_2norm_hz", group.residual},
               {"damping",
                {{"low_frequency", group.damping.low_frequency},
                 {"high_frequency", group.damping.high_frequency},
                 {"low_factor", group.damping.low_factor},
                 {"high_factor", group.damping.high_factor}}}};
  for (const FittedBranch& b : group.branches) {
    Json branch = {{"point", b.point}, {"domain", b.domain}, {"length_m", b.length}};
    branch.update(mode_json(b.measured));
    branch["nu_fitted_hz"] = b.fitted;
    branch["residual_hz"] = b.measured.frequency - b.fitted;
    json["branches"].push_back(branch);
  }
  return json;
}

template <class Visit>
void for_each_motion(const InferResult& result, Visit&& visit) {
  for (const BranchMotion& branch : result.tree.branches) visit(branch.motion, &branch);
  for (const PointModes& motion : result.unassigned) visit(motion, nullptr);
}

const char* role_of(const BranchMotion* branch, size_t i) {
  return branch ? name_of(branch->roles[i]) : "unassigned";
}

}  // namespace

std::string infer_json(const InferResult& result) {
  Json json = {
      {"source", result.source}, {"frames_per_second", result.frames_per_second}, {"frames", result.frames}};
  json["wind"] = result.tree.wind ? mode_json(*result.tree.wind) : Json(nullptr);
  json["trunk"] = result.tree.trunk ? mode_json(*result.tree.trunk) : Json(nullptr);
  json["points"] = Json::array();
  for_each_motion(result, [&](const PointModes& motion, const BranchMotion* branch) {
    Json point = motion_json(motion);
    if (branch)
      point.update({{"domain", branch->target.domain},
                    {"group", branch->target.group},
                    {"length_m", branch->target.length}});
    for (size_t i = 0; i < motion.modes.size(); ++i) {
      Json mode = mode_json(motion.modes[i]);
      mode["role"] = role_of(branch, i);
      point["modes"].push_back(mode);
    }
    json["points"].push_back(point);
  });
  json["groups"] = Json::array();
  for (const FittedGroup& group : result.groups) json["groups"].push_back(group_json(group));
  json["notes"] = result.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string spectrum_csv(const InferResult& result) {
  std::string text = "point,frequency_hz,amplitude_px\n";
  for_each_motion(result, [&](const PointModes& motion, const BranchMotion*) {
    // A sinusoid of amplitude A has the peak power (A/2)² (Σw)² under a window with Σw² = 1; (Σw)² = 2N/3 for
    // Hann.
    const double scale = 2 / std::sqrt(2 * static_cast<double>(motion.frames) / 3);
    const Spectrum& spectrum = motion.spectrum;
    for (size_t i = 0; i < spectrum.power.size(); ++i)
      text += fmt::format("{},{:.5f},{:.6g}\n", motion.point, static_cast<double>(i) * spectrum.bin,
                          scale * std::sqrt(spectrum.power[i]));
  });
  return text;
}

std::string infer_table(const InferResult& result) {
  std::string text = fmt::format("{}: {} frames, {:g} per second\n\n", result.source, result.frames,
                                 result.frames_per_second);
  text += fmt::format("{:<16}{:<20}{:>9}  {:<6}{:>16}{:>18}{:>10}  {}\n", "point", "on", "seconds", "as",
                      "nu, Hz (95 %)", "xi (95 %)", "px", "whose");
  for_each_motion(result, [&](const PointModes& motion, const BranchMotion* branch) {
    const std::string on = !branch ? "-"
                           : !branch->target.domain.empty()
                               ? branch->target.domain
                               : fmt::format("{}:{:g}", branch->target.group, branch->target.length);
    for (size_t i = 0; i < motion.modes.size(); ++i) {
      const MeasuredMode& m = motion.modes[i];
      text += fmt::format("{:<16}{:<20}{:>9.2f}  {:<6}{:>8.3f} +-{:<6.3f}{:>9.4f} +-{:<7.4f}{:>9.2f}  {}\n",
                          i ? "" : motion.point, i ? "" : on,
                          static_cast<double>(motion.frames) / result.frames_per_second,
                          motion.excitation == Excitation::FreeDecay ? "decay" : "gusts", m.frequency,
                          kCoverage95 * m.frequency_sigma, m.damping_factor, kCoverage95 * m.damping_sigma,
                          m.amplitude, role_of(branch, i));
    }
  });
  if (!result.groups.empty()) text += "\n";
  for (const FittedGroup& g : result.groups)
    text += fmt::format(
        "{}: nu = {:.4g} (+-{:.2g}) l^{:g} Hz through {} point{}, residual {:.3g} Hz; xi {:.4f} at {:.3g} "
        "Hz, {:.4f} at {:.3g} Hz\n",
        g.group, g.c1, kCoverage95 * g.c1_sigma, g.epsilon1, g.branches.size(),
        g.branches.size() == 1 ? "" : "s", g.residual, g.damping.low_factor, g.damping.low_frequency,
        g.damping.high_factor, g.damping.high_frequency);
  for (const std::string& note : result.notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace liana
