// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/lit_clouds.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/math/constants.h"
#include "renderer/cloud_light/cloud_plane_rays.h"
#include "renderer/cloud_light/plane_parallel_light.h"
#include "renderer/illumination/sky_moments.h"
#include "renderer/lit_clouds/air_layers.h"

namespace alpenglow::renderer {
namespace {

/// Returns the fluxes of a layer over black ground for a unit beam. Droplets absorb nothing.
CloudLayerFluxes FluxesOf(const CloudLight& light) {
  const CloudGroundIrradiance& on_ground = light.ground_irradiance();
  CloudLayerFluxes fluxes;
  fluxes.sun_down = on_ground.diffuse;
  fluxes.sun_up = light.sun().map()
                      ? std::max(light.sun().to_sun().z - on_ground.direct - on_ground.diffuse, 0.0)
                      : light.sun_moments().up_at_top;
  fluxes.sky_down = on_ground.sky / kPi;
  fluxes.sky_up = std::max(1.0 - fluxes.sky_down, 0.0);
  return fluxes;
}

/// Returns the radiance of higher orders of a clear sky, integrated over all directions.
std::vector<double> DiffuseIntensity(const SolvedAir& air, double altitude_m, double mu_s) {
  const MultipleScattering& orders = air.multiple_scattering();
  const double altitude = std::sqrt(altitude_m / air.medium().atmosphere_height_m);
  const std::vector<float> moments =
      orders.ValuesAt(altitude, MultipleScattering::SunCoordinate(mu_s));
  std::vector<double> intensity(air.bands());
  for (std::size_t band = 0; band < intensity.size(); ++band)
    intensity[band] = std::sqrt(4.0 * kPi) * static_cast<double>(moments[band]);
  return intensity;
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
  near.ground += near.transmittance * screen.ground;
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

Spectrum LampsOnClouds(const CloudsOnRay& clouds, const LampLight& lamps,
                       const SceneGeometry& geometry, const glm::dvec3& origin,
                       const glm::dvec3& direction, const std::function<Spectrum(double)>& left) {
  Spectrum sum(left(0.0).size());
  float past = 1.0F;
  for (const CloudScreen& screen : clouds.screens) {
    const glm::dvec3 point = origin + screen.distance_m * direction;
    const glm::dvec3 down = -geometry.UpAt(point);
    const Spectrum light = lamps.OnSurface(lamps.FarFrom(point), {point, point, down, down});
    sum = sum + past * screen.ground / static_cast<float>(kPi) * (left(screen.distance_m) * light);
    past *= screen.transmittance;
  }
  return sum;
}

Spectrum NightAlong(const CloudsOnRay& clouds, const NightScattered& night, const Spectrum& whole,
                    const std::function<Spectrum(double)>& left) {
  Spectrum sum = night.all + -1.0F * (whole * night.all);
  float past = 1.0F;
  for (const CloudScreen& screen : clouds.screens) {
    // Ground of the radiance 2 J takes the place of J in what the screen hides.
    const float in_excess = 2.0F * screen.ground - (1.0F - screen.transmittance);
    sum = sum + past * in_excess * (left(screen.distance_m) * night.towns);
    past *= screen.transmittance;
  }
  return sum;
}

LitClouds::LitClouds(std::shared_ptr<const SolvedClouds> clouds, const SceneGeometry& geometry,
                     const SolvedAir& air, const DistantLight& light, CloudsInPicture view)
    : clouds_(std::move(clouds)),
      past_terrain_(std::move(view.past_terrain)),
      geometry_(geometry),
      air_(air),
      light_(light) {
  std::optional<int> paths;
  if (view.pixels && view.method == CloudLightMethod::kHybrid) {
    shared_.emplace(std::move(*view.pixels));
    paths = kSharedPaths;
  }
  std::vector<CloudShadow::Layer> suns;
  double highest_m = 0.0;
  for (std::size_t i = 0; i < layers(); ++i) {
    // The depths live as long as the solution.
    const PlaneParallelCloud* plane = Layer(i).plane_parallel();
    peak_scale_.push_back(plane != nullptr ? plane->stack().scaled(0).scale
                                           : Layer(i).optics().extinction_scale());
    suns.push_back({{clouds_, &Layer(i).sun()}, peak_scale_.back()});
    along_rays_.push_back(Layer(i).WithMethod(view.method, paths));
    if (view.has_colours) {
      colours_.emplace_back(Layer(i),
                            PhasesByBand((*clouds_->layers)[i], air.medium().wavelengths_nm));
    }
    highest_m = std::max(highest_m, RangeOf(i).high_m);
  }
  shadow_ = std::make_shared<const CloudShadow>(std::move(suns), highest_m, geometry.radius_m());
  FindExchange();
  FindLayered();
  if (view.mirror) {
    mirror_.emplace(*view.mirror, [this](const glm::dvec3& point, const glm::dvec3& direction) {
      return ChangeAlong(point, direction);
    });
  }
}

AltitudeRange LitClouds::RangeOf(std::size_t layer) const {
  const CloudField& field = Layer(layer).field();
  return {field.base_altitude_m(), field.top_altitude_m()};
}

double LitClouds::MeanBeamLeft(double altitude_m, std::size_t of_layer) const {
  double left = 1.0;
  for (std::size_t other = 0; other < layers(); ++other) {
    if (other != of_layer) left *= Layer(other).sun().MeanTransmittance(altitude_m);
  }
  return left;
}

double LitClouds::MeanScaledLeft(double altitude_m) const {
  double left = 1.0;
  for (std::size_t i = 0; i < layers(); ++i) {
    left *= Layer(i).sun().MeanPowerOfTransmittance(altitude_m, peak_scale_[i]);
  }
  return left;
}

double LitClouds::AltitudeOf(std::size_t interface) const {
  return interface < layers() ? RangeOf(interface).low_m : shadow_->highest_cloud_m();
}

Spectrum LitClouds::MeanBeam(double altitude_m, std::size_t of_layer) const {
  const LocalLight sun = LocalLightAt(geometry_, {0.0, 0.0, altitude_m}, light_);
  return static_cast<float>(sun.visible_fraction * MeanBeamLeft(altitude_m, of_layer)) *
         air_.BeamLeft(altitude_m, sun.mu_s_effective);
}

std::vector<CloudLayerFluxes> LitClouds::LitBy(const std::vector<Spectrum>& beams, double sky,
                                               std::size_t band) const {
  std::vector<CloudLayerFluxes> lit;
  for (std::size_t i = 0; i < layers(); ++i) {
    CloudLayerFluxes fluxes = FluxesOf(Layer(i));
    const auto beam = static_cast<double>(beams[i][band]);
    const float excess = (sky_on_clouds_[i][band] - 1.0F) * beam_left_[i];
    const double more = static_cast<double>(excess) * fluxes.sky_up * sky;
    fluxes.sun_up = beam * fluxes.sun_up + more;
    fluxes.sun_down = beam * fluxes.sun_down - more;
    lit.push_back(fluxes);
  }
  return lit;
}

void LitClouds::FindExchange() {
  const std::size_t bands = air_.bands();
  for (std::size_t i = 0; i < layers(); ++i) {
    beams_.push_back(MeanBeam(BeamAltitudeOf(i, MiddleOf(i)), i));
    sky_on_clouds_.push_back(SkyOnClouds(i));
    beam_left_.push_back(static_cast<float>(MeanBeamLeft(MiddleOf(i), i)));
    sky_past_.push_back(static_cast<float>(FluxesOf(Layer(i)).sky_down));
  }
  const std::vector<Spectrum> no_beams(layers(), Spectrum(bands));
  const double top_m = shadow_->highest_cloud_m();
  const LocalLight above = LocalLightAt(geometry_, {0.0, 0.0, top_m}, light_);
  const LocalLight below = LocalLightAt(geometry_, {0.0, 0.0, 0.0}, light_);
  const Spectrum sky = air_.multiple_scattering().Irradiance(top_m, above.mu_s_for_air, 1.0, 1.0);
  const std::vector<double> intensity = DiffuseIntensity(air_, top_m, above.mu_s_for_air);
  const std::vector<double> reflection = ReflectionOfAirAbove(air_.medium(), top_m);
  const double sine = std::max(below.mu_s_effective, 0.0);
  const Spectrum direct = static_cast<float>(sine) * MeanBeam(0.0, layers());
  const Spectrum clear_direct =
      static_cast<float>(sine * below.visible_fraction) * air_.BeamLeft(0.0, below.mu_s_effective);
  FindTurned();
  sky_on_top_ = sky;
  sky_above_.assign(layers(), Spectrum(bands));
  ground_below_ = sky_above_;
  diffuse_.assign(layers() + 1, Spectrum(bands));
  added_ = sent_back_ = diffuse_;
  left_on_ground_ = Spectrum(bands);
  for (std::size_t band = 0; band < bands; ++band) {
    const double albedo = air_.medium().ground_albedo[band];
    const auto from_sky = static_cast<double>(sky[band]);
    const auto on_ground = static_cast<double>(direct[band]);
    const InterfaceFluxes clear =
        FluxesBetween({}, {from_sky, static_cast<double>(clear_direct[band])}, albedo).front();
    const double sky_alone = from_sky - reflection[band] * clear.up;
    const auto all = FluxesBetween(LitBy(beams_, from_sky, band),
                                   {sky_alone, on_ground, reflection[band]}, albedo);
    const auto of_sky = FluxesBetween(LitBy(no_beams, 1.0, band), {.sky = 1.0}, albedo);
    for (std::size_t i = 0; i < layers(); ++i) {
      sky_above_[i][band] = static_cast<float>(all[i + 1].down / kPi);
      ground_below_[i][band] = static_cast<float>(all[i].up / kPi);
    }
    const double on_clear_ground = clear.down + static_cast<double>(clear_direct[band]);
    left_on_ground_[band] = static_cast<float>(
        on_clear_ground > 0.0 ? (all.front().down + on_ground) / on_clear_ground : 1.0);
    const auto of_ground = FluxesBetween(LitBy(no_beams, 0.0, band), {.from_ground = 1.0}, albedo);
    for (std::size_t i = 0; i <= layers(); ++i) {
      sent_back_[i][band] = static_cast<float>(of_ground[i].down);
      added_[i][band] = static_cast<float>(
          std::max(all[i].down - static_cast<double>(air_left_[i]) * from_sky, 0.0));
      const double left = of_sky[i].down;
      const double down = std::max(all[i].down - static_cast<double>(turned_[i][band]), 0.0);
      const double change = (left - 1.0) * (intensity[band] - 2.0 * clear.up) +
                            2.0 * (down - left * clear.down + all[i].up - clear.up);
      diffuse_[i][band] = static_cast<float>(
          intensity[band] > 0.0 ? std::max(1.0 + change / intensity[band], 0.0) : 1.0);
    }
  }
}

// Below kLowestFull the light of beams that pass under clouds of a round planet counts more and more.
void LitClouds::FindLayered() {
  constexpr double kLowestFull = 0.05;
  const LocalLight sun = LocalLightAt(geometry_, {0.0, 0.0, 0.0}, light_);
  if (!(sun.visible_fraction > 0.0 && sun.mu_s_effective > 0.0)) return;
  std::vector<LayeredCloud> clouds;
  for (std::size_t i = 0; i < layers(); ++i) {
    const PlaneParallelCloud* plane = Layer(i).plane_parallel();
    if (plane == nullptr) return;
    clouds.push_back(
        {{plane->depths().base_m(), plane->depths().top_m()}, plane->stack().optics(0)});
  }
  if (clouds.empty()) return;
  layered_.emplace(air_.medium(), clouds, SunOverLayers(air_, sun.mu_s_effective));
  layered_share_ = static_cast<float>(std::min(sun.mu_s_effective / kLowestFull, 1.0));
  const Spectrum clear = air_.multiple_scattering().Irradiance(0.0, sun.mu_s_for_air, 1.0, 1.0);
  const Spectrum change = layered_->ChangeAt(0.0).down;
  const auto sine = static_cast<float>(sun.mu_s_effective);
  const Spectrum direct = sine * MeanBeam(0.0, layers());
  const Spectrum clear_direct =
      sine * static_cast<float>(sun.visible_fraction) * air_.BeamLeft(0.0, sun.mu_s_effective);
  Spectrum left = left_on_ground_;
  for (std::size_t band = 0; band < left.size(); ++band) {
    const float before = clear[band] + clear_direct[band];
    const float now = std::max(clear[band] + change[band], 0.0F) + direct[band];
    if (before > 0.0F) left[band] = now / before;
  }
  left_on_ground_ = Blended(left_on_ground_, left);
}

Spectrum LitClouds::Blended(const Spectrum& by_exchange, const Spectrum& together) const {
  return (1.0F - layered_share_) * by_exchange + layered_share_ * together;
}

Spectrum LitClouds::AddedAt(std::size_t interface, double altitude_m) const {
  if (!layered_) return added_[interface];
  const LocalLight sun = LocalLightAt(geometry_, {0.0, 0.0, altitude_m}, light_);
  const Spectrum clear =
      air_.multiple_scattering().Irradiance(altitude_m, sun.mu_s_for_air, 1.0, 1.0);
  Spectrum added = (1.0F - air_left_[interface]) * clear + layered_->ChangeAt(altitude_m).down;
  for (float& value : added.values()) value = std::max(value, 0.0F);
  return Blended(added_[interface], added);
}

void LitClouds::FindTurned() {
  for (std::size_t i = 0; i <= layers(); ++i) {
    const double altitude_m = AltitudeOf(i);
    const double scaled = MeanScaledLeft(altitude_m);
    const double turned = std::max(scaled - MeanBeamLeft(altitude_m, layers()), 0.0);
    const LocalLight sun = LocalLightAt(geometry_, {0.0, 0.0, altitude_m}, light_);
    const double level = turned * sun.visible_fraction * std::max(sun.mu_s_effective, 0.0);
    air_left_.push_back(static_cast<float>(scaled));
    turned_.push_back(static_cast<float>(level) * air_.BeamLeft(altitude_m, sun.mu_s_effective));
  }
}

double LitClouds::MiddleOf(std::size_t layer) const {
  return 0.5 * (RangeOf(layer).low_m + RangeOf(layer).high_m);
}

std::size_t LitClouds::InterfaceAt(double altitude_m) const {
  std::size_t interface = 0;
  while (interface < layers() && MiddleOf(interface) < altitude_m) ++interface;
  return interface;
}

const Spectrum& LitClouds::SentBackAt(double altitude_m) const {
  return sent_back_[InterfaceAt(altitude_m)];
}

std::vector<DiffuseStretch> LitClouds::DiffuseInAir(const glm::dvec3& origin,
                                                    const glm::dvec3& direction) const {
  constexpr double kEndless_m = std::numeric_limits<double>::infinity();
  const double radius_m = geometry_.radius_m();
  const bool falls = glm::dot(direction, geometry_.UpAt(origin)) < 0.0;
  const auto grounds = CrossingsOf(0.0, origin, direction, kEndless_m, radius_m);
  const double length_m = falls && !grounds.empty() ? grounds.front() : kEndless_m;
  std::vector<double> ends_m{kEndless_m};
  for (std::size_t i = 0; i < layers(); ++i) {
    const auto crossed = CrossingsOf(MiddleOf(i), origin, direction, length_m, radius_m);
    ends_m.insert(ends_m.end(), crossed.begin(), crossed.end());
  }
  std::sort(ends_m.begin(), ends_m.end());
  std::vector<DiffuseStretch> stretches;
  double begin_m = 0.0;
  for (const double end_m : ends_m) {
    stretches.push_back(
        {end_m, DiffuseOn({begin_m, std::min(end_m, length_m)}, origin, direction)});
    begin_m = end_m;
  }
  return stretches;
}

Spectrum LitClouds::DiffuseOn(const Distances& part, const glm::dvec3& origin,
                              const glm::dvec3& direction) const {
  constexpr double kBeyond_m = 1000.0;
  const bool is_endless = std::isinf(part.end_m);
  const glm::dvec3 middle =
      origin +
      (is_endless ? part.begin_m + kBeyond_m : 0.5 * (part.begin_m + part.end_m)) * direction;
  const double altitude_m = geometry_.AltitudeOf(middle);
  const Spectrum& even = diffuse_[InterfaceAt(altitude_m)];
  if (!layered_) return even;
  const auto altitude_at = [&](double distance_m) {
    return std::isinf(distance_m) ? distance_m
                                  : geometry_.AltitudeOf(origin + distance_m * direction);
  };
  const auto [low_m, high_m] =
      std::minmax({altitude_m, altitude_at(part.begin_m), altitude_at(part.end_m)});
  const double up = glm::dot(geometry_.UpAt(middle), direction);
  const LightWay way{-up, AzimuthFromBeam(direction, light_.direction.for_air)};
  return Blended(even, layered_->FactorTowards({low_m, high_m}, way));
}

LightPastClouds LitClouds::MeanAt(double altitude_m) const {
  const std::size_t interface = InterfaceAt(altitude_m);
  Spectrum added = AddedAt(interface, altitude_m);
  for (std::size_t band = 0; band < added.size(); ++band)
    added[band] = std::max(added[band] - turned_[interface][band], 0.0F);
  return {{Spectrum(added.size(), air_left_[interface]), added},
          left_on_ground_,
          static_cast<float>(MeanScaledLeft(altitude_m))};
}

SkyThroughMedia LitClouds::SkyAt(std::size_t interface, const glm::dvec3& point) const {
  SkyThroughMedia sky{Spectrum(air_.bands(), air_left_[interface]),
                      AddedAt(interface, geometry_.AltitudeOf(point))};
  if (interface == layers()) return sky;
  const glm::dvec3 flat = InFlatFrame(point, geometry_.radius_m());
  float past_lower = 1.0F, past_all = 1.0F;
  for (std::size_t i = interface; i < layers(); ++i) past_all *= sky_past_[i];
  for (std::size_t i = interface; i < layers(); ++i) {
    const CloudGroundDifference here = Layer(i).GroundDifferenceAt(flat);
    const float past_others = sky_past_[i] > 0.0F ? past_all / sky_past_[i] : 0.0F;
    const float of_sky = past_others * static_cast<float>(here.sky / kPi);
    const float of_sun = past_lower * static_cast<float>(here.sun);
    for (std::size_t band = 0; band < sky.added.size(); ++band) {
      const float more = of_sky * sky_on_top_[band] + of_sun * beams_[i][band];
      sky.added[band] = std::max(sky.added[band] + more, 0.0F);
    }
    past_lower *= sky_past_[i];
  }
  return sky;
}

SkyThroughMedia LitClouds::SkyOnSurface(const glm::dvec3& point, double cos_up,
                                        SkyThroughMedia above) const {
  const SkyThroughMedia level = SkyAt(InterfaceAt(geometry_.AltitudeOf(point)), point);
  const auto seen = static_cast<float>(0.5 * (1.0 + cos_up));
  above.added = level.left * above.added + seen * level.added;
  above.left = level.left * above.left;
  return above;
}

double LitClouds::PastOthers(std::size_t layer, const glm::dvec3& flat_point) const {
  double left = 1.0;
  for (std::size_t other = 0; other < layers(); ++other) {
    if (other != layer) left *= Layer(other).SunTransmittance(flat_point);
  }
  return left;
}

Spectrum LitClouds::SkyOnClouds(std::size_t layer) const {
  constexpr int kRays = 512;
  const CloudLight& light = Layer(layer);
  const CloudLattice& lattice = light.field().lattice();
  const CloudPlaneRays rays(light.field(), glm::dvec2(lattice.origin_m),
                            glm::dvec2(lattice.size_m()), light.sun().to_sun(),
                            light.optics().phase());
  const double altitude_m = MiddleOf(layer);
  const double mu_s = LocalLightAt(geometry_, {0.0, 0.0, altitude_m}, light_).mu_s_for_air;
  const Spectrum from_below = air_.multiple_scattering().Irradiance(altitude_m, mu_s, -1.0, 1.0);
  const SkyMoments sky = SkyMoments(air_.multiple_scattering(), {0.0, 0.0, 1.0},
                                    light_.direction.for_air, {altitude_m})
                             .WithoutGround(static_cast<float>(1.0 / kPi) * from_below);
  const std::vector<double> all(
      static_cast<std::size_t>(air_.multiple_scattering().options().degree) + 1, 1.0);
  Spectrum level(air_.bands()), taken(air_.bands());
  float taken_weight = 0.0F;
  for (int i = 1; i <= kRays; ++i) {
    const CloudRay ray = rays.FromTop(i).ray;
    const Spectrum radiance = sky.Towards(-ray.direction, all).front();
    const auto weight = static_cast<float>(1.0 - light.Radiance(ray).scaled_transmittance);
    level = level + radiance;
    taken = taken + weight * radiance;
    taken_weight += weight;
  }
  Spectrum relative(air_.bands(), 1.0F);
  for (std::size_t band = 0; band < relative.size(); ++band) {
    const float even = taken_weight * level[band];
    if (even > 0.0F) relative[band] = kRays * taken[band] / even;
  }
  return relative;
}

LitClouds::LightAround LitClouds::AroundLayer(std::size_t layer, const glm::dvec3& point) const {
  return AroundLayer(layer, LocalLightAt(geometry_, point, light_));
}

std::vector<LitClouds::InterfaceLight> LitClouds::Interfaces() const {
  std::vector<InterfaceLight> all;
  for (std::size_t i = 0; i <= layers(); ++i) {
    constexpr double kEndless_m = std::numeric_limits<double>::infinity();
    const double low_m = i > 0 ? MiddleOf(i - 1) : -kEndless_m;
    const AltitudeRange gap_m{i > 0 ? RangeOf(i - 1).high_m : 0.0,
                              i < layers() ? RangeOf(i).low_m : kEndless_m};
    all.push_back({low_m, air_left_[i], AddedAt(i, gap_m.low_m), diffuse_[i], {}});
    if (!layered_) continue;
    all.back().diffuse = Blended(diffuse_[i], layered_->MeanFactor(gap_m));
    for (int elevation = 0; elevation < InterfaceLight::kElevations; ++elevation) {
      for (int azimuth = 0; azimuth < InterfaceLight::kAzimuths; ++azimuth) {
        const LightWay way = InterfaceLight::WayOfNode(elevation, azimuth);
        all.back().diffuse_towards.push_back(
            Blended(diffuse_[i], layered_->FactorTowards(gap_m, way)));
      }
    }
  }
  return all;
}

LightWay LitClouds::InterfaceLight::WayOfNode(int elevation, int azimuth) {
  const double root = 2.0 * elevation / (kElevations - 1.0) - 1.0;
  return {-root * std::abs(root), kPi * azimuth / (kAzimuths - 1.0)};
}

LitClouds::LightAround LitClouds::AroundLayer(std::size_t layer, const LocalLight& sun) const {
  const MultipleScattering& orders = air_.multiple_scattering();
  // Irradiance of a level surface that faces the sky or the ground.
  const auto level = [&](double altitude_m, double up) {
    return orders.Irradiance(altitude_m, sun.mu_s_for_air, up, 1.0);
  };
  const Spectrum from_above = sky_on_clouds_[layer] * level(sun.altitude_m, 1.0) +
                              -1.0F * level(shadow_->highest_cloud_m(), 1.0);
  const Spectrum from_below = level(sun.altitude_m, -1.0) + -1.0F * level(0.0, -1.0);
  LightAround around{sky_above_[layer], ground_below_[layer]};
  constexpr auto kToRadiance = static_cast<float>(1.0 / kPi);
  for (std::size_t band = 0; band < around.sky.size(); ++band) {
    float &sky = around.sky[band], &ground = around.ground[band];
    sky = std::max(sky + kToRadiance * beam_left_[layer] * from_above[band], 0.0F);
    ground = std::max(ground + kToRadiance * left_on_ground_[band] * from_below[band], 0.0F);
  }
  if (!layered_) return around;
  const auto [low_m, high_m] = RangeOf(layer);
  const Spectrum change_above = layered_->ChangeAt(high_m).down;
  const Spectrum change_below = layered_->ChangeAt(low_m).up;
  const Spectrum clear_above = level(high_m, 1.0), clear_below = level(low_m, -1.0);
  LightAround together = around;
  for (std::size_t band = 0; band < around.sky.size(); ++band) {
    const float uneven = beam_left_[layer] * (sky_on_clouds_[layer][band] - 1.0F);
    const float above = (1.0F + uneven) * clear_above[band] + change_above[band];
    together.sky[band] = kToRadiance * std::max(above, 0.0F);
    together.ground[band] = kToRadiance * std::max(clear_below[band] + change_below[band], 0.0F);
  }
  return {Blended(around.sky, together.sky), Blended(around.ground, together.ground)};
}

// A plane-parallel layer takes the beam where it enters.
double LitClouds::BeamAltitudeOf(std::size_t layer, double altitude_m) const {
  if (Layer(layer).plane_parallel() == nullptr) return altitude_m;
  return Layer(layer).sun().to_sun().z < 0.0 ? RangeOf(layer).low_m : RangeOf(layer).high_m;
}

CloudScreen LitClouds::Screen(const CloudRayPart& grey, const glm::dvec3& point) const {
  const LocalLight sun = LocalLightAt(geometry_, point, light_);
  const double beam_m = BeamAltitudeOf(grey.layer, sun.altitude_m);
  const glm::dvec3 entry = point + (beam_m - sun.altitude_m) * sun.up;
  const LocalLight at_entry = LocalLightAt(geometry_, entry, light_);
  const double past = PastOthers(grey.layer, InFlatFrame(point, geometry_.radius_m())) *
                      (past_terrain_ ? past_terrain_->At(point) : 1.0);
  Spectrum beam = static_cast<float>(past * at_entry.visible_fraction) *
                  air_.BeamLeft(at_entry.altitude_m, at_entry.mu_s_effective);
  if (!colours_.empty()) beam = beam * colours_[grey.layer].Of(grey.fast[0], grey.once);
  const LightAround around = AroundLayer(grey.layer, sun);
  const auto [from_sun, from_sky, from_ground] = grey.light;
  return {grey.distance_m, static_cast<float>(grey.scaled_transmittance),
          static_cast<float>(from_sun) * beam + static_cast<float>(from_sky) * around.sky +
              static_cast<float>(from_ground) * around.ground,
          static_cast<float>(from_ground)};
}

bool LitClouds::SharesAltitudes(std::size_t layer) const {
  const auto [low_m, high_m] = RangeOf(layer);
  for (std::size_t other = 0; other < layers(); ++other) {
    const AltitudeRange range = RangeOf(other);
    if (other != layer && range.low_m < high_m && low_m < range.high_m) return true;
  }
  return false;
}

std::vector<CloudRayPart> LitClouds::PartsOf(const glm::dvec3& origin, const PixelRays::Ray& ray,
                                             bool by_paths) const {
  constexpr double kNothing = 1e-4, kLongestShared_m = 4000.0;
  struct Piece {
    std::size_t layer;
    int number;
    CloudChord chord;
  };
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < layers(); ++i) {
    int number = 0;
    for (const CloudChord& chord :
         ChordsWithin(RangeOf(i), origin, ray.direction, ray.length_m, geometry_.radius_m(),
                      SharesAltitudes(i) ? kLongestShared_m : kLongestChord_m))
      pieces.push_back({i, number++, chord});
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.chord.begin_m < b.chord.begin_m; });
  std::vector<CloudRayPart> parts;
  double left = 1.0, farthest_m = 0.0;
  for (const Piece& piece : pieces) {
    if (left < kNothing && piece.chord.begin_m >= farthest_m) break;
    const CloudLight& light = by_paths ? along_rays_[piece.layer] : Layer(piece.layer);
    const auto [fast, chosen] =
        light.RadianceByBoth({piece.chord.origin, piece.chord.direction}, piece.chord.length_m);
    if (fast.transmittance >= 1.0) continue;
    parts.push_back({.layer = piece.layer,
                     .chord = piece.number,
                     .distance_m = piece.chord.OnRay(fast.mean_distance_m),
                     .transmittance = fast.transmittance,
                     .scaled_transmittance = fast.scaled_transmittance,
                     .fast = {fast.sun, fast.sky, fast.ground},
                     .light = {chosen.sun, chosen.sky, chosen.ground},
                     .once = fast.once});
    left *= fast.scaled_transmittance;
    farthest_m = std::max(farthest_m, parts.back().distance_m);
  }
  // Chords of layers at the same altitudes overlap.
  std::stable_sort(parts.begin(), parts.end(), [](const CloudRayPart& a, const CloudRayPart& b) {
    return a.distance_m < b.distance_m;
  });
  return parts;
}

CloudsOnRay LitClouds::Along(const glm::dvec3& origin, const glm::dvec3& direction,
                             double length_m) const {
  const auto trace = [&](const PixelRays::Ray& ray, bool by_paths) {
    return PartsOf(origin, ray, by_paths);
  };
  const PixelRays::Ray ray{direction, length_m};
  return CloudsOf(
      shared_ && shared_->eye() == origin ? shared_->Parts(ray, trace) : trace(ray, true), origin,
      direction);
}

CloudsOnRay LitClouds::CloudsOf(const std::vector<CloudRayPart>& parts, const glm::dvec3& origin,
                                const glm::dvec3& direction) const {
  CloudsOnRay clouds;
  double unscattered = 1.0;
  for (const CloudRayPart& part : parts) {
    clouds.Add(Screen(part, origin + part.distance_m * direction));
    unscattered *= part.transmittance;
  }
  clouds.unscattered = static_cast<float>(unscattered);
  return clouds;
}

Spectrum LitClouds::OverSky(const glm::dvec3& point, const glm::dvec3& direction,
                            const Spectrum& clear) const {
  const CloudChange change =
      mirror_ ? mirror_->Towards(direction, geometry_.UpAt(point)) : ChangeAlong(point, direction);
  return change.left * clear + change.added;
}

CloudChange LitClouds::ChangeAlong(const glm::dvec3& point, const glm::dvec3& direction) const {
  const PixelRays::Ray endless{direction, std::numeric_limits<double>::infinity()};
  const CloudsOnRay clouds = CloudsOf(PartsOf(point, endless, false), point, direction);
  CloudChange change{Spectrum(air_.bands(), 1.0F), Spectrum(air_.bands())};
  if (clouds.screens.empty()) return change;
  const double cosine = std::clamp(glm::dot(direction, geometry_.UpAt(point)), -1.0, 1.0);
  const auto left_after = [&](double distance_m) {
    ViewRay ray{geometry_.AltitudeOf(point), cosine, 1.0, 0.0};
    ray.length_m = distance_m;
    return air_.single_scattering().TransmittanceAlong(ray);
  };
  const Spectrum whole = left_after(endless.length_m);
  const auto share_up_to = [&](double distance_m) {
    Spectrum share = left_after(distance_m);
    for (std::size_t band = 0; band < share.size(); ++band)
      share[band] = whole[band] < 1.0F ? (1.0F - share[band]) / (1.0F - whole[band]) : 1.0F;
    return share;
  };
  change.left = clouds.Dimmed(change.left, share_up_to);
  float past = 1.0F;
  for (const CloudScreen& screen : clouds.screens) {
    change.added = change.added + past * (left_after(screen.distance_m) * screen.radiance);
    past *= screen.transmittance;
  }
  return change;
}

}  // namespace alpenglow::renderer
