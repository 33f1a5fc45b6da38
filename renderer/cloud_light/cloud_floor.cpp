// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_floor.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "renderer/clouds/periodic_index.h"

namespace alpenglow::renderer {
namespace {

using FloorValues = std::vector<float>;

/// A line of values that repeats: `count` of them, `stride` apart.
struct FloorLine {
  std::size_t first, stride;
  int count;

  [[nodiscard]] std::size_t At(int i) const {
    return first + stride * static_cast<std::size_t>(PeriodicIndex(i, count));
  }
};

/// Replaces the values of a line by means over `radius` neighbours on both sides.
void AverageAlong(const FloorLine& line, int radius, FloorValues& values, FloorValues& room) {
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) sum += static_cast<double>(values[line.At(i)]);
  room.resize(static_cast<std::size_t>(line.count));
  for (int i = 0; i < line.count; ++i) {
    room[static_cast<std::size_t>(i)] = static_cast<float>(sum / (2 * radius + 1));
    sum += static_cast<double>(values[line.At(i + radius + 1)]) -
           static_cast<double>(values[line.At(i - radius)]);
  }
  for (int i = 0; i < line.count; ++i) values[line.At(i)] = room[static_cast<std::size_t>(i)];
}

/// Convolves values with a Gaussian function: three means over 2 r + 1 values have the variance
/// r (r + 1).
void Spread(const CloudColumns& columns, double deviation_m, FloorValues& values) {
  FloorValues room;
  for (int axis = 0; axis < 2; ++axis) {
    const auto [x_count, y_count] = columns.count;
    const double deviation = deviation_m / columns.cell_m[axis];
    const auto radius =
        static_cast<int>(std::lround(std::sqrt(deviation * deviation + 0.25) - 0.5));
    const int across = axis == 0 ? y_count : x_count;
    const auto x_stride = static_cast<std::size_t>(x_count);
    for (int k = 0; radius > 0 && k < across; ++k) {
      const auto number = static_cast<std::size_t>(k);
      const FloorLine line = axis == 0 ? FloorLine{number * x_stride, 1, x_count}
                                       : FloorLine{number, x_stride, y_count};
      for (int pass = 0; pass < 3; ++pass) AverageAlong(line, radius, values, room);
    }
  }
}

/// Returns a value linear between values at integers, which repeat.
double LinearAt(const CloudColumns& columns, const FloorValues& values, const glm::dvec2& at) {
  const auto [x_count, y_count] = columns.count;
  const double x = std::floor(at.x), y = std::floor(at.y);
  const auto value = [&, x_count = x_count, y_count = y_count](double column, double line) {
    const auto row = static_cast<std::size_t>(PeriodicIndex(line, y_count));
    return static_cast<double>(values[row * static_cast<std::size_t>(x_count) +
                                      static_cast<std::size_t>(PeriodicIndex(column, x_count))]);
  };
  return std::lerp(std::lerp(value(x, y), value(x + 1.0, y), at.x - x),
                   std::lerp(value(x, y + 1.0), value(x + 1.0, y + 1.0), at.x - x), at.y - y);
}

}  // namespace

CloudFloor::CloudFloor(const CloudColumns& columns, const std::vector<CloudBaseLight>& light,
                       double depth_m)
    : columns_(columns),
      irradiance_(static_cast<std::size_t>(columns.count[0]) *
                  static_cast<std::size_t>(columns.count[1])) {
  std::vector<FloorValues> radiances(light.size());
  tbb::parallel_for(std::size_t{0}, light.size(), [&](std::size_t i) {
    const glm::dvec3& travel = light[i].travel;
    const glm::dvec2 shift_m = depth_m / -travel.z * glm::dvec2(travel);
    radiances[i] = light[i].radiance;
    Spread(columns_, std::hypot(kTraceWidth * glm::length(shift_m), kLeastTrace_m), radiances[i]);
  });
  const int lines = columns.count[1];
  tbb::parallel_for(0, lines, [&](int line) {
    for (int column = 0; column < columns_.count[0]; ++column) {
      const glm::dvec2 middle_m = (glm::dvec2(column, line) + 0.5) * columns_.cell_m;
      double sum = 0.0;
      for (std::size_t i = 0; i < light.size(); ++i) {
        const glm::dvec3& travel = light[i].travel;
        const glm::dvec2 from_m =
            middle_m - depth_m / -travel.z * glm::dvec2(travel) - light[i].place_m;
        sum += light[i].solid_angle_sr * -travel.z *
               LinearAt(columns_, radiances[i], from_m / columns_.cell_m);
      }
      irradiance_[static_cast<std::size_t>(line) * static_cast<std::size_t>(columns_.count[0]) +
                  static_cast<std::size_t>(column)] = static_cast<float>(sum);
    }
  });
  for (const float value : irradiance_)
    mean_ += static_cast<double>(value) / static_cast<double>(irradiance_.size());
}

double CloudFloor::At(const glm::dvec2& place_m) const {
  return LinearAt(columns_, irradiance_, (place_m - columns_.origin_m) / columns_.cell_m - 0.5);
}

}  // namespace alpenglow::renderer
