// SPDX-License-Identifier: MIT
#include "renderer/picture/skyline.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kQuarter = 0.5 * kPi;

glm::dvec3 East(const glm::dvec3& up) {
  return glm::normalize(glm::dvec3(1.0, 0.0, 0.0) - up.x * up);
}

}  // namespace

Skyline::Skyline(const glm::dvec3& up, const Arc& arc, double step_rad, const SeesSky& sees_sky)
    : up_(up),
      east_(East(up)),
      north_(glm::cross(up_, east_)),
      first_rad_(arc.first_rad),
      step_rad_(step_rad),
      is_whole_turn_(arc.width_rad >= 2.0 * kPi - step_rad) {
  constexpr int kNeighbours = 64;  // found in sequence, each starting from the previous elevation
  if (is_whole_turn_) step_rad_ = 2.0 * kPi / std::ceil(2.0 * kPi / step_rad);
  const int count = is_whole_turn_ ? static_cast<int>(std::lround(2.0 * kPi / step_rad_))
                                   : static_cast<int>(std::ceil(arc.width_rad / step_rad_)) + 1;
  elevation_rad_.resize(static_cast<std::size_t>(count));
  tbb::parallel_for(0, (count + kNeighbours - 1) / kNeighbours, [&](int some) {
    double near_rad = 0.0;
    for (int i = some * kNeighbours; i < std::min((some + 1) * kNeighbours, count); ++i) {
      near_rad = Found(first_rad_ + i * step_rad_, near_rad, sees_sky);
      elevation_rad_[static_cast<std::size_t>(i)] = static_cast<float>(near_rad);
    }
  });
  highest_rad_ =
      static_cast<double>(*std::max_element(elevation_rad_.begin(), elevation_rad_.end()));
}

double Skyline::AzimuthOf(const glm::dvec3& direction, const glm::dvec3& up) {
  const glm::dvec3 east = East(up);
  return std::atan2(glm::dot(direction, glm::cross(up, east)), glm::dot(direction, east));
}

glm::dvec3 Skyline::DirectionAt(double azimuth_rad, double elevation_rad) const {
  return std::cos(elevation_rad) *
             (std::cos(azimuth_rad) * east_ + std::sin(azimuth_rad) * north_) +
         std::sin(elevation_rad) * up_;
}

double Skyline::Found(double azimuth_rad, double near_rad, const SeesSky& sees_sky) const {
  const auto is_sky = [&](double elevation) {
    return sees_sky(DirectionAt(azimuth_rad, elevation));
  };
  double ground = near_rad - step_rad_, sky = near_rad + step_rad_;
  for (double way = 2.0 * step_rad_; ground > -kQuarter && is_sky(ground); way *= 2.0) {
    sky = ground;
    ground = std::max(ground - way, -kQuarter);
  }
  for (double way = 2.0 * step_rad_; sky < kQuarter && !is_sky(sky); way *= 2.0) {
    ground = sky;
    sky = std::min(sky + way, kQuarter);
  }
  while (sky - ground > step_rad_) {
    const double middle = 0.5 * (ground + sky);
    (is_sky(middle) ? sky : ground) = middle;
  }
  return sky;
}

bool Skyline::IsBelow(const glm::dvec3& direction, double around_rad) const {
  const double lowest_rad = std::asin(std::clamp(glm::dot(direction, up_), -1.0, 1.0)) - around_rad;
  if (is_whole_turn_ && lowest_rad > highest_rad_) return true;
  const double x = glm::dot(direction, east_), y = glm::dot(direction, north_);
  const double across = std::hypot(x, y);
  const auto count = static_cast<int>(elevation_rad_.size());
  // Azimuth range of the circle around the direction: its sine is the sine of the angle over the
  // cosine of the elevation.
  if (!(std::sin(around_rad) < across)) return false;
  const double half = std::asin(std::sin(around_rad) / across) / step_rad_ + 1.0;
  const double from_first = std::remainder(std::atan2(y, x) - first_rad_ - kPi, 2.0 * kPi) + kPi;
  const double middle = from_first / step_rad_;
  const int first = static_cast<int>(std::floor(middle - half));
  const int last = static_cast<int>(std::ceil(middle + half));
  if (is_whole_turn_ ? last - first >= count : first < 0 || last >= count) return false;
  for (int i = first; i <= last; ++i) {
    const auto at = static_cast<std::size_t>((i + count) % count);
    if (lowest_rad <= static_cast<double>(elevation_rad_[at])) return false;
  }
  return true;
}

}  // namespace alpenglow::renderer
