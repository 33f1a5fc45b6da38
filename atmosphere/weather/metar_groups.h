// SPDX-License-Identifier: MIT
// The groups of aviation weather reports and their values, in SI units.
//
// Code forms FM 15 METAR and FM 16 SPECI: World Meteorological Organization, Manual on Codes, volume
// I.1 (WMO-No. 306); International Civil Aviation Organization, Annex 3, appendix 3. Statute miles,
// inches of mercury and CLR: Federal Meteorological Handbook No. 1 (FCM-H1, USA). Letters may be of
// either case.
//
// Each function reads one group whose kind is known by its first or last letters, and throws
// InputError "group "24O08KT": REASON" for a group that does not have the form of its kind.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

/// Day of the month and time of a report (UTC).
struct ReportTime {
  int day = 1, hour = 0, minute = 0;

  bool operator==(const ReportTime&) const = default;
};

struct ReportedWind {
  std::optional<double> from_deg;  // clockwise from true north, (0, 360]; empty: variable, or calm
  double speed_m_per_s = 0.0;      // mean of 10 minutes, at most kFastestWind_m_per_s
};

/// A report may state a limit of its instruments or of its code in place of a value.
enum class VisibilityBound { kValue, kAtLeast, kAtMost };

struct ReportedVisibility {
  double distance_m = 0.0;  // at least kLeastVisibility_m
  VisibilityBound bound = VisibilityBound::kValue;
};

/// Amounts in eighths of the sky (oktas): few 1 to 2, scattered 3 to 4, broken 5 to 7, overcast 8.
enum class CloudAmount { kFew, kScattered, kBroken, kOvercast };

enum class Convection { kUnstated, kToweringCumulus, kCumulonimbus };

struct ReportedCloud {
  std::string group;  // as reported: "SCT040CB"
  CloudAmount amount = CloudAmount::kFew;
  double height_m = 0.0;  // of the base above the station
  Convection convection = Convection::kUnstated;
};

/// A sky that fog or precipitation hides.
struct ObscuredSky {
  std::string group;
  std::optional<double> vertical_visibility_m;
};

/// Temperature and dew point in degrees Celsius; values that the station did not measure are empty.
struct ReportedTemperature {
  std::optional<double> air_c, dew_point_c;
};

/// Weather at the station or near it.
struct WeatherGroup {
  bool is_fog = false;   // fog at the station that is neither shallow, in patches nor on one side
  bool is_haze = false;  // mist or haze, which visibility alone describes
  std::string in_words;  // "light: showers, rain"
};

/// Shorter visibilities are read as at most this one, the step of the code.
inline constexpr double kLeastVisibility_m = 50.0;
/// Greater values are refused.
inline constexpr double kHighestConvection_m = 6000.0;  // of the bases of CB and TCU
inline constexpr double kFastestWind_m_per_s = 83.0;

/// Throws InputError "group "GROUP": REASON".
[[noreturn]] void RefuseGroup(std::string_view group, std::string_view reason);

/// Returns whether a group has the letters of its kind; the rest of it may be wrong.
[[nodiscard]] bool IsWind(std::string_view group);
[[nodiscard]] bool IsWindRange(std::string_view group);
[[nodiscard]] bool IsVisibility(std::string_view group);
[[nodiscard]] bool IsLeastVisibility(std::string_view group);  // in one direction: "1200SW"
[[nodiscard]] bool IsRunway(std::string_view group);
[[nodiscard]] bool IsWeather(std::string_view group);
[[nodiscard]] bool IsCloud(std::string_view group);
[[nodiscard]] bool IsObscuredSky(std::string_view group);
[[nodiscard]] bool IsTemperature(std::string_view group);
[[nodiscard]] bool IsPressure(std::string_view group);

/// Returns the time of "211350Z".
[[nodiscard]] ReportTime TimeFromGroup(std::string_view group);

/// Returns the wind of "24008KT", "VRB02KT", "24015G28MPS" or "30010KMH"; empty for "/////KT".
[[nodiscard]] std::optional<ReportedWind> WindFromGroup(std::string_view group);
/// Returns the gusts of a wind as it is reported, "G28MPS"; empty if it has none.
[[nodiscard]] std::string GustsOfWind(std::string_view group);

/// Returns the visibility of "0800", "9999", "9999NDV", "10KM", "P6SM", "M1/4SM" or "1 1/2SM"; empty for
/// "////" and "////SM".
[[nodiscard]] std::optional<ReportedVisibility> VisibilityFromGroup(std::string_view group);

/// Returns the weather of "-SHRA", "VCTS", "FZFG" or "RETS".
[[nodiscard]] WeatherGroup WeatherFromGroup(std::string_view group);

/// Returns the clouds of "FEW040", "SCT035TCU" or "BKN012///"; empty if amount or height is not
/// known: "///015", "BKN///", "//////CB".
[[nodiscard]] std::optional<ReportedCloud> CloudFromGroup(std::string_view group);

/// Returns the sky of "VV003" or "VV///".
[[nodiscard]] ObscuredSky ObscuredSkyFromGroup(std::string_view group);

/// Returns the values of "22/12", "M03/M05", "12///" or "/////".
[[nodiscard]] ReportedTemperature TemperatureFromGroup(std::string_view group);

/// Returns the pressure of "Q1018" or "A2992" [Pa], which is reduced to the sea by the standard atmosphere
/// (QNH); empty for "Q////".
[[nodiscard]] std::optional<double> PressureFromGroup(std::string_view group);

}  // namespace alpenglow::atmosphere
