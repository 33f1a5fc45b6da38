// SPDX-License-Identifier: MIT
// Provides ViewerApp, the user interface of a flight: keyboard, mouse and gamepad input,
// instruments, panels and messages. It also keeps a log of the flight, which can be saved and
// replayed.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "viewer/flight/flight_recorder.h"
#include "viewer/flight_session.h"
#include "viewer/hud/hud.h"
#include "viewer/input/controls.h"
#include "viewer/picture_queue.h"
#include "viewer/window.h"

namespace alpenglow::viewer {

class ViewerApp {
 public:
  struct Settings {
    double hud_scale = 1.0;
    bool shows_hud = true;
    ControlSettings controls;
  };
  /// Keeps references to the flight and to the recorder. The panels start and stop the recorder. It
  /// outlives the deck, so that the recorded flight is complete however the deck ends.
  ViewerApp(FlightSession& flight, FlightRecorder& recorder, const Settings& settings);
  /// Finishes the requested pictures and writes their outcomes that were not yet displayed to
  /// standard error.
  ~ViewerApp();
  ViewerApp(const ViewerApp&) = delete;
  ViewerApp& operator=(const ViewerApp&) = delete;

  /// Applies the input of keyboard, mouse, gamepad and panels, and advances the flight by `seconds`
  /// of real time. Call it once a frame, whether the frame is displayed or not.
  void Advance(const WindowEvents& events, const ImageSize& size, double seconds);
  /// Carries out the requests of the panels. Errors are displayed as messages on the screen.
  void Serve(const HudRequest& asked);
  /// Paints the flight and draws the instruments over it.
  void Paint(const ToneMapPass::Screen& screen, double seconds);

  /// Writes a developed picture with instruments, as displayed on the screen. It is written before
  /// the call returns. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, const ImageSize& size);

  /// Ends the flight: at once, or as soon as all requested pictures are written. A second call
  /// drops the pictures that are not painted yet.
  void Leave();
  /// Waits for the pictures after the display of the window is lost, and writes their outcomes to
  /// standard error.
  void FinishWithoutWindow();

  /// Displays a message on the screen.
  void Say(const std::string& text, bool is_warning = false);

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
  void Do(Action action, const ImageSize& size);
  void ServeTime(const HudTimeRequest& asked);
  void ServeAir(const HudAirRequest& asked);
  void ServeLook(const HudRequest& asked);
  void ServeFlight(const HudRequest& asked);
  void AskForPicture(const HudCaptureRequest& asked);
  void TellOfPictures();
  void SayOutcomes();
  void Record(bool records);
  void SaveFlight();
  void FlyAgain();
  void NoteFlight(double seconds);
  void Age(double seconds);
  void SetLandingLight(bool is_on);
  [[nodiscard]] HudChoices Choices() const;
  void WantStrip();
  template <typename Work>
  void Try(const Work& work);

  FlightSession& flight_;
  FlightRecorder& recorder_;
  double elapsed_s_ = 0.0, flown_s_ = 0.0;
  FlightLog flown_;  // without the replayed parts
  bool replays_ = false;
  Hud hud_;
  HudKeys keys_;
  AsyncValue<DayStripRequest, DayStrip> strip_{MakeDayStrip, LooksTheSame};
  Controls controls_;
  std::deque<Message> messages_;
  std::optional<double> cursor_cd_per_m2_;
  double frame_ms_ = 16.0;
  bool leaves_ = false, full_screen_ = false, landing_light_ = false;
  HudUnits units_ = HudUnits::kMetric;
  PictureQueue pictures_;
};

}  // namespace alpenglow::viewer
