// SPDX-License-Identifier: MIT
// A scene flown through: pilot and clock, air and land as they follow, exposure, and the picture.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lut/picture/eye.h"
#include "lut/picture/look.h"
#include "renderer/scene/scene.h"
#include "viewer/air/solved_air.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/input/cockpit.h"
#include "viewer/paint/auto_quality.h"
#include "viewer/paint/darkroom.h"
#include "viewer/paint/developer.h"
#include "viewer/paint/reference_picture.h"
#include "viewer/paint/sky_painter.h"

namespace alpenglow::viewer {

/// Exposure that follows the meter like an eye: half
/// way in 0.3 s. A first exposure is the metered one.
[[nodiscard]] double AdaptedEv100(std::optional<double> before, double metered, double seconds);

/// Throws InputError unless the file's name ends in .png or .exr.
void RequirePictureName(const std::filesystem::path& file);

/// White balance that follows the meter like that, in reciprocal temperature.
[[nodiscard]] WhiteBalance AdaptedWhite(const WhiteBalance& before, const WhiteBalance& metered,
                                        double seconds);

/// How pictures of a flight are painted.
struct FlythroughSettings {
  LandSource land;
  QualityRule quality;
  double frame_rate = 20.0;  // that automatic quality keeps
  ImageSize size;            // of the first picture
  /// Pictures are painted in parts of at most so many pixels a side; nothing: in one piece as far as
  /// OpenGL draws them.
  std::optional<int> largest_part = {};
  ExposureRule exposure = {};  // metered, eye or fixed
  Look look = {};              // without local exposure and night vision
  FirstAir first_air = {};  // solved beside the making of a window, the first frame is sooner there
};

/// Where the exposure comes from.
struct FlightExposure {
  bool locked = false;
  double compensation_ev = 0.0;  // over 0 is brighter
  std::optional<double> ev100;   // as shown; nothing before the first picture
};

/// How a picture is developed.
struct Development {
  Look look;  // settled
  double ev100;
};

/// All that a picture of a flight depends on, besides the scene and settings that it began with: a
/// copy, so that the flight may go on while the picture is made.
struct FlightMoment {
  Eye eye;
  UtcInstant now;
  bool knows_ground = false;                   // else the eye is yet to be put over it
  std::optional<double> waits_above_ground_m;  // as high, once it is known
  TerrainSource terrain;          // the range that is there, where there is no other land
  Medium planet;                  // without changes
  AirChoice air;                  // changes of it
  std::optional<Medium> sky_air;  // the changed one under the eye; nothing: that of the scene
  QualityRule quality;
  Look look;                          // not settled
  std::optional<WhiteBalance> white;  // as shown; nothing before the first picture
  ExposureRule exposure_rule;
  FlightExposure exposure;
  bool landing_light = false;
};

/// Told between the parts of a picture that is being made, of the graphics card's work none longer
/// than one ray a pixel: the share that is done [0, 1]. What it throws ends the picture.
using PictureProgress = std::function<void(double share)>;

class Flythrough {
 public:
  /// Solves the air and begins to read the land: an OpenGL context must be current, now and in all
  /// calls. Throws InputError for what the scene names and cannot be read, and a medium of more than
  /// four wavelengths.
  Flythrough(const Scene& scene, const UtcInstant& start, const FlythroughSettings& settings);

  /// Puts the eye there. Without a height it keeps the one it had over the ground; it never comes
  /// to stand in the ground. The built-in range comes along to a place off it; of a place that no
  /// other land reaches there is a note.
  void Place(const EyePlacement& placement);
  /// Puts the eye at a place of the list, by name. Land as in Place.
  void GoTo(const std::string& name);
  /// The built-in range of a place, where the one that is there does not reach it: that of the
  /// scene where it does, else RangeSeenFrom the place. Read beside drawing. No other land moves.
  void BringRangeTo(const GeodeticPosition& place);
  /// Puts an eye that counts its height from the ground at the height at which it will stay: waits
  /// for the land there, but not for a range, whose ground under the view is known.
  void AwaitGround();
  /// Flies along a path from its beginning.
  void Follow(const CameraPath& path);
  /// Shows a flight as it was, and what was flown so far: see Cockpit.
  void Replay(const CameraPath& flight);
  void FlyAgain(const CameraPath& flown);
  /// Puts the eye and the time where a replay has them.
  void Show(const ReplayFrame& frame);

  /// Lets real seconds pass, with the controls held like this.
  void Advance(const PilotControls& controls, double seconds);
  /// What an action came to, in words; empty: nothing to say; nothing: it is for others.
  std::optional<std::string> Do(Action action);

  /// Moves the clock on to what the sky does next; says to what.
  [[nodiscard]] std::string JumpTo(SkyEvent event);

  void Use(const QualityRule& rule);
  /// Another look, from the next picture on; its white balance is not settled.
  void Use(const Look& look);
  void Use(const AirChoice& choice);
  /// Another planet by the name of a preset, with the changes that were made to the last one.
  void UsePlanet(const std::string& preset);
  void LockExposure(bool locked) { exposure_.locked = locked; }
  void SetExposure(double ev100);
  void Compensate(double ev) { exposure_.compensation_ev = ev; }

  /// A landing light ahead and below, or none.
  void SetLandingLight(bool is_on) { landing_light_ = is_on; }
  /// Luminance of a picture of a frame or two ago [cd/m^2], at shares of its width and height from
  /// the upper left; asked once a frame. Nothing outside.
  [[nodiscard]] std::optional<double> LuminanceAt(double right, double down);
  void LeavePicture() { spot_.Leave(); }

  /// Paints onto a screen, exposed as the meter says. `seconds` since the last picture.
  void Paint(const Developer::Screen& screen, double seconds);
  /// What took the last picture, without waiting for the screen, for automatic quality.
  void NoteFrame(double seconds);

  /// Waits until all is there that a picture of this size needs.
  /// @param samples  rays a pixel that it will have.
  void Settle(const ImageSize& size, int samples = 1);
  /// The linear picture of where the eye is, with all that belongs into it there. Of any size: what
  /// OpenGL cannot draw in one piece is painted in parts. Throws OptionError when memory does not
  /// hold it.
  [[nodiscard]] Image Picture(const ImageSize& size, int samples,
                              const PictureProgress& progress = {});
  /// Paints anew with several rays a pixel and writes what is seen: .png developed, .exr linear,
  /// both with what made them in their headers. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, const ImageSize& size,
                    const PictureProgress& progress = {});
  /// What the renderer would render: the scene from the eye, now, and where a scene cannot say what
  /// the land is, of several elevation models, the land that is loaded around the eye.
  [[nodiscard]] ReferenceScene SceneForRenderer() const;
  /// What another flight of the same scene and settings needs in order to make the same pictures.
  [[nodiscard]] FlightMoment Moment() const;
  /// Pictures are those of that moment from here on.
  void TakeUp(const FlightMoment& moment);
  /// The picture of WritePicture, developed onto a screen. @return how.
  Development PaintStill(const Developer::Screen& screen, const PictureProgress& progress = {});
  /// What made a picture of this size, but its exposure.
  [[nodiscard]] Metadata PictureHeader(const ImageSize& size) const;
  /// How it was exposed and developed.
  [[nodiscard]] Metadata ExposureHeader(const Development& development) const;
  /// Writes pictures at even steps of the path, its ends included, and notes them down.
  void WriteReplay(const CameraPath& path, const std::vector<std::filesystem::path>& files,
                   const ImageSize& size, FlightRecorder& recorder);
  /// A picture of a film, `seconds` after the one before: developed, the exposure adapted.
  [[nodiscard]] DisplayImage Film(const ReplayFrame& frame, const ImageSize& size, double seconds);

  [[nodiscard]] Cockpit& cockpit() { return cockpit_; }
  [[nodiscard]] const Cockpit& cockpit() const { return cockpit_; }
  [[nodiscard]] const Eye& eye() const { return cockpit_.pilot().eye(); }
  [[nodiscard]] const UtcInstant& now() const { return cockpit_.clock().now(); }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// With which another flight of this scene begins.
  [[nodiscard]] const Scene& first_scene() const { return first_scene_; }
  [[nodiscard]] const FlythroughSettings& settings() const { return settings_; }
  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] const AirChoice& air_choice() const { return air_; }
  [[nodiscard]] const FlightExposure& exposure() const { return exposure_; }
  /// As asked for: its white balance is not settled.
  [[nodiscard]] const Look& look() const { return look_; }
  /// Temperature of the light that is shown as white [K]; nothing before the first picture.
  [[nodiscard]] std::optional<double> white_k() const;
  /// What land and places give occasion to tell, each once.
  [[nodiscard]] std::vector<std::string> TakeNotes();
  /// Height of the ground under a place; of the bare planet where there is no land, of the built-in
  /// range about its view before it is made.
  [[nodiscard]] GroundHeight Ground() const;
  /// Whether the eye stands where it was put: over the ground there, or where there is none. Until
  /// the land under a place is loaded it may be inside; from then on it never is.
  [[nodiscard]] bool KnowsGround() const { return knows_ground_; }
  [[nodiscard]] SkyPainter& painter() { return painter_; }
  [[nodiscard]] const SkyPainter& painter() const { return painter_; }
  /// "auto: medium at 0.7x", "high", "reference, 16 rays a pixel".
  [[nodiscard]] std::string QualityText() const;
  [[nodiscard]] const QualityRule& quality_rule() const { return rule_; }
  [[nodiscard]] std::string zone() const;

 private:
  [[nodiscard]] PaintedView ViewOf(const ImageSize& size) const;
  /// Without land of several elevation models.
  [[nodiscard]] Scene SceneSeen() const;
  [[nodiscard]] PaintedQuality Painted() const;
  /// The EV that the rule of exposure has it for, by the eye as it has adapted.
  [[nodiscard]] double AdaptedTo(double metered_ev100, double seconds);
  void Expose(const MeterReading& metered, double seconds);
  /// The clock has jumped by over a quarter of an hour since the last frame.
  [[nodiscard]] bool HasJumped();
  void ForgetAdaptation();
  /// Of a picture without a frame before it: as frames are, or as it is metered.
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
  /// The land that is loaded around the eye, for the renderer.
  [[nodiscard]] std::function<std::shared_ptr<const SceneGround>()> GroundAround() const;
  Scene first_scene_;  // as it was given
  FlythroughSettings settings_;
  Scene scene_;
  TerrainSource first_terrain_;  // of the scene as it was read
  bool has_range_;               // and no other land
  bool has_one_model_;           // not several elevation models, nor a folder of them
  Medium medium_;                // of the preset or file, unchanged
  AirChoice air_;
  std::optional<Medium> sky_air_;  // changed, on the sphere under the eye that it had then
  QualityRule rule_;
  AutoQuality auto_;
  PaintedQuality used_;
  Cockpit cockpit_;
  Darkroom darkroom_;  // before the painter: both take their time to make, side by side
  SkyPainter painter_;
  ExposureRule rule_of_exposure_;
  Look look_;  // as asked for: its white balance is not settled
  ExposureMeter meter_;
  SpotMeter spot_;
  FlightExposure exposure_;
  std::optional<MeterReading> metered_;
  EyeAdaptation adaptation_;              // of the rule eye
  std::optional<UtcInstant> adapted_at_;  // the moment that it followed last
  std::optional<UtcInstant> painted_at_;
  std::optional<WhiteBalance> white_;  // as shown; nothing before the first picture
  bool landing_light_ = false;
  bool knows_ground_ = false;                   // under the eye, since it was put there
  std::optional<double> waits_above_ground_m_;  // until then: how high it will stand over it
  std::optional<Eye> put_at_;                   // over ground that is expected, by AwaitGround
  std::vector<std::string> notes_;
  std::unique_ptr<ReferencePicture> reference_;
  std::shared_ptr<const ReferenceScene> reference_scene_;
  std::optional<Eye> still_eye_;
  double still_s_ = 0.0;
};

}  // namespace alpenglow::viewer
