// SPDX-License-Identifier: MIT
// Provides SceneEdits, the scene of a flight with the changes of its air and its land, and
// Standpoint, which puts the eye at places over ground that may not be loaded yet.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "atmosphere/medium/medium_presets.h"
#include "renderer/picture/reference_picture.h"
#include "renderer/scene/scene.h"
#include "renderer/series/scene_metadata.h"
#include "viewer/flight/flight_controller.h"
#include "viewer/passes/sky_painter.h"

namespace alpenglow::viewer {

/// Changes of the scene of a flight since its start.
struct SceneChanges {
  TerrainSource terrain;          // the built-in mountain range in use, if there is no other land
  Medium planet;                  // without the changes of `air`
  AirChoice air;                  // changes of the planet's atmosphere
  std::optional<Medium> sky_air;  // the changed medium under the eye; nullopt: that of the scene
  std::shared_ptr<const std::vector<SceneCloud>> clouds = nullptr;  // null: those of the scene
};

class SceneEdits {
 public:
  /// Keeps a reference to the painter, which draws the scene with this land.
  SceneEdits(const Scene& scene, const LandSource& land, SkyPainter& painter);

  /// Changes the clouds. Throws InputError if an option is out of its range over the ground of the
  /// scene, or if their fields may need more memory than there is.
  void Use(const std::vector<SceneCloud>& clouds);
  /// Changes the air.
  /// @param place  of the eye: the medium lies on the sphere under it.
  void Use(const AirChoice& choice, const Place& place);
  /// Uses the planet of a preset, with the changes that were made to the medium of the previous
  /// planet. Throws InputError for a preset with another shape of the planet.
  void UsePlanet(const std::string& preset, const Place& place);

  /// Selects the built-in mountain range for a place that the current one does not cover: the range
  /// of the scene if that covers the place, otherwise RangeSeenFrom the place. It is read while
  /// drawing continues. Other land is not moved.
  void BringRangeTo(const Place& place);
  /// Does the same for a place of this name where the eye arrives. If no land reaches the place, a
  /// note is added.
  void BringLandTo(const Place& place, const std::string& name);
  /// Returns whether the built-in mountain range will be loaded near its view at a place; the
  /// height of its ground there is known in advance.
  [[nodiscard]] bool IsRangeExpectedAt(const Place& place) const;
  /// Returns the height of the ground under a place [m]. Without land it returns the height of the
  /// bare planet. Near the view of the built-in mountain range it returns the known height before
  /// the range is loaded.
  [[nodiscard]] double GroundAt(const Place& place) const;
  /// Waits until the land at a place is loaded, if there is any.
  void AwaitGround(const Place& place);

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Landscape& land() const { return painter_.land(); }
  [[nodiscard]] const Medium& planet() const { return changes_.planet; }
  [[nodiscard]] const AirChoice& air_choice() const { return changes_.air; }
  [[nodiscard]] const SceneChanges& changes() const { return changes_; }
  /// Makes the same changes as another flight of the same scene.
  void Restore(const SceneChanges& changes);
  /// Returns a number that increases with each change.
  [[nodiscard]] int version() const { return version_; }

  /// Returns the scene as seen by an eye.
  [[nodiscard]] Scene SeenBy(const CameraPose& eye, const UtcTime& now) const;
  /// Returns hashes of the files of the scene, which were read when the scene was loaded. Throws
  /// InputError if one could not be read.
  [[nodiscard]] const FileHashes& file_hashes() const { return file_hashes_.get(); }
  /// Returns the scene for the renderer. A scene file cannot describe land of several elevation
  /// models; for those it holds the land that is loaded around the eye.
  [[nodiscard]] ReferenceScene ForRenderer(const CameraPose& eye, const UtcTime& now) const;
  /// Returns the name of the time zone at a place.
  [[nodiscard]] std::string ZoneAt(const Place& place) const;
  /// Returns new notes about land and places. Each note is returned once.
  [[nodiscard]] std::vector<std::string> PollNotes();

 private:
  void BeginHashing();
  void UseRange(const TerrainSource& range);
  /// Returns a function that samples the loaded land around the eye for the renderer.
  [[nodiscard]] std::function<std::shared_ptr<const SceneGround>()> GroundAround(
      const Place& place) const;

  SkyPainter& painter_;
  Scene scene_;
  TerrainSource first_terrain_;  // terrain of the original scene
  bool has_range_;               // the land is the built-in range and nothing else
  bool has_one_model_;           // neither several elevation models nor a folder of them
  SceneChanges changes_;
  int version_ = 0;
  std::vector<std::string> notes_;
  std::shared_future<FileHashes> file_hashes_;
  std::jthread hashing_;  // last member: its thread ends before the other members
};

/// Place of the eye over the ground. The ground may be known only after the eye is there: until the
/// land there is loaded, the eye may be inside the ground; afterwards it never is.
class Standpoint {
 public:
  /// Keeps references to all of them.
  Standpoint(FlightController& controller, SceneEdits& scene, SkyPainter& painter)
      : controller_(controller), scene_(scene), painter_(painter) {}

  /// Places the eye. If the placement has no height, the eye keeps its height over the ground. It
  /// is never placed inside the ground. Land is brought to the place (SceneEdits).
  void MoveTo(const EyePlacement& placement);
  /// Places the eye at a named place of the list. Throws InputError for an unknown name.
  void GoTo(const std::string& name);
  /// Puts an eye whose height is given above ground at its final height. Waits for the land there
  /// to load, except for a built-in range, because its ground height at the view is known in
  /// advance.
  void AwaitGround();
  /// Does the same if the land there is loaded, without waiting. Call it once a frame.
  void StandOnGround();
  /// Forgets the ground: the eye is somewhere else.
  /// @param above_ground_m  height over the ground that the eye gets once that is known.
  void Leave(std::optional<double> above_ground_m = std::nullopt);
  /// Returns whether the ground under the eye has been known since the eye was placed, including
  /// the case that there is no land.
  [[nodiscard]] bool KnowsGround() const { return state_.knows_ground; }

  struct State {
    bool knows_ground = false;                   // since the eye was placed
    std::optional<double> waits_above_ground_m;  // height over the ground once that is known
  };
  [[nodiscard]] const State& state() const { return state_; }
  void Restore(const State& state) { state_ = state; }

 private:
  [[nodiscard]] const CameraPose& eye() const { return controller_.pilot().eye(); }

  FlightController& controller_;
  SceneEdits& scene_;
  SkyPainter& painter_;
  State state_;
  std::optional<CameraPose> put_at_;  // the eye as placed by AwaitGround
};

}  // namespace alpenglow::viewer
