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
#include "lut/night_vision.h"
#include "lut/program.h"
#include "renderer/aerial_perspective.h"
#include "renderer/camera_rays.h"
#include "renderer/lamp_light.h"
#include "renderer/scene_ground.h"
#include "renderer/surface.h"
#include "renderer/terrain_sunlight.h"

namespace alpenglow {
namespace {

using BandLight = Bands<float>;

BandLight operator+(const BandLight& a, const BandLight& b) {
  BandLight sum(a.count);
  for (std::size_t band = 0; band < a.count; ++band) sum[band] = a[band] + b[band];
  return sum;
}
BandLight operator*(const BandLight& a, const BandLight& b) {
  BandLight product(a.count);
  for (std::size_t band = 0; band < a.count; ++band) product[band] = a[band] * b[band];
  return product;
}
BandLight operator*(float scale, const BandLight& a) {
  BandLight product(a.count);
  for (std::size_t band = 0; band < a.count; ++band) product[band] = scale * a[band];
  return product;
}

/// The same light for the sums of colours.
class InDouble {
 public:
  explicit InDouble(const BandLight& light) : count_(light.count) {
    std::copy_n(light.value.begin(), count_, value_.begin());
  }
  operator std::span<const double>() const { return {value_.data(), count_}; }  // NOLINT: a view

 private:
  std::array<double, kMaxBands> value_{};
  std::size_t count_;
};

/// Light in the air and on surfaces for one position of the sun.
struct Lighting {
  glm::dvec3 to_sun;
  double sun_radius_rad;
  BandLight irradiance;     // of the sun above the air, W m^-2 nm^-1
  MountainSurface surface;  // as the season covers it
};

/// The lamps that a pixel can see.
struct LampsHere {
  const LampPlan& plan;
  int x, y;
  double pixel_angle_rad;
  int nodes;

  [[nodiscard]] const LampTile& tile() const { return plan.At(x, y); }
};

/// What a ray of the camera meets first.
enum class HitKind { kSky, kTerrain, kPlanet };
struct Hit {
  HitKind kind = HitKind::kSky;
  double distance_m = std::numeric_limits<double>::infinity();
  glm::dvec3 normal{0.0, 0.0, 1.0};       // with relief finer than the mesh
  glm::dvec3 mesh_normal{0.0, 0.0, 1.0};  // interpolated between vertices
  glm::dvec3 geometric_normal{0.0, 0.0, 1.0};
  glm::dvec3 point{0.0};
  double footprint_m = 0.0;  // width of a pixel there
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

/// One ray's contribution to a pixel.
struct Shaded {
  BandLight radiance;  // W m^-2 sr^-1 nm^-1
  BandLight inscatter, transmittance, albedo;
  BandLight lamps;  // of radiance, what comes from lamps
  Hit hit;
  float sun_visibility = 0.0F;
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

const std::vector<std::string>& KnownLayers() {
  static const std::vector<std::string> layers{"depth",     "normal",        "albedo",
                                               "inscatter", "transmittance", "sun_visibility",
                                               "lamps",     kScotopicLayer};
  return layers;
}

struct SceneRenderer::State {
  explicit State(const Scene& of)
      : scene(of),
        ground(LoadGround(scene)),
        air(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
        diffuse(air.medium()),
        aerial(air, diffuse),
        colour(air.medium().wavelengths_nm),
        lamps(scene, ground, air.medium(), colour) {}

  [[nodiscard]] double radius() const { return air.medium().planet_radius_m; }
  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const;
  [[nodiscard]] GroundPoint GroundAt(const glm::dvec3& point, double footprint_m) const;
  [[nodiscard]] bool HiddenByPlanet(const glm::dvec3& direction, double distance_m) const;
  [[nodiscard]] Hit Trace(const glm::dvec3& direction, double pixel_angle_rad) const;
  [[nodiscard]] AirAlongRay AirAlong(const SharedAir& rays, const Lighting& light,
                                     const TerrainSunlight& sunlight, int nodes) const;
  void AddLamps(SharedAir& rays, const LampsHere& near) const;
  [[nodiscard]] Shaded Shade(const Hit& hit, const SharedAir& through, const glm::dvec3& direction,
                             const Lighting& light, const LampsHere& near,
                             std::array<double, 2> disk_sample) const;
  [[nodiscard]] BandLight SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                  const Lighting& light) const;
  [[nodiscard]] Lighting LightingAt(const SunPosition& sun, const UtcInstant& instant) const;
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
};

// |p - c| - R with the centre c at (0, 0, -R), without cancelling.
double SceneRenderer::State::AltitudeOf(const glm::dvec3& point) const {
  const double r = radius();
  const double across = point.x * point.x + point.y * point.y;
  const double q = across + point.z * (2.0 * r + point.z);
  return q / (std::sqrt(across + (r + point.z) * (r + point.z)) + r);
}

glm::dvec3 SceneRenderer::State::UpAt(const glm::dvec3& point) const {
  return glm::normalize(point + glm::dvec3(0.0, 0.0, radius()));
}

GroundPoint SceneRenderer::State::GroundAt(const glm::dvec3& point, double footprint_m) const {
  const GeodeticPosition& origin = ground.frame.origin();
  return {origin.longitude_rad * std::cos(origin.latitude_rad) * radius() + point.x,
          origin.latitude_rad * radius() + point.y, std::max(AltitudeOf(point), 0.0), footprint_m};
}

// Whether the bare planet stands between the eye and terrain behind its horizon: the ray goes
// through it, comes out again before the terrain, and no terrain covers the planet there (a ray
// through a basin below the sphere is in free air).
bool SceneRenderer::State::HiddenByPlanet(const glm::dvec3& direction, double distance_m) const {
  if (direction.z >= 0.0) return false;
  const double deepest_m = -(radius() + ground.eye_height_m) * direction.z;
  const RayExtent extent = ExtentOf({ground.eye_height_m, direction.z, 1.0, direction.z}, radius(),
                                    air.medium().atmosphere_height_m);
  if (extent.end != RayEnd::kGround || 2.0 * deepest_m - extent.end_m > distance_m) return false;
  const glm::dvec3 inside = glm::dvec3(0.0, 0.0, ground.eye_height_m) + deepest_m * direction;
  constexpr double kAbove_m = 20000.0;
  const glm::dvec3 up = UpAt(inside);
  return !ground.terrain->Intersect(inside + kAbove_m * up, -up);
}

Hit SceneRenderer::State::Trace(const glm::dvec3& direction, double pixel_angle_rad) const {
  const glm::dvec3 eye(0.0, 0.0, ground.eye_height_m);
  if (ground.terrain) {
    const auto hit = ground.terrain->Intersect(eye, direction);
    if (hit && !HiddenByPlanet(direction, hit->distance_m)) {
      Hit found{HitKind::kTerrain,
                hit->distance_m,
                hit->normal,
                hit->normal,
                hit->geometric_normal,
                hit->smooth_point,
                hit->distance_m * pixel_angle_rad};
      // A mesh of a file is as its maker wants it; samples of elevation are not all there is.
      if (scene.terrain.kind != TerrainSource::Kind::kMesh) {
        found.normal =
            MountainSurface::DetailedNormal(GroundAt(found.point, found.footprint_m), found.normal);
      }
      return found;
    }
  }
  if (direction.z >= 0.0) return {};
  const RayExtent extent = ExtentOf({ground.eye_height_m, direction.z, 1.0, direction.z}, radius(),
                                    air.medium().atmosphere_height_m);
  if (extent.end != RayEnd::kGround) return {};
  const glm::dvec3 point = eye + extent.end_m * direction;
  const glm::dvec3 up = UpAt(point);
  return {HitKind::kPlanet, extent.end_m, up, up, up, point, extent.end_m * pixel_angle_rad};
}

AirAlongRay SceneRenderer::State::AirAlong(const SharedAir& rays, const Lighting& light,
                                           const TerrainSunlight& sunlight, int nodes) const {
  const glm::dvec3 direction = glm::normalize(rays.direction_sum);
  ViewRay ray{ground.eye_height_m, std::clamp(direction.z, -1.0, 1.0),
              std::clamp(light.to_sun.z, -1.0, 1.0),
              std::clamp(glm::dot(direction, light.to_sun), -1.0, 1.0)};
  // The planet's own horizon ends the ray by itself; a length there would only add a rounding.
  if (rays.kind == HitKind::kTerrain) ray.length_m = rays.distance_sum_m / rays.rays;
  if (!sunlight.IsBroken()) return aerial.Along(ray, {.sky = nodes});
  const RayExtent extent = ExtentOf(ray, radius(), air.medium().atmosphere_height_m);
  const SunlitPath path = sunlight.Along({0.0, 0.0, ground.eye_height_m}, direction, extent.end_m);
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
  const double altitude = std::max(AltitudeOf(hit.point), 0.0);
  const glm::dvec3 up = UpAt(hit.point);
  const double mu_s = std::clamp(glm::dot(up, light.to_sun), -1.0, 1.0);
  const double horizon = -std::sqrt(altitude * (2.0 * radius() + altitude)) / (radius() + altitude);
  const VisibleDisk disk = DiskOverHorizon(mu_s, horizon, light.sun_radius_rad);

  // A point of the disk, uniform in area, is tested against the terrain: penumbrae average over
  // rays.
  const glm::dvec3 side = glm::normalize(glm::cross(light.to_sun, glm::dvec3(0.3, -0.5, 0.8)));
  const double rho = light.sun_radius_rad * std::sqrt(disk_sample[0]);
  const double angle = 2.0 * kPi * disk_sample[1];
  const glm::dvec3 to_disk =
      glm::normalize(light.to_sun + rho * (std::cos(angle) * side +
                                           std::sin(angle) * glm::cross(light.to_sun, side)));
  const double cosine = glm::dot(hit.normal, to_disk);
  const bool faces =
      cosine > 0.0 && glm::dot(hit.geometric_normal, to_disk) > 0.0 && disk.fraction > 0.0;
  const bool occluded = faces && ground.terrain &&
                        ground.terrain->Occluded(hit.point, hit.geometric_normal, to_disk,
                                                 std::numeric_limits<double>::infinity());
  BandLight irradiance(air.bands());
  if (faces && !occluded) {
    shaded.sun_visibility = static_cast<float>(disk.fraction);
    irradiance = static_cast<float>(disk.fraction * cosine) *
                 air.TransmittanceToSpace(altitude, disk.mu_s_effective);
  }
  const glm::dvec3 flat_sun = light.to_sun - mu_s * up;
  const double normal_mu = std::clamp(glm::dot(hit.normal, up), -1.0, 1.0);
  const glm::dvec3 flat_normal = hit.normal - normal_mu * up;
  const double lengths = glm::length(flat_sun) * glm::length(flat_normal);
  const double azimuth =
      lengths > 1e-9 ? std::clamp(glm::dot(flat_sun, flat_normal) / lengths, -1.0, 1.0) : 1.0;
  irradiance = irradiance + diffuse.Irradiance(altitude, mu_s, normal_mu, azimuth);

  if (hit.kind == HitKind::kTerrain) {
    shaded.albedo =
        light.surface.Albedo(GroundAt(hit.point, hit.footprint_m), glm::dot(hit.mesh_normal, up));
  } else {
    for (std::size_t band = 0; band < air.bands(); ++band) {
      shaded.albedo[band] = static_cast<float>(air.medium().ground_albedo[band]);
    }
  }
  const BandLight towards_eye =
      static_cast<float>(1.0 / kPi) * (shaded.albedo * shaded.transmittance);
  const BandLight lamp_light =
      towards_eye *
      lamps.OnSurface(near.tile().surface, {hit.point, hit.normal, hit.geometric_normal});
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + towards_eye * (light.irradiance * irradiance);
  return shaded;
}

Lighting SceneRenderer::State::LightingAt(const SunPosition& sun, const UtcInstant& instant) const {
  const MountainCover cover = CoverInSeason(scene.place.latitude_rad, instant.modified_julian_day);
  Lighting light{DirectionFromAngles(sun.elevation_rad, sun.azimuth_rad).xyz,
                 sun.angular_radius_rad, BandLight(air.bands()),
                 MountainSurface(air.medium().wavelengths_nm, cover)};
  for (std::size_t band = 0; band < air.bands(); ++band) {
    light.irradiance[band] = static_cast<float>(air.medium().solar_irradiance[band] /
                                                (sun.distance_au * sun.distance_au));
  }
  return light;
}

double SceneRenderer::State::Illuminance(const Lighting& light) const {
  const double altitude = std::max(ground.eye_height_m, 0.0);
  const double mu_s = std::clamp(light.to_sun.z, -1.0, 1.0);
  const double horizon = -std::sqrt(altitude * (2.0 * radius() + altitude)) / (radius() + altitude);
  const VisibleDisk disk = DiskOverHorizon(mu_s, horizon, light.sun_radius_rad);
  const auto direct = static_cast<float>(disk.fraction * std::max(disk.mu_s_effective, 0.0));
  const BandLight irradiance = direct * air.TransmittanceToSpace(altitude, disk.mu_s_effective) +
                               diffuse.SkyIrradiance(altitude, mu_s);
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
                         return Trace(direction, camera.PixelAngle()).distance_m;
                       });
}

namespace {

/// Accumulates the rays of a pixel into the picture.
class PixelWriter {
 public:
  PixelWriter(const BandColour& colour, const RenderSettings& settings)
      : colour_(colour), image_(settings.width, settings.height) {
    for (const std::string& layer : settings.layers) {
      if (std::find(KnownLayers().begin(), KnownLayers().end(), layer) == KnownLayers().end()) {
        throw InputError(
            fmt::format("layer \"{}\" is not one of {}", layer, fmt::join(KnownLayers(), ", ")));
      }
      for (const std::string& channel : ChannelsOf(layer)) {
        image_.layers.push_back({channel, std::vector<float>(image_.rgb.size(), 0.0F)});
      }
      layers_.push_back(layer);
    }
  }

  // Not shared between pixels: rows may be written from any thread.
  void Write(int x, int y, const std::vector<Shaded>& rays) {
    const auto share = 1.0F / static_cast<float>(rays.size());
    BandLight radiance(rays.front().radiance.count);
    for (const Shaded& ray : rays) radiance = radiance + share * ray.radiance;
    image_.at(x, y) = Rgb(radiance);
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                              static_cast<std::size_t>(x);
    std::size_t channel = 0;
    for (const std::string& layer : layers_) {
      for (const float value : ValuesOf(layer, rays))
        image_.layers[channel++].values[pixel] = value;
    }
  }

  [[nodiscard]] Image Take() { return std::move(image_); }

 private:
  static std::vector<std::string> ChannelsOf(const std::string& layer) {
    if (layer == "depth") return {"depth.Z"};
    if (layer == "sun_visibility") return {"sun_visibility.Y"};
    if (layer == kScotopicLayer) return {kScotopicChannel};
    if (layer == "normal") return {"normal.X", "normal.Y", "normal.Z"};
    return {layer + ".R", layer + ".G", layer + ".B"};
  }

  [[nodiscard]] std::array<float, 3> Rgb(const BandLight& light) const {
    const auto rgb = colour_.LinearSrgb(InDouble(light));
    return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
  }

  // Colour of a factor (albedo, transmittance) as it looks under the sun above the air.
  [[nodiscard]] std::array<float, 3> RgbOfFactor(const BandLight& factor) const {
    BandLight sun(factor.count);
    for (std::size_t band = 0; band < factor.count; ++band) {
      sun[band] = static_cast<float>(SolarIrradiance(colour_.wavelengths_nm()[band]));
    }
    const auto white = Rgb(sun);
    const auto seen = Rgb(sun * factor);
    return {seen[0] / white[0], seen[1] / white[1], seen[2] / white[2]};
  }

  [[nodiscard]] std::vector<float> ValuesOf(const std::string& layer,
                                            const std::vector<Shaded>& rays) const {
    const auto share = 1.0F / static_cast<float>(rays.size());
    if (layer == "depth") return {static_cast<float>(rays.front().hit.distance_m)};
    if (layer == "normal") {
      const glm::dvec3 normal =
          rays.front().hit.kind == HitKind::kSky ? glm::dvec3(0.0) : rays.front().hit.normal;
      return {static_cast<float>(normal.x), static_cast<float>(normal.y),
              static_cast<float>(normal.z)};
    }
    if (layer == "sun_visibility") {
      float visible = 0.0F;
      for (const Shaded& ray : rays) visible += share * ray.sun_visibility;
      return {visible};
    }
    BandLight mean(rays.front().radiance.count);
    for (const Shaded& ray : rays) {
      mean = mean + share * (layer == "albedo"          ? ray.albedo
                             : layer == "transmittance" ? ray.transmittance
                             : layer == "lamps"         ? ray.lamps
                             : layer == kScotopicLayer  ? ray.radiance
                                                        : ray.inscatter);
    }
    if (layer == kScotopicLayer)
      return {static_cast<float>(colour_.ScotopicLuminance(InDouble(mean)))};
    const bool is_light = layer == "inscatter" || layer == "lamps";
    const auto rgb = is_light ? Rgb(mean) : RgbOfFactor(mean);
    return {rgb[0], rgb[1], rgb[2]};
  }

  const BandColour& colour_;
  Image image_;
  std::vector<std::string> layers_;
};

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
        const Hit hit = state_->Trace(direction, camera.PixelAngle());
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
