// SPDX-License-Identifier: MIT
#include "renderer/picture/shared_segment_air.h"
#include "renderer/illumination/polarised_axes.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
        is_broken_(source.shadows->IsBroken() || source.cloud_shadow() != nullptr),
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
    if (source.clouds && frame.Has(Effect::kCloudGlow))
      diffuse_ = source.clouds->DiffuseInAir(from, direction_);
    if (!is_broken_) return;
    const RayExtent extent =
        ExtentOf(ray_, geometry.radius_m(), frame.scene().medium().atmosphere_height_m);
    path_ = source.shadows->Along(from, direction_, extent.end_m);
    if (const CloudShadow* shadow = source.cloud_shadow())
      path_ = shadow->OnRay(path_, from, direction_);
  }

  [[nodiscard]] const SunlitPath* sunlit() const { return is_broken_ ? &path_ : nullptr; }

  [[nodiscard]] AirAlongRay operator()(double length_m) const {
    const AirOverGround& in = frame_.over_ground();
    ViewRay ray = ray_;
    ray.length_m = std::min(ray.length_m, length_m);
    AirAlongRay none{Spectrum(in.air.bands()), Spectrum(in.air.bands())};
    if (frame_.IsPolarised()) none.polarised = {none.inscatter, none.inscatter};
    std::ranges::fill(none.transmittance.values(), 1.0F);
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
        .nu_seen = nu_seen_,
        .diffuse = diffuse_};
    AirAlongRay air =
        is_broken_ ? in.aerial.Along(ray, path_, sampling) : in.aerial.Along(ray, sampling);
    if (air.polarised) {
      air.polarised =
          InAxes(*air.polarised, direction_, up_, to_light_, frame_.camera().AxesAt(direction_));
    }
    return air;
  }

 private:
  const FrameContext& frame_;
  bool is_broken_;  // terrain or clouds may shade the ray
  bool is_lit_;
  HitKind kind_;
  glm::dvec3 direction_, to_light_;
  double nu_seen_;
  glm::dvec3 up_;
  ViewRay ray_;
  SunlitPath path_;
  std::vector<DiffuseStretch> diffuse_;
};

/// Returns the light of the air that arrives through media.
/// @param air  returns the light of the air up to a distance.
template <typename Air>
AirAlongRay ThroughMedia(const std::vector<MarchedPiece>& pieces, const Air& air,
                         const AirAlongRay& whole) {
  AirAlongRay left = whole;
  left.inscatter = DimmedByMedia(
      pieces, [&](double m) { return air(m).inscatter; }, whole.inscatter, Behind::kAll);
  if (!whole.polarised) return left;
  // Q and U can fall with distance, but the light behind an analyser, I + Q and I + U, increases.
  const auto dimmed = [&](Spectrum PolarisedLight::*part) {
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

/// Returns the transmittance of media over a distance; within pieces the optical depth is linear.
Spectrum LeftByMedia(const std::vector<MarchedPiece>& pieces, double distance_m,
                     std::size_t bands) {
  Spectrum left(bands);
  std::ranges::fill(left.values(), 1.0F);
  for (const MarchedPiece& piece : pieces) {
    if (piece.begin_m >= distance_m) break;
    const auto share = static_cast<float>(
        std::min((distance_m - piece.begin_m) / (piece.end_m - piece.begin_m), 1.0));
    for (std::size_t band = 0; band < bands; ++band) {
      if (left[band] > 0.0F) left[band] *= std::pow(piece.transmittance[band] / left[band], share);
    }
  }
  return left;
}

/// Returns the fraction of the light of narrow sources behind media to that of wide ones.
Spectrum NarrowLeft(const MarchedLight& marched) {
  Spectrum left = marched.narrow_transmittance;
  for (std::size_t band = 0; band < left.size(); ++band) {
    const float wide = marched.transmittance[band];
    left[band] = wide > 0.0F ? left[band] / wide : 1.0F;
  }
  return left;
}

/// Returns air in media and behind them.
/// @param whole  the air alone, up to the end of the ray.
AirAlongRay BehindMedia(const MarchedLight& media, const AirTo& air, const AirAlongRay& whole) {
  AirAlongRay left = ThroughMedia(media.pieces, air, whole);
  left.transmittance = left.transmittance * media.transmittance;
  return left;
}

/// Puts the air behind clouds. Returns the light of the clouds, per unit solar irradiance [1/sr].
/// @param media  up to each screen; empty: there are none. @param lit  the whole air, behind media.
Spectrum AddClouds(const CloudsOnRay& clouds, const std::vector<MarchedLight>& media,
                   const AirTo& air, AirAlongRay& lit) {
  Spectrum light(lit.inscatter.size());
  std::vector<AirAlongRay> reached;
  float left = 1.0F;
  for (const CloudScreen& screen : clouds.screens) {
    const AirAlongRay upto = air(screen.distance_m);
    reached.push_back(media.empty() ? upto : BehindMedia(media[reached.size()], air, upto));
    light = light + left * (reached.back().transmittance * screen.radiance);
    left *= screen.transmittance;
  }
  const auto dimmed = [&](const auto& part) {
    std::size_t next = 0;
    return clouds.Dimmed(part(lit), [&](double) { return part(reached[next++]); });
  };
  lit.inscatter = dimmed([](const AirAlongRay& of) { return of.inscatter; });
  if (lit.polarised) {
    lit.polarised = {dimmed([](const AirAlongRay& of) { return of.polarised->q; }),
                     dimmed([](const AirAlongRay& of) { return of.polarised->u; })};
  }
  lit.transmittance = left * lit.transmittance;
  return light;
}

/// Adds the light of one source in air and media. The first source also determines the
/// transmittance and the pieces of media.
void AddSource(const FrameContext& frame, const FrameLight& source, bool is_first,
               const AirRay& through, SharedSegmentAir& rays) {
  const glm::dvec3& eye = frame.camera().eye();
  const AirTo air(frame, source, rays.kind, through);
  AirAlongRay lit = air(std::numeric_limits<double>::infinity());
  if (is_first) rays.media = rays.cloud_light = Spectrum(lit.inscatter.size());
  MarchedLight marched;
  if (source.media) {
    marched = source.media->Along(eye, through.direction, through.length_m, air.sunlit());
    lit = BehindMedia(marched, air, lit);
    if (is_first) rays.narrow_left = NarrowLeft(marched);
  }
  CloudsOnRay clouds;
  if (source.clouds) {
    clouds = source.clouds->Along(eye, through.direction, through.length_m);
    std::vector<MarchedLight> upto;
    if (source.media) {
      marched.radiance = clouds.Dimmed(marched.radiance, [&](double distance_m) {
        upto.push_back(source.media->Along(eye, through.direction, distance_m, air.sunlit()));
        return upto.back().radiance;
      });
    }
    rays.cloud_light =
        rays.cloud_light + source.light.source.irradiance * AddClouds(clouds, upto, air, lit);
  }
  if (source.media) rays.media = rays.media + marched.radiance;
  if (is_first) {
    rays.air = std::move(lit);
    rays.pieces = std::move(marched.pieces);
    rays.clouds = std::move(clouds);
    return;
  }
  rays.air.inscatter = rays.air.inscatter + source.by_sun * lit.inscatter;
  if (lit.polarised) rays.air.polarised = *rays.air.polarised + source.by_sun * *lit.polarised;
}

/// Returns the transmittance of air and media up to a distance.
Spectrum LeftByAir(const FrameContext& frame, const AirRay& through, const SharedSegmentAir& rays,
                   double distance_m) {
  ViewRay ray{frame.scene().geometry().AltitudeOf(frame.camera().eye()),
              std::clamp(glm::dot(through.direction, frame.limb().up()), -1.0, 1.0), 1.0, 0.0};
  ray.length_m = distance_m;
  return LeftByMedia(rays.pieces, distance_m, rays.media.size()) *
         frame.over_ground().air.single_scattering().TransmittanceAlong(ray);
}

/// Returns the light of lamps that clouds scatter to the eye [W m^-2 sr^-1 nm^-1].
Spectrum CloudsByLamps(const FrameContext& frame, const AirRay& through,
                       const SharedSegmentAir& rays) {
  return LampsOnClouds(
      rays.clouds, frame.lamps(), frame.scene().geometry(), frame.camera().eye(), through.direction,
      [&](double distance_m) { return LeftByAir(frame, through, rays, distance_m); });
}

/// Returns the light of the night that air and clouds scatter to the eye [W m^-2 sr^-1 nm^-1].
Spectrum NightOf(const FrameContext& frame, const AirRay& through, const SharedSegmentAir& rays) {
  const Spectrum none(rays.media.size());
  const NightLight* night = frame.sky_lights().night.get();
  const bool has_air = frame.Has(rays.kind == HitKind::kSky ? Effect::kSky : Effect::kAerial);
  if (night == nullptr || !has_air) return none;
  const NightScattered light{night->scattered(), frame.scene().towns().value_or(none)};
  const auto left = [&](double distance_m) { return LeftByAir(frame, through, rays, distance_m); };
  const Spectrum behind = NightAlong(rays.clouds, light, rays.air.transmittance, left);
  // Layers that only lamps light lie before the clouds.
  return light.all + rays.layers_left * (behind + -1.0F * light.all);
}

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
  air.narrow_left = Spectrum(frame.scene().medium().wavelengths_nm.size());
  std::ranges::fill(air.narrow_left.values(), 1.0F);
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
  if (kind == HitKind::kTerrain || kind == HitKind::kSphere) return true;
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

void AddAir(const FrameContext& frame, SharedSegmentAir& rays) {
  const AirRay through = AirRayOf(frame, rays);
  bool is_first = true;
  for (const FrameLight& source : frame.lights()) {
    AddSource(frame, source, is_first, through, rays);
    is_first = false;
  }
}

Spectrum UnmarchedLayers(const FrameContext& frame, const glm::dvec3& direction, double length_m) {
  const bool is_marched = frame.media() && frame.media()->media().HasLayers();
  return frame.lamps().LayerTransmittance(direction, is_marched ? 0.0 : length_m);
}

void AddLamps(const FrameContext& frame, int x, int y, SharedSegmentAir& rays) {
  const AirRay through = AirRayOf(frame, rays);
  rays.layers_left = UnmarchedLayers(frame, through.direction, through.length_m);
  rays.lamp_light = Spectrum(rays.media.size());
  rays.night = NightOf(frame, through, rays);
  if (frame.plan().tiles.empty()) return;
  if (frame.Has(Effect::kCloudGlow)) rays.lamp_light = CloudsByLamps(frame, through, rays);
  if (!frame.Has(Effect::kBeams)) return;
  const auto upto = [&](double length_m) {
    return frame.lamps().InAir(frame.plan(), x, y,
                               {through.direction, std::min(length_m, through.length_m)},
                               frame.camera().PixelAngle(), frame.settings().lamps.nodes);
  };
  const auto behind_bodies = [&](double length_m) {
    return DimmedByMedia(
        rays.pieces, [&](double m) { return upto(std::min(m, length_m)); }, upto(length_m),
        Behind::kBodies);
  };
  rays.lamp_light =
      rays.lamp_light + rays.clouds.Dimmed(behind_bodies(through.length_m), behind_bodies);
}

}  // namespace alpenglow::renderer
