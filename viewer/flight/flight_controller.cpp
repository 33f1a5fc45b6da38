// SPDX-License-Identifier: MIT
#include "viewer/flight/flight_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refraction.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::viewer {
namespace {

constexpr std::array<double, 11> kTimeRates{-3600.0, -600.0, -60.0, -10.0, -1.0,  0.0,
                                            1.0,     10.0,   60.0,  600.0, 3600.0};

const UtcTime& FirstInstant() {
  static const UtcTime first = ParseInstant("1900-01-01T00:00:00Z");
  return first;
}
const UtcTime& LastInstant() {
  static const UtcTime last = ParseInstant("2100-12-31T23:59:59Z");
  return last;
}

struct EventRow {
  const char* name;
  std::variant<SunEvent, MoonEvent> of;
};
// The rows have the order of SkyEvent.
constexpr std::array<EventRow, 7> kEventRows{{{"dawn", SunEvent::kCivilDawn},
                                              {"sunrise", SunEvent::kSunrise},
                                              {"noon", SunEvent::kNoon},
                                              {"sunset", SunEvent::kSunset},
                                              {"dusk", SunEvent::kCivilDusk},
                                              {"moonrise", MoonEvent::kMoonrise},
                                              {"moonset", MoonEvent::kMoonset}}};

const EventRow& RowOf(SkyEvent event) { return kEventRows[static_cast<std::size_t>(event)]; }

/// Returns whether the sun of the day reaches the elevations of the event, with a margin of 2
/// degrees: its declination changes by 0.4 degrees a day. Most days of a polar night need no
/// search.
bool CanHappen(SunEvent event, const Place& place, const UtcTime& day) {
  constexpr double kMargin_rad = 2.0 * kRadiansPerDegree, kTwilight_rad = -6.0 * kRadiansPerDegree;
  if (event == SunEvent::kNoon) return true;
  const bool at_horizon = event == SunEvent::kSunrise || event == SunEvent::kSunset;
  const double wanted_rad =
      at_horizon ? SeaHorizonFrom(place.height_m, OsculatingRadius(kWgs84, place.latitude_rad()))
                       .true_elevation_rad
                 : kTwilight_rad;
  const double declination_rad = std::asin(EcefTowards(TrueSunAt(place, day), place).xyz.z);
  const double highest_rad = 0.5 * kPi - std::abs(place.latitude_rad() - declination_rad);
  const double lowest_rad = std::abs(place.latitude_rad() + declination_rad) - 0.5 * kPi;
  return highest_rad > wanted_rad - kMargin_rad && lowest_rad < wanted_rad + kMargin_rad;
}

FlightMode Stepped(FlightMode mode, int step) {
  return static_cast<FlightMode>((static_cast<int>(mode) + step + 3) % 3);
}

std::string HeldText(const PilotedAircraft& aircraft) {
  const std::string text = TextOf(aircraft.autopilot().targets());
  return text.empty() ? "autopilot off" : text;
}

}  // namespace

double SteppedTimeRate(double rate, int step) {
  const auto* at = std::lower_bound(kTimeRates.begin(), kTimeRates.end(), rate);
  const auto index = std::min<std::ptrdiff_t>(at - kTimeRates.begin(), kTimeRates.size() - 1);
  const std::ptrdiff_t next =
      std::clamp<std::ptrdiff_t>(index + step, 0, std::ptrdiff_t{kTimeRates.size()} - 1);
  return kTimeRates[static_cast<std::size_t>(next)];
}

const char* NameOf(SkyEvent event) { return RowOf(event).name; }

std::optional<UtcTime> NextEvent(SkyEvent event, const Place& place, const UtcTime& after) {
  const auto& of = RowOf(event).of;
  if (const auto* moon = std::get_if<MoonEvent>(&of)) return NextMoonEvent(*moon, place, after);
  constexpr int kDays = 366;
  constexpr double kSame_s = 1.0;
  const SunEvent sun = std::get<SunEvent>(of);
  for (int day = 0; day <= kDays; ++day) {
    const UtcTime around = AddSeconds(after, day * kSecondsPerDay);
    if (!CanHappen(sun, place, around)) continue;
    const auto found = FindSunEvent(sun, place, around);
    if (found && SecondsBetween(after, *found) > kSame_s) return found;
  }
  return std::nullopt;
}

void SceneClock::Advance(double seconds) {
  if (!paused_) Shift(rate_ * seconds);
}

void SceneClock::SetRate(double rate) {
  rate_ = RequireInRange(rate, -3600.0, 3600.0, "time rate");
}

void SceneClock::Shift(double seconds) { Set(AddSeconds(now_, seconds)); }

void SceneClock::Set(const UtcTime& instant) {
  const bool early = SecondsBetween(FirstInstant(), instant) < 0.0;
  const bool late = SecondsBetween(instant, LastInstant()) < 0.0;
  now_ = early ? FirstInstant() : late ? LastInstant() : instant;
}

bool SceneClock::JumpToNext(SkyEvent event, const Place& place) {
  const std::optional<UtcTime> next = NextEvent(event, place, now_);
  if (next) Set(*next);
  return next.has_value();
}

void SceneClock::Type(const std::string& text, const Place& place, const std::string& zone) {
  Set(InstantFromText(text, {place, zone, now_}));
}

void FlightController::Advance(const PilotControls& controls, double seconds) {
  const bool stands = clock_.paused() && pilot_.mode() != FlightMode::kFree;
  const bool replays = pilot_.Replays() && !pilot_.track().IsAtEnd();
  const auto before = replays ? pilot_.TrackUtc() : std::nullopt;
  pilot_.Advance(controls, stands ? 0.0 : seconds, ground_);
  AdvanceClock(before, seconds);
  if (!pilot_.Replays()) waits_.reset();
  if (pilot_.Replays() && pilot_.track().IsAtEnd()) EndReplay();
}

// During a replay the clock moves with the replayed time, including pauses and jumps; offsets set
// by the user remain.
void FlightController::AdvanceClock(const std::optional<UtcTime>& before, double seconds) {
  if (before) {
    clock_.Shift(SecondsBetween(*before, *pilot_.TrackUtc()));
  } else {
    clock_.Advance(pilot_.time_factor() * seconds);
  }
}

void FlightController::EndReplay() {
  if (waits_) {
    pilot_ = *std::exchange(waits_, std::nullopt);
  } else {
    Enter(FlightMode::kFree);
    pilot_.SetTrack(nullptr);
  }
}

void FlightController::Replay(std::shared_ptr<const CameraPath> flight) {
  waits_.reset();
  clock_.Pause(false);
  pilot_.PutAt(pilot_.eye(), ground_);  // leaves the current track
  pilot_.SetTrack(std::move(flight), Pilot::Lens::kOfTrack);
  Enter(FlightMode::kTrack);
}

void FlightController::FlyAgain(std::shared_ptr<const CameraPath> flown) {
  Pilot now = pilot_.Replays() && waits_ ? *waits_ : pilot_;
  Replay(std::move(flown));
  waits_ = std::move(now);
}

std::string FlightController::Enter(FlightMode mode) {
  if (const auto why_not = pilot_.Enter(mode, ground_)) return *why_not;
  // A track with instants sets the clock; afterwards the clock runs along.
  if (const auto utc = pilot_.TrackUtc()) clock_.Set(*utc);
  return NameOf(pilot_.mode());
}

std::string FlightController::EnterNext(int step) {
  const FlightMode next = Stepped(pilot_.mode(), step);
  // Without a track the cycle has two modes.
  const bool skips = next == FlightMode::kTrack && !pilot_.track().exists();
  return Enter(skips ? Stepped(next, step) : next);
}

std::string FlightController::StepSpeed(int step) {
  pilot_.StepSpeed(step);
  return fmt::format("speed x{:.3g}", pilot_.Readout(ground_).speed_factor);
}

void FlightController::SkipTrack(double seconds) {
  const auto before = pilot_.TrackUtc();
  pilot_.SkipTrack(seconds);
  const auto after = pilot_.TrackUtc();
  if (before && after) clock_.Shift(SecondsBetween(*before, *after));
}

std::string FlightController::ToggleHold(Autopilot::Hold hold) {
  PilotedAircraft* aircraft = pilot_.aircraft();
  if (aircraft == nullptr) return "";
  aircraft->Toggle(hold);
  return HeldText(*aircraft);
}

std::string FlightController::ReleaseAutopilot() {
  PilotedAircraft* aircraft = pilot_.aircraft();
  if (aircraft == nullptr) return "";
  aircraft->autopilot().Release();
  return HeldText(*aircraft);
}

std::string FlightController::JumpTo(SkyEvent event) {
  const bool jumped = clock_.JumpToNext(event, pilot_.eye().place);
  return jumped ? NameOf(event) : fmt::format("no {} here within a year", NameOf(event));
}

}  // namespace alpenglow::viewer
