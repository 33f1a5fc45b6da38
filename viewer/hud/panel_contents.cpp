// SPDX-License-Identifier: MIT
#include "viewer/hud/panel_contents.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/math/constants.h"
#include "lut/image/image.h"
#include "lut/image/metering.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"

namespace alpenglow::viewer {
namespace {

constexpr double kItemWidth = 170.0;   // width of sliders and lists [units]
constexpr double kStripWidth = 440.0;  // units
constexpr double kStripHeight = 64.0;  // units
constexpr double kNightShare = 0.35;   // brightness of the day strip in the night theme

float Pixels(const PanelView& view, double units) { return static_cast<float>(units * view.scale); }

double Degrees(double radians) { return radians / kRadiansPerDegree; }

double StripWidth_px(const PanelView& view) {
  const double margin = static_cast<double>(2.0F * ImGui::GetStyle().WindowPadding.x +
                                            ImGui::GetStyle().ScrollbarSize);
  return std::max(
      std::min(kStripWidth * view.scale, view.width - 2.0 * kPanelMargin * view.scale - margin),
      60.0);
}

std::optional<double> RateButtons(const HudTime& time, double width_px) {
  static constexpr std::array<double, 7> kRates{-3600.0, -60.0, 0.0, 1.0, 10.0, 60.0, 3600.0};
  std::vector<std::string> names;
  for (const double rate : kRates) names.push_back(RateText(rate, false));
  ImGui::Text("rate of time: %s", RateText(time.rate, time.paused).c_str());
  const auto pressed = ButtonRows(names, width_px);
  return pressed ? std::optional(kRates[*pressed]) : std::nullopt;
}

std::optional<std::string> InstantControl(std::array<char, 64>& typed, float width) {
  ImGui::SetNextItemWidth(width);
  const bool entered =
      ImGui::InputTextWithHint("##instant", "2026-06-21T13:00:00+09:00", typed.data(), typed.size(),
                               ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  const bool pressed = ImGui::Button("set time");
  if (!(entered || pressed) || typed.front() == '\0') return std::nullopt;
  return std::string(typed.data());
}

HudTimeRequest TimeControls(const PanelView& view, PanelTyping& typing) {
  const HudTime& time = view.model.time;
  const double width = StripWidth_px(view);
  HudTimeRequest request;
  ImGui::TextUnformatted(time.utc.c_str());
  ImGui::TextUnformatted((time.local + " " + time.zone).c_str());
  request.day_fraction = DayStripControl(
      view.strip, time.day_fraction,
      {width, kStripHeight * view.scale, view.theme == HudTheme::kDay ? 1.0 : kNightShare});
  if (const auto moment = ButtonRows(view.choices.moments, width))
    request.moment = view.choices.moments[*moment];
  request.rate = RateButtons(time, width);
  request.paused = CheckBox("paused", time.paused);
  request.instant = InstantControl(
      typing.instant,
      std::min(Pixels(view, kItemWidth + 40.0), static_cast<float>(width) - Pixels(view, 90.0)));
  return request;
}

std::array<double, 3> PlaceOf(const HudModel& model) {
  return {Degrees(model.latitude_rad), Degrees(model.longitude_rad), model.flight.height_m};
}

std::optional<HudPlaceRequest> PlaceControls(const PanelView& view, PanelTyping& typing) {
  if (!typing.is_place_typed) typing.place = PlaceOf(view.model);
  auto& [latitude, longitude, height] = typing.place;
  typing.is_place_typed |= ImGui::InputDouble("latitude", &latitude, 0.0, 0.0, "%.5f°");
  typing.is_place_typed |= ImGui::InputDouble("longitude", &longitude, 0.0, 0.0, "%.5f°");
  typing.is_place_typed |= ImGui::InputDouble("height", &height, 0.0, 0.0, "%.0f m");
  if (!ImGui::Button("go there")) return std::nullopt;
  typing.is_place_typed = false;
  return HudPlaceRequest{std::clamp(latitude, -90.0, 90.0), std::clamp(longitude, -180.0, 180.0),
                         height};
}

/// A value that can be held: its name, slider units per SI unit, and range.
struct Holdable {
  const char* name;
  double per_si;
  SliderRange range;
};

// Draws a check box that holds the current value, and a slider for the held value. All values are
// in SI.
std::optional<HudHold> HoldControl(const Holdable& what, const std::optional<double>& held,
                                   double now) {
  const double shown = what.per_si * held.value_or(now);
  std::optional<HudHold> request;
  ImGui::PushID(what.name);
  if (const auto on = CheckBox(what.name, held.has_value())) {
    const double value = std::clamp(shown, what.range.low, what.range.high) / what.per_si;
    request = HudHold{*on ? std::optional(value) : std::nullopt};
  }
  if (const auto value = Slider("##held", shown, what.range))
    request = HudHold{*value / what.per_si};
  ImGui::PopID();
  return request;
}

HudRequest WithHolds(const HudModel& model, HudRequest request) {
  constexpr double kHighest_m = 20000.0, kSlowest_m_per_s = 25.0, kFastest_m_per_s = 280.0;
  const HudAutopilot& held = model.autopilot;
  const double turns = model.flight.heading_rad / (2.0 * kPi);
  request.hold_heading_rad =
      HoldControl({"hold heading", 1.0 / kRadiansPerDegree, {0.0, 360.0, "%03.0f°"}},
                  held.heading_rad, 2.0 * kPi * (turns - std::floor(turns)));
  const Quantity height = HeightText(0.0, model.units), speed = SpeedText(0.0, model.units);
  const std::string in_heights = "%.0f " + height.unit, in_speeds = "%.0f " + speed.unit;
  request.hold_height_m = HoldControl(
      {"hold height", height.per_si, {0.0, kHighest_m * height.per_si, in_heights.c_str()}},
      held.height_m, model.flight.height_m);
  const SliderRange speeds{kSlowest_m_per_s * speed.per_si, kFastest_m_per_s * speed.per_si,
                           in_speeds.c_str()};
  request.hold_speed_m_per_s = HoldControl({"hold speed", speed.per_si, speeds}, held.speed_m_per_s,
                                           model.flight.ground_speed_m_per_s);
  return request;
}

void ShowRow(const HudRow& row) {
  ImGui::TableNextRow();
  for (const std::string& cell : row) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(cell.c_str());
  }
}

// Draws a list of named white balances, and a slider for the colour temperature.
HudRequest WithWhiteBalance(const PanelView& view, HudRequest request) {
  const HudExposure& exposure = view.model.exposure;
  request.white_balance =
      NameList("white balance", exposure.white_balance, view.choices.white_balances);
  if (const auto kelvin = Slider("white light", exposure.white_k.value_or(kDaylight_k),
                                 {kWarmestWhite_k, kCoolestWhite_k, "%.0f K", true}))
    request.white_balance = fmt::format("{:.0f}", *kelvin);
  return request;
}

std::optional<HudThemeChoice> ThemeList(HudThemeChoice current) {
  static const std::vector<std::string> names{"by exposure", "day", "night"};
  const auto chosen = NameList("instruments", names[static_cast<std::size_t>(current)], names);
  if (!chosen) return std::nullopt;
  return static_cast<HudThemeChoice>(std::find(names.begin(), names.end(), *chosen) -
                                     names.begin());
}

constexpr ImGuiTableFlags kTableFlags =
    ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_BordersInnerV;

void ShowTable(const HudChoices& choices) {
  const int columns = static_cast<int>(choices.table_heading.size());
  if (columns == 0 || !ImGui::BeginTable("tables", columns, kTableFlags)) return;
  for (const std::string& name : choices.table_heading) ImGui::TableSetupColumn(name.c_str());
  ImGui::TableHeadersRow();
  for (const HudRow& row : choices.tables) ShowRow(row);
  ImGui::EndTable();
}

std::optional<HudCaptureRequest> PictureButtons(const PanelTyping& typing) {
  const auto request = [&](HudPictureKind kind) {
    return HudCaptureRequest{kind, typing.picture_size[0], typing.picture_size[1], typing.with_hud};
  };
  const bool png = ImGui::Button("PNG");
  ImGui::SameLine();
  const bool exr = ImGui::Button("EXR, linear");
  if (png) return request(HudPictureKind::kPng);
  return exr ? std::optional(request(HudPictureKind::kExr)) : std::nullopt;
}

}  // namespace

HudRequest WithPlaceAndTime(const PanelView& view, PanelTyping& typing, HudRequest request) {
  request.time = TimeControls(view, typing);
  ImGui::Separator();
  request.named_place = PlaceSearch(typing.place_name, StripWidth_px(view));
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  request.place = PlaceControls(view, typing);
  ImGui::PopItemWidth();
  return request;
}

HudRequest WithAir(const PanelView& view, HudRequest request) {
  const HudAir& air = view.model.air;
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  request.air.planet = NameList("planet", air.planet, view.choices.planets);
  request.air.visibility_km =
      Slider("visibility", air.visibility_km, {1.0, 400.0, "%.3g km", true});
  if (!view.choices.mixtures.empty())
    request.air.mixture = NameList("aerosol", air.mixture, view.choices.mixtures);
  request.air.aerosol_scale =
      Slider("amount of aerosol", air.aerosol_scale, {0.01, 10.0, "x %.2f", true});
  request.air.ozone_du = Slider("ozone", air.ozone_du, {0.0, 600.0, "%.0f DU"});
  request.air.ground_albedo = Slider("ground albedo", air.ground_albedo, {0.0, 1.0, "%.2f"});
  ImGui::PopItemWidth();
  return request;
}

HudRequest WithLights(const PanelView& view, HudRequest request) {
  if (view.choices.lamps.empty()) ImGui::TextUnformatted("There are no lamps here.");
  for (std::size_t i = 0; i < view.choices.lamps.size(); ++i) {
    const HudLamp& lamp = view.choices.lamps[i];
    ImGui::PushID(static_cast<int>(i));
    if (const auto on = CheckBox(lamp.name.c_str(), lamp.is_on))
      request.lamp = HudLampRequest{i, *on};
    ImGui::PopID();
  }
  return request;
}

HudRequest WithExposure(const PanelView& view, HudRequest request) {
  const HudExposure& exposure = view.model.exposure;
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  request.exposure_locked = CheckBox("locked", exposure.locked);
  request.ev100 = Slider("EV at ISO 100", exposure.ev100, {kDarkestEv100, kBrightestEv100, "%.1f"});
  request.compensation_ev = Slider("compensation", exposure.compensation_ev, {-5.0, 5.0, "%+.1f"});
  request.tone_curve = NameList("tone curve", exposure.tone_curve, view.choices.tone_curves);
  if (exposure.tone_curve == "agx")
    request.look = NameList("look", exposure.look, view.choices.looks);
  request = WithWhiteBalance(view, std::move(request));
  request.theme = ThemeList(view.theme_choice);
  ImGui::PopItemWidth();
  return request;
}

HudRequest WithFlight(const PanelView& view, HudRequest request) {
  const HudModel& model = view.model;
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  request.mode = NameList("mode", model.flight.mode, view.choices.modes);
  if (model.flight.throttle) {
    if (const auto percent =
            Slider("throttle", 100.0 * *model.flight.throttle, {0.0, 100.0, "%.0f %%"}))
      request.throttle = 0.01 * *percent;
    request = WithHolds(model, std::move(request));
  } else {
    ImGui::TextUnformatted("Throttle and autopilot: in the aircraft.");
  }
  if (const auto aviation = CheckBox("feet and knots", model.units == HudUnits::kAviation))
    request.units = *aviation ? HudUnits::kAviation : HudUnits::kMetric;
  ImGui::PopItemWidth();
  return request;
}

HudRequest WithTables(const PanelView& view, HudRequest request) {
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  request.quality = NameList("quality", view.model.speed.quality, view.choices.qualities);
  ImGui::PopItemWidth();
  ShowTable(view.choices);
  return request;
}

HudRequest WithCapture(const PanelView& view, PanelTyping& typing, HudRequest request) {
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  if (!typing.is_size_typed) typing.picture_size = {view.width, view.height};
  typing.is_size_typed |= ImGui::InputInt2("width, height", typing.picture_size.data());
  for (int& side : typing.picture_size) side = std::clamp(side, 1, kLargestImageSide);
  if (const auto with_hud = CheckBox("with instruments", typing.with_hud))
    typing.with_hud = *with_hud;
  request.capture = PictureButtons(typing);
  request.record = CheckBox("record the flight", view.model.recording);
  ImGui::PopItemWidth();
  return request;
}

}  // namespace alpenglow::viewer
