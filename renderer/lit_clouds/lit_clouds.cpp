// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/lit_clouds.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

/// Returns the fluxes of a layer over black ground, from those on the ground. Droplets absorb nothing.
CloudLayerFluxes FluxesOf(const CloudLight& light) {
  const CloudGroundIrradiance& on_ground = light.ground_irradiance();
  const double sine = light.sun_map().to_sun().z;
  CloudLayerFluxes fluxes;
  fluxes.sun_direct = on_ground.direct / sine;
  fluxes.sun_down = on_ground.diffuse / sine;
  fluxes.sun_up = std::max(1.0 - fluxes.sun_direct - fluxes.sun_down, 0.0);
  fluxes.sky_down = on_ground.sky / kPi;
  fluxes.sky_up = std::max(1.0 - fluxes.sky_down, 0.0);
  return fluxes;
}

}  // namespace

void CloudsOnRay::Add(const CloudScreen& screen) {
  if (screens.empty() || screen.distance_m > kMostJoined * screens.back().distance_m) {
    screens.push_back(screen);
    return;
  }
  CloudScreen& near = screens.back();
  const double taken = 1.0 - static_cast<double>(near.transmittance);
  const double taken_behind =
      static_cast<double>(near.transmittance) * (1.0 - static_cast<double>(screen.transmittance));
  if (taken + taken_behind > 0.0) {
    near.distance_m =
        (taken * near.distance_m + taken_behind * screen.distance_m) / (taken + taken_behind);
  }
  near.radiance = near.radiance + near.transmittance * screen.radiance;
  near.transmittance *= screen.transmittance;
}

float CloudsOnRay::TransmittanceTo(double distance_m) const {
  float left = 1.0F;
  for (const CloudScreen& screen : screens) {
    if (screen.distance_m < distance_m) left *= screen.transmittance;
  }
  return left;
}

float CloudsOnRay::WeightedDistance_m() const {
  float sum_m = 0.0F, left = 1.0F;
  for (const CloudScreen& screen : screens) {
    sum_m += left * (1.0F - screen.transmittance) * static_cast<float>(screen.distance_m);
    left *= screen.transmittance;
  }
  return sum_m;
}

float CloudsOnRay::DiskLeft() const {
  const float scattered_too = transmittance();
  return scattered_too > 0.0F ? std::min(unscattered / scattered_too, 1.0F) : 0.0F;
}

LitClouds::LitClouds(std::shared_ptr<const SolvedClouds> clouds, const SceneGeometry& geometry,
                     const SolvedAir& air, const DistantLight& light)
    : clouds_(std::move(clouds)), geometry_(geometry), air_(air), light_(light) {
  std::vector<std::shared_ptr<const CloudSunMap>> maps;
  double highest_m = 0.0;
  for (std::size_t i = 0; i < layers(); ++i) {
    // The map lives as long as the solution.
    maps.emplace_back(clouds_, &Layer(i).sun_map());
    highest_m = std::max(highest_m, RangeOf(i).high_m);
  }
  shadow_ = std::make_shared<const CloudShadow>(std::move(maps), highest_m, geometry.radius_m());
  FindExchange();
}

AltitudeRange LitClouds::RangeOf(std::size_t layer) const {
  const CloudField& field = Layer(layer).field();
  return {field.base_altitude_m(), field.top_altitude_m()};
}

void LitClouds::FindExchange() {
  const std::size_t bands = air_.bands();
  std::vector<CloudLayerFluxes> fluxes;
  for (const CloudLight& layer : clouds_->light) fluxes.push_back(FluxesOf(layer));
  const double top_m = shadow_->highest_cloud_m();
  const LocalLight sun = LocalLightAt(geometry_, {0.0, 0.0, top_m}, light_);
  const Spectrum sky = air_.multiple_scattering().Irradiance(top_m, sun.mu_s_for_air, 1.0, 1.0);
  const auto onto_level =
      static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const Spectrum beam = onto_level * air_.BeamLeft(top_m, sun.mu_s_effective);
  sky_above_.assign(layers(), Spectrum(bands));
  ground_below_ = sky_above_;
  sky_left_.assign(layers() + 1, Spectrum(bands));
  sun_added_ = sky_left_;
  for (std::size_t band = 0; band < bands; ++band) {
    const double albedo = air_.medium().ground_albedo[band];
    const double flux = static_cast<double>(beam[band]);
    const auto all =
        FluxesBetween(fluxes, {.down = static_cast<double>(sky[band]), .direct = flux}, albedo);
    const auto of_sky = FluxesBetween(fluxes, {.down = 1.0}, albedo);
    const auto of_sun = FluxesBetween(fluxes, {.direct = flux}, albedo);
    for (std::size_t i = 0; i < layers(); ++i) {
      sky_above_[i][band] = static_cast<float>(all[i + 1].down / kPi);
      ground_below_[i][band] = static_cast<float>(all[i].up / kPi);
      sky_left_[i][band] = static_cast<float>(of_sky[i].down);
      sun_added_[i][band] = static_cast<float>(of_sun[i].down);
    }
    sky_left_.back()[band] = 1.0F;
  }
}

SkyThroughMedia LitClouds::SkyOnSurface(double altitude_m, double cos_up,
                                        SkyThroughMedia above) const {
  const auto is_below = [&](std::size_t layer) {
    const AltitudeRange range = RangeOf(layer);
    return 0.5 * (range.low_m + range.high_m) < altitude_m;
  };
  std::size_t interface = 0;
  while (interface < layers() && is_below(interface)) ++interface;
  const auto seen = static_cast<float>(0.5 * (1.0 + cos_up));
  above.added = sky_left_[interface] * above.added + seen * sun_added_[interface];
  above.left = sky_left_[interface] * above.left;
  return above;
}

double LitClouds::PastOthers(std::size_t layer, const glm::dvec3& flat_point) const {
  double left = 1.0;
  for (std::size_t other = 0; other < layers(); ++other) {
    if (other != layer) left *= Layer(other).SunTransmittance(flat_point);
  }
  return left;
}

CloudScreen LitClouds::Screen(std::size_t layer, const CloudRayLight& grey, const glm::dvec3& point,
                              double distance_m) const {
  const LocalLight sun = LocalLightAt(geometry_, point, light_);
  const double past = PastOthers(layer, InFlatFrame(point, geometry_.radius_m()));
  const Spectrum beam = static_cast<float>(past * sun.visible_fraction) *
                        air_.BeamLeft(sun.altitude_m, sun.mu_s_effective);
  return {distance_m, static_cast<float>(grey.scaled_transmittance),
          static_cast<float>(grey.sun) * beam + static_cast<float>(grey.sky) * sky_above_[layer] +
              static_cast<float>(grey.ground) * ground_below_[layer]};
}

CloudsOnRay LitClouds::Along(const glm::dvec3& origin, const glm::dvec3& direction,
                             double length_m) const {
  constexpr double kNothing = 1e-4;
  struct Part {
    std::size_t layer;
    CloudChord chord;
  };
  std::vector<Part> parts;
  for (std::size_t i = 0; i < layers(); ++i) {
    for (const CloudChord& chord :
         ChordsWithin(RangeOf(i), origin, direction, length_m, geometry_.radius_m()))
      parts.push_back({i, chord});
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.chord.begin_m < b.chord.begin_m; });
  CloudsOnRay clouds;
  double left = 1.0, unscattered = 1.0;
  for (const Part& part : parts) {
    const CloudRayLight grey =
        Layer(part.layer).Radiance({part.chord.origin, part.chord.direction}, part.chord.length_m);
    if (grey.transmittance >= 1.0) continue;
    const double distance_m = part.chord.OnRay(grey.mean_distance_m);
    clouds.Add(Screen(part.layer, grey, origin + distance_m * direction, distance_m));
    left *= grey.scaled_transmittance;
    unscattered *= grey.transmittance;
    if (left < kNothing) break;
  }
  clouds.unscattered = static_cast<float>(unscattered);
  return clouds;
}

}  // namespace alpenglow::renderer
