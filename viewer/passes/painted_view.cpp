// SPDX-License-Identifier: MIT
#include "viewer/passes/painted_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/camera_tables/air_rows.h"
#include "renderer/camera/camera_rays.h"

namespace alpenglow::viewer {
namespace {

// Returns the position of the minimum of a convex function between -1 and 1, to 1e-5. The minimum
// value is then accurate to about 1e-10.
template <typename Function>
double LeastOf(const Function& function) {
  constexpr double kGolden = 0.6180339887498949;
  double low = -1.0, high = 1.0;
  while (high - low > 1e-5) {
    const double width = kGolden * (high - low);
    if (function(high - width) < function(low + width))
      high = low + width;
    else
      low = high - width;
  }
  return 0.5 * (low + high);
}

}  // namespace

double PixelAngle(const PaintedView& view) {
  return 2.0 * std::tan(0.5 * view.eye.fov_rad) / (view.width * view.part.z);
}

// On a plane picture an angle a off its centre, pixels are smaller by the square of cos(a).
double LeastPixelAngle(const PaintedView& view) {
  const glm::dvec2 middle(view.part.x * view.part.z, view.part.y * view.part.w);
  const glm::dvec2 corner = HalfViewOf(view) / view.part.z * (glm::abs(middle) + 1.0);
  return PixelAngle(view) / (1.0 + glm::dot(corner, corner));
}

glm::dvec2 HalfViewOf(const PaintedView& view) {
  const double half_width = std::tan(0.5 * view.eye.fov_rad);
  return {half_width, half_width * view.height / view.width};
}

ViewAxes AxesOf(const PaintedView& view) {
  const ViewAxes axes = AxesOf(view.eye);
  const glm::dvec2 half = HalfViewOf(view) / view.part.z;
  return {half.x * axes.right, half.y * axes.up, axes.forward};
}

// The shift is equal for all pixels.
glm::dvec2 ShiftOf(const PixelRay& ray, const PaintedView& view) {
  if (ray.of == 1) return glm::dvec2(0.0);
  const auto [x, y] = PixelSamples(0, 0, ray.of).Point(ray.number, SampleOf::kPixel);
  return {(2.0 * x - 1.0) / view.width, (2.0 * y - 1.0) / view.height};
}

std::optional<PixelBox> PixelsOfDisk(const glm::dvec3& direction, double radius_rad,
                                     const PaintedView& view) {
  const ViewAxes axes = AxesOf(view);
  const double along = glm::dot(direction, axes.forward);
  if (along <= 0.0) return std::nullopt;
  const auto pixel = [&](const glm::dvec3& axis, double part, int side) {
    const double at = glm::dot(direction, axis) / glm::dot(axis, axis) / along - part;
    return 0.5 * side * (1.0 + at);
  };
  const double x = pixel(axes.right, view.part.x * view.part.z, view.width);
  const double y = pixel(axes.up, view.part.y * view.part.w, view.height);
  // Off the centre of the view, disks are stretched: tan(a + r) - tan(a) = sin(r) / (cos(a) cos(a +
  // r)). Light of small disks falls beside them (small_disk_painter.h), by a tenth of that and a pixel.
  const double off_rad = std::acos(std::min(along, 1.0)) + radius_rad;
  const double stretch = 1.0 / (along * std::max(std::cos(off_rad), 0.01));
  const double reach = 1.2 * std::sin(radius_rad) / PixelAngle(view) * stretch + 2.0;
  if (x < -reach || y < -reach || x > view.width + reach || y > view.height + reach)
    return std::nullopt;
  const int side = static_cast<int>(std::ceil(2.0 * reach)) + 1;
  return PixelBox{static_cast<int>(std::floor(x - reach)), static_cast<int>(std::floor(y - reach)),
                  side, side};
}

double RadiusUnder(const CameraPose& eye, const Medium& medium) {
  return OnOsculatingSphere(medium, eye.place.latitude_rad()).planet_radius_m / kMetresPerKilometre;
}

// A ray d is below the horizon with cosine c <= 0 where d.z - c |d| < 0. This function is convex
// over the picture, and so is its minimum over each row as a function of the row.
int RowsOfPlanet(const PaintedView& view, double radius_km) {
  const ViewAxes axes = AxesOf(view);
  const double altitude_km = std::max(view.eye.place.height_m, 0.0) / kMetresPerKilometre;
  const double horizon = shared::HorizonCosine(altitude_km, radius_km);
  const glm::dvec3 middle =
      axes.forward + view.part.x * view.part.z * axes.right + view.part.y * view.part.w * axes.up;
  const double half_width = glm::length(axes.right);
  const glm::dvec3 along = axes.right / half_width;
  // With d = p + s a, where p is perpendicular to the row's axis a, the least value is where
  // s / |d| = a.z / c.
  constexpr double kMostSine = 1.0 - 1e-6;  // its tangent leads out of every picture
  const double sine = std::clamp(along.z / std::min(horizon, -1e-9), -kMostSine, kMostSine);
  const double tangent = sine / std::sqrt(1.0 - sine * sine);
  const auto least_of_row = [&](double y) {
    const glm::dvec3 row = middle + y * axes.up;
    const double centre = glm::dot(row, along);
    const glm::dvec3 p = row - centre * along;
    const double s = std::clamp(glm::length(p) * tangent, centre - half_width, centre + half_width);
    const glm::dvec3 d = p + s * along;
    return d.z - horizon * glm::length(d);
  };
  double under = LeastOf(least_of_row), over = 1.0;
  if (least_of_row(under) >= 0.0) return 0;
  if (least_of_row(over) < 0.0) return view.height;
  while (over - under > 1e-6) {
    const double y = 0.5 * (under + over);
    (least_of_row(y) < 0.0 ? under : over) = y;
  }
  return std::min(static_cast<int>(0.5 * (over + 1.0) * view.height) + 2, view.height);
}

std::optional<LandBend> BendOf(const PaintedView& view, const Medium& medium,
                               double farthest_land_m) {
  BendingAir air = GentleAirOf(medium);
  air.planet_radius_m = RadiusUnder(view.eye, medium) * kMetresPerKilometre;
  const double height_m = std::max(view.eye.place.height_m, 0.0);
  const LandBend bend = LandBendOf(air, height_m);
  if (MostLiftOfPlanet(bend, height_m, farthest_land_m) <= 0.5 * LeastPixelAngle(view))
    return std::nullopt;
  return bend;
}

}  // namespace alpenglow::viewer
