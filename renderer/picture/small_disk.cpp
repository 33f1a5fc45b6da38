// SPDX-License-Identifier: MIT
#include "renderer/picture/small_disk.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace alpenglow::renderer {
namespace {

/// Rotates a direction by Rodrigues' formula. @param axis  unit.
glm::dvec3 TurnedAbout(const glm::dvec3& axis, double angle_rad, const glm::dvec3& direction) {
  return std::cos(angle_rad) * direction + std::sin(angle_rad) * glm::cross(axis, direction) +
         (1.0 - std::cos(angle_rad)) * glm::dot(axis, direction) * axis;
}

/// Returns the number of samples of a cell around a point of the picture, a power of 2: each covers
/// half a pixel at most, and blurred cells share the places of the blur among them.
int SamplesOfCell(const MovingCamera& camera, const ArrivingRay& middle, double width_rad) {
  constexpr double kPerPixel = 2.0;
  constexpr unsigned kBlurred = 64;
  const auto [across_rad, down_rad] = camera.middle().PixelExtentAt(middle.x, middle.y);
  const double pixel_rad = std::max(std::min(across_rad, down_rad), 1e-9);
  const double side = std::clamp(std::ceil(kPerPixel * width_rad / pixel_rad), 1.0, 32.0);
  const auto fine = static_cast<unsigned>(side * side);
  const bool is_blurred = camera.IsMoving() || camera.middle().HasLens();
  return static_cast<int>(std::bit_ceil(is_blurred ? std::max(fine, kBlurred) : fine));
}

bool IsDark(const Spectrum& light) {
  return std::all_of(light.values().begin(), light.values().end(),
                     [](float band) { return band <= 0.0F; });
}

}  // namespace

/// The cells that cover a disk and its motion, in angles around the axis of the motion and towards
/// it. The area of a disk of half the width of a grid at rest is right within 1 %.
class SmallDisk::Grid {
 public:
  explicit Grid(const DiskInSky& disk) : to_disk_(disk.to_disk) {
    constexpr int kSide = 48;
    const double turn_rad = glm::length(disk.turn);
    const glm::dvec3 other =
        std::abs(to_disk_.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 beside = glm::normalize(glm::cross(to_disk_, other));
    axis_ = turn_rad > 0.0 ? disk.turn / turn_rad : beside;
    const glm::dvec3 towards = axis_ - glm::dot(axis_, to_disk_) * to_disk_;
    const double sine = glm::length(towards);  // > 0: sun and moon do not stand at a celestial pole
    towards_axis_ = towards / sine;
    down_rad_ = 2.0 * disk.around_rad / kSide;
    across_rad_ = down_rad_ / sine;
    rows_ = kSide;
    columns_ = kSide + static_cast<int>(std::ceil(turn_rad / across_rad_));
  }

  [[nodiscard]] int size() const { return columns_ * rows_; }
  /// Angle around the middle of the disk that contains all cells [rad].
  [[nodiscard]] double around_rad() const {
    return std::hypot(0.5 * columns_ * across_rad_, 0.5 * rows_ * down_rad_);
  }
  /// Width of a cell [rad].
  [[nodiscard]] double width_rad() const { return down_rad_; }
  /// Returns the direction of a point of a cell, in [0, 1) x [0, 1).
  [[nodiscard]] glm::dvec3 DirectionIn(int cell, const std::array<double, 2>& point) const {
    const double across = (cell % columns_ + point[0] - 0.5 * columns_) * across_rad_;
    const double towards = TowardsAxis(cell, point[1]);
    return TurnedAbout(axis_, across,
                       std::cos(towards) * to_disk_ + std::sin(towards) * towards_axis_);
  }
  /// Returns the solid angle of a cell [sr].
  [[nodiscard]] double SolidAngleOf(int cell) const {
    const double towards = TowardsAxis(cell, 0.5);
    const glm::dvec3 in_row = std::cos(towards) * to_disk_ + std::sin(towards) * towards_axis_;
    return across_rad_ * down_rad_ * glm::length(glm::cross(axis_, in_row));
  }
  /// Returns the samples of the picture, of the lens and of the time that belong to a cell.
  [[nodiscard]] PixelSamples SamplesOf(int cell, int count) const {
    return {cell % columns_, cell / columns_, count};
  }

 private:
  [[nodiscard]] double TowardsAxis(int cell, double point) const {
    return (cell / columns_ + point - 0.5 * rows_) * down_rad_;
  }

  glm::dvec3 to_disk_, axis_{0.0}, towards_axis_{0.0};
  double across_rad_ = 0.0, down_rad_ = 0.0;  // of a cell; across: around the axis
  int columns_ = 0, rows_ = 0;
};

SmallDisk::SmallDisk(const MovingCamera& camera, const PixelFilter& filter, int width, int height,
                     const DiskInSky& disk)
    : width_(width), height_(height), spread_(width, height) {
  const Grid grid(disk);
  if (!camera.MaySee(disk.to_disk, grid.around_rad(), filter.radius())) return;
  for (int cell = 0; cell < grid.size(); ++cell) AddCell(camera, filter, disk, grid, cell);
}

void SmallDisk::AddCell(const MovingCamera& camera, const PixelFilter& filter,
                        const DiskInSky& disk, const Grid& grid, int cell) {
  constexpr std::array kMiddle{0.5, 0.5};
  const glm::dvec3 middle = grid.DirectionIn(cell, kMiddle);
  const auto seen = camera.middle().RayFrom(middle, kMiddle);
  if (!seen && !camera.IsMoving()) return;
  const int count =
      seen ? SamplesOfCell(camera, *seen, grid.width_rad()) : PixelSamples::kMostSamples;
  const PixelSamples samples = grid.SamplesOf(cell, count);
  std::optional<Spectrum> share;  // of a sample, known when the first of them is seen
  for (int i = 0; i < count; ++i) {
    const auto of = [&](SampleOf decision) {
      return count == 1 ? kMiddle : samples.Point(i, decision);
    };
    const CameraRays& then =
        camera.IsMoving() ? camera.At(of(SampleOf::kTime)[0]) : camera.middle();
    const auto ray =
        then.RayFrom(grid.DirectionIn(cell, of(SampleOf::kPixel)), of(SampleOf::kLens));
    const double reach = filter.radius();
    if (!ray || ray->x < -reach || ray->x > width_ + reach || ray->y < -reach ||
        ray->y > height_ + reach || !disk.is_open(ray->ray))
      continue;
    if (!share) share = static_cast<float>(grid.SolidAngleOf(cell) / count) * disk.radiance(middle);
    if (IsDark(*share)) return;
    Spread(camera.middle(), filter, *ray, *share);
  }
}

// The weights of the pixels around a point are scaled so that they sum to one: the illuminance in
// the picture is that of the disk.
void SmallDisk::Spread(const CameraRays& camera, const PixelFilter& filter, const ArrivingRay& at,
                       const Spectrum& irradiance) {
  constexpr int kReach = 2;
  using Weights = std::array<double, 2 * kReach + 1>;
  const auto weights_around = [&](double place) {
    Weights weights{};
    double sum = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
      const double off = place - std::floor(place) - i - 0.5;
      if (std::abs(off) > filter.radius()) continue;
      sum += weights.at(static_cast<std::size_t>(i + kReach)) = filter.Weight(off);
    }
    for (double& weight : weights) weight /= sum;
    return weights;
  };
  const Weights across = weights_around(at.x), down = weights_around(at.y);
  for (int j = -kReach; j <= kReach; ++j) {
    for (int i = -kReach; i <= kReach; ++i) {
      const double weight = across.at(static_cast<std::size_t>(i + kReach)) *
                            down.at(static_cast<std::size_t>(j + kReach));
      if (weight == 0.0) continue;
      spread_.Add(camera, static_cast<int>(std::floor(at.x)) + i,
                  static_cast<int>(std::floor(at.y)) + j, static_cast<float>(weight) * irradiance);
    }
  }
}

}  // namespace alpenglow::renderer
