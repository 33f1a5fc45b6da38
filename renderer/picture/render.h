// SPDX-License-Identifier: MIT
// Renders pictures of a scene: terrain, sky, sun disk, lamps, and the air in front of everything.
//
// RenderSettings set the size and quality of a picture; CameraSample sets its time and camera.
//
// Frame: ENU at the foot of the eye on the ellipsoid. The atmosphere is a shell on the sphere that
// osculates the ellipsoid there, so the altitude of a point is its distance from that sphere. The
// sun stands at its refracted direction: disk, light on the ground and light in the air use this
// one, apparent direction. Where the effect of refraction is visible, the disk and the horizon of a
// sea without terrain follow refracted rays instead (RefractedViewRays).
//
// Each pixel traces rays against the terrain, distributed by PixelFilter and PixelSamples. A single
// ray goes through the middle of the pixel; with RenderSettings::noise, shared_samples.h chooses
// the number of rays. Then AerialPerspective computes the air along the mean of the rays that meet
// the same surface: single scattering where terrain and planet let the sun in, multiple scattering
// everywhere. Terrain beyond the planet's own horizon is not visible.
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/time_place/time.h"
#include "lut/cli/messages.h"
#include "lut/image/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/effects/effects.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Largest number of rays of a pixel with RenderSettings::noise, unless its first rays are already
/// more.
inline constexpr int kMostRaysForNoise = 256;
/// Number of first rays of a pixel whose neighbours agree.
inline constexpr int kFewestRaysForNoise = 2;

/// Largest number of paths of a pixel.
inline constexpr int kMostPaths = 1 << 20;

struct RenderSettings {
  int width = 1280;
  int height = 720;
  int samples_per_pixel = 4;  // rays, in [1, 1024]; powers of two are distributed best
  /// Relative noise of a pixel, in [1e-8, 1]: pixels take as many rays as it requires
  /// (shared_samples.h), at most kMostRaysForNoise. Empty: all pixels take samples_per_pixel.
  std::optional<double> noise = std::nullopt;
  PixelFilter::Kind filter = PixelFilter::Kind::kBlackmanHarris;
  /// Number of paths of a pixel, in [1, 1048576]: the light of sun, moon and sky in air, clouds and on
  /// the ground is traced (path_tracing/scene_path_tracer.h). All rays have the same number of them,
  /// rounded up. It excludes `noise` and layers of polarised light; effects of air, clouds and ground
  /// change nothing. Empty: the fast method.
  std::optional<int> paths = std::nullopt;
  /// Method of light in clouds along rays; it changes nothing with `paths`.
  CloudLightMethod cloud_light = CloudLightMethod::kFast;
  int air_nodes = 12;  // Gauss nodes along a ray to the sky
  EffectSet effects = EffectSet::All();
  bool share_air = true;  // between the rays of a pixel; false for comparison
  /// With `noise`, pixels also share air with each other where it is smooth (pixel_light.h); false
  /// for comparison.
  bool share_air_of_pixels = true;
  /// With `noise`, pixels that see only sky take one ray; false for comparison.
  bool skips_open_sky = true;
  std::vector<PictureLayer> layers;
  LampSettings lamps = {};
  Progress* progress = nullptr;  // receives the steps, and the finished rows of pixels
  std::stop_token stop = {};     // checked between pixels: cancels the picture
  /// Receives the fraction of the pixels that are done; may be empty. The picture ends with Cancelled
  /// when it returns false.
  ProgressFunction pixels_done = {};
};

/// Thrown when a picture is cancelled (RenderSettings::stop).
class RenderingStopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "rendering was stopped"; }
};

/// Time and camera of a picture.
struct CameraSample {
  CameraSample(const UtcTime& at) : instant(at) {}  // NOLINT: the camera of the scene

  UtcTime instant;
  /// Sun and moon at the eye (SceneRenderer::BodiesOver); each call computes them if they are
  /// missing.
  std::optional<SkyBodies> bodies = std::nullopt;
  /// Replaces the camera of the scene, with the same lens: one pose, or several at even steps of
  /// time while the shutter is open. Terrain stays in place; light and air are those of the middle
  /// pose. The air stays on the sphere that osculates the ellipsoid at the scene's place. Sphere
  /// and ellipsoid differ by 3 m at 100 km and by 70 m at 500 km, the largest distance of an eye.
  std::vector<CameraPose> poses;

  [[nodiscard]] std::optional<CameraPose> middle() const {
    if (poses.empty()) return std::nullopt;
    return poses[poses.size() / 2];
  }
};

/// Throws InputError for a value out of range.
void ValidateSettings(const RenderSettings& settings);

struct SceneGround;
class PreparedScene;

/// A picture and its ray counts.
struct CountedPicture {
  HdrImage image;
  RayCount rays;
};

/// A picture rendered with the effects that the scene needs.
struct ChosenPicture {
  HdrImage image;
  RayCount rays;
  EffectChoice choice;
};

/// A scene ready to be rendered at any time: terrain is loaded, multiple scattering is solved.
/// Immutable.
class SceneRenderer {
 public:
  /// Throws InputError for files of the scene that cannot be read, or an eye below the ground.
  /// @param progress  receives the steps of the preparation; may be null; not kept.
  explicit SceneRenderer(const Scene& scene, Progress* progress = nullptr);
  /// Uses loaded ground, in the frame of the scene's place, instead of loading the scene's own.
  SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground);
  ~SceneRenderer();

  /// Returns the picture as linear sRGB in cd/m^2. The bytes do not depend on the number of
  /// threads. Throws InputError for a size out of [1, 16384] and for an eye at an impossible place,
  /// RenderingStopped when settings.stop requests it; stops early when Interrupted().
  [[nodiscard]] HdrImage Render(const CameraSample& camera_sample,
                                const RenderSettings& settings) const;
  [[nodiscard]] CountedPicture RenderCounted(const CameraSample& camera_sample,
                                             const RenderSettings& settings) const;

  /// Renders without paths, with the subset of settings.effects that the picture needs
  /// (effect_choice.h). The choice does not depend on the number of threads; the times in it are
  /// measured in this run.
  [[nodiscard]] ChosenPicture RenderWithin(const CameraSample& camera_sample,
                                           const RenderSettings& settings,
                                           const EffectBudget& budget) const;

  /// Returns the illuminance of all distant lights and the sky on a horizontal plane at the eye,
  /// without terrain [lux].
  [[nodiscard]] double Illuminance(const CameraSample& camera_sample) const;

  /// Returns sun and moon at the eye, for CameraSample::bodies.
  [[nodiscard]] SkyBodies BodiesOver(const CameraSample& camera_sample) const;
  /// Returns the sun as seen from the eye with refraction, where the picture shows it.
  [[nodiscard]] SunInSky ApparentSun(const CameraSample& camera_sample) const;

  /// Returns the medium on the osculating sphere.
  [[nodiscard]] const Medium& medium() const;
  /// Returns the height of the eye over the ellipsoid [m].
  [[nodiscard]] double eye_height_m() const;
  /// Returns the height of the ground over the ellipsoid at a place [m] (GroundHeightUnder).
  [[nodiscard]] double GroundHeightAt(const Place& place) const;
  /// Returns what was noted on reading the terrain (voids found and filled) and what is draped over
  /// it (values out of range); empty: nothing.
  [[nodiscard]] const std::string& terrain_message() const;

 private:
  std::unique_ptr<PreparedScene> scene_;
};

}  // namespace alpenglow::renderer
