// SPDX-License-Identifier: MIT
// Sun and moon together, as one place sees them at one instant, and eclipses of the sun: their
// times at a place, and the light that is not covered by the moon. SkyBodies is computed once, and
// passed to everything that depends on place and time.
//
// In an eclipse sun and moon are disks; lengths on the sky are in radii of the sun. At rho radii
// from the sun's centre the moon, of radius p at a distance z, covers the fraction a / pi of a
// circle. For a disk with brightness f(rho) (LimbDarkening, sun.h) the uncovered fraction of the
// light is
//
//   1 / pi integral of 2 rho f(rho) (pi - a(rho)),     cos a = (z^2 + rho^2 - p^2) / (2 z rho)
//
// Mountains and valleys of the moon's limb, up to two arcseconds high, are neglected; Baily's
// beads, some seconds around second and third contact, are therefore missing.
#pragma once

#include <optional>
#include <string_view>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/refraction/refraction.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"

namespace alpenglow::atmosphere {

/// The moon in front of the sun, as two disks.
struct EclipsedDisk {
  double moon_radius;  // p, > 0
  double separation;   // distance of the centres z, >= 0

  [[nodiscard]] bool IsCovered() const { return separation < 1.0 + moon_radius; }  // in part
  [[nodiscard]] bool IsTotal() const { return separation <= moon_radius - 1.0; }
  /// Returns the covered fraction of the sun's diameter through the moon's centre, called magnitude
  /// in almanacs. 0 outside of an eclipse, (1 + p) / 2 if the centres coincide.
  [[nodiscard]] double Magnitude() const;
  /// Returns the covered fraction of the sun's disk, [0, 1], called obscuration in almanacs.
  [[nodiscard]] double CoveredArea() const;
};

/// Returns the disks seen from one place at one time, without refraction, which flattens both disks
/// equally. Radii are kSunRadius_m and kMoonRadius_m.
[[nodiscard]] EclipsedDisk EclipsedDiskOf(const SunInSky& sun, const MoonPosition& moon);

/// Returns the fraction of the sun's light at a wavelength that is not covered by the moon, [0, 1]:
/// exactly 1 if nothing and exactly 0 if everything is covered. Error below 1e-8, and below 1e-4 of
/// the uncovered light.
[[nodiscard]] double UncoveredLight(const EclipsedDisk& disk, double wavelength_nm);

/// An eclipse of the sun at a place, whether or not the sun is up there.
struct SolarEclipse {
  struct Moment {
    UtcTime instant;
    EclipsedDisk disk;
    double limb_over_horizon_rad;  // of the sun's upper limb, refracted, over the sea horizon

    [[nodiscard]] bool IsSeen() const { return limb_over_horizon_rad >= 0.0; }
  };
  /// Period in which the moon is entirely within the sun's disk, or covers all of it.
  struct Inner {
    Moment second_contact, third_contact;
  };
  Moment first_contact, maximum, last_contact;
  std::optional<Inner> inner;
};

/// Returns the state of sun and moon at one instant.
[[nodiscard]] SolarEclipse::Moment EclipseAt(const Place& place, const UtcTime& instant);

/// Returns the eclipse at a place whose maximum, the least distance of the centres, is within a
/// number of seconds from an instant. Contacts are defined as in almanacs: the sun's radius is
/// 959.63 arcseconds at 1 au (Auwers), the moon's radius is 0.2725076 equatorial radii of the earth
/// for the outer contacts (IAU 1982, over its mountains) and 0.272281 for the inner ones (through
/// its valleys; both as in Espenak and Meeus 2006, NASA/TP-2006-214141). Within 5 s of NASA's
/// Besselian elements for 2026 August 12 in Spain. Outside 1960-2026 an error of one second in
/// delta-T shifts them by up to a second.
/// @param within_s  > 0, 2 days at most.
[[nodiscard]] std::optional<SolarEclipse> FindSolarEclipse(const Place& place, const UtcTime& from,
                                                           double within_s);

/// Events of an eclipse of the sun.
enum class EclipseEvent { kFirstContact, kSecondContact, kMaximum, kThirdContact, kLastContact };

/// Returns the event named "first-contact", "second-contact", "eclipse-maximum", "third-contact" or
/// "last-contact"; std::nullopt for another name.
[[nodiscard]] std::optional<EclipseEvent> EclipseEventFromName(std::string_view name);

/// Returns the instant of an event; std::nullopt for the inner contacts of a partial eclipse.
[[nodiscard]] std::optional<UtcTime> InstantOf(EclipseEvent event, const SolarEclipse& eclipse);

/// Returns the sun with refraction by any air that bends rays gently (ApparentSunAt).
/// @param sun  without refraction. @param height_m  of the eye above the ellipsoid.
[[nodiscard]] SunInSky Refracted(const SunInSky& sun, double height_m, const BendingAir& air);
/// Returns the moon with refraction (ApparentMoonAt).
[[nodiscard]] MoonPosition Refracted(const MoonPosition& moon, double height_m,
                                     const BendingAir& air);

/// Sun and moon without refraction.
struct SkyBodies {
  Place place;
  UtcTime instant;
  SunInSky sun;
  MoonPosition moon;

  /// Returns the moon in front of the sun.
  [[nodiscard]] EclipsedDisk Eclipse() const { return EclipsedDiskOf(sun, moon); }
  /// Returns the fraction of the sun's light at 550 nm that the moon covers, [0, 1]; exactly 1 in
  /// totality.
  [[nodiscard]] double CoveredLight() const;
  [[nodiscard]] SunInSky ApparentSun(const BendingAir& air) const {
    return Refracted(sun, place.height_m, air);
  }
  /// Returns the disk of the moon with refraction, in the frame east, north, up of the place.
  [[nodiscard]] MoonDisk ApparentMoonDisk(const BendingAir& air) const;
};

[[nodiscard]] SkyBodies SkyBodiesAt(const Place& place, const UtcTime& instant);

}  // namespace alpenglow::atmosphere
