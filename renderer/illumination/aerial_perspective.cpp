// SPDX-License-Identifier: MIT
#include "renderer/illumination/aerial_perspective.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::renderer {
namespace {

/// Table of (2 n + 1) P_n at the nodes of a Gauss rule on [0, 1].
using LegendreAtNodes = std::array<ShaftNodes, kMostShaftNodes>;  // [n][node]

LegendreAtNodes LegendreOf(int nodes) {
  LegendreAtNodes table{};
  const GaussRule& rule = GaussLegendre(nodes);
  for (std::size_t j = 0; j < rule.node.size(); ++j) {
    VisitLegendre(nodes, rule.node[j], [&](int n, double p) {
      table[static_cast<std::size_t>(n)][j] = (2.0 * n + 1.0) * p;
    });
  }
  return table;
}

const LegendreAtNodes& LegendreAt(int nodes) {
  static const auto kTables = [] {
    std::array<LegendreAtNodes, kMostShaftNodes + 1> tables{};
    for (int count = 1; count <= kMostShaftNodes; ++count)
      tables[static_cast<std::size_t>(count)] = LegendreOf(count);
    return tables;
  }();
  return kTables[static_cast<std::size_t>(nodes)];
}

// Beams that graze the planet light the end at its shadow much less than the other end.
constexpr int kTwilightNodes = 7;

/// A panel as described in aerial_perspective.h.
struct PanelMap {
  double begin_m, end_m;
  bool up;  // altitude increases along the ray
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
  // Newton's method from above: the map is convex, so the iteration decreases towards the root.
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

// Returns the sunlight that planet and terrain let through at each lane.
LaneLight LaneLightInShade(const DirectRay& placed, const SunlitPath& sunlit) {
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

// Stores the end of the ray in the last lane, which has no node.
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

/// A stretch of the ray where the integrand is smooth and altitude monotone. Distances are from the
/// eye [m]; v runs from 0 at the lower end to 1, by ray_map.glsl.
struct Panel {
  double begin_m, end_m;
  bool up;  // altitude increases along the ray
  double stretch, scale_m;
  int nodes;

  [[nodiscard]] double length_m() const { return end_m - begin_m; }
  [[nodiscard]] double DistanceAt(double v) const { return NodeAt(v).distance_m; }
  /// Returns a node whose weight is the derivative of the distance with respect to v.
  [[nodiscard]] RayNode NodeAt(double v) const {
    double t = length_m() * v, slope = length_m();
    if (stretch > 0.0) {
      const double growth = std::exp(stretch * v);
      t = shared::StretchedDistance(scale_m, growth);
      slope = shared::StretchedSlope(scale_m, stretch, growth);
    }
    return {up ? begin_m + t : end_m - t, slope};
  }
  [[nodiscard]] double CoordinateAt(double distance_m) const {
    const double t = up ? distance_m - begin_m : end_m - distance_m;
    return stretch > 0.0 ? std::asinh(t / scale_m) / stretch : t / length_m();
  }
};

}  // namespace

ShaftNodes FactorsFromMoments(int nodes, const ShaftNodes& moments) {
  const LegendreAtNodes& legendre = LegendreAt(nodes);
  const auto count = static_cast<std::size_t>(nodes);
  ShaftNodes light{};
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t j = 0; j < count; ++j) light[j] += legendre[n][j] * moments[n];
  }
  return light;
}

SunlitPiece Clipped(const SunlitPiece& piece, double begin_m, double end_m) {
  const double begin = std::clamp(begin_m, piece.begin_m, piece.end_m);
  const double end = std::clamp(end_m, piece.begin_m, piece.end_m);
  const double slope = (piece.end_x - piece.begin_x) / piece.length_m();
  return {begin, end, piece.begin_x + slope * (begin - piece.begin_m),
          piece.begin_x + slope * (end - piece.begin_m)};
}

SegmentAir::SegmentAir(const SingleScattering<float>& air)
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
  // Logarithm of the change of the integrand from end to end.
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
  constexpr float kMostHeights = 6.0F;  // limit for DirectScattering::ColumnsAlong
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
  if (shafts) lit.light = LaneLightInShade(lit.placed, *sunlit);
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

AerialPerspective::AerialPerspective(const SingleScattering<float>& air,
                                     const MultipleScattering& multiple_scattering)
    : air_(air), multiple_scattering_(multiple_scattering), segments_(air) {
  const Medium& medium = air.medium();
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    rayleigh_per_m_ = std::max(rayleigh_per_m_, medium.rayleigh_scattering_per_m[band]);
    mie_per_m_ = std::max(mie_per_m_, medium.mie_extinction_per_m[band]);
  }
}

double AerialPerspective::StretchOf(const ViewRay& ray, double length_m, double at_low_m,
                                    double low_m) const {
  const double radius = air_.medium().planet_radius_m;
  const double cosine = std::abs(
      shared::ZenithCosineAlongRay<double>(ray.altitude_m, ray.mu, at_low_m, low_m, radius));
  constexpr double kKilometres = 1e-3;
  return shared::PanelStretch<double>(kKilometres * low_m, cosine, kKilometres * length_m,
                                      (rayleigh_per_m_ + mie_per_m_) / kKilometres, 1.0,
                                      kKilometres * radius);
}

template <typename OfSegment, typename OfWhole>
auto AerialPerspective::OfRay(const ViewRay& ray, const OfSegment& of_segment,
                              const OfWhole& of_whole) const {
  // Direct integration ends rays at altitude 0.
  if (std::isfinite(ray.length_m) && ray.altitude_m >= 0.0) {
    const DirectRay placed = segments_.Place(ray);
    if (placed.extent.end == RayEnd::kLength && placed.panels > 0) return of_segment(placed);
  }
  return of_whole();
}

ScatteredOnce<float> AerialPerspective::Once(const ViewRay& ray, const SunlitPath* sunlit,
                                             const Nodes& nodes) const {
  return OfRay(
      ray, [&](const DirectRay& placed) { return segments_.Once(ray, placed, sunlit, nodes.sky); },
      [&] { return air_.Scatter(SampleWhole(ray, sunlit, nodes.sky)); });
}

SampledLight AerialPerspective::Sample(const ViewRay& ray, const SunlitPath* sunlit,
                                       const Nodes& nodes) const {
  return OfRay(
      ray,
      [&](const DirectRay& placed) { return segments_.Sample(ray, placed, sunlit, nodes.sky); },
      [&] {
        SampledLight light{SampleWhole(ray, sunlit, nodes.sky), {}};
        light.once = air_.Scatter(light.samples);
        return light;
      });
}

RaySamples<float> AerialPerspective::SampleWhole(const ViewRay& ray, const SunlitPath* sunlit,
                                                 int nodes) const {
  using namespace shared;
  const Medium& medium = air_.medium();
  const double radius = medium.planet_radius_m;
  const RayExtent extent = ExtentOf(ray, radius, medium.atmosphere_height_m);
  const ShadowSpan shadow = PlanetShadow(ray, extent, radius);
  const SubmergedSpan below = SubmergedPart(ray, extent, radius);
  const double perigee_m = -(radius + ray.altitude_m) * ray.mu;
  std::array<double, 6> cut{extent.begin_m,
                            extent.end_m,
                            below.Exists() ? below.begin_m : perigee_m,
                            below.Exists() ? below.end_m : perigee_m,
                            shadow.dark_begin_m,
                            shadow.dark_end_m};
  for (double& at : cut) at = std::clamp(at, extent.begin_m, extent.end_m);
  std::sort(cut.begin(), cut.end());

  std::array<RayNode, 5 * kMostShaftNodes + 1> node;
  std::array<float, 5 * kMostShaftNodes + 1> light;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
    if (cut[i + 1] - cut[i] <= 1e-12 * (extent.end_m - extent.begin_m)) continue;
    Panel panel{cut[i], cut[i + 1], true, 0.0, 0.0, nodes};
    const double first = AltitudeAlongRay<double>(ray.altitude_m, ray.mu, panel.begin_m, radius);
    const double last = AltitudeAlongRay<double>(ray.altitude_m, ray.mu, panel.end_m, radius);
    panel.up = last >= first;
    const double low = std::max(std::min(first, last), 0.0);
    panel.stretch = StretchOf(ray, panel.length_m(), panel.up ? panel.begin_m : panel.end_m, low);
    if (panel.stretch > 0.0)
      panel.scale_m = StretchedScale(panel.length_m(), std::exp(panel.stretch));
    const bool unbroken = sunlit == nullptr || LightUnbroken(panel, *sunlit);
    const GaussRule& rule = GaussLegendre(panel.nodes);
    const auto sunlight = unbroken ? ShaftNodes{} : SunlightAtNodes(panel, panel.nodes, *sunlit);
    for (std::size_t k = 0; k < rule.node.size(); ++k, ++count) {
      const std::size_t j = panel.up ? k : rule.node.size() - 1 - k;  // in order from the eye
      node[count] = panel.NodeAt(rule.node[j]);
      node[count].weight_m *= rule.weight[j];
      light[count] = unbroken ? 1.0F : static_cast<float>(sunlight[j]);
    }
  }
  node[count++] = {extent.end_m, 0.0};
  RaySamples<float> samples =
      air_.SampleAt(ray, extent, shadow, std::span(node.data(), count), ViewColumns::kFromSpace);
  for (std::size_t i = 0; i + 1 < count; ++i) samples.lit[i] *= light[i];
  return samples;
}

// With the light M(d) up to the distance d and the factors f, the sum over stretches of
// (f_k - 1) (M(d_k) - M(d_(k-1))) is the last (f - 1) M and all f_k - f_(k+1) times M(d_k).
template <typename Light>
void AerialPerspective::ChangeDiffuse(const RaySamples<float>& samples, const ViewRay& ray,
                                      const Nodes& nodes, const Light& light, Spectrum& sum) const {
  for (std::size_t i = 0; i < nodes.diffuse.size(); ++i) {
    const DiffuseStretch& stretch = nodes.diffuse[i];
    const bool is_last = i + 1 == nodes.diffuse.size() || stretch.end_m >= ray.length_m;
    ViewRay part = ray;
    part.length_m = stretch.end_m;
    const Spectrum along = is_last ? light(samples) : light(Sample(part, nullptr, nodes).samples);
    for (std::size_t band = 0; band < sum.size(); ++band) {
      const float next = is_last ? 1.0F : nodes.diffuse[i + 1].factor[band];
      sum[band] += (stretch.factor[band] - next) * along[band];
    }
    if (is_last) return;
  }
}

PolarisedLight AerialPerspective::Polarised(const RaySamples<float>& samples, const ViewRay& ray,
                                            const ScatteredOnce<float>& once,
                                            const Nodes& nodes) const {
  PolarisedLight light{Spectrum(air_.bands()), Spectrum(air_.bands())};
  if (!air_.medium().polarised) return light;
  light = PolarisedOnce(air_.medium(), once, ray);
  if (!nodes.higher_orders) return light;
  const auto along = [&](const RaySamples<float>& of) {
    return multiple_scattering_.PolarisationAlong(of, ray.nu);
  };
  PolarisedLight more = along(samples);
  ChangeDiffuse(
      samples, ray, nodes, [&](const auto& of) { return along(of).q; }, more.q);
  ChangeDiffuse(
      samples, ray, nodes, [&](const auto& of) { return along(of).u; }, more.u);
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    light.q[band] += more.q[band];
    light.u[band] += more.u[band];
  }
  return light;
}

AirAlongRay AerialPerspective::Sum(const SampledLight& light, const ViewRay& ray,
                                   const Nodes& nodes) const {
  const AirConstants<float>& air_per_km = air_.constants();
  const auto& [samples, once] = light;
  const double nu_seen = nodes.nu_seen.value_or(ray.nu);
  const auto direct = air_.Inscatter(once, nu_seen);
  auto multiple_scattering =
      nodes.higher_orders
          ? multiple_scattering_.InscatterAlong(samples, ray.nu, nu_seen, SegmentEnd::kOpaque)
          : Spectrum(air_.bands());
  if (nodes.higher_orders) {
    ChangeDiffuse(
        samples, ray, nodes,
        [&](const RaySamples<float>& of) {
          return multiple_scattering_.InscatterByMoments(of, ray.nu);
        },
        multiple_scattering);
  }
  AirAlongRay air{Spectrum(air_.bands()), Spectrum(air_.bands())};
  const std::size_t last = samples.count - 1;
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    air.inscatter[band] = std::max(direct[band], 0.0F) + multiple_scattering[band];
    const float depth = OpticalDepthOf(
        ExtinctionAt(air_per_km, band),
        {samples.view_rayleigh[last], samples.view_mie[last], samples.view_ozone[last]});
    air.transmittance[band] = std::exp(-std::max(depth, 0.0F));
  }
  if (nodes.polarised) air.polarised = Polarised(samples, ray, once, nodes);
  return air;
}

AirAlongRay AerialPerspective::Along(const ViewRay& ray, const Nodes& nodes) const {
  return Sum(Sample(ray, nullptr, nodes), ray, nodes);
}

AirAlongRay AerialPerspective::Along(const ViewRay& ray, const SunlitPath& sunlit,
                                     const Nodes& nodes) const {
  return Sum(Sample(ray, &sunlit, nodes), ray, nodes);
}

}  // namespace alpenglow::renderer
