#include "runtime/picture/image.h"

#include <cmath>
#include <memory>
#include <string>

#include "mesher/base/error.h"
#include "mesher/base/files.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace liana {

void write_png(const std::filesystem::path& path, const Image& image) {
  require(
      image.width > 0 && image.height > 0 && image.pixels.size() == size_t(image.width) * image.height * 3,
      "write_png: size and pixels disagree");
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), size);
  };
  require(stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.pixels.data(),
                                 3 * image.width),
          "write_png: encoding failed");
  write_file(path, bytes);
}

Image read_png(const std::filesystem::path& path) {
  const std::string bytes = read_file(path, size_t{1} << 30);
  Image image;
  int channels = 0;
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto broken = [&](const char* why) {
    return Error(Error::Kind::Input, path.string() + ": not a readable PNG picture (" + why + ")");
  };
  if (!stbi_info_from_memory(data, int(bytes.size()), &image.width, &image.height, &channels))
    throw broken(stbi_failure_reason());
  if (image.width > 16384 || image.height > 16384) throw broken("larger than 16384 pixels a side");
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> decoded(
      stbi_load_from_memory(data, int(bytes.size()), &image.width, &image.height, &channels, 3),
      stbi_image_free);
  if (!decoded) throw broken(stbi_failure_reason());
  image.pixels.assign(decoded.get(), decoded.get() + size_t(image.width) * image.height * 3);
  return image;
}

double root_mean_square_difference(const Image& a, const Image& b) {
  require(a.width == b.width && a.height == b.height, "root_mean_square_difference: sizes differ");
  double sum = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double difference = double(a.pixels[i]) - b.pixels[i];
    sum += difference * difference;
  }
  return std::sqrt(sum / std::max<size_t>(1, a.pixels.size()));
}

}  // namespace liana
