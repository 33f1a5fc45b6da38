// SPDX-License-Identifier: MIT
// Stars and planets in a picture: points whose light is spread over the pixels around them.
//
// A light of illuminance E brings a pixel of the solid angle Omega the radiance w E / Omega, with w
// from a bell of half a pixel's deviation over 5 x 5 pixels, whose sum is one: the illuminance in a
// picture is that of the light whatever its size, and nothing twinkles as a star moves on. While a
// shutter is open long the same light is spread along its way, evenly in time, in steps of half a
// pixel.
//
// Pixels in which nothing but sky is seen, without a ray: those well over the skyline, and not near
// the sun or the moon.
//
// All rays of such a pixel see one sky, that of its middle (shared_rays.h), and so do all rays of its
// neighbours that count for it. One ray through the middle says as much as many.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <unordered_map>
#include <vector>

#include "renderer/camera/camera_rays.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/skyline.h"
#include "renderer/light/night_light.h"

namespace alpenglow::renderer {

inline constexpr int kStarReach = 2;
/// Shares of the pixels around the one that a place lies in, along one side; their sum is one.
using StarBell = std::array<double, 2 * kStarReach + 1>;
[[nodiscard]] StarBell StarBellAround(double place);

/// Of one picture. Immutable.
class StarPixels {
 public:
  /// What is left of light that falls in at a place of the picture; nothing where something stands
  /// before it.
  using Left = std::function<std::optional<BandLight>(double x, double y)>;

  /// Whether something stands before a place of the picture; Left knows that too, but asks air.
  using Hidden = std::function<bool(double x, double y)>;

  /// @param lights  brightest first.
  StarPixels(const CameraRays& camera, int width, int height, const std::vector<StarLight>& lights,
             const Left& left, const Hidden& hidden);

  /// Radiance to add to a pixel, W m^-2 sr^-1 nm^-1; null: nothing.
  [[nodiscard]] const BandLight* At(int x, int y) const;
  /// Of those that are in the picture, brightest first.
  [[nodiscard]] const std::vector<glm::dvec3>& directions() const { return directions_; }

 private:
  struct Place {
    double x, y;
  };
  /// What a pixel within reach takes light of; nothing outside the picture.
  [[nodiscard]] bool IsNear(const Place& place) const;
  void AddPoint(const CameraRays& camera, const StarLight& light, const Left& left);
  void AddTrail(const CameraRays& camera, const StarLight& light, const Left& left,
                const Hidden& hidden);
  void AddStep(const CameraRays& camera, const Place& from, const Place& to,
               const BandLight& irradiance, const Left& left, const Hidden& hidden);
  void Spread(const CameraRays& camera, const Place& place, const BandLight& irradiance);

  int width_, height_;
  std::unordered_map<int, BandLight> pixels_;
  std::vector<glm::dvec3> directions_;
};

struct PictureFrame;
struct SceneState;

/// Immutable, safe to share between threads. Refers to the frame.
class OpenSkyPixels {
 public:
  /// No pixel is of open sky where sky may be seen under ground, a lens blurs, or the camera moves.
  OpenSkyPixels(const SceneState& scene, const PictureFrame& frame);

  /// Returns whether all rays that count for a pixel see the sky, and no disk in it.
  [[nodiscard]] bool Has(int x, int y) const;

 private:
  /// Returns the azimuths of the eye's vertical planes that the picture shows, and that lie around it.
  [[nodiscard]] Skyline::Arc ArcAround(const glm::dvec3& up) const;

  const PictureFrame& frame_;
  double around_rad_;  // of the middle of a pixel: what its rays see lies within that
  std::optional<Skyline> skyline_;
};

}  // namespace alpenglow::renderer
