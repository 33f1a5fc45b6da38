// SPDX-License-Identifier: MIT
// Computes the refracted rays of a picture, and whether their effect is visible; and the air along
// its rays.
#include "renderer/picture/segment_air.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/illumination/picture_stokes.h"
#include "renderer/picture/prepared_scene.h"

namespace alpenglow::renderer {
namespace {

constexpr EffectSet kParts{Effect::kMolecules, Effect::kAerosol, Effect::kOzone};

Medium OnlyWith(Medium medium, EffectSet parts) {
  const std::vector<double> none(medium.wavelengths_nm.size(), 0.0);
  if (!parts.Has(Effect::kMolecules)) medium.rayleigh_scattering_per_m = none;
  if (!parts.Has(Effect::kAerosol))
    medium.mie_scattering_per_m = medium.mie_extinction_per_m = none;
  if (!parts.Has(Effect::kOzone)) medium.ozone_absorption_per_m = none;
  return medium;
}

}  // namespace

const AirModel& AirModels::With(EffectSet effects) const {
  const EffectSet parts = effects.And(kParts);
  if (parts == kParts) return whole_;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<AirModel>& partial = partial_[parts];
  if (!partial) {
    partial = std::make_unique<AirModel>(OnlyWith(whole_.air.medium(), parts), parts_);
  }
  return *partial;
}

namespace {

/// Returns the direction in the same vertical plane at an elevation.
glm::dvec3 AtElevation(const glm::dvec3& direction, const glm::dvec3& up, double elevation_rad) {
  const glm::dvec3 across = direction - glm::dot(direction, up) * up;
  const double length = glm::length(across);
  if (!(length > 0.0)) return direction;  // at the zenith
  return std::cos(elevation_rad) / length * across + std::sin(elevation_rad) * up;
}

double Elevation(const glm::dvec3& direction, const glm::dvec3& up) {
  return std::asin(std::clamp(glm::dot(direction, up), -1.0, 1.0));
}

/// Largest distance between a chord and its bent ray, as an angle from the eye. Compared with exact
/// rays, moonlit crests of one pixel are off by 2.8 % of their light in one pixel of a thousand at
/// 0.04 pixels, and by 1.0 % at 0.005, for 1.01 times the time.
constexpr double kOffPixels = 0.005, kLeastOff_rad = 1e-4 * kRadiansPerDegree / 60.0;

/// Returns the larger of the flattening of a disk at its lower limb and the separation of its
/// colours at the limb [rad].
double ChangeOfDisk(const RefractedView& view, double elevation_rad, double radius_rad,
                    std::size_t bands) {
  const auto lift = [&](double elevation, std::size_t band) {
    return elevation - view.TrueElevation(elevation, band);
  };
  const double lower = std::max(elevation_rad - radius_rad, view.horizon_rad());
  const double flatter = lift(lower, 0) - lift(std::max(elevation_rad, lower), 0);
  return std::max(flatter, std::abs(lift(lower, 0) - lift(lower, bands - 1)));
}

}  // namespace

double RefractedViewRays::ElevationOf(const glm::dvec3& direction) const {
  return Elevation(direction, up);
}

glm::dvec3 RefractedViewRays::TrueDirection(const glm::dvec3& direction, std::size_t band) const {
  return AtElevation(direction, up, view.TrueElevation(ElevationOf(direction), band));
}

std::shared_ptr<const RefractedViewRays> PreparedScene::RefractedViewRaysOf(
    const FrameContext& frame, const CameraSample& camera_sample) const {
  const CameraRays& camera = frame.camera();
  const double half_pixel = 0.5 * camera.PixelAngle();
  const glm::dvec3 up = geometry.UpAt(camera.eye());
  const double height_m = std::max(geometry.AltitudeOf(camera.eye()), 0.0);
  // The margin around the picture admits bodies that only touch its edge.
  const auto in_picture = [&](const glm::dvec3& direction, double margin_rad) {
    const auto at = camera.PlaceOf(direction);
    const double margin = margin_rad / camera.PixelAngle();
    return at && (*at)[0] > -margin && (*at)[0] < frame.settings.width + margin &&
           (*at)[1] > -margin && (*at)[1] < frame.settings.height + margin;
  };
  const auto horizon_in_picture = [&](double elevation_rad) {
    constexpr int kPlaces = 16;
    bool above = false, below = false;
    for (int i = 0; i <= kPlaces * kPlaces; ++i) {
      const double x = i % kPlaces * frame.settings.width / (kPlaces - 1.0);
      const double y = i / kPlaces * frame.settings.height / (kPlaces - 1.0);
      (Elevation(camera.Direction(x, y), up) > elevation_rad ? above : below) = true;
    }
    return above && below;
  };
  constexpr double kLow_rad = 10.0 * kRadiansPerDegree;
  const double geometric_rad = -std::acos(geometry.radius_m() / (geometry.radius_m() + height_m));
  const auto may_see = [&](const glm::dvec3& to_disk, double radius_rad) {
    const double elevation = Elevation(to_disk, up);
    return elevation < kLow_rad && elevation > geometric_rad - 2.0 * radius_rad &&
           in_picture(to_disk, 2.0 * radius_rad);
  };
  const Lighting& light = frame.light;
  const bool may_see_sun = may_see(light.to_sun, light.sun_radius_rad);
  const bool may_see_moon = light.moon && may_see(light.moon->to_moon, light.moon->radius_rad);
  const bool may_see_sea = !geometry.HasTerrain() && horizon_in_picture(geometric_rad);
  const bool moves_terrain = geometry.HasTerrain() && MostLift(frame, height_m) > half_pixel;
  if (!may_see_sun && !may_see_moon && !may_see_sea && !moves_terrain) return nullptr;
  const glm::dmat3 frame_from_enu = StandOf(camera_sample).frame_from_enu;
  const SunPosition sun = SunAt(EyeOf(camera_sample), camera_sample.instant);
  const MoonPosition moon = MoonAt(EyeOf(camera_sample), camera_sample.instant);
  auto bent = std::make_shared<RefractedViewRays>(RefractedViewRays{
      RefractedView(medium, height_m), up,
      frame_from_enu * DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz,
      frame_from_enu * DirectionFromAngles(moon.elevation_rad, moon.azimuth_rad).xyz});
  const auto moves = [&](const glm::dvec3& to_disk, double radius_rad) {
    return ChangeOfDisk(bent->view, Elevation(to_disk, up), radius_rad,
                        medium.wavelengths_nm.size()) > half_pixel;
  };
  const bool moves_disk = (may_see_sun && moves(light.to_sun, light.sun_radius_rad)) ||
                          (may_see_moon && moves(light.moon->to_moon, light.moon->radius_rad));
  const bool moves_sea = may_see_sea && bent->view.horizon_rad() - geometric_rad > half_pixel;
  if (moves_terrain) {
    bent->fan = std::make_shared<RefractedFan>(bent->view.air(), camera.eye(), up,
                                               geometry.FarthestFrom(camera.eye()));
  }
  bent->moves_ground = !geometry.HasTerrain() || moves_terrain;
  return moves_disk || moves_sea || moves_terrain ? bent : nullptr;
}

double PreparedScene::MostLift(const FrameContext& frame, double eye_height_m) const {
  const LandBend bend = LandBendOf(GentleAirOf(medium), eye_height_m);
  return MostLiftOfPlanet(bend, eye_height_m, geometry.FarthestFrom(frame.camera().eye()));
}

namespace {

/// Returns whether the bare planet occludes the terrain that a ray meets: the ray enters the planet
/// before it, where no terrain covers the planet (a ray through a basin below the sphere is in free
/// air). Inside the planet the air of ground level continues.
bool HiddenByPlanet(const SceneGeometry& geometry, const RefractedGroundRay& met,
                    const BendingAir& air, const glm::dvec3& foot, const glm::dvec3& up,
                    const glm::dvec3& across, const glm::dvec3& point) {
  const glm::dvec3 from_centre = point + glm::dvec3(0.0, 0.0, geometry.radius_m());
  const double angle = std::atan2(glm::dot(from_centre, across), glm::dot(from_centre, up));
  if (angle < met.angle_rad) return false;
  const double bends =
      -RefractivitySlopeAt(air, 0.0) * geometry.radius_m() / (1.0 + air.refractivity);
  const double to_deepest = met.elevation_rad / (1.0 - bends);
  const double inside = met.angle_rad + std::min(to_deepest, 0.5 * (angle - met.angle_rad));
  const double sine = std::sin(0.5 * inside);
  return !geometry.CoversPlanetAt(foot + geometry.radius_m() *
                                             (std::sin(inside) * across - 2.0 * sine * sine * up));
}

/// Returns whether a ray descends all the way to a point that is not below the planet's sphere. The
/// chord to the point is not above the ray.
bool IsBeforeHorizon(const SceneGeometry& geometry, const CameraRay& ray, const glm::dvec3& point) {
  return geometry.AltitudeOf(point) >= 0.0 &&
         glm::dot(point - ray.origin, geometry.UpAt(point)) < 0.0;
}

}  // namespace

Hit PreparedScene::OnRefractedRay(const CameraRay& ray, const FrameContext& frame,
                                  double expected_m) const {
  const RefractedViewRays& bent = *frame.bent;
  Hit hit;
  if (geometry.HasTerrain()) {
    const double off_rad = std::max(kOffPixels * frame.camera().PixelAngle(), kLeastOff_rad);
    hit = Relief(frame).TerrainAlong(FanRay(*bent.fan, ray.origin, ray.direction), off_rad,
                                     frame.camera().PixelAngle(), expected_m);
    if (hit.kind == HitKind::kTerrain && IsBeforeHorizon(geometry, ray, hit.point)) return hit;
  }
  const auto met = bent.view.ToGround(bent.ElevationOf(ray.direction));
  if (!met) return hit;
  const glm::dvec3 across = AtElevation(ray.direction, bent.up, 0.0);
  const glm::dvec3 foot = ray.eye - geometry.AltitudeOf(ray.eye) * bent.up;
  if (hit.kind == HitKind::kTerrain &&
      !HiddenByPlanet(geometry, *met, bent.view.air(), foot, bent.up, across, hit.point))
    return hit;
  const double sine = std::sin(0.5 * met->angle_rad);
  const glm::dvec3 point = foot + geometry.radius_m() * (std::sin(met->angle_rad) * across -
                                                         2.0 * sine * sine * bent.up);
  const glm::dvec3 up = geometry.UpAt(point);
  const double distance_m = glm::length(point - ray.origin);
  return {HitKind::kPlanet,
          distance_m,
          up,
          up,
          up,
          point,
          point,
          distance_m * frame.camera().PixelAngle()};
}

namespace {

/// Air along a ray, with the effects of a picture.
class AirTo {
 public:
  AirTo(const FrameContext& frame, const SceneGeometry& geometry, const Medium& medium,
        const SharedSegmentAir& rays, const glm::dvec3& direction, const Lighting& light,
        const TerrainSunlight& sunlight)
      : frame_(frame),
        sunlight_(sunlight),
        is_lit_(light.shows),
        kind_(rays.kind),
        direction_(direction),
        to_sun_(light.to_sun_for_air),
        nu_seen_(std::clamp(glm::dot(direction, light.to_sun), -1.0, 1.0)),
        up_(geometry.UpAt(frame.camera().eye())) {
    const glm::dvec3& from = frame.camera().eye();
    ray_ = {geometry.AltitudeOf(from), std::clamp(glm::dot(direction, up_), -1.0, 1.0),
            std::clamp(glm::dot(to_sun_, up_), -1.0, 1.0),
            std::clamp(glm::dot(direction, to_sun_), -1.0, 1.0)};
    // A straight ray ends at the planet's own horizon by itself; a length would only add a rounding
    // error. Refracted rays also see the planet beyond that horizon.
    const bool is_bent = frame.bent && frame.bent->moves_ground;
    if (kind_ == HitKind::kTerrain || (kind_ == HitKind::kPlanet && is_bent))
      ray_.length_m = rays.length_m();
    if (!sunlight_.IsBroken()) return;
    const RayExtent extent = ExtentOf(ray_, geometry.radius_m(), medium.atmosphere_height_m);
    path_ = sunlight_.Along(from, direction, extent.end_m);
  }

  [[nodiscard]] const SunlitPath* sunlit() const { return sunlight_.IsBroken() ? &path_ : nullptr; }

  [[nodiscard]] AirAlongRay operator()(double length_m) const {
    const AirModel& in = *frame_.model;
    ViewRay ray = ray_;
    ray.length_m = std::min(ray.length_m, length_m);
    AirAlongRay none{BandLight(in.air.bands()), BandLight(in.air.bands())};
    if (frame_.polarised) none.polarised = {none.inscatter, none.inscatter};
    std::fill_n(none.transmittance.value.begin(), none.transmittance.count, 1.0F);
    if (kind_ != HitKind::kSky && !frame_.Has(Effect::kAerial)) return none;
    if (!is_lit_ || (kind_ == HitKind::kSky && !frame_.Has(Effect::kSky))) {
      none.transmittance = in.air.TransmittanceAlong(ray);
      return none;
    }
    const int nodes = frame_.settings.air_nodes;
    const AerialPerspective::Nodes sampling{
        .sky = frame_.Has(Effect::kFineAir) ? nodes : std::max(nodes / 2, 2),
        .higher_orders = frame_.Has(Effect::kMultipleScattering),
        .polarised = frame_.polarised,
        .nu_seen = nu_seen_};
    AirAlongRay air = sunlight_.IsBroken() ? in.aerial.Along(ray, path_, sampling)
                                           : in.aerial.Along(ray, sampling);
    if (air.polarised) {
      air.polarised =
          InAxes(*air.polarised, direction_, up_, to_sun_, frame_.camera().AxesAt(direction_));
    }
    return air;
  }

 private:
  const FrameContext& frame_;
  const TerrainSunlight& sunlight_;
  bool is_lit_;
  HitKind kind_;
  glm::dvec3 direction_, to_sun_;
  double nu_seen_;
  glm::dvec3 up_;
  ViewRay ray_;
  SunlitPath path_;
};

}  // namespace

bool SharedSegmentAir::Takes(const Hit& hit, const glm::dvec3& direction, double widest_rad) const {
  constexpr double kSameDistance = 0.01;
  if (hit.kind != kind || glm::length(direction - first_direction) > widest_rad) return false;
  return kind == HitKind::kSky ||
         std::abs(hit.distance_m - first_distance_m) <= kSameDistance * first_distance_m;
}

std::size_t AirFor(const Hit& hit, const glm::dvec3& direction, const FrameContext& frame,
                   std::vector<SharedSegmentAir>& airs) {
  // Rays share air across the full width of a filter, and while the camera turns by so little that
  // the sky hardly changes.
  constexpr double kSameSky_rad = 0.01;
  const double widest_rad =
      3.0 * frame.filter.radius() * frame.camera().PixelAngle() + kSameSky_rad;
  auto known = std::find_if(airs.begin(), airs.end(), [&](const SharedSegmentAir& shared) {
    return frame.settings.share_air && shared.Takes(hit, direction, widest_rad);
  });
  if (known == airs.end()) {
    known = airs.insert(airs.end(), {hit.kind, hit.distance_m, direction, glm::dvec3(0.0), 0.0, 0});
  }
  known->direction_sum += direction;
  known->distance_sum_m += hit.distance_m;
  ++known->rays;
  return static_cast<std::size_t>(known - airs.begin());
}

namespace {

/// Returns the light of the air that arrives through media.
AirAlongRay ThroughMedia(const std::vector<MarchedPiece>& pieces, const AirTo& air,
                         const AirAlongRay& whole) {
  AirAlongRay left = whole;
  left.inscatter = DimmedByMedia(
      pieces, [&](double m) { return air(m).inscatter; }, whole.inscatter, Behind::kAll);
  if (!whole.polarised) return left;
  // Q and U can fall with distance, but the light behind an analyser, I + Q and I + U, increases.
  const auto dimmed = [&](BandLight PolarisedLight::*part) {
    const auto passed = [&](const AirAlongRay& lit) {
      return lit.inscatter + *lit.polarised.*part;
    };
    return DimmedByMedia(
               pieces, [&](double m) { return passed(air(m)); }, passed(whole), Behind::kAll) +
           -1.0F * left.inscatter;
  };
  left.polarised = {dimmed(&PolarisedLight::q), dimmed(&PolarisedLight::u)};
  return left;
}

/// Adds the light of a second source in air and media. Call after adding the sun's.
void AddSecondLight(const FrameContext& frame, const SecondLight& second,
                    const SceneGeometry& geometry, const Medium& medium,
                    const glm::dvec3& direction, SharedSegmentAir& rays) {
  const AirTo air(frame, geometry, medium, rays, direction, second.light, *second.sunlight);
  AirAlongRay lit = air(std::numeric_limits<double>::infinity());
  if (second.media) {
    const MarchedLight marched =
        second.media->Along(frame.camera().eye(), direction, rays.length_m(), air.sunlit());
    lit = ThroughMedia(marched.pieces, air, lit);
    rays.media = rays.media + marched.radiance;
  }
  rays.air.inscatter = rays.air.inscatter + second.by_sun * lit.inscatter;
  if (lit.polarised) rays.air.polarised = *rays.air.polarised + second.by_sun * *lit.polarised;
}

}  // namespace

void AddAir(const FrameContext& frame, const SceneGeometry& geometry, const Medium& medium,
            SharedSegmentAir& rays) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  const glm::dvec3 direction = glm::normalize(rays.direction_sum);
  const AirTo air(frame, geometry, medium, rays, direction, frame.light, *frame.sunlight);
  rays.air = air(kAll);
  rays.media = BandLight(rays.air.inscatter.count);
  if (frame.media) {
    MarchedLight marched =
        frame.media->Along(frame.camera().eye(), direction, rays.length_m(), air.sunlit());
    rays.air = ThroughMedia(marched.pieces, air, rays.air);
    rays.air.transmittance = rays.air.transmittance * marched.transmittance;
    rays.media = marched.radiance;
    rays.pieces = std::move(marched.pieces);
  }
  if (frame.moonlit) AddSecondLight(frame, *frame.moonlit, geometry, medium, direction, rays);
}

void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays) {
  const glm::dvec3 direction = glm::normalize(rays.direction_sum);
  rays.fog = frame.lamps->FogTransmittance(direction, frame.HasLitFog() ? 0.0 : rays.length_m());
  rays.lamp_light = BandLight(rays.media.count);
  if (frame.plan->tiles.empty() || !frame.Has(Effect::kBeams)) return;
  const auto upto = [&](double length_m) {
    return frame.lamps->InAir(*frame.plan, x, y, {direction, std::min(length_m, rays.length_m())},
                              frame.camera().PixelAngle(), frame.settings.lamps.nodes);
  };
  rays.lamp_light = DimmedByMedia(rays.pieces, upto, upto(rays.length_m()), Behind::kVolumes);
}

}  // namespace alpenglow::renderer
