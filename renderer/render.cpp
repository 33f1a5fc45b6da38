// SPDX-License-Identifier: MIT
#include "renderer/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/constants.h"
#include "atmosphere/error.h"
#include "atmosphere/refraction.h"
#include "atmosphere/single_scattering.h"
#include "atmosphere/spectrum.h"
#include "atmosphere/sun_disk.h"
#include "lut/multiple_scattering.h"
#include "lut/program.h"
#include "renderer/aerial_perspective.h"
#include "renderer/band_light.h"
#include "renderer/camera_rays.h"
#include "renderer/ground_light.h"
#include "renderer/lamp_light.h"
#include "renderer/pixel_writer.h"
#include "renderer/scene_geometry.h"
#include "renderer/scene_ground.h"
#include "renderer/terrain_sunlight.h"

namespace alpenglow {
namespace {

/// The lamps that a pixel can see.
struct LampsHere {
  const LampPlan& plan;
  int x, y;
  double pixel_angle_rad;
  int nodes;

  [[nodiscard]] const LampTile& tile() const { return plan.At(x, y); }
};

/// Rays of a pixel that look through the same air, to the same place but for an edge's width.
struct SharedAir {
  HitKind kind;
  double first_distance_m;   // of the ray that began it
  glm::dvec3 direction_sum;  // of unit vectors
  double distance_sum_m;
  int rays;
  // Along the mean of their directions, to their mean distance:
  AirAlongRay air{};
  BandLight fog{};         // what fog leaves of light from the end
  BandLight lamp_light{};  // of lamps in the air, W m^-2 sr^-1 nm^-1

  [[nodiscard]] bool Takes(const Hit& hit) const {
    constexpr double kSameDistance = 0.01;
    if (hit.kind != kind) return false;
    return hit.kind == HitKind::kSky ||
           std::abs(hit.distance_m - first_distance_m) <= kSameDistance * first_distance_m;
  }
};

// A number in [0, 1) from pixel and dimension, the same on every machine: the finaliser of
// MurmurHash3 (Appleby).
double HashedUnit(std::uint32_t x, std::uint32_t y, std::uint32_t dimension) {
  std::uint32_t h = x * 0x9E3779B1U ^ y * 0x85EBCA77U ^ dimension * 0xC2B2AE3DU;
  h = (h ^ (h >> 16)) * 0x85EBCA6BU;
  h = (h ^ (h >> 13)) * 0xC2B2AE35U;
  return static_cast<double>(h ^ (h >> 16)) / 4294967296.0;
}

}  // namespace

struct SceneRenderer::State {
  explicit State(const Scene& of)
      : scene(of),
        ground(LoadGround(scene)),
        air(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
        diffuse(air.medium()),
        aerial(air, diffuse),
        colour(air.medium().wavelengths_nm),
        lamps(scene, ground, air.medium(), colour),
        eye(0.0, 0.0, ground.eye_height_m),
        // A mesh of a file is as its maker wants it; samples of elevation are not all there is.
        geometry(ground, air.medium(), scene.terrain.kind != TerrainSource::Kind::kMesh),
        ground_light(ground, geometry, air, diffuse, lamps) {}

  [[nodiscard]] AirAlongRay AirAlong(const SharedAir& rays, const Lighting& light,
                                     const TerrainSunlight& sunlight, int nodes) const;
  void AddLamps(SharedAir& rays, const LampsHere& near) const;
  [[nodiscard]] Shaded Shade(const Hit& hit, const SharedAir& through, const glm::dvec3& direction,
                             const Lighting& light, const LampsHere& near,
                             std::array<double, 2> disk_sample) const;
  [[nodiscard]] BandLight SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                  const Lighting& light) const;
  [[nodiscard]] Lighting LightingAt(const SunPosition& sun, const UtcInstant& instant) const {
    return LightingOf(sun, instant, scene.place.latitude_rad, air.medium());
  }
  [[nodiscard]] double Illuminance(const Lighting& light) const;  // see SceneRenderer
  [[nodiscard]] LampPlan PlanLamps(const CameraRays& camera, const Lighting& light,
                                   const RenderSettings& settings) const;

  Scene scene;
  SceneGround ground;
  AirIntegrator<float> air;
  DiffuseLight diffuse;
  AerialPerspective aerial;
  BandColour colour;
  LampLight lamps;
  glm::dvec3 eye;
  SceneGeometry geometry;
  GroundLight ground_light;
};

AirAlongRay SceneRenderer::State::AirAlong(const SharedAir& rays, const Lighting& light,
                                           const TerrainSunlight& sunlight, int nodes) const {
  const glm::dvec3 direction = glm::normalize(rays.direction_sum);
  const glm::dvec3 up = geometry.UpAt(eye);
  ViewRay ray{geometry.AltitudeOf(eye), std::clamp(glm::dot(direction, up), -1.0, 1.0),
              std::clamp(glm::dot(light.to_sun, up), -1.0, 1.0),
              std::clamp(glm::dot(direction, light.to_sun), -1.0, 1.0)};
  // The planet's own horizon ends the ray by itself; a length there would only add a rounding.
  if (rays.kind == HitKind::kTerrain) ray.length_m = rays.distance_sum_m / rays.rays;
  if (!sunlight.IsBroken()) return aerial.Along(ray, {.sky = nodes});
  const RayExtent extent = ExtentOf(ray, geometry.radius_m(), air.medium().atmosphere_height_m);
  const SunlitPath path = sunlight.Along(eye, direction, extent.end_m);
  return aerial.Along(ray, path, {.sky = nodes});
}

void SceneRenderer::State::AddLamps(SharedAir& rays, const LampsHere& near) const {
  const LampRayEnd end{glm::normalize(rays.direction_sum),
                       rays.kind == HitKind::kSky ? std::numeric_limits<double>::infinity()
                                                  : rays.distance_sum_m / rays.rays};
  rays.fog = lamps.FogTransmittance(end.direction, end.length_m);
  rays.lamp_light = lamps.InAir(near.plan, near.x, near.y, end, near.pixel_angle_rad, near.nodes);
}

BandLight SceneRenderer::State::SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                        const Lighting& light) const {
  // Angle from the chord: the arc cosine of a number near 1 has no digits left.
  const double chord = glm::length(direction - light.to_sun);
  const double rho = 2.0 * std::asin(std::min(0.5 * chord, 1.0)) / light.sun_radius_rad;
  if (rho >= 1.0) return BandLight(air.bands());
  const auto scale = static_cast<float>(LimbDarkening(rho) / DiskSolidAngle(light.sun_radius_rad));
  return scale * (light.irradiance * through.transmittance);
}

Shaded SceneRenderer::State::Shade(const Hit& hit, const SharedAir& through,
                                   const glm::dvec3& direction, const Lighting& light,
                                   const LampsHere& near, std::array<double, 2> disk_sample) const {
  Shaded shaded;
  shaded.hit = hit;
  shaded.inscatter = through.fog * (light.irradiance * through.air.inscatter);
  shaded.transmittance = through.fog * through.air.transmittance;
  shaded.albedo = BandLight(air.bands());
  shaded.lamps = through.lamp_light + lamps.Seen(near.tile().seen, direction, near.pixel_angle_rad);
  shaded.radiance = shaded.inscatter + shaded.lamps;
  if (hit.kind == HitKind::kSky) {
    shaded.radiance = shaded.radiance + through.fog * SunDisk(direction, through.air, light);
    return shaded;
  }
  const GroundRadiance sent = ground_light.Towards(hit, light, near.tile().surface, disk_sample);
  shaded.albedo = sent.albedo;
  shaded.sun_visibility = sent.sun_visibility;
  const BandLight lamp_light = shaded.transmittance * sent.lamps;
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * sent.natural;
  return shaded;
}

double SceneRenderer::State::Illuminance(const Lighting& light) const {
  const LocalSun sun = ground_light.LocalSunAt(eye, light);
  const auto direct = static_cast<float>(sun.visible_fraction * std::max(sun.mu_s_effective, 0.0));
  const BandLight irradiance =
      direct * air.TransmittanceToSpace(sun.altitude_m, sun.mu_s_effective) +
      diffuse.SkyIrradiance(sun.altitude_m, sun.mu_s);
  return colour.Xyz(InDouble(light.irradiance * irradiance))[1];
}

LampPlan SceneRenderer::State::PlanLamps(const CameraRays& camera, const Lighting& light,
                                         const RenderSettings& settings) const {
  // Lamps are too dim to see where all that are left out together change a grey card in daylight
  // by less than a thousandth.
  constexpr double kGreyCard = 0.18;
  LampSettings lamp_settings = settings.lamps;
  lamp_settings.floor_cd_per_m2 =
      std::max(lamp_settings.floor_cd_per_m2, 1e-3 * kGreyCard / kPi * Illuminance(light));
  return lamps.PlanFor(camera, settings.width, settings.height, lamp_settings,
                       [&](const glm::dvec3& direction) {
                         return geometry.Trace(eye, direction, camera.PixelAngle()).distance_m;
                       });
}

namespace {

/// A ray of a pixel and the air it looks through.
struct PixelRay {
  glm::dvec3 direction;
  Hit hit;
  std::size_t air;
};

// Which of the airs of a pixel a ray looks through; makes a new one if none.
std::size_t AirFor(const Hit& hit, const glm::dvec3& direction, std::vector<SharedAir>& airs) {
  auto known = std::find_if(airs.begin(), airs.end(),
                            [&](const SharedAir& shared) { return shared.Takes(hit); });
  if (known == airs.end())
    known = airs.insert(airs.end(), {hit.kind, hit.distance_m, glm::dvec3(0.0), 0.0, 0});
  known->direction_sum += direction;
  known->distance_sum_m += hit.distance_m;
  ++known->rays;
  return static_cast<std::size_t>(known - airs.begin());
}

void ValidateSettings(const RenderSettings& settings) {
  RequireInRange(settings.width, 1, 16384, "picture width");
  RequireInRange(settings.height, 1, 16384, "picture height");
  RequireInRange(settings.samples_per_pixel, 1, 1024, "samples per pixel");
  RequireInRange(settings.air_nodes, 2, 32, "air nodes");
}

}  // namespace

SceneRenderer::SceneRenderer(const Scene& scene) : state_(std::make_unique<State>(scene)) {}
SceneRenderer::~SceneRenderer() = default;

const Medium& SceneRenderer::medium() const { return state_->air.medium(); }
double SceneRenderer::eye_height_m() const { return state_->ground.eye_height_m; }
const std::string& SceneRenderer::terrain_message() const { return state_->ground.message; }

SunPosition SceneRenderer::ApparentSun(const UtcInstant& instant) const {
  GeodeticPosition eye = state_->scene.place;
  eye.height_m = state_->ground.eye_height_m;
  SunPosition sun = SunAt(eye, instant);
  sun.elevation_rad += RefractionFromHeight(sun.elevation_rad, eye.height_m);
  return sun;
}

double SceneRenderer::Illuminance(const UtcInstant& instant) const {
  return state_->Illuminance(state_->LightingAt(ApparentSun(instant), instant));
}

Image SceneRenderer::Render(const UtcInstant& instant, const RenderSettings& settings) const {
  ValidateSettings(settings);
  const Lighting light = state_->LightingAt(ApparentSun(instant), instant);
  const CameraRays camera(state_->scene.camera, settings.width, settings.height);
  PixelWriter writer(state_->colour, settings);
  const int grid = static_cast<int>(std::lround(std::sqrt(settings.samples_per_pixel)));
  const TerrainSunlight sunlight =
      settings.shafts ? TerrainSunlight(state_->ground, light.to_sun, light.sun_radius_rad)
                      : TerrainSunlight();
  const LampPlan plan = state_->PlanLamps(camera, light, settings);
  ThrowIfInterrupted();
  tbb::parallel_for(0, settings.height, [&](int y) {
    if (Interrupted()) return;
    std::vector<PixelRay> rays;
    std::vector<SharedAir> airs;
    std::vector<Shaded> shaded;
    for (int x = 0; x < settings.width; ++x) {
      rays.clear();
      airs.clear();
      shaded.clear();
      for (int s = 0; s < grid * grid; ++s) {
        const glm::dvec3 direction =
            camera.Direction(x + (s % grid + 0.5) / grid, y + (s / grid + 0.5) / grid);
        const Hit hit = state_->geometry.Trace(state_->eye, direction, camera.PixelAngle());
        rays.push_back({direction, hit, AirFor(hit, direction, airs)});
      }
      const LampsHere near{plan, x, y, camera.PixelAngle(), settings.lamps.nodes};
      for (SharedAir& shared : airs) {
        shared.air = state_->AirAlong(shared, light, sunlight, settings.air_nodes);
        state_->AddLamps(shared, near);
      }
      for (std::size_t s = 0; s < rays.size(); ++s) {
        const auto seed = [&](std::uint32_t dimension) {
          return HashedUnit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                            2U * static_cast<std::uint32_t>(s) + dimension);
        };
        shaded.push_back(state_->Shade(rays[s].hit, airs[rays[s].air], rays[s].direction, light,
                                       near, {seed(0), seed(1)}));
      }
      writer.Write(x, y, shaded);
    }
  });
  ThrowIfInterrupted();
  return writer.Take();
}

}  // namespace alpenglow
