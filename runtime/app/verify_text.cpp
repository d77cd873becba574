#include "runtime/app/verify_text.h"

#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>

namespace liana {
namespace {

struct Row {
  size_t count = 0, missed = 0;
  double least_frequency = 0, most_frequency = 0, frequency_error = 0, damping_error = 0;
};

std::string level_rows(const Bake& bake, const VerifyReport& report) {
  std::map<std::pair<int, std::string>, Row> rows;
  for (const DomainVerdict& v : report.domains) {
    const BakedDomain& domain = bake.domains[v.id.index()];
    Row& row = rows[{domain.level, domain.group}];
    const double nu = v.frequency_baked;
    row.least_frequency = row.count == 0 ? nu : std::min(row.least_frequency, nu);
    row.most_frequency = std::max(row.most_frequency, nu);
    row.frequency_error = std::max(row.frequency_error, v.frequency_error);
    row.damping_error = std::max(row.damping_error, v.damping_error);
    ++row.count;
    row.missed += !v.within;
  }
  constexpr const char* kLine = "{:>5}  {:<10} {:>7}  {:>15}  {:>10}  {:>10}  {:>7}\n";
  std::string text =
      fmt::format(kLine, "level", "group", "domains", "nu baked, Hz", "nu error", "xi error", "missed");
  for (const auto& [key, row] : rows)
    text += fmt::format(kLine, key.first, key.second, row.count,
                        fmt::format("{:.3g}-{:.3g}", row.least_frequency, row.most_frequency),
                        fmt::format("{:.4f} %", 100 * row.frequency_error),
                        fmt::format("{:.4f} %", 100 * row.damping_error), row.missed);
  return text;
}

std::string domain_row(const Bake& bake, const DomainVerdict& v) {
  const auto measured = [&](double value) {
    return v.measured ? fmt::format("{:.5g}", value) : std::string("none");
  };
  return fmt::format("{:>5}  {:<20} {:>9.5g} {:>9}  {:>9.5g} {:>9}  {}\n", v.id.value,
                     bake.domains[v.id.index()].name, v.frequency_baked, measured(v.frequency_measured),
                     v.damping_baked, measured(v.damping_measured), v.within ? "" : "missed");
}

std::string domain_rows(const Bake& bake, const VerifyReport& report, bool missed_only) {
  std::string text = fmt::format("{:>5}  {:<20} {:>9} {:>9}  {:>9} {:>9}\n", "id", "name", "nu baked",
                                 "measured", "xi baked", "measured");
  for (const DomainVerdict& v : report.domains)
    if (!missed_only || !v.within) text += domain_row(bake, v);
  return text;
}

}  // namespace

std::string verify_table(const Bake& bake, const VerifyReport& report, const VerifyOptions& options,
                         bool every_domain) {
  std::string text = every_domain ? domain_rows(bake, report, false) : level_rows(bake, report);
  text += fmt::format(
      "largest error: frequency {:.4f} % (bar {:g} %), damping {:.4f} % (bar {:g} %; {:g} absolute below "
      "0.02)\n",
      100 * report.max_frequency_error, 100 * options.frequency_bar, 100 * report.max_damping_error,
      100 * options.damping_bar, 0.04 * options.damping_bar);
  const TimeScheme& scheme = report.calibration.scheme;
  text += fmt::format("step {:g} ms, {} substep(s), rho {:g}\n", 1e3 * scheme.dt, scheme.substeps,
                      scheme.rho_infinity);
  if (!report.calibration.note.empty()) text += "note: " + report.calibration.note + "\n";
  text += fmt::format("under its own weight for 10 s: moved {:.3g} mm\n", 1e3 * report.standing.moved);
  if (!report.standing.stable)
    text +=
        "note: it does not stand by itself: a slight push makes it topple; anchor it, or give its lower "
        "levels a "
        "higher frequency\n";
  if (!report.within && !every_domain) text += "\nmissed:\n" + domain_rows(bake, report, true);
  text += report.within ? "What was baked is what moves.\n" : "Some domains do not move as baked.\n";
  return text;
}

std::string verify_json(const Bake& bake, const VerifyReport& report) {
  using nlohmann::json;
  json domains = json::array();
  for (const DomainVerdict& v : report.domains) {
    const BakedDomain& domain = bake.domains[v.id.index()];
    domains.push_back({{"id", v.id.value},
                       {"name", domain.name},
                       {"level", domain.level},
                       {"nu_baked", v.frequency_baked},
                       {"nu_measured", v.measured ? json(v.frequency_measured) : json()},
                       {"xi_baked", v.damping_baked},
                       {"xi_measured", v.measured ? json(v.damping_measured) : json()},
                       {"frequency_error", v.frequency_error},
                       {"damping_error", v.damping_error},
                       {"passed", v.within}});
  }
  const TimeScheme& scheme = report.calibration.scheme;
  const json all = {{"plant", bake.plant},
                    {"domains", domains},
                    {"max_frequency_error", report.max_frequency_error},
                    {"max_damping_error", report.max_damping_error},
                    {"passed", report.within},
                    {"dt", scheme.dt},
                    {"substeps", scheme.substeps},
                    {"rho_infinity", scheme.rho_infinity},
                    {"moved_at_rest_m", report.standing.moved},
                    {"stands", report.standing.stable},
                    {"note", report.calibration.note}};
  return all.dump(1) + "\n";
}

}  // namespace liana
