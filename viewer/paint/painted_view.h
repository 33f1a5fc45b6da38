// SPDX-License-Identifier: MIT
// A view that is painted: when, from where, in how many pixels, and where things are in it.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "atmosphere/air/medium.h"
#include "atmosphere/sun/sun.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/scissor.h"
#include "viewer/land/land_pass.h"

namespace alpenglow::viewer {

/// When and from where a picture is painted.
struct PaintedView {
  Eye eye;
  UtcInstant now;
  int width, height;                    // of what is painted
  glm::dvec4 part{0.0, 0.0, 1.0, 1.0};  // of the whole view that it is: ViewOfTile
};

/// Angle between neighbouring pixels in the middle of the view [rad].
[[nodiscard]] double PixelAngle(const PaintedView& view);

/// Tangents of half the width and half the height of a view that is painted whole.
[[nodiscard]] glm::dvec2 HalfViewOf(const PaintedView& view);

/// @param samples  rays a pixel.
[[nodiscard]] LandView LandViewOf(const PaintedView& view, int samples = 1);

/// One of a pixel's rays.
struct PixelRay {
  int number = 0, of = 1;
};
/// Where in its pixel it is, in half widths and heights of the picture: 0 for the only one, else
/// spread evenly over the pixel.
[[nodiscard]] glm::dvec2 ShiftOf(const PixelRay& ray, const PaintedView& view);

/// Pixels that a disk of the sky may reach; nothing where none is in the view.
/// @param direction  unit, east, north, up at the eye; radius_rad: angular.
[[nodiscard]] std::optional<PixelBox> PixelsOfDisk(const glm::dvec3& direction, double radius_rad,
                                                   const PaintedView& view);

/// Of the planet's sphere under an eye [km].
[[nodiscard]] double RadiusUnder(const Eye& eye, const Medium& medium);

/// Rows from the lowest that hold all rays under the planet's horizon, and one more: above them is
/// nothing but sky.
[[nodiscard]] int RowsOfPlanet(const PaintedView& view, double radius_km);

/// Unit vector to the sun: east, north, up where it is seen from.
[[nodiscard]] glm::dvec3 DirectionToSun(const SunPosition& sun);

}  // namespace alpenglow::viewer
