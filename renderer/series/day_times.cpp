// SPDX-License-Identifier: MIT
#include "renderer/series/day_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"

namespace alpenglow::renderer {
namespace {

// Indices into kTimesOfDay.
constexpr std::size_t kSunrise = 3, kSunset = 5;
constexpr const char* kEclipseFields =
    ",eclipse_first_contact,eclipse_second_contact,eclipse_deepest,eclipse_third_contact,"
    "eclipse_last_contact,eclipse_magnitude,eclipse_obscuration";
// Column heads of the table, in two lines.
constexpr std::array<std::array<const char*, 2>, kTimesOfDay.size()> kHeads{{{"astr.", "dawn"},
                                                                             {"naut.", "dawn"},
                                                                             {"civil", "dawn"},
                                                                             {"sun", "rise"},
                                                                             {"", "noon"},
                                                                             {"sun", "set"},
                                                                             {"civil", "dusk"},
                                                                             {"naut.", "dusk"},
                                                                             {"astr.", "dusk"},
                                                                             {"moon", "rise"},
                                                                             {"moon", "tran."},
                                                                             {"moon", "set"}}};

/// Returns the visible eclipse of the mean solar day, which has the daylight in its middle.
std::optional<SeenEclipse> EclipseOf(const EventDay& day, const DayTimes& times) {
  const UtcTime midnight = MeanSolarMidnight(day.place, *day.around);
  const auto eclipse = FindSolarEclipse(day.place, midnight, kSecondsPerDay);
  if (!eclipse) return std::nullopt;
  std::vector<SolarEclipse::Moment> seen;
  if (eclipse->maximum.IsSeen()) seen.push_back(eclipse->maximum);
  for (const std::size_t event : {kSunrise, kSunset}) {
    if (times.at.at(event)) seen.push_back(EclipseAt(day.place, *times.at.at(event)));
  }
  const auto deepest =
      std::min_element(seen.begin(), seen.end(), [](const auto& one, const auto& other) {
        return one.disk.separation < other.disk.separation;
      });
  if (deepest == seen.end() || !deepest->disk.IsCovered()) return std::nullopt;
  return SeenEclipse{*eclipse, *deepest};
}

DayTimes TimesOf(const EventDay& day) {
  DayTimes times;
  times.date = DateAt(*day.around, day);
  for (std::size_t i = 0; i < kTimesOfDay.size(); ++i) {
    times.at[i] = FindDailyEvent(kTimesOfDay[i], day);
  }
  const UtcTime noon = *FindSunEvent(SunEvent::kNoon, day.place, *day.around);
  times.noon_elevation_deg = ApparentSunAt(day.place, noon).elevation_deg;
  times.moon_illuminated = TrueMoonAt(day.place, noon).illuminated_fraction;
  times.eclipse = EclipseOf(day, times);
  return times;
}

/// Returns "04:25", in the zone or in UTC.
std::string ClockTime(const std::optional<UtcTime>& instant,
                      const std::optional<std::string>& zone) {
  if (!instant) return "--:--";
  constexpr double kHalfMinute_s = 30.0;
  const UtcTime rounded = AddSeconds(*instant, kHalfMinute_s);
  return (zone ? FormatInZone(rounded, *zone) : FormatUtc(rounded)).substr(11, 5);
}

/// Returns "20:28:13", in the zone or in UTC.
std::string ClockSecond(const UtcTime& instant, const std::optional<std::string>& zone) {
  return (zone ? FormatInZone(instant, *zone) : FormatUtc(instant)).substr(11, 8);
}

/// Returns "eclipse of the sun: begins 19:33:04, total 20:28:21 to 20:30:05, deepest 20:29:13 ...".
std::string LineOf(const SeenEclipse& eclipse, const std::optional<std::string>& zone) {
  const SolarEclipse& whole = eclipse.whole;
  std::string text = "           eclipse of the sun: ";
  if (whole.first_contact.IsSeen())
    text += fmt::format("begins {}, ", ClockSecond(whole.first_contact.instant, zone));
  if (whole.inner && whole.inner->second_contact.IsSeen() && whole.inner->third_contact.IsSeen()) {
    text += fmt::format("{} {} to {}, ", whole.maximum.disk.moon_radius > 1.0 ? "total" : "annular",
                        ClockSecond(whole.inner->second_contact.instant, zone),
                        ClockSecond(whole.inner->third_contact.instant, zone));
  }
  const SolarEclipse::Moment& deepest = eclipse.at_deepest;
  text += fmt::format("deepest {} (magnitude {:.3f}, {:.2f}% covered)",
                      ClockSecond(deepest.instant, zone), deepest.disk.Magnitude(),
                      100.0 * deepest.disk.CoveredArea());
  if (whole.last_contact.IsSeen())
    text += fmt::format(", ends {}", ClockSecond(whole.last_contact.instant, zone));
  return text + "\n";
}

/// Returns fields of the CSV, each with a comma in front.
std::string FieldsOf(const std::optional<SeenEclipse>& eclipse) {
  if (!eclipse) return ",,,,,,,";
  const auto field = [](const SolarEclipse::Moment& moment) {
    return fmt::format(",{}", moment.IsSeen() ? FormatUtc(moment.instant) : "");
  };
  const SolarEclipse& whole = eclipse->whole;
  return field(whole.first_contact) + (whole.inner ? field(whole.inner->second_contact) : ",") +
         fmt::format(",{}", FormatUtc(eclipse->at_deepest.instant)) +
         (whole.inner ? field(whole.inner->third_contact) : ",") + field(whole.last_contact) +
         fmt::format(",{:.4f},{:.4f}", eclipse->at_deepest.disk.Magnitude(),
                     eclipse->at_deepest.disk.CoveredArea());
}

}  // namespace

void VisitTimesOfDays(const EventDay& first, int count,
                      const std::function<void(const DayTimes&)>& visit) {
  if (!first.around) throw InputError("times of which days? give a date");
  for (int i = 0; i < count; ++i) {
    ThrowIfInterrupted();
    EventDay day = first;
    day.around = AddSeconds(*first.around, i * kSecondsPerDay);
    visit(TimesOf(day));
  }
}

std::string HeadOfTable(const std::optional<std::string>& zone) {
  std::string text;
  for (std::size_t line = 0; line < 2; ++line) {
    text += fmt::format("{:<10}", line == 0 ? "" : zone.value_or("UTC").substr(0, 10));
    for (const auto& head : kHeads) text += fmt::format(" {:>5}", head[line]);
    text += line == 0 ? "  noon  moon\n" : "   sun   lit\n";
  }
  return text;
}

std::string LinesOf(const DayTimes& day, const std::optional<std::string>& zone) {
  std::string text = day.date;
  for (const auto& instant : day.at) text += fmt::format(" {}", ClockTime(instant, zone));
  text += fmt::format(" {:5.1f} {:4.0f}%\n", day.noon_elevation_deg, 100.0 * day.moon_illuminated);
  return day.eclipse ? text + LineOf(*day.eclipse, zone) : text;
}

std::string HeaderOfTimesCsv() {
  return fmt::format("date,{},noon_elevation_deg,moon_illuminated{}\n", fmt::join(kTimesOfDay, ","),
                     kEclipseFields);
}

std::string CsvLineOf(const DayTimes& day) {
  std::string text = day.date;
  for (const auto& instant : day.at) text += fmt::format(",{}", instant ? FormatUtc(*instant) : "");
  return text + fmt::format(",{:.3f},{:.4f}{}\n", day.noon_elevation_deg, day.moon_illuminated,
                            FieldsOf(day.eclipse));
}

}  // namespace alpenglow::renderer
