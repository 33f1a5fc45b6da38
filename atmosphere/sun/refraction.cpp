// SPDX-License-Identifier: MIT
#include "atmosphere/sun/refraction.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/sun/bent_ray.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

struct ValueAndSlope {
  double value, slope;
};

/// For air of 15 C and 1013.25 hPa: A cos e / (sin e + b / (sin e + c / (sin e + d))), the
/// continued fraction of Marini (1972), Radio Science 7, 223-231, which is A cot e high up and
/// finite at the horizon. The four constants were fitted to RefractionOfRay from sea level, which they
/// miss by less than 0.04' from the horizon up; below it they go on smoothly.
ValueAndSlope StandardRefraction(double elevation_rad) {
  constexpr double kA = 2.78291862e-4;
  constexpr double kB = 1.60741104e-3;
  constexpr double kC = 5.59356459e-3;
  constexpr double kD = 1.17198817e-1;
  const double sine = std::sin(elevation_rad);
  const double cosine = std::cos(elevation_rad);
  const double inner = sine + kD;
  const double middle = sine + kC / inner;
  const double outer = sine + kB / middle;
  const double middle_slope = 1.0 - kC / (inner * inner);
  const double outer_slope = 1.0 - kB * middle_slope / (middle * middle);
  return {kA * cosine / outer,
          -kA * (sine / outer + cosine * cosine * outer_slope / (outer * outer))};
}

// Refraction is observable down to the last ray of the sun's lower limb over a sea horizon,
// 34' + 32' below the horizontal; the closed form goes there and a little beyond. Further down
// no ray reaches the observer and refraction has no meaning, but a picture moves the sun by it
// continuously. The light that remains, twilight, is that of air high up, which the geometric
// direction describes: so the value fades to 0 until civil twilight ends.
constexpr double kFadeBegins_rad = -1.0 * kRadiansPerDegree;
constexpr double kFadeEnds_rad = -6.0 * kRadiansPerDegree;

/// Cubic that continues value and slope at kFadeBegins and is flat and 0 at kFadeEnds.
double FadedRefraction(double elevation_rad) {
  static const ValueAndSlope begin = StandardRefraction(kFadeBegins_rad);
  constexpr double kWidth = kFadeBegins_rad - kFadeEnds_rad;
  const double t = (elevation_rad - kFadeEnds_rad) / kWidth;
  return t * t * ((3.0 - 2.0 * t) * begin.value + (t - 1.0) * kWidth * begin.slope);
}

double SmoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

BendingAir AlmanacAir(double earth_radius_m) {
  constexpr double kTop_m = 120e3;  // bends by 1e-8 of the whole above
  return {.refractivity = RefractivityAtSeaLevel(kHorizonWavelength_nm),
          .layers = kAlmanacLayers,
          .top_m = kTop_m,
          .planet_radius_m = earth_radius_m};
}

double RefractionOfRay(double apparent_elevation_rad, double height_m, double earth_radius_m) {
  return RefractionSeenAt(AlmanacAir(earth_radius_m), apparent_elevation_rad, height_m);
}

SeaHorizon SeaHorizonFrom(double height_m, double earth_radius_m) {
  const double grazing = GrazingElevation(AlmanacAir(earth_radius_m), height_m);
  return {-grazing, grazing - RefractionOfRay(grazing, height_m, earth_radius_m)};
}

double RefractionFromHeight(double true_elevation_rad, double height_m, double earth_radius_m) {
  return RefractionFromHeight(AlmanacAir(earth_radius_m), true_elevation_rad, height_m);
}

double RefractionFromHeight(const BendingAir& air, double true_elevation_rad, double height_m) {
  const double horizon = GrazingElevation(air, height_m);
  const double on_horizon = RefractionSeenAt(air, horizon, height_m);
  const double last_seen = horizon - on_horizon;
  if (true_elevation_rad <= last_seen) {
    constexpr double kFade_rad = 3.0 * kRadiansPerDegree;  // peaks are sunlit for most of that
    return SmoothStep(1.0 - (last_seen - true_elevation_rad) / kFade_rad) * on_horizon;
  }
  const auto apparent = ApparentElevation(air, true_elevation_rad, height_m);
  return apparent.value_or(horizon) - true_elevation_rad;
}

double LiftForAir(const BendingAir& air, double true_elevation_rad) {
  constexpr double kShare = 0.2;
  const double on_horizon = RefractionSeenAt(air, 0.0, 0.0);
  return kShare * (true_elevation_rad > -on_horizon
                       ? RefractionFromHeight(air, true_elevation_rad, 0.0)
                       : on_horizon);
}

double Refraction(double true_elevation_rad, const AirAtObserver& air) {
  RequireInRange(air.pressure_pa, 0.0, 2e5, "pressure_pa");
  RequireInRange(air.temperature_k, 150.0, 400.0, "temperature_k");
  const double relative_density = (air.pressure_pa / 101325.0) * (288.15 / air.temperature_k);
  if (true_elevation_rad <= kFadeEnds_rad) return 0.0;
  if (true_elevation_rad < kFadeBegins_rad) {
    return relative_density * FadedRefraction(true_elevation_rad);
  }
  return relative_density * StandardRefraction(true_elevation_rad).value;
}

}  // namespace alpenglow::atmosphere
