// SPDX-License-Identifier: MIT
/// @file
/// The light that air scatters and absorbs along rays: sky and aerial perspective.
#pragma once

#include <memory>
#include <span>

#include <alpenglow/atmosphere.h>
#include <alpenglow/batch.h>
#include <alpenglow/export.h>
#include <alpenglow/geometry.h>
#include <alpenglow/progress.h>
#include <alpenglow/spectrum.h>
#include <alpenglow/sun_and_moon.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// The effect of the air between two points: an object with radiance L at the far point is seen
/// with radiance transmittance * L + inscattered.
struct AirBetween {
  Spectrum transmittance;  ///< in [0, 1]
  Spectrum inscattered;    ///< light of all orders, per unit of solar irradiance [1/sr]
};

/// Stokes parameters of linear polarisation, per unit of solar irradiance [1/sr]. The degree of
/// polarisation is sqrt(Q^2 + U^2) over the radiance.
struct Polarisation {
  Spectrum q;  ///< positive for light that vibrates in the vertical plane of the view
  Spectrum u;  ///< positive for light that vibrates from the eye's lower left to its upper right
};

/// The light in an atmosphere under the sun, including all orders of scattering. Light is relative
/// to the irradiance that the sun has above the air at its mean distance: a sun that is nearer gives
/// more. Atmosphere::ColourOf converts it to colours, and Atmosphere::solar_irradiance_w_per_m2_nm to
/// W m^-2 sr^-1 nm^-1.
///
/// Immutable; copies share their memory. All functions may be called from several threads. Rays are
/// straight.
///
/// Each quantity has a function for one ray and one for a batch of rays, see batch.h. Functions throw
/// InputError for a direction of length 0, for coordinates that are not finite, for a sun out of
/// range, for points lower than half a radius of the planet below altitude 0 or higher than 1e12 m,
/// and for an argument of a batch whose number of values is neither 1 nor that of the rays. The sky
/// of a point below altitude 0 is that of altitude 0.
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
                                  const Sunlight& sun) const;
  /// Computes Radiance() of many rays.
  void Radiance(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& views,
                const OneOrMany<Sunlight>& suns, std::span<float> result) const;

  /// Returns the polarisation of Radiance(). It is 0 in air whose light is not polarised. A vertical
  /// view counts as tilted towards the sun.
  [[nodiscard]] Polarisation PolarisationOf(const LocalPoint& eye, const Direction& view,
                                            const Sunlight& sun) const;
  /// Computes PolarisationOf() many rays.
  void PolarisationOf(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& views,
                      const OneOrMany<Sunlight>& suns, std::span<float> q,
                      std::span<float> u) const;

  /// Returns the radiance of the disk of the sun in a direction, seen through the air, per unit of
  /// solar irradiance [1/sr]; 0 beside it and behind the ground. The limb is darker than the centre.
  [[nodiscard]] Spectrum DiskRadiance(const LocalPoint& eye, const Direction& view,
                                      const Sunlight& sun) const;
  /// Computes DiskRadiance() of many rays.
  void DiskRadiance(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& views,
                    const OneOrMany<Sunlight>& suns, std::span<float> result) const;

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
                                   const Sunlight& sun) const;
  /// Computes Between() of many lines.
  void Between(const OneOrMany<LocalPoint>& eyes, const OneOrMany<LocalPoint>& objects,
               const OneOrMany<Sunlight>& suns, std::span<float> transmittance,
               std::span<float> inscattered) const;

  /// Returns the irradiance of the sun on the horizontal plane at a point, per unit of its irradiance
  /// above the air [1], of the part of the disk above the horizon of altitude 0.
  [[nodiscard]] Spectrum SunIrradiance(const LocalPoint& point, const Sunlight& sun) const;
  /// Returns the irradiance of the sun on a plane with a normal, such as `sun.to_sun` for the one that
  /// faces it.
  [[nodiscard]] Spectrum SunIrradiance(const LocalPoint& point, const Sunlight& sun,
                                       const Direction& normal) const;
  /// Computes SunIrradiance() of many planes.
  void SunIrradiance(const OneOrMany<LocalPoint>& points, const OneOrMany<Sunlight>& suns,
                     const OneOrMany<Direction>& normals, std::span<float> result) const;

  /// Returns the irradiance of the sky on the horizontal plane at a point, per unit of solar
  /// irradiance [1]. Error: within 2 % of a path tracer in the air of the earth (asserted by
  /// multiple_scattering_test).
  [[nodiscard]] Spectrum SkyIrradiance(const LocalPoint& point, const Sunlight& sun) const;
  /// Returns the irradiance of the sky, and of the ground of the atmosphere, on a plane with a normal.
  /// Error: within 4 % of the irradiance of the horizontal plane in the air of the earth (asserted by
  /// sky_light_api_test).
  [[nodiscard]] Spectrum SkyIrradiance(const LocalPoint& point, const Sunlight& sun,
                                       const Direction& normal) const;
  /// Computes SkyIrradiance() of many planes.
  void SkyIrradiance(const OneOrMany<LocalPoint>& points, const OneOrMany<Sunlight>& suns,
                     const OneOrMany<Direction>& normals, std::span<float> result) const;

 private:
  friend struct SkyParts;  // of the sources of the library
  struct State;
  explicit Sky(std::shared_ptr<const State> state);

  std::shared_ptr<const State> state_;
};

}  // namespace alpenglow
