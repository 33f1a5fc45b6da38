// SPDX-License-Identifier: MIT
#include "viewer/input/flight_controller.h"

#include <fmt/format.h>

#include <utility>

namespace alpenglow::viewer {
namespace {

FlightMode Stepped(FlightMode mode, int step) {
  return static_cast<FlightMode>((static_cast<int>(mode) + step + 3) % 3);
}

std::string HeldText(const PilotedAircraft& aircraft) {
  const std::string text = TextOf(aircraft.autopilot().targets());
  return text.empty() ? "autopilot off" : text;
}

}  // namespace

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
void FlightController::AdvanceClock(const std::optional<UtcInstant>& before, double seconds) {
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
