// SPDX-License-Identifier: MIT
// What an eye sees through bent rays in the air of a medium: where light of each band comes from,
// how much of it the air lets through, and where rays meet the ground.
//
// The refractivity of a medium is as many times that of air of 15 C and 1013.25 hPa as its molecules
// scatter more than those of such air at 550 nm. It falls off with height as the medium says
// (Medium::refraction). That takes the molecules for air: those of carbon dioxide bend 1.7 times less
// than they would be taken to, which on Mars is 0.3' at the horizon.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/sun/bent_ray.h"

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

}  // namespace alpenglow::atmosphere
