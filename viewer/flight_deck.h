// SPDX-License-Identifier: MIT
// A flight with people: keys, mouse and gamepad, instruments and panels, messages.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "viewer/flythrough.h"
#include "viewer/hud/hud.h"
#include "viewer/hud/hud_keys.h"
#include "viewer/input/controls.h"
#include "viewer/window_events.h"

namespace alpenglow {

class FlightDeck {
 public:
  struct Settings {
    double hud_scale = 1.0;
    bool shows_hud = true;
    ControlSettings controls;
  };
  /// Refers to the flight.
  FlightDeck(Flythrough& flight, const Settings& settings);

  /// What hands and panels ask for, and the seconds that have passed. Once a frame.
  void Advance(const WindowEvents& events, const ImageSize& size, double seconds);
  /// Does what panels asked for; what cannot be done is said on the screen.
  void Serve(const HudRequest& asked);
  /// Paints the flight, and instruments over it.
  void Paint(const Developer::Screen& screen, double seconds);

  /// A developed picture with instruments, as the screen would show it. Throws OutputError.
  void WritePicture(const std::filesystem::path& file, const ImageSize& size);

  /// Something to be said on the screen.
  void Say(const std::string& text, bool is_warning = false);

  [[nodiscard]] bool quit() const { return quit_; }
  [[nodiscard]] MouseMode mouse_mode() const { return controls_.mouse_mode(); }
  /// Whether the other of window and full screen was asked for since the last call.
  [[nodiscard]] bool TakeFullScreen() { return std::exchange(full_screen_, false); }
  /// What the benchmark and tests ask for without hands.
  [[nodiscard]] HudModel Model() const;

  void SetRecording(bool recording) { recording_ = recording; }

 private:
  struct Message {
    std::string text;
    double age_s;
    bool is_warning;
  };
  void Do(Action action, const ImageSize& size);
  void ServeTime(const HudTimeRequest& asked);
  void ServeAir(const HudAirRequest& asked);
  void Capture(const HudCaptureRequest& asked);
  void Screenshot(const char* extension, const ImageSize& size);
  void Age(double seconds);
  void SetLandingLight(bool is_on);
  [[nodiscard]] HudChoices Choices() const;
  void WantStrip();
  template <typename Work>
  void Try(const Work& work);

  Flythrough& flight_;
  Hud hud_;
  HudKeys keys_;
  DayStrips strips_;
  Controls controls_;
  std::deque<Message> messages_;
  std::optional<double> cursor_cd_per_m2_;
  double frame_ms_ = 16.0;
  bool quit_ = false, full_screen_ = false, recording_ = false, landing_light_ = false;
  HudUnits units_ = HudUnits::kMetric;
};

}  // namespace alpenglow
