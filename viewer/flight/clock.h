// SPDX-License-Identifier: MIT
// The clock of the scene: it runs at a rate, stands, and jumps to what the sun and the moon do.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Seconds of the scene per second of the pilot, one step faster (+1) or slower (-1) than `rate`:
/// ..., -60, -10, -1, 0, 1, 10, 60, ... up to 3600 either way.
[[nodiscard]] double SteppedTimeRate(double rate, int step);

/// What one waits for. Dawn and dusk are the civil ones (the sun 6 degrees below the horizon).
enum class SkyEvent { kDawn, kSunrise, kNoon, kSunset, kDusk, kMoonrise, kMoonset };
inline constexpr std::array<SkyEvent, 7> kSkyEvents{
    SkyEvent::kDawn, SkyEvent::kSunrise,  SkyEvent::kNoon,   SkyEvent::kSunset,
    SkyEvent::kDusk, SkyEvent::kMoonrise, SkyEvent::kMoonset};
/// "dawn", "sunrise", ...
[[nodiscard]] const char* NameOf(SkyEvent event);

/// The next moonrise or moonset after an instant.
using MoonEventAfter = std::function<std::optional<UtcInstant>(
    SkyEvent event, const GeodeticPosition& place, const UtcInstant& after)>;

/// The next time that it happens at a place, more than a second after an instant; nothing when it
/// does not happen within 366 days. `moon` says it of the moon; without it there is no moon.
/// Instants of the sun as FindSunEvent has them.
[[nodiscard]] std::optional<UtcInstant> NextEvent(SkyEvent event, const GeodeticPosition& place,
                                                  const UtcInstant& after,
                                                  const MoonEventAfter& moon = {});

/// The clock. It knows the years 1900 to 2100 and stops at their ends.
class SceneClock {
 public:
  explicit SceneClock(const UtcInstant& start) : now_(start) {}

  [[nodiscard]] const UtcInstant& now() const { return now_; }
  /// Seconds per second; kept while the clock is paused.
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Lets real seconds pass.
  void Advance(double seconds);
  void Pause(bool paused) { paused_ = paused; }
  void StepRate(int step) { rate_ = SteppedTimeRate(rate_, step); }
  /// Throws InputError when the rate is not in [-3600, 3600].
  void SetRate(double rate);

  /// Moves the hands, paused or not.
  void Shift(double seconds);
  void Set(const UtcInstant& instant);
  /// To the next one; false, and nothing is moved, when there is none within 366 days.
  bool JumpToNext(SkyEvent event, const GeodeticPosition& place, const MoonEventAfter& moon = {});
  /// To what is typed, as InstantFromText has it (renderer/series/time_text.h); the day is that of
  /// the hands in the zone, but "today" and "now" are of the machine's clock. Throws InputError.
  void Type(const std::string& text, const GeodeticPosition& place, const std::string& zone);

 private:
  UtcInstant now_;
  double rate_ = 1.0;
  bool paused_ = false;
};

}  // namespace alpenglow::viewer
