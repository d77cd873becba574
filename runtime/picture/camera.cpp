#include "runtime/picture/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

#include "mesher/base/error.h"
#include "runtime/picture/glm_types.h"

namespace liana {
namespace {

constexpr double kMostElevation = 1.55;  // rad; at the pole the turntable has no right-hand side
constexpr double kLeastDistance = 0.02, kMostDistance = 500;  // m
constexpr double kFar = 2000;                                 // m, beyond the faded horizon

double degrees(double radians) {
  return radians * 180 / kPi;
}

}  // namespace

Vec3 Camera::forward() const {
  return -Vec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
               std::cos(azimuth) * std::cos(elevation));
}

Vec3 Camera::eye() const {
  return pivot - distance * forward();
}
Vec3 Camera::right() const {
  return {std::cos(azimuth), 0, -std::sin(azimuth)};
}
Vec3 Camera::up() const {
  return right().cross(forward());
}

void Camera::orbit(double dx, double dy, int height) {
  azimuth = std::remainder(azimuth - kPi * dx / height, 2 * kPi);
  elevation = std::clamp(elevation + kPi * dy / height, -kMostElevation, kMostElevation);
}

void Camera::pan(double dx, double dy, int height) {
  pivot += pixel_size(distance, height) * (dy * up() - dx * right());
}

void Camera::zoom(double notches) {
  distance = std::clamp(distance * std::pow(0.9, notches), kLeastDistance, kMostDistance);
}

void Camera::frame(const BoundingBox& box, double aspect) {
  if (box.empty()) return;
  pivot = (box.low + box.high) / 2;
  const double slope_y = std::tan(field_of_view / 2), slope_x = slope_y * aspect;
  double needed = kLeastDistance;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 offset = Vec3(corner & 1 ? box.high.x() : box.low.x(), corner & 2 ? box.high.y() : box.low.y(),
                             corner & 4 ? box.high.z() : box.low.z()) -
                        pivot;
    const double wide = std::abs(offset.dot(right())) / slope_x, high = std::abs(offset.dot(up())) / slope_y;
    needed = std::max(needed, std::max(wide, high) - offset.dot(forward()));
  }
  distance = std::min(1.06 * needed, kMostDistance);  // a little air around it
}

double Camera::near_plane() const {
  return std::max(0.005, 0.02 * distance);
}

glm::mat4 Camera::view() const {
  return glm::mat4(glm::lookAt(to_glm(eye()), to_glm(pivot), to_glm(up())));
}

glm::mat4 Camera::projection(double aspect) const {
  return glm::mat4(glm::perspective(field_of_view, aspect, near_plane(), kFar));
}

Ray Camera::ray(double x, double y, int width, int height) const {
  const double slope = std::tan(field_of_view / 2);
  const double sx = (2 * x - width) / height * slope, sy = (1 - 2 * y / height) * slope;
  return {eye(), (forward() + sx * right() + sy * up()).normalized()};
}

Vec3 Camera::project(const Vec3& point, int width, int height) const {
  const Vec3 offset = point - eye();
  const double depth = offset.dot(forward()), scale = height / (2 * std::tan(field_of_view / 2) * depth);
  return {width / 2.0 + scale * offset.dot(right()), height / 2.0 - scale * offset.dot(up()), depth};
}

double Camera::pixel_size(double depth, int height) const {
  return 2 * depth * std::tan(field_of_view / 2) / height;
}

std::string Camera::text() const {
  return fmt::format("pivot {:.4g} {:.4g} {:.4g} distance {:.4g} azimuth {:.4g} elevation {:.4g}", pivot.x(),
                     pivot.y(), pivot.z(), distance, degrees(azimuth), degrees(elevation));
}

Camera Camera::parse(std::string_view text) {
  Camera camera;
  std::istringstream words{std::string(text)};
  const auto number = [&](const std::string& key) {
    std::string word;
    double value = 0;
    if (words >> word) {
      std::istringstream digits(word);
      if (digits >> value && digits.eof() && std::isfinite(value)) return value;
    }
    throw Error(Error::Kind::Usage, fmt::format("camera: '{}' needs a number, not '{}'", key, word),
                "write a pose as: " + Camera().text());
  };
  for (std::string key; words >> key;) {
    if (key == "pivot")
      for (int axis = 0; axis < 3; ++axis) camera.pivot[axis] = number(key);
    else if (key == "distance")
      camera.distance = std::clamp(number(key), kLeastDistance, kMostDistance);
    else if (key == "azimuth")
      camera.azimuth = number(key) * kPi / 180;
    else if (key == "elevation")
      camera.elevation = std::clamp(number(key) * kPi / 180, -kMostElevation, kMostElevation);
    else
      throw Error(Error::Kind::Usage, fmt::format("camera: there is no '{}'", key),
                  "write a pose as: " + Camera().text());
  }
  return camera;
}

}  // namespace liana
