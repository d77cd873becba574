#include "modal/domains/beam_sections.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/error.h"

namespace liana {
namespace {

/// Distance along the line of each section, up to the one behind which it holds `volume`.
struct Measured {
  std::vector<double> along{0};
  double length = 0;  // m, to where the sections hold the volume
};

Measured measure(std::span<const Section> line, double volume) {
  Measured m;
  double held = 0;
  for (size_t i = 1; i < line.size(); ++i) {
    const double step = (line[i].centre - line[i - 1].centre).norm();
    const double a = area_of(line[i - 1]), b = area_of(line[i]);
    m.along.push_back(m.along.back() + step);
    if (volume > 0 && held + step * (a + b) / 2 >= volume) {
      // The root of a x + (b − a) x² / (2 step) = volume − held, in a form that stands b = a.
      const double rest = volume - held, slope = (b - a) / step;
      m.length = m.along[i - 1] + 2 * rest / (a + std::sqrt(std::max(0.0, a * a + 2 * slope * rest)));
      return m;
    }
    held += step * (a + b) / 2;
    m.length = m.along.back();
  }
  return m;
}

}  // namespace

double area_of(const Section& s) {
  return s.area > 0 ? s.area : kPi * s.half_width * s.half_thickness;
}

Section between(const Section& a, const Section& b, double part) {
  const auto mix = [&](double x, double y) { return (1 - part) * x + part * y; };
  const Vec3 other = a.thin_axis.dot(b.thin_axis) < 0 ? Vec3(-b.thin_axis) : b.thin_axis;
  return {(1 - part) * a.centre + part * b.centre, mix(a.half_width, b.half_width),
          mix(a.half_thickness, b.half_thickness), Vec3((1 - part) * a.thin_axis + part * other).normalized(),
          mix(area_of(a), area_of(b))};
}

std::vector<Section> resample(std::span<const Section> line, double volume, int count) {
  const auto [along, length] = measure(line, volume);
  if (!(length > 0) || !std::isfinite(length))
    throw Error(Error::Kind::Input, "its centreline has no length", "give the domain a surface");
  std::vector<Section> sections;
  size_t i = 0;
  for (int k = 0; k <= count; ++k) {
    const double s = length * k / count;
    while (i + 2 < along.size() && along[i + 1] < s) ++i;
    const double step = along[i + 1] - along[i];
    sections.push_back(between(line[i], line[i + 1], step > 0 ? std::min(1.0, (s - along[i]) / step) : 0));
    const Section& last = sections.back();
    if (!(last.half_thickness > 0) || !(last.half_width > 0) || !last.centre.allFinite())
      throw Error(Error::Kind::Input, "a section of its centreline has no size", "give the domain a surface");
  }
  return sections;
}

std::vector<Section> carried_to_ends(std::span<const Section> line) {
  std::vector<Section> result(line.begin(), line.end());
  const auto carry_on = [](Section& end, const Section& inner) {
    // Half a step from the inner one to where it was cut, half a step on to the end.
    const auto on = [](double at, double before) { return std::max(2 * at - before, 0.2 * at); };
    const double area = area_of(end) / (end.half_width * end.half_thickness);
    end.half_width = on(end.half_width, inner.half_width);
    end.half_thickness = on(end.half_thickness, inner.half_thickness);
    end.area = area * end.half_width * end.half_thickness;
  };
  if (line.size() < 4) return result;
  carry_on(result.front(), line[1]);
  carry_on(result.back(), line[line.size() - 2]);
  return result;
}

}  // namespace liana
