// SPDX-License-Identifier: MIT
#include "renderer/light/aerial_perspective.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/number/quadrature.h"
#include "atmosphere/ray/optical_depth.h"
#include "atmosphere/ray/ray_map.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/text/error.h"

namespace alpenglow {
namespace {

constexpr int kMostNodes = 16;
constexpr int kTwilightNodes = 6;

/// (2 n + 1) P_n at the nodes of a Gauss rule on [0, 1].
struct LegendreAtNodes {
  int nodes = 0;
  std::array<std::array<double, kMostNodes>, kMostNodes> value{};  // [n][node]
};

// P_0 to P_{count - 1} at v in [0, 1], by the recurrence.
template <typename Visit>
void VisitLegendre(int count, double v, const Visit& visit) {
  const double x = 2.0 * v - 1.0;
  double last = 0.0;
  double p = 1.0;
  for (int n = 0; n < count; ++n) {
    visit(n, p);
    const double next = ((2.0 * n + 1.0) * x * p - n * last) / (n + 1.0);
    last = p;
    p = next;
  }
}

const LegendreAtNodes& LegendreAt(int nodes) {
  static const auto kTables = [] {
    std::array<LegendreAtNodes, kMostNodes + 1> tables;
    for (int count = 1; count <= kMostNodes; ++count) {
      LegendreAtNodes& table = tables[static_cast<std::size_t>(count)];
      table.nodes = count;
      const GaussRule& rule = GaussLegendre(count);
      for (std::size_t j = 0; j < rule.node.size(); ++j) {
        VisitLegendre(count, rule.node[j], [&](int n, double p) {
          table.value[static_cast<std::size_t>(n)][j] = (2.0 * n + 1.0) * p;
        });
      }
    }
    return tables;
  }();
  return kTables[static_cast<std::size_t>(nodes)];
}

/// A stretch of the ray where the integrand is smooth and altitude monotone. Distances from the eye
/// [m]; v runs from 0 at the lower end to 1, by ray_map.glsl.
struct Panel {
  double begin_m, end_m;
  bool up;  // altitude rises along the ray
  double stretch, scale_m;
  int nodes;

  [[nodiscard]] double length_m() const { return end_m - begin_m; }
  [[nodiscard]] double DistanceAt(double v) const { return NodeAt(v).distance_m; }
  /// With the derivative of the distance by v as its weight.
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

using NodeMoments = std::array<double, kMostNodes>;

// Adds the moments of a piece of sunlight, which lies within the panel. Eight nodes are exact for
// full light, and half shade is smooth.
void AddMoments(const Panel& panel, const SunlitPiece& piece, NodeMoments& moments) {
  static const GaussRule& rule = GaussLegendre(8);
  const double from = panel.CoordinateAt(piece.begin_m);
  const double to = panel.CoordinateAt(piece.end_m);
  const bool full = piece.begin_x >= 1.0 && piece.end_x >= 1.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double v = from + (to - from) * rule.node[i];
    double light = std::abs(to - from) * rule.weight[i];
    if (!full) {
      const double share = (panel.DistanceAt(v) - piece.begin_m) / piece.length_m();
      light *= SunlightOverEdge(piece.begin_x + share * (piece.end_x - piece.begin_x));
    }
    VisitLegendre(panel.nodes, v,
                  [&](int n, double p) { moments[static_cast<std::size_t>(n)] += light * p; });
  }
}

// The part of a piece between two distances; nothing left of it has no length.
SunlitPiece Clipped(const SunlitPiece& piece, double begin_m, double end_m) {
  const double begin = std::clamp(begin_m, piece.begin_m, piece.end_m);
  const double end = std::clamp(end_m, piece.begin_m, piece.end_m);
  const double slope = (piece.end_x - piece.begin_x) / piece.length_m();
  return {begin, end, piece.begin_x + slope * (begin - piece.begin_m),
          piece.begin_x + slope * (end - piece.begin_m)};
}

// Sunlight at the nodes of a panel, as factors of their weights.
std::array<double, kMostNodes> SunlightAtNodes(const Panel& panel, const SunlitPath& sunlit) {
  NodeMoments moments{};
  for (const SunlitPiece& piece : sunlit) {
    const SunlitPiece within = Clipped(piece, panel.begin_m, panel.end_m);
    if (within.length_m() > 0.0) AddMoments(panel, within, moments);
  }
  const LegendreAtNodes& legendre = LegendreAt(panel.nodes);
  std::array<double, kMostNodes> light{};
  for (std::size_t n = 0; n < static_cast<std::size_t>(panel.nodes); ++n) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(panel.nodes); ++j)
      light[j] += legendre.value[n][j] * moments[n];
  }
  return light;
}

bool LightUnbroken(const Panel& panel, const SunlitPath& sunlit) {
  return std::any_of(sunlit.begin(), sunlit.end(), [&](const SunlitPiece& piece) {
    return piece.begin_x >= 1.0 && piece.end_x >= 1.0 && piece.begin_m <= panel.begin_m &&
           piece.end_m >= panel.end_m;
  });
}

}  // namespace

AerialPerspective::AerialPerspective(const AirIntegrator<float>& air, const DiffuseLight& diffuse)
    : air_(air), diffuse_(diffuse) {
  const Medium& medium = air.medium();
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    rayleigh_per_m_ = std::max(rayleigh_per_m_, medium.rayleigh_scattering_per_m[band]);
    mie_per_m_ = std::max(mie_per_m_, medium.mie_extinction_per_m[band]);
  }
}

int AerialPerspective::NodesFor(double length_m, double low_m, double high_m, bool shafts) const {
  const Medium& medium = air_.medium();
  const double haze = mie_per_m_ * std::exp(-low_m / medium.mie_scale_height_m);
  const double clear = rayleigh_per_m_ * MoleculeDensity(medium, low_m);
  const double share = haze / std::max(haze + clear, 1e-30);
  const double rise = high_m - low_m;
  // Logarithm of how much the integrand changes from end to end.
  const double change = (haze + clear) * length_m + rise / medium.rayleigh_scale_height_m +
                        std::min(share, 1.0) * rise / medium.mie_scale_height_m;
  constexpr double kMost = 12.0;
  const double nodes = 2.0 + std::floor(std::min(change, 2.0 * kMost) / 1.2) + (shafts ? 3.0 : 0.0);
  return static_cast<int>(std::min(nodes, kMost));
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

RaySamples<float> AerialPerspective::Sample(const ViewRay& ray, const SunlitPath* sunlit,
                                            const Nodes& nodes) const {
  using namespace shared;
  const Medium& medium = air_.medium();
  const double radius = medium.planet_radius_m;
  const RayExtent extent = ExtentOf(ray, radius, medium.atmosphere_height_m);
  const ShadowSpan shadow = PlanetShadow(ray, extent, radius);
  std::array<double, 5> cut{extent.begin_m, extent.end_m, -(radius + ray.altitude_m) * ray.mu,
                            shadow.dark_begin_m, shadow.dark_end_m};
  for (double& at : cut) at = std::clamp(at, extent.begin_m, extent.end_m);
  std::sort(cut.begin(), cut.end());

  std::array<RayNode, 4 * kMostNodes + 1> node;
  std::array<float, 4 * kMostNodes + 1> light;
  std::size_t count = 0;
  double lowest = ray.altitude_m;
  double highest = ray.altitude_m;
  for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
    if (cut[i + 1] - cut[i] <= 1e-12 * (extent.end_m - extent.begin_m)) continue;
    Panel panel{cut[i], cut[i + 1], true, 0.0, 0.0, nodes.sky};
    const double first = AltitudeAlongRay<double>(ray.altitude_m, ray.mu, panel.begin_m, radius);
    const double last = AltitudeAlongRay<double>(ray.altitude_m, ray.mu, panel.end_m, radius);
    lowest = std::min({lowest, first, last});
    highest = std::max({highest, first, last});
    panel.up = last >= first;
    const double low = std::max(std::min(first, last), 0.0);
    panel.stretch = StretchOf(ray, panel.length_m(), panel.up ? panel.begin_m : panel.end_m, low);
    if (panel.stretch > 0.0)
      panel.scale_m = StretchedScale(panel.length_m(), std::exp(panel.stretch));
    const bool unbroken = sunlit == nullptr || LightUnbroken(panel, *sunlit);
    if (extent.end == RayEnd::kLength) {
      // Beams that graze the planet light the end at its shadow by far less than the other.
      const int least = ray.mu_s < 0.0 ? kTwilightNodes : 0;
      const int asked = NodesFor(panel.length_m(), low, std::max({first, last, low}), !unbroken);
      panel.nodes = std::min(std::max(asked, least), nodes.sky);
    }
    const GaussRule& rule = GaussLegendre(panel.nodes);
    const auto sunlight =
        unbroken ? std::array<double, kMostNodes>{} : SunlightAtNodes(panel, *sunlit);
    for (std::size_t k = 0; k < rule.node.size(); ++k, ++count) {
      const std::size_t j = panel.up ? k : rule.node.size() - 1 - k;  // in order from the eye
      node[count] = panel.NodeAt(rule.node[j]);
      node[count].weight_m *= rule.weight[j];
      light[count] = unbroken ? 1.0F : static_cast<float>(sunlight[j]);
    }
  }
  node[count++] = {extent.end_m, 0.0};
  constexpr double kMostHeights = 6.0;  // for ViewColumns::kBetweenSamples
  const bool short_way = extent.end == RayEnd::kLength && extent.begin_m == 0.0 &&
                         highest - lowest < kMostHeights * medium.mie_scale_height_m;
  RaySamples<float> samples =
      air_.SampleAt(ray, extent, shadow, std::span(node.data(), count),
                    short_way ? ViewColumns::kBetweenSamples : ViewColumns::kFromSpace);
  for (std::size_t i = 0; i + 1 < count; ++i) samples.lit[i] *= light[i];
  return samples;
}

PolarisedLight AerialPerspective::Polarised(const RaySamples<float>& samples, const ViewRay& ray,
                                            const ScatteredOnce<float>& once,
                                            bool higher_orders) const {
  PolarisedLight light{Bands<float>(air_.bands()), Bands<float>(air_.bands())};
  if (!air_.medium().polarised) return light;
  light = PolarisedOnce(air_.medium(), once, ray);
  if (!higher_orders) return light;
  const PolarisedLight more = diffuse_.PolarisationAlong(samples, ray.nu);
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    light.q[band] += more.q[band];
    light.u[band] += more.u[band];
  }
  return light;
}

AirAlongRay AerialPerspective::Sum(const RaySamples<float>& samples, const ViewRay& ray,
                                   const Nodes& nodes) const {
  const AirConstants<float>& air_per_km = air_.constants();
  const ScatteredOnce<float> once = air_.Scatter(samples);
  const auto direct = air_.Inscatter(once, ray.nu);
  const auto diffuse = nodes.higher_orders
                           ? diffuse_.InscatterAlong(samples, ray.nu, SegmentEnd::kOpaque)
                           : Bands<float>(air_.bands());
  AirAlongRay air{Bands<float>(air_.bands()), Bands<float>(air_.bands())};
  const std::size_t last = samples.count - 1;
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    air.inscatter[band] = std::max(direct[band], 0.0F) + diffuse[band];
    const float depth = OpticalDepthOf(
        ExtinctionAt(air_per_km, band),
        {samples.view_rayleigh[last], samples.view_mie[last], samples.view_ozone[last]});
    air.transmittance[band] = std::exp(-std::max(depth, 0.0F));
  }
  if (nodes.polarised) air.polarised = Polarised(samples, ray, once, nodes.higher_orders);
  return air;
}

AirAlongRay AerialPerspective::Along(const ViewRay& ray, const Nodes& nodes) const {
  return Sum(Sample(ray, nullptr, nodes), ray, nodes);
}

AirAlongRay AerialPerspective::Along(const ViewRay& ray, const SunlitPath& sunlit,
                                     const Nodes& nodes) const {
  return Sum(Sample(ray, &sunlit, nodes), ray, nodes);
}

}  // namespace alpenglow
