// SPDX-License-Identifier: MIT
// Stars and planets in a picture, disks narrower than a pixel, and the pixels that see only sky.
//
// Stars and planets are points whose light is spread over the pixels around them. A light of
// illuminance E adds the radiance w E / Omega to a pixel of solid angle Omega. The weights w come
// from a bell with a standard deviation of half a pixel over 5 x 5 pixels, whose sum is one: the
// illuminance in a picture equals that of the light for any picture size, and a moving star does
// not twinkle. During a long exposure the light is spread along its path, evenly in time, in steps
// of half a pixel.
//
// A disk of sun or moon that is narrower than a pixel at its place is integrated over the pixels
// around it, because rays would miss it: a dozen rays of a pixel, of which none meets the disk, do
// not differ. While the shutter is open the light follows the motion of the camera and of the disk,
// and a lens blurs it, as they do with the rays of other pixels.
//
// In both cases each pixel's share of the light is divided by the solid angle of this pixel. The
// sum of radiance times solid angle is therefore the illuminance everywhere in a picture, at the
// rim of a wide view and at the poles of a panorama too. A panorama is closed: light beyond its
// left edge is that at its right edge, and light beyond a pole lies on the other side of the pole.
//
// UnoccludedSkyPixels finds the pixels that see only sky without tracing a ray: those well above
// the skyline, not near the sun or the moon, and not at the limb of the planet (LimbView). All rays
// of such a pixel have one sky radiance, that of its middle (shared_samples.h), and so have all
// rays of its neighbours that count for it. One ray through the middle gives the same result as
// many.
//
// Skyline is the elevation of the ground around an eye. If the ground is solid below its surface,
// then along each azimuth all directions below one elevation show ground and all above it show sky.
// The skyline is therefore one elevation per azimuth, which bisection finds. Azimuths are half a
// pixel apart. Between two azimuths, the ground is assumed to exceed both elevations by no more
// than the margin requested around a direction.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/illumination/night_light.h"
#include "renderer/material/band_light.h"

namespace alpenglow::renderer {

/// The lowest elevation of the sky by azimuth. Immutable, safe to share between threads.
class Skyline {
 public:
  /// A range of azimuths in the frame, counted from x towards y.
  struct Arc {
    double first_rad, width_rad;  // at most a full turn
  };
  using SeesSky = std::function<bool(const glm::dvec3& direction)>;

  /// @param up  at the eye, unit.
  /// @param step_rad  between azimuths, and the accuracy of elevations, > 0.
  /// @param sees_sky  safe to call from many threads.
  Skyline(const glm::dvec3& up, const Arc& arc, double step_rad, const SeesSky& sees_sky);

  /// Returns the azimuth of a direction, in the convention of Arc.
  [[nodiscard]] static double AzimuthOf(const glm::dvec3& direction, const glm::dvec3& up);
  /// Returns whether all directions within an angle of a direction are above the skyline; false if
  /// this is unknown.
  [[nodiscard]] bool IsBelow(const glm::dvec3& direction, double around_rad) const;

 private:
  [[nodiscard]] glm::dvec3 DirectionAt(double azimuth_rad, double elevation_rad) const;
  /// @param near_rad  estimated elevation.
  [[nodiscard]] double Found(double azimuth_rad, double near_rad, const SeesSky& sees_sky) const;

  glm::dvec3 up_, east_, north_;  // of the eye; unit
  double first_rad_, step_rad_;
  bool is_whole_turn_;
  std::vector<float> elevation_rad_;  // lowest elevation at which sky is visible
  double highest_rad_;
};

inline constexpr int kStarReach = 2;
/// Weights of the pixels around the one that contains a place, along one axis; their sum is one.
using StarBell = std::array<double, 2 * kStarReach + 1>;
[[nodiscard]] StarBell StarBellAround(double place);

/// Light of points, spread over the pixels of a picture.
class SpreadLight {
 public:
  SpreadLight(int width, int height) : width_(width), height_(height) {}

  /// Adds the light that falls on a pixel, W m^-2 nm^-1; nothing outside a picture that is no
  /// panorama.
  void Add(const CameraRays& camera, int column, int row, const BandLight& irradiance);

  /// Returns the radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing to add.
  [[nodiscard]] const BandLight* At(int x, int y) const;
  /// Number of pixels with light.
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }

 private:
  struct LitPixel {
    double per_sr;
    BandLight radiance;
  };

  int width_, height_;
  std::unordered_map<int, LitPixel> pixels_;
};

/// Stars of one picture. Immutable.
class StarPixels {
 public:
  /// Returns the transmittance of light from space at a place of the picture; no value where
  /// something occludes it.
  using Left = std::function<std::optional<BandLight>(double x, double y)>;

  /// Returns whether something occludes a place of the picture. Cheaper than Left, which also
  /// computes air.
  using Hidden = std::function<bool(double x, double y)>;

  /// @param lights  brightest first.
  StarPixels(const CameraRays& camera, int width, int height, const std::vector<StarLight>& lights,
             const Left& left, const Hidden& hidden);

  /// Returns the radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing to add.
  [[nodiscard]] const BandLight* At(int x, int y) const { return spread_.At(x, y); }
  /// Directions of the lights within the picture, brightest first.
  [[nodiscard]] const std::vector<glm::dvec3>& directions() const { return directions_; }

 private:
  struct PicturePoint {
    double x, y;
  };
  /// Returns whether a place is near enough to light a pixel of the picture.
  [[nodiscard]] bool IsNear(const PicturePoint& place) const;
  void AddPoint(const CameraRays& camera, const StarLight& light, const Left& left);
  void AddTrail(const CameraRays& camera, const StarLight& light, const Left& left,
                const Hidden& hidden);
  void AddStep(const CameraRays& camera, const PicturePoint& from, const PicturePoint& to,
               const BandLight& irradiance, const Left& left, const Hidden& hidden);
  void Spread(const CameraRays& camera, const PicturePoint& place, const BandLight& irradiance);

  int width_, height_;
  SpreadLight spread_;
  std::vector<glm::dvec3> directions_;
};

/// A disk of sun or moon in the sky of a picture.
struct DiskInSky {
  glm::dvec3 to_disk{0.0};  // unit, in the middle of the exposure
  double around_rad = 0.0;  // > 0: everything farther from the middle of the disk is dark
  glm::dvec3 turn{0.0};     // axis and angle [rad] of its motion while the shutter is open
  /// Returns the radiance that arrives from a direction if nothing hides it, its mean while the
  /// shutter is open; 0 beside the disk.
  std::function<BandLight(const glm::dvec3& direction)> radiance;
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
  [[nodiscard]] const BandLight* At(int x, int y) const { return spread_.At(x, y); }

 private:
  class Grid;
  void AddCell(const MovingCamera& camera, const PixelFilter& filter, const DiskInSky& disk,
               const Grid& grid, int cell);
  void Spread(const CameraRays& camera, const PixelFilter& filter, const ArrivingRay& at,
              const BandLight& irradiance);

  int width_, height_;
  SpreadLight spread_;
};

class FrameContext;
class PixelShader;

/// Immutable, safe to share between threads. Refers to the frame.
class UnoccludedSkyPixels {
 public:
  /// No pixel counts as open sky where sky can be visible below ground, a lens blurs, or the camera
  /// moves.
  explicit UnoccludedSkyPixels(const PixelShader& shader);

  /// Returns whether all rays that count for a pixel see only sky, without a disk in it.
  [[nodiscard]] bool Has(int x, int y) const;

 private:
  /// Returns the range of azimuths that the picture, with a margin, covers.
  [[nodiscard]] Skyline::Arc ArcAround(const glm::dvec3& up) const;

  const FrameContext& frame_;
  double around_rad_;  // angular radius around the middle of a pixel that contains everything its
                       // rays see
  std::optional<Skyline> skyline_;
};

}  // namespace alpenglow::renderer
