// SPDX-License-Identifier: MIT
#include "renderer/lamp/ies_angles.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <tuple>
#include <utility>

#include "atmosphere/number/constants.h"

namespace alpenglow::renderer {
namespace {

using Columns = std::vector<std::pair<double, std::size_t>>;  // angle [degrees], measured plane

// The horizontal angles at which a measured plane of type C also holds.
std::vector<double> MirroredIn(const std::vector<double>& all_deg, double angle_deg) {
  const double last = all_deg.back();
  if (all_deg.front() == 90.0) return {angle_deg, 180.0 - angle_deg};
  if (last == 90.0) return {angle_deg, 180.0 - angle_deg, 180.0 + angle_deg, 360.0 - angle_deg};
  if (last == 180.0) return {angle_deg, 360.0 - angle_deg};
  return {angle_deg};
}

// Planes around the whole turn, ascending from 0 to below 360 degrees, each once.
Columns WholeTurn(const std::vector<double>& horizontal_deg) {
  Columns columns;
  for (std::size_t i = 0; i < horizontal_deg.size(); ++i) {
    for (const double angle : MirroredIn(horizontal_deg, horizontal_deg[i])) {
      columns.emplace_back(angle - 360.0 * std::floor(angle / 360.0), i);
    }
  }
  std::stable_sort(columns.begin(), columns.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  columns.erase(std::unique(columns.begin(), columns.end(), same), columns.end());
  return columns;
}

// A table begins at 0. Where no plane was measured there, it lies on the line between its
// neighbours, the first column and the last.
void BeginAtZero(LampTable& table) {
  const std::size_t verticals = table.gamma_rad.size();
  const std::size_t last = table.intensity.size() - verticals;
  const double before = 2.0 * kPi - table.c_rad.back();
  const double share = before / (before + table.c_rad.front());  // of the first column
  std::vector<double> column;
  for (std::size_t i = 0; i < verticals; ++i) {
    column.push_back((1.0 - share) * table.intensity[last + i] + share * table.intensity[i]);
  }
  table.c_rad.insert(table.c_rad.begin(), 0.0);
  table.intensity.insert(table.intensity.begin(), column.begin(), column.end());
}

LampTable TypeC(const MeasuredAngles& measured) {
  LampTable table;
  for (const double angle : measured.vertical_deg) {
    table.gamma_rad.push_back(angle * kRadiansPerDegree);
  }
  const auto verticals = static_cast<std::ptrdiff_t>(measured.vertical_deg.size());
  for (const auto& [angle, plane] : WholeTurn(measured.horizontal_deg)) {
    const auto from = measured.intensity.begin() + static_cast<std::ptrdiff_t>(plane) * verticals;
    table.c_rad.push_back(angle * kRadiansPerDegree);
    table.intensity.insert(table.intensity.end(), from, from + verticals);
  }
  if (table.c_rad.front() > 0.0) BeginAtZero(table);
  return table;
}

/// A place among ascending angles, or none outside of them.
struct AnglePlace {
  std::size_t low = 0;
  double share = 0.0;  // of the next one
  bool is_inside = false;
};

AnglePlace PlaceAmong(const std::vector<double>& angles, double at) {
  constexpr double kRounding_deg = 1e-9;
  if (at < angles.front() - kRounding_deg || at > angles.back() + kRounding_deg) return {};
  const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, at);
  const auto low = static_cast<std::size_t>(above - angles.begin()) - 1;
  const double share = (at - angles[low]) / (angles[low + 1] - angles[low]);
  return {low, std::clamp(share, 0.0, 1.0), true};
}

double IntensityAt(const MeasuredAngles& measured, double vertical_deg, double horizontal_deg) {
  const bool is_mirrored = measured.horizontal_deg.front() == 0.0;
  const AnglePlace v = PlaceAmong(measured.vertical_deg, vertical_deg);
  const AnglePlace h =
      PlaceAmong(measured.horizontal_deg, is_mirrored ? std::abs(horizontal_deg) : horizontal_deg);
  if (!v.is_inside || !h.is_inside) return 0.0;
  const auto plane = [&](std::size_t horizontal) {
    const double* values =
        measured.intensity.data() + horizontal * measured.vertical_deg.size() + v.low;
    return (1.0 - v.share) * values[0] + v.share * values[1];
  };
  return (1.0 - h.share) * plane(h.low) + h.share * plane(h.low + 1);
}

// Towards a direction (d, a, l), see the header. On the axis of the planes their angle is 0.
double IntensityTowards(const MeasuredAngles& measured, const glm::dvec3& direction) {
  const auto degrees = [](double sine, double cosine) {
    constexpr double kOnAxis = 1e-12;
    return std::hypot(sine, cosine) < kOnAxis ? 0.0 : std::atan2(sine, cosine) / kRadiansPerDegree;
  };
  const auto [d, a, l] = std::tuple(direction.x, direction.y, direction.z);
  if (measured.type == PhotometricType::kB) {
    return IntensityAt(measured, degrees(a, d), degrees(-l, std::hypot(d, a)));
  }
  return IntensityAt(measured, degrees(-d, std::hypot(a, l)), degrees(-l, a));
}

double SmallestStep(const std::vector<double>& angles) {
  double smallest = 180.0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    smallest = std::min(smallest, angles[i] - angles[i - 1]);
  }
  return smallest;
}

// Steps per quarter of a turn.
int StepsFor(const MeasuredAngles& measured) {
  constexpr double kFinest_deg = 0.25, kCoarsest_deg = 2.5;
  const double step =
      0.5 * std::min(SmallestStep(measured.vertical_deg), SmallestStep(measured.horizontal_deg));
  return static_cast<int>(std::ceil(90.0 / std::clamp(step, kFinest_deg, kCoarsest_deg) - 1e-9));
}

LampTable SampledInTypeC(const MeasuredAngles& measured) {
  const int quarter = StepsFor(measured);
  const double step_rad = 0.5 * kPi / quarter;
  LampTable table;
  for (int i = 0; i <= 2 * quarter; ++i) table.gamma_rad.push_back(i * step_rad);
  for (int c = 0; c < 4 * quarter; ++c) {
    table.c_rad.push_back(c * step_rad);
    for (const double gamma : table.gamma_rad) {
      table.intensity.push_back(IntensityTowards(
          measured, {std::cos(gamma), std::sin(gamma) * std::cos(table.c_rad.back()),
                     std::sin(gamma) * std::sin(table.c_rad.back())}));
    }
  }
  return table;
}

}  // namespace

bool HasWholeTurn(PhotometricType type, const std::vector<double>& horizontal_deg) {
  const double first = horizontal_deg.front(), last = horizontal_deg.back();
  if (type == PhotometricType::kC) {
    return (first == 0.0 && (last == 0.0 || last == 90.0 || last == 180.0 || last == 360.0)) ||
           (first == 90.0 && last == 270.0);
  }
  return last > 0.0 && last <= 90.0 && (first == 0.0 || first == -last);
}

LampTable TableOf(const MeasuredAngles& measured) {
  return measured.type == PhotometricType::kC ? TypeC(measured) : SampledInTypeC(measured);
}

}  // namespace alpenglow::renderer
