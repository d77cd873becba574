// An 8-bit RGB picture, rows from the top.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace liana {

struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  ///< width * height * 3, sRGB

  const uint8_t* at(int x, int y) const { return &pixels[3 * (size_t(y) * width + x)]; }
};

/// The file appears only when complete. Throws Error{Output}.
void write_png(const std::filesystem::path& path, const Image& image);

/// Throws Error{Input} for a missing or broken file, or one above 16384 pixels a side.
Image read_png(const std::filesystem::path& path);

/// Root mean square difference of the channels, 0 to 255. The sizes must agree.
double root_mean_square_difference(const Image& a, const Image& b);

}  // namespace liana
