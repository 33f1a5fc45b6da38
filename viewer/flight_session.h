// SPDX-License-Identifier: MIT
// Provides FlightSession, an interactive flight through a scene. It connects pilot and clock, the
// scene with its changes, exposure, and the painted frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "viewer/flight/flight_controller.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/passes/display_pass.h"
#include "viewer/passes/exposure_control.h"
#include "viewer/passes/frame_renderer.h"
#include "viewer/passes/sky_painter.h"
#include "viewer/scene_edits.h"

namespace alpenglow::viewer {

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
  FirstAir first_air = {};     // null: the flight solves its air
};

/// Scene and settings from which a flight starts.
struct FlightStart {
  Scene scene;
  FlightSessionSettings settings;
};

/// Everything that determines a picture of a flight besides its start. It is a copy, so that the
/// flight can continue while the picture is made.
struct FlightMoment {
  CameraPose eye;
  UtcTime now;
  Standpoint::State standpoint;
  SceneChanges scene;
  QualityRule quality;
  ExposureControl exposure;
  bool landing_light = false;
};

class FlightSession {
 public:
  /// Solves the atmosphere and starts to read the land. An OpenGL context must be current here and
  /// in all later calls. Throws InputError for files of the scene that cannot be read and for a
  /// medium of more than four wavelengths.
  FlightSession(const Scene& scene, const UtcTime& start, const FlightSessionSettings& settings);
  FlightSession(const FlightSession&) = delete;
  FlightSession& operator=(const FlightSession&) = delete;

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
  /// Paints onto a screen with the exposure of the meter. `seconds` is the time since the previous
  /// picture.
  void Paint(const ToneMapPass::Screen& screen, double seconds);
  /// Waits until the eye stands where it belongs and all data for a frame of this size are ready.
  void WaitUntilReady(const ImageSize& size);

  /// Returns everything that another flight with the same start needs to make the same pictures.
  [[nodiscard]] FlightMoment Moment() const;
  /// Makes all following pictures show this moment.
  void TakeUp(const FlightMoment& moment);
  /// Returns the report of ExplainView (reports.h) for the current view.
  [[nodiscard]] std::string Explain(const ImageSize& size);

  [[nodiscard]] const CameraPose& eye() const { return controller_.pilot().eye(); }
  [[nodiscard]] const UtcTime& now() const { return controller_.clock().now(); }
  /// Returns the name of the time zone at the eye.
  [[nodiscard]] std::string zone() const { return edits_.ZoneAt(eye().place); }
  /// Returns the view of a written picture. Its field of view is that of the scene or path, up to
  /// 179 degrees, or it is a panorama.
  [[nodiscard]] PaintedView ViewOf(const ImageSize& size) const {
    return {eye(), now(), size.width, size.height};
  }
  [[nodiscard]] const FlightStart& start() const { return start_; }
  [[nodiscard]] FlightController& controller() { return controller_; }
  [[nodiscard]] Standpoint& standpoint() { return standpoint_; }
  [[nodiscard]] SceneEdits& edits() { return edits_; }
  [[nodiscard]] ExposureControl& exposure() { return exposure_; }
  [[nodiscard]] FrameRenderer& frames() { return frames_; }

 private:
  FlightStart start_;
  FlightController controller_;
  ExposureControl exposure_;
  DisplayPass display_pass_;  // constructed before the painter: both take long and run in parallel
  SkyPainter painter_;
  SceneEdits edits_;
  Standpoint standpoint_;
  FrameRenderer frames_;
};

}  // namespace alpenglow::viewer
