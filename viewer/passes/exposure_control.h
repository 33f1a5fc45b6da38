// SPDX-License-Identifier: MIT
// Provides ExposureControl, the exposure and the look of the pictures of a flight: metered or
// locked, and adapted from frame to frame as an eye does.
#pragma once

#include <optional>

#include "lut/image/eye_adaptation.h"
#include "lut/image/look.h"
#include "lut/image/white_balance.h"
#include "viewer/passes/display_pass.h"

namespace alpenglow::viewer {

/// Returns an EV that adapts to the metered EV, as an eye does: half way in 0.3 s. Without a value
/// `before` it is the metered EV.
[[nodiscard]] double AdaptedEv100(std::optional<double> before, double metered, double seconds);

/// Returns a white balance that adapts to the metered one in the same way, in reciprocal colour
/// temperature.
[[nodiscard]] WhiteBalance AdaptedWhite(const WhiteBalance& before, const WhiteBalance& metered,
                                        double seconds);

/// Source of the exposure.
struct FlightExposure {
  bool locked = false;
  double compensation_ev = 0.0;  // positive values are brighter
  std::optional<double> ev100;   // as displayed; nullopt before the first picture
};

/// It needs no OpenGL. A copy continues from the same state.
class ExposureControl {
 public:
  /// @param rule  metered, eye or fixed; a fixed exposure is locked, and metered once unlocked.
  /// @param look  as selected; its white balance may be automatic.
  ExposureControl(const ExposureRule& rule, const Look& look);

  void Lock(bool locked) { exposure_.locked = locked; }
  /// Sets and locks the exposure.
  void Set(double ev100) { exposure_ = {true, 0.0, ev100}; }
  void Compensate(double ev) { exposure_.compensation_ev = ev; }
  /// Returns to the metered exposure without compensation.
  void Reset() { exposure_ = {false, 0.0, exposure_.ev100}; }
  /// Sets the look of the following pictures. Its white balance may be automatic; another one takes
  /// effect without adaptation.
  void Use(const Look& look);

  /// Adapts to a metered picture, `seconds` after the previous one.
  /// @param now  time of the scene: after a jump of an hour the eye has had an hour to adapt.
  void Follow(const MeterReading& metered, const UtcTime& now, double seconds);
  /// Records the exposure of a displayed picture that did not adapt.
  void Record(const Development& development) { exposure_.ev100 = development.ev100; }
  /// Forgets the previous picture, which is unrelated to the next one, so that nothing adapts to
  /// it.
  void Forget();

  [[nodiscard]] const FlightExposure& exposure() const { return exposure_; }
  /// Returns the look as selected by the user; its white balance may be automatic.
  [[nodiscard]] const Look& look() const { return look_; }
  /// Returns the look with the white balance that is displayed; call it after Follow.
  [[nodiscard]] Look ShownLook() const;
  /// Returns the colour temperature of the light that is displayed as white [K]; nullopt before the
  /// first picture.
  [[nodiscard]] std::optional<double> white_k() const;
  /// Returns the development of a picture without a preceding frame: that of the displayed frames
  /// if there are any, otherwise the metered one.
  [[nodiscard]] Development DevelopmentOf(const HdrImage& picture,
                                          Projection projection = Projection::kCamera) const;
  /// Returns the metadata of exposure and development.
  [[nodiscard]] Metadata Header(const Development& development) const;

 private:
  /// Returns the EV for the current rule of exposure, after the adaptation of the eye.
  [[nodiscard]] double AdaptedTo(double metered_ev100, const UtcTime& now, double seconds);

  ExposureRule rule_;
  Look look_;
  FlightExposure exposure_;
  EyeAdaptation adaptation_;           // for the exposure rule `eye`
  std::optional<UtcTime> adapted_at_;  // time of the last adaptation
  std::optional<WhiteBalance> white_;  // as displayed; nullopt before the first picture
};

}  // namespace alpenglow::viewer
