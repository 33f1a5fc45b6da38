// SPDX-License-Identifier: MIT
#include "atmosphere/weather/metar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/parsing.h"

namespace alpenglow::atmosphere {
namespace {

using Groups = std::vector<std::string>;

/// The places of groups in a report, in their order.
enum class Section {
  kWind,
  kWindRange,
  kVisibility,
  kLeastVisibility,
  kRunway,
  kWeather,
  kClouds,
  kTemperature,
  kPressure,
  kOther
};

constexpr EnumNames kSectionNames{{std::pair{Section::kWind, "a wind"},
                                   {Section::kWindRange, "a range of the wind"},
                                   {Section::kVisibility, "a visibility"},
                                   {Section::kLeastVisibility, "a visibility in one direction"},
                                   {Section::kRunway, "a state of a runway"},
                                   {Section::kWeather, "weather"},
                                   {Section::kClouds, "a group of clouds"},
                                   {Section::kTemperature, "a temperature"},
                                   {Section::kPressure, "a pressure"},
                                   {Section::kOther, "another group"}}};

bool IsOneOf(std::string_view group, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), group) != names.end();
}

bool IsColourState(std::string_view group) {
  return IsOneOf(group,
                 {"BLU", "BLU+", "WHT", "GRN", "YLO", "YLO1", "YLO2", "AMB", "RED", "BLACK"});
}

bool IsTrend(std::string_view group) {
  return IsOneOf(group, {"NOSIG", "BECMG", "TEMPO", "INTER"}) || group.starts_with("PROB") ||
         (group.starts_with("FM") && group.size() > 2);
}

/// Temperature and waves of the sea: "W15/S4".
bool IsSea(std::string_view group) {
  return group.starts_with("W") && group.find('/') != std::string_view::npos;
}

bool MayBeRepeated(Section section) {
  return section == Section::kLeastVisibility || section == Section::kRunway ||
         section == Section::kWeather || section == Section::kClouds ||
         section == Section::kPressure || section == Section::kOther;
}

std::optional<Section> SectionOf(std::string_view group) {
  if (IsWind(group)) return Section::kWind;
  if (IsWindRange(group)) return Section::kWindRange;
  if (group == "CAVOK" || IsVisibility(group)) return Section::kVisibility;
  if (IsLeastVisibility(group)) return Section::kLeastVisibility;
  if (IsColourState(group) || group == "WS" || IsSea(group)) return Section::kOther;
  if (IsWeather(group)) return group.starts_with("RE") ? Section::kOther : Section::kWeather;
  if (IsRunway(group)) return Section::kRunway;
  const bool is_clear = IsOneOf(group, {"NSC", "NCD", "SKC", "CLR"});
  if (is_clear || IsCloud(group) || IsObscuredSky(group)) return Section::kClouds;
  if (IsTemperature(group)) return Section::kTemperature;
  if (IsPressure(group)) return Section::kPressure;
  return std::nullopt;
}

/// Returns the groups in capital letters, a mile with its fraction as one group, without "=" at the end.
Groups GroupsOf(std::string_view text) {
  Groups groups;
  for (const std::string_view word : WordsOf(text)) {
    std::string group;
    for (const char letter : word) group += UpperCase(letter);
    if (group.ends_with('=')) group.pop_back();
    if (group.empty()) continue;
    const bool is_fraction =
        group.ends_with("SM") && group.find('/') != std::string::npos && !groups.empty();
    if (is_fraction && groups.back().size() <= 2 && ParseWholeNumber(groups.back())) {
      groups.back().append(1, ' ').append(group);
    } else {
      groups.push_back(group);
    }
  }
  return groups;
}

/// Reads the groups from first to last.
class ReportReader {
 public:
  explicit ReportReader(std::string_view text) : groups_(GroupsOf(text)) {
    report_.text = fmt::format("{}", fmt::join(groups_, " "));
  }

  MetarReport Read() {
    ReadHead();
    while (!AtEnd() && !ReadRest()) {
      const std::string group = Take();
      Note(group, Placed(group));
    }
    return std::move(report_);
  }

 private:
  [[nodiscard]] bool AtEnd() const { return next_ == groups_.size(); }
  std::string Take() { return groups_[next_++]; }
  bool Accept(std::initializer_list<std::string_view> names) {
    if (AtEnd() || !IsOneOf(groups_[next_], names)) return false;
    ++next_;
    return true;
  }

  void ReadHead() {
    if (Accept({"TAF"})) RefuseGroup("TAF", "this is a forecast; a METAR or SPECI is needed");
    Accept({"METAR", "SPECI"});
    Accept({"COR", "AMD"});
    if (AtEnd()) throw InputError("the report has no station; it begins as in METAR LSZH 211350Z");
    const std::string station = Take();
    const bool is_station = station.size() == 4 && station.front() >= 'A' &&
                            station.front() <= 'Z' &&
                            std::all_of(station.begin(), station.end(), IsLetterOrDigit);
    if (!is_station) {
      RefuseGroup(station,
                  "a report begins with the four letters of a station and a time, as in "
                  "LSZH 211350Z");
    }
    report_.station = station;
    if (AtEnd()) throw InputError("the report has no time; it begins as in METAR LSZH 211350Z");
    if (Accept({"NIL"})) RefuseGroup("NIL", "the report is missing");
    report_.time = TimeFromGroup(Take());
    while (Accept({"AUTO", "COR", "RTD"}) || AcceptCorrection()) {
    }
    if (Accept({"NIL"})) RefuseGroup("NIL", "the report is missing");
  }

  /// Skips the number of a correction, "CCA" to "CCZ", as Canada reports it.
  bool AcceptCorrection() {
    if (AtEnd() || groups_[next_].size() != 3 || !groups_[next_].starts_with("CC")) return false;
    ++next_;
    return true;
  }

  /// Skips the trend and the remarks if they come next; returns whether they did.
  bool ReadRest() {
    const bool is_trend = IsTrend(groups_[next_]);
    if (!is_trend && groups_[next_] != "RMK") return false;
    const auto remarks =
        std::find(groups_.begin() + static_cast<std::ptrdiff_t>(next_), groups_.end(), "RMK");
    if (is_trend) {
      const std::span trend(groups_.begin() + static_cast<std::ptrdiff_t>(next_), remarks);
      report_.not_modelled.push_back(fmt::format("{} (trend)", fmt::join(trend, " ")));
    }
    if (remarks != groups_.end()) report_.not_modelled.emplace_back("RMK (remarks)");
    next_ = groups_.size();
    return true;
  }

  /// Returns the section of a group. Refuses one that is unknown, out of order or given twice.
  Section Placed(const std::string& group) {
    std::optional<Section> section = SectionOf(group);
    // States of runways have the form of visual ranges and stand at the end.
    const bool is_late = section_ && *section_ >= Section::kTemperature;
    if (section == Section::kRunway && is_late) section = Section::kOther;
    if (!section) RefuseGroup(group, "no group of a METAR has this form");
    if (section_ && *section < *section_) {
      RefuseGroup(group, fmt::format("{} in this form stands before {}", kSectionNames.Of(*section),
                                     previous_));
    }
    if (section_ == section && !MayBeRepeated(*section))
      RefuseGroup(group, fmt::format("{} already gives this", previous_));
    section_ = section;
    previous_ = group;
    return *section;
  }

  void Note(const std::string& group, Section section) {
    switch (section) {
      case Section::kWind:
        return NoteWind(group);
      case Section::kWindRange:
        return Leave(group, "range of the wind");
      case Section::kVisibility:
        return NoteVisibility(group);
      case Section::kLeastVisibility:
        return Leave(group, "visibility in one direction");
      case Section::kRunway:
        return Leave(group, "runway");
      case Section::kWeather:
        return NoteWeather(group);
      case Section::kClouds:
        return NoteClouds(group);
      case Section::kTemperature:
        report_.temperature = TemperatureFromGroup(group);
        return;
      case Section::kPressure:
        return NotePressure(group);
      case Section::kOther:
        return NoteOther(group);
    }
  }

  void Leave(const std::string& group, std::string_view meaning) {
    report_.not_modelled.push_back(fmt::format("{} ({})", group, meaning));
  }

  void NoteWind(const std::string& group) {
    report_.wind = WindFromGroup(group);
    if (const std::string gusts = GustsOfWind(group); !gusts.empty()) Leave(gusts, "gusts");
  }

  void NoteVisibility(const std::string& group) {
    if (group != "CAVOK") {
      report_.visibility = VisibilityFromGroup(group);
      return;
    }
    constexpr double kVisibilityOfCavok_m = 10000.0;
    report_.visibility = {kVisibilityOfCavok_m, VisibilityBound::kAtLeast};
    report_.states_clouds = true;
    clear_ = group;
  }

  void NoteWeather(const std::string& group) {
    const WeatherGroup weather = WeatherFromGroup(group);
    if (weather.is_fog) report_.fog = group;
    if (!weather.is_fog && !weather.is_haze) Leave(group, weather.in_words);
  }

  void NoteClouds(const std::string& group) {
    if (!clear_.empty())
      RefuseGroup(group, fmt::format("{} says that there are no such clouds", clear_));
    if (IsObscuredSky(group)) {
      if (report_.obscured) RefuseGroup(group, "the vertical visibility is given twice");
      report_.obscured = ObscuredSkyFromGroup(group);
      report_.states_clouds = true;
    } else if (!IsCloud(group)) {
      if (report_.states_clouds)
        RefuseGroup(group, "it says that there are no clouds, and a group before it gives clouds");
      clear_ = group;
      report_.states_clouds = true;
    } else if (const std::optional<ReportedCloud> cloud = CloudFromGroup(group)) {
      report_.clouds.push_back(*cloud);
      report_.states_clouds = true;
    } else {
      Leave(group, "clouds of unknown amount or height");
    }
  }

  void NotePressure(const std::string& group) {
    const std::optional<double> pressure_pa = PressureFromGroup(group);
    if (!pressure_pa) return;
    // Whole hectopascals are rounded down, hundredths of an inch are 34 Pa.
    constexpr double kRounding_pa = 150.0;
    if (report_.pressure_pa && std::abs(*pressure_pa - *report_.pressure_pa) > kRounding_pa) {
      RefuseGroup(group, fmt::format("it is {:.1f} hPa, and the group before it {:.1f} hPa",
                                     0.01 * *pressure_pa, 0.01 * *report_.pressure_pa));
    }
    if (!report_.pressure_pa) report_.pressure_pa = pressure_pa;
  }

  void NoteOther(std::string group) {
    if (group == "WS") {
      while (!AtEnd() && IsRunwayOfShear(groups_[next_])) group.append(1, ' ').append(Take());
      return Leave(group, "wind shear");
    }
    if (IsWeather(group)) return Leave(group, WeatherFromGroup(group).in_words);
    Leave(group, IsSea(group) ? "sea" : IsRunway(group) ? "runway" : "colour state");
  }

  static bool IsRunwayOfShear(std::string_view group) {
    return IsOneOf(group, {"ALL", "RWY", "TKOF", "LDG"}) || group.starts_with("RWY") ||
           (group.starts_with('R') && group.size() <= 4 && group.size() >= 3 && group[1] <= '9');
  }

  Groups groups_;
  std::size_t next_ = 0;
  MetarReport report_;
  std::optional<Section> section_;  // of the previous group
  std::string previous_;            // the previous group
  std::string clear_;               // the group that says that there are no clouds
};

}  // namespace

MetarReport ReadMetar(std::string_view text) { return ReportReader(text).Read(); }

}  // namespace alpenglow::atmosphere
