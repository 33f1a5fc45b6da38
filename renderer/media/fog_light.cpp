// SPDX-License-Identifier: MIT
#include "renderer/media/fog_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

double SlabField::DownwardFlux() const { return kPi * (mean + 2.0 / 3.0 * slope); }
double SlabField::UpwardFlux() const { return kPi * (mean - 2.0 / 3.0 * slope); }

EddingtonSlab::EddingtonSlab(const SlabScattering& scattering, double depth, double ground_albedo,
                             double mu0) {
  ALPENGLOW_ENSURE(depth, >=, 0.0);
  ALPENGLOW_ENSURE(mu0, >, 0.0);
  ALPENGLOW_ENSURE(scattering.chi_2, <, 1.0);
  // Without any absorption e^(k tau) and e^(-k tau) are the same solution. An absorption of a
  // millionth separates them, and removes a millionth of the light per unit of depth.
  constexpr double kMostAlbedo = 1.0 - 1e-6;
  const double w_true = std::min(scattering.albedo, kMostAlbedo);
  const double f = std::max(scattering.chi_2, 0.0);
  scale_ = 1.0 - w_true * f;
  const double w = w_true * (1.0 - f) / scale_;
  const double g = (scattering.chi_1 - f) / (1.0 - f);
  depth_ = scale_ * depth;
  k_ = std::sqrt(3.0 * (1.0 - w) * (1.0 - w * g));
  slope_of_k_ = k_ / (1.0 - w * g);
  // If the beam decays like the diffuse light, the particular solution has a pole that the boundary
  // conditions cancel.
  mu0_ = std::abs(k_ * mu0 - 1.0) < 1e-4 ? (1.0 - 1e-4) / k_ : mu0;
  const double source = w / (4.0 * kPi);
  particular_ = 3.0 * mu0_ * mu0_ * source * (1.0 + g - w * g) / (k_ * k_ * mu0_ * mu0_ - 1.0);
  particular_slope_ = 3.0 * mu0_ * ((1.0 - w) * particular_ - source);
  // Boundary conditions: no diffuse light from above, the ground's reflection from below.
  const double across = std::exp(-k_ * depth_);
  const double beam = std::exp(-depth_ / mu0_);
  const double top_falling = 1.0 + 2.0 / 3.0 * slope_of_k_;
  const double top_rising = (1.0 - 2.0 / 3.0 * slope_of_k_) * across;
  const double top = -(particular_ + 2.0 / 3.0 * particular_slope_);
  const double up = 1.0 - ground_albedo, down = 2.0 / 3.0 * (1.0 + ground_albedo);
  const double bottom_falling = (up - down * slope_of_k_) * across;
  const double bottom_rising = up + down * slope_of_k_;
  const double bottom =
      ground_albedo * mu0_ * beam / kPi - (up * particular_ - down * particular_slope_) * beam;
  const double determinant = top_falling * bottom_rising - top_rising * bottom_falling;
  falling_ = (top * bottom_rising - top_rising * bottom) / determinant;
  rising_ = (top_falling * bottom - bottom_falling * top) / determinant;
}

SlabField EddingtonSlab::At(double depth) const {
  const double tau = std::clamp(scale_ * depth, 0.0, depth_);
  const double falling = falling_ * std::exp(-k_ * tau);
  const double rising = rising_ * std::exp(-k_ * (depth_ - tau));
  const double beam = std::exp(-tau / mu0_);
  return {falling + rising + particular_ * beam,
          slope_of_k_ * (falling - rising) + particular_slope_ * beam};
}

double EddingtonSlab::BeamLeft(double slant_depth) const { return std::exp(-scale_ * slant_depth); }

namespace {

/// Skylight is attenuated in fog like a beam of this zenith cosine: the diffusivity factor 1.66 of
/// Elsasser (1942).
constexpr double kSkyCosine = 0.6;
constexpr int kGlowNodes = 65;

std::vector<double> AltitudesOver(double bottom_m, const FogLayer& layer) {
  constexpr double kEndless_m = 8000.0;
  const double step = std::isinf(layer.scale_height_m()) ? kEndless_m : layer.scale_height_m();
  std::vector<double> altitudes;
  for (const double share : {0.0, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    altitudes.push_back(bottom_m + share * step);
  }
  return altitudes;
}

}  // namespace

FogLight::FogLight(const LocalMedium& fog, const MultipleScattering& diffuse, const FogSun& sun,
                   double bottom_m)
    : fog_(fog),
      to_sun_(sun.to_light),
      chi_(LegendreCoefficients(fog.optics.phase, diffuse.options().degree)),
      extinction_per_m_(fog.optics.extinction_per_m[0]),
      depth_(extinction_per_m_ * fog.fog()->ColumnAbove(bottom_m)),
      sky_(diffuse, {0.0, 0.0, 1.0}, sun.to_light_for_air, AltitudesOver(bottom_m, *fog.fog())),
      ground_(diffuse.bands()) {
  const double albedo = fog.optics.scattering_per_m[0] / extinction_per_m_;
  peak_scale_ = 1.0 - albedo * std::max(chi_[2], 0.0);
  broad_.kind = PhaseKind::kHenyeyGreenstein;
  broad_.g = std::clamp(chi_[1], -0.99, 0.99);
  const BandLight sky = diffuse.SkyIrradiance(std::max(bottom_m, 0.0), sky_.mu_s());
  const std::vector<double>& ground_albedo = diffuse.medium().ground_albedo;
  for (std::size_t band = 0; band < ground_.count; ++band) {
    ground_[band] = static_cast<float>(ground_albedo[band] / kPi) *
                    (static_cast<float>(std::max(to_sun_.z, 0.0)) * sun.in_air[band] + sky[band]);
  }
  sky_ = sky_.WithoutGround(ground_);
  // This is the cosine for which the plane layer is as deep towards the sun as the layer over a
  // round planet.
  const FogLayer& layer = *fog.fog();
  const double slant =
      layer.ColumnToSpace({0.0, 0.0, bottom_m}, to_sun_) / layer.ColumnAbove(bottom_m);
  Solve(albedo, std::clamp(1.0 / slant, 1e-3, 1.0), sun.in_air, sky, ground_albedo);
}

void FogLight::Solve(double albedo, double mu0, const BandLight& sun, const BandLight& sky,
                     const std::vector<double>& ground_albedo) {
  const SlabScattering scattering{albedo, chi_[1], chi_[2]};
  for (Glow* glow : {&of_sun_, &of_sky_}) {
    glow->mean.assign(kGlowNodes, BandLight(sun.count));
    glow->slope.assign(kGlowNodes, BandLight(sun.count));
  }
  for (std::size_t band = 0; band < sun.count; ++band) {
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

double FogLight::DepthAbove(double altitude_m) const {
  return std::min(extinction_per_m_ * fog_.fog()->ColumnAbove(altitude_m), depth_);
}

FogLight::Place FogLight::PlaceOf(double altitude_m) const {
  const double u =
      depth_ > 0.0 ? (kGlowNodes - 1) * std::sqrt(std::sqrt(DepthAbove(altitude_m) / depth_)) : 0.0;
  const double low = std::min(std::floor(u), kGlowNodes - 2.0);
  return {static_cast<std::size_t>(low), static_cast<float>(u - low)};
}

BandLight FogLight::At(const std::vector<BandLight>& nodes, const Place& place) {
  return (1.0F - place.share) * nodes[place.low] + place.share * nodes[place.low + 1];
}

FogLight::Look FogLight::LookAlong(const glm::dvec3& look) const {
  const double cosine = glm::dot(look, to_sun_);
  return {Phase(fog_.optics.phase, cosine), Phase(broad_, cosine), look.z,
          sky_.Towards(look, chi_)};
}

FogLight::Scattered FogLight::At(const Look& look, double altitude_m, const BandLight& sun,
                                 const BandLight& lit, double slant_depth) const {
  const double direct = std::exp(-slant_depth);
  const double taken_along = std::exp(-peak_scale_ * slant_depth) - direct;
  const auto once = static_cast<float>(look.phase * direct + look.broad_phase * taken_along);
  // Light that reaches the eye travels against the viewing direction: downwards if the view goes
  // upwards.
  const auto tilt = static_cast<float>(chi_[1] * look.down);
  const Place place = PlaceOf(altitude_m);
  return {once * sun + lit * (At(of_sun_.mean, place) + tilt * At(of_sun_.slope, place)),
          SkyLeft(altitude_m) * sky_.At(look.sky, altitude_m) + At(of_sky_.mean, place) +
              tilt * At(of_sky_.slope, place)};
}

float FogLight::SkyLeft(double altitude_m) const {
  return static_cast<float>(std::exp(-peak_scale_ * DepthAbove(altitude_m) / kSkyCosine));
}

float FogLight::BeamLeft(double slant_depth) const {
  return static_cast<float>(std::exp(-peak_scale_ * slant_depth));
}

BandLight FogLight::OnSurface(double altitude_m, double cos_up) const {
  const Place place = PlaceOf(altitude_m);
  const auto tilt = static_cast<float>(2.0 * kPi / 3.0 * cos_up);
  BandLight irradiance =
      static_cast<float>(kPi) * (At(of_sun_.mean, place) + At(of_sky_.mean, place)) +
      tilt * (At(of_sun_.slope, place) + At(of_sky_.slope, place));
  // The light of the ground is already part of the clear sky's irradiance of a slope.
  const auto twice = static_cast<float>(kPi * 0.5 * (1.0 - cos_up)) * SkyLeft(altitude_m);
  for (std::size_t band = 0; band < irradiance.count; ++band) {
    irradiance[band] = std::max(irradiance[band] - twice * ground_[band], 0.0F);
  }
  return irradiance;
}

}  // namespace alpenglow::renderer
