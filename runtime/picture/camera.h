// A turntable camera: it looks at a pivot from a distance, +Y stays up.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <string_view>

#include "runtime/picture/draw_scene.h"

namespace liana {

/// A half line; direction is a unit vector.
struct Ray {
  Vec3 origin, direction;
};

struct Camera {
  Vec3 pivot = {0, 1, 0};      ///< m
  double distance = 5;         ///< m, eye to pivot
  double azimuth = 0.5;        ///< rad, 0 looks along -Z, positive moves the eye towards +X
  double elevation = 0.2;      ///< rad, above the horizon
  double field_of_view = 0.7;  ///< rad, vertical

  Vec3 eye() const;
  Vec3 forward() const;  ///< unit, from the eye to the pivot
  Vec3 right() const;
  Vec3 up() const;  ///< unit, of the picture

  /// Turns about the pivot by a mouse motion in pixels (x right, y down); a picture height is half a turn.
  void orbit(double dx, double dy, int height);
  /// Moves the pivot so that it follows the mouse in its own plane.
  void pan(double dx, double dy, int height);
  /// Multiplies the distance by 0.9 per notch (positive comes nearer).
  void zoom(double notches);
  /// Moves pivot and distance so that the box fills the picture; keeps the direction of view.
  void frame(const BoundingBox& box, double aspect);

  glm::mat4 view() const;
  glm::mat4 projection(double aspect) const;  ///< OpenGL clip space
  double near_plane() const;                  ///< m
  /// Ray through a pixel (x right, y down, from the upper left corner).
  Ray ray(double x, double y, int width, int height) const;
  /// Pixel of a point (x right, y down) and its depth along the view in m; the pixel means nothing for depth
  /// <= 0.
  Vec3 project(const Vec3& point, int width, int height) const;
  /// Size in m of one pixel at a depth along the view.
  double pixel_size(double depth, int height) const;

  /// "pivot x y z distance d azimuth a elevation e" in m and degrees: for notes, scenes and the command line.
  std::string text() const;
  /// Reads text(); the keys may come in any order and be left out. Throws Error{Usage} naming the bad word.
  static Camera parse(std::string_view text);
};

}  // namespace liana
