// SPDX-License-Identifier: MIT
// A scene flown through: eye, time and exposure, what keys do to them, and the picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lut/picture/picture_text.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/scene/scene.h"
#include "viewer/flight/clock.h"
#include "viewer/flight/flight.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/paint/sky_painter.h"

namespace alpenglow {

/// What a key press asks for.
enum class Command {
  kFasterTime,
  kSlowerTime,
  kNarrowerView,
  kWiderView,
  kScreenshot,
  kHud,
  kQuit
};

/// Exposure that follows the meter like an eye: half
/// way in 0.3 s. A first exposure is the metered one.
[[nodiscard]] double AdaptedEv100(std::optional<double> before, double metered, double seconds);

/// Throws InputError unless the file's name ends in .png or .exr.
void RequirePictureName(const std::filesystem::path& file);

class Flythrough {
 public:
  /// Loads the terrain, solves the diffuse light, fills the graphics card: an OpenGL context must
  /// be current, now and in all calls. The scene starts at `start`. Throws InputError for what the
  /// scene names and cannot be read, and a medium of more than four wavelengths.
  Flythrough(const Scene& scene, const UtcInstant& start);

  /// Puts the eye there. Without a height it keeps the one it had over the ground; it never comes
  /// to stand in the ground.
  void Place(const EyePlacement& placement);
  /// Lets `seconds` pass, with the controls held like this.
  void Advance(const Steering& steering, double seconds);
  void Turn(double right_rad, double up_rad) { eye_ = Turned(eye_, right_rad, up_rad); }
  /// kScreenshot writes the next free of skyview-0001.png, ... in the current folder.
  void Do(Command command);

  /// Paints into a framebuffer (0: the window), exposed as the meter says.
  void Paint(int width, int height, GLuint framebuffer, double seconds);
  /// Paints anew with four rays a pixel and writes what is seen: .png developed, .exr linear, both
  /// with what made them in their headers. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, int width, int height);

  /// Puts the eye and the time where a replay has them; the eye never comes to stand in the ground.
  void Show(const ReplayFrame& frame);

  /// Writes pictures at even steps of the path, its ends included, and notes them down.
  void WriteReplay(const CameraPath& path, const std::vector<std::filesystem::path>& files,
                   const ImageSize& size, FlightRecorder& recorder);

  /// A picture of a film, `seconds` after the one before: developed, the exposure adapted.
  [[nodiscard]] DisplayImage Film(const ReplayFrame& frame, const ImageSize& size, double seconds);

  [[nodiscard]] const Eye& eye() const { return eye_; }
  [[nodiscard]] const UtcInstant& now() const { return now_; }
  [[nodiscard]] bool quit() const { return quit_; }
  /// Place, height, heading, time, sun and exposure in one line; empty when hidden.
  [[nodiscard]] std::string HudText() const;
  /// What loading the terrain has to tell, empty if nothing.
  [[nodiscard]] const std::string& terrain_message() const { return ground_.message; }

 private:
  [[nodiscard]] double GroundUnder(const GeodeticPosition& place) const;

  Scene scene_;
  SceneGround ground_;
  SkyPainter painter_;
  Eye eye_;
  UtcInstant now_;
  double time_rate_ = 1.0;
  std::optional<double> ev100_;
  int width_ = 0, height_ = 0;  // of the last picture
  bool hud_ = true, quit_ = false;
};

}  // namespace alpenglow
