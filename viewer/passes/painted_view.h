// SPDX-License-Identifier: MIT
// A view to be drawn: its time, place and size in pixels, and the positions of objects in it.
//
// BendOf describes atmospheric refraction of a view, or returns no refraction if its effect is not
// visible.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>

#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/refracted_view.h"
#include "atmosphere/time_place/time.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_context.h"
#include "viewer/land/land_pass.h"

namespace alpenglow::viewer {

/// Time, position, camera and size of a picture.
struct PaintedView {
  CameraPose eye;
  UtcTime now;
  int width, height;                    // of this part [pixels]
  glm::dvec4 part{0.0, 0.0, 1.0, 1.0};  // part of the whole view, as in ViewOfTile
};

/// Returns the view with a field of view that a window shows.
[[nodiscard]] inline PaintedView InWindow(PaintedView view) {
  view.eye = InWindow(view.eye);
  return view;
}

/// Returns the angle between neighbouring pixels in the centre of the view [rad].
[[nodiscard]] double PixelAngle(const PaintedView& view);

/// Returns the least angle between neighbouring pixels in the view [rad]: that in its farthest
/// corner.
[[nodiscard]] double LeastPixelAngle(const PaintedView& view);

/// Returns the tangents of half the horizontal and half the vertical field of view, for a view that
/// is drawn whole.
[[nodiscard]] glm::dvec2 HalfViewOf(const PaintedView& view);

/// Returns the axes of the view, as in view/block.glsl: right and up reach from the middle of the
/// picture to its sides, where forward is 1.
[[nodiscard]] ViewAxes AxesOf(const PaintedView& view);

/// One of the rays of a pixel.
struct PixelRay {
  int number = 0, of = 1;
};
/// Returns the offset of a ray from the pixel centre, in half widths and heights of the picture. It
/// is 0 for a single ray; otherwise the rays are spread evenly over the pixel.
[[nodiscard]] glm::dvec2 ShiftOf(const PixelRay& ray, const PaintedView& view);

/// Returns the pixels that a disk in the sky may cover; empty if it is not in the view.
/// @param direction  unit vector east, north, up at the eye.
/// @param radius_rad  angular radius.
[[nodiscard]] std::optional<PixelBox> PixelsOfDisk(const glm::dvec3& direction, double radius_rad,
                                                   const PaintedView& view);

/// Returns the radius of the planet's osculating sphere under an eye [km].
[[nodiscard]] double RadiusUnder(const CameraPose& eye, const Medium& medium);

/// Returns the number of rows, counted from the bottom, that hold all rays below the planet's
/// horizon, plus one. Rows above them hold only sky.
[[nodiscard]] int RowsOfPlanet(const PaintedView& view, double radius_km);

/// Returns the refraction of the rays of a view. Empty if it moves neither the farthest land nor
/// the planet's horizon by more than half a pixel.
/// @param farthest_land_m  distance of the farthest land around the eye, regardless of the part of
///   the picture that is drawn.
[[nodiscard]] std::optional<LandBend> BendOf(const PaintedView& view, const Medium& medium,
                                             double farthest_land_m);

}  // namespace alpenglow::viewer
