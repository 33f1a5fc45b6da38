// SPDX-License-Identifier: MIT
// Atmospheric refraction: rays in air whose density decreases with height over a sphere, by
// Bouguer's law.
//
//   n(h) - 1 = N sum of s_i exp(-h / H_i),  sum of s_i = 1
//   q cos(e) = b,  q = n r                                    along a ray of the elevation e
//   bending  = integral of -r n' / (n + r n') over e          Auer and Standish (2000)
//   column   = integral of density b / (cos^2(e) (n + r n')) over e
//
// with r = R + h and n' = dn/dr. Elevations of rays are those of an observer's line of sight; light
// propagates in the opposite direction. Auer, L. H. and Standish, E. M. (2000), Astron. J. 119,
// 2472-2474: with the zenith angle, or here the elevation, as the variable both integrands are
// smooth even where the ray is horizontal; the column follows from
// dr = q sin(e) / (cos(e) (n + r n')) de.
//
// Negative height arguments are treated as 0.
//
// Refraction of light from outside the air is computed with such rays, for observers at any height.
// The refractivity decreases with height as defined by kAlmanacLayers, in spherical shells; at the
// ground it is that of air of 15 C and 1013.25 hPa at 550 nm. A star seen at the horizontal from
// sea level is lifted by the 34' of the almanacs. The model reproduces quantities that almanacs
// tabulate separately: refraction at any elevation, the refracted dip of the sea horizon, and the
// refraction of a body on the horizon. The air of the earth presets bends rays in the same way.
// Weather changes all of these values by minutes of arc near the horizon.
#pragma once

#include <array>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {

/// Wavelength near the peak sensitivity of the eye, which therefore defines the visible horizon.
inline constexpr double kHorizonWavelength_nm = 550.0;

/// Returns n - 1 for air of 15 C and 1013.25 hPa with 450 ppm of carbon dioxide: Ciddor (1996),
/// Appl. Opt. 35, 1566-1573, equation 1, s = 1 um / wavelength,
///
///   10^8 (n - 1) = 5792105 / (238.0185 - s^2) + 167917 / (57.362 - s^2).
///
/// @param wavelength_nm  in [200, 4000]; measured from 300 to 1690.
[[nodiscard]] double RefractivityAtSeaLevel(double wavelength_nm);

/// A part of the refractivity that decreases exponentially with height.
struct RefractivityLayer {
  double share;           // share of the refractivity at altitude 0; positive or negative
  double scale_height_m;  // > 0
};
using RefractivityLayers = std::array<RefractivityLayer, 3>;

/// Height profile of the refractivity in the standard air of almanacs. It was fitted so that, from
/// sea level, a star on the horizon is lifted by 34.0' and a star up to 20 degrees high as by
/// Bennett (1982) within 0.25', and that rays which are level 2 to 13 km up bend as in the U.S.
/// Standard Atmosphere 1976 within 0.6'. That atmosphere itself lifts a star on the horizon by
/// 33.0', and the fit has its density within 5 % up to 30 km.
inline constexpr RefractivityLayers kAlmanacLayers{
    {{2.236, 6078.0}, {-2.116, 3576.0}, {0.880, 2664.2}}};

/// Air that bends rays, over a sphere. GentlyBends must be true for it.
struct BendingAir {
  double refractivity;  // n - 1 at altitude 0, >= 0
  RefractivityLayers layers;
  double top_m;  // there is no refraction above
  double planet_radius_m = kEarthMeanRadius_m;

  /// Returns the scale height of the refractivity at high altitudes [m].
  [[nodiscard]] double UpperScaleHeight() const { return layers.front().scale_height_m; }
};

/// Functions for n - 1 [1], and its derivative with respect to height [1/m].
[[nodiscard]] double RefractivityAt(const BendingAir& air, double height_m);
[[nodiscard]] double RefractivitySlopeAt(const BendingAir& air, double height_m);

/// Returns n' / n [1/m], the curvature of a level ray: negative if it bends towards the ground.
[[nodiscard]] double CurvaturePerMetreAt(const BendingAir& air, double height_m);

/// Returns whether n r increases with height by at least a fifth of r everywhere. Where n r
/// decreases, the air forms a duct and the ground appears concave; the formulas of this header are
/// then not valid.
[[nodiscard]] bool GentlyBends(const BendingAir& air);

/// A ray, defined by the line of sight of an observer.
class RefractedRay {
 public:
  /// @param elevation_rad  apparent elevation of the line of sight, at the height.
  RefractedRay(const BendingAir& air, double elevation_rad, double height_m);

  /// Returns the height [m] at which the rising ray has a (positive) elevation, to a micrometre.
  [[nodiscard]] double HeightWhere(double elevation_rad) const;
  /// Returns the elevation [rad], >= 0, at which the ray passes a height; 0 if it does not get so
  /// low.
  [[nodiscard]] double ElevationAt(double height_m) const;

  /// Returns the bending [rad] between two elevations of its rising part.
  [[nodiscard]] double Bending(double low_rad, double high_rad) const;

  /// Returns the column on the path to space [m], for a relative density or for several: `density`
  /// is a function of height_m that returns a number or a vector. For molecules the column is
  /// within 2e-3 of that of the ray equation from the horizon to 6 degrees above it.
  template <typename Density>
  [[nodiscard]] auto ColumnToSpace(const Density& density) const {
    auto sum = 0.0 * density(height_m_);
    const GaussRule& rule = GaussLegendre(64);
    VisitParts([&](double low_rad, double high_rad) {
      for (std::size_t i = 0; i < rule.node.size(); ++i) {
        // Nodes are dense where the ray is low and most of the air is.
        const double t = rule.node[i];
        const double elevation = low_rad + (high_rad - low_rad) * t * t;
        const double height_m = HeightWhere(elevation);
        sum += rule.weight[i] * 2.0 * t * (high_rad - low_rad) *
               MetresPerRadian(elevation, height_m) * density(height_m);
      }
    });
    return sum;
  }

 private:
  /// Calls visit(low_rad, high_rad) for each rising part of the path to space: one, or two if the
  /// path goes through its lowest point.
  template <typename Visit>
  void VisitParts(const Visit& visit) const {
    const double exit_rad = ElevationAt(air_.top_m);
    if (elevation_rad_ >= 0.0) {
      if (height_m_ < air_.top_m) visit(elevation_rad_, exit_rad);
      return;
    }
    visit(0.0, exit_rad);
    visit(0.0, height_m_ < air_.top_m ? -elevation_rad_ : exit_rad);
  }
  /// @param height_m  height at which the ray has the elevation.
  [[nodiscard]] double MetresPerRadian(double elevation_rad, double height_m) const;
  /// Returns n r at a height minus the ray's invariant [m], without cancellation.
  [[nodiscard]] double OverInvariant(double height_m) const;

  BendingAir air_;
  double elevation_rad_, height_m_;
  double invariant_m_;  // b
};

/// Returns the elevation [rad] of the ray that grazes the ground, at the observer; <= 0.
[[nodiscard]] double GrazingElevation(const BendingAir& air, double height_m);

/// Returns apparent minus true elevation [rad] of light that arrives at an apparent elevation or,
/// below the horizon, of the light that grazes the ground. Within 0.1' of the ray equation.
[[nodiscard]] double RefractionSeenAt(const BendingAir& air, double apparent_elevation_rad,
                                      double height_m);

/// Returns the standard air of almanacs at kHorizonWavelength_nm.
[[nodiscard]] BendingAir AlmanacAir(double earth_radius_m = kEarthMeanRadius_m);

/// Returns apparent minus true elevation [rad] of light that arrives at an observer `height_m`
/// above sea level at an apparent elevation or, below the sea horizon, of the light that grazes it.
/// Within 1' of a ray traced through the U.S. Standard Atmosphere 1976 from the ground.
[[nodiscard]] double RefractionOfRay(double apparent_elevation_rad, double height_m,
                                     double earth_radius_m = kEarthMeanRadius_m);

/// The horizon of the sea, seen from above.
struct SeaHorizon {
  double dip_rad;             // depression of the apparent horizon, >= 0
  double true_elevation_rad;  // of a point at infinity that appears on the horizon, without air
};

/// Returns the horizon seen from `height_m` above the sea, from 0 to any distance; negative heights
/// are treated as 0.
[[nodiscard]] SeaHorizon SeaHorizonFrom(double height_m,
                                        double earth_radius_m = kEarthMeanRadius_m);

/// Returns apparent minus true elevation [rad] as a function of the *true* elevation, for an
/// observer at sea level, on a mountain, in an aeroplane or in orbit, in any air that bends rays
/// gently. Below the sea horizon, where only sunlit peaks indicate the position of the sun, the
/// refraction at the horizon fades to 0 within 3 degrees.
[[nodiscard]] double RefractionFromHeight(const BendingAir& air, double true_elevation_rad,
                                          double height_m);

/// Returns the lift [rad] of a sun or moon at a *true* elevation for which straight rays light the
/// air approximately as refracted rays do: a fifth of the refraction seen from sea level, 7' from
/// the horizon down, for any height of the observer.
///
/// A refracted ray that grazes the planet arrives higher than a straight one, but it stays low for
/// longer, and spreads: straight rays from the apparent position of the sun bring up to twice the
/// light. With this lift, single scattering (450, 550, 650 nm) towards observers from sea level to
/// 3 km is within 5 % (rms over directions) of that of refracted rays while the sun is up, 6 % down
/// to -4 degrees and 17 % down to -8, where blue is brighter and red, whose light comes through
/// lower air, darker. These figures exclude the sky up to 10 degrees over the horizon opposite a
/// sun that has set, where single scattering ends. tests/bench/refracted_twilight.cpp compares
/// values of the lift.
[[nodiscard]] double LiftForAir(const BendingAir& air, double true_elevation_rad);

}  // namespace alpenglow::atmosphere
