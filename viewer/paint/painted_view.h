// SPDX-License-Identifier: MIT
// A view that is painted: when, from where, in how many pixels, and where things are in it.
//
// Refraction of a view: it moves land and the horizon, or nothing that one could see.
//
// Air changes the disk of sun or moon near the horizon: it flattens it, spreads its colours and
// dims its lower limb. Nodes of elevation across the disk, by the renderer's bent rays; shaders
// interpolate (shaders/bent_disks.glsl).
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/bent_view.h"
#include "atmosphere/sun/sun.h"
#include "viewer/air/solved_air.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_objects.h"
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

/// Returns how air bends the rays of a view; nothing where neither the farthest land nor the planet's
/// horizon moves by more than half a pixel.
/// @param farthest_land_m  of the land about the eye, whatever part of a picture is painted.
[[nodiscard]] std::optional<LandBend> BendOf(const PaintedView& view, const Medium& medium,
                                             double farthest_land_m);

/// Values by band, node by node upwards.
struct BentDisk {
  static constexpr int kNodes = 13;  // 3.4' apart: between them lifts are within 0.05' of the rays'

  double first_rad = 0.0, step_rad = 1.0;      // apparent elevations of the nodes
  std::array<glm::vec4, kNodes> lift_rad{};    // apparent less true elevation
  std::array<glm::vec4, kNodes> more_depth{};  // optical depth, more than if the ray were straight

  /// By how much the air shifts parts of the disk against each other [rad]: bands, and the lower
  /// half against the upper.
  [[nodiscard]] double Change() const;
};

/// Some milliseconds. @param elevation_rad, radius_rad  of the disk, apparent.
[[nodiscard]] BentDisk BentDiskOf(const Medium& medium, double height_m, double elevation_rad,
                                  double radius_rad);

/// The same, kept while eye and disk stay about where they are.
class BentDiskFollower {
 public:
  /// Null where the disk stands so high or so far under the horizon that it is round, or where no
  /// part of it moves by `half_pixel_rad`.
  [[nodiscard]] const BentDisk* Follow(const std::shared_ptr<const SolvedAir>& air, double height_m,
                                       double elevation_rad, double radius_rad,
                                       double half_pixel_rad);

 private:
  struct Made {
    std::shared_ptr<const SolvedAir> air;
    double height_m, elevation_rad;
    BentDisk disk;
  };
  std::optional<Made> made_;
};

}  // namespace alpenglow::viewer
