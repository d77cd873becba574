#include "materials/pipeline/stations.h"

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

}  // namespace liana
