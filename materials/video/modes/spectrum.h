// The Fourier spectrum of a recorded signal and its peaks.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace liana {

/// Discrete Fourier transform of a real signal padded with zeros to `size` (even): bins 0 to size/2.
std::vector<std::complex<double>> fourier(std::span<const double> signal, size_t size);

/// w_n² of a Hann window sum to 1.
std::vector<double> hann_window(size_t count);

/// Power per bin: a signal of white noise of variance σ² has the expectation σ² everywhere.
struct Spectrum {
  double bin = 0;             ///< Hz from one value to the next, starting at 0
  std::vector<double> power;  ///< pixel²

  double at(double frequency) const;                 ///< linear between bins
  double local_mean(double low, double high) const;  ///< of at least one bin
};

enum class Window { None, Hann };

/// Of the signal less its mean, padded to at least `padding` times its length.
Spectrum power_spectrum(std::span<const double> signal, double dt, Window window, size_t padding = 8);

/// Mean of the spectra of half-overlapping parts of a signal ([Welch 1967]), so that the spikes of a random
/// motion are not taken for its frequencies.
Spectrum welch_spectrum(std::span<const double> signal, double dt, size_t part);

struct SpectrumPeak {
  double frequency;  ///< Hz, of the parabola through the logarithms of the highest bin and its neighbours
  double power;
};

/// Local maxima between two frequencies, the strongest first, that stand out by `contrast` over the median
/// power of that range and rise by a factor of 2 from the valley to any stronger one.
std::vector<SpectrumPeak> spectrum_peaks(const Spectrum& spectrum, double low, double high, double contrast);

}  // namespace liana
