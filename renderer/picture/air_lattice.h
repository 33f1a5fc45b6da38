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
#pragma once

#include <optional>
#include <vector>

#include "renderer/picture/shared_air.h"

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

}  // namespace alpenglow::renderer
