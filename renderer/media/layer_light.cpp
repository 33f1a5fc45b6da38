// SPDX-License-Identifier: MIT
#include "renderer/media/layer_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

/// Skylight is attenuated in a layer like a beam of this zenith cosine: the diffusivity factor 1.66 of
/// Elsasser (1942).
constexpr double kSkyCosine = 0.6;
/// Above a layer, light from its top and light from the sky meet at the horizontal. The forward peak
/// turns light by a few degrees, and rounds off this edge; closer to it than this sine, light is
/// interpolated.
constexpr double kHorizonSine = 0.03;
/// Deeper layers count as this deep, because densities far below a base overflow.
constexpr double kDeepest = 1e8;

Spectrum NotNegative(Spectrum light) {
  for (std::size_t band = 0; band < light.size(); ++band) {
    light[band] = std::max(light[band], 0.0F);
  }
  return light;
}

/// Returns the azimuth of a direction from the vertical plane of the light.
double AzimuthFrom(const glm::dvec3& to_light, const glm::dvec3& direction) {
  return std::atan2(direction.y, direction.x) - std::atan2(to_light.y, to_light.x);
}

/// Returns how light travels that reaches an eye against its viewing direction. Light of the sun
/// travels with azimuth 0.
LightWay WayInto(const glm::dvec3& look, const glm::dvec3& to_light) {
  return {-look.z, AzimuthFrom(to_light, look)};
}

}  // namespace

LayerLight::LayerLight(const ExponentialLayer& layer, const MultipleScattering& diffuse,
                       const LightDirection& light, const Spectrum& in_air, LightPastClouds past)
    : layer_(layer),
      to_light_(light.seen),
      extinction_per_m_(layer.optics().extinction_per_m[0]),
      depth_(std::min(extinction_per_m_ * layer.ColumnAbove(layer.bottom_m()), kDeepest)),
      albedo_(layer.optics().scattering_per_m[0] / extinction_per_m_),
      nodes_(depth_),
      sky_(diffuse, {0.0, 0.0, 1.0}, light.for_air, {std::max(layer.bottom_m(), 0.0)}),
      all_of_it_(static_cast<std::size_t>(diffuse.options().degree) + 1, 1.0),
      ground_(diffuse.bands()),
      past_(std::move(past)) {
  const Spectrum clear = diffuse.SkyIrradiance(std::max(layer.bottom_m(), 0.0), sky_.mu_s());
  skylight_ = past_.sky.left * clear + past_.sky.added;
  const std::vector<double>& ground_albedo = diffuse.medium().ground_albedo;
  for (std::size_t band = 0; band < ground_.size(); ++band) {
    ground_[band] = static_cast<float>(ground_albedo[band] / kPi) *
                    (static_cast<float>(std::max(to_light_.z, 0.0)) * in_air[band] + clear[band]);
  }
  sky_ = sky_.WithoutGround(ground_);
  // This is the cosine for which the plane layer is as deep towards the sun as the layer over a
  // round planet.
  const double slant = layer.ColumnToSpace({0.0, 0.0, layer.bottom_m()}, to_light_) /
                       layer.ColumnAbove(layer.bottom_m());
  for (std::size_t band = 0; band < ground_.size(); ++band) {
    bands_.push_back(Solved(band, std::clamp(1.0 / slant, 1e-3, 1.0),
                            static_cast<double>(in_air[band]), static_cast<double>(skylight_[band]),
                            ground_albedo[band]));
  }
}

Spectrum LayerLight::SkyFrom(const LightWay& way) const {
  const double sine = std::sqrt(std::max(1.0 - way.mu * way.mu, 0.0));
  const double azimuth = std::atan2(to_light_.y, to_light_.x) + way.azimuth;
  const Spectrum clear =
      sky_.Towards({sine * std::cos(azimuth), sine * std::sin(azimuth), -way.mu}, all_of_it_)
          .front();
  return NotNegative(past_.sky.left * clear + static_cast<float>(1.0 / kPi) * past_.sky.added);
}

LayerLight::Band LayerLight::Solved(std::size_t band, double mu_s, double sun, double sky,
                                    double ground_albedo) const {
  LayerStack stack({GreyLayer(layer_.optics().phase, depth_, albedo_)}, ground_albedo,
                   kLayerStreams);
  const LayerGlow of_sun(stack, LayerField::UnderSun(stack, mu_s), mu_s);
  const LayerGlow of_sky(
      stack,
      LayerField::UnderSky(
          stack, [&](const LightWay& way) { return static_cast<double>(SkyFrom(way)[band]); }),
      0.0);
  // Moments of low degree miss some of the irradiance.
  const double found = of_sky.fluxes().front().down;
  return {std::move(stack), of_sun, of_sky, sun, found > 0.0 ? sky / found : 0.0};
}

double LayerLight::DepthAbove(double altitude_m) const {
  return std::min(extinction_per_m_ * layer_.ColumnAbove(altitude_m), depth_);
}

AxisPosition LayerLight::PlaceOf(double altitude_m) const {
  const double u = nodes_.NodeAt(DepthAbove(altitude_m));
  const double low = std::min(std::floor(u), kGlowNodes - 2.0);
  return {static_cast<std::size_t>(low), static_cast<float>(u - low)};
}

Spectrum LayerLight::At(const std::vector<Spectrum>& nodes, const AxisPosition& place) {
  return place.Weight(0) * nodes[place.low] + place.Weight(1) * nodes[place.low + 1];
}

LayerLight::Look LayerLight::LookAlong(const glm::dvec3& look) const {
  const LightWay way = WayInto(look, to_light_);
  const double cosine = glm::dot(look, to_light_);
  const std::vector<Spectrum> dark(kGlowNodes, Spectrum(bands_.size()));
  Look seen{beam().AtAngle(cosine), dark, dark};
  if (std::abs(way.mu) >= kHorizonSine) {
    AddGlow(way, 1.0, seen);
    return seen;
  }
  const double up = 0.5 + 0.5 * way.mu / kHorizonSine;
  AddGlow({kHorizonSine, way.azimuth}, up, seen);
  AddGlow({-kHorizonSine, way.azimuth}, 1.0 - up, seen);
  return seen;
}

void LayerLight::AddGlow(const LightWay& way, double share, Look& seen) const {
  const GlowDirection direction(bands_.front().stack, way);
  const Spectrum sky = SkyFrom(way);
  for (std::size_t band = 0; band < bands_.size(); ++band) {
    const Band& lit = bands_[band];
    const std::vector<double> of_sun = lit.of_sun.Towards(direction, 0.0);
    const std::vector<double> of_sky =
        lit.of_sky.Towards(direction, static_cast<double>(sky[band]));
    // Series of low degree are negative where little light arrives.
    for (std::size_t node = 0; node < kGlowNodes; ++node) {
      seen.of_sun[node][band] += static_cast<float>(share * std::max(lit.sun * of_sun[node], 0.0));
      seen.of_sky[node][band] += static_cast<float>(share * std::max(lit.sky * of_sky[node], 0.0));
    }
  }
}

LayerLight::Glow LayerLight::GlowAt(const Look& look, double altitude_m) const {
  const AxisPosition place = PlaceOf(altitude_m);
  return {At(look.of_sun, place), At(look.of_sky, place)};
}

float LayerLight::SkyLeft(double altitude_m) const {
  return static_cast<float>(std::exp(-beam().peak_scale() * DepthAbove(altitude_m) / kSkyCosine));
}

Spectrum LayerLight::OnSurface(double altitude_m, double cos_up) const {
  const AxisPosition place = PlaceOf(altitude_m);
  const double from_above = 0.5 * (1.0 + cos_up), from_below = 1.0 - from_above;
  const auto all = [&](const LayerGlow& glow) {
    double sum = 0.0;
    for (const int end : {0, 1}) {
      const LayerFluxes& fluxes = glow.fluxes()[place.low + static_cast<std::size_t>(end)];
      sum += static_cast<double>(place.Weight(end)) *
             (from_above * fluxes.down + from_below * fluxes.up);
    }
    return sum;
  };
  // Part of the skylight, and of the light of the ground below it, is counted as not scattered.
  const auto left = static_cast<double>(SkyLeft(altitude_m));
  Spectrum irradiance(bands_.size());
  for (std::size_t band = 0; band < bands_.size(); ++band) {
    const Band& lit = bands_[band];
    const double unscattered =
        from_above * static_cast<double>(skylight_[band]) +
        from_below * kPi * static_cast<double>(past_.sky.left[band] * ground_[band]);
    const double sun = static_cast<double>(past_.sun) * lit.sun;
    irradiance[band] =
        static_cast<float>(sun * all(lit.of_sun) + lit.sky * all(lit.of_sky) - left * unscattered);
  }
  return NotNegative(irradiance);
}

}  // namespace alpenglow::renderer
