// SPDX-License-Identifier: MIT
// Pixels of a scene: their rays, what these see, and the air on the way.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "atmosphere/sun/sun_disk.h"
#include "lut/program/program.h"
#include "renderer/camera/pixel_samples.h"
#include "renderer/picture/pixel_writer.h"
#include "renderer/picture/scene_state.h"

namespace alpenglow {
namespace {

/// Lamps that no ray comes near.
const LampTile& DarkTile() {
  static const LampTile kDark;
  return kDark;
}

/// A ray of a pixel and the air it looks through.
struct PixelRay {
  CameraRay ray;
  Hit hit;
  std::size_t air;
};

/// Of a ray, from the pixel's upper left corner [pixels].
glm::dvec2 PlaceInPixel(const PixelSamples& samples, int sample, const PictureFrame& frame) {
  if (frame.settings.samples_per_pixel == 1) return {0.5, 0.5};
  const auto [u, v] = samples.Point(sample, SampleOf::kPixel);
  return {0.5 + frame.filter.Offset(u), 0.5 + frame.filter.Offset(v)};
}

CameraRay RayOf(const PixelSamples& samples, int sample, const glm::dvec2& at,
                const PictureFrame& frame) {
  std::array<double, 2> lens{};
  double time = 0.0;
  if (frame.camera().HasLens()) lens = samples.Point(sample, SampleOf::kLens);
  if (frame.moving.IsMoving()) time = samples.Point(sample, SampleOf::kTime)[0];
  return frame.moving.Ray(at.x, at.y, lens, time);
}

}  // namespace

BandLight SceneState::SunDisk(const glm::dvec3& direction, const AirAlongRay& through,
                              const Lighting& light) const {
  // Angle from the chord: the arc cosine of a number near 1 has no digits left.
  const double chord = glm::length(direction - light.to_sun);
  const double rho = 2.0 * std::asin(std::min(0.5 * chord, 1.0)) / light.sun_radius_rad;
  if (rho >= 1.0) return BandLight(light.irradiance.count);
  const auto scale = static_cast<float>(LimbDarkening(rho) / DiskSolidAngle(light.sun_radius_rad));
  return scale * (light.irradiance * through.transmittance);
}

BandLight SceneState::Moonlight(const glm::dvec3& direction, const AirAlongRay& through,
                                const Lighting& light) const {
  const double radiance = light.moon ? MoonRadiance(*light.moon, direction) : 0.0;
  if (radiance == 0.0) return BandLight(light.irradiance.count);
  return static_cast<float>(radiance) * (light.irradiance * through.transmittance);
}

Shaded SceneState::Shade(const Hit& hit, const SharedAir& through, const CameraRay& ray,
                         const PictureFrame& frame, const LampTile& near,
                         std::array<double, 2> disk_sample) const {
  Shaded shaded;
  shaded.inscatter = through.fog * (frame.light.irradiance * through.air.inscatter);
  shaded.transmittance = through.fog * through.air.transmittance;
  shaded.albedo = BandLight(medium.wavelengths_nm.size());
  const auto left = [&](double distance_m) {
    return LeftByVolumes(through.pieces, distance_m, through.media.count);
  };
  shaded.lamps =
      through.lamp_light + frame.lamps->Seen(near.seen, ray, frame.camera().PixelAngle(), left);
  shaded.volumes = through.media;
  shaded.radiance = shaded.inscatter + shaded.lamps + shaded.volumes;
  if (hit.kind == HitKind::kSky) {
    shaded.radiance =
        shaded.radiance + through.fog * (SunDisk(ray.direction, through.air, frame.light) +
                                         Moonlight(ray.direction, through.air, frame.light));
    return shaded;
  }
  const GroundRadiance sent = frame.model->ground_light.Towards(
      hit, -ray.direction, frame.ground_sources(), near.surface, disk_sample);
  shaded.albedo = sent.albedo;
  shaded.sun_visibility = sent.sun_visibility;
  const BandLight lamp_light = shaded.transmittance * sent.lamps;
  shaded.lamps = shaded.lamps + lamp_light;
  shaded.radiance = shaded.radiance + lamp_light + shaded.transmittance * sent.natural;
  return shaded;
}

Image SceneState::Pixels(const PictureFrame& frame, const std::vector<PixelPlace>& places) const {
  const int count = static_cast<int>(places.size());
  PixelWriter writer(colour, count, 1, {});
  tbb::parallel_for(0, count, [&](int i) {
    const PixelPlace& at = places[static_cast<std::size_t>(i)];
    if (!Interrupted()) writer.Write(i, 0, Pixel(frame, at.x, at.y));
  });
  ThrowIfInterrupted();
  return writer.Take();
}

Image SceneState::Picture(const PictureFrame& frame) const {
  PixelWriter writer(colour, frame.settings.width, frame.settings.height, frame.settings.layers);
  ThrowIfInterrupted();
  std::atomic<int> rows{0};
  tbb::parallel_for(0, frame.settings.height, [&](int y) {
    for (int x = 0; x < frame.settings.width; ++x) {
      if (Interrupted() || frame.settings.stop.stop_requested()) return;
      writer.Write(x, y, Pixel(frame, x, y));
      if (!writer.AsksForMiddle()) continue;
      writer.WriteMiddle(x, y, Trace(frame.camera().MiddleRay(x + 0.5, y + 0.5), frame));
    }
    if (frame.settings.progress != nullptr)
      frame.settings.progress->Part(static_cast<double>(++rows) / frame.settings.height);
  });
  ThrowIfInterrupted();
  if (frame.settings.stop.stop_requested()) throw RenderingStopped();
  return writer.Take();
}

std::vector<Shaded> SceneState::Pixel(const PictureFrame& frame, int x, int y) const {
  const PixelSamples samples(x, y, frame.settings.samples_per_pixel);
  std::vector<PixelRay> rays;
  rays.reserve(static_cast<std::size_t>(frame.settings.samples_per_pixel));
  std::vector<SharedAir> airs;
  for (int i = 0; i < frame.settings.samples_per_pixel; ++i) {
    const glm::dvec2 at = glm::dvec2(x, y) + PlaceInPixel(samples, i, frame);
    const CameraRay ray = RayOf(samples, i, at, frame);
    const Hit hit = Trace(ray, frame);
    rays.push_back({ray, hit, AirFor(hit, ray.through, frame, airs)});
  }
  // The filter is symmetric: the mean of all its rays is known better than the mean of some.
  if (airs.size() == 1 && !frame.moving.IsMoving()) {
    airs.front().direction_sum = frame.camera().Direction(x + 0.5, y + 0.5);
  }
  const LampTile& near = frame.plan->tiles.empty() ? DarkTile() : frame.plan->At(x, y);
  for (SharedAir& shared : airs) {
    AddAir(frame, geometry, medium, shared);
    AddLamps(frame, x, y, shared);
  }
  std::vector<Shaded> shaded;
  shaded.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    shaded.push_back(Shade(rays[i].hit, airs[rays[i].air], rays[i].ray, frame, near,
                           samples.Point(static_cast<int>(i), SampleOf::kSunDisk)));
  }
  return shaded;
}

}  // namespace alpenglow
