// SPDX-License-Identifier: MIT
// What an eye sees through bent rays in the air of a medium: where light of each band comes from,
// how much of it the air lets through, and where rays meet the ground.
//
// The refractivity of a medium is as many times that of air of 15 C and 1013.25 hPa as its molecules
// scatter more than those of such air at 550 nm. It falls off with height as the medium says
// (Medium::refraction). That takes the molecules for air: those of carbon dioxide bend 1.7 times less
// than they would be taken to, which on Mars is 0.3' at the horizon.
//
// Where air shows land and the edge of a bare planet, in closed form: for shaders, which work it out
// vertex by vertex (land_lift.glsl), and what they read.
//
// A planet that bends rays looks as one of another radius with straight rays does: the one whose
// horizon is where the bent rays that graze the ground have it,
//
//   R' / (R' + h) = cos(dip).
//
// Sunlight that falls on ground, fog and volumes along bent rays, against that of straight ones.
//
// Where a disk is seen at an elevation e, a surface across its beams gets
//
//   E = E_0 T(h, e) F(h, e),  F = exp(-more optical depth) (de / de_true) cos(e) / cos(e_true)
//
// T of the straight ray from height h along e. The bent ray stays lower, so it passes more air, and
// refraction, which grows downwards, makes the disk as much flatter as it spreads its light. Radiance
// over the square of the refractive index stays as it is along a ray (Born and Wolf 1999, Principles
// of Optics, 3.1.2), and that square is 1 within 6e-4.
//
// F lies in a table over sqrt(h) and over log(1 + (sin e - sin of the horizon) / s). Elevations are
// those at which the disk's middle is seen at the place itself. Ozone is left out, as by
// BentView::MoreOpticalDepth.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/refraction.h"

namespace alpenglow::atmosphere {

[[nodiscard]] BendingAir BendingAirOf(const Medium& medium, double wavelength_nm);

/// By which sun, moon and stars are lifted: at kHorizonWavelength_nm, without any refractivity
/// where it would not bend gently.
[[nodiscard]] BendingAir GentleAirOf(const Medium& medium);

/// A ray that ends on the ground.
struct BentGroundRay {
  double angle_rad;      // at the planet's centre, between the eye and where it ends
  double elevation_rad;  // > 0, of the eye's line of sight there, seen from the ground
};

/// Changes that air makes to light from outside, seen in a direction, at kHorizonWavelength_nm.
struct BentLight {
  double refraction_rad = 0.0;
  double per_refractivity_rad = 0.0;          // its derivative with respect to N
  double molecules_m = 0.0, aerosol_m = 0.0;  // columns to space, more than if straight; 0 from 15
                                              // degrees up
};

/// Some hundred microseconds. @param air  GentleAirOf(medium); elevation_rad: from the horizon up.
[[nodiscard]] BentLight BentLightOf(const Medium& medium, const BendingAir& air,
                                    double elevation_rad, double height_m);

/// Tables for an eye at one height. Immutable. All elevations are apparent unless they are called
/// true. Below the horizon the sky is as on it.
class BentView {
 public:
  /// @param height_m  over the sphere; below 0 as 0. Nothing bends where BendingAirOf(medium) does
  ///     not bend gently.
  BentView(const Medium& medium, double height_m);

  /// Of the horizon of the ground [rad], <= 0.
  [[nodiscard]] double horizon_rad() const { return horizon_rad_; }
  [[nodiscard]] const BendingAir& air() const { return air_; }
  /// Returns the size of the tables.
  [[nodiscard]] std::size_t bytes() const {
    return sky_.size() * sizeof(Node) + bending_.size() * sizeof(double);
  }

  /// True elevation [rad] of what is seen in a band, within 0.1' of the ray equation.
  [[nodiscard]] double TrueElevation(double elevation_rad, std::size_t band) const;
  /// The same at kHorizonWavelength_nm.
  [[nodiscard]] double TrueElevation(double elevation_rad) const;
  /// The apparent elevation [rad] of what stands at a true one, at kHorizonWavelength_nm; the
  /// horizon's for what it hides.
  [[nodiscard]] double ApparentElevationOf(double true_elevation_rad) const;
  /// The same, but what the horizon hides is as much below it as below what is seen on it.
  [[nodiscard]] double LiftedElevationOf(double true_elevation_rad) const;

  /// Optical depth of molecules and aerosol on the way to space, in a band, less that of a straight
  /// ray of the same apparent elevation; 0 from 15 degrees up, where it is 1e-3 of the depth of the
  /// air. Ozone is left out: it is so high up that at the horizon its depth of up to 0.5 grows by
  /// 4 %.
  [[nodiscard]] double MoreOpticalDepth(double elevation_rad, std::size_t band) const;

  /// Where a ray ends on the ground; nothing for those of the sky.
  [[nodiscard]] std::optional<BentGroundRay> ToGround(double elevation_rad) const;

 private:
  using Node = BentLight;
  [[nodiscard]] Node At(double elevation_rad) const;

  BendingAir air_;
  double height_m_;
  double horizon_rad_;
  double sky_scale_rad_, ground_scale_rad_;
  std::vector<double> more_refractivity_;                // of each band than air_ has
  std::vector<double> molecules_per_m_, aerosol_per_m_;  // extinction at altitude 0
  std::vector<Node> sky_;        // over log(1 + (elevation - horizon) / sky_scale_rad_)
  std::vector<double> bending_;  // over log(1 + elevation at the ground / ground_scale_rad_)
};

/// Bending of rays by the air as an eye at one height sees it; kilometres.
struct LandBend {
  double radius_km, look_radius_km;    // of the planet, and of the one that it looks as
  double top_km;                       // rays are straight above
  double usual_per_km;                 // curvature of most rays from this eye
  std::array<double, 3> slope_per_km;  // curvature of level rays at the ground, layer by layer
  std::array<double, 3> fall_per_km;   // with height

  /// Curvature of level rays at the ground.
  [[nodiscard]] double MostCurvature() const {
    return slope_per_km[0] + slope_per_km[1] + slope_per_km[2];
  }
};

/// @param air  that bends gently. @param height_m  of the eye; below 0 as 0.
[[nodiscard]] LandBend LandBendOf(const BendingAir& air, double height_m);

/// By how much a place up to 9 km high is lifted [rad] that is not behind the ground, before the horizon
/// or behind it: within 0.3' of the ray equation for eyes up to 16 km, within 0.5' for higher ones.
/// @param distance_m  straight from the eye.
[[nodiscard]] double LiftOfLand(const LandBend& bend, double eye_m, double place_m,
                                double distance_m);

/// Returns the largest lift [rad] of anything that an eye sees of a planet: of its horizon, or of land at its radius
/// as far away as the farthest.
[[nodiscard]] double MostLiftOfPlanet(const LandBend& bend, double eye_m, double farthest_land_m);

/// For one medium, at any height. Immutable.
class BentBeam {
 public:
  /// The beam is that of straight rays in a medium whose air does not bend gently (GentleAirOf of bent_view.h).
  explicit BentBeam(const Medium& medium);

  /// Returns F, by band. Under the horizon it is that on it, above the air that at its top.
  /// Light of the beam is within 2 % of an integration along bent rays from 0.1 degrees up at 0, 3
  /// and 8 km, and within 3 % from 0.3 degrees over the horizon between the table's heights
  /// (tests/atmosphere/ray/bent_beam_test.cpp).
  [[nodiscard]] Bands<float> OverStraight(double altitude_m, double mu) const;

  /// Returns the irradiance across the beams of a sun whose irradiance above the air is 1.
  /// @param air  of the medium. @param mu  zenith cosine of where the disk is seen, not behind the
  ///     planet.
  [[nodiscard]] Bands<float> Left(const AirIntegrator<float>& air, double altitude_m,
                                  double mu) const;

 private:
  struct Node {
    glm::dvec2 more_m;  // columns of molecules and aerosol, more than if straight
    double log_spread;
  };
  struct Row {
    double horizon_mu;
    std::vector<Node> nodes;
  };
  [[nodiscard]] static Row RowAt(const AirIntegrator<double>& straight, const BendingAir& air,
                                 double height_m);
  [[nodiscard]] Node At(double altitude_m, double mu) const;

  std::size_t bands_;
  double top_m_;
  std::vector<double> molecules_per_m_, aerosol_per_m_;  // extinction at altitude 0
  std::vector<Row> rows_;                                // none: nothing bends
};

}  // namespace alpenglow::atmosphere
