// SPDX-License-Identifier: MIT
// Rays in air whose density falls off with height over a sphere: Bouguer's law.
//
//   n(h) - 1 = N sum of s_i exp(-h / H_i),  sum of s_i = 1
//   q cos(e) = b,  q = n r                                    along a ray of the elevation e
//   bending  = integral of -r n' / (n + r n') over e          Auer and Standish (2000)
//   column   = integral of density b / (cos^2(e) (n + r n')) over e
//
// with r = R + h and n' = dn/dr. Elevations of rays are those that an eye at the place sees; light
// comes the other way. Auer, L. H. and Standish, E. M. (2000), Astron. J. 119, 2472-2474: with the
// zenith angle, or here the elevation, as the variable both integrands are smooth even where the
// ray is horizontal; the column follows from dr = q sin(e) / (cos(e) (n + r n')) de.
//
// What asks for a height takes one below 0 as 0.
//
// Refraction by rays: where light from outside the air arrives, seen from any height.
//
// Refractivity falls off with height as kAlmanacLayers (refraction.h) say, in spherical shells; at the
// ground it is that of air of 15 C and 1013.25 hPa at 550 nm. A star seen at the horizontal from sea
// level is lifted by the 34' of the almanacs. The model reproduces what almanacs tabulate apart:
// refraction at any elevation, the refracted dip of the sea horizon, and the refraction of a body
// that stands on it. The air of the earth presets bends rays alike. sun.h has a closed form for
// observers on the ground, of which this is the judge. Weather moves all of it by minutes of arc
// near the horizon.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "atmosphere/number/constants.h"
#include "atmosphere/number/numerics.h"

namespace alpenglow::atmosphere {

/// Where most of the light is that eyes see, and the horizon therefore.
inline constexpr double kHorizonWavelength_nm = 550.0;

/// n - 1 of air of 15 C and 1013.25 hPa with 450 ppm of carbon dioxide: Ciddor (1996), Appl. Opt.
/// 35, 1566-1573, equation 1, s = 1 um / wavelength,
///
///   10^8 (n - 1) = 5792105 / (238.0185 - s^2) + 167917 / (57.362 - s^2).
///
/// @param wavelength_nm  in [200, 4000]; measured from 300 to 1690.
[[nodiscard]] double RefractivityAtSeaLevel(double wavelength_nm);

/// A part of the refractivity that falls off exponentially with height.
struct RefractivityLayer {
  double share;           // of that at altitude 0; of either sign
  double scale_height_m;  // > 0
};
using RefractivityLayers = std::array<RefractivityLayer, 3>;

/// How the refractivity of the air of almanacs falls off, fitted so that from sea level a star on
/// the horizon is lifted by 34.0' and one up to 20 degrees high as by Bennett (1982) within 0.25',
/// and that rays which are level 2 to 13 km up bend as in the U.S. Standard Atmosphere 1976 within
/// 0.6'. That atmosphere itself lifts a star on the horizon by 33.0', and the fit has its density
/// within 5 % up to 30 km.
inline constexpr RefractivityLayers kAlmanacLayers{
    {{2.236, 6078.0}, {-2.116, 3576.0}, {0.880, 2664.2}}};

/// Air that bends rays, over a sphere. GentlyBends must be true of it.
struct BendingAir {
  double refractivity;  // n - 1 at altitude 0, >= 0
  RefractivityLayers layers;
  double top_m;  // nothing bends above
  double planet_radius_m = kEarthMeanRadius_m;

  /// Over which refractivity falls off far up [m].
  [[nodiscard]] double UpperScaleHeight() const { return layers.front().scale_height_m; }
};

/// n - 1 [1], and how it changes with height [1/m].
[[nodiscard]] double RefractivityAt(const BendingAir& air, double height_m);
[[nodiscard]] double RefractivitySlopeAt(const BendingAir& air, double height_m);

/// Returns n' / n [1/m], the curvature of a level ray: negative where it bends towards the ground.
[[nodiscard]] double CurvaturePerMetreAt(const BendingAir& air, double height_m);

/// Whether n r grows with height by at least a fifth of r everywhere: where it falls, air traps
/// rays, the ground seems hollow, and nothing here holds.
[[nodiscard]] bool GentlyBends(const BendingAir& air);

/// A ray by where it is seen from.
class BentRay {
 public:
  /// @param elevation_rad  apparent, of the eye's line of sight, at the height.
  BentRay(const BendingAir& air, double elevation_rad, double height_m);

  /// Where it has the (positive) elevation, on its way up: height [m], to a micrometre.
  [[nodiscard]] double HeightWhere(double elevation_rad) const;
  /// Elevation [rad], >= 0, where it passes a height; 0 where it does not get so low.
  [[nodiscard]] double ElevationAt(double height_m) const;

  /// Bending [rad] between two elevations of its rising part.
  [[nodiscard]] double Bending(double low_rad, double high_rad) const;

  /// Bending on the way from the eye out of the air, once past its lowest point if it looks down.
  /// That point must not be below the ground.
  [[nodiscard]] double BendingToSpace() const {
    double sum = 0.0;
    VisitParts([&](double low_rad, double high_rad) { sum += Bending(low_rad, high_rad); });
    return sum;
  }

  /// Column on that way [m], of what has a density relative to somewhere, or of several: a number or
  /// a vector of height_m. Of molecules within 2e-3 of the ray equation's from the horizon to 6
  /// degrees over it.
  template <typename Density>
  [[nodiscard]] auto ColumnToSpace(const Density& density) const {
    auto sum = 0.0 * density(height_m_);
    const GaussRule& rule = GaussLegendre(64);
    VisitParts([&](double low_rad, double high_rad) {
      for (std::size_t i = 0; i < rule.node.size(); ++i) {
        // Nodes crowd where the ray is low and most of the air is.
        const double t = rule.node[i];
        const double elevation = low_rad + (high_rad - low_rad) * t * t;
        const double height_m = HeightWhere(elevation);
        sum += rule.weight[i] * 2.0 * t * (high_rad - low_rad) *
               MetresPerRadian(elevation, height_m) * density(height_m);
      }
    });
    return sum;
  }

  /// Angle at the planet's centre [rad] between the eye and where a ray that looks down meets the
  /// ground; nothing where it does not.
  [[nodiscard]] std::optional<double> AngleToGround() const;

 private:
  /// visit(low_rad, high_rad) for each rising part of the way to space: one, or two where the way
  /// goes through its lowest point.
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
  /// @param height_m  where it has the elevation.
  [[nodiscard]] double MetresPerRadian(double elevation_rad, double height_m) const;
  /// n r at a height, less the ray's invariant [m], without cancelling.
  [[nodiscard]] double OverInvariant(double height_m) const;

  BendingAir air_;
  double elevation_rad_, height_m_;
  double invariant_m_;  // b
};

/// Elevation [rad] of the ray that grazes the ground, at an eye; <= 0.
[[nodiscard]] double GrazingElevation(const BendingAir& air, double height_m);

/// Apparent minus true elevation [rad] of light that arrives under an apparent one, or, below the
/// horizon, of the light that grazes the ground. Within 0.1' of the ray equation.
[[nodiscard]] double RefractionSeenAt(const BendingAir& air, double apparent_elevation_rad,
                                      double height_m);

/// The apparent elevation [rad] of what stands at a true one; nothing behind the ground. About ten times
/// RefractionSeenAt, of some ten microseconds.
[[nodiscard]] std::optional<double> ApparentElevation(const BendingAir& air,
                                                      double true_elevation_rad, double height_m);

/// The air of almanacs at kHorizonWavelength_nm.
[[nodiscard]] BendingAir AlmanacAir(double earth_radius_m = kEarthMeanRadius_m);

/// Apparent minus true elevation [rad] of light that arrives at an observer `height_m` above sea
/// level under an apparent elevation, or, below the sea horizon, of the light that grazes it.
/// Within 1' of a ray traced through the U.S. Standard Atmosphere 1976 from the ground.
[[nodiscard]] double RefractionOfRay(double apparent_elevation_rad, double height_m,
                                     double earth_radius_m = kEarthMeanRadius_m);

/// The sea seen from above.
struct SeaHorizon {
  double dip_rad;             // depression of the horizon as it is seen, >= 0
  double true_elevation_rad;  // without air, of a point at infinity that is seen on the horizon
};

/// From `height_m` above the sea, from 0 to any distance; below 0 as from 0.
[[nodiscard]] SeaHorizon SeaHorizonFrom(double height_m,
                                        double earth_radius_m = kEarthMeanRadius_m);

/// Refraction [rad] of the *true* elevation, seen from `height_m`: as atmosphere::Refraction, for an
/// observer on a mountain, in an aeroplane or in orbit. Below the sea horizon, where only sunlit peaks
/// show where the sun is, the refraction on it fades to 0 within 3 degrees. Some ten microseconds a
/// call.
[[nodiscard]] double RefractionFromHeight(double true_elevation_rad, double height_m,
                                          double earth_radius_m = kEarthMeanRadius_m);
/// The same, in any air that bends gently.
[[nodiscard]] double RefractionFromHeight(const BendingAir& air, double true_elevation_rad,
                                          double height_m);

/// Returns the lift [rad] of a sun or moon of a *true* elevation with which its straight rays light the
/// air about as bent rays do: a fifth of the refraction seen from sea level, 7' from the horizon
/// down, whatever the height of the eye.
///
/// A bent ray that grazes the planet arrives higher than a straight one, but it stays low for longer,
/// and spreads: straight rays from where the sun is seen bring up to twice the light. Light scattered
/// once (450, 550, 650 nm) towards eyes from sea level to 3 km is then within 5 % (rms over directions)
/// of that of bent rays while the sun is up, 6 % down to -4 degrees and 17 % down to -8, where blue is
/// brighter and red, whose light comes through lower air, darker. Not in these figures is the sky up to
/// 10 degrees over the horizon opposite a sun that has set, where light scattered once ends.
/// tests/bench/bent_twilight.cpp compares shares.
[[nodiscard]] double LiftForAir(const BendingAir& air, double true_elevation_rad);

}  // namespace alpenglow::atmosphere
