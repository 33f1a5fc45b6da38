// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/ephemeris_tables.h"

#include <erfa.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>

#include "atmosphere/math/constants.h"

namespace alpenglow::atmosphere {
namespace {

/// Values of several functions of time.
template <std::size_t kFunctions>
using ValuesInTime = std::array<double, kFunctions>;

/// Chebyshev polynomials of several functions over one span of time.
template <std::size_t kFunctions, std::size_t kNodes>
class SpanPolynomials {
 public:
  /// `values`(days after the begin of the span) returns the functions.
  template <typename Values>
  SpanPolynomials(double days, const Values& values) {
    std::array<ValuesInTime<kFunctions>, kNodes> at{};
    for (std::size_t k = 0; k < kNodes; ++k)
      at[k] = values(0.5 * days * (1.0 + std::cos(AngleOf(k))));
    for (std::size_t j = 0; j < kNodes; ++j) {
      for (std::size_t k = 0; k < kNodes; ++k) {
        const double weight =
            (j == 0 ? 1.0 : 2.0) / kNodes * std::cos(static_cast<double>(j) * AngleOf(k));
        for (std::size_t i = 0; i < kFunctions; ++i) coefficients_[j][i] += weight * at[k][i];
      }
    }
  }

  /// Returns the functions at a fraction of the span.
  [[nodiscard]] ValuesInTime<kFunctions> At(double share) const {
    const double twice_x = 2.0 * (2.0 * share - 1.0);
    ValuesInTime<kFunctions> next{}, after{};
    for (std::size_t j = kNodes; j-- > 1;) {
      for (std::size_t i = 0; i < kFunctions; ++i) {
        const double sum = twice_x * next[i] - after[i] + coefficients_[j][i];
        after[i] = next[i];
        next[i] = sum;
      }
    }
    ValuesInTime<kFunctions> values;
    for (std::size_t i = 0; i < kFunctions; ++i)
      values[i] = 0.5 * twice_x * next[i] - after[i] + coefficients_[0][i];
    return values;
  }

 private:
  [[nodiscard]] static double AngleOf(std::size_t node) {
    return kPi * (static_cast<double>(node) + 0.5) / static_cast<double>(kNodes);
  }

  std::array<ValuesInTime<kFunctions>, kNodes> coefficients_{};
};

/// Polynomials of spans that have been asked for.
template <typename Polynomials, typename Make>
class Spans {
 public:
  Spans(double days, Make make) : days_(days), make_(make) {}

  [[nodiscard]] auto At(const TerrestrialTime& time) {
    const double day = (time.day - kModifiedJulianEpoch) + time.part;
    const double span = std::floor(day / days_);
    return Of(span)->At(day / days_ - span);
  }

 private:
  using Shared = std::shared_ptr<const Polynomials>;

  [[nodiscard]] Shared Of(double span) {
    constexpr std::size_t kMost = 4096;  // some megabytes, for 20 years and more
    thread_local double last_span = 0.0;
    thread_local Shared last;
    if (last && last_span == span) return last;
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = spans_.find(span);
    if (known == spans_.end() && spans_.size() >= kMost) spans_.clear();
    last =
        known != spans_.end()
            ? known->second
            : spans_.emplace(span, std::make_shared<const Polynomials>(make_(span * days_, days_)))
                  .first->second;
    last_span = span;
    return last;
  }

  double days_;
  Make make_;
  std::mutex mutex_;
  std::map<double, Shared> spans_;
};

constexpr std::size_t kEarthValues = 12 + 9 + 1;
constexpr double kEarthSpan_days = 16.0, kMoonSpan_days = 8.0;
using EarthPolynomials = SpanPolynomials<kEarthValues, 14>;
using MoonPolynomials = SpanPolynomials<6, 16>;

/// Returns earth, sun and axes by ERFA. Status 1 of eraEpv00, outside 1900-2100, only means that
/// the error is no longer bounded by 0.02 arcseconds.
ValuesInTime<kEarthValues> EarthValuesAt(double day, double part) {
  double heliocentric[2][3], barycentric[2][3], true_from_gcrs[3][3];
  eraEpv00(day, part, heliocentric, barycentric);
  eraPnm06a(day, part, true_from_gcrs);
  double x = 0.0, y = 0.0;
  eraBpn2xy(true_from_gcrs, &x, &y);
  ValuesInTime<kEarthValues> values{};
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      values[6 * k + i] = barycentric[k][i];
      values[6 * k + 3 + i] = barycentric[k][i] - heliocentric[k][i];
    }
  }
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      values[12 + 3 * row + column] = true_from_gcrs[row][column];
  }
  values[21] = eraEors(true_from_gcrs, eraS06(day, part, x, y));
  return values;
}

EarthPolynomials EarthIn(double begin_day, double days) {
  return {days,
          [&](double after) { return EarthValuesAt(kModifiedJulianEpoch + begin_day, after); }};
}

MoonPolynomials MoonIn(double begin_day, double days) {
  return {days, [&](double after) {
            const BodyState moon = MoonFromEarth({kModifiedJulianEpoch + begin_day, after});
            const auto& [p, v] = moon;
            return ValuesInTime<6>{p.x, p.y, p.z, v.x, v.y, v.z};
          }};
}

}  // namespace

EarthAndAxes EarthAndAxesAt(const TerrestrialTime& time) {
  static Spans<EarthPolynomials, decltype(&EarthIn)> spans(kEarthSpan_days, &EarthIn);
  const ValuesInTime<kEarthValues> v = spans.At(time);
  const auto vector = [&](std::size_t first) {
    return glm::dvec3(v[first], v[first + 1], v[first + 2]);
  };
  return {{{vector(0), vector(6)}, {vector(3), vector(9)}},
          glm::dmat3(v[12], v[15], v[18], v[13], v[16], v[19], v[14], v[17], v[20]),
          v[21]};
}

BodyState TabulatedMoonFromEarth(const TerrestrialTime& time) {
  static Spans<MoonPolynomials, decltype(&MoonIn)> spans(kMoonSpan_days, &MoonIn);
  const ValuesInTime<6> v = spans.At(time);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

}  // namespace alpenglow::atmosphere
