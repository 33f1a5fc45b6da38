// SPDX-License-Identifier: MIT
#include "renderer/camera/odd_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/camera/along_way.h"

namespace alpenglow::renderer {
namespace {

/// Consecutive values of which each can be reached from the one before.
struct Piece {
  std::size_t first, last;              // indices of values
  std::size_t values = 0;               // number of values of the best chain that ends with it
  std::optional<std::size_t> before{};  // piece before it in this chain
};

/// Returns the pieces, each with its best chain. Pieces farther back than kWindow are not joined to
/// one: this bounds the time for a track of noise.
template <typename CanReach>
std::vector<Piece> ChainedPieces(std::size_t count, const CanReach& can_reach) {
  constexpr std::size_t kWindow = 512;
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && can_reach(i - 1, i)) {
      pieces.back().last = i;
    } else {
      pieces.push_back({i, i});
    }
  }
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Piece& piece = pieces[k];
    for (std::size_t j = k; j-- > k - std::min(k, kWindow);) {
      const Piece& other = pieces[j];
      if (other.values <= piece.values || !can_reach(other.last, piece.first)) continue;
      piece.values = other.values;
      piece.before = j;
    }
    piece.values += piece.last - piece.first + 1;
  }
  return pieces;
}

/// Returns which of the values are outside of the longest chain; none if the chain does not contain
/// more than half of them.
template <typename CanReach>
std::vector<bool> OutsideLongestChain(std::size_t count, const CanReach& can_reach) {
  const std::vector<Piece> pieces = ChainedPieces(count, can_reach);
  const auto longest =
      std::max_element(pieces.begin(), pieces.end(),
                       [](const Piece& a, const Piece& b) { return a.values < b.values; });
  if (longest == pieces.end() || 2 * longest->values <= count) return std::vector<bool>(count);
  std::vector<bool> outside(count, true);
  for (auto at = std::optional(static_cast<std::size_t>(longest - pieces.begin())); at;
       at = pieces[*at].before) {
    for (std::size_t i = pieces[*at].first; i <= pieces[*at].last; ++i) outside[i] = false;
  }
  return outside;
}

/// Returns the median, 0 of nothing.
double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<glm::dvec3> PositionsOf(const std::vector<Place>& places) {
  std::vector<glm::dvec3> positions_m;
  for (const Place& place : places) positions_m.push_back(EcefFromGeodetic(kWgs84, place).xyz);
  return positions_m;
}

/// Returns whether the track has times: a single one gives no speed.
bool IsTimed(const PlacesInTime& points) {
  const auto times = std::count_if(points.times_s.begin(), points.times_s.end(),
                                   [](const auto& time_s) { return time_s.has_value(); });
  return times > 1;
}

/// Returns times of the points at `rest`, 0 of the others. Missing ones follow from the way between
/// points with a time, and beyond them from the mean speed of all.
std::vector<double> TimesAlong(const std::vector<glm::dvec3>& positions_m,
                               const std::vector<std::optional<double>>& times_s,
                               const std::vector<std::size_t>& rest) {
  constexpr double kUnknown_s_per_m = 1.0;  // of points with times that all have one place
  std::vector<double> way_m, all(times_s.size(), 0.0);
  std::vector<std::optional<double>> known;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const double step_m =
        k > 0 ? glm::distance(positions_m[rest[k - 1]], positions_m[rest[k]]) : 0.0;
    way_m.push_back(k > 0 ? way_m.back() + step_m : 0.0);
    known.push_back(times_s[rest[k]]);
  }
  std::vector<std::size_t> timed;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    if (known[k]) timed.push_back(k);
  }
  if (timed.empty()) return all;
  const double whole_m = way_m[timed.back()] - way_m[timed.front()];
  const double whole_s = *known[timed.back()] - *known[timed.front()];
  const double s_per_m = whole_m > 0.0 && whole_s > 0.0 ? whole_s / whole_m : kUnknown_s_per_m;
  const std::vector<double> completed =
      CompletedAlong(way_m, known, [&](std::size_t k, std::size_t near, std::size_t) {
        return *known[near] + (way_m[k] - way_m[near]) * s_per_m;
      });
  for (std::size_t k = 0; k < rest.size(); ++k) all[rest[k]] = completed[k];
  return all;
}

/// Returns which points lie at latitude 0 and longitude 0, far from their nearest neighbours that
/// do not.
std::vector<bool> OnNullIsland(const std::vector<Place>& places,
                               const std::vector<glm::dvec3>& positions_m) {
  constexpr double kAt_rad = 1e-5 * kRadiansPerDegree;
  constexpr double kFar_m = 100e3;
  const auto is_null = [&](std::size_t i) {
    return std::abs(places[i].latitude_rad()) < kAt_rad &&
           std::abs(places[i].longitude_rad()) < kAt_rad;
  };
  std::vector<bool> odd(places.size());
  for (std::size_t i = 0; i < places.size();) {
    std::size_t end = i + 1;
    if (is_null(i)) {
      while (end < places.size() && is_null(end)) ++end;
      const auto is_far = [&](std::size_t other) {
        return glm::distance(positions_m[i], positions_m[other]) > kFar_m;
      };
      const bool far_before = i == 0 || is_far(i - 1);
      const bool far_after = end == places.size() || is_far(end);
      if (far_before && far_after)
        std::fill(odd.begin() + static_cast<std::ptrdiff_t>(i),
                  odd.begin() + static_cast<std::ptrdiff_t>(end), true);
    }
    i = end;
  }
  return odd;
}

/// Returns the indices of the values that are false.
std::vector<std::size_t> Rest(const std::vector<bool>& odd) {
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < odd.size(); ++i) {
    if (!odd[i]) rest.push_back(i);
  }
  return rest;
}

/// Marks the values at `rest` that are outside of their longest chain.
template <typename CanReach>
void MarkUnreachable(const std::vector<std::size_t>& rest, const CanReach& can_reach,
                     std::vector<bool>& odd) {
  const std::vector<bool> outside = OutsideLongestChain(
      rest.size(), [&](std::size_t a, std::size_t b) { return can_reach(rest[a], rest[b]); });
  for (std::size_t k = 0; k < rest.size(); ++k) odd[rest[k]] = outside[k];
}

/// The largest rate at which a value of a track can change.
struct RateLimit {
  double per_s;         // at least
  double median_times;  // or this multiple of the median rate of the track
  double noise;         // in addition, in any time
};

/// Marks the values at `rest` that nothing reaches in the time of the track. `apart`(a, b) is the
/// difference of two values.
template <typename Apart>
void MarkTooFast(const std::vector<std::size_t>& rest, const std::vector<double>& times_s,
                 const RateLimit& limit, const Apart& apart, std::vector<bool>& odd) {
  std::vector<double> rates;
  for (std::size_t k = 1; k < rest.size(); ++k) {
    const double step_s = times_s[rest[k]] - times_s[rest[k - 1]];
    if (step_s > 0.0) rates.push_back(apart(rest[k - 1], rest[k]) / step_s);
  }
  const double most = std::max(limit.per_s, limit.median_times * MedianOf(std::move(rates)));
  MarkUnreachable(
      rest,
      [&](std::size_t a, std::size_t b) {
        return apart(a, b) <= limit.noise + most * (times_s[b] - times_s[a]);
      },
      odd);
}

bool IsCustomaryForMissing(double height_m) {
  constexpr std::array<double, 9> kCustomary{-999.0,  -9999.0, -99999.0, 9999.0,  99999.0,
                                             65535.0, 32767.0, -32767.0, -32768.0};
  return std::find(kCustomary.begin(), kCustomary.end(), height_m) != kCustomary.end();
}

}  // namespace

std::vector<bool> OddPlaces(const PlacesInTime& points) {
  constexpr RateLimit kLimit{.per_s = 400.0, .median_times = 5.0, .noise = 200.0};
  constexpr double kFar_m = 500e3, kTimesFarther = 200.0;
  const std::vector<glm::dvec3> positions_m = PositionsOf(points.places);
  std::vector<bool> odd = OnNullIsland(points.places, positions_m);
  const std::vector<std::size_t> rest = Rest(odd);
  const auto apart_m = [&](std::size_t a, std::size_t b) {
    return glm::distance(positions_m[a], positions_m[b]);
  };
  if (IsTimed(points)) {
    MarkTooFast(rest, TimesAlong(positions_m, points.times_s, rest), kLimit, apart_m, odd);
    return odd;
  }
  std::vector<double> steps_m;
  for (std::size_t k = 1; k < rest.size(); ++k) steps_m.push_back(apart_m(rest[k - 1], rest[k]));
  const double most_m = std::max(kFar_m, kTimesFarther * MedianOf(std::move(steps_m)));
  MarkUnreachable(
      rest, [&](std::size_t a, std::size_t b) { return apart_m(a, b) <= most_m; }, odd);
  return odd;
}

std::vector<bool> OddHeights(const PlacesInTime& points,
                             const std::vector<std::optional<double>>& heights_m) {
  constexpr RateLimit kLimit{.per_s = 100.0, .median_times = 20.0, .noise = 300.0};
  constexpr double kSteep = 2.0, kNoiseOfDrawing_m = 1000.0;
  std::vector<bool> odd(heights_m.size());
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    odd[i] = heights_m[i] && IsCustomaryForMissing(*heights_m[i]);
    if (heights_m[i] && !odd[i]) rest.push_back(i);
  }
  const auto apart_m = [&](std::size_t a, std::size_t b) {
    return std::abs(*heights_m[a] - *heights_m[b]);
  };
  const std::vector<glm::dvec3> positions_m = PositionsOf(points.places);
  if (IsTimed(points)) {
    const std::vector<std::size_t> all = Rest(std::vector<bool>(points.places.size()));
    MarkTooFast(rest, TimesAlong(positions_m, points.times_s, all), kLimit, apart_m, odd);
    return odd;
  }
  MarkUnreachable(
      rest,
      [&](std::size_t a, std::size_t b) {
        return apart_m(a, b) <=
               kNoiseOfDrawing_m + kSteep * glm::distance(positions_m[a], positions_m[b]);
      },
      odd);
  return odd;
}

}  // namespace alpenglow::renderer
