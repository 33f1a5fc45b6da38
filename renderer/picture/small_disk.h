// SPDX-License-Identifier: MIT
// A disk of sun or moon that is narrower than a pixel at its place. It is integrated over the
// pixels around it, because rays would miss it: a dozen rays of a pixel, of which none meets the
// disk, do not differ. While the shutter is open the light follows the motion of the camera and of
// the disk, and a lens blurs it, as they do with the rays of other pixels.
#pragma once

#include <functional>
#include <glm/vec3.hpp>

#include "atmosphere/colour/spectrum.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/picture/spread_light.h"

namespace alpenglow::renderer {

/// A disk of sun or moon in the sky of a picture.
struct DiskInSky {
  glm::dvec3 to_disk{0.0};  // unit, in the middle of the exposure
  double around_rad = 0.0;  // > 0: everything farther from the middle of the disk is dark
  glm::dvec3 turn{0.0};     // axis and angle [rad] of its motion while the shutter is open
  /// Returns the radiance that arrives from a direction if nothing hides it, its mean while the
  /// shutter is open; 0 beside the disk.
  std::function<Spectrum(const glm::dvec3& direction)> radiance;
  /// Returns whether a ray meets nothing but sky.
  std::function<bool(const CameraRay& ray)> is_open;
};

/// A disk, integrated over the pixels that it lights: within 1 % of its illuminance, if its radius
/// is at least half of DiskInSky::around_rad. Immutable.
class SmallDisk {
 public:
  SmallDisk(const MovingCamera& camera, const PixelFilter& filter, int width, int height,
            const DiskInSky& disk);

  /// Returns the radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing to add.
  [[nodiscard]] const Spectrum* At(int x, int y) const { return spread_.At(x, y); }

 private:
  class Grid;
  void AddCell(const MovingCamera& camera, const PixelFilter& filter, const DiskInSky& disk,
               const Grid& grid, int cell);
  void Spread(const CameraRays& camera, const PixelFilter& filter, const ArrivingRay& at,
              const Spectrum& irradiance);

  int width_, height_;
  SpreadLight spread_;
};

}  // namespace alpenglow::renderer
