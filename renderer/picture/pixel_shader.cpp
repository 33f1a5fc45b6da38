// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_shader.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "renderer/material/band_light.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/ground_light.h"

namespace alpenglow::renderer {
namespace {

/// The straight ray along which the air in front of a hit is computed.
struct AirRay {
  glm::dvec3 direction;  // unit
  double length_m;
  bool ends_by_itself;  // at the planet or in space; the length would only add a rounding error
};

/// Most of the haze is below this height above the ground.
constexpr double kHaze_m = 3000.0;

/// Returns the elevation, at the ground, of the straight ray with nearly the columns of the
/// refracted ray that arrives there: the chord of the refracted ray up to kHaze_m. Compared with
/// columns along refracted rays, from 10 km up into space and down to 0.02 degrees below the
/// horizon, those of haze are within 3 % and those of molecules within 3 %; from 3 km within 4 %.
/// The chord up to the eye is off by 14 % (tests/renderer/picture/refraction_picture_test.cpp).
/// @param chord_rad  elevation of the eye, seen from the ground.
/// @param eye_rad  apparent elevation of the ground, seen from the eye.
double ElevationOfEqualAir(const BendingAir& air, double eye_height_m, double eye_rad,
                           double ground_height_m, double chord_rad) {
  const double arriving_rad = RefractedRay(air, eye_rad, eye_height_m).ElevationAt(ground_height_m);
  const double bends_per_m = -CurvaturePerMetreAt(air, ground_height_m + 0.5 * kHaze_m);
  const double sine = std::sin(arriving_rad);
  const double falls_per_m = 1.0 / (air.planet_radius_m + ground_height_m) - bends_per_m;
  const double length_m =
      2.0 * kHaze_m / (sine + std::sqrt(sine * sine + 2.0 * kHaze_m * falls_per_m));
  return std::max(chord_rad, arriving_rad - 0.5 * bends_per_m * std::cos(arriving_rad) * length_m);
}

/// Returns the straight ray from an eye to a height below it, in the vertical plane of `direction`,
/// that has an elevation seen from its end.
AirRay RayDownTo(const LimbView& limb, const glm::dvec3& direction, double ground_height_m,
                 double elevation_rad) {
  const double eye_m = limb.radius_m() + limb.altitude_m();
  const double end_m = limb.radius_m() + ground_height_m;
  const double fall_m = limb.altitude_m() - ground_height_m;
  const double rise_m = end_m * std::sin(elevation_rad);
  const double across = end_m * std::cos(elevation_rad) / eye_m;
  const double along_m = std::sqrt(fall_m * (eye_m + end_m) + rise_m * rise_m);
  const glm::dvec3 level = glm::normalize(direction - glm::dot(direction, limb.up()) * limb.up());
  return {across * level - along_m / eye_m * limb.up(),
          fall_m * (eye_m + end_m) / (along_m + rise_m), false};
}

AirRay Between(const AirRay& a, const AirRay& b, double share) {
  if (share == 1.0) return b;
  return {glm::normalize(a.direction + share * (b.direction - a.direction)),
          std::lerp(a.length_m, b.length_m, share), false};
}

/// Returns the ray through the air in front of rays. A refracted ray is replaced by a straight one
/// that ends at the same height. Where refraction does not move the planet in the picture, or
/// terrain is seen, this begins gradually from kHaze_m above the ground on.
AirRay AirRayOf(const FrameContext& frame, const SharedSegmentAir& rays) {
  const bool is_bent = frame.bent() && frame.bent()->moves_ground;
  AirRay seen{rays.Direction(), rays.length_m(),
              rays.kind == HitKind::kSky || (rays.kind == HitKind::kPlanet && !is_bent)};
  if (rays.kind == HitKind::kSky || !frame.Has(Effect::kRefraction)) return seen;
  const SceneGeometry& geometry = frame.scene().geometry();
  const LimbView& limb = frame.limb();
  const glm::dvec3 point = rays.point_sum / static_cast<double>(rays.rays);
  const glm::dvec3 to_point = point - frame.camera().eye();
  const double chord_m = glm::length(to_point);
  const glm::dvec3 chord = to_point / chord_m;
  const double ground_m = rays.kind == HitKind::kPlanet ? 0.0 : geometry.AltitudeOf(point);
  const double chord_rad = -std::asin(std::clamp(glm::dot(chord, geometry.UpAt(point)), -1.0, 1.0));
  const double eye_rad = std::asin(std::clamp(glm::dot(seen.direction, limb.up()), -1.0, 1.0));
  const bool is_bent_to_planet = is_bent && rays.kind == HitKind::kPlanet;
  const double share = is_bent_to_planet
                           ? 1.0
                           : std::clamp((limb.altitude_m() - ground_m) / kHaze_m - 1.0, 0.0, 1.0);
  if (share > 0.0 && chord_rad > 0.0 && eye_rad < 0.0) {
    const double equal_rad =
        ElevationOfEqualAir(limb.bending_air(), limb.altitude_m(), eye_rad, ground_m, chord_rad);
    if (equal_rad > chord_rad)
      return Between(seen, RayDownTo(limb, seen.direction, ground_m, equal_rad), share);
  }
  return is_bent_to_planet ? AirRay{chord, chord_m, false} : seen;
}

/// Air along a ray, with the effects of a picture.
class AirTo {
 public:
  AirTo(const FrameContext& frame, const FrameLight& source, HitKind kind, const AirRay& through)
      : frame_(frame),
        sunlight_(*source.shadows),
        is_lit_(source.light.shows),
        kind_(kind),
        direction_(through.direction),
        to_light_(source.light.source.direction.for_air),
        nu_seen_(std::clamp(glm::dot(direction_, source.light.source.direction.seen), -1.0, 1.0)),
        up_(frame.limb().up()) {
    const SceneGeometry& geometry = frame.scene().geometry();
    const glm::dvec3& from = frame.camera().eye();
    ray_ = {geometry.AltitudeOf(from), std::clamp(glm::dot(direction_, up_), -1.0, 1.0),
            std::clamp(glm::dot(to_light_, up_), -1.0, 1.0),
            std::clamp(glm::dot(direction_, to_light_), -1.0, 1.0)};
    if (!through.ends_by_itself) {
      ray_.length_m = through.length_m;
      ray_.passes_ground = true;  // terrain may lie below altitude 0
    }
    if (!sunlight_.IsBroken()) return;
    const RayExtent extent =
        ExtentOf(ray_, geometry.radius_m(), frame.scene().medium().atmosphere_height_m);
    path_ = sunlight_.Along(from, direction_, extent.end_m);
  }

  [[nodiscard]] const SunlitPath* sunlit() const { return sunlight_.IsBroken() ? &path_ : nullptr; }

  [[nodiscard]] AirAlongRay operator()(double length_m) const {
    const AirOverGround& in = frame_.over_ground();
    ViewRay ray = ray_;
    ray.length_m = std::min(ray.length_m, length_m);
    AirAlongRay none{BandLight(in.air.bands()), BandLight(in.air.bands())};
    if (frame_.IsPolarised()) none.polarised = {none.inscatter, none.inscatter};
    std::fill_n(none.transmittance.value.begin(), none.transmittance.count, 1.0F);
    if (kind_ != HitKind::kSky && !frame_.Has(Effect::kAerial)) return none;
    if (!is_lit_ || (kind_ == HitKind::kSky && !frame_.Has(Effect::kSky))) {
      none.transmittance = in.air.single_scattering().TransmittanceAlong(ray);
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
          InAxes(*air.polarised, direction_, up_, to_light_, frame_.camera().AxesAt(direction_));
    }
    return air;
  }

 private:
  const FrameContext& frame_;
  const TerrainSunlight& sunlight_;
  bool is_lit_;
  HitKind kind_;
  glm::dvec3 direction_, to_light_;
  double nu_seen_;
  glm::dvec3 up_;
  ViewRay ray_;
  SunlitPath path_;
};

}  // namespace

SharedSegmentAir SharedSegmentAir::Of(const Hit& hit, const glm::dvec3& direction,
                                      const FrameContext& frame) {
  SharedSegmentAir air{hit.kind,
                       hit.distance_m,
                       direction,
                       frame.limb().GroundCosine(direction),
                       hit.kind == HitKind::kSky && frame.limb().IsSteepAt(direction),
                       glm::dvec3(0.0),
                       glm::dvec3(0.0),
                       0.0,
                       0};
  air.Add(hit, direction);
  return air;
}

void SharedSegmentAir::Add(const Hit& hit, const glm::dvec3& direction) {
  direction_sum += direction;
  point_sum += hit.point;
  distance_sum_m += hit.distance_m;
  ++rays;
}

bool SharedSegmentAir::MayLookAlong(const glm::dvec3& direction, const FrameContext& frame) const {
  constexpr double kSameCosine = 0.02;
  if (kind == HitKind::kTerrain) return true;
  if (kind == HitKind::kSky) return !is_alone && !frame.limb().IsSteepAt(direction);
  return std::abs(frame.limb().GroundCosine(direction) - first_cosine) <=
         kSameCosine * first_cosine;
}

bool SharedSegmentAir::Takes(const Hit& hit, const glm::dvec3& direction, double widest_rad,
                             const FrameContext& frame) const {
  constexpr double kSameDistance = 0.01;
  if (hit.kind != kind || glm::length(direction - first_direction) > widest_rad) return false;
  return MayLookAlong(direction, frame) &&
         (kind == HitKind::kSky ||
          std::abs(hit.distance_m - first_distance_m) <= kSameDistance * first_distance_m);
}

std::size_t AirFor(const Hit& hit, const glm::dvec3& direction, const FrameContext& frame,
                   std::vector<SharedSegmentAir>& airs) {
  // Rays share air across the full width of a filter, and while the camera turns by so little that
  // the sky hardly changes.
  constexpr double kSameSky_rad = 0.01;
  const double widest_rad =
      3.0 * frame.filter().radius() * frame.camera().PixelAngle() + kSameSky_rad;
  auto known = std::find_if(airs.begin(), airs.end(), [&](const SharedSegmentAir& shared) {
    return frame.settings().share_air && shared.Takes(hit, direction, widest_rad, frame);
  });
  if (known == airs.end()) {
    airs.push_back(SharedSegmentAir::Of(hit, direction, frame));
    return airs.size() - 1;
  }
  known->Add(hit, direction);
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
               const AirRay& through, SharedSegmentAir& rays) {
  const AirTo air(frame, source, rays.kind, through);
  AirAlongRay lit = air(std::numeric_limits<double>::infinity());
  if (is_first) rays.media = BandLight(lit.inscatter.count);
  if (source.media) {
    MarchedLight marched = source.media->Along(frame.camera().eye(), through.direction,
                                               through.length_m, air.sunlit());
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
  const AirRay through = AirRayOf(frame, rays);
  bool is_first = true;
  for (const FrameLight& source : frame.lights()) {
    AddSource(frame, source, is_first, through, rays);
    is_first = false;
  }
}

BandLight UnmarchedLayers(const FrameContext& frame, const glm::dvec3& direction, double length_m) {
  const bool is_marched = frame.media() && frame.media()->media().HasLayers();
  return frame.lamps().LayerTransmittance(direction, is_marched ? 0.0 : length_m);
}

void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays) {
  const AirRay through = AirRayOf(frame, rays);
  rays.layers_left = UnmarchedLayers(frame, through.direction, through.length_m);
  rays.lamp_light = BandLight(rays.media.count);
  if (frame.plan().tiles.empty() || !frame.Has(Effect::kBeams)) return;
  const auto upto = [&](double length_m) {
    return frame.lamps().InAir(frame.plan(), x, y,
                               {through.direction, std::min(length_m, through.length_m)},
                               frame.camera().PixelAngle(), frame.settings().lamps.nodes);
  };
  rays.lamp_light = DimmedByMedia(rays.pieces, upto, upto(through.length_m), Behind::kBodies);
}

namespace {

/// Returns the angular distance of a direction from the centre of the sun, in solar radii; no value
/// outside the disk and where the moon covers it.
std::optional<double> PlaceOnSun(const glm::dvec3& direction, const glm::dvec3& to_sun,
                                 const glm::dvec3& to_moon, const Lighting& light) {
  // A chord is never longer than its arc.
  if (glm::length(direction - to_sun) >= light.source.radius_rad) return std::nullopt;
  const double rho = AngleBetween(direction, to_sun) / light.source.radius_rad;
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
  BandLight disk(light.source.irradiance.count);
  // The refracted disk is not wider than a circular one.
  if (glm::length(direction - light.source.direction.seen) > 2.0 * light.source.radius_rad)
    return disk;
  const double elevation = bent.ElevationOf(direction);
  const double per_sr = 1.0 / DiskSolidAngle(light.source.radius_rad);
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
  const glm::dvec3& to_moon = light.moon ? light.moon->direction.seen : light.source.direction.seen;
  const auto rho = PlaceOnSun(direction, light.source.direction.seen, to_moon, light);
  if (!rho) return BandLight(light.source.irradiance.count);
  BandLight disk = (1.0F / static_cast<float>(DiskSolidAngle(light.source.radius_rad))) *
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
  const double chord = glm::length(direction - moon.direction.seen);
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
  BandLight seen(light.source.irradiance.count);
  // Neither the refracted disk nor its trail is wider than the unrefracted one.
  const double widest = 2.0 * light.moon->radius_rad + glm::length(light.moon_turn);
  if (glm::length(direction - light.moon->direction.seen) > widest) return seen;
  MoonDisk moon = *light.moon;
  moon.direction.seen = bent.to_moon;
  const double elevation = bent.ElevationOf(direction);
  for (std::size_t band = 0; band < seen.count; ++band) {
    const double radiance =
        MeanMoonRadiance(moon, light.moon_turn, bent.TrueDirection(direction, band));
    const double left = std::exp(-bent.view.MoreOpticalDepth(elevation, band));
    seen[band] = static_cast<float>(radiance * left) * light.moon_colour[band] *
                 light.source.irradiance[band] * through.transmittance[band];
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
  if (!light.moon || light.eclipse) return BandLight(light.source.irradiance.count);
  if (frame.bent()) return RefractedMoon(direction, through, light, *frame.bent());
  const double radiance = MeanMoonRadiance(*light.moon, light.moon_turn, direction);
  if (radiance == 0.0) return BandLight(light.source.irradiance.count);
  return static_cast<float>(radiance) *
         (light.moon_colour * (light.source.irradiance * through.transmittance));
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
  SharedSegmentAir air = SharedSegmentAir::Of(hit, ray.through, *frame_);
  AddAir(*frame_, air);
  const BandLight left =
      UnmarchedLayers(*frame_, ray.through, air.length_m()) * air.air.transmittance;
  return frame_->camera().HasPolariser() ? 0.5F * left : left;
}

BandLight PixelShader::SunFrom(const glm::dvec3& direction) const {
  return DiskFrom(direction, SunDiskRadiance);
}

BandLight PixelShader::MoonFrom(const glm::dvec3& direction) const {
  return DiskFrom(direction, MoonDiskRadiance);
}

BandLight PixelShader::DiskFrom(const glm::dvec3& direction, DiskBehind disk) const {
  const BandLight none(frame_->scene().medium().wavelengths_nm.size());
  AirAlongRay clear{none, none};
  std::fill_n(clear.transmittance.value.begin(), none.count, 1.0F);
  const BandLight bare = disk(*frame_, direction, clear);
  if (std::all_of(bare.value.begin(), bare.value.begin() + static_cast<int>(bare.count),
                  [](float band) { return band <= 0.0F; }))
    return none;
  SharedSegmentAir air = SharedSegmentAir::Of(Hit{}, direction, *frame_);
  AddAir(*frame_, air);
  const BandLight left = UnmarchedLayers(*frame_, direction, air.length_m()) * bare;
  return (frame_->camera().HasPolariser() ? 0.5F : 1.0F) * (air.air.transmittance * left);
}

PolarisedLight PixelShader::PolarisedGround(const Hit& hit, const CameraRay& ray,
                                            std::array<double, 2> disk_sample) const {
  const GroundLight& ground_light = frame_->over_ground().ground_light;
  const ViewAxes axes = frame_->camera().AxesAt(ray.through);
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
      (through.layers_left * frame_->light().source.irradiance) * *through.air.polarised;
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
  const NightLight* night = frame.sky_lights().night.get();
  Shaded shaded;
  shaded.inscatter =
      through.layers_left * (frame_->light().source.irradiance * through.air.inscatter);
  shaded.transmittance = through.layers_left * through.air.transmittance;
  const bool has_air = frame.Has(hit.kind == HitKind::kSky ? Effect::kSky : Effect::kAerial);
  if (night && has_air) {
    const BandLight& scattered = night->scattered();
    for (std::size_t band = 0; band < scattered.count; ++band)
      shaded.inscatter[band] += (1.0F - shaded.transmittance[band]) * scattered[band];
  }
  shaded.albedo = BandLight(frame.scene().medium().wavelengths_nm.size());
  const auto left = [&](double distance_m) {
    return LeftByBodies(through.pieces, distance_m, through.media.count);
  };
  shaded.lamps =
      through.lamp_light + frame.lamps().Seen(near.seen, ray, frame_->camera().PixelAngle(), left);
  shaded.volumes = through.media;
  shaded.radiance = shaded.inscatter + shaded.lamps + shaded.volumes;
  if (hit.kind == HitKind::kSky) {
    if (!frame.sky_lights().small_sun)
      shaded.radiance = shaded.radiance +
                        through.layers_left * SunDiskRadiance(frame, ray.direction, through.air);
    if (!frame.sky_lights().small_moon)
      shaded.radiance = shaded.radiance +
                        through.layers_left * MoonDiskRadiance(frame, ray.direction, through.air);
    if (night)
      shaded.radiance = shaded.radiance + shaded.transmittance * night->Above(ray.direction);
  } else {
    AddGround(hit, ray, near, disk_sample, shaded);
  }
  return shaded;
}

void PixelShader::AddGround(const Hit& hit, const CameraRay& ray, const LampTile& near,
                            std::array<double, 2> disk_sample, Shaded& shaded) const {
  const GroundLight& ground_light = frame_->over_ground().ground_light;
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame_->light());
  shaded.albedo = seen.albedo;
  BandLight natural(shaded.albedo.count);
  for (const FrameLight& source : frame_->lights()) {
    if (!source.light.shows) continue;
    const NaturalRadiance sent = ground_light.Natural(seen, source.ground_sources(), disk_sample);
    if (&source == &frame_->lights().front()) shaded.sun_visibility = sent.disk_visibility;
    natural = natural + sent.radiance;
  }
  if (const NightLight* night = frame_->sky_lights().night.get()) {
    const double cos_up = glm::dot(hit.normal, seen.up);
    natural = natural + static_cast<float>(1.0 / kPi) * (seen.albedo * night->OnSurface(cos_up));
  }
  const BandLight lamp_light = shaded.transmittance * ground_light.OfLamps(seen, near.surface);
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * natural;
}

}  // namespace alpenglow::renderer
