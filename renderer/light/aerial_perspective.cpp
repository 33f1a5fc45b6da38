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
#include "renderer/light/shaft_weights.h"

namespace alpenglow::renderer {
namespace {

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

}  // namespace

AerialPerspective::AerialPerspective(const AirIntegrator<float>& air, const DiffuseLight& diffuse)
    : air_(air), diffuse_(diffuse), segments_(air) {
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
  if (std::isfinite(ray.length_m)) {
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
  std::array<double, 5> cut{extent.begin_m, extent.end_m, -(radius + ray.altitude_m) * ray.mu,
                            shadow.dark_begin_m, shadow.dark_end_m};
  for (double& at : cut) at = std::clamp(at, extent.begin_m, extent.end_m);
  std::sort(cut.begin(), cut.end());

  std::array<RayNode, 4 * kMostShaftNodes + 1> node;
  std::array<float, 4 * kMostShaftNodes + 1> light;
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

AirAlongRay AerialPerspective::Sum(const SampledLight& light, const ViewRay& ray,
                                   const Nodes& nodes) const {
  const AirConstants<float>& air_per_km = air_.constants();
  const auto& [samples, once] = light;
  const double nu_seen = nodes.nu_seen.value_or(ray.nu);
  const auto direct = air_.Inscatter(once, nu_seen);
  const auto diffuse = nodes.higher_orders
                           ? diffuse_.InscatterAlong(samples, ray.nu, nu_seen, SegmentEnd::kOpaque)
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

}  // namespace alpenglow::renderer
