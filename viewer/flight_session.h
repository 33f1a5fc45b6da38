// SPDX-License-Identifier: MIT
// Provides FlightSession, an interactive flight through a scene: pilot and clock, atmosphere and land
// that follow the eye, exposure, and painted pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/medium/air_choice.h"
#include "lut/camera_tables/air_tables.h"
#include "lut/image/eye.h"
#include "lut/image/look.h"
#include "renderer/scene/scene.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/input/flight_controller.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/display_pass.h"
#include "viewer/passes/reference_picture.h"
#include "viewer/passes/sky_painter.h"
#include "viewer/passes/tone_map_pass.h"

namespace alpenglow::viewer {

/// Returns an EV that adapts to the metered EV, as an eye does: half way in 0.3 s. Without a value
/// `before` it is the metered EV.
[[nodiscard]] double AdaptedEv100(std::optional<double> before, double metered, double seconds);

/// Throws InputError unless the file's name ends in .png or .exr.
void RequirePictureName(const std::filesystem::path& file);

/// Returns a white balance that adapts to the metered one in the same way, in reciprocal colour
/// temperature.
[[nodiscard]] WhiteBalance AdaptedWhite(const WhiteBalance& before, const WhiteBalance& metered,
                                        double seconds);

/// Settings for the pictures of a flight.
struct FlightSessionSettings {
  LandSource land;
  QualityRule quality;
  double frame_rate = 20.0;  // target of automatic quality
  ImageSize size;            // size of the first picture
  /// Pictures are painted in tiles of at most this many pixels a side. Without a value, pictures
  /// that OpenGL can draw as a whole are not divided.
  std::optional<int> largest_part = {};
  ExposureRule exposure = {};  // metered, eye or fixed
  Look look = {};              // without local exposure and night vision
  FirstAir first_air = {};     // computed while the window is created, for an early first frame
};

/// Source of the exposure.
struct FlightExposure {
  bool locked = false;
  double compensation_ev = 0.0;  // positive values are brighter
  std::optional<double> ev100;   // as displayed; nullopt before the first picture
};

/// Look and exposure with which a picture is developed.
struct Development {
  Look look;  // with a definite white balance
  double ev100;
};

/// Everything that determines a picture of a flight besides its first scene and its settings. It is
/// a copy, so that the flight can continue while the picture is made.
struct FlightMoment {
  Eye eye;
  UtcInstant now;
  bool knows_ground = false;                   // false: the eye is not yet placed over the ground
  std::optional<double> waits_above_ground_m;  // height over the ground once that is known
  TerrainSource terrain;          // the built-in mountain range in use, if there is no other land
  Medium planet;                  // without the changes of `air`
  AirChoice air;                  // changes of the planet's atmosphere
  std::optional<Medium> sky_air;  // the changed medium under the eye; nullopt: that of the scene
  QualityRule quality;
  Look look;                          // its white balance may be automatic
  std::optional<WhiteBalance> white;  // as displayed; nullopt before the first picture
  ExposureRule exposure_rule;
  FlightExposure exposure;
  bool landing_light = false;
};

/// Receives the completed fraction [0, 1] between the steps of a picture that is being made. A step
/// of the GPU is at most one ray per pixel. An exception of this function ends the picture.
using PictureProgress = std::function<void(double share)>;

class FlightSession {
 public:
  /// Solves the atmosphere and starts to read the land. An OpenGL context must be current here and
  /// in all later calls. Throws InputError for files of the scene that cannot be read and for a
  /// medium of more than four wavelengths.
  FlightSession(const Scene& scene, const UtcInstant& start, const FlightSessionSettings& settings);

  /// Places the eye. If the placement has no height, the eye keeps its height over the ground. It
  /// is never placed inside the ground. If the built-in mountain range does not reach the place, it
  /// is moved there. If no other land reaches the place, a note is added.
  void Place(const EyePlacement& placement);
  /// Places the eye at a named place of the list. Land is handled as in Place.
  void GoTo(const std::string& name);
  /// Selects the built-in mountain range for a place that the current one does not cover: the range
  /// of the scene if that covers the place, otherwise RangeSeenFrom the place. It is read while
  /// drawing continues. Other land is not moved.
  void BringRangeTo(const GeodeticPosition& place);
  /// Puts an eye whose height is given above ground at its final height. Waits for the land there
  /// to load, except for a built-in range, because its ground height at the view is known in
  /// advance.
  void AwaitGround();
  /// Follows a path from its beginning.
  void Follow(const CameraPath& path);
  /// Replay shows a recorded flight; FlyAgain shows the current flight from its beginning and
  /// continues it afterwards. See FlightController.
  void Replay(const CameraPath& flight);
  void FlyAgain(const CameraPath& flown);
  /// Sets eye and time to those of a replay frame.
  void Show(const ReplayFrame& frame);

  /// Advances the flight by a number of real seconds with constant controls.
  void Advance(const PilotControls& controls, double seconds);
  /// Carries out an action. Returns a message about its result, which is empty if there is nothing
  /// to report; nullopt if this class does not handle the action.
  std::optional<std::string> Do(Action action);

  /// Advances the clock to the next such event of the sky. Returns a message that names it.
  [[nodiscard]] std::string JumpTo(SkyEvent event);

  void Use(const QualityRule& rule);
  /// Sets the look of the following pictures. Its white balance may be automatic.
  void Use(const Look& look);
  void Use(const AirChoice& choice);
  /// Uses the planet of a preset, with the changes that were made to the medium of the previous
  /// planet.
  void UsePlanet(const std::string& preset);
  void LockExposure(bool locked) { exposure_.locked = locked; }
  void SetExposure(double ev100);
  void Compensate(double ev) { exposure_.compensation_ev = ev; }

  /// Turns a landing light on or off. It points forward and is mounted below the eye.
  void SetLandingLight(bool is_on) { landing_light_ = is_on; }
  /// Returns the luminance [cd/m^2] in a picture of one or two frames ago, at fractions of its
  /// width and height from the upper left corner. Call it once a frame. Returns nullopt outside of
  /// the picture.
  [[nodiscard]] std::optional<double> LuminanceAt(double right, double down);
  void LeavePicture() { spot_.Leave(); }

  /// Paints onto a screen with the exposure of the meter. `seconds` is the time since the previous
  /// picture.
  void Paint(const ToneMapPass::Screen& screen, double seconds);
  /// Records the time that the last picture took without the wait for the screen. Automatic quality
  /// uses it.
  void NoteFrame(double seconds);

  /// Waits until all data for a picture of this size are ready.
  /// @param samples  rays per pixel of that picture.
  void Settle(const ImageSize& size, int samples = 1);
  /// Returns the linear picture as seen by the eye, with everything that is visible there. Any size
  /// is possible: a picture that OpenGL cannot draw as a whole is painted in tiles. Throws
  /// OptionError if memory is insufficient.
  [[nodiscard]] Image Picture(const ImageSize& size, int samples,
                              const PictureProgress& progress = {});
  /// Paints the view again with several rays per pixel and writes it: a .png is developed, an .exr
  /// is linear. Both have the settings of the picture in their headers. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, const ImageSize& size,
                    const PictureProgress& progress = {});
  /// Returns the scene for the renderer with the current eye and time. A scene file cannot describe
  /// land of several elevation models; for those it holds the land that is loaded around the eye.
  [[nodiscard]] ReferenceScene SceneForRenderer() const;
  /// Returns everything that another flight with the same scene and settings needs to make the same
  /// pictures.
  [[nodiscard]] FlightMoment Moment() const;
  /// Makes all following pictures show this moment.
  void TakeUp(const FlightMoment& moment);
  /// Paints the picture of WritePicture and develops it onto a screen. @return look and exposure.
  Development PaintStill(const ToneMapPass::Screen& screen, const PictureProgress& progress = {});
  /// Returns the metadata of a picture of this size, without its exposure.
  [[nodiscard]] Metadata PictureHeader(const ImageSize& size) const;
  /// Returns the metadata of exposure and development.
  [[nodiscard]] Metadata ExposureHeader(const Development& development) const;
  /// Writes pictures at equal time steps along the path, including both of its ends, and records
  /// their points.
  void WriteReplay(const CameraPath& path, const std::vector<std::filesystem::path>& files,
                   const ImageSize& size, FlightRecorder& recorder);
  /// Returns a developed picture of a film, `seconds` after the previous one, with adapted
  /// exposure.
  [[nodiscard]] DisplayImage Film(const ReplayFrame& frame, const ImageSize& size, double seconds);

  [[nodiscard]] FlightController& cockpit() { return cockpit_; }
  [[nodiscard]] const FlightController& cockpit() const { return cockpit_; }
  [[nodiscard]] const Eye& eye() const { return cockpit_.pilot().eye(); }
  [[nodiscard]] const UtcInstant& now() const { return cockpit_.clock().now(); }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Returns the scene from which another flight starts.
  [[nodiscard]] const Scene& first_scene() const { return first_scene_; }
  [[nodiscard]] const FlightSessionSettings& settings() const { return settings_; }
  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] const AirChoice& air_choice() const { return air_; }
  [[nodiscard]] const FlightExposure& exposure() const { return exposure_; }
  /// Returns the look as selected by the user; its white balance may be automatic.
  [[nodiscard]] const Look& look() const { return look_; }
  /// Returns the colour temperature of the light that is displayed as white [K]; nullopt before the
  /// first picture.
  [[nodiscard]] std::optional<double> white_k() const;
  /// Returns new notes about land and places. Each note is returned once.
  [[nodiscard]] std::vector<std::string> TakeNotes();
  /// Returns a function for the height of the ground under a place. Without land it returns the
  /// height of the bare planet. Near the view of the built-in mountain range it returns the known
  /// height before the range is loaded.
  [[nodiscard]] GroundHeight Ground() const;
  /// Returns whether the ground under the eye has been known since the eye was placed, including
  /// the case that there is no land. Until the land there is loaded, the eye may be inside the
  /// ground; afterwards it never is.
  [[nodiscard]] bool KnowsGround() const { return knows_ground_; }
  [[nodiscard]] SkyPainter& painter() { return painter_; }
  [[nodiscard]] const SkyPainter& painter() const { return painter_; }
  /// Returns "auto: medium at 0.7x", "high", or "reference, 16 rays a pixel".
  [[nodiscard]] std::string QualityText() const;
  [[nodiscard]] const QualityRule& quality_rule() const { return rule_; }
  [[nodiscard]] std::string zone() const;

 private:
  [[nodiscard]] PaintedView ViewOf(const ImageSize& size) const;
  /// Returns the scene as seen by the eye, without land of several elevation models.
  [[nodiscard]] Scene SceneSeen() const;
  [[nodiscard]] PaintedQuality Painted() const;
  /// Returns the EV for the current rule of exposure, after the adaptation of the eye.
  [[nodiscard]] double AdaptedTo(double metered_ev100, double seconds);
  void Expose(const MeterReading& metered, double seconds);
  /// Returns whether the clock has jumped by more than a quarter of an hour since the last frame.
  [[nodiscard]] bool HasJumped();
  void ForgetAdaptation();
  /// Returns the development of a picture without a preceding frame: that of the displayed frames
  /// if there are any, otherwise the metered one.
  [[nodiscard]] Development DevelopmentOf(const Image& picture) const;
  [[nodiscard]] Image PaintedInParts(const PaintedView& whole, int samples,
                                     const PictureProgress& progress);
  void ForgetGround(std::optional<double> above_ground_m = std::nullopt);
  [[nodiscard]] bool IsRangeExpectedAt(const GeodeticPosition& place) const;
  void UseRange(const TerrainSource& range);
  void BringLandTo(const GeodeticPosition& place, const std::string& name);
  void StandOnGround();
  void AimLandingLight();
  void ShowReference(const ImageSize& size);
  /// Returns a function that samples the loaded land around the eye for the renderer.
  [[nodiscard]] std::function<std::shared_ptr<const SceneGround>()> GroundAround() const;
  Scene first_scene_;  // as passed to the constructor
  FlightSessionSettings settings_;
  Scene scene_;
  TerrainSource first_terrain_;  // terrain of the original scene
  bool has_range_;               // the land is the built-in range and nothing else
  bool has_one_model_;           // neither several elevation models nor a folder of them
  Medium medium_;                // unchanged medium of the preset or file
  AirChoice air_;
  std::optional<Medium> sky_air_;  // changed, on the sphere under the eye when it was changed
  QualityRule rule_;
  AutoQuality auto_;
  PaintedQuality used_;
  FlightController cockpit_;
  DisplayPass darkroom_;  // constructed before the painter: both take long and run in parallel
  SkyPainter painter_;
  ExposureRule rule_of_exposure_;
  Look look_;  // as selected; its white balance may be automatic
  ExposureMeter meter_;
  SpotMeter spot_;
  FlightExposure exposure_;
  std::optional<MeterReading> metered_;
  EyeAdaptation adaptation_;              // for the exposure rule `eye`
  std::optional<UtcInstant> adapted_at_;  // time of the last adaptation
  std::optional<UtcInstant> painted_at_;
  std::optional<WhiteBalance> white_;  // as displayed; nullopt before the first picture
  bool landing_light_ = false;
  bool knows_ground_ = false;                   // since the eye was placed
  std::optional<double> waits_above_ground_m_;  // height over the ground once that is known
  std::optional<Eye> put_at_;                   // the eye as placed by AwaitGround
  std::vector<std::string> notes_;
  std::unique_ptr<ReferencePicture> reference_;
  std::shared_ptr<const ReferenceScene> reference_scene_;
  std::optional<Eye> still_eye_;
  double still_s_ = 0.0;
};

}  // namespace alpenglow::viewer
