// SPDX-License-Identifier: MIT
// The light of one pixel: its rays, what they meet, and the air they look through.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/camera/pixel_samples.h"
#include "renderer/picture/air_lattice.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/pixel_noise.h"
#include "renderer/picture/shared_air.h"
#include "renderer/picture/shared_rays.h"

namespace alpenglow::renderer {

struct SceneState;

/// Takes rays until it has as many as it is asked for; all count alike. Refers to scene, frame and
/// lattice.
class PixelLight {
 public:
  /// @param most_rays  that it will ever be asked for. A pixel of a single one looks through its
  ///     middle.
  /// @param around  air that is shared with other pixels; null: none is.
  /// @param expected_m  how far rays may go (SceneState::Trace).
  PixelLight(const SceneState& scene, const PictureFrame& frame, int x, int y, int most_rays,
             AirLattice* around = nullptr, double expected_m = 0.0);

  /// More rays until there are so many. Air that earlier rays look through is not asked for again.
  void TakeUpTo(int rays);
  /// The first ray, through the middle of a pixel in which nothing but sky is seen.
  void TakeOpenSky();

  [[nodiscard]] const PixelSum& sum() const { return sum_; }
  /// Length of the last ray that met something, or what was expected [m].
  [[nodiscard]] double last_m() const { return last_m_; }
  [[nodiscard]] const RaySpread& spread() const { return spread_; }

  /// The rays since it was last asked, without light from lamps and volumes: its glow in the air is
  /// one value for all rays of a pixel, and near lamps very another one for the next.
  [[nodiscard]] std::vector<SeenRay> NewRays() { return std::exchange(new_rays_, {}); }
  /// The light of the air of rays that see the sky, to which the radiance of these is added.
  [[nodiscard]] const std::optional<BandLight>& sky() const { return sky_; }
  /// What is known of the mean radiance without that better than from its rays alone.
  void SetMeanRadiance(const BandLight& mean) {
    sum_.radiance = static_cast<float>(sum_.rays) * mean + glow_;
  }

 private:
  struct Ray {
    CameraRay ray;
    Hit hit;
    std::size_t air;    // of airs_
    glm::dvec2 offset;  // from the middle of the pixel
  };
  [[nodiscard]] Ray Traced(int sample);
  void AddNewAir(std::size_t known);
  void Add(const Ray& seen);

  const SceneState* scene_;
  const PictureFrame* frame_;
  int x_, y_;
  bool through_middle_;
  AirLattice* around_;
  double last_m_;
  PixelSamples samples_;
  std::vector<SharedAir> airs_;
  PixelSum sum_;
  RaySpread spread_;
  std::vector<SeenRay> new_rays_;
  std::optional<BandLight> sky_;
  BandLight glow_;  // sum of what new_rays_ are without
};

}  // namespace alpenglow::renderer
