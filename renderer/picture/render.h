// SPDX-License-Identifier: MIT
// What is asked of a picture: its size and care, when and from where it is taken.
//
// Pictures of a scene: terrain, sky, sun disk, lamps, and the air in front of everything.
//
// Frame: ENU at the foot of the eye on the ellipsoid. The atmosphere is a shell on the sphere that
// osculates the ellipsoid there, so the altitude of a point is its distance from that sphere. The
// sun stands where refraction shows it: disk, light on the ground and light in the air use the
// same, apparent direction. Where the effect of refraction shows, the disk and the horizon of a sea
// without terrain are those of bent rays instead (BentSight).
//
// Per pixel: rays against the terrain, spread as PixelFilter and PixelSamples say (a single one
// goes through the middle; with RenderSettings::noise, as many as shared_rays.h says), then the air
// along the mean of those that meet the same surface (AerialPerspective): single scattering where
// terrain and planet let the sun in, light of higher orders everywhere. Terrain behind the planet's
// own horizon is not seen.
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"
#include "lut/picture/image.h"
#include "lut/program/messages.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effect/effect_choice.h"
#include "renderer/effect/effects.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/picture/picture_layers.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Of a pixel, unless it begins with more.
inline constexpr int kMostRaysForNoise = 256;
/// What a pixel begins with whose neighbours agree.
inline constexpr int kFewestRaysForNoise = 2;

struct RenderSettings {
  int width = 1280;
  int height = 720;
  int samples_per_pixel = 4;  // rays, in [1, 1024]; a power of two is spread best
  /// Of a pixel, relative, in [1e-8, 1]: pixels take more rays as it asks (shared_rays.h), at most
  /// kMostRaysForNoise. Nothing: all take samples_per_pixel.
  std::optional<double> noise = std::nullopt;
  PixelFilter::Kind filter = PixelFilter::Kind::kBlackmanHarris;
  int air_nodes = 12;  // Gauss nodes along a ray to the sky
  EffectSet effects = EffectSet::All();
  bool share_air = true;  // between rays of a pixel; false for comparison
  /// With noise between pixels, too, where it is smooth (pixel_light.h); false for comparison.
  bool share_air_of_pixels = true;
  /// With noise, pixels that see nothing but sky take one ray; false is for comparison.
  bool skips_open_sky = true;
  std::vector<PictureLayer> layers;
  LampSettings lamps = {};
  Progress* progress = nullptr;  // told of steps, and of the rows of pixels that are done
  std::stop_token stop = {};     // asked between pixels whether anybody still wants the picture
};

/// Nobody wants the picture any more (RenderSettings::stop).
class RenderingStopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "rendering was stopped"; }
};

/// When a picture is taken, and from where.
struct Shot {
  Shot(const UtcInstant& at) : instant(at) {}  // NOLINT: by the scene's camera

  UtcInstant instant;
  /// Another camera with the scene's lens: of one pose, or of several that it takes
  /// at even steps of time while its shutter is open. Terrain stays where it is;
  /// light and air are as at the middle pose. The air stays on the sphere that
  /// osculates the ellipsoid at the scene's place, which the ellipsoid leaves by 3
  /// m at 100 km and by 70 m at 500 km, the farthest that an eye may be.
  std::vector<CameraPose> poses;

  [[nodiscard]] std::optional<CameraPose> middle() const {
    if (poses.empty()) return std::nullopt;
    return poses[poses.size() / 2];
  }
};

/// Throws InputError for what is out of range.
void ValidateSettings(const RenderSettings& settings);

struct SceneGround;
struct SceneState;

/// A picture, and the rays that it took.
struct CountedPicture {
  Image image;
  RayCount rays;
};

/// A picture of what a scene needs.
struct ChosenPicture {
  Image image;
  RayCount rays;
  EffectChoice choice;
};

/// A scene ready to be rendered at any time: terrain
/// loaded, light of higher orders solved. Immutable.
class SceneRenderer {
 public:
  /// Throws InputError for what the scene names and cannot be read, or an eye below the ground.
  /// @param progress  told what is prepared, if not null; not kept.
  explicit SceneRenderer(const Scene& scene, Progress* progress = nullptr);
  /// On ground that is there already, in the frame of the scene's place, instead of the scene's own.
  SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground);
  ~SceneRenderer();

  /// Linear sRGB in cd/m^2. The same bytes for any number of threads. Throws InputError for a size
  /// out of [1, 16384] and an eye that cannot be where it is, RenderingStopped when
  /// settings.stop asks for it; stops early when Interrupted().
  [[nodiscard]] Image Render(const Shot& shot, const RenderSettings& settings) const;
  [[nodiscard]] CountedPicture RenderCounted(const Shot& shot,
                                             const RenderSettings& settings) const;

  /// Render() with those of settings.effects that the picture needs (effect_choice.h). The choice
  /// is the same for any number of threads; the times in it are this run's.
  [[nodiscard]] ChosenPicture RenderWithin(const Shot& shot, const RenderSettings& settings,
                                           const EffectBudget& budget) const;

  /// Of sun and sky on a horizontal plane at the eye, terrain aside [lux].
  [[nodiscard]] double Illuminance(const Shot& shot) const;

  /// The sun from the eye with refraction: where the picture shows it.
  [[nodiscard]] SunPosition ApparentSun(const Shot& shot) const;

  /// The medium on the osculating sphere.
  [[nodiscard]] const Medium& medium() const;
  /// Height of the eye over the ellipsoid [m].
  [[nodiscard]] double eye_height_m() const;
  /// What loading the terrain has to tell (voids found and filled), empty if nothing.
  [[nodiscard]] const std::string& terrain_message() const;

 private:
  std::unique_ptr<SceneState> state_;
};

}  // namespace alpenglow::renderer
