// SPDX-License-Identifier: MIT
// Refraction of light from outside the air for one observer, for many directions. The bending of a
// rising ray is, with the symbols of refraction.h,
//
//   bending = b integral of (-n' / n) / sqrt(q^2 - b^2) dh,   q^2 - b^2 = (q - b) (q + b)
//
// over the heights above the observer. With h = h_0 + x^2 the integrand is smooth in x, also where
// the ray is horizontal, and at fixed heights only b differs from one direction to another: air and
// heights are tabulated once. The bending of a ray that descends first is twice that from its
// lowest point to space, less that of the rising ray from the observer.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere {

/// Returns whether all values of two airs are the same.
[[nodiscard]] bool IsSame(const BendingAir& a, const BendingAir& b);

/// Rising rays from one height: the bending of light from space that arrives from the horizontal or
/// from above it.
class RisingRays {
 public:
  RisingRays(const BendingAir& air, double height_m);

  struct BendingAndSlope {
    double bending_rad, per_rad;
  };
  /// Returns the bending and its derivative with respect to the elevation, from 0 to pi / 2.
  [[nodiscard]] BendingAndSlope At(double elevation_rad) const;

 private:
  static constexpr std::size_t kNodes = 64;
  double here_m_;                             // q at the height
  std::array<double, kNodes> strength_{};     // -n' / n times the weight of the node [1]
  std::array<double, kNodes> over_here_m_{};  // q at the node minus q at the height
};

/// Tables of one air for an observer at one height. Immutable. A table takes some microseconds; a
/// direction from the horizontal up takes a fifth of a microsecond, one below it some microseconds.
class ObserverRefraction {
 public:
  /// @param air  air that bends rays gently. @param height_m  negative values are treated as 0.
  ObserverRefraction(const BendingAir& air, double height_m);

  [[nodiscard]] bool IsFor(const BendingAir& air, double height_m) const;

  /// Returns the elevation [rad] of the ray that grazes the ground; <= 0.
  [[nodiscard]] double horizon_rad() const { return horizon_rad_; }
  /// Returns the refraction [rad] of that ray.
  [[nodiscard]] double on_horizon_rad() const { return on_horizon_rad_; }

  /// Returns RefractionSeenAt. Error: 2e-6 of the refraction at the horizon from sea level, 0.004
  /// arcseconds on the earth, for any air that bends rays gently and at any height (asserted by
  /// refraction_test, against the integral over the elevation by RefractedRay).
  [[nodiscard]] double SeenAt(double apparent_elevation_rad) const;
  /// Returns the apparent elevation [rad] of an object at a true elevation, to 1e-10 rad;
  /// std::nullopt if it is behind the ground. It takes a microsecond above the horizontal.
  [[nodiscard]] std::optional<double> ApparentElevationOf(double true_elevation_rad) const;
  /// Returns RefractionFromHeight of refraction.h.
  [[nodiscard]] double AtTrue(double true_elevation_rad) const;

 private:
  [[nodiscard]] double Descending(double elevation_rad) const;
  [[nodiscard]] double RisingElevationOf(double true_elevation_rad) const;

  BendingAir air_;
  double height_m_, horizon_rad_, on_horizon_rad_;
  RisingRays rising_;
};

/// Returns a table for this thread: the one of an earlier call if air and height are the same.
[[nodiscard]] const ObserverRefraction& RefractionOfObserver(const BendingAir& air,
                                                             double height_m);

}  // namespace alpenglow::atmosphere
