// SPDX-License-Identifier: MIT
#include "renderer/light/segment_air.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/direct_columns.h"
#include "renderer/light/shaft_weights.h"

namespace alpenglow::renderer {
namespace {

// Beams that graze the planet light the end at its shadow by far less than the other.
constexpr int kTwilightNodes = 7;

/// A panel as shaft_weights.h has it.
struct PanelMap {
  double begin_m, end_m;
  bool up;  // altitude rises along the ray
  double slope;

  PanelMap(const DirectPanel& panel, double entry_m)
      : begin_m(entry_m), end_m(entry_m), up(panel.direction > 0.0F), slope(panel.slope) {
    const auto metres = [](float km) { return kMetresPerKilometre * static_cast<double>(km); };
    const double low_m = entry_m + metres(panel.begin), length_m = metres(panel.length);
    begin_m = up ? low_m : low_m - length_m;
    end_m = begin_m + length_m;
  }
  [[nodiscard]] double length_m() const { return end_m - begin_m; }
  [[nodiscard]] double DistanceAt(double v) const {
    const double t = length_m() * shared::DirectDistance<double>(v, slope);
    return up ? begin_m + t : end_m - t;
  }
  // By Newton's method from above: the map is convex, so that it comes down to the root.
  [[nodiscard]] double CoordinateAt(double distance_m) const {
    const double t = (up ? distance_m - begin_m : end_m - distance_m) / length_m();
    double v = std::min(t / slope, 1.0);
    for (double step = 1.0; step > 1e-8;) {
      const double next = v - (shared::DirectDistance<double>(v, slope) - t) /
                                  shared::DirectSlope<double>(v, slope);
      step = v - next;
      v = next;
    }
    return v;
  }
};

float LargestHazeShare(const AirConstants<float>& air) {
  float largest = 0.0F;
  for (std::size_t band = 0; band < air.bands; ++band) {
    const float haze = air.mie_extinction[band];
    largest = std::max(largest, haze / std::max(haze + air.rayleigh[band], 1e-30F));
  }
  return largest;
}

// Sunlight that planet and terrain leave at each lane.
LaneLight Shaded(const DirectRay& placed, const SunlitPath& sunlit) {
  LaneLight light;
  VisitPanels(placed, [&](const PanelNodes& nodes) {
    const DirectPanel& panel = placed.panel[nodes.panel];
    const std::size_t lanes = nodes.count == kManyNodes ? kDirectLanes : kDirectLanes / 2;
    std::fill_n(light.factor.begin() + static_cast<std::ptrdiff_t>(nodes.first), lanes, panel.lit);
    const PanelMap map(panel, placed.extent.begin_m);
    if (LightUnbroken(map, sunlit)) return;
    const ShaftNodes factor = SunlightAtNodes(map, static_cast<int>(nodes.count), sunlit);
    for (std::size_t j = 0; j < nodes.count; ++j)
      light.factor[nodes.SampleOf(j)] *= static_cast<float>(factor[j]);
  });
  return light;
}

bool Breaks(const DirectRay& placed, const SunlitPath* sunlit) {
  if (sunlit == nullptr) return false;
  for (std::size_t i = 0; i < placed.panels; ++i) {
    if (!LightUnbroken(PanelMap(placed.panel[i], placed.extent.begin_m), *sunlit)) return true;
  }
  return false;
}

// Puts the end of the ray into the last lane, which has no node.
void SetEnd(const DirectRay& placed, const ColumnSet<float>& columns, RaySamples<float>& samples) {
  const DirectPanel& panel = placed.panel[placed.panels - 1];
  const float position = panel.direction > 0.0F ? panel.length : 0.0F;
  const std::size_t end = samples.count - 1;
  const float altitude = panel.AltitudeAt(position);
  const float per_radius = 1.0F / (panel.radius + (altitude - panel.altitude));
  const auto cosine = [per_radius](float along) {
    return std::clamp(along * per_radius, -1.0F, 1.0F);
  };
  samples.distance[end] = panel.begin + panel.direction * position;
  samples.weight[end] = samples.lit[end] = 0.0F;
  samples.altitude[end] = std::max(altitude, 0.0F);
  samples.mu[end] = cosine(panel.direction * (panel.from_perigee + position));
  samples.mu_s[end] = cosine(panel.radius * panel.mu_s + position * panel.nu);
  samples.view_rayleigh[end] = columns.rayleigh;
  samples.view_mie[end] = columns.mie;
  samples.view_ozone[end] = columns.ozone;
}

}  // namespace

SegmentAir::SegmentAir(const AirIntegrator<float>& air)
    : air_(air),
      direct_(air.medium()),
      haze_share_(LargestHazeShare(air.constants())),
      rayleigh_height_km_(air.constants().rayleigh_height),
      mie_height_km_(air.constants().mie_height) {}

DirectRay SegmentAir::Place(const ViewRay& ray) const {
  return direct_.Place(ray, {.mode = DirectMode::kFast, .dark_samples = true});
}

int SegmentAir::NodesFor(const DirectPanel& panel, bool shafts) const {
  const float rise = panel.AltitudeAt(panel.length) - panel.altitude;
  // Logarithm of how much the integrand changes from end to end.
  const float change =
      panel.dense * panel.length + rise / rayleigh_height_km_ + haze_share_ * rise / mie_height_km_;
  constexpr float kMost = 12.0F;
  return 2 + static_cast<int>(std::min(change, 2.0F * kMost) / 1.2F) + (shafts ? 3 : 0);
}

int SegmentAir::NodesFor(const DirectRay& placed, bool shafts) const {
  int nodes = 0;
  for (std::size_t i = 0; i < placed.panels; ++i) {
    const DirectPanel& panel = placed.panel[i];
    nodes = std::max({nodes, NodesFor(panel, shafts), panel.mu_s < 0.0F ? kTwilightNodes : 0});
  }
  return nodes;
}

ColumnSet<float> SegmentAir::ColumnsAlong(const ViewRay& ray, const DirectRay& placed) const {
  constexpr float kMostHeights = 6.0F;  // for DirectScattering::ColumnsAlong
  float lowest = placed.panel[0].altitude, highest = lowest;
  for (std::size_t i = 0; i < placed.panels; ++i) {
    const DirectPanel& panel = placed.panel[i];
    lowest = std::min(lowest, panel.altitude);
    highest = std::max(highest, panel.AltitudeAt(panel.length));
  }
  const OzoneLayer& ozone = air_.medium().ozone;
  const bool bends = ozone.shape == OzoneShape::kTent &&
                     highest > static_cast<float>(ozone.bottom_m / kMetresPerKilometre);
  const bool is_short = highest - lowest < kMostHeights * mie_height_km_;
  return is_short && !bends ? direct_.ColumnsAlong(placed) : air_.ColumnsAlong(ray);
}

SegmentAir::Lit SegmentAir::LightOf(const ViewRay& ray, const DirectRay& placed,
                                    const SunlitPath* sunlit, int most_nodes) const {
  const bool shafts = Breaks(placed, sunlit);
  const int nodes = std::min(NodesFor(placed, shafts), most_nodes);
  Lit lit{placed, !shafts, {}};
  if (nodes <= static_cast<int>(kMostFewNodes)) {
    lit.placed.few_nodes = static_cast<std::size_t>(nodes);
  } else {
    lit.placed = direct_.Place(ray, {.mode = DirectMode::kNormal, .dark_samples = true});
  }
  if (shafts) lit.light = Shaded(lit.placed, *sunlit);
  return lit;
}

ScatteredOnce<float> SegmentAir::Once(const ViewRay& ray, const DirectRay& placed,
                                      const SunlitPath* sunlit, int most_nodes) const {
  const Lit lit = LightOf(ray, placed, sunlit, most_nodes);
  return direct_.Scatter(lit.placed, lit.sunlight());
}

SampledLight SegmentAir::Sample(const ViewRay& ray, const DirectRay& placed,
                                const SunlitPath* sunlit, int most_nodes) const {
  const Lit lit = LightOf(ray, placed, sunlit, most_nodes);
  SampledLight light = direct_.Sample(lit.placed, lit.sunlight());
  SetEnd(lit.placed, ColumnsAlong(ray, lit.placed), light.samples);
  return light;
}

}  // namespace alpenglow::renderer
