// SPDX-License-Identifier: MIT
#include "renderer/picture/shared_air.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/light/picture_stokes.h"

namespace alpenglow::renderer {
namespace {

/// The air along a ray as the effects of a picture have it.
class AirTo {
 public:
  AirTo(const PictureFrame& frame, const SceneGeometry& geometry, const Medium& medium,
        const SharedAir& rays, const glm::dvec3& direction, const Lighting& light,
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
    // The planet's own horizon ends a straight ray by itself, where a length would only add a
    // rounding. Bent rays see the planet over that horizon too.
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
  const PictureFrame& frame_;
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

bool SharedAir::Takes(const Hit& hit, const glm::dvec3& direction, double widest_rad) const {
  constexpr double kSameDistance = 0.01;
  if (hit.kind != kind || glm::length(direction - first_direction) > widest_rad) return false;
  return kind == HitKind::kSky ||
         std::abs(hit.distance_m - first_distance_m) <= kSameDistance * first_distance_m;
}

std::size_t AirFor(const Hit& hit, const glm::dvec3& direction, const PictureFrame& frame,
                   std::vector<SharedAir>& airs) {
  // All of a filter's width, and as far as the sky hardly bends where a camera turns.
  constexpr double kSameSky_rad = 0.01;
  const double widest_rad =
      3.0 * frame.filter.radius() * frame.camera().PixelAngle() + kSameSky_rad;
  auto known = std::find_if(airs.begin(), airs.end(), [&](const SharedAir& shared) {
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

/// What of the light of the air arrives through media.
AirAlongRay ThroughMedia(const std::vector<MarchedPiece>& pieces, const AirTo& air,
                         const AirAlongRay& whole) {
  AirAlongRay left = whole;
  left.inscatter = DimmedByMedia(
      pieces, [&](double m) { return air(m).inscatter; }, whole.inscatter, Behind::kAll);
  if (!whole.polarised) return left;
  // Q and U may fall with distance; what an analyser passes, I + Q and I + U, rises.
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

/// Of a second light, in air and media. After the sun's.
void AddSecondLight(const PictureFrame& frame, const SecondLight& second,
                    const SceneGeometry& geometry, const Medium& medium,
                    const glm::dvec3& direction, SharedAir& rays) {
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

void AddAir(const PictureFrame& frame, const SceneGeometry& geometry, const Medium& medium,
            SharedAir& rays) {
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

void AddLamps(const PictureFrame& frame, int x, int y, SharedAir& rays) {
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
