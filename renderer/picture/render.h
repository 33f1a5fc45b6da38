// SPDX-License-Identifier: MIT
// Pictures of a scene: terrain, sky, sun disk, lamps, and the air in front of everything.
//
// Frame: ENU at the foot of the eye on the ellipsoid. The atmosphere is a shell on the sphere that
// osculates the ellipsoid there, so the altitude of a point is its distance from that sphere. The
// sun stands where refraction shows it: disk, light on the ground and light in the air use the
// same, apparent direction.
//
// Per pixel: rays against the terrain, spread as PixelFilter and PixelSamples say (a single one
// goes through the middle), then the air along the mean of those that meet the same surface
// (AerialPerspective): single scattering where terrain and planet let the sun in, light of higher
// orders everywhere. Terrain behind the planet's own horizon is not seen.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"
#include "lut/picture/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/camera/pixel_filter.h"
#include "renderer/effect/effect_choice.h"
#include "renderer/effect/effects.h"
#include "renderer/lamp/lamp_light.h"
#include "renderer/scene/scene.h"

namespace alpenglow {

struct RenderSettings {
  int width = 1280;
  int height = 720;
  int samples_per_pixel = 4;  // rays, in [1, 1024]; a power of two is spread best
  PixelFilter::Kind filter = PixelFilter::Kind::kBlackmanHarris;
  int air_nodes = 12;  // Gauss nodes along a ray to the sky
  EffectSet effects = EffectSet::All();
  bool share_air = true;            // between rays of a pixel; false for comparison
  std::vector<std::string> layers;  // of KnownLayers()
  LampSettings lamps = {};
};

/// "depth" [m] and "normal" (ENU) of what stands in the middle of the pixel, not mixed with what is
/// beside it; means over the pixel as the picture is: "albedo", "transmittance" (of
/// air, fog and volumes), "inscatter" (of sun and sky in air), "volumes" (in fog and volumes, and
/// what these emit) and "lamps" (all that comes from lamps) [cd/m^2], "sun_visibility" (0 to 1) and
/// kScotopicLayer: what `layers` may name.
[[nodiscard]] const std::vector<std::string>& KnownLayers();

/// The layer of what rods see [scotopic cd/m^2]; its channel is kScotopicChannel.
inline constexpr const char* kScotopicLayer = "scotopic";

/// When a picture is taken, and from where.
struct Shot {
  Shot(const UtcInstant& at) : instant(at) {}  // NOLINT: by the scene's camera

  UtcInstant instant;
  /// Another camera with the scene's lens: of one pose, or of several that it takes at even steps
  /// of time while its shutter is open. Terrain stays where it is; light and air are as at the
  /// middle pose. The air stays on the sphere that osculates the ellipsoid at the scene's place,
  /// which the ellipsoid leaves by 3 m at 100 km and by 70 m at 500 km, the farthest that an eye
  /// may be.
  std::vector<CameraPose> poses;

  [[nodiscard]] std::optional<CameraPose> middle() const {
    if (poses.empty()) return std::nullopt;
    return poses[poses.size() / 2];
  }
};

/// A picture of what a scene needs.
struct ChosenPicture {
  Image image;
  EffectChoice choice;
};

/// A scene ready to be rendered at any time: terrain loaded, light of higher orders solved.
/// Immutable.
class SceneRenderer {
 public:
  /// Throws InputError for what the scene names and cannot be read, or an eye below the ground.
  explicit SceneRenderer(const Scene& scene);
  ~SceneRenderer();

  /// Linear sRGB in cd/m^2. The same bytes for any number of threads. Throws InputError for a layer
  /// that is not known, a size out of [1, 16384], and an eye that cannot be where it is; stops
  /// early when Interrupted().
  [[nodiscard]] Image Render(const Shot& shot, const RenderSettings& settings) const;

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
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow
