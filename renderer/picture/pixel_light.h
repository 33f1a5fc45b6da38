// SPDX-License-Identifier: MIT
// Air that neighbouring pixels share: computed at the corners of cells of 4 x 4 pixels, and in
// between taken from them where the cell is as smooth as that.
//
// Bilinear in the corners' light I, transmittance T and distance d. Ground at another distance than
// the corners say, by a factor r, stands behind r times the air, as if that were alike all along:
//
//   T_r = T^r,      I_r = I (1 - T^r) / (1 - T)
//
// A cell is shared when all its corners and its middle see the sky, or all see terrain, and what is
// computed for its middle agrees with the corners in every band:
//
//   |dI| <= 2e-3 I before the sky, 2e-3 min(I / (1 - T), 4 I) before ground,      |dT| <= 2e-3,
//
// (and Q and U, where they are asked for, as I),
// where I / (1 - T) is the brightness of air without an end; and ground in it where
// |r - 1| (1 - T) <= 4e-3, so that what the last stretch of air has more or less than the rest of
// it is less than 4e-3 of that. Everything else is computed for each pixel, as
// everything is in a picture of equally many rays, and in fog and volumes.
//
// The light of one pixel: its rays, what they meet, and the air they look through.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/picture/shared_air.h"
#include "renderer/picture/shared_rays.h"

namespace alpenglow::renderer {

struct SceneState;

/// Of a rectangle of pixels; cells are computed when they are asked for, by one thread. Refers to
/// scene and frame.
class AirLattice {
 public:
  static constexpr int kCell = 4;  // pixels

  /// @param x0, y0  first pixel. @param x1, y1  behind the last.
  AirLattice(const SceneState& scene, const PictureFrame& frame, int x0, int y0, int x1, int y1);

  /// The air before rays of a pixel; nothing where it cannot be shared.
  [[nodiscard]] std::optional<AirAlongRay> Before(const SharedAir& rays);

 private:
  struct Corner {
    HitKind kind;
    double distance_m;
    AirAlongRay air;
  };
  enum class Cell { kUnknown, kShared, kRough };

  [[nodiscard]] const Corner& At(int column, int row);
  [[nodiscard]] Corner Computed(double x, double y) const;
  /// Of what stands at a distance, at (x, y) within the picture.
  [[nodiscard]] std::optional<AirAlongRay> Between(int column, int row, double x, double y,
                                                   HitKind kind, double distance_m);
  [[nodiscard]] bool IsShared(int column, int row);

  const SceneState* scene_;
  const PictureFrame* frame_;
  int x0_, y0_, columns_, rows_;  // of cells
  std::vector<std::optional<Corner>> corners_;
  std::vector<Cell> cells_;
};

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
