#include "materials/video/modes/spectrum.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "mesher/base/error.h"
#include "mesher/base/types.h"

namespace liana {
namespace {

std::vector<double> without_mean(std::span<const double> signal) {
  double mean = 0;
  for (const double value : signal) mean += value / static_cast<double>(signal.size());
  std::vector<double> rest(signal.begin(), signal.end());
  for (double& value : rest) value -= mean;
  return rest;
}

}  // namespace

std::vector<std::complex<double>> fourier(std::span<const double> signal, size_t size) {
  require(size >= signal.size() && size % 2 == 0, "fourier: padded to an even size");
  std::vector<double> padded(signal.begin(), signal.end());
  padded.resize(size, 0.0);
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> bins;
  transform.fwd(bins, padded);
  return bins;
}

std::vector<double> hann_window(size_t count) {
  std::vector<double> window(count);
  double sum = 0;
  for (size_t n = 0; n < count; ++n) {
    window[n] = std::pow(std::sin(kPi * (static_cast<double>(n) + 0.5) / static_cast<double>(count)), 2);
    sum += window[n] * window[n];
  }
  for (double& w : window) w /= std::sqrt(sum);
  return window;
}

double Spectrum::at(double frequency) const {
  const double place = std::clamp(frequency / bin, 0.0, static_cast<double>(power.size() - 1));
  const size_t i = std::min(static_cast<size_t>(place), power.size() - 2);
  return power[i] + (place - static_cast<double>(i)) * (power[i + 1] - power[i]);
}

double Spectrum::local_mean(double low, double high) const {
  const auto last = static_cast<double>(power.size() - 1);
  const auto first = static_cast<size_t>(std::clamp(std::ceil(low / bin), 0.0, last));
  const auto end = std::max(first + 1, static_cast<size_t>(std::clamp(high / bin, 0.0, last)) + 1);
  double sum = 0;
  for (size_t i = first; i < end; ++i) sum += power[i];
  return sum / static_cast<double>(end - first);
}

Spectrum power_spectrum(std::span<const double> signal, double dt, Window window, size_t padding) {
  std::vector<double> values = without_mean(signal);
  const std::vector<double> weights =
      window == Window::Hann
          ? hann_window(values.size())
          : std::vector<double>(values.size(), 1 / std::sqrt(static_cast<double>(values.size())));
  for (size_t n = 0; n < values.size(); ++n) values[n] *= weights[n];
  const size_t size = std::bit_ceil(std::max<size_t>(8, padding * values.size()));
  Spectrum spectrum{1 / (dt * static_cast<double>(size)), {}};
  for (const std::complex<double>& z : fourier(values, size)) spectrum.power.push_back(std::norm(z));
  return spectrum;
}

Spectrum welch_spectrum(std::span<const double> signal, double dt, size_t part) {
  part = std::clamp<size_t>(part, 8, signal.size());
  const size_t parts = 1 + (signal.size() - part) / (part / 2);
  Spectrum mean;
  for (size_t i = 0; i < parts; ++i) {
    const Spectrum one = power_spectrum(signal.subspan(i * (part / 2), part), dt, Window::Hann);
    mean.bin = one.bin;
    mean.power.resize(one.power.size(), 0.0);
    for (size_t k = 0; k < one.power.size(); ++k) mean.power[k] += one.power[k] / static_cast<double>(parts);
  }
  return mean;
}

std::vector<SpectrumPeak> spectrum_peaks(const Spectrum& spectrum, double low, double high, double contrast) {
  const std::vector<double>& p = spectrum.power;
  const auto first = std::max<size_t>(1, static_cast<size_t>(std::ceil(low / spectrum.bin)));
  const auto end = std::min(p.size() - 1, static_cast<size_t>(std::floor(high / spectrum.bin)) + 1);
  if (first >= end) return {};
  std::vector<double> sorted(p.begin() + static_cast<std::ptrdiff_t>(first),
                             p.begin() + static_cast<std::ptrdiff_t>(end));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double median = sorted[sorted.size() / 2];

  std::vector<size_t> tops;
  for (size_t i = first; i < end; ++i)
    if (p[i] > p[i - 1] && p[i] >= p[i + 1] && p[i] > contrast * median) tops.push_back(i);
  std::sort(tops.begin(), tops.end(), [&](size_t a, size_t b) { return p[a] > p[b]; });
  std::vector<size_t> kept;
  for (const size_t top : tops) {
    const bool apart = std::all_of(kept.begin(), kept.end(), [&](size_t other) {
      const auto [a, b] = std::minmax(top, other);
      return *std::min_element(p.begin() + static_cast<std::ptrdiff_t>(a),
                               p.begin() + static_cast<std::ptrdiff_t>(b)) < p[top] / 2;
    });
    if (apart) kept.push_back(top);
  }
  std::vector<SpectrumPeak> peaks;
  for (const size_t i : kept) {
    const double a = std::log(p[i - 1] + 1e-300), b = std::log(p[i]), c = std::log(p[i + 1] + 1e-300);
    const double curvature = a - 2 * b + c;
    const double shift = curvature < 0 ? std::clamp(0.5 * (a - c) / curvature, -0.5, 0.5) : 0;
    peaks.push_back({(static_cast<double>(i) + shift) * spectrum.bin, p[i]});
  }
  return peaks;
}

}  // namespace liana
