// SPDX-License-Identifier: MIT
// A flight with people: keys, mouse and gamepad, instruments and panels, messages; what they have
// flown, to be written down and flown again.
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "viewer/flight/flight_recorder.h"
#include "viewer/flythrough.h"
#include "viewer/hud/hud.h"
#include "viewer/input/controls.h"
#include "viewer/picture_queue.h"
#include "viewer/window.h"

namespace alpenglow::viewer {

class FlightDeck {
 public:
  struct Settings {
    double hud_scale = 1.0;
    bool shows_hud = true;
    ControlSettings controls;
  };
  /// Refers to the flight, and to the recorder, which panels begin and end: it outlives the deck, so
  /// that a flight is whole however the deck ends.
  FlightDeck(Flythrough& flight, FlightRecorder& recorder, const Settings& settings);
  /// Finishes the pictures that were asked for, and says on standard error what nobody saw of them.
  ~FlightDeck();
  FlightDeck(const FlightDeck&) = delete;
  FlightDeck& operator=(const FlightDeck&) = delete;

  /// What hands and panels ask for, and the seconds that have passed. Once a frame, seen or not.
  void Advance(const WindowEvents& events, const ImageSize& size, double seconds);
  /// Does what panels asked for; what cannot be done is said on the screen.
  void Serve(const HudRequest& asked);
  /// Paints the flight, and instruments over it.
  void Paint(const Developer::Screen& screen, double seconds);

  /// A developed picture with instruments, as the screen would show it, at once. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, const ImageSize& size);

  /// The pilot leaves: at once, or when the pictures that were asked for are written; asked for
  /// again, without those that are not painted yet.
  void Leave();
  /// Waits for the pictures after the window's display has gone, and says what came of them.
  void FinishWithoutWindow();

  /// Something to be said on the screen.
  void Say(const std::string& text, bool is_warning = false);

  /// Whether the pilot has left and all pictures are written.
  [[nodiscard]] bool quit() const { return leaves_ && !pictures_.UnderWay(); }
  [[nodiscard]] MouseMode mouse_mode() const { return controls_.mouse_mode(); }
  /// Whether the other of window and full screen was asked for since the last call.
  [[nodiscard]] bool TakeFullScreen() { return std::exchange(full_screen_, false); }
  /// What the benchmark and tests ask for without hands.
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

  Flythrough& flight_;
  FlightRecorder& recorder_;
  double elapsed_s_ = 0.0, flown_s_ = 0.0;
  FlightLog flown_;  // but for what was flown again
  bool replays_ = false;
  Hud hud_;
  HudKeys keys_;
  DayStrips strips_;
  Controls controls_;
  std::deque<Message> messages_;
  std::optional<double> cursor_cd_per_m2_;
  double frame_ms_ = 16.0;
  bool leaves_ = false, full_screen_ = false, landing_light_ = false;
  HudUnits units_ = HudUnits::kMetric;
  PictureQueue pictures_;
};

}  // namespace alpenglow::viewer
