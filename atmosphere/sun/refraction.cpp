// SPDX-License-Identifier: MIT
#include "atmosphere/sun/refraction.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/quadrature.h"
#include "atmosphere/number/root.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"

namespace alpenglow {
namespace {

// ---------------------------------------------------------------- rays

// Edlen (1966), Metrologia 2, 71-80, eq. 1 at 550 nm: 2.7782e-4.
constexpr double kRefractivity = 2.778e-4;
constexpr double kScaleHeight_m = 9366.0;
constexpr double kTop_m = 20.0 * kScaleHeight_m;  // bends by 1e-9 of the whole above

double RefractivityAt(double height_m) {
  return kRefractivity * std::exp(-height_m / kScaleHeight_m);
}

/// The invariant of a ray, n r cos(elevation); Bouguer's law.
double Invariant(double elevation_rad, double height_m, double earth_radius_m) {
  return (1.0 + RefractivityAt(height_m)) * (earth_radius_m + height_m) * std::cos(elevation_rad);
}

/// Height where n r = q, by Newton's method: n r grows by at least a fifth of r down to -12 km.
double HeightOf(double q, double earth_radius_m) {
  double height_m = q - earth_radius_m;
  for (int step = 0; step < 20; ++step) {
    const double refractivity = RefractivityAt(height_m);
    const double radius_m = earth_radius_m + height_m;
    const double excess_m = (height_m - (q - earth_radius_m)) + refractivity * radius_m;
    const double correction_m =
        excess_m / (1.0 + refractivity - refractivity * radius_m / kScaleHeight_m);
    height_m -= correction_m;
    if (std::abs(correction_m) < 1e-6) break;
  }
  return height_m;
}

/// Bending of a ray between two zenith angles, high_rad (where it is lower) and low_rad.
///
/// Auer, L. H. and Standish, E. M. (2000), Astron. J. 119, 2472-2474: with the zenith angle psi as
/// the variable the bending is the integral of -r n' / (n + r n'), which is smooth even where the
/// ray is horizontal.
double Bending(double invariant_m, double low_rad, double high_rad, double earth_radius_m) {
  if (!(low_rad < high_rad)) return 0.0;
  const GaussRule& rule = GaussLegendre(32);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double psi = low_rad + (high_rad - low_rad) * rule.node[i];
    const double height_m = HeightOf(invariant_m / std::sin(psi), earth_radius_m);
    const double refractivity = RefractivityAt(height_m);
    const double slope = -refractivity * (earth_radius_m + height_m) / kScaleHeight_m;  // r n'
    sum += rule.weight[i] * -slope / (1.0 + refractivity + slope);
  }
  return sum * (high_rad - low_rad);
}

/// Zenith angle of a rising ray at a height; at most pi/2, where it is horizontal.
double ZenithAngleAt(double height_m, double invariant_m, double earth_radius_m) {
  const double q = (1.0 + RefractivityAt(height_m)) * (earth_radius_m + height_m);
  return std::asin(std::min(invariant_m / q, 1.0));
}

/// Elevation of the ray that grazes the sea, at the observer; <= 0.
double GrazingElevation(double height_m, double earth_radius_m) {
  const double at_sea_m = (1.0 + RefractivityAt(0.0)) * earth_radius_m;
  const double here_m = (1.0 + RefractivityAt(height_m)) * (earth_radius_m + height_m);
  // acos(at_sea / here), without its cancellation near 1.
  return -2.0 * std::asin(std::sqrt(0.5 * std::max(here_m - at_sea_m, 0.0) / here_m));
}

// ---------------------------------------------------------------- closed form

struct ValueAndSlope {
  double value, slope;
};

/// For air of 15 C and 1013.25 hPa: A cos e / (sin e + b / (sin e + c / (sin e + d))), the
/// continued fraction of Marini (1972), Radio Science 7, 223-231, which is A cot e high up and
/// finite at the horizon. The four constants were fitted to RefractionOfRay from sea level for true
/// elevations from -1.2 to 90 degrees; they miss it by less than 0.05' above -1 degree.
ValueAndSlope StandardRefraction(double elevation_rad) {
  constexpr double kA = 2.78480978e-4;
  constexpr double kB = 1.78501289e-3;
  constexpr double kC = 7.50019978e-3;
  constexpr double kD = 1.42003864e-1;
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

}  // namespace

double RefractionOfRay(double apparent_elevation_rad, double height_m, double earth_radius_m) {
  const double height = std::max(height_m, 0.0);
  const double elevation =
      std::max(apparent_elevation_rad, GrazingElevation(height, earth_radius_m));
  const double invariant = Invariant(elevation, height, earth_radius_m);
  constexpr double kHorizontal = 0.5 * kPi;
  const double psi_exit = ZenithAngleAt(kTop_m, invariant, earth_radius_m);
  const bool inside = height < kTop_m;
  if (elevation >= 0.0) {
    return inside ? Bending(invariant, psi_exit, kHorizontal - elevation, earth_radius_m) : 0.0;
  }
  // From the lowest point of the ray up on both sides, to the observer and out of the air.
  const double psi_entry = inside ? kHorizontal + elevation : psi_exit;
  return Bending(invariant, psi_exit, kHorizontal, earth_radius_m) +
         Bending(invariant, psi_entry, kHorizontal, earth_radius_m);
}

SeaHorizon SeaHorizonFrom(double height_m, double earth_radius_m) {
  const double grazing = GrazingElevation(std::max(height_m, 0.0), earth_radius_m);
  return {-grazing, grazing - RefractionOfRay(grazing, height_m, earth_radius_m)};
}

double RefractionFromHeight(double true_elevation_rad, double height_m, double earth_radius_m) {
  const SeaHorizon horizon = SeaHorizonFrom(height_m, earth_radius_m);
  const double on_horizon = -horizon.dip_rad - horizon.true_elevation_rad;
  if (true_elevation_rad <= horizon.true_elevation_rad) {
    const double below =
        (horizon.true_elevation_rad - true_elevation_rad) / (kFadeBegins_rad - kFadeEnds_rad);
    const double t = std::clamp(1.0 - below, 0.0, 1.0);
    return on_horizon * t * t * (3.0 - 2.0 * t);
  }
  // The apparent elevation lies between the true one and the true one lifted by the refraction on
  // the horizon, the largest there is.
  const auto error = [&](double apparent) {
    return apparent - RefractionOfRay(apparent, height_m, earth_radius_m) - true_elevation_rad;
  };
  const double low = std::max(true_elevation_rad, -horizon.dip_rad);
  const double apparent = BracketedRoot(error, low, true_elevation_rad + on_horizon + 1e-9, 1e-12);
  return apparent - true_elevation_rad;
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

}  // namespace alpenglow
