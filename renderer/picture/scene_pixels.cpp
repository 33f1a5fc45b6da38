// SPDX-License-Identifier: MIT
// Pixels of a scene: their rays, the surfaces that these meet, and the air in front of the surfaces.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/pixel_light.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/picture/sky_pixels.h"

namespace alpenglow::renderer {
namespace {

/// A square of pixels within a picture, processed by one thread.
struct Tile {
  static constexpr int kSide = 64;
  int x0, y0, x1, y1;

  [[nodiscard]] bool Has(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>((y - y0) * (x1 - x0) + x - x0);
  }
  [[nodiscard]] std::size_t Size() const { return Index(x0, y1); }

  /// Calls visit(x, y) row by row.
  template <typename See>
  void Visit(const See& visit) const {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) visit(x, y);
    }
  }
  /// Calls visit(index) for each of up to eight neighbours.
  template <typename See>
  void VisitNeighbours(int x, int y, const See& visit) const {
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if ((u != x || v != y) && Has(u, v)) visit(Index(u, v));
      }
    }
  }
};

/// Returns the mean of the relative variances of a pixel's neighbours; its own if it has no neighbours.
double VarianceAround(const std::vector<double>& variances, const Tile& tile, int x, int y) {
  double sum = 0.0;
  int neighbours = 0;
  tile.VisitNeighbours(x, y, [&](std::size_t at) {
    sum += variances[at];
    ++neighbours;
  });
  return neighbours > 0 ? sum / neighbours : variances[tile.Index(x, y)];
}

/// Returns the relative variance over the rays of all neighbours of a pixel, pooled as if they
/// belonged to one pixel.
double VarianceAmong(const std::vector<RaySpread>& spreads, const Tile& tile, int x, int y,
                     double floor) {
  RaySpread all;
  tile.VisitNeighbours(x, y, [&](std::size_t at) { all.Add(spreads[at]); });
  return all.RelativeVariance(floor);
}

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

}  // namespace

BandLight PreparedScene::SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                                 const FrameContext& frame) const {
  const Lighting& light = frame.light;
  if (frame.bent) return RefractedSunDisk(direction, through, light, *frame.bent, medium);
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

namespace {

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

}  // namespace

BandLight PreparedScene::MoonSeen(const glm::dvec3& direction, const AirAlongRay& through,
                                  const FrameContext& frame) const {
  const Lighting& light = frame.light;
  // During an eclipse, the earthshine of the moon would stand out, because the renderer has no corona.
  if (!light.moon || light.eclipse) return BandLight(light.irradiance.count);
  if (frame.bent) return RefractedMoon(direction, through, light, *frame.bent);
  const double radiance = MeanMoonRadiance(*light.moon, light.moon_turn, direction);
  if (radiance == 0.0) return BandLight(light.irradiance.count);
  return static_cast<float>(radiance) *
         (light.moon_colour * (light.irradiance * through.transmittance));
}

PixelSum PreparedScene::WithStars(const FrameContext& frame, int x, int y, PixelSum rays) {
  const BandLight* star = frame.stars ? frame.stars->At(x, y) : nullptr;
  if (star != nullptr) rays.radiance = rays.radiance + static_cast<float>(rays.rays) * *star;
  return rays;
}

PolarisedLight PreparedScene::PolarisedGround(const Hit& hit, const CameraRay& ray,
                                              const FrameContext& frame,
                                              std::array<double, 2> disk_sample) const {
  const GroundLight& ground_light = frame.model->ground_light;
  const PictureAxes axes = frame.camera().AxesAt(ray.through);
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame.light);
  PolarisedLight sum{BandLight(medium.wavelengths_nm.size()),
                     BandLight(medium.wavelengths_nm.size())};
  if (frame.light.shows)
    sum = ground_light.Polarised(seen, frame.ground_sources(), axes, disk_sample);
  if (!frame.moonlit) return sum;
  return sum + ground_light.Polarised(seen, frame.moonlit->ground_sources(), axes, disk_sample);
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

Shaded PreparedScene::Shade(const Hit& hit, const SharedSegmentAir& through, const CameraRay& ray,
                            const FrameContext& frame, const LampTile& near,
                            std::array<double, 2> disk_sample) const {
  Shaded shaded = ShadedWithoutPolariser(hit, through, ray, frame, near, disk_sample);
  if (!frame.polarised) return shaded;
  const PolarisedLight inscatter = (through.fog * frame.light.irradiance) * *through.air.polarised;
  shaded.polarised = inscatter;
  if (hit.kind != HitKind::kSky) {
    shaded.polarised =
        inscatter + shaded.transmittance * PolarisedGround(hit, ray, frame, disk_sample);
  }
  return Polarised(frame.camera(), ray.through, inscatter, std::move(shaded));
}

Shaded PreparedScene::ShadedWithoutPolariser(const Hit& hit, const SharedSegmentAir& through,
                                             const CameraRay& ray, const FrameContext& frame,
                                             const LampTile& near,
                                             std::array<double, 2> disk_sample) const {
  Shaded shaded;
  shaded.inscatter = through.fog * (frame.light.irradiance * through.air.inscatter);
  shaded.transmittance = through.fog * through.air.transmittance;
  const bool has_air = frame.Has(hit.kind == HitKind::kSky ? Effect::kSky : Effect::kAerial);
  if (frame.night && has_air) {
    const BandLight& scattered = frame.night->scattered();
    for (std::size_t band = 0; band < scattered.count; ++band)
      shaded.inscatter[band] += (1.0F - shaded.transmittance[band]) * scattered[band];
  }
  shaded.albedo = BandLight(medium.wavelengths_nm.size());
  const auto left = [&](double distance_m) {
    return LeftByVolumes(through.pieces, distance_m, through.media.count);
  };
  shaded.lamps =
      through.lamp_light + frame.lamps->Seen(near.seen, ray, frame.camera().PixelAngle(), left);
  shaded.volumes = through.media;
  shaded.radiance = shaded.inscatter + shaded.lamps + shaded.volumes;
  if (hit.kind == HitKind::kSky) {
    shaded.radiance = shaded.radiance + through.fog * (SunDisk(ray.direction, through.air, frame) +
                                                       MoonSeen(ray.direction, through.air, frame));
    if (frame.night) {
      shaded.radiance = shaded.radiance + shaded.transmittance * frame.night->Above(ray.direction);
    }
    return shaded;
  }
  const GroundLight& ground_light = frame.model->ground_light;
  const SeenGround seen = ground_light.SeenFrom(hit, -ray.direction, frame.light);
  shaded.albedo = seen.albedo;
  BandLight natural(shaded.albedo.count);
  if (frame.light.shows) {
    const NaturalRadiance sent = ground_light.Natural(seen, frame.ground_sources(), disk_sample);
    shaded.sun_visibility = sent.disk_visibility;
    natural = sent.radiance;
  }
  if (frame.moonlit) {
    natural =
        natural + ground_light.Natural(seen, frame.moonlit->ground_sources(), disk_sample).radiance;
  }
  if (frame.night) {
    const double cos_up = glm::dot(hit.normal, seen.up);
    natural =
        natural + static_cast<float>(1.0 / kPi) * (seen.albedo * frame.night->OnSurface(cos_up));
  }
  const BandLight lamp_light = shaded.transmittance * ground_light.OfLamps(seen, near.surface);
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * natural;
  return shaded;
}

Image PreparedScene::Pixels(const FrameContext& frame,
                            const std::vector<PixelPlace>& places) const {
  const int count = static_cast<int>(places.size());
  const int rays = frame.settings.samples_per_pixel;
  PixelWriter writer(colour, count, 1, {});
  tbb::parallel_for(0, count, [&](int i) {
    const PixelPlace& at = places[static_cast<std::size_t>(i)];
    if (Interrupted()) return;
    PixelLight pixel(*this, frame, at.x, at.y, rays);
    pixel.TakeUpTo(rays);
    writer.Write(i, 0, WithStars(frame, at.x, at.y, pixel.sum()));
  });
  ThrowIfInterrupted();
  return writer.Take();
}

CountedPicture PreparedScene::Picture(const FrameContext& frame) const {
  PixelWriter writer(colour, frame.settings.width, frame.settings.height, frame.settings.layers);
  ThrowIfInterrupted();
  if (frame.settings.noise) {
    AddTiles(frame, writer);
  } else {
    AddRows(frame, writer);
  }
  ThrowIfInterrupted();
  if (frame.settings.stop.stop_requested()) throw RenderingStopped();
  return {writer.Take(), writer.rays()};
}

void PreparedScene::AddRows(const FrameContext& frame, PixelWriter& writer) const {
  const int rays = frame.settings.samples_per_pixel;
  std::atomic<int> rows{0};
  tbb::parallel_for(0, frame.settings.height, [&](int y) {
    for (int x = 0; x < frame.settings.width; ++x) {
      if (Interrupted() || frame.settings.stop.stop_requested()) return;
      PixelLight pixel(*this, frame, x, y, rays);
      pixel.TakeUpTo(rays);
      Write(frame, x, y, pixel, writer);
    }
    if (frame.settings.progress != nullptr)
      frame.settings.progress->Part(static_cast<double>(++rows) / frame.settings.height);
  });
}

double PreparedScene::NoiseFloor(const FrameContext& frame) const {
  constexpr int kPixels = 400;
  return ChangeFloor(
      Pixels(frame, PreviewGrid(frame.settings.width, frame.settings.height, kPixels)));
}

void PreparedScene::AddTiles(const FrameContext& frame, PixelWriter& writer) const {
  const RenderSettings& settings = frame.settings;
  const int columns = (settings.width + Tile::kSide - 1) / Tile::kSide;
  const int tiles = columns * ((settings.height + Tile::kSide - 1) / Tile::kSide);
  const double floor = NoiseFloor(frame);
  const OccludedSkyPixels open_sky(*this, frame);
  std::atomic<int> done{0};
  tbb::parallel_for(0, tiles, [&](int i) {
    const int x0 = i % columns * Tile::kSide, y0 = i / columns * Tile::kSide;
    AddTile(frame, floor, x0, y0, open_sky, writer);
    if (settings.progress != nullptr) settings.progress->Part(static_cast<double>(++done) / tiles);
  });
}

// Traces first rays of the tile and of a border of pixels around it. Border pixels belong to other
// tiles; they only provide the noise estimate and their rays.
void PreparedScene::AddTile(const FrameContext& frame, double floor, int x0, int y0,
                            const OccludedSkyPixels& open_sky, PixelWriter& writer) const {
  const RenderSettings& settings = frame.settings;
  const int first = settings.samples_per_pixel, most = std::max(kMostRaysForNoise, first);
  const int fewest = std::min(first, kFewestRaysForNoise);
  const Tile tile{x0, y0, std::min(x0 + Tile::kSide, settings.width),
                  std::min(y0 + Tile::kSide, settings.height)};
  const Tile asked{std::max(x0 - 1, 0), std::max(y0 - 1, 0), std::min(tile.x1 + 1, settings.width),
                   std::min(tile.y1 + 1, settings.height)};
  const auto stopped = [&] { return Interrupted() || settings.stop.stop_requested(); };
  AirInterpolationGrid air(*this, frame, x0, y0, tile.x1, tile.y1);
  AirInterpolationGrid* const lattice =
      settings.share_air && settings.share_air_of_pixels ? &air : nullptr;
  std::vector<PixelLight> pixels;
  std::vector<RaySpread> spreads;
  std::vector<bool> is_done;
  pixels.reserve(asked.Size());
  asked.Visit([&](int x, int y) {
    if (stopped()) return;
    const double expected_m = pixels.empty() ? 0.0 : pixels.back().last_m();
    PixelLight& pixel = pixels.emplace_back(*this, frame, x, y, most, lattice, expected_m);
    is_done.push_back(open_sky.Has(x, y));
    if (is_done.back()) {
      pixel.TakeOccludedSky();
    } else {
      pixel.TakeUpTo(fewest);
    }
    spreads.push_back(pixel.spread());
  });
  if (stopped()) return;
  asked.Visit([&](int x, int y) {
    if (stopped() || is_done[asked.Index(x, y)]) return;
    const double among = VarianceAmong(spreads, asked, x, y, floor);
    if (RaysForNoise(among, *settings.noise, fewest, first) > fewest)
      pixels[asked.Index(x, y)].TakeUpTo(first);
  });
  if (stopped()) return;
  std::vector<double> variances;
  for (const PixelLight& pixel : pixels)
    variances.push_back(pixel.spread().RelativeVariance(floor));
  std::vector<int> wanted;
  asked.Visit([&](int x, int y) {
    const int begun = pixels[asked.Index(x, y)].sum().rays;
    const bool may_take_more = tile.Has(x, y) && !is_done[asked.Index(x, y)];
    wanted.push_back(may_take_more ? RaysForNoise(VarianceAround(variances, asked, x, y),
                                                  *settings.noise, begun, most)
                                   : begun);
  });
  SharedSampleFilter shared(frame.filter, asked.x1 - asked.x0, asked.y1 - asked.y0,
                            medium.wavelengths_nm.size());
  asked.Visit(
      [&](int x, int y) { shared.Expect(x - asked.x0, y - asked.y0, wanted[asked.Index(x, y)]); });
  asked.Visit([&](int x, int y) {
    if (stopped()) return;
    PixelLight& pixel = pixels[asked.Index(x, y)];
    const auto share = [&] {
      for (const SeenRay& ray : pixel.NewRays()) shared.Add(x - asked.x0, y - asked.y0, ray);
    };
    share();
    pixel.TakeUpTo(wanted[asked.Index(x, y)]);
    share();
    if (pixel.sky()) shared.SetSky(x - asked.x0, y - asked.y0, *pixel.sky());
  });
  if (stopped()) return;
  tile.Visit([&](int x, int y) {
    PixelLight& pixel = pixels[asked.Index(x, y)];
    pixel.SetMeanRadiance(shared.Light(x - asked.x0, y - asked.y0));
    Write(frame, x, y, pixel, writer);
  });
}

void PreparedScene::Write(const FrameContext& frame, int x, int y, const PixelLight& pixel,
                          PixelWriter& writer) const {
  writer.Write(x, y, WithStars(frame, x, y, pixel.sum()));
  if (!writer.AsksForMiddle()) return;
  writer.WriteMiddle(x, y, Trace(frame.camera().MiddleRay(x + 0.5, y + 0.5), frame));
}

}  // namespace alpenglow::renderer
