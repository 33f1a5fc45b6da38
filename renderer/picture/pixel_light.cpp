// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_light.h"

#include <algorithm>
#include <array>
#include <glm/vec2.hpp>

#include "renderer/picture/scene_state.h"

namespace alpenglow::renderer {
namespace {

/// Lamps that no ray comes near.
const LampTile& DarkTile() {
  static const LampTile kDark;
  return kDark;
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

PixelLight::PixelLight(const SceneState& scene, const PictureFrame& frame, int x, int y,
                       int most_rays, AirLattice* around, double expected_m)
    : scene_(&scene),
      frame_(&frame),
      x_(x),
      y_(y),
      through_middle_(most_rays == 1),
      around_(around),
      last_m_(expected_m),
      samples_(x, y, most_rays),
      glow_(scene.medium.wavelengths_nm.size()) {}

PixelLight::Ray PixelLight::Traced(int sample) {
  glm::dvec2 offset(0.0);
  if (!through_middle_) {
    const auto [u, v] = samples_.Point(sample, SampleOf::kPixel);
    offset = {frame_->filter.Offset(u), frame_->filter.Offset(v)};
  }
  const CameraRay ray = RayOf(samples_, sample, glm::dvec2(x_ + 0.5, y_ + 0.5) + offset, *frame_);
  const Hit hit = scene_->Trace(ray, *frame_, last_m_);
  if (hit.kind != HitKind::kSky) last_m_ = hit.distance_m;
  return {ray, hit, AirFor(hit, ray.through, *frame_, airs_), offset};
}

void PixelLight::AddNewAir(std::size_t known) {
  // The filter is symmetric: the mean of all its rays is known better than the mean of some.
  if (airs_.size() == 1 && known == 0 && !frame_->moving.IsMoving()) {
    airs_.front().direction_sum = frame_->camera().Direction(x_ + 0.5, y_ + 0.5);
  }
  for (std::size_t i = known; i < airs_.size(); ++i) {
    const auto shared = around_ != nullptr ? around_->Before(airs_[i]) : std::nullopt;
    if (shared) {
      airs_[i].air = *shared;
      airs_[i].media = BandLight(shared->inscatter.count);
    } else {
      AddAir(*frame_, scene_->geometry, scene_->medium, airs_[i]);
    }
    AddLamps(*frame_, x_, y_, airs_[i]);
  }
}

void PixelLight::TakeUpTo(int rays) {
  if (rays <= sum_.rays) return;
  const std::size_t known = airs_.size();
  thread_local std::vector<Ray> more;  // memory that all pixels of a thread use
  more.clear();
  for (int sample = sum_.rays; sample < rays; ++sample) more.push_back(Traced(sample));
  AddNewAir(known);
  new_rays_.reserve(new_rays_.size() + more.size());
  for (const Ray& seen : more) Add(seen);
}

void PixelLight::TakeOpenSky() {
  const CameraRay ray = frame_->camera().MiddleRay(x_ + 0.5, y_ + 0.5);
  const Ray seen{ray, {}, AirFor({}, ray.through, *frame_, airs_), glm::dvec2(0.0)};
  AddNewAir(0);
  Add(seen);
}

void PixelLight::Add(const Ray& seen) {
  const LampTile& near = frame_->plan->tiles.empty() ? DarkTile() : frame_->plan->At(x_, y_);
  const Shaded shaded = scene_->Shade(seen.hit, airs_[seen.air], seen.ray, *frame_, near,
                                      samples_.Point(sum_.rays, SampleOf::kSunDisk));
  spread_.Add(scene_->colour.LinearSrgb(InDouble(shaded.radiance)));
  const BandLight glow = shaded.lamps + shaded.volumes;
  const bool sees_sky = seen.hit.kind == HitKind::kSky;
  if (sees_sky && !sky_) sky_ = shaded.inscatter;
  BandLight shared = shaded.radiance + -1.0F * glow;
  if (sees_sky) shared = shared + -1.0F * *sky_;
  new_rays_.push_back({seen.offset.x, seen.offset.y, shared, sees_sky});
  glow_ = glow_ + glow;
  sum_.Add(shaded, !frame_->settings.layers.empty());
}

}  // namespace alpenglow::renderer
