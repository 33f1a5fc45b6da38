// SPDX-License-Identifier: MIT
#include "viewer/input/flight_controller.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace alpenglow::viewer {
namespace {

constexpr double kThousandFeet_m = 304.8;
constexpr double kTrackSkip_s = 10.0;
constexpr double kZoomStep = 1.1;
constexpr double kMinute_s = 60.0, kHour_s = 3600.0, kDay_s = 86400.0;

std::string ModeNameOf(FlightMode mode) {
  constexpr std::array<const char*, 3> kNames{"free camera", "aircraft", "track"};
  return kNames[static_cast<std::size_t>(mode)];
}

FlightMode Stepped(FlightMode mode, int step) {
  return static_cast<FlightMode>((static_cast<int>(mode) + step + 3) % 3);
}

std::optional<SkyEvent> EventOf(Action action) {
  switch (action) {
    case Action::kToDawn:
      return SkyEvent::kDawn;
    case Action::kToSunrise:
      return SkyEvent::kSunrise;
    case Action::kToNoon:
      return SkyEvent::kNoon;
    case Action::kToSunset:
      return SkyEvent::kSunset;
    case Action::kToDusk:
      return SkyEvent::kDusk;
    case Action::kToMoonrise:
      return SkyEvent::kMoonrise;
    case Action::kToMoonset:
      return SkyEvent::kMoonset;
    default:
      return std::nullopt;
  }
}

std::optional<double> ShiftOf(Action action) {
  switch (action) {
    case Action::kLaterMinute:
      return kMinute_s;
    case Action::kEarlierMinute:
      return -kMinute_s;
    case Action::kLaterHour:
      return kHour_s;
    case Action::kEarlierHour:
      return -kHour_s;
    case Action::kLaterDay:
      return kDay_s;
    case Action::kEarlierDay:
      return -kDay_s;
    default:
      return std::nullopt;
  }
}

std::optional<Autopilot::Hold> HoldOf(Action action) {
  switch (action) {
    case Action::kHoldHeading:
      return Autopilot::Hold::kHeading;
    case Action::kHoldAltitude:
      return Autopilot::Hold::kHeight;
    case Action::kHoldClimb:
      return Autopilot::Hold::kClimb;
    case Action::kHoldSpeed:
      return Autopilot::Hold::kSpeed;
    case Action::kLevelWings:
      return Autopilot::Hold::kLevelWings;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<std::string> FlightController::Do(Action action, const GroundHeight& ground) {
  if (auto said = DoFlight(action, ground)) return said;
  if (auto said = DoAutopilot(action)) return said;
  return DoTime(action);
}

void FlightController::Advance(const PilotControls& controls, double seconds,
                               const GroundHeight& ground) {
  const bool stands = clock_.paused() && pilot_.mode() != FlightMode::kFree;
  const bool replays = pilot_.Replays() && !pilot_.track().IsAtEnd();
  const auto before = replays ? pilot_.TrackUtc() : std::nullopt;
  pilot_.Advance(controls, stands ? 0.0 : seconds, ground);
  AdvanceClock(before, seconds);
  if (!pilot_.Replays()) waits_.reset();
  if (pilot_.Replays() && pilot_.track().IsAtEnd()) EndReplay(ground);
}

// During a replay the clock moves with the replayed time, including pauses and jumps; offsets set
// by the user remain.
void FlightController::AdvanceClock(const std::optional<UtcInstant>& before, double seconds) {
  if (before) {
    clock_.Shift(SecondsBetween(*before, *pilot_.TrackUtc()));
  } else {
    clock_.Advance(pilot_.time_factor() * seconds);
  }
}

void FlightController::EndReplay(const GroundHeight& ground) {
  if (waits_) {
    pilot_ = *std::exchange(waits_, std::nullopt);
  } else {
    static_cast<void>(Enter(FlightMode::kFree, ground));
    pilot_.SetTrack(nullptr);
  }
}

void FlightController::Replay(std::shared_ptr<const CameraPath> flight,
                              const GroundHeight& ground) {
  waits_.reset();
  clock_.Pause(false);
  pilot_.PutAt(pilot_.eye(), ground);  // leaves the current track
  pilot_.SetTrack(std::move(flight), Pilot::Lens::kOfTrack);
  static_cast<void>(Enter(FlightMode::kTrack, ground));
}

void FlightController::FlyAgain(std::shared_ptr<const CameraPath> flown,
                                const GroundHeight& ground) {
  Pilot now = pilot_.Replays() && waits_ ? *waits_ : pilot_;
  Replay(std::move(flown), ground);
  waits_ = std::move(now);
}

std::string FlightController::Enter(FlightMode mode, const GroundHeight& ground) {
  if (const auto why_not = pilot_.Enter(mode, ground)) return *why_not;
  // A track with instants sets the clock; afterwards the clock runs along.
  if (const auto utc = pilot_.TrackUtc()) clock_.Set(*utc);
  return ModeNameOf(pilot_.mode());
}

void FlightController::SkipTrack(double seconds) {
  const auto before = pilot_.TrackUtc();
  pilot_.SkipTrack(seconds);
  const auto after = pilot_.TrackUtc();
  if (before && after) clock_.Shift(SecondsBetween(*before, *after));
}

std::optional<std::string> FlightController::DoFlight(Action action, const GroundHeight& ground) {
  switch (action) {
    case Action::kFaster:
    case Action::kFasterFlight:
      pilot_.StepSpeed(1);
      break;
    case Action::kSlower:
    case Action::kSlowerFlight:
      pilot_.StepSpeed(-1);
      break;
    case Action::kTrackAhead:
    case Action::kTrackBack:
      SkipTrack(action == Action::kTrackAhead ? kTrackSkip_s : -kTrackSkip_s);
      return "";
    case Action::kCentre:
      pilot_.Centre(ground);
      return "";
    case Action::kHigher:
      pilot_.Lift(kThousandFeet_m, ground);
      return "";
    case Action::kFreeMode:
      return Enter(FlightMode::kFree, ground);
    case Action::kAircraftMode:
      return Enter(FlightMode::kAircraft, ground);
    case Action::kTrackMode:
      return Enter(FlightMode::kTrack, ground);
    case Action::kNextMode:
    case Action::kPreviousMode: {
      const int step = action == Action::kNextMode ? 1 : -1;
      const FlightMode next = Stepped(pilot_.mode(), step);
      // Without a track the cycle has two modes.
      const bool skips = next == FlightMode::kTrack && !pilot_.track().exists();
      return Enter(skips ? Stepped(next, step) : next, ground);
    }
    case Action::kNarrowerView:
    case Action::kWiderView:
      pilot_.Zoom(action == Action::kNarrowerView ? 1.0 / kZoomStep : kZoomStep);
      return "";
    case Action::kResetView:
      pilot_.ResetView();
      return "";
    default:
      return std::nullopt;
  }
  return fmt::format("speed x{:.3g}", pilot_.Readout(ground).speed_factor);
}

std::optional<std::string> FlightController::DoAutopilot(Action action) {
  const std::optional<Autopilot::Hold> hold = HoldOf(action);
  if (!hold && action != Action::kAutopilotOff) return std::nullopt;
  PilotedAircraft* aircraft = pilot_.aircraft();
  if (aircraft == nullptr) return "";
  if (hold) {
    aircraft->Toggle(*hold);
  } else {
    aircraft->autopilot().Release();
  }
  const std::string text = TextOf(aircraft->autopilot().targets());
  return text.empty() ? "autopilot off" : text;
}

std::string FlightController::JumpTo(SkyEvent event) {
  const bool jumped = clock_.JumpToNext(event, pilot_.eye().place);
  return jumped ? NameOf(event) : fmt::format("no {} here within a year", NameOf(event));
}

std::optional<std::string> FlightController::DoTime(Action action) {
  if (const auto event = EventOf(action)) return JumpTo(*event);
  if (const auto shift_s = ShiftOf(action)) {
    clock_.Shift(*shift_s);
    return "";
  }
  switch (action) {
    case Action::kPause:
      clock_.Pause(!clock_.paused());
      return clock_.paused() ? "paused" : "";
    case Action::kFasterTime:
    case Action::kSlowerTime:
      clock_.StepRate(action == Action::kFasterTime ? 1 : -1);
      break;
    case Action::kRealTime:
      clock_.SetRate(1.0);
      break;
    default:
      return std::nullopt;
  }
  return fmt::format("time x{:.0f}", clock_.rate());
}

}  // namespace alpenglow::viewer
