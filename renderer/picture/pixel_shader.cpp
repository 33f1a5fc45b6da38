// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_shader.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/material/band_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/ground_light.h"

namespace alpenglow::renderer {
namespace {

/// Air along a ray, with the effects of a picture.
class AirTo {
 public:
  AirTo(const FrameContext& frame, const FrameLight& source, const SharedSegmentAir& rays,
        const glm::dvec3& direction)
      : frame_(frame),
        sunlight_(*source.shadows),
        is_lit_(source.light.shows),
        kind_(rays.kind),
        direction_(direction),
        to_sun_(source.light.to_sun_for_air),
        nu_seen_(std::clamp(glm::dot(direction, source.light.to_sun), -1.0, 1.0)),
        up_(frame.scene().geometry().UpAt(frame.camera().eye())) {
    const SceneGeometry& geometry = frame.scene().geometry();
    const glm::dvec3& from = frame.camera().eye();
    ray_ = {geometry.AltitudeOf(from), std::clamp(glm::dot(direction, up_), -1.0, 1.0),
            std::clamp(glm::dot(to_sun_, up_), -1.0, 1.0),
            std::clamp(glm::dot(direction, to_sun_), -1.0, 1.0)};
    // A straight ray ends at the planet's own horizon by itself; a length would only add a rounding
    // error. Refracted rays also see the planet beyond that horizon.
    const bool is_bent = frame.bent() && frame.bent()->moves_ground;
    if (kind_ == HitKind::kTerrain || (kind_ == HitKind::kPlanet && is_bent))
      ray_.length_m = rays.length_m();
    if (!sunlight_.IsBroken()) return;
    const RayExtent extent =
        ExtentOf(ray_, geometry.radius_m(), frame.scene().medium().atmosphere_height_m);
    path_ = sunlight_.Along(from, direction, extent.end_m);
  }

  [[nodiscard]] const SunlitPath* sunlit() const { return sunlight_.IsBroken() ? &path_ : nullptr; }

  [[nodiscard]] AirAlongRay operator()(double length_m) const {
    const AirModel& in = frame_.model();
    ViewRay ray = ray_;
    ray.length_m = std::min(ray.length_m, length_m);
    AirAlongRay none{BandLight(in.air.bands()), BandLight(in.air.bands())};
    if (frame_.IsPolarised()) none.polarised = {none.inscatter, none.inscatter};
    std::fill_n(none.transmittance.value.begin(), none.transmittance.count, 1.0F);
    if (kind_ != HitKind::kSky && !frame_.Has(Effect::kAerial)) return none;
    if (!is_lit_ || (kind_ == HitKind::kSky && !frame_.Has(Effect::kSky))) {
      none.transmittance = in.air.TransmittanceAlong(ray);
      return none;
    }
    const int nodes = frame_.settings().air_nodes;
    const AerialPerspective::Nodes sampling{
        .sky = frame_.Has(Effect::kFineAir) ? nodes : std::max(nodes / 2, 2),
        .higher_orders = frame_.Has(Effect::kMultipleScattering),
        .polarised = frame_.IsPolarised(),
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
      3.0 * frame.filter().radius() * frame.camera().PixelAngle() + kSameSky_rad;
  auto known = std::find_if(airs.begin(), airs.end(), [&](const SharedSegmentAir& shared) {
    return frame.settings().share_air && shared.Takes(hit, direction, widest_rad);
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

/// Adds the light of one source in air and media. The first source also determines the
/// transmittance and the pieces of media.
void AddSource(const FrameContext& frame, const FrameLight& source, bool is_first,
               const glm::dvec3& direction, SharedSegmentAir& rays) {
  const AirTo air(frame, source, rays, direction);
  AirAlongRay lit = air(std::numeric_limits<double>::infinity());
  if (is_first) rays.media = BandLight(lit.inscatter.count);
  if (source.media) {
    MarchedLight marched =
        source.media->Along(frame.camera().eye(), direction, rays.length_m(), air.sunlit());
    lit = ThroughMedia(marched.pieces, air, lit);
    lit.transmittance = lit.transmittance * marched.transmittance;
    rays.media = rays.media + marched.radiance;
    if (is_first) rays.pieces = std::move(marched.pieces);
  }
  if (is_first) {
    rays.air = std::move(lit);
    return;
  }
  rays.air.inscatter = rays.air.inscatter + source.by_sun * lit.inscatter;
  if (lit.polarised) rays.air.polarised = *rays.air.polarised + source.by_sun * *lit.polarised;
}

}  // namespace

void AddAir(const FrameContext& frame, SharedSegmentAir& rays) {
  const glm::dvec3 direction = glm::normalize(rays.direction_sum);
  bool is_first = true;
  for (const FrameLight& source : frame.lights()) {
    AddSource(frame, source, is_first, direction, rays);
    is_first = false;
  }
}

BandLight UnmarchedFog(const FrameContext& frame, const glm::dvec3& direction, double length_m) {
  const bool is_marched = frame.media() && frame.media()->media().fog() != nullptr;
  return frame.lamps().FogTransmittance(direction, is_marched ? 0.0 : length_m);
}

void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays) {
  const glm::dvec3 direction = glm::normalize(rays.direction_sum);
  rays.fog = UnmarchedFog(frame, direction, rays.length_m());
  rays.lamp_light = BandLight(rays.media.count);
  if (frame.plan().tiles.empty() || !frame.Has(Effect::kBeams)) return;
  const auto upto = [&](double length_m) {
    return frame.lamps().InAir(frame.plan(), x, y, {direction, std::min(length_m, rays.length_m())},
                               frame.camera().PixelAngle(), frame.settings().lamps.nodes);
  };
  rays.lamp_light = DimmedByMedia(rays.pieces, upto, upto(rays.length_m()), Behind::kVolumes);
}

namespace {

/// Returns the angle between unit vectors, computed from the chord: the arc cosine of a number near
/// 1 loses all digits.
double AngleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return 2.0 * std::asin(std::min(0.5 * glm::length(a - b), 1.0));
}

/// Returns the angular distance of a direction from the centre of the sun, in solar radii; no value
/// outside the disk and where the moon covers it.
std::optional<double> PlaceOnSun(const glm::dvec3& direction, const glm::dvec3& to_sun,
                                 const glm::dvec3& to_moon, const Lighting& light) {
  // A chord is never longer than its arc.
  if (glm::length(direction - to_sun) >= light.sun_radius_rad) return std::nullopt;
  const double rho = AngleBetween(direction, to_sun) / light.sun_radius_rad;
  if (rho >= 1.0) return std::nullopt;
  if (light.eclipse && AngleBetween(direction, to_moon) < light.moon->radius_rad)
    return std::nullopt;
  return rho;
}

/// Returns the radiance of the refracted disk: each band of the disk is lifted by its own
/// refraction, and attenuated by the air along the bent ray.
BandLight RefractedSunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                           const Lighting& light, const RefractedViewRays& bent,
                           const Medium& medium) {
  BandLight disk(light.irradiance.count);
  // The refracted disk is not wider than a circular one.
  if (glm::length(direction - light.to_sun) > 2.0 * light.sun_radius_rad) return disk;
  const double elevation = bent.ElevationOf(direction);
  const double per_sr = 1.0 / DiskSolidAngle(light.sun_radius_rad);
  for (std::size_t band = 0; band < disk.count; ++band) {
    const auto rho =
        PlaceOnSun(bent.TrueDirection(direction, band), bent.to_sun, bent.to_moon, light);
    if (!rho) continue;
    const double left = std::exp(-bent.view.MoreOpticalDepth(elevation, band));
    disk[band] =
        static_cast<float>(per_sr * left * LimbDarkening(*rho, medium.wavelengths_nm[band])) *
        light.WholeSun()[band] * through.transmittance[band];
  }
  return disk;
}

/// Returns the radiance of the sun's disk in a direction, W m^-2 sr^-1 nm^-1; 0 beside it and where
/// the moon covers it.
BandLight SunDiskRadiance(const FrameContext& frame, const glm::dvec3& direction,
                          const AirAlongRay& through) {
  const Medium& medium = frame.scene().medium();
  const Lighting& light = frame.light();
  if (frame.bent()) return RefractedSunDisk(direction, through, light, *frame.bent(), medium);
  const glm::dvec3& to_moon = light.moon ? light.moon->to_moon : light.to_sun;
  const auto rho = PlaceOnSun(direction, light.to_sun, to_moon, light);
  if (!rho) return BandLight(light.irradiance.count);
  BandLight disk = (1.0F / static_cast<float>(DiskSolidAngle(light.sun_radius_rad))) *
                   (light.WholeSun() * through.transmittance);
  for (std::size_t band = 0; band < disk.count; ++band) {
    disk[band] *= static_cast<float>(LimbDarkening(*rho, medium.wavelengths_nm[band]));
  }
  return disk;
}

/// Rotates a direction by Rodrigues' formula. @param turn  axis times angle.
glm::dvec3 Turned(const glm::dvec3& direction, const glm::dvec3& turn) {
  const double angle = glm::length(turn);
  if (angle == 0.0) return direction;
  const glm::dvec3 axis = turn / angle;
  return std::cos(angle) * direction + std::sin(angle) * glm::cross(axis, direction) +
         (1.0 - std::cos(angle)) * glm::dot(axis, direction) * axis;
}

/// Returns the mean radiance while the shutter is open.
double MeanMoonRadiance(const MoonDisk& moon, const glm::dvec3& turn, const glm::dvec3& direction) {
  const double angle = glm::length(turn);
  if (angle == 0.0) return MoonRadiance(moon, direction);
  const double chord = glm::length(direction - moon.to_moon);
  if (chord > 0.5 * angle + moon.radius_rad) return 0.0;
  // One step is a twentieth of the disk.
  const int steps = 1 + static_cast<int>(angle / (0.1 * moon.radius_rad));
  double sum = 0.0;
  for (int i = 0; i < steps; ++i)
    sum += MoonRadiance(moon, Turned(direction, (0.5 - (i + 0.5) / steps) * turn));
  return sum / steps;
}

/// Returns the radiance of the refracted moon (see RefractedSunDisk).
BandLight RefractedMoon(const glm::dvec3& direction, const AirAlongRay& through,
                        const Lighting& light, const RefractedViewRays& bent) {
  BandLight seen(light.irradiance.count);
  // Neither the refracted disk nor its trail is wider than the unrefracted one.
  const double widest = 2.0 * light.moon->radius_rad + glm::length(light.moon_turn);
  if (glm::length(direction - light.moon->to_moon) > widest) return seen;
  MoonDisk moon = *light.moon;
  moon.to_moon = bent.to_moon;
  const double elevation = bent.ElevationOf(direction);
  for (std::size_t band = 0; band < seen.count; ++band) {
    const double radiance =
        MeanMoonRadiance(moon, light.moon_turn, bent.TrueDirection(direction, band));
    const double left = std::exp(-bent.view.MoreOpticalDepth(elevation, band));
    seen[band] = static_cast<float>(radiance * left) * light.moon_colour[band] *
                 light.irradiance[band] * through.transmittance[band];
  }
  return seen;
}

/// Returns the radiance of the moon's disk in a direction, W m^-2 sr^-1 nm^-1, its mean while the
/// shutter is open; 0 beside it and during an eclipse of the sun.
BandLight MoonDiskRadiance(const FrameContext& frame, const glm::dvec3& direction,
                           const AirAlongRay& through) {
  const Lighting& light = frame.light();
  // During an eclipse, the earthshine of the moon would stand out, because the renderer has no
  // corona.
  if (!light.moon || light.eclipse) return BandLight(light.irradiance.count);
  if (frame.bent()) return RefractedMoon(direction, through, light, *frame.bent());
  const double radiance = MeanMoonRadiance(*light.moon, light.moon_turn, direction);
  if (radiance == 0.0) return BandLight(light.irradiance.count);
  return static_cast<float>(radiance) *
         (light.moon_colour * (light.irradiance * through.transmittance));
}

}  // namespace

Hit PixelShader::Trace(const CameraRay& ray, double expected_m) const {
  const RefractedViewRays* bent = frame_->bent();
  if (bent && bent->moves_ground) return OnRefractedRay(*frame_, ray, expected_m);
  return frame_->geometry().Trace(ray.origin, ray.direction, frame_->camera().PixelAngle());
}

std::optional<BandLight> PixelShader::LeftOfSpace(double x, double y) const {
  const CameraRay ray = frame_->camera().MiddleRay(x, y);
  const Hit hit = Trace(ray);
  if (hit.kind != HitKind::kSky) return std::nullopt;
  SharedSegmentAir air{hit.kind, hit.distance_m, ray.through, ray.through, hit.distance_m, 1};
  AddAir(*frame_, air);
  const BandLight left = UnmarchedFog(*frame_, ray.through, air.length_m()) * air.air.transmittance;
  return frame_->camera().HasPolariser() ? 0.5F * left : left;
}

PolarisedLight PixelShader::PolarisedGround(const Hit& hit, const CameraRay& ray,
                                            std::array<double, 2> disk_sample) const {
  const GroundLight& ground_light = frame_->model().ground_light;
  const PictureAxes axes = frame_->camera().AxesAt(ray.through);
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame_->light());
  std::optional<PolarisedLight> sum;
  for (const FrameLight& source : frame_->lights()) {
    if (!source.light.shows) continue;
    const PolarisedLight sent =
        ground_light.Polarised(seen, source.ground_sources(), axes, disk_sample);
    sum = sum ? *sum + sent : sent;
  }
  const std::size_t bands = frame_->scene().medium().wavelengths_nm.size();
  return sum.value_or(PolarisedLight{BandLight(bands), BandLight(bands)});
}

namespace {

/// Applies the camera's polariser.
Shaded Polarised(const CameraRays& camera, const glm::dvec3& direction,
                 const PolarisedLight& inscatter, Shaded shaded) {
  const std::optional<glm::dvec3> passed = camera.PassedBy(direction);
  if (!passed) return shaded;
  const Analyser analyser = AnalyserAlong(*passed, camera.AxesAt(direction));
  shaded.radiance = Passed(analyser, shaded.radiance, &*shaded.polarised);
  shaded.inscatter = Passed(analyser, shaded.inscatter, &inscatter);
  shaded.lamps = Passed(analyser, shaded.lamps, nullptr);
  shaded.volumes = Passed(analyser, shaded.volumes, nullptr);
  shaded.polarised = {analyser.q * shaded.radiance, analyser.u * shaded.radiance};
  return shaded;
}

}  // namespace

Shaded PixelShader::Shade(const Hit& hit, const SharedSegmentAir& through, const CameraRay& ray,
                          const LampTile& near, std::array<double, 2> disk_sample) const {
  Shaded shaded = WithoutPolariser(hit, through, ray, near, disk_sample);
  if (!frame_->IsPolarised()) return shaded;
  const PolarisedLight inscatter =
      (through.fog * frame_->light().irradiance) * *through.air.polarised;
  shaded.polarised = inscatter;
  if (hit.kind != HitKind::kSky) {
    shaded.polarised = inscatter + shaded.transmittance * PolarisedGround(hit, ray, disk_sample);
  }
  return Polarised(frame_->camera(), ray.through, inscatter, std::move(shaded));
}

Shaded PixelShader::WithoutPolariser(const Hit& hit, const SharedSegmentAir& through,
                                     const CameraRay& ray, const LampTile& near,
                                     std::array<double, 2> disk_sample) const {
  const FrameContext& frame = *frame_;
  const NightLight* night = frame.night();
  Shaded shaded;
  shaded.inscatter = through.fog * (frame_->light().irradiance * through.air.inscatter);
  shaded.transmittance = through.fog * through.air.transmittance;
  const bool has_air = frame.Has(hit.kind == HitKind::kSky ? Effect::kSky : Effect::kAerial);
  if (night && has_air) {
    const BandLight& scattered = night->scattered();
    for (std::size_t band = 0; band < scattered.count; ++band)
      shaded.inscatter[band] += (1.0F - shaded.transmittance[band]) * scattered[band];
  }
  shaded.albedo = BandLight(frame.scene().medium().wavelengths_nm.size());
  const auto left = [&](double distance_m) {
    return LeftByVolumes(through.pieces, distance_m, through.media.count);
  };
  shaded.lamps =
      through.lamp_light + frame.lamps().Seen(near.seen, ray, frame_->camera().PixelAngle(), left);
  shaded.volumes = through.media;
  shaded.radiance = shaded.inscatter + shaded.lamps + shaded.volumes;
  if (hit.kind == HitKind::kSky) {
    shaded.radiance =
        shaded.radiance + through.fog * (SunDiskRadiance(frame, ray.direction, through.air) +
                                         MoonDiskRadiance(frame, ray.direction, through.air));
    if (night)
      shaded.radiance = shaded.radiance + shaded.transmittance * night->Above(ray.direction);
  } else {
    AddGround(hit, ray, near, disk_sample, shaded);
  }
  return shaded;
}

void PixelShader::AddGround(const Hit& hit, const CameraRay& ray, const LampTile& near,
                            std::array<double, 2> disk_sample, Shaded& shaded) const {
  const GroundLight& ground_light = frame_->model().ground_light;
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame_->light());
  shaded.albedo = seen.albedo;
  BandLight natural(shaded.albedo.count);
  for (const FrameLight& source : frame_->lights()) {
    if (!source.light.shows) continue;
    const NaturalRadiance sent = ground_light.Natural(seen, source.ground_sources(), disk_sample);
    if (&source == &frame_->lights().front()) shaded.sun_visibility = sent.disk_visibility;
    natural = natural + sent.radiance;
  }
  if (const NightLight* night = frame_->night()) {
    const double cos_up = glm::dot(hit.normal, seen.up);
    natural = natural + static_cast<float>(1.0 / kPi) * (seen.albedo * night->OnSurface(cos_up));
  }
  const BandLight lamp_light = shaded.transmittance * ground_light.OfLamps(seen, near.surface);
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * natural;
}

}  // namespace alpenglow::renderer
