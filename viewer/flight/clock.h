// SPDX-License-Identifier: MIT
// Provides the clock of the scene. It runs at a rate, pauses, and jumps to events of the sun and
// the moon.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Returns the rate that is one step faster (+1) or slower (-1) than `rate`, in scene seconds per
/// real second: ..., -60, -10, -1, 0, 1, 10, 60, ... up to 3600 in both directions.
[[nodiscard]] double SteppedTimeRate(double rate, int step);

/// Events of the sun and the moon. Dawn and dusk are the civil ones (the sun is 6 degrees below the
/// horizon).
enum class SkyEvent { kDawn, kSunrise, kNoon, kSunset, kDusk, kMoonrise, kMoonset };
inline constexpr std::array<SkyEvent, 7> kSkyEvents{
    SkyEvent::kDawn, SkyEvent::kSunrise,  SkyEvent::kNoon,   SkyEvent::kSunset,
    SkyEvent::kDusk, SkyEvent::kMoonrise, SkyEvent::kMoonset};
/// Returns "dawn", "sunrise", ...
[[nodiscard]] const char* NameOf(SkyEvent event);

/// Returns the next occurrence of an event at a place, after an instant and for the sun more than a
/// second after it. Instants are those of FindSunEvent and NextMoonEvent. Returns nullopt if the
/// event does not occur within 366 days (sun) or 30 days (moon).
[[nodiscard]] std::optional<UtcInstant> NextEvent(SkyEvent event, const GeodeticPosition& place,
                                                  const UtcInstant& after);

/// Clock of the scene. Its range is the years 1900 to 2100; it stops at their ends.
class SceneClock {
 public:
  explicit SceneClock(const UtcInstant& start) : now_(start) {}

  [[nodiscard]] const UtcInstant& now() const { return now_; }
  /// Rate in seconds per second; it is kept while the clock is paused.
  [[nodiscard]] double rate() const { return rate_; }
  [[nodiscard]] bool paused() const { return paused_; }

  /// Advances the clock by a number of real seconds.
  void Advance(double seconds);
  void Pause(bool paused) { paused_ = paused; }
  void StepRate(int step) { rate_ = SteppedTimeRate(rate_, step); }
  /// Throws InputError if the rate is not in [-3600, 3600].
  void SetRate(double rate);

  /// Shifts the time, whether the clock is paused or not.
  void Shift(double seconds);
  void Set(const UtcInstant& instant);
  /// Jumps to the next occurrence of the event. Returns false and changes nothing if NextEvent
  /// finds none.
  bool JumpToNext(SkyEvent event, const GeodeticPosition& place);
  /// Sets the time from a text, as InstantFromText (time_text.h). The day is that
  /// of this clock in the zone, but "today" and "now" refer to the clock of the computer. Throws
  /// InputError.
  void Type(const std::string& text, const GeodeticPosition& place, const std::string& zone);

 private:
  UtcInstant now_;
  double rate_ = 1.0;
  bool paused_ = false;
};

}  // namespace alpenglow::viewer
