#include "runtime/sim/model/centreline.h"

#include <algorithm>

#include "mesher/base/error.h"

namespace liana {

Centreline::Centreline(const BakedDomain& domain, const TaperLaw& taper)
    : stations_(domain.centreline), taper_(taper) {
  arc_.push_back(0);
  for (size_t i = 0; i < stations_.size(); ++i) {
    if (i > 0) arc_.push_back(arc_.back() + (stations_[i].position - stations_[i - 1].position).norm());
    least_width_ = std::max(least_width_, stations_[i].half_width / 20);
    least_thickness_ = std::max(least_thickness_, stations_[i].half_thickness / 20);
  }
  const bool good = stations_.size() >= 2 && length() > 0 && std::isfinite(length()) && least_width_ > 0 &&
                    least_thickness_ > 0 && std::isfinite(least_width_ + least_thickness_);
  if (!good)
    throw Error(Error::Kind::Input,
                "domain '" + domain.name + "': its centreline has no length or no thickness",
                "bake the plant again; if it stays, look at this domain's surface");
}

Station Centreline::at(double s) const {
  const auto above = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, s);
  const size_t i = static_cast<size_t>(above - arc_.begin());
  const Station &a = stations_[i - 1], &b = stations_[i];
  const double step = arc_[i] - arc_[i - 1];
  const double t = step > 0 ? std::clamp((s - arc_[i - 1]) / step, 0.0, 1.0) : 0;
  return {a.position + t * (b.position - a.position),
          std::max(least_width_, a.half_width + t * (b.half_width - a.half_width)),
          std::max(least_thickness_, a.half_thickness + t * (b.half_thickness - a.half_thickness))};
}

double Centreline::volume_share(double s0, double s1) const {
  constexpr int kParts = 16;  // midpoint rule: 1e-3 of a cone's segment, and only the shares matter
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    const Station section = at(s0 + (s1 - s0) * (i + 0.5) / kParts);
    sum += section.half_width * section.half_thickness;
  }
  return sum * (s1 - s0) / kParts;
}

double Centreline::material_scaling(double s) const {
  return taper_.uniform() ? 1 : taper_scaling(taper_, std::clamp(s / length(), 0.0, 1.0));
}

double Centreline::mass_share(double s0, double s1) const {
  return volume_share(s0, s1) * material_scaling((s0 + s1) / 2);
}

double Centreline::mean_diameter() const {
  return 2 * std::sqrt(volume_share(0, length()) / length());
}

}  // namespace liana
