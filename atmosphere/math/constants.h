// SPDX-License-Identifier: MIT
// Physical constants and constants of the solar system, with their sources. SI units.
#pragma once

#include <numbers>

namespace alpenglow::atmosphere {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kRadiansPerDegree = kPi / 180.0;
/// Angle between neighbours of a spiral that fills a disk evenly [rad]: pi (3 - sqrt 5). Vogel
/// (1979), Math. Biosciences 44, 179-189.
inline constexpr double kGoldenAngle = kPi * (3.0 - 2.2360679774997896964);
inline constexpr double kMetresPerKilometre = 1000.0;
inline constexpr double kSecondsPerDay = 86400.0;

/// Mean radius of the earth, (2a + b) / 3 of WGS84. Moritz (2000), J. Geodesy 74, 128-133.
inline constexpr double kEarthMeanRadius_m = 6371008.7714;

/// Astronomical unit. IAU 2012 resolution B2, exact.
inline constexpr double kAstronomicalUnit_m = 149597870700.0;

/// Nominal radius of the sun. IAU 2015 resolution B3.
inline constexpr double kSunRadius_m = 6.957e8;

/// Angular radius of the sun at 1 au [rad]: asin(radius / au).
inline constexpr double kSunAngularRadius_rad = 4.650471e-3;

/// Luminous efficacy of monochromatic radiation of 540 THz [lm/W]. CIE 018:2019; the photopic
/// maximum with the 1931 observer is 683.002 at 555 nm.
inline constexpr double kLuminousEfficacy_lm_per_W = 683.002;

/// Scotopic maximum of the luminous efficacy, at 507 nm [lm/W]. CIE 018:2019: with this value
/// radiation of 540 THz has the same scotopic as photopic luminous efficacy.
inline constexpr double kScotopicEfficacy_lm_per_W = 1700.0;

/// Optical depth through which a black object is just visible against the horizon, -ln 0.02: the
/// product of visibility and extinction. Koschmieder (1924), Beitr. Phys. freien Atm. 12, 33.
inline constexpr double kOpticalDepthOfVisibility = 3.912;

inline constexpr double kStandardGravity_m_per_s2 = 9.80665;  // CGPM 1901

}  // namespace alpenglow::atmosphere
