// SPDX-License-Identifier: MIT
// The rotation of the earth against atomic time, and leap seconds.
//
// Espenak, F. and Meeus, J. (2006), Five Millennium Canon of Solar
// Eclipses, NASA/TP-2006-214141, section 2.3: polynomials of TT - UT1
// in the year. Leap seconds are ERFA's table (IERS bulletin C).
#include <erfa.h>

#include <algorithm>

#include "atmosphere/sun/time.h"
#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

constexpr int kFirstDayOfUtc = 36934;          // 1960-01-01
constexpr int kFirstDayOfLeapSeconds = 41317;  // 1972-01-01
constexpr int kFirstDayUnknown = 61406;        // 2027-01-01, from which ERFA calls a date dubious
constexpr double kTtMinusTai_s = 32.184;       // IAU 1991 resolution A4

/// In [1960, 2027). UTC ran at rates of its own until 1972, in steps of a second since.
double TtMinusUtc(int modified_julian_day, double second_of_day) {
  int year = 0;
  int month = 0;
  int day = 0;
  double fraction = 0.0;
  eraJd2cal(2400000.5, modified_julian_day, &year, &month, &day, &fraction);
  double tai_minus_utc_s = 0.0;
  const int status =
      eraDat(year, month, day, std::min(second_of_day / 86400.0, 1.0), &tai_minus_utc_s);
  ALPENGLOW_ENSURE(status, >=, 0);  // positive: dubious, and its answer the best there is
  return tai_minus_utc_s + kTtMinusTai_s;
}

/// 1900 to 1961 and 2005 to 2150, held constant outside; the years between are not needed.
double EspenakMeeus(double year) {
  const double y = std::clamp(year, 1900.0, 2150.0);
  if (y < 1920.0) {
    const double t = y - 1900.0;
    return -2.79 + t * (1.494119 + t * (-0.0598939 + t * (0.0061966 - t * 0.000197)));
  }
  if (y < 1941.0) {
    const double t = y - 1920.0;
    return 21.20 + t * (0.84493 + t * (-0.076100 + t * 0.0020936));
  }
  if (y < 1961.0) {
    const double t = y - 1950.0;
    return 29.07 + t * (0.407 + t * (-1.0 / 233.0 + t / 2547.0));
  }
  if (y < 2050.0) {
    const double t = y - 2000.0;
    return 62.92 + t * (0.32217 + t * 0.005589);
  }
  const double u = (y - 1820.0) / 100.0;
  return -20.0 + 32.0 * u * u - 0.5628 * (2150.0 - y);
}

double JulianYear(int modified_julian_day, double second_of_day) {
  return 2000.0 + (modified_julian_day - 51544.5 + second_of_day / 86400.0) / 365.25;
}

}  // namespace

double DayLength(int modified_julian_day) {
  if (modified_julian_day < kFirstDayOfLeapSeconds || modified_julian_day >= kFirstDayUnknown) {
    return 86400.0;
  }
  const double step_s =
      TtMinusUtc(modified_julian_day + 1, 0.0) - TtMinusUtc(modified_julian_day, 0.0);
  return step_s > 0.5 ? 86401.0 : 86400.0;
}

double DeltaT(const UtcInstant& instant) {
  const int day = instant.modified_julian_day;
  if (day >= kFirstDayOfUtc && day < kFirstDayUnknown) {
    return TtMinusUtc(day, instant.second_of_day);
  }
  const double year = JulianYear(day, instant.second_of_day);
  const int seam_day = day < kFirstDayOfUtc ? kFirstDayOfUtc : kFirstDayUnknown;
  const double seam_year = JulianYear(seam_day, 0.0);
  const double gap_s =
      (day < kFirstDayOfUtc ? TtMinusUtc(seam_day, 0.0) : TtMinusUtc(seam_day - 1, 86400.0)) -
      EspenakMeeus(seam_year);
  // Before 1960 the polynomials are observations: the gap (0.03 s) fades within ten years. In 2027
  // they are a forecast that came out 6 s too high; nothing says that the earth will catch up.
  const double share =
      day < kFirstDayOfUtc ? std::clamp(1.0 - (seam_year - year) / 10.0, 0.0, 1.0) : 1.0;
  return EspenakMeeus(year) + share * gap_s;
}

}  // namespace alpenglow::atmosphere
