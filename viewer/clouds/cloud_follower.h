// SPDX-License-Identifier: MIT
// Provides the clouds of a scene for drawing: fields, sun maps and solutions of the renderer are made
// on a thread beside drawing, for the time and the light of the moment. Drawing moves the fields with
// the wind since the time for which they were made, and fades from one solution to the next.
#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/time_place/geodesy.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"
#include "viewer/clouds/cloud_texels.h"
#include "viewer/clouds/cloud_textures.h"
#include "viewer/flight/flight.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Time, place and light for which clouds are made.
struct CloudMoment {
  std::shared_ptr<const SolvedAir> air;  // on the sphere under the scene
  std::shared_ptr<const Scene> scene;
  UtcTime now;
  DistantLight light;     // in the frame of the scene
  double eye_altitude_m;  // the clouds in its sight are lit, see CloudsByTime::Light
};

/// Colours of the light of clouds, for unit solar irradiance.
struct CloudColours {
  std::vector<glm::vec4> sky_low, sky_high, ground_low, ground_high;  // of each layer
  struct Interface {
    float low_m, left;  // see LitClouds::InterfaceLight
    glm::vec4 added, diffuse;
    std::vector<glm::vec4> diffuse_towards;  // empty: `diffuse` in all directions
  };
  std::vector<Interface> interfaces;
};

/// Clouds of one moment.
struct MadeClouds {
  CloudMoment of;
  std::shared_ptr<const CloudTexels> texels;
  CloudColours colours;
};

/// Place of an eye in the flat frame of the clouds.
struct EyeInClouds {
  glm::dvec3 at;    // x, y along the ground, and the altitude [m]
  double turn_rad;  // from the axes of the eye to those of the clouds, counter-clockwise
};

class CloudFollower {
 public:
  /// @param ground  of the scene, if that has clouds.
  CloudFollower(const Scene& scene, const SceneGround& ground);

  /// Returns whether the scene has clouds.
  [[nodiscard]] bool HasAny() const { return !scene_->clouds.empty(); }
  /// Returns whether clouds are drawn now.
  [[nodiscard]] bool IsShown() const { return shown_ != nullptr && layers() > 0; }
  /// Returns the number of layers that are drawn.
  [[nodiscard]] std::size_t layers() const;

  /// Replaces the clouds of the scene. The new ones are made as soon as they have not been replaced for
  /// a moment, and then fade in.
  /// @param ground_m  height of the ground at the scene's place, for the first clouds of a scene that
  ///     began without any.
  void Use(const std::vector<SceneCloud>& clouds, double ground_m);
  [[nodiscard]] const Place& place() const { return scene_->place; }
  [[nodiscard]] const std::vector<SceneCloud>& clouds() const { return scene_->clouds; }

  /// Takes finished clouds and requests missing ones. Call it once a frame.
  /// @param light  as seen from the eye. @param seconds  since the last call.
  void Follow(const std::shared_ptr<const SolvedAir>& air, const Place& eye, const UtcTime& now,
              const DistantLight& light, double seconds);
  /// Waits for the clouds of the moment.
  void WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const Place& eye,
                      const UtcTime& now, const DistantLight& light);

  /// Returns the uniform block for an eye.
  [[nodiscard]] CloudsBlock BlockFor(const Place& eye, const UtcTime& now) const;
  [[nodiscard]] EyeInClouds EyeAt(const Place& eye) const;
  /// Returns the extinction by clouds at a place [1/m].
  [[nodiscard]] double ExtinctionAt(const Place& place, const UtcTime& now) const;

  /// Clouds that are drawn, with their share of the picture.
  struct Shown {
    std::shared_ptr<CloudTextures> textures;
    MadeClouds made;
  };
  [[nodiscard]] const Shown& shown() const { return *shown_; }
  /// Returns the clouds that fade out; null: none.
  [[nodiscard]] const Shown* earlier() const { return earlier_.get(); }
  /// Returns the share of the shown clouds, in [0, 1].
  [[nodiscard]] double share() const { return share_; }

  /// Texture unit for uploads.
  static constexpr int kUploadUnit = 6;
  static constexpr double kFade_s = 1.5;

 private:
  class Maker;
  [[nodiscard]] CloudMoment MomentOf(const std::shared_ptr<const SolvedAir>& air, const Place& eye,
                                     const UtcTime& now, const DistantLight& light) const;
  [[nodiscard]] static bool Suits(const CloudMoment& made, const CloudMoment& wanted);
  /// Starts the thread, if there are clouds to make.
  void Begin();
  void TakeOver(MadeClouds made);
  void Show();

  std::shared_ptr<const Scene> scene_;
  LocalFrame frame_;
  double ground_m_ = 0.0;  // height of the ground at the scene's place
  std::shared_ptr<Shown> coming_, shown_, earlier_;
  double share_ = 1.0;
  double settles_s_ = 0.0;  // until changed clouds are requested
  std::optional<AsyncValue<CloudMoment, MadeClouds>> maker_;
};

}  // namespace alpenglow::viewer
