// SPDX-License-Identifier: MIT
#include "renderer/terrain/range_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/terrain/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

// The chains strike east-north-east. `along` runs with them, `across` runs southwards over them.
struct StrikeFrame {
  double along_km;
  double across_km;
};

constexpr double kCosStrike = 0.96;
constexpr double kSinStrike = 0.28;

StrikeFrame ToStrikeFrame(double x_km, double y_km) {
  return {kCosStrike * x_km + kSinStrike * y_km, kSinStrike * x_km - kCosStrike * y_km};
}

struct Chain {
  double across_km;
  double half_width_km;
  double uplift;
};
constexpr std::array<Chain, 5> kChains{{
    {-18.0, 6.5, 0.44},
    {-6.5, 7.0, 0.3},
    {6.5, 8.0, 0.5},
    {19.0, 8.0, 0.65},
    {31.0, 7.5, 0.85},
}};

struct Summit {
  double along_km;
  double across_km;
  double radius_km;
  double uplift;
};
constexpr std::array<Summit, 7> kSummits{{
    {4.0, 6.0, 4.8, 2.0},
    {-13.0, 6.5, 4.0, 0.45},
    {-12.0, -6.0, 3.5, 0.35},
    {-6.0, 18.0, 4.5, 0.35},
    {14.0, 19.0, 4.5, 0.7},
    {1.0, 30.5, 4.5, 0.9},
    {14.0, 30.0, 4.5, 1.0},
}};

// 1 in the middle, 0 from distance 1 on, smooth at both.
double Bump(double distance) {
  const double inside = std::max(0.0, 1.0 - distance * distance);
  return inside * inside;
}

double SmoothStep(double t) {
  const double clamped = std::clamp(t, 0.0, 1.0);
  return clamped * clamped * (3.0 - 2.0 * clamped);
}

// Chains wander and vary along their strike.
double ChainUplift(const StrikeFrame& place, std::uint32_t range_seed) {
  double uplift = 0.0;
  for (std::size_t i = 0; i < kChains.size(); ++i) {
    const Chain& chain = kChains[i];
    const auto seed = range_seed + static_cast<std::uint32_t>(100 + 10 * i);
    constexpr double kWander_km = 3.5;
    constexpr double kOctaves_km = kWander_km * (1.0 + 0.5 + 0.25);  // no noise reaches 1
    const double from_chain_km = place.across_km - chain.across_km;
    if (std::abs(from_chain_km) > chain.half_width_km + kOctaves_km) continue;
    const double wander = kWander_km * FractalNoise(place.along_km / 17.0, 0.3, 3, seed);
    const double offset = (from_chain_km - wander) / chain.half_width_km;
    if (std::abs(offset) >= 1.0) continue;
    const double strength = 1.0 + 0.9 * FractalNoise(place.along_km / 9.0, 0.7, 2, seed + 5);
    uplift += chain.uplift * std::clamp(strength, 0.35, 1.4) * Bump(offset);
  }
  return uplift;
}

double SummitUplift(const StrikeFrame& place) {
  double uplift = 0.0;
  for (const Summit& summit : kSummits) {
    const double along = (place.along_km - summit.along_km) / summit.radius_km;
    const double across = (place.across_km - summit.across_km) / summit.radius_km;
    uplift += summit.uplift * Bump(std::sqrt(along * along + across * across));
  }
  return uplift;
}

// 0 at the rim, 1 from `width_km` inwards.
double RimFade(double x_km, double y_km, double width_km) {
  return SmoothStep((kRangeHalfWidth_km - std::abs(x_km)) / width_km) *
         SmoothStep((kRangeHalfWidth_km - std::abs(y_km)) / width_km);
}

// The place that noise has moved: nothing in the range is straight.
StrikeFrame Warped(double x_km, double y_km, std::uint32_t seed) {
  const double warp_x = 5.5 * FractalNoise(x_km / 17.0, y_km / 17.0, 4, seed + 1);
  const double warp_y = 5.5 * FractalNoise(x_km / 17.0, y_km / 17.0, 4, seed + 2);
  return ToStrikeFrame(x_km + warp_x, y_km + warp_y);
}

// 0 in the northern foreland, 1 from the first chain on.
double South(const StrikeFrame& place) { return SmoothStep((place.across_km + 26.0) / 12.0); }

// 1 from the view of the range northwards, where the ground is that of the first one, 0 from 9 km
// south of it on.
double ForelandShare(double y_km) {
  constexpr double kAlike_km = 2.0, kOther_km = 9.0;
  return SmoothStep((y_km - 1e-3 * kRangeViewNorth_m + kOther_km) / (kOther_km - kAlike_km));
}

// The value of a range, and that of the first one in the north.
template <typename Value>
double OverForeland(double y_km, std::uint32_t seed, const Value& value_of) {
  const double foreland = seed == 0 ? 1.0 : ForelandShare(y_km);
  if (foreland == 1.0) return value_of(std::uint32_t{0});
  if (foreland == 0.0) return value_of(seed);
  return std::lerp(value_of(seed), value_of(std::uint32_t{0}), foreland);
}

double UpliftOf(double x_km, double y_km, std::uint32_t seed) {
  const StrikeFrame place = Warped(x_km, y_km, seed);
  const double ridges = RidgedNoise(place.along_km / 13.0, place.across_km / 13.0, 4, seed + 3);
  const double mountains =
      (ChainUplift(place, seed) + SummitUplift(place)) * (0.35 + 1.15 * ridges);
  const double foreland = 0.02 + 0.04 * ridges + 0.05 * South(place);
  return (foreland + mountains) * RimFade(x_km, y_km, 9.0);
}

}  // namespace

double RelativeUplift(double x_km, double y_km, std::uint32_t seed) {
  return OverForeland(y_km, seed, [&](std::uint32_t of) { return UpliftOf(x_km, y_km, of); });
}

double RelativeErodibility(double x_km, double y_km, std::uint32_t seed) {
  return OverForeland(y_km, seed, [&](std::uint32_t of) {
    return std::clamp(1.0 + 0.9 * FractalNoise(x_km / 6.0, y_km / 6.0, 4, of + 20), 0.5, 2.0);
  });
}

double SteepestSlope(double x_km, double y_km, double relative_uplift, std::uint32_t seed) {
  const double fresh = std::min(1.0, relative_uplift);
  const double layers = OverForeland(y_km, seed, [&](std::uint32_t of) {
    return FractalNoise(x_km / 2.3, y_km / 2.3, 4, of + 30);
  });
  return std::clamp(0.44 + 0.4 * fresh + 0.4 * layers, 0.35, 1.3);
}

double BaseHeight(double x_km, double y_km) { return 450.0 * RimFade(x_km, y_km, 10.0); }

double Alpine(double x_km, double y_km, std::uint32_t seed) {
  return RimFade(x_km, y_km, 9.0) *
         OverForeland(y_km, seed, [&](std::uint32_t of) { return South(Warped(x_km, y_km, of)); });
}

double CrestUnderView(double x_km, double y_km) {
  constexpr double kWhole_km = 0.3, kEnd_km = 6.0;
  const double away_km =
      std::hypot(x_km - 1e-3 * kRangeViewEast_m, y_km - 1e-3 * kRangeViewNorth_m);
  return SmoothStep((kEnd_km - away_km) / (kEnd_km - kWhole_km));
}

}  // namespace alpenglow::renderer
