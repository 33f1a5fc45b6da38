// SPDX-License-Identifier: MIT
// Directions stored in a sky view: rows of one zenith angle on both sides of the horizon.
//
// For an observer at altitude h the geometric horizon lies a dip below the horizontal. Angles from
// it, in radians, are
//
//   sky     e = a sinh(b v)        from the horizon up to the zenith, or, seen from outside the
//                                  air, up to where rays begin to miss it (there quadratic, see
//                                  the source); above, all is black
//   ground  e = a (cosh(b v) - 1)  from the horizon down to the nadir
//
// with v in [0, 1]. Columns are azimuths from the sun's, over half a turn. For a high observer, who
// sees the terminator cross the horizon, they are dense around it: with a bell
// L(x) = 1 / (1 + x^2),
//
//   x(p) ~ integral of 1 + A (L((p - p_t) / w) + its mirror images)
//
// so that x is symmetric about both ends, as the sky is.
//
// The sky is smooth in the lowest altitude of the ray; its a is the angle in which that altitude
// grows by one scale height of aerosol. The ground is smooth in the distance t to it, which is
// stationary at the horizon, t(0) - t ~ sqrt(e): hence the cosh; its a is the dip.
#pragma once

#include "atmosphere/medium/medium.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Concentration of columns: strength A, azimuth p_t and width w [rad].
struct AzimuthCrowd {
  double strength = 0.0, azimuth = 0.0, width = 1.0;
};

/// Angles [rad] from the horizon by coordinate: a sinh(b v), or a (cosh(b v) - 1).
struct HorizonScale {
  double a = 1.0, b = 1.0;
};

class SkyViewMap {
 public:
  SkyViewMap(const Medium& medium, double altitude_m, double mu_s);

  [[nodiscard]] double horizon_zenith_angle_rad() const { return horizon_; }
  /// Returns whether an upper edge of the air is visible: from above its top.
  [[nodiscard]] bool sees_upper_edge() const { return outside_; }
  /// Returns the zenith angle of the first direction above the horizon that meets no air; 0 from
  /// inside.
  [[nodiscard]] double upper_edge_zenith_angle_rad() const { return edge_; }

  [[nodiscard]] const HorizonScale& sky() const { return sky_; }
  [[nodiscard]] const HorizonScale& ground() const { return ground_; }

  /// Zenith angles of a coordinate in [0, 1], and the inverse.
  [[nodiscard]] double SkyZenithAngle(double v) const;
  [[nodiscard]] double GroundZenithAngle(double v) const;
  [[nodiscard]] double SkyCoordinate(double zenith_angle_rad) const;
  [[nodiscard]] double GroundCoordinate(double zenith_angle_rad) const;

  /// Azimuth from the sun's, in [0, pi], and its coordinate in [0, 1].
  [[nodiscard]] double AzimuthCoordinate(double azimuth_rad) const;
  [[nodiscard]] double Azimuth(double x) const;

 private:
  [[nodiscard]] double AzimuthIntegral(double azimuth_rad) const;

  double horizon_, edge_ = 0.0;
  bool outside_;
  HorizonScale sky_, ground_;
  AzimuthCrowd crowd_;
  double half_turn_integral_ = 0.0;
};

}  // namespace alpenglow::lut
