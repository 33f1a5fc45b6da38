// SPDX-License-Identifier: MIT
// Provides ViewerApp, the user interface of a flight: keyboard, mouse and gamepad input,
// instruments, panels and messages, and the values of the flight that these show. It also keeps a
// log of the flight, which can be saved and replayed.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "atmosphere/base/async_value.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/flight_session.h"
#include "viewer/hud/day_strip.h"
#include "viewer/hud/hud.h"
#include "viewer/hud/hud_model.h"
#include "viewer/input/action.h"
#include "viewer/input/controls.h"
#include "viewer/picture_queue.h"

namespace alpenglow::viewer {

/// Keys, gamepad and panels change the flight through its FlightCommands.
class ViewerApp final : public FlightCommands {
 public:
  struct Settings {
    double hud_scale = 1.0;
    bool shows_hud = true;
    ControlSettings controls;
  };
  /// Keeps references to the flight and to the recorder. The panels start and stop the recorder. The
  /// recorder outlives the ViewerApp, so that the recorded flight is complete however that ends.
  ViewerApp(FlightSession& flight, FlightRecorder& recorder, const Settings& settings);
  /// Finishes the requested pictures and writes their outcomes that were not yet displayed to
  /// standard error.
  ~ViewerApp() override;
  ViewerApp(const ViewerApp&) = delete;
  ViewerApp& operator=(const ViewerApp&) = delete;

  /// Applies the input of keyboard, mouse, gamepad and panels, and advances the flight. Call it
  /// once a frame, whether the frame is displayed or not.
  void Advance(const InputFrame& input);
  /// Paints the flight and draws the instruments over it.
  void Paint(const ToneMapPass::Screen& screen, double seconds);

  /// Writes a developed picture with instruments, as displayed on the screen. It is written before
  /// the call returns. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, const ImageSize& size);

  void Leave() override;
  /// Waits for the pictures after the display of the window is lost, and writes their outcomes to
  /// standard error.
  void FinishWithoutWindow();

  void Report(const std::string& message) override;

  /// Returns whether the user has left the flight and all pictures are written.
  [[nodiscard]] bool quit() const { return leaves_ && !pictures_.UnderWay(); }
  [[nodiscard]] MouseMode mouse_mode() const { return controls_.mouse_mode(); }
  /// Returns whether a change between window and full screen was requested since the last call.
  [[nodiscard]] bool TakeFullScreen() { return std::exchange(full_screen_, false); }
  /// Returns the values that the instruments display. The benchmark and the tests read them without
  /// user input.
  [[nodiscard]] HudModel Model() const;

 private:
  struct Message {
    std::string text;
    double age_s;
    bool is_warning;
  };

  // The other FlightCommands.
  [[nodiscard]] FlightController& controller() override { return flight_.controller(); }
  [[nodiscard]] ExposureControl& exposure() override { return flight_.exposure(); }
  [[nodiscard]] const QualityRule& quality() const override { return flight_.frames().rule(); }
  void Use(const QualityRule& rule) override;
  [[nodiscard]] const Medium& planet() const override { return flight_.edits().planet(); }
  void UsePlanet(const std::string& preset) override;
  [[nodiscard]] const AirChoice& air_choice() const override {
    return flight_.edits().air_choice();
  }
  void Use(const AirChoice& choice) override;
  [[nodiscard]] const std::vector<SceneCloud>& clouds() const override {
    return flight_.edits().scene().clouds;
  }
  void Use(const std::vector<SceneCloud>& clouds) override;
  void ToggleLandingLight() override;
  void MoveTo(const EyePlacement& placement) override;
  void GoTo(const std::string& place) override;
  void SetTime(const std::string& text) override;
  void Request(const PictureOrder& picture) override;
  void Record(bool records) override;
  void Use(FlightSoFar use) override;
  void Switch(WindowPart part) override;

  void Display(const std::string& text, bool is_warning = false);
  void ReportPictures();
  void ReportOutcomesAtEnd();
  void SaveFlight();
  void FlyAgain();
  void RecordFlight(double seconds);
  void ReadLuminance(const InputFrame& input);
  void Age(double seconds);
  void WantStrip();
  /// Returns a function that draws the instruments of this moment over a picture.
  [[nodiscard]] std::function<DisplayImage(const HdrImage&)> Instruments();
  /// Displays errors of a work as warnings.
  template <typename Work>
  void Try(const Work& work);

  FlightSession& flight_;
  FlightRecorder& recorder_;
  double elapsed_s_ = 0.0, flown_s_ = 0.0;
  FlightLog flown_;  // without the replayed parts
  bool replays_ = false;
  Hud hud_;
  AsyncValue<DayStripRequest, DayStrip> strip_{MakeDayStrip, LooksTheSame};
  Controls controls_;
  std::deque<Message> messages_;
  std::optional<double> cursor_cd_per_m2_;
  ImageSize size_;  // of the picture in the last frame [pixels]
  double frame_ms_ = 16.0;
  bool leaves_ = false, full_screen_ = false;
  PictureQueue pictures_;
};

/// Returns the model of the HUD, without messages and the other values of the user interface.
[[nodiscard]] HudModel ReadInstruments(FlightSession& flight);

}  // namespace alpenglow::viewer
