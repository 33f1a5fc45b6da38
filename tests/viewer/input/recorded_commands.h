// SPDX-License-Identifier: MIT
// A flight without scene and window, which keeps what keys and panels request.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/input/action.h"

namespace alpenglow::tests {

using namespace viewer;

class RecordedCommands : public FlightCommands {
 public:
  /// All that was requested.
  struct Requests {
    std::optional<EyePlacement> place;
    std::optional<std::string> named_place, time, planet;
    std::optional<AirChoice> air;
    std::optional<QualityRule> quality;
    std::optional<PictureOrder> picture;
    std::optional<bool> record;
    bool landing_light = false, saves = false, flies_again = false, leaves = false;
    std::vector<WindowPart> parts;
    std::vector<std::string> messages;
  };

  explicit RecordedCommands(GroundHeight ground = [](const Place&) { return 0.0; })
      : controller_({Place{47.0, 8.0, 1500.0}}, kWgs84, ParseInstant("2026-06-21T12:00:00Z"),
                    std::move(ground)) {}

  [[nodiscard]] FlightController& controller() override { return controller_; }
  [[nodiscard]] ExposureControl& exposure() override { return exposure_; }
  [[nodiscard]] const QualityRule& quality() const override { return quality_; }
  void Use(const QualityRule& rule) override { requests.quality = quality_ = rule; }
  [[nodiscard]] const Medium& planet() const override {
    static const Medium earth = MediumPreset("earth");
    return earth;
  }
  void UsePlanet(const std::string& preset) override { requests.planet = preset; }
  [[nodiscard]] const AirChoice& air_choice() const override { return air_; }
  void Use(const AirChoice& choice) override { requests.air = air_ = choice; }
  [[nodiscard]] const std::vector<SceneCloud>& clouds() const override { return clouds_; }
  void Use(const std::vector<SceneCloud>& clouds) override { clouds_ = clouds; }
  void ToggleLandingLight() override { requests.landing_light = true; }
  void MoveTo(const EyePlacement& placement) override { requests.place = placement; }
  void GoTo(const std::string& place) override { requests.named_place = place; }
  void SetTime(const std::string& text) override { requests.time = text; }
  void Request(const PictureOrder& picture) override { requests.picture = picture; }
  void Record(bool records) override { requests.record = records; }
  void Use(FlightSoFar use) override {
    (use == FlightSoFar::kSave ? requests.saves : requests.flies_again) = true;
  }
  void Switch(WindowPart part) override { requests.parts.push_back(part); }
  void Leave() override { requests.leaves = true; }
  void Report(const std::string& message) override { requests.messages.push_back(message); }

  /// Runs the action of a key in the present mode. Returns its message; "" without one.
  std::string Press(const char* key) {
    const KeyChord chord = KeyChordFromText(key);
    const Action* action = ActionOfKey(chord.key, chord.modifiers, controller_.pilot().mode());
    requests.messages.clear();
    action->run(*this);
    return requests.messages.empty() ? "" : requests.messages.back();
  }

  Requests requests;

 private:
  FlightController controller_;
  ExposureControl exposure_{{}, {}};
  QualityRule quality_;
  AirChoice air_;
  std::vector<SceneCloud> clouds_;
};

}  // namespace alpenglow::tests
