// SPDX-License-Identifier: MIT
#include "atmosphere/weather/metar_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/units.h"

namespace alpenglow::atmosphere {
namespace {

constexpr std::string_view kDigits = "0123456789";
constexpr double kPascalsPerInchOfMercury = 3386.389;  // 0 degrees Celsius; NIST SP 811
constexpr double kHundredFeet_m = 100.0 * kMetresPerFoot;

constexpr EnumNames kAmounts{{std::pair{CloudAmount::kFew, "FEW"},
                              {CloudAmount::kScattered, "SCT"},
                              {CloudAmount::kBroken, "BKN"},
                              {CloudAmount::kOvercast, "OVC"}}};

struct WeatherWord {
  std::string_view code, text;
};
constexpr std::array<WeatherWord, 4> kPrefixes{
    {{"-", "light"}, {"+", "heavy"}, {"VC", "in the vicinity"}, {"RE", "recent"}}};
constexpr std::array<WeatherWord, 8> kDescriptors{{{"MI", "shallow"},
                                                   {"BC", "in patches"},
                                                   {"PR", "on one side"},
                                                   {"DR", "drifting"},
                                                   {"BL", "blowing"},
                                                   {"SH", "showers"},
                                                   {"TS", "thunderstorm"},
                                                   {"FZ", "freezing"}}};
constexpr std::array<WeatherWord, 22> kPhenomena{
    {{"DZ", "drizzle"},      {"RA", "rain"},         {"SN", "snow"},
     {"SG", "snow grains"},  {"IC", "ice crystals"}, {"PL", "ice pellets"},
     {"GR", "hail"},         {"GS", "small hail"},   {"UP", "unknown precipitation"},
     {"BR", "mist"},         {"FG", "fog"},          {"FU", "smoke"},
     {"VA", "volcanic ash"}, {"DU", "dust"},         {"SA", "sand"},
     {"HZ", "haze"},         {"PY", "spray"},        {"PO", "dust whirls"},
     {"SQ", "squalls"},      {"FC", "funnel cloud"}, {"SS", "sandstorm"},
     {"DS", "dust storm"}}};

template <std::size_t N>
const WeatherWord* Find(const std::array<WeatherWord, N>& words, std::string_view code) {
  const auto found = std::find_if(words.begin(), words.end(),
                                  [&](const WeatherWord& word) { return word.code == code; });
  return found == words.end() ? nullptr : &*found;
}

/// Skips a word if the text begins with it, and returns whether it did.
bool AcceptWord(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

bool IsUnknown(std::string_view text) {
  return !text.empty() && text.find_first_not_of('/') == std::string_view::npos;
}

/// Returns the value of a run of exactly `count` digits, which is skipped.
std::optional<int> Digits(TextCursor& cursor, std::size_t count) {
  const std::string_view digits = cursor.rest().substr(0, count);
  if (digits.size() < count || digits.find_first_not_of(kDigits) != std::string_view::npos)
    return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) cursor.Accept(digits[i]);
  return ParseWholeNumber(digits);
}

constexpr double kSecondsPerHour = 3600.0;

struct WindUnit {
  std::string_view code;
  double m_per_s;
};
constexpr std::array<WindUnit, 3> kWindUnits{{{"KT", kMetresPerNauticalMile / kSecondsPerHour},
                                              {"MPS", 1.0},
                                              {"KMH", kMetresPerKilometre / kSecondsPerHour}}};

/// Returns the unit in which a group ends, or null.
const WindUnit* WindUnitOf(std::string_view group) {
  const auto found = std::find_if(kWindUnits.begin(), kWindUnits.end(),
                                  [&](const WindUnit& unit) { return group.ends_with(unit.code); });
  return found == kWindUnits.end() ? nullptr : &*found;
}

/// A wind as it is written, in its own unit.
struct WrittenWind {
  std::string_view direction, speed, gusts;
  WindUnit unit;
};

constexpr char kWindForm[] =
    "a wind is a direction of three digits or VRB, a speed of two or three digits, possibly G and "
    "gusts, and KT, MPS or KMH";

WrittenWind SplitWind(std::string_view group) {
  const WindUnit* unit = WindUnitOf(group);
  if (unit == nullptr) RefuseGroup(group, kWindForm);
  std::string_view values = group.substr(0, group.size() - unit->code.size());
  const std::string_view direction = values.substr(0, 3);
  values.remove_prefix(direction.size());
  const std::size_t mark = values.find('G');
  const bool has_gusts = mark != std::string_view::npos;
  const std::string_view gusts = has_gusts ? values.substr(mark + 1) : "";
  if (direction.size() < 3 || (has_gusts && gusts.empty())) RefuseGroup(group, kWindForm);
  return {direction, values.substr(0, mark), gusts, *unit};
}

/// Returns a speed in the unit of the group; "P99" is more than the code holds.
double SpeedOf(std::string_view text, std::string_view group) {
  AcceptWord(text, "P");
  TextCursor cursor(text);
  const std::optional<int> speed = cursor.Number(2, 3);
  if (!speed || !cursor.AtEnd()) RefuseGroup(group, kWindForm);
  return *speed;
}

std::optional<double> DirectionOf(const WrittenWind& wind, double speed, std::string_view group) {
  if (wind.direction == "VRB") return std::nullopt;
  TextCursor cursor(wind.direction);
  const std::optional<int> from_deg = cursor.Number(3, 3);
  if (!from_deg) RefuseGroup(group, kWindForm);
  if (*from_deg > 360)
    RefuseGroup(group,
                fmt::format("the wind is from {} degrees; it must be from 0 to 360", *from_deg));
  if (*from_deg == 0 && speed == 0.0) return std::nullopt;
  if (*from_deg == 0)
    RefuseGroup(group, "direction 000 is that of calm air; wind from the north is 360");
  return *from_deg;
}

ReportedVisibility Visibility(double distance_m, VisibilityBound bound) {
  if (distance_m < kLeastVisibility_m) return {kLeastVisibility_m, VisibilityBound::kAtMost};
  return {distance_m, bound};
}

/// Returns the miles of "10", "3/4" or "1 1/2".
std::optional<double> MilesOf(std::string_view text) {
  TextCursor cursor(text);
  std::optional<int> number = cursor.Number(1, 2);
  if (!number) return std::nullopt;
  double miles = 0.0;
  if (cursor.Accept(' ')) {
    miles = *number;
    number = cursor.Number(1, 2);
    if (!number || cursor.rest().empty()) return std::nullopt;
  }
  if (cursor.AtEnd()) return miles + *number;
  if (!cursor.Accept('/')) return std::nullopt;
  const std::optional<int> denominator = cursor.Number(1, 2);
  const bool is_fraction = denominator && cursor.AtEnd() && *number > 0 && *number < *denominator;
  if (!is_fraction) return std::nullopt;
  return miles + static_cast<double>(*number) / *denominator;
}

std::optional<ReportedVisibility> VisibilityInMiles(std::string_view group) {
  std::string_view text = group.substr(0, group.size() - 2);
  if (IsUnknown(text)) return std::nullopt;
  constexpr double kMostMilesOfStations = 10.0;  // stations of the USA report no more
  const bool is_at_least = AcceptWord(text, "P"),
             is_at_most = !is_at_least && AcceptWord(text, "M");
  const std::optional<double> miles = MilesOf(text);
  if (!miles) {
    RefuseGroup(group,
                "a visibility in statute miles is a whole number, a fraction below 1 or both, "
                "possibly after P (more) or M (less)");
  }
  if (is_at_most) return Visibility(*miles * kMetresPerStatuteMile, VisibilityBound::kAtMost);
  const bool is_open = is_at_least || *miles >= kMostMilesOfStations;
  return Visibility(*miles * kMetresPerStatuteMile,
                    is_open ? VisibilityBound::kAtLeast : VisibilityBound::kValue);
}

ReportedVisibility VisibilityInKilometres(std::string_view group) {
  TextCursor cursor(group);
  const std::optional<int> kilometres = cursor.Number(1, 2);
  if (!kilometres || cursor.rest() != "KM" || *kilometres == 0)
    RefuseGroup(group, "a visibility in kilometres is one or two digits and KM");
  constexpr int kMostOfCode_km = 10;
  return Visibility(*kilometres * kMetresPerKilometre, *kilometres >= kMostOfCode_km
                                                           ? VisibilityBound::kAtLeast
                                                           : VisibilityBound::kValue);
}

/// Returns the words of the codes in a text; nothing if one of them is unknown.
std::optional<std::vector<std::string_view>> WordsOfWeather(std::string_view text) {
  std::vector<std::string_view> words;
  for (; text.size() >= 2; text.remove_prefix(2)) {
    const std::string_view code = text.substr(0, 2);
    const WeatherWord* word = Find(kDescriptors, code);
    if (word == nullptr) word = Find(kPhenomena, code);
    if (word == nullptr) return std::nullopt;
    words.push_back(word->text);
  }
  if (!text.empty() || words.empty()) return std::nullopt;
  return words;
}

const WeatherWord* PrefixOf(std::string_view group) {
  const auto found =
      std::find_if(kPrefixes.begin(), kPrefixes.end(),
                   [&](const WeatherWord& prefix) { return group.starts_with(prefix.code); });
  return found == kPrefixes.end() ? nullptr : &*found;
}

std::string_view WithoutPrefix(std::string_view group) {
  const WeatherWord* prefix = PrefixOf(group);
  return prefix == nullptr ? group : group.substr(prefix->code.size());
}

Convection ConvectionOf(std::string_view text, std::string_view group) {
  if (text == "TCU") return Convection::kToweringCumulus;
  if (text == "CB") return Convection::kCumulonimbus;
  if (text.empty() || IsUnknown(text)) return Convection::kUnstated;
  RefuseGroup(group, "after the height, a layer of clouds has CB, TCU or nothing");
}

/// Skips a height in hundreds of feet, which is returned in metres, or "///".
std::optional<double> HeightFrom(std::string_view& text, std::string_view group) {
  if (AcceptWord(text, "///")) return std::nullopt;
  TextCursor cursor(text);
  const std::optional<int> height = Digits(cursor, 3);
  if (!height) RefuseGroup(group, "a height is three digits, in hundreds of feet, or ///");
  text = cursor.rest();
  return *height * kHundredFeet_m;
}

/// Returns the degrees of "12" or "M03"; nothing for "//" and no text.
std::optional<double> DegreesOf(std::string_view text, std::string_view group) {
  if (text.empty() || IsUnknown(text)) return std::nullopt;
  const bool is_negative = AcceptWord(text, "M");
  TextCursor cursor(text);
  const std::optional<int> degrees = cursor.Number(2, 2);
  if (!degrees || !cursor.AtEnd()) {
    RefuseGroup(group,
                "temperature and dew point are two digits each with / between them, and M in "
                "front of negative ones");
  }
  return is_negative ? -*degrees : *degrees;
}

}  // namespace

void RefuseGroup(std::string_view group, std::string_view reason) {
  throw InputError(fmt::format("group \"{}\": {}", Printable(group), reason));
}

bool IsWind(std::string_view group) { return WindUnitOf(group) != nullptr; }

bool IsWindRange(std::string_view group) {
  return group.size() == 7 && group[3] == 'V' &&
         group.find_first_not_of("0123456789V") == std::string_view::npos;
}

bool IsVisibility(std::string_view group) {
  if (group == "////" || group.ends_with("SM")) return true;
  const std::size_t digits = std::min(group.find_first_not_of(kDigits), group.size());
  const std::string_view unit = group.substr(digits);
  return digits > 0 && (unit.empty() || unit == "NDV" || unit == "KM" || unit == "M");
}

bool IsLeastVisibility(std::string_view group) {
  TextCursor cursor(group);
  if (!cursor.Number(4, 4) || cursor.AtEnd()) return false;
  cursor.Run("NS");
  cursor.Run("EW");
  return cursor.AtEnd();
}

bool IsRunway(std::string_view group) {
  return group == "SNOCLO" || (group.starts_with('R') && group.find('/') != std::string_view::npos);
}

bool IsWeather(std::string_view group) {
  if (group == "//" || group == "NSW") return true;
  const WeatherWord* prefix = PrefixOf(group);
  const bool has_sign = prefix != nullptr && prefix->code.size() == 1;
  return has_sign || WordsOfWeather(WithoutPrefix(group)) ||
         (group.starts_with("RE") && IsUnknown(group.substr(2)));
}

bool IsCloud(std::string_view group) {
  return kAmounts.Find(group.substr(0, 3)).has_value() ||
         (group.starts_with("///") && group.size() > 5);
}

bool IsObscuredSky(std::string_view group) { return group.starts_with("VV"); }

bool IsTemperature(std::string_view group) {
  const std::size_t slash = group.find('/');
  if (slash == std::string_view::npos || group.size() > 7 || group.size() < 3) return false;
  return group.find_first_not_of("0123456789M/") == std::string_view::npos;
}

bool IsPressure(std::string_view group) {
  if (group.size() < 2 || (group[0] != 'Q' && group[0] != 'A')) return false;
  return IsUnknown(group.substr(1)) ||
         (group.find_first_not_of(kDigits, 1) == std::string_view::npos);
}

ReportTime TimeFromGroup(std::string_view group) {
  TextCursor cursor(group);
  const std::optional<int> day = Digits(cursor, 2), hour = Digits(cursor, 2),
                           minute = Digits(cursor, 2);
  if (!day || !hour || !minute || cursor.rest() != "Z")
    RefuseGroup(group, "the time is day, hour and minute in two digits each, and Z");
  if (*day < 1 || *day > 31 || *hour > 23 || *minute > 59)
    RefuseGroup(group, fmt::format("there is no day {} with {:02}:{:02}", *day, *hour, *minute));
  return {*day, *hour, *minute};
}

std::optional<ReportedWind> WindFromGroup(std::string_view group) {
  const WrittenWind wind = SplitWind(group);
  if (IsUnknown(wind.speed)) return std::nullopt;
  const double speed = SpeedOf(wind.speed, group);
  if (!wind.gusts.empty() && !IsUnknown(wind.gusts)) {
    const double gusts = SpeedOf(wind.gusts, group);
    if (gusts <= speed)
      RefuseGroup(group, fmt::format("gusts of {} are not above the wind of {}", gusts, speed));
  }
  const double speed_m_per_s = speed * wind.unit.m_per_s;
  if (speed_m_per_s > kFastestWind_m_per_s) {
    RefuseGroup(group, fmt::format("the wind has {:.0f} m/s; it must have at most {:.0f} m/s",
                                   speed_m_per_s, kFastestWind_m_per_s));
  }
  if (IsUnknown(wind.direction)) return ReportedWind{std::nullopt, speed_m_per_s};
  return ReportedWind{DirectionOf(wind, speed, group), speed_m_per_s};
}

std::string GustsOfWind(std::string_view group) {
  const WrittenWind wind = SplitWind(group);
  if (wind.gusts.empty() || IsUnknown(wind.gusts)) return "";
  return fmt::format("G{}{}", wind.gusts, wind.unit.code);
}

std::optional<ReportedVisibility> VisibilityFromGroup(std::string_view group) {
  if (group == "////") return std::nullopt;
  if (group.ends_with("SM")) return VisibilityInMiles(group);
  if (group.ends_with("KM")) return VisibilityInKilometres(group);
  TextCursor cursor(group);
  const std::optional<int> metres = cursor.Number(4, 4);
  if (!metres || !(cursor.AtEnd() || cursor.rest() == "NDV")) {
    RefuseGroup(group,
                "a visibility is four digits, in metres, or statute miles as in 1 1/2SM, P6SM "
                "and M1/4SM");
  }
  constexpr int kMostOfCode_m = 9999;
  if (*metres == kMostOfCode_m) return Visibility(10000.0, VisibilityBound::kAtLeast);
  return Visibility(*metres, VisibilityBound::kValue);
}

WeatherGroup WeatherFromGroup(std::string_view group) {
  if (group == "//" || group == "RE//") return {.in_words = "weather not observed"};
  if (group == "NSW") return {.in_words = "no significant weather"};
  const WeatherWord* prefix = PrefixOf(group);
  const std::string_view codes = WithoutPrefix(group);
  const auto words = WordsOfWeather(codes);
  if (!words) {
    RefuseGroup(group,
                "weather is a sign, VC or RE and codes of two letters, as in -SHRA and VCFG");
  }
  WeatherGroup weather;
  weather.is_fog = prefix == nullptr && (codes == "FG" || codes == "FZFG");
  weather.is_haze = prefix == nullptr && (codes == "BR" || codes == "HZ");
  weather.in_words =
      fmt::format("{}{}", prefix ? fmt::format("{}: ", prefix->text) : "", fmt::join(*words, ", "));
  return weather;
}

std::optional<ReportedCloud> CloudFromGroup(std::string_view group) {
  const std::optional<CloudAmount> amount = kAmounts.Find(group.substr(0, 3));
  std::string_view text = group.substr(3);
  const std::optional<double> height_m = HeightFrom(text, group);
  const Convection convection = ConvectionOf(text, group);
  if (!amount || !height_m) return std::nullopt;
  if (convection != Convection::kUnstated && *height_m > kHighestConvection_m) {
    RefuseGroup(group,
                fmt::format("the base is at {:.0f} m; that of CB and TCU is at most at {:.0f} m",
                            *height_m, kHighestConvection_m));
  }
  return ReportedCloud{std::string(group), *amount, *height_m, convection};
}

ObscuredSky ObscuredSkyFromGroup(std::string_view group) {
  std::string_view text = group.substr(2);
  ObscuredSky sky{std::string(group), HeightFrom(text, group)};
  if (!text.empty())
    RefuseGroup(group, "a vertical visibility is VV and three digits, in hundreds of feet, or ///");
  return sky;
}

ReportedTemperature TemperatureFromGroup(std::string_view group) {
  if (IsUnknown(group)) return {};
  const bool is_air_unknown = group.starts_with("///");
  const std::size_t slash = is_air_unknown ? 2 : group.find('/');
  const ReportedTemperature temperature{DegreesOf(group.substr(0, slash), group),
                                        DegreesOf(group.substr(slash + 1), group)};
  if (temperature.air_c && temperature.dew_point_c &&
      *temperature.dew_point_c > *temperature.air_c) {
    RefuseGroup(group,
                fmt::format("the dew point, {} degrees, is above the temperature, {} degrees",
                            *temperature.dew_point_c, *temperature.air_c));
  }
  return temperature;
}

std::optional<double> PressureFromGroup(std::string_view group) {
  if (IsUnknown(group.substr(1))) return std::nullopt;
  TextCursor cursor(group.substr(1));
  const std::optional<int> digits = cursor.Number(4, 4);
  if (!digits || !cursor.AtEnd())
    RefuseGroup(group, "a pressure is Q or A and four digits: hectopascals, or inches of mercury");
  const double pressure_pa =
      group[0] == 'Q' ? 100.0 * *digits : 0.01 * kPascalsPerInchOfMercury * *digits;
  constexpr double kLeast_pa = 85000.0, kMost_pa = 110000.0;  // beyond all records at the sea
  if (pressure_pa < kLeast_pa || pressure_pa > kMost_pa) {
    RefuseGroup(group, fmt::format("the pressure is {:.0f} hPa; it must lie in [{:.0f}, {:.0f}]",
                                   0.01 * pressure_pa, 0.01 * kLeast_pa, 0.01 * kMost_pa));
  }
  return pressure_pa;
}

}  // namespace alpenglow::atmosphere
