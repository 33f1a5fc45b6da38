// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_shadow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/lit_clouds/cloud_chords.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kEdgeNodes = 1025;

/// Returns the heights over an edge at which equal steps of sunlight from 0 to 1 pass.
const std::array<double, kEdgeNodes>& HeightsOverEdge() {
  static const auto kTable = [] {
    std::array<double, kEdgeNodes> table{};
    for (std::size_t i = 0; i < kEdgeNodes; ++i) {
      const double sunlight = static_cast<double>(i) / (kEdgeNodes - 1);
      double low = -1.0, high = 1.0;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = 0.5 * (low + high);
        (SunlightOverEdge(middle) < sunlight ? low : high) = middle;
      }
      table[i] = 0.5 * (low + high);
    }
    table.front() = -1.0;
    table.back() = 1.0;
    return table;
  }();
  return kTable;
}

/// Returns the height over the edge at a distance of a piece.
double HeightAt(const SunlitPiece& piece, double distance_m) {
  return std::lerp(piece.begin_x, piece.end_x, (distance_m - piece.begin_m) / piece.length_m());
}

}  // namespace

double EdgeHeightFor(double sunlight) {
  static const auto& heights = HeightsOverEdge();
  const double at = std::clamp(sunlight, 0.0, 1.0) * (kEdgeNodes - 1);
  const auto node = std::min(static_cast<std::size_t>(at), kEdgeNodes - 2);
  return std::lerp(heights[node], heights[node + 1], at - static_cast<double>(node));
}

CloudShadow::CloudShadow(std::vector<Layer> layers, double highest_cloud_m, double planet_radius_m)
    : layers_(std::move(layers)), highest_cloud_m_(highest_cloud_m), radius_m_(planet_radius_m) {
  for (const auto& [sun, scale] : layers_) {
    mean_scaled_ *= sun->MeanPowerOfTransmittance(sun->field().base_altitude_m(), scale);
    if (sun->low_sun() != nullptr) steps_ = kUnderLowSun;
  }
}

double CloudShadow::Transmittance(const glm::dvec3& point) const {
  const glm::dvec3 flat = InFlatFrame(point, radius_m_);
  double left = 1.0;
  for (const Layer& layer : layers_) left *= layer.sun->Transmittance(flat);
  return left;
}

double CloudShadow::ScaledTransmittance(const glm::dvec3& point, bool is_sharp) const {
  const glm::dvec3 flat = InFlatFrame(point, radius_m_);
  double left = 1.0;
  for (const auto& [sun, scale] : layers_) {
    left *= std::pow(is_sharp ? sun->Transmittance(flat) : sun->TransmittanceAround(flat), scale);
  }
  return left;
}

SunlitPath CloudShadow::OnRay(const SunlitPath& path, const glm::dvec3& origin,
                              const glm::dvec3& direction) const {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const std::vector<CloudChord> shaded =
      ChordsWithin({-radius_m_, highest_cloud_m_}, origin, direction, kEndless, radius_m_);
  if (shaded.empty() || path.empty()) return path;
  const double begin_m = shaded.front().begin_m, end_m = shaded.back().end_m;
  SunlitPathBuilder builder;
  const auto left_at = [&](double distance_m) {
    if (distance_m > steps_.reach_m) return mean_scaled_;
    const glm::dvec3 point = origin + distance_m * direction;
    return ScaledTransmittance(point, distance_m <= kSharpReach_m);
  };
  for (const SunlitPiece& piece : path) {
    const double from_m = std::clamp(begin_m, piece.begin_m, piece.end_m);
    const double to_m = std::clamp(end_m, piece.begin_m, piece.end_m);
    builder.Add({piece.begin_m, from_m, piece.begin_x, HeightAt(piece, from_m)});
    const auto lit_at = [&](double distance_m) {
      const double past_terrain = SunlightOverEdge(HeightAt(piece, distance_m));
      return past_terrain > 0.0 ? EdgeHeightFor(past_terrain * left_at(distance_m)) : -1.0;
    };
    double at_m = from_m;
    double x = from_m < to_m ? lit_at(from_m) : -1.0;
    while (at_m < to_m) {
      const double step_m = at_m >= steps_.reach_m
                                ? to_m - at_m
                                : std::max(steps_.shortest_m, steps_.per_distance * at_m);
      const double next_m = std::min(at_m + step_m, to_m);
      const double next_x = lit_at(next_m);
      builder.Add({at_m, next_m, x, next_x});
      at_m = next_m;
      x = next_x;
    }
    builder.Add({to_m, piece.end_m, HeightAt(piece, to_m), piece.end_x});
  }
  return builder.Take();
}

}  // namespace alpenglow::renderer
