// SPDX-License-Identifier: MIT
#include "renderer/picture/segment_air.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "renderer/material/band_light.h"
#include "renderer/picture/frame_context.h"

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

}  // namespace alpenglow::renderer
