// SPDX-License-Identifier: MIT
// The light of one pixel: its rays, the surfaces that they meet, and the air in front of these.
//
// Neighbouring pixels share air: it is computed at the corners of cells of 4 x 4 pixels and
// interpolated between them where the cell is smooth enough.
//
// Light I, transmittance T and distance d are interpolated bilinearly between the corners. For
// ground at a distance that differs from the interpolated one by a factor r, the air is
// extrapolated as if it were uniform along the ray:
//
//   T_r = T^r,      I_r = I (1 - T^r) / (1 - T)
//
// A cell is shared when all its corners and its middle see the sky, or all see terrain, and the air
// computed for its middle agrees with the interpolated air in every band:
//
//   |dI| <= 2e-3 I before the sky, 2e-3 min(I / (1 - T), 4 I) before ground,      |dT| <= 2e-3,
//
// where I / (1 - T) is the radiance of air of infinite depth. Q and U, where requested, have the
// bound of I. Ground in a shared cell uses the shared air where |r - 1| (1 - T) <= 4e-3: an error
// of the uniformity along the last stretch of air is then less than 4e-3 of the radiance of air of
// infinite depth. All other air is computed for each pixel, and so is all air in a picture with a
// fixed number of rays, and in media.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/pixel_shader.h"
#include "renderer/picture/shared_samples.h"

namespace alpenglow::renderer {

/// Air of a rectangle of pixels. Cells are computed on demand, by one thread. Refers to the
/// shader and its frame.
class AirInterpolationGrid {
 public:
  static constexpr int kCell = 4;  // pixels

  /// @param x0, y0  first pixel. @param x1, y1  one past the last pixel.
  AirInterpolationGrid(const PixelShader& shader, int x0, int y0, int x1, int y1);

  /// Returns the air in front of rays of a pixel; no value where it cannot be shared.
  [[nodiscard]] std::optional<AirAlongRay> Before(const SharedSegmentAir& rays);

 private:
  struct Corner {
    HitKind kind;
    double distance_m;
    AirAlongRay air;
  };
  enum class Cell { kUnknown, kShared, kRough };

  [[nodiscard]] const Corner& At(int column, int row);
  [[nodiscard]] Corner Computed(double x, double y) const;
  /// Returns the interpolated air in front of a surface at a distance, at (x, y) within the
  /// picture.
  [[nodiscard]] std::optional<AirAlongRay> Between(int column, int row, double x, double y,
                                                   HitKind kind, double distance_m);
  [[nodiscard]] bool IsShared(int column, int row);

  const PixelShader* shader_;
  const FrameContext* frame_;
  int x0_, y0_, columns_, rows_;  // in cells
  std::vector<std::optional<Corner>> corners_;
  std::vector<Cell> cells_;
};

/// Accumulates rays of one pixel up to a requested number; all rays have the same weight. Refers to
/// shader, frame and lattice.
class PixelLight {
 public:
  /// @param most_rays  largest number of rays that will be requested. A pixel with a single ray
  ///     looks through its middle.
  /// @param around  air shared with other pixels; null: no sharing.
  /// @param expected_m  expected length of the rays (PixelShader::Trace).
  PixelLight(const PixelShader& shader, int x, int y, int most_rays,
             AirInterpolationGrid* around = nullptr, double expected_m = 0.0);

  /// Adds rays until the pixel has `rays` of them. Air of earlier rays is reused.
  void TakeUpTo(int rays);
  /// Adds the first ray, through the middle of a pixel that sees only sky.
  void TakeUnoccludedSky();

  [[nodiscard]] const PixelSum& sum() const { return sum_; }
  /// Length of the last ray that met a surface, or the expected length [m].
  [[nodiscard]] double last_m() const { return last_m_; }
  [[nodiscard]] const RaySpread& spread() const { return spread_; }

  /// Returns the rays added since the last call, without light from lamps, volumes and clouds: the airlight
  /// of lamps has one value for all rays of a pixel, and near lamps it changes strongly from pixel
  /// to pixel.
  [[nodiscard]] std::vector<SeenRay> NewRays() { return std::exchange(new_rays_, {}); }
  /// Airlight of the rays that see the sky; the radiance in NewRays() of these rays is relative to
  /// it.
  [[nodiscard]] const std::optional<Spectrum>& sky() const { return sky_; }
  /// Replaces the mean radiance without lamps, volumes and clouds by a better estimate than the mean of the
  /// pixel's own rays.
  void SetMeanRadiance(const Spectrum& mean) {
    sum_.radiance = static_cast<float>(sum_.rays) * mean + glow_;
  }

 private:
  struct Ray {
    CameraRay ray;
    Hit hit;
    std::size_t air;    // index into airs_
    glm::dvec2 offset;  // from the middle of the pixel
  };
  [[nodiscard]] Ray Traced(int sample);
  /// Returns the mean light of the paths of the next ray; no value if the picture has none.
  [[nodiscard]] std::optional<Spectrum> LightOfPaths(const CameraRay& ray);
  void AddNewAir(std::size_t known);
  void Add(const Ray& seen);

  const PixelShader* shader_;
  const FrameContext* frame_;
  int x_, y_;
  bool through_middle_;
  AirInterpolationGrid* around_;
  double last_m_;
  PixelSamples samples_;
  std::vector<SharedSegmentAir> airs_;
  PixelSum sum_;
  RaySpread spread_;
  std::vector<SeenRay> new_rays_;
  std::optional<Spectrum> sky_;
  Spectrum glow_;  // sum of the light from lamps, volumes and clouds that new_rays_ exclude
};

}  // namespace alpenglow::renderer
