// SPDX-License-Identifier: MIT
// Atmospheric refraction for an observer in the air of a medium: the true direction and the
// transmittance of light in each band, the ground points of rays, the lift of land, and the
// sunlight of refracted beams.
//
// The refractivity of a medium is that of air of 15 C and 1013.25 hPa, times the ratio of its
// molecular scattering to that of such air at 550 nm. Its height profile is given by the medium
// (Medium::refraction). This treats the molecules as air: the true refraction by carbon dioxide is
// 1.7 times smaller, which on Mars is 0.3' at the horizon.
//
// The lift of land and of the edge of a bare planet have closed forms, for shaders that evaluate
// them per vertex (land_lift.glsl); LandBend contains their parameters.
//
// A planet with refraction looks like a planet of another radius with straight rays: the radius R'
// whose horizon is the horizon of the refracted rays that graze the ground,
//
//   R' / (R' + h) = cos(dip).
//
// RefractedBeam gives sunlight on ground and media along refracted rays, relative to
// straight rays. If a disk is seen at an elevation e, a surface perpendicular to its beams receives
//
//   E = E_0 T(h, e) F(h, e),  F = exp(-more optical depth) (de / de_true) cos(e) / cos(e_true)
//
// with T of the straight ray from height h along e. The refracted ray stays lower, so it passes
// more air. Refraction increases downwards: it flattens the disk and spreads its light by the same
// factor. Radiance over the square of the refractive index is constant along a ray (Born and Wolf
// 1999, Principles of Optics, 3.1.2), and that square is 1 within 6e-4.
//
// F is tabulated over sqrt(h) and over log(1 + (sin e - sin of the horizon) / s). Elevations are
// apparent elevations of the disk's centre at the receiver. Ozone is neglected, as in
// RefractedView::MoreOpticalDepth.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/refraction/land_lift.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::atmosphere {

[[nodiscard]] BendingAir BendingAirOf(const Medium& medium, double wavelength_nm);

/// Returns the air that lifts sun, moon and stars: at kHorizonWavelength_nm, with refractivity 0 if
/// the medium would not bend rays gently.
[[nodiscard]] BendingAir GentleAirOf(const Medium& medium);
/// @param planet_radius_m  the radius at a place (OsculatingRadius), instead of the medium's.
[[nodiscard]] BendingAir GentleAirOf(const Medium& medium, double planet_radius_m);

/// A ray that ends on the ground.
struct RefractedGroundRay {
  double angle_rad;      // at the planet's centre, between the observer and the end of the ray
  double elevation_rad;  // > 0, elevation of the observer's line of sight there, seen from the
                         // ground
};

/// Changes by the air to light from outside, seen in a direction, at kHorizonWavelength_nm.
struct RefractedLight {
  double refraction_rad = 0.0;
  double per_refractivity_rad = 0.0;          // its derivative with respect to N
  double molecules_m = 0.0, aerosol_m = 0.0;  // columns in excess of straight rays; 0 from 15 deg
};

/// Computes the changes, in some hundred microseconds.
/// @param air  GentleAirOf(medium).
/// @param elevation_rad  from the horizon up.
[[nodiscard]] RefractedLight RefractedLightOf(const Medium& medium, const BendingAir& air,
                                              double elevation_rad, double height_m);

/// Tables for an observer at one height. Immutable. All elevations are apparent unless they are
/// called true. Directions below the horizon have the values of the sky at the horizon.
class RefractedView {
 public:
  /// There is no refraction if BendingAirOf(medium) does not bend rays gently.
  /// @param height_m  over the sphere; negative values are treated as 0.
  RefractedView(const Medium& medium, double height_m);

  /// Returns the elevation of the ground's horizon [rad], <= 0.
  [[nodiscard]] double horizon_rad() const { return horizon_rad_; }
  [[nodiscard]] const BendingAir& air() const { return air_; }
  /// Returns the size of the tables.
  [[nodiscard]] std::size_t bytes() const {
    return sky_.size() * sizeof(Node) + bending_.size() * sizeof(double);
  }

  /// Returns the true elevation [rad] of an object seen in a band, within 0.1' of the ray equation.
  [[nodiscard]] double TrueElevation(double elevation_rad, std::size_t band) const;
  /// Returns the true elevation at kHorizonWavelength_nm.
  [[nodiscard]] double TrueElevation(double elevation_rad) const;
  /// Returns the apparent elevation [rad] of an object at a true elevation, at
  /// kHorizonWavelength_nm; the elevation of the horizon for an object hidden by it.
  [[nodiscard]] double ApparentElevationOf(double true_elevation_rad) const;
  /// Returns the apparent elevation like ApparentElevationOf, except for a hidden object: it is as
  /// far below the horizon as its true elevation is below the true elevation of the horizon.
  [[nodiscard]] double LiftedElevationOf(double true_elevation_rad) const;

  /// Returns the optical depth of molecules and aerosol to space, in a band, minus that of a
  /// straight ray of the same apparent elevation; 0 from 15 degrees up, where it is 1e-3 of the
  /// depth of the air. Ozone is neglected: it is so high that at the horizon its depth of up to 0.5
  /// increases by only 4 %.
  [[nodiscard]] double MoreOpticalDepth(double elevation_rad, std::size_t band) const;

  /// Returns the end of a ray on the ground; std::nullopt for rays to the sky.
  [[nodiscard]] std::optional<RefractedGroundRay> ToGround(double elevation_rad) const;

 private:
  using Node = RefractedLight;
  [[nodiscard]] Node At(double elevation_rad) const;

  BendingAir air_;
  double height_m_;
  double horizon_rad_;
  double sky_scale_rad_, ground_scale_rad_;
  std::vector<double> more_refractivity_;                // of each band, relative to air_
  std::vector<double> molecules_per_m_, aerosol_per_m_;  // extinction at altitude 0
  std::vector<Node> sky_;        // over log(1 + (elevation - horizon) / sky_scale_rad_)
  std::vector<double> bending_;  // over log(1 + elevation at the ground / ground_scale_rad_)
};

/// Bending of rays by the air for an observer at one height; kilometres.
struct LandBend {
  double radius_km, look_radius_km;    // radius of the planet, and apparent radius
  double top_km;                       // rays are straight above this altitude
  double usual_per_km;                 // curvature of most rays from this observer
  std::array<double, 3> slope_per_km;  // curvature of level rays at the ground, layer by layer
  std::array<double, 3> fall_per_km;   // decrease with height

  /// Returns the curvature of level rays at the ground.
  [[nodiscard]] double MostCurvature() const {
    return slope_per_km[0] + slope_per_km[1] + slope_per_km[2];
  }
};

/// @param air  air that bends rays gently. @param height_m  height of the observer; negative values
/// are treated as 0.
[[nodiscard]] LandBend LandBendOf(const BendingAir& air, double height_m);

/// Returns the lift [rad] of a place up to 9 km high that is not hidden by the ground, in front of
/// or behind the horizon: within 0.3' of the ray equation for observers up to 16 km, within 0.5'
/// for higher ones.
/// @param distance_m  straight distance from the observer.
[[nodiscard]] double LiftOfLand(const LandBend& bend, double eye_m, double place_m,
                                double distance_m);

/// Returns the largest lift [rad] of anything on a planet that an observer sees: its horizon, or
/// land at its radius at the farthest distance.
[[nodiscard]] double MostLiftOfPlanet(const LandBend& bend, double eye_m, double farthest_land_m);

/// Refracted sunlight in one medium, at any height. Immutable.
class RefractedBeam {
 public:
  /// The beam is that of straight rays if the air of the medium does not bend rays gently
  /// (GentleAirOf of refracted_view.h).
  explicit RefractedBeam(const Medium& medium);

  /// Returns F, by band. Below the horizon it is the value at the horizon, above the air the value
  /// at its top. Irradiance of the beam is within 2 % of an integration along refracted rays from
  /// 0.1 degrees up at 0, 3 and 8 km, and within 3 % from 0.3 degrees over the horizon between the
  /// table's heights (tests/atmosphere/refraction/refracted_rays_test.cpp).
  [[nodiscard]] Spectrum OverStraight(double altitude_m, double mu) const;

  /// Returns the irradiance perpendicular to the beams of a sun with unit irradiance above the air.
  /// @param air  air of the medium.
  /// @param mu  apparent zenith cosine of the disk, not hidden by the planet.
  [[nodiscard]] Spectrum Left(const SingleScattering<float>& air, double altitude_m,
                              double mu) const;

 private:
  struct Node {
    glm::dvec2 more_m;  // columns of molecules and aerosol, in addition to those of a straight ray
    double log_spread;
  };
  struct Row {
    double horizon_mu;
    std::vector<Node> nodes;
  };
  [[nodiscard]] static Row RowAt(const SingleScattering<double>& straight, const BendingAir& air,
                                 double height_m);
  [[nodiscard]] Node At(double altitude_m, double mu) const;

  std::size_t bands_;
  double top_m_;
  std::vector<double> molecules_per_m_, aerosol_per_m_;  // extinction at altitude 0
  std::vector<Row> rows_;                                // empty: no refraction
};

}  // namespace alpenglow::atmosphere
