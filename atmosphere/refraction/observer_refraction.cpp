// SPDX-License-Identifier: MIT
#include "atmosphere/refraction/observer_refraction.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
namespace {

/// Above this many scale heights bending is e^-40 of the whole.
constexpr double kScaleHeights = 40.0;

double WidestScaleHeight(const BendingAir& air) {
  double widest_m = 0.0;
  for (const RefractivityLayer& layer : air.layers) {
    if (layer.share != 0.0) widest_m = std::max(widest_m, layer.scale_height_m);
  }
  return widest_m;
}

double SmoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

RisingRays::RisingRays(const BendingAir& air, double height_m)
    : here_m_((1.0 + RefractivityAt(air, height_m)) * (air.planet_radius_m + height_m)) {
  const double way_m = std::min(air.top_m - height_m, kScaleHeights * WidestScaleHeight(air));
  if (!(way_m > 0.0)) return;
  const double here = RefractivityAt(air, height_m);
  const double length = std::sqrt(way_m);
  const GaussRule& rule = GaussLegendre(static_cast<int>(kNodes));
  for (std::size_t i = 0; i < kNodes; ++i) {
    // Nodes are dense where the ray is low: x = t^2.
    const double t = rule.node[i], x = length * t * t, up_m = x * x;
    const double refractivity = RefractivityAt(air, height_m + up_m);
    const double falls_per_m = -RefractivitySlopeAt(air, height_m + up_m) / (1.0 + refractivity);
    strength_[i] = falls_per_m * 4.0 * x * length * t * rule.weight[i];
    over_here_m_[i] =
        up_m * (1.0 + refractivity) + (air.planet_radius_m + height_m) * (refractivity - here);
  }
}

RisingRays::BendingAndSlope RisingRays::At(double elevation_rad) const {
  constexpr double kLeast_m2 = 1e-200;  // above the air all nodes are at the observer
  const double half_sine = std::sin(0.5 * elevation_rad);
  const double less_m = 2.0 * here_m_ * half_sine * half_sine;  // q at the observer minus b
  const double invariant_m = here_m_ - less_m;
  const double twice_m = here_m_ + invariant_m;
  double sum = 0.0, slope_sum = 0.0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double over_m = over_here_m_[i] + less_m;  // q - b
    const double squares_m2 = std::max(over_m * (twice_m + over_here_m_[i]), kLeast_m2);
    const double inverse_per_m = 1.0 / std::sqrt(squares_m2);
    const double ratio = invariant_m * inverse_per_m;
    const double term = strength_[i] * inverse_per_m;
    sum += term;
    slope_sum += term * ratio * ratio;
  }
  return {invariant_m * sum, -here_m_ * std::sin(elevation_rad) * (sum + slope_sum)};
}

ObserverRefraction::ObserverRefraction(const BendingAir& air, double height_m)
    : air_(air),
      height_m_(std::max(height_m, 0.0)),
      horizon_rad_(GrazingElevation(air, height_m_)),
      on_horizon_rad_(0.0),
      rising_(air, height_m_) {
  on_horizon_rad_ = rising_.At(-horizon_rad_).bending_rad;
  if (height_m_ > 0.0)
    on_horizon_rad_ = 2.0 * RisingRays(air, 0.0).At(0.0).bending_rad - on_horizon_rad_;
}

bool IsSame(const BendingAir& a, const BendingAir& b) {
  const auto same_layer = [](const RefractivityLayer& one, const RefractivityLayer& other) {
    return one.share == other.share && one.scale_height_m == other.scale_height_m;
  };
  return a.refractivity == b.refractivity && a.top_m == b.top_m &&
         a.planet_radius_m == b.planet_radius_m &&
         std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), same_layer);
}

bool ObserverRefraction::IsFor(const BendingAir& air, double height_m) const {
  return height_m_ == std::max(height_m, 0.0) && IsSame(air, air_);
}

double ObserverRefraction::Descending(double elevation_rad) const {
  const double lowest_m =
      std::max(RefractedRay(air_, elevation_rad, height_m_).HeightWhere(0.0), 0.0);
  if (lowest_m >= air_.top_m) return 0.0;
  return 2.0 * RisingRays(air_, lowest_m).At(0.0).bending_rad -
         rising_.At(-elevation_rad).bending_rad;
}

double ObserverRefraction::SeenAt(double apparent_elevation_rad) const {
  const double elevation_rad = std::max(apparent_elevation_rad, horizon_rad_);
  return elevation_rad >= 0.0 ? rising_.At(elevation_rad).bending_rad : Descending(elevation_rad);
}

// Uses Newton's method. Bending decreases with the elevation ever more slowly, therefore the steps
// from an elevation that is too low never go beyond the root, and the curvature of the last step is
// an upper bound of that ahead.
double ObserverRefraction::RisingElevationOf(double true_elevation_rad) const {
  constexpr double kLeastStep_rad =
      1e-8;  // the step after one of this length is shorter than 1e-12
  constexpr double kError_rad = 1e-11;
  double elevation_rad = std::max(true_elevation_rad, 0.0);
  double last_step_rad = 0.0, last_per_rad = 0.0;
  for (int step = 0; step < 20; ++step) {
    const auto [bending_rad, per_rad] = rising_.At(elevation_rad);
    const double step_rad =
        (true_elevation_rad + bending_rad - elevation_rad) / (1.0 - std::min(per_rad, 0.0));
    elevation_rad += step_rad;
    if (std::abs(step_rad) < kLeastStep_rad) break;
    const double error_rad = 0.5 * std::abs(per_rad - last_per_rad) * step_rad * step_rad;
    if (step > 0 && error_rad < kError_rad * std::abs(last_step_rad)) break;
    last_step_rad = step_rad;
    last_per_rad = per_rad;
  }
  return elevation_rad;
}

std::optional<double> ObserverRefraction::ApparentElevationOf(double true_elevation_rad) const {
  if (true_elevation_rad >= -rising_.At(0.0).bending_rad)
    return RisingElevationOf(true_elevation_rad);
  if (true_elevation_rad < horizon_rad_ - on_horizon_rad_) return std::nullopt;
  const auto error = [&](double apparent) {
    return apparent - SeenAt(apparent) - true_elevation_rad;
  };
  const double low = std::max(true_elevation_rad, horizon_rad_);
  return BracketedRoot(error, low, true_elevation_rad + on_horizon_rad_ + 1e-9, 1e-12);
}

double ObserverRefraction::AtTrue(double true_elevation_rad) const {
  const double last_seen_rad = horizon_rad_ - on_horizon_rad_;
  if (true_elevation_rad <= last_seen_rad) {
    constexpr double kFade_rad = 3.0 * kRadiansPerDegree;  // peaks are sunlit for most of it
    return SmoothStep(1.0 - (last_seen_rad - true_elevation_rad) / kFade_rad) * on_horizon_rad_;
  }
  return ApparentElevationOf(true_elevation_rad).value_or(horizon_rad_) - true_elevation_rad;
}

const ObserverRefraction& RefractionOfObserver(const BendingAir& air, double height_m) {
  constexpr std::size_t kMost = 4;  // a place and the sea level below it, of two airs
  thread_local std::deque<ObserverRefraction> tables;
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const ObserverRefraction& one) {
    return one.IsFor(air, height_m);
  });
  if (found != tables.end()) return *found;
  if (tables.size() == kMost) tables.pop_front();
  return tables.emplace_back(air, height_m);
}

}  // namespace alpenglow::atmosphere
