// SPDX-License-Identifier: MIT
#include "renderer/media/layer_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/media/eddington_slab.h"

namespace alpenglow::renderer {
namespace {

/// Skylight is attenuated in a layer like a beam of this zenith cosine: the diffusivity factor 1.66 of
/// Elsasser (1942).
constexpr double kSkyCosine = 0.6;
constexpr int kGlowNodes = 65;

Spectrum NotNegative(Spectrum light) {
  for (std::size_t band = 0; band < light.size(); ++band) {
    light[band] = std::max(light[band], 0.0F);
  }
  return light;
}

std::vector<double> AltitudesOver(const ExponentialLayer& layer) {
  constexpr double kEndless_m = 8000.0;
  const double step = std::isinf(layer.scale_height_m()) ? kEndless_m : layer.scale_height_m();
  std::vector<double> altitudes;
  for (const double share : {0.0, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    altitudes.push_back(layer.bottom_m() + share * step);
  }
  return altitudes;
}

}  // namespace

LayerLight::LayerLight(const ExponentialLayer& layer, const MultipleScattering& diffuse,
                       const LightDirection& light, const Spectrum& in_air)
    : layer_(layer),
      to_light_(light.seen),
      chi_(LegendreCoefficients(layer.optics().phase, diffuse.options().degree)),
      extinction_per_m_(layer.optics().extinction_per_m[0]),
      depth_(extinction_per_m_ * layer.ColumnAbove(layer.bottom_m())),
      sky_(diffuse, {0.0, 0.0, 1.0}, light.for_air, AltitudesOver(layer)),
      ground_(diffuse.bands()) {
  const double albedo = layer.optics().scattering_per_m[0] / extinction_per_m_;
  peak_scale_ = 1.0 - albedo * PeakFraction({albedo, chi_[1], chi_[2]});
  broad_.kind = PhaseKind::kHenyeyGreenstein;
  broad_.g = std::clamp(chi_[1], -0.99, 0.99);
  const Spectrum sky = diffuse.SkyIrradiance(std::max(layer.bottom_m(), 0.0), sky_.mu_s());
  const std::vector<double>& ground_albedo = diffuse.medium().ground_albedo;
  for (std::size_t band = 0; band < ground_.size(); ++band) {
    ground_[band] = static_cast<float>(ground_albedo[band] / kPi) *
                    (static_cast<float>(std::max(to_light_.z, 0.0)) * in_air[band] + sky[band]);
  }
  sky_ = sky_.WithoutGround(ground_);
  // This is the cosine for which the plane layer is as deep towards the sun as the layer over a
  // round planet.
  const double slant = layer.ColumnToSpace({0.0, 0.0, layer.bottom_m()}, to_light_) /
                       layer.ColumnAbove(layer.bottom_m());
  Solve(albedo, std::clamp(1.0 / slant, 1e-3, 1.0), in_air, sky, ground_albedo);
}

void LayerLight::Solve(double albedo, double mu0, const Spectrum& sun, const Spectrum& sky,
                       const std::vector<double>& ground_albedo) {
  const SlabScattering scattering{albedo, chi_[1], chi_[2]};
  for (Glow* glow : {&of_sun_, &of_sky_}) {
    glow->mean.assign(kGlowNodes, Spectrum(sun.size()));
    glow->slope.assign(kGlowNodes, Spectrum(sun.size()));
  }
  for (std::size_t band = 0; band < sun.size(); ++band) {
    const EddingtonSlab under_sun(scattering, depth_, ground_albedo[band], mu0);
    const EddingtonSlab under_sky(scattering, depth_, ground_albedo[band], kSkyCosine);
    const auto beam = static_cast<double>(sun[band]);
    const double sky_beam = static_cast<double>(sky[band]) / kSkyCosine;
    for (std::size_t i = 0; i < kGlowNodes; ++i) {
      const double u = static_cast<double>(i) / (kGlowNodes - 1);
      const SlabField sunny = under_sun.At(depth_ * u * u * u * u);
      const SlabField dull = under_sky.At(depth_ * u * u * u * u);
      of_sun_.mean[i][band] = static_cast<float>(beam * sunny.mean);
      of_sun_.slope[i][band] = static_cast<float>(beam * sunny.slope);
      of_sky_.mean[i][band] = static_cast<float>(sky_beam * dull.mean);
      of_sky_.slope[i][band] = static_cast<float>(sky_beam * dull.slope);
    }
  }
}

double LayerLight::DepthAbove(double altitude_m) const {
  return std::min(extinction_per_m_ * layer_.ColumnAbove(altitude_m), depth_);
}

AxisPosition LayerLight::PlaceOf(double altitude_m) const {
  const double u =
      depth_ > 0.0 ? (kGlowNodes - 1) * std::sqrt(std::sqrt(DepthAbove(altitude_m) / depth_)) : 0.0;
  const double low = std::min(std::floor(u), kGlowNodes - 2.0);
  return {static_cast<std::size_t>(low), static_cast<float>(u - low)};
}

Spectrum LayerLight::At(const std::vector<Spectrum>& nodes, const AxisPosition& place) {
  return place.Weight(0) * nodes[place.low] + place.Weight(1) * nodes[place.low + 1];
}

LayerLight::Look LayerLight::LookAlong(const glm::dvec3& look) const {
  const double cosine = glm::dot(look, to_light_);
  return {Phase(layer_.optics().phase, cosine), Phase(broad_, cosine), look.z,
          sky_.Towards(look, chi_)};
}

LayerLight::Scattered LayerLight::At(const Look& look, double altitude_m, const Spectrum& sun,
                                     const Spectrum& lit, double slant_depth) const {
  const double direct = std::exp(-slant_depth);
  const double taken_along = std::exp(-peak_scale_ * slant_depth) - direct;
  const auto once = static_cast<float>(look.phase * direct + look.broad_phase * taken_along);
  // Light that reaches the eye travels against the viewing direction: downwards if the view goes
  // upwards.
  const auto tilt = static_cast<float>(chi_[1] * look.down);
  const AxisPosition place = PlaceOf(altitude_m);
  return {once * sun + lit * Field(of_sun_, place, tilt),
          SkyLeft(altitude_m) * NotNegative(sky_.At(look.sky, altitude_m)) +
              Field(of_sky_, place, tilt)};
}

// At the edge of a layer, a radiance that is linear in the cosine is negative in directions from
// which no light arrives.
Spectrum LayerLight::Field(const Glow& glow, const AxisPosition& place, float tilt) {
  return NotNegative(At(glow.mean, place) + tilt * At(glow.slope, place));
}

float LayerLight::SkyLeft(double altitude_m) const {
  return static_cast<float>(std::exp(-peak_scale_ * DepthAbove(altitude_m) / kSkyCosine));
}

Spectrum LayerLight::OnSurface(double altitude_m, double cos_up) const {
  const AxisPosition place = PlaceOf(altitude_m);
  const auto tilt = static_cast<float>(2.0 * kPi / 3.0 * cos_up);
  Spectrum irradiance =
      static_cast<float>(kPi) * (At(of_sun_.mean, place) + At(of_sky_.mean, place)) +
      tilt * (At(of_sun_.slope, place) + At(of_sky_.slope, place));
  // The light of the ground is already part of the clear sky's irradiance of a slope.
  const auto twice = static_cast<float>(kPi * 0.5 * (1.0 - cos_up)) * SkyLeft(altitude_m);
  return NotNegative(irradiance + -twice * ground_);
}

}  // namespace alpenglow::renderer
