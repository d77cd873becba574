#include "materials/pipeline/stations.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"

namespace liana {

Vec3 flat_normal(const std::vector<Section>& sections, const Vec3& soft) {
  require(sections.size() >= 2, "a solid domain has a centreline");
  const Vec3 along = (sections.back().centre - sections.front().centre).normalized();
  Vec3 normal = soft - soft.dot(along) * along;
  if (!(normal.norm() > 0.1)) {
    const Vec3& thin = sections.front().thin_axis;
    normal = thin - thin.dot(along) * along;
  }
  if (!(normal.norm() > 0.1)) normal = along.unitOrthogonal();
  Eigen::Index largest;
  normal.cwiseAbs().maxCoeff(&largest);
  return normal.normalized() * (normal[largest] < 0 ? -1 : 1);
}

std::vector<Station> stations(const std::vector<Section>& sections, const Vec3& normal) {
  std::vector<Station> result;
  for (const Section& section : sections) {
    // A uniform ellipse's second moment about a direction goes with the square of its half axis there.
    const double cosine = std::min(1.0, std::abs(section.thin_axis.dot(normal)));
    const double thin = cosine * cosine, wide = 1 - thin;
    const double w2 = section.half_width * section.half_width,
                 t2 = section.half_thickness * section.half_thickness;
    result.push_back({section.centre, std::sqrt(thin * w2 + wide * t2), std::sqrt(thin * t2 + wide * w2)});
  }
  return result;
}

double mean_taper(const std::vector<Section>& sections, const TaperLaw& law) {
  if (law.uniform()) return 1;
  double length = 0;
  for (size_t i = 1; i < sections.size(); ++i) length += (sections[i].centre - sections[i - 1].centre).norm();
  constexpr int kParts = 16;  // midpoint rule on each piece: 1e-3 of a quadratic law
  double volume = 0, scaled = 0, before = 0;
  for (size_t i = 1; i < sections.size(); ++i) {
    const Section &a = sections[i - 1], &b = sections[i];
    const double step = (b.centre - a.centre).norm();
    for (int k = 0; k < kParts; ++k) {
      const double t = (k + 0.5) / kParts;
      const double part = step * (a.half_width + t * (b.half_width - a.half_width)) *
                          (a.half_thickness + t * (b.half_thickness - a.half_thickness));
      volume += part, scaled += part * taper_scaling(law, std::min(1.0, (before + t * step) / length));
    }
    before += step;
  }
  return volume > 0 ? scaled / volume : 1;
}

}  // namespace liana
