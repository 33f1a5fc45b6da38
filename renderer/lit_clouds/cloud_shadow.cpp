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

constexpr std::size_t kEdgeNodes = 513;

/// Returns SunlightOverEdge at equal steps of x from -1 to 1.
const std::array<double, kEdgeNodes>& SunlightOfEdges() {
  static const auto kTable = [] {
    std::array<double, kEdgeNodes> table{};
    for (std::size_t i = 0; i < kEdgeNodes; ++i)
      table[i] = SunlightOverEdge(2.0 * static_cast<double>(i) / (kEdgeNodes - 1) - 1.0);
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
  const auto& table = SunlightOfEdges();
  if (sunlight <= table.front()) return -1.0;
  if (sunlight >= table.back()) return 1.0;
  const auto above = std::upper_bound(table.begin(), table.end(), sunlight);
  const double low = *std::prev(above);
  const double share = (sunlight - low) / (*above - low);
  const auto node = static_cast<double>(above - table.begin() - 1);
  return 2.0 * (node + share) / (kEdgeNodes - 1) - 1.0;
}

CloudShadow::CloudShadow(std::vector<std::shared_ptr<const CloudSunMap>> maps,
                         double highest_cloud_m, double planet_radius_m)
    : maps_(std::move(maps)), highest_cloud_m_(highest_cloud_m), radius_m_(planet_radius_m) {
  for (const auto& map : maps_) mean_transmittance_ *= map->MeanTransmittance();
}

double CloudShadow::Transmittance(const glm::dvec3& point) const {
  const glm::dvec3 flat = InFlatFrame(point, radius_m_);
  double left = 1.0;
  for (const auto& map : maps_) left *= map->Transmittance(flat);
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
    return distance_m > kReach_m ? mean_transmittance_
                                 : Transmittance(origin + distance_m * direction);
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
      const double step_m =
          at_m >= kReach_m ? to_m - at_m : std::max(kShortestStep_m, kStepPerDistance * at_m);
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
