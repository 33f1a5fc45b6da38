// SPDX-License-Identifier: MIT
/// @file
/// The light that air scatters and absorbs along rays: sky and aerial perspective.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <alpenglow/atmosphere.h>
#include <alpenglow/export.h>
#include <alpenglow/geometry.h>
#include <alpenglow/progress.h>
#include <alpenglow/spectrum.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// The effect of the air between two points: an object with radiance L at the far point is seen
/// with radiance transmittance * L + inscattered.
struct AirBetween {
  Spectrum transmittance;  ///< in [0, 1]
  Spectrum inscattered;    ///< light of all orders, per unit of solar irradiance [1/sr]
};

/// The light in an atmosphere under the sun, including all orders of scattering. Light is relative
/// to the irradiance of the sun above the air; Atmosphere::ColourOf converts it to colours, and
/// Atmosphere::solar_irradiance_w_per_m2_nm to W m^-2 sr^-1 nm^-1.
///
/// Immutable; copies share their memory. All functions may be called from several threads. Rays are
/// straight: directions to the sun should be those of SunInSky::ToSunForAir.
///
/// Functions throw InputError for a direction of length 0, for coordinates that are not finite, and
/// for points lower than half a radius of the planet below altitude 0 or higher than 1e12 m. The
/// sky of a point below altitude 0 is that of altitude 0.
class Sky {
 public:
  /// Solves multiple scattering, on all processors. This is slow compared with all other functions:
  /// make one sky per atmosphere. Throws Cancelled if `progress` ends the work.
  /// @param atmosphere  air of the sky.
  /// @param progress    receives an estimate of the fraction that is done, as the number of orders of
  ///   scattering that the air needs is not known before; may be empty.
  explicit Sky(const Atmosphere& atmosphere, const ProgressFunction& progress = {});

  /// Returns the atmosphere.
  [[nodiscard]] const Atmosphere& atmosphere() const;

  /// Returns the radiance of the air along a ray to space or to the ground, per unit of solar
  /// irradiance [1/sr]. It includes neither the disk of the sun nor the light that the ground at
  /// the end of the ray reflects.
  ///
  /// Error: 0.25 % (rms) by day and 1 % in civil twilight in clear air, against a path tracer
  /// (asserted by multiple_scattering_test).
  [[nodiscard]] Spectrum Radiance(const LocalPoint& eye, const Direction& view,
                                  const Direction& to_sun) const;

  /// Returns the aerial perspective: the effect of the air between the eye and an opaque object.
  /// Both may lie below altitude 0, and the line between them may dip below it: air continues there
  /// with the density of altitude 0, and the transmittance is the same in both directions. Only a
  /// line that leads deeper than 12 km (on small planets a fiftieth of the radius) stops at the
  /// ground.
  ///
  /// Error of the transmittance: 1e-4 of its optical depth, or 1e-6. Light scattered once has a
  /// relative error below 0.1 % (both asserted by sky_api_test between points up to 100 km apart);
  /// light of higher orders has that of Radiance().
  [[nodiscard]] AirBetween Between(const LocalPoint& eye, const LocalPoint& object,
                                   const Direction& to_sun) const;

  /// Returns Radiance() for many directions, computed on all processors.
  [[nodiscard]] std::vector<Spectrum> Radiance(const LocalPoint& eye,
                                               std::span<const Direction> views,
                                               const Direction& to_sun) const;
  /// Returns Between() for many objects, computed on all processors.
  [[nodiscard]] std::vector<AirBetween> Between(const LocalPoint& eye,
                                                std::span<const LocalPoint> objects,
                                                const Direction& to_sun) const;

  /// Computes Between() for many objects into memory of the caller. Throws InputError unless both
  /// spans have the same length.
  void Between(const LocalPoint& eye, std::span<const LocalPoint> objects, const Direction& to_sun,
               std::span<AirBetween> result) const;

  /// Returns the irradiance of the sun on a horizontal plane, per unit of its irradiance above the
  /// air [1]; 0 if the sun is below the horizontal plane.
  [[nodiscard]] Spectrum SunIrradiance(const LocalPoint& point, const Direction& to_sun) const;
  /// Returns the irradiance of the sky on a horizontal plane, per unit of solar irradiance [1].
  /// Error: within 2 % of a path tracer in the air of the earth (asserted by
  /// multiple_scattering_test).
  [[nodiscard]] Spectrum SkyIrradiance(const LocalPoint& point, const Direction& to_sun) const;

 private:
  friend struct SkyParts;  // of the sources of the library
  struct State;
  explicit Sky(std::shared_ptr<const State> state);

  std::shared_ptr<const State> state_;
};

}  // namespace alpenglow
