// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/mirrored_clouds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/math/constants.h"
#include "renderer/clouds/periodic_index.h"

namespace alpenglow::renderer {
namespace {

// Rays that are flatter count as this steep: light that meets a second wave comes from there.
constexpr double kLeastElevation_rad = 0.01;
constexpr double kUpright_rad = 0.5 * kPi;

double ElevationOf(int number) {
  const double root = static_cast<double>(number) / (MirroredClouds::kElevations - 1);
  return std::max(kUpright_rad * root * root, kLeastElevation_rad);
}

}  // namespace

MirroredClouds::MirroredClouds(const MirrorEye& eye, Trace trace)
    : eye_(eye),
      trace_(std::move(trace)),
      asked_(std::make_unique<std::once_flag[]>(static_cast<std::size_t>(kAzimuths) * kElevations)),
      entry_(static_cast<std::size_t>(kAzimuths) * kElevations) {
  const glm::dvec3 beside =
      std::abs(eye.up.x) < 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  north_ = glm::normalize(glm::cross(eye.up, beside));
  east_ = glm::cross(north_, eye.up);
}

const CloudChange& MirroredClouds::Entry(int azimuth, int elevation) const {
  const auto number = static_cast<std::size_t>(elevation) * kAzimuths +
                      static_cast<std::size_t>(PeriodicIndex(azimuth, kAzimuths));
  std::call_once(asked_[number], [&] {
    const double azimuth_rad = 2.0 * kPi * azimuth / kAzimuths, rise = ElevationOf(elevation);
    const glm::dvec3 away = std::cos(azimuth_rad) * east_ + std::sin(azimuth_rad) * north_;
    const double slope = std::tan(rise), fall = 2.0 * eye_.height_m / eye_.radius_m;
    const double bend = fall / (std::sqrt(slope * slope + fall) + slope);
    const glm::dvec3 up = std::cos(bend) * eye_.up + std::sin(bend) * away;
    const glm::dvec3 level = std::cos(bend) * away - std::sin(bend) * eye_.up;
    const glm::dvec3 point = eye_.foot + eye_.radius_m * (up - eye_.up);
    entry_[number] = trace_(point, std::cos(rise) * level + std::sin(rise) * up);
  });
  return entry_[number];
}

CloudChange MirroredClouds::Towards(const glm::dvec3& direction, const glm::dvec3& up) const {
  const double rise = std::max(std::asin(std::clamp(glm::dot(direction, up), -1.0, 1.0)), 0.0);
  const double row = std::sqrt(rise / kUpright_rad) * (kElevations - 1);
  const double column =
      std::atan2(glm::dot(direction, north_), glm::dot(direction, east_)) / (2.0 * kPi) * kAzimuths;
  const int low = std::min(static_cast<int>(row), kElevations - 2);
  const auto west = static_cast<int>(std::floor(column));
  const double over = row - low, past = column - west;
  CloudChange change;
  const auto add = [&](int azimuth, int elevation, double weight) {
    const CloudChange& entry = Entry(azimuth, elevation);
    if (change.left.size() == 0) change.left = change.added = Spectrum(entry.left.size());
    change.left = change.left + static_cast<float>(weight) * entry.left;
    change.added = change.added + static_cast<float>(weight) * entry.added;
  };
  add(west, low, (1.0 - past) * (1.0 - over));
  add(west + 1, low, past * (1.0 - over));
  add(west, low + 1, (1.0 - past) * over);
  add(west + 1, low + 1, past * over);
  return change;
}

}  // namespace alpenglow::renderer
