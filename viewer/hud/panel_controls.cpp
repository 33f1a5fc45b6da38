// SPDX-License-Identifier: MIT
#include "viewer/hud/panel_controls.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/image/image.h"
#include "lut/image/tone_mapping.h"
#include "lut/sky/sky_view_map.h"
#include "renderer/scene/places.h"

namespace alpenglow::viewer {
namespace {

constexpr std::array<double, 6> kElevations_deg{80.0, 50.0, 28.0, 14.0, 6.0, 1.5};
constexpr int kRows = kElevations_deg.size();

/// Computes sky radiance along rays, in cd/m^2.
class Sky {
 public:
  explicit Sky(const DayStripRequest& request)
      : request_(request),
        medium_(request.multiple_scattering->medium()),
        air_(medium_),
        colour_(medium_.wavelengths_nm),
        altitude_m_(std::max(request.place.height_m, 0.0)),
        horizon_rad_(SkyViewMap(medium_, altitude_m_, 1.0).horizon_zenith_angle_rad()) {}

  /// @param elevation_deg  above the sea horizon.
  [[nodiscard]] std::array<double, 3> LinearSrgb(double elevation_deg,
                                                 const SunPosition& sun) const {
    const double zenith_deg = horizon_rad_ / kRadiansPerDegree - elevation_deg;
    const auto under = [&](const SunPosition& at) {
      return RayFromAngles(altitude_m_, zenith_deg, 0.0,
                           90.0 - at.elevation_rad / kRadiansPerDegree);
    };
    const ViewRay ray = under(SunForAir(sun));
    const double nu_seen = under(sun).nu;
    const RaySamples<float> samples = air_.Sample(ray, {.dark_samples = true});
    const Bands<float> once = air_.Inscatter(air_.Scatter(samples), nu_seen);
    const Bands<float> more =
        request_.multiple_scattering->InscatterAlong(samples, ray.nu, nu_seen, SegmentEnd::kOpen);
    std::vector<double> radiance(once.count);
    for (std::size_t band = 0; band < once.count; ++band) {
      radiance[band] = static_cast<double>(once[band] + more[band]) *
                       medium_.solar_irradiance[band] / (sun.distance_au * sun.distance_au);
    }
    return colour_.LinearSrgb(radiance);
  }

 private:
  const DayStripRequest& request_;
  const Medium& medium_;
  SingleScattering<float> air_;
  BandColour colour_;
  double altitude_m_;
  double horizon_rad_;  // zenith angle of the sea horizon
};

using Column = std::array<std::array<double, 3>, kRows>;

double ShownEv100(const Column& column) {
  constexpr double kShareOfMeter = 0.8, kBrightDayEv100 = 14.0;
  double mean = 0.0;
  for (const auto& rgb : column) mean += shared::Luminance(rgb[0], rgb[1], rgb[2]) / kRows;
  const double darkest = std::exp2(kDarkestEv100) * kMeterConstant / 100.0;
  const double metered = std::log2(100.0 * std::max(mean, darkest) / kMeterConstant);
  return kShareOfMeter * metered + (1.0 - kShareOfMeter) * kBrightDayEv100;
}

std::array<float, 3> DisplayCode(const std::array<double, 3>& rgb, double ev100) {
  const Rgb<double> light = DisplayLight<double>(ToneCurve::kAgx, rgb, ExposureScale(ev100));
  std::array<float, 3> code{};
  for (std::size_t c = 0; c < 3; ++c)
    code[c] = static_cast<float>(shared::SrgbCode(std::clamp(light[c], 0.0, 1.0)));
  return code;
}

}  // namespace

bool LooksTheSame(const DayStripRequest& a, const DayStripRequest& b) {
  constexpr double kAngle_rad = 0.5 * kRadiansPerDegree, kTime_s = 1.0;
  constexpr double kHeight_m = 200.0, kShareOfHeight = 0.1;
  const double apart_rad =
      std::max(std::abs(a.place.latitude_rad - b.place.latitude_rad),
               std::abs(std::remainder(a.place.longitude_rad - b.place.longitude_rad, 2.0 * kPi)) *
                   std::cos(a.place.latitude_rad));
  return a.multiple_scattering == b.multiple_scattering && a.columns == b.columns &&
         std::abs(SecondsBetween(a.begin, b.begin)) < kTime_s && apart_rad < kAngle_rad &&
         std::abs(a.place.height_m - b.place.height_m) <
             std::max(kHeight_m, kShareOfHeight * std::abs(a.place.height_m));
}

DayStrip MakeDayStrip(const DayStripRequest& request) {
  ALPENGLOW_ENSURE(request.columns, >=, 2);
  DayStrip strip;
  strip.columns = request.columns;
  strip.rows = kRows;
  strip.begin = request.begin;
  strip.colours.resize(static_cast<std::size_t>(request.columns) * kRows);
  const Sky sky(request);
  const BendingAir refracting = GentleAirOf(request.multiple_scattering->medium());
  for (int x = 0; x < request.columns; ++x) {
    const UtcInstant instant =
        AddSeconds(request.begin, (x + 0.5) / request.columns * kSecondsPerDay);
    const SunPosition sun = ApparentSunAt(request.place, instant, refracting);
    strip.sun_elevation_rad.push_back(sun.elevation_rad);
    Column column;
    for (std::size_t row = 0; row < kRows; ++row)
      column[row] = sky.LinearSrgb(kElevations_deg[row], sun);
    const double ev100 = ShownEv100(column);
    for (std::size_t row = 0; row < kRows; ++row) {
      strip.colours[row * static_cast<std::size_t>(request.columns) + static_cast<std::size_t>(x)] =
          DisplayCode(column[row], ev100);
    }
  }
  return strip;
}

namespace {

ImU32 Colour(const std::array<float, 3>& rgb, double brightness) {
  const auto share = static_cast<float>(brightness);
  return ImGui::ColorConvertFloat4ToU32({share * rgb[0], share * rgb[1], share * rgb[2], 1.0F});
}

/// Rectangle of the strip [pixels].
struct StripBox {
  ImVec2 from, size;

  [[nodiscard]] ImVec2 At(double x_share, double y_share) const {
    return {from.x + size.x * static_cast<float>(x_share),
            from.y + size.y * static_cast<float>(y_share)};
  }
};

// Draws the colours, interpolated between the centres of columns and rows.
void DrawColours(ImDrawList& list, const DayStrip& strip, const StripBox& box, double brightness) {
  const auto colour = [&](int column, int row) {
    return Colour(strip.at(column, row), brightness);
  };
  const auto x_of = [&](int column) { return (column + 0.5) / strip.columns; };
  for (int row = 0; row + 1 < strip.rows; ++row) {
    const double top = static_cast<double>(row) / (strip.rows - 1);
    const double bottom = (row + 1.0) / (strip.rows - 1);
    for (int column = -1; column < strip.columns; ++column) {
      const int left = std::max(column, 0), right = std::min(column + 1, strip.columns - 1);
      list.AddRectFilledMultiColor(
          box.At(std::max(x_of(column), 0.0), top), box.At(std::min(x_of(column + 1), 1.0), bottom),
          colour(left, row), colour(right, row), colour(right, row + 1), colour(left, row + 1));
    }
  }
}

void DrawHours(ImDrawList& list, const StripBox& box, ImU32 colour) {
  for (int hour = 0; hour <= 24; hour += 3) {
    const ImVec2 foot = box.At(hour / 24.0, 1.0);
    const float mark = box.size.y * (hour % 6 == 0 ? 0.18F : 0.10F);
    list.AddLine({foot.x, foot.y - mark}, foot, colour);
    const std::string text = fmt::format("{}", hour);
    const float half = 0.5F * ImGui::CalcTextSize(text.c_str()).x;
    // Large letters can be wider than a narrow strip.
    const float last = std::max(box.from.x + box.size.x - 2.0F * half, box.from.x);
    const float x = std::clamp(foot.x - half, box.from.x, last);
    list.AddText({x, foot.y}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  }
}

// Draws the path of the sun; noon at the zenith would touch the upper edge.
void DrawSunPath(ImDrawList& list, const DayStrip& strip, const StripBox& box, ImU32 colour) {
  const auto point = [&](int column) {
    const double elevation = strip.sun_elevation_rad[static_cast<std::size_t>(column)];
    return box.At((column + 0.5) / strip.columns, 0.5 - elevation / kPi);
  };
  for (int column = 0; column + 1 < strip.columns; ++column)
    list.AddLine(point(column), point(column + 1), colour, 1.5F);
  list.AddLine(box.At(0.0, 0.5), box.At(1.0, 0.5), (colour & 0xFFFFFFU) | 0x60000000U);
}

void DrawNow(ImDrawList& list, double day_fraction, const StripBox& box) {
  const ImVec2 from = box.At(day_fraction, 0.0), to = box.At(day_fraction, 1.0);
  list.AddLine(from, to, IM_COL32(0, 0, 0, 200), 4.0F);
  list.AddLine(from, to, ImGui::GetColorU32(ImGuiCol_CheckMark), 2.0F);
}

// Returns the time of day.
std::string ClockText(double day_fraction) {
  const auto minutes = std::lround(day_fraction * 24.0 * 60.0);
  return fmt::format("{:02d}:{:02d}", minutes / 60, minutes % 60);
}

}  // namespace

std::optional<double> Slider(const char* label, double value, const SliderRange& range) {
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (range.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
  const bool changed = ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &range.low,
                                           &range.high, range.format, flags);
  return changed ? std::optional(value) : std::nullopt;
}

std::optional<std::string> NameList(const char* label, const std::string& current,
                                    std::span<const std::string> names) {
  if (!ImGui::BeginCombo(label, current.c_str())) return std::nullopt;
  std::optional<std::string> chosen;
  for (const std::string& name : names) {
    if (ImGui::Selectable(name.c_str(), name == current)) chosen = name;
  }
  ImGui::EndCombo();
  return chosen;
}

std::optional<bool> CheckBox(const char* label, bool is_on) {
  return ImGui::Checkbox(label, &is_on) ? std::optional(is_on) : std::nullopt;
}

std::optional<std::size_t> ButtonRows(std::span<const std::string> names, double row_width_px) {
  std::optional<std::size_t> pressed;
  const ImGuiStyle& style = ImGui::GetStyle();
  double used = 0.0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double width = static_cast<double>(ImGui::CalcTextSize(names[i].c_str()).x +
                                             2.0F * style.FramePadding.x + style.ItemSpacing.x);
    if (i > 0 && used + width <= row_width_px) ImGui::SameLine();
    used = i > 0 && used + width <= row_width_px ? used + width : width;
    if (ImGui::Button(names[i].c_str())) pressed = i;
  }
  return pressed;
}

std::optional<double> DayStripControl(const DayStrip* strip, double day_fraction,
                                      const StripLook& look) {
  const StripBox box{ImGui::GetCursorScreenPos(),
                     {static_cast<float>(look.width_px), static_cast<float>(look.height_px)}};
  ImGui::InvisibleButton("day", box.size);
  const bool is_held = ImGui::IsItemActive(), is_hovered = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 line = (ImGui::GetColorU32(ImGuiCol_Text) & 0xFFFFFFU) | 0xAA000000U;
  if (strip == nullptr) {
    list.AddRectFilled(box.from, box.At(1.0, 1.0), ImGui::GetColorU32(ImGuiCol_FrameBg));
  } else {
    DrawColours(list, *strip, box, look.brightness);
    DrawSunPath(list, *strip, box, line);
  }
  DrawHours(list, box, line);
  DrawNow(list, std::clamp(day_fraction, 0.0, 1.0), box);
  const double share = std::clamp(
      static_cast<double>(ImGui::GetIO().MousePos.x - box.from.x) / look.width_px, 0.0, 1.0);
  if (is_held || is_hovered) ImGui::SetTooltip("%s", ClockText(share).c_str());
  ImGui::Dummy({box.size.x, ImGui::GetTextLineHeight()});
  return is_held ? std::optional(share) : std::nullopt;
}

namespace {

// Returns the searchable names: "Zürich Airport (LSZH, Kloten)".
std::string LabelOf(const NamedPlace& place) {
  const std::string both = place.code.empty() || place.also.empty() ? "" : ", ";
  const std::string others = place.code + both + place.also;
  return others.empty() ? place.name : fmt::format("{} ({})", place.name, others);
}

}  // namespace

std::optional<std::string> PlaceSearch(std::array<char, 64>& typed, double width_px) {
  constexpr float kLines = 6.5F;  // a half line shows that the list continues
  const auto width = static_cast<float>(width_px);
  ImGui::SetNextItemWidth(width);
  const bool entered =
      ImGui::InputTextWithHint("##search", "name of a place, Enter: fly there", typed.data(),
                               typed.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  const std::vector<const NamedPlace*> places = PlacesByName(typed.data());
  std::optional<std::string> chosen;
  if (entered && !places.empty()) chosen = places.front()->name;
  const float height = kLines * ImGui::GetTextLineHeightWithSpacing();
  if (!ImGui::BeginListBox("##places", {width, height})) return chosen;
  if (places.empty()) ImGui::TextUnformatted("There is no such place in the list.");
  for (const NamedPlace* place : places) {
    if (ImGui::Selectable(LabelOf(*place).c_str())) chosen = place->name;
  }
  ImGui::EndListBox();
  return chosen;
}

}  // namespace alpenglow::viewer
