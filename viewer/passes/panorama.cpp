// SPDX-License-Identifier: MIT
#include "viewer/passes/panorama.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"

namespace alpenglow::viewer {
namespace {

constexpr int kDirections = 4;  // per pixel and axis
constexpr std::size_t kSides = kPanoramaSides;

// Returns the half width of a side's plane, one unit ahead of the eye. The sides overlap by two
// pixels, so that all neighbours exist for interpolation.
double HalfWidth(int pixels) { return 1.0 + 4.0 / pixels; }

// Returns a side of the cube around the eye. Its pixels are half as large as those of the panorama
// in its centre, and smaller elsewhere.
PaintedView SideOf(const PaintedView& panorama, std::size_t side) {
  const int pixels = std::max(static_cast<int>(std::ceil(2.0 / kPi * panorama.width)), 16);
  PaintedView view{panorama.eye, panorama.now, pixels, pixels};
  view.eye.heading_rad = side < 4 ? 0.5 * kPi * static_cast<double>(side) : 0.0;
  view.eye.pitch_rad = side < 4 ? 0.0 : side == 4 ? 0.5 * kPi : -0.5 * kPi;
  view.eye.roll_rad = 0.0;
  view.eye.fov_rad = 2.0 * std::atan(HalfWidth(pixels));
  return view;
}

/// Evenly spaced angles, as points of the unit circle.
std::vector<glm::dvec2> Circle(int count, double first_rad, double range_rad) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = first_rad + range_rad * (i + 0.5) / count;
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  return points;
}

/// The picture of one side, interpolated.
class Side {
 public:
  Side(const ViewAxes& axes, HdrImage image)
      : axes_(axes), half_(HalfWidth(image.width)), image_(std::move(image)) {}

  [[nodiscard]] glm::dvec3 At(const glm::dvec3& direction) const {
    const double ahead = half_ * glm::dot(direction, axes_.forward);
    const auto along = [&](double share) {
      return std::clamp(0.5 * (1.0 + share) * image_.width - 0.5, 0.0, image_.width - 1.001);
    };
    const double x = along(glm::dot(direction, axes_.right) / ahead);
    const double y = along(-glm::dot(direction, axes_.up) / ahead);
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const auto pixel = [&](int right, int down) {
      const std::array<float, 3>& rgb = image_.at(column + right, row + down);
      return glm::dvec3(rgb[0], rgb[1], rgb[2]);
    };
    return glm::mix(glm::mix(pixel(0, 0), pixel(1, 0), x - column),
                    glm::mix(pixel(0, 1), pixel(1, 1), x - column), y - row);
  }

 private:
  ViewAxes axes_;
  double half_;
  HdrImage image_;
};

/// Directions of a panorama, and the sides that show them.
class Directions {
 public:
  explicit Directions(const PaintedView& panorama)
      : axes_(AxesOf(panorama.eye)),
        azimuths_(Circle(kDirections * panorama.width, -kPi, 2.0 * kPi)),
        elevations_(Circle(kDirections * panorama.height, 0.5 * kPi, -kPi)) {
    for (std::size_t side = 0; side < kSides; ++side)
      sides_[side] = AxesOf(SideOf(panorama, side).eye);
  }

  [[nodiscard]] const ViewAxes& side(std::size_t number) const { return sides_[number]; }
  [[nodiscard]] glm::dvec3 At(std::size_t column, std::size_t row) const {
    const glm::dvec2 &azimuth = azimuths_[column], &elevation = elevations_[row];
    return elevation.x * (azimuth.x * axes_.forward + azimuth.y * axes_.right) +
           elevation.y * axes_.up;
  }
  /// Returns the cosine of the elevation in a row of directions.
  [[nodiscard]] double Cosine(std::size_t row) const { return elevations_[row].x; }
  /// Returns its sum over the rows of directions in a row of pixels.
  [[nodiscard]] double SumOfCosines(int row) const {
    double sum = 0.0;
    for (int part = 0; part < kDirections; ++part)
      sum += Cosine(static_cast<std::size_t>(kDirections * row + part));
    return sum;
  }
  [[nodiscard]] std::size_t SideFor(const glm::dvec3& direction) const {
    std::size_t nearest = 0;
    for (std::size_t side = 1; side < kSides; ++side) {
      if (glm::dot(direction, sides_[side].forward) > glm::dot(direction, sides_[nearest].forward))
        nearest = side;
    }
    return nearest;
  }

 private:
  ViewAxes axes_;
  std::vector<glm::dvec2> azimuths_, elevations_;
  std::array<ViewAxes, kSides> sides_;
};

// Adds the directions that a side shows to the pixels of a panorama. They count as the solid angle
// that they stand for, so that a panorama has the light of a small source.
void AddSide(const Directions& directions, std::size_t number, const Side& side,
             HdrImage& panorama) {
  tbb::parallel_for(0, panorama.height, [&](int row) {
    const double per_cosine = 1.0 / (kDirections * directions.SumOfCosines(row));
    for (int i = 0; i < kDirections * kDirections * panorama.width; ++i) {
      const int column = i / (kDirections * kDirections), part = i % (kDirections * kDirections);
      const auto direction_row = static_cast<std::size_t>(kDirections * row + part / kDirections);
      const glm::dvec3 direction = directions.At(
          static_cast<std::size_t>(kDirections * column + part % kDirections), direction_row);
      if (directions.SideFor(direction) != number) continue;
      const glm::dvec3 light = per_cosine * directions.Cosine(direction_row) * side.At(direction);
      std::array<float, 3>& rgb = panorama.at(column, row);
      for (glm::length_t k = 0; k < 3; ++k)
        rgb[static_cast<std::size_t>(k)] += static_cast<float>(light[k]);
    }
  });
}

}  // namespace

bool IsPanorama(const PaintedView& view) { return view.eye.fov_rad > kPi; }

HdrImage PaintPanorama(const PaintedView& panorama,
                       const std::function<HdrImage(const PaintedView& side)>& paint) {
  HdrImage whole(panorama.width, panorama.height);
  const Directions directions(panorama);
  for (std::size_t number = 0; number < kSides; ++number)
    AddSide(directions, number, Side(directions.side(number), paint(SideOf(panorama, number))),
            whole);
  return whole;
}

}  // namespace alpenglow::viewer
