// SPDX-License-Identifier: MIT
#include "viewer/hud/panel_contents.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/picture_format.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"
#include "renderer/clouds/cloud_options.h"
#include "renderer/scene/scene_clouds.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"

namespace alpenglow::viewer {
namespace {

constexpr double kItemWidth = 170.0;   // width of sliders and lists [units]
constexpr double kStripWidth = 440.0;  // units
constexpr double kStripHeight = 64.0;  // units
constexpr double kNightShare = 0.35;   // brightness of the day strip in the night theme

constexpr EnumNames kThemes{{std::pair{HudThemeChoice::kAuto, "by exposure"},
                             {HudThemeChoice::kDay, "day"},
                             {HudThemeChoice::kNight, "night"}}};
const std::vector<std::string> kTableHeading{"", "made in", "memory"};

float Pixels(const PanelView& view, double units) { return static_cast<float>(units * view.scale); }

double StripWidth_px(const PanelView& view) {
  const double margin = static_cast<double>(2.0F * ImGui::GetStyle().WindowPadding.x +
                                            ImGui::GetStyle().ScrollbarSize);
  return std::max(
      std::min(kStripWidth * view.scale, view.width - 2.0 * kPanelMargin * view.scale - margin),
      60.0);
}

void RateButtons(const HudTime& time, double width_px, SceneClock& clock) {
  static constexpr std::array<double, 7> kRates{-3600.0, -60.0, 0.0, 1.0, 10.0, 60.0, 3600.0};
  std::vector<std::string> names;
  for (const double rate : kRates) names.push_back(RateText(rate, false));
  ImGui::Text("rate of time: %s", RateText(time.rate, time.paused).c_str());
  if (const auto pressed = ButtonRows(names, width_px)) clock.SetRate(kRates[*pressed]);
}

// Draws a field for an instant. Returns the text when it is submitted.
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

void EventButtons(double width_px, FlightCommands& flight) {
  std::vector<std::string> names;
  for (const SkyEvent event : kSkyEvents) names.emplace_back(NameOf(event));
  if (const auto pressed = ButtonRows(names, width_px))
    flight.Report(flight.controller().JumpTo(kSkyEvents[*pressed]));
}

void TimeControls(const PanelChange& change, PanelTyping& typing) {
  const auto& [view, preferences, flight] = change;
  const HudTime& time = view.model.time;
  const double width = StripWidth_px(view);
  SceneClock& clock = flight.controller().clock();
  ImGui::TextUnformatted(time.utc.c_str());
  ImGui::TextUnformatted((time.local + " " + time.zone).c_str());
  const auto day_fraction = DayStripControl(
      view.strip, time.day_fraction,
      {width, kStripHeight * view.scale, view.theme == HudTheme::kDay ? 1.0 : kNightShare});
  if (day_fraction) clock.Shift(kSecondsPerDay * (*day_fraction - time.day_fraction));
  EventButtons(width, flight);
  RateButtons(time, width, clock);
  if (const auto paused = CheckBox("paused", time.paused)) clock.Pause(*paused);
  const auto instant = InstantControl(
      typing.instant,
      std::min(Pixels(view, kItemWidth + 40.0), static_cast<float>(width) - Pixels(view, 90.0)));
  if (instant) flight.SetTime(*instant);
}

std::array<double, 3> PlaceOf(const HudModel& model) {
  return {model.latitude_deg, model.longitude_deg, model.flight.height_m};
}

void PlaceControls(const PanelChange& change, PanelTyping& typing) {
  if (!typing.is_place_typed) typing.place = PlaceOf(change.view.model);
  auto& [latitude, longitude, height] = typing.place;
  typing.is_place_typed |= ImGui::InputDouble("latitude", &latitude, 0.0, 0.0, "%.5f°");
  typing.is_place_typed |= ImGui::InputDouble("longitude", &longitude, 0.0, 0.0, "%.5f°");
  typing.is_place_typed |= ImGui::InputDouble("height", &height, 0.0, 0.0, "%.0f m");
  if (!ImGui::Button("go there")) return;
  typing.is_place_typed = false;
  change.flight.MoveTo({std::clamp(latitude, -90.0, 90.0), std::clamp(longitude, -180.0, 360.0),
                        height, std::nullopt, std::nullopt});
}

/// A value that can be held: its name, slider units per SI unit, and range.
struct Holdable {
  const char* name;
  double per_si;
  SliderRange range;
};

// Draws a check box that holds the current value, and a slider for the held value. All values are
// in SI. Returns the target that the user chose, which is empty to release it; nullopt: no choice.
std::optional<std::optional<double>> HoldControl(const Holdable& what,
                                                 const std::optional<double>& held, double now) {
  const double shown = what.per_si * held.value_or(now);
  std::optional<std::optional<double>> chosen;
  ImGui::PushID(what.name);
  if (const auto on = CheckBox(what.name, held.has_value())) {
    const double value = std::clamp(shown, what.range.low, what.range.high) / what.per_si;
    chosen = *on ? std::optional(value) : std::nullopt;
  }
  if (const auto value = Slider("##held", shown, what.range))
    chosen = std::optional(*value / what.per_si);
  ImGui::PopID();
  return chosen;
}

void HoldControls(const HudModel& model, HudUnits units, PilotedAircraft& aircraft) {
  constexpr double kHighest_m = 20000.0, kSlowest_m_per_s = 25.0, kFastest_m_per_s = 280.0;
  const AutopilotTargets& held = model.autopilot;
  AutopilotTargets targets = aircraft.autopilot().targets();
  const double turns = model.flight.heading_rad / (2.0 * kPi);
  const auto heading =
      HoldControl({"hold heading", 1.0 / kRadiansPerDegree, {0.0, 360.0, "%03.0f°"}},
                  held.heading_rad, 2.0 * kPi * (turns - std::floor(turns)));
  const Quantity in_heights = HeightText(0.0, units), in_speeds = SpeedText(0.0, units);
  const std::string height_format = "%.0f " + in_heights.unit;
  const std::string speed_format = "%.0f " + in_speeds.unit;
  const auto height = HoldControl({"hold height",
                                   in_heights.per_si,
                                   {0.0, kHighest_m * in_heights.per_si, height_format.c_str()}},
                                  held.height_m, model.flight.height_m);
  const SliderRange speeds{kSlowest_m_per_s * in_speeds.per_si, kFastest_m_per_s * in_speeds.per_si,
                           speed_format.c_str()};
  const auto speed = HoldControl({"hold speed", in_speeds.per_si, speeds}, held.speed_m_per_s,
                                 model.flight.ground_speed_m_per_s);
  if (heading) targets.heading_rad = *heading;
  if (height) targets.height_m = *height;
  if (speed) targets.speed_m_per_s = *speed;
  if (heading || height || speed) aircraft.autopilot().Set(targets);
}

void ShowRow(const HudRow& row) {
  ImGui::TableNextRow();
  for (const std::string& cell : row) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(cell.c_str());
  }
}

std::string WhiteBalanceOf(const Look& look) {
  for (const std::string& name : WhiteBalanceNames()) {
    if (WhiteBalanceFromText(name) == look.white) return name;
  }
  return fmt::format("{:.0f} K", look.white.kelvin.value_or(kDaylight_k));
}

// Draws a list of named white balances, and a slider for the colour temperature.
void WhiteBalanceControls(const ExposureControl& exposure, Look& look) {
  if (const auto name = NameList("white balance", WhiteBalanceOf(look), WhiteBalanceNames()))
    look.white = WhiteBalanceFromText(*name);
  if (const auto kelvin = Slider("white light", exposure.white_k().value_or(kDaylight_k),
                                 {kWarmestWhite_k, kCoolestWhite_k, "%.0f K", true}))
    look.white = WhiteBalanceFromText(fmt::format("{:.0f}", *kelvin));
}

void LookControls(ExposureControl& exposure) {
  Look look = exposure.look();
  if (const auto curve = NameList("tone curve", NameOf(look.curve), ToneCurveNames()))
    look.curve = ToneCurveFromName(*curve);
  if (look.curve == ToneCurve::kAgx) {
    if (const auto agx = NameList("look", NameOf(look.agx), AgxLookNames()))
      look.agx = AgxLookFromName(*agx);
  }
  WhiteBalanceControls(exposure, look);
  if (look != exposure.look()) exposure.Use(look);
}

void ThemeList(HudThemeChoice& theme) {
  if (const auto chosen = NameList("instruments", kThemes.Of(theme), kThemes.All()))
    theme = *kThemes.Find(*chosen);
}

void ModeList(const HudModel& model, FlightCommands& flight) {
  std::vector<std::string> names;
  for (const FlightMode mode : {FlightMode::kFree, FlightMode::kAircraft, FlightMode::kTrack}) {
    if (mode != FlightMode::kTrack || flight.controller().pilot().track().exists())
      names.emplace_back(NameOf(mode));
  }
  const auto chosen = NameList("mode", model.flight.mode, names);
  if (!chosen) return;
  const auto index = std::find(names.begin(), names.end(), *chosen) - names.begin();
  flight.Report(flight.controller().Enter(static_cast<FlightMode>(index)));
}

constexpr ImGuiTableFlags kTableFlags =
    ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_BordersInnerV;

void ShowTable(const std::vector<HudRow>& rows) {
  if (!ImGui::BeginTable("tables", static_cast<int>(kTableHeading.size()), kTableFlags)) return;
  for (const std::string& name : kTableHeading) ImGui::TableSetupColumn(name.c_str());
  ImGui::TableHeadersRow();
  for (const HudRow& row : rows) ShowRow(row);
  ImGui::EndTable();
}

void PictureButtons(const PanelTyping& typing, FlightCommands& flight) {
  const auto& [width, height] = typing.picture_size;
  for (const PictureFormat& format : PictureFormats()) {
    if (&format != &PictureFormats().front()) ImGui::SameLine();
    const std::string label = std::string(format.name) + (format.StoresLight() ? ", linear" : "");
    if (ImGui::Button(label.c_str()))
      flight.Request({format.extension, ImageSize{width, height}, typing.with_hud});
  }
}

}  // namespace

void DrawPlaceAndTime(const PanelChange& change, PanelTyping& typing) {
  const PanelView& view = change.view;
  TimeControls(change, typing);
  ImGui::Separator();
  if (const auto place = PlaceSearch(typing.place_name, StripWidth_px(view)))
    change.flight.GoTo(*place);
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  PlaceControls(change, typing);
  ImGui::PopItemWidth();
}

void DrawAir(const PanelChange& change) {
  const auto& [view, preferences, flight] = change;
  const HudAir& air = view.model.air;
  AirChoice choice = flight.air_choice();
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  const auto planet = NameList("planet", air.planet, MediumPresetNames());
  const auto visibility_km = Slider("visibility", air.visibility_km, {1.0, 400.0, "%.3g km", true});
  const auto aerosol = Slider("amount of aerosol", air.aerosol_scale, {0.01, 10.0, "x %.2f", true});
  const auto ozone_du = Slider("ozone", air.ozone_du, {0.0, 600.0, "%.0f DU"});
  const auto albedo = Slider("ground albedo", air.ground_albedo, {0.0, 1.0, "%.2f"});
  ImGui::PopItemWidth();
  if (planet) flight.UsePlanet(*planet);
  if (visibility_km) choice.aerosol = AerosolForVisibility(flight.planet(), 1e3 * *visibility_km);
  if (aerosol) choice.aerosol = *aerosol;
  if (ozone_du) choice.ozone_du = ozone_du;
  if (albedo) choice.ground_albedo = albedo;
  if (visibility_km || aerosol || ozone_du || albedo) flight.Use(choice);
}

namespace {

// Draws the controls of one layer and returns the changed layer, if it changes.
std::optional<CloudOptions> LayerControls(const CloudOptions& layer) {
  CloudOptions changed = layer;
  const auto [least, most] = CoversOf(layer.genus);
  const auto set = [](double& value, const std::optional<double>& to) {
    value = to.value_or(value);
  };
  set(changed.cover, Slider("cover", layer.cover, {least, most, "%.2f"}));
  const auto [lowest_m, highest_m] = CloudRanges::kBase_m;
  const double most_m = IsOfIce(layer.genus) ? highest_m : kHighestWaterBase_m;
  set(changed.base_altitude_m, Slider("base", layer.base_altitude_m, {lowest_m, most_m, "%.0f m"}));
  const auto [thinnest_m, deepest_m] = CloudRanges::kDepth_m;
  set(changed.depth_m, Slider("depth", layer.depth_m, {thinnest_m, deepest_m, "%.0f m"}));
  set(changed.wind_m_per_s.x,
      Slider("wind to the east", layer.wind_m_per_s.x, {-50.0, 50.0, "%.0f m/s"}));
  set(changed.wind_m_per_s.y,
      Slider("wind to the north", layer.wind_m_per_s.y, {-50.0, 50.0, "%.0f m/s"}));
  if (const auto seed = Slider("seed", layer.seed, {1.0, 100.0, "%.0f"}))
    changed.seed = static_cast<std::uint32_t>(std::lround(*seed));
  return changed == layer ? std::nullopt : std::optional(changed);
}

}  // namespace

void DrawWeather(const PanelChange& change) {
  std::vector<SceneCloud> clouds = change.flight.clouds();
  bool is_changed = false;
  ImGui::PushItemWidth(Pixels(change.view, kItemWidth));
  static const std::vector<std::string> kSkies{"none", "fair", "broken", "high", "overcast"};
  if (const auto sky = NameList("usual sky", "", kSkies)) {
    clouds = CloudsFromText(*sky);
    is_changed = true;
  }
  for (std::size_t i = 0; i < clouds.size() && !is_changed; ++i) {
    if (!clouds[i].grid.empty()) continue;
    ImGui::PushID(static_cast<int>(i));
    ImGui::Separator();
    ImGui::TextUnformatted(std::string(kCloudGenusNames.Of(clouds[i].options.genus)).c_str());
    if (const auto changed = LayerControls(clouds[i].options)) {
      clouds[i].options = *changed;
      is_changed = true;
    }
    ImGui::PopID();
  }
  ImGui::PopItemWidth();
  if (is_changed) change.flight.Use(clouds);
}

void DrawLights(const PanelChange& change) {
  if (CheckBox("landing light", change.view.model.landing_light))
    change.flight.ToggleLandingLight();
}

void DrawExposure(const PanelChange& change) {
  const HudExposure& shown = change.view.model.exposure;
  ExposureControl& exposure = change.flight.exposure();
  ImGui::PushItemWidth(Pixels(change.view, kItemWidth));
  if (const auto locked = CheckBox("locked", shown.locked)) exposure.Lock(*locked);
  if (const auto ev100 =
          Slider("EV at ISO 100", shown.ev100, {kDarkestEv100, kBrightestEv100, "%.1f"}))
    exposure.Set(*ev100);
  if (const auto ev = Slider("compensation", shown.compensation_ev, {-5.0, 5.0, "%+.1f"}))
    exposure.Compensate(*ev);
  LookControls(exposure);
  ThemeList(change.preferences.theme);
  ImGui::PopItemWidth();
}

void DrawFlight(const PanelChange& change) {
  const auto& [view, preferences, flight] = change;
  const HudModel& model = view.model;
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  ModeList(model, flight);
  PilotedAircraft* aircraft = flight.controller().pilot().aircraft();
  if (model.flight.throttle && aircraft != nullptr) {
    if (const auto percent =
            Slider("throttle", 100.0 * *model.flight.throttle, {0.0, 100.0, "%.0f %%"}))
      aircraft->SetThrottle(0.01 * *percent);
    HoldControls(model, preferences.units, *aircraft);
  } else {
    ImGui::TextUnformatted("Throttle and autopilot: in the aircraft.");
  }
  if (const auto aviation = CheckBox("feet and knots", preferences.units == HudUnits::kAviation))
    preferences.units = *aviation ? HudUnits::kAviation : HudUnits::kMetric;
  ImGui::PopItemWidth();
}

void DrawTables(const PanelChange& change) {
  ImGui::PushItemWidth(Pixels(change.view, kItemWidth));
  if (const auto quality = NameList("quality", change.view.model.speed.quality, QualityRuleTexts()))
    change.flight.Use(QualityRuleFromText(*quality));
  ImGui::PopItemWidth();
  ShowTable(change.view.model.tables);
}

void DrawCapture(const PanelChange& change, PanelTyping& typing) {
  const PanelView& view = change.view;
  ImGui::PushItemWidth(Pixels(view, kItemWidth));
  if (!typing.is_size_typed) typing.picture_size = {view.width, view.height};
  typing.is_size_typed |= ImGui::InputInt2("width, height", typing.picture_size.data());
  for (int& side : typing.picture_size) side = std::clamp(side, 1, kLargestImageSide);
  if (const auto with_hud = CheckBox("with instruments", typing.with_hud))
    typing.with_hud = *with_hud;
  PictureButtons(typing, change.flight);
  if (const auto records = CheckBox("record the flight", view.model.recording))
    change.flight.Record(*records);
  ImGui::PopItemWidth();
}

}  // namespace alpenglow::viewer
