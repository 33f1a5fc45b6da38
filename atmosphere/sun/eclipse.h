// SPDX-License-Identifier: MIT
// Eclipses of the sun: when they are at a place, and what the moon leaves of the light.
//
// Sun and moon are disks; lengths on the sky are in radii of the sun's. At rho radii from its centre
// the moon, of radius p at a distance z, covers the part a / pi of a circle, and of the light of a
// disk that is f(rho) bright (LimbDarkening, sun.h) passes
//
//   1 / pi integral of 2 rho f(rho) (pi - a(rho)),     cos a = (z^2 + rho^2 - p^2) / (2 z rho)
//
// Mountains and valleys of the moon's rim, up to two arcseconds of it, are left out: Baily's beads,
// and with them some seconds around second and third contact.
#pragma once

#include <optional>
#include <string_view>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/moon.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/sun/time.h"

namespace alpenglow::atmosphere {

/// The moon before the sun.
struct EclipsedDisk {
  double moon_radius;  // p, > 0
  double separation;   // z, of the centres, >= 0

  [[nodiscard]] bool IsCovered() const { return separation < 1.0 + moon_radius; }  // some of it
  [[nodiscard]] bool IsTotal() const { return separation <= moon_radius - 1.0; }
  /// Share of the sun's diameter that is covered, through the moon's centre; what almanacs call
  /// magnitude. 0 outside of an eclipse, (1 + p) / 2 where the centres meet.
  [[nodiscard]] double Magnitude() const;
  /// Share of the sun's disk that is covered, [0, 1]; what almanacs call obscuration.
  [[nodiscard]] double CoveredArea() const;
};

/// Seen from one place at one time, without refraction, which flattens both disks alike. Radii are
/// kSunRadius_m and kMoonRadius_m.
[[nodiscard]] EclipsedDisk EclipsedDiskOf(const SunPosition& sun, const MoonPosition& moon);

/// Of the sun's light in a wavelength the share that passes beside the moon, [0, 1]: exactly 1 and
/// 0 where none and all of it is covered. Error below 1e-8, of what is left below 1e-4.
[[nodiscard]] double UncoveredLight(const EclipsedDisk& disk, double wavelength_nm);

/// An eclipse of the sun at a place, whether or not the sun is up there.
struct SolarEclipse {
  struct Moment {
    UtcInstant instant;
    EclipsedDisk disk;
    double limb_over_horizon_rad;  // of the sun's upper limb, refracted, over the sea's horizon

    [[nodiscard]] bool IsSeen() const { return limb_over_horizon_rad >= 0.0; }
  };
  /// While the moon stands wholly within the sun's disk, or before all of it.
  struct Inner {
    Moment second_contact, third_contact;
  };
  Moment first_contact, maximum, last_contact;
  std::optional<Inner> inner;
};

/// One moment of the two bodies.
[[nodiscard]] SolarEclipse::Moment EclipseAt(const GeodeticPosition& place,
                                             const UtcInstant& instant);

/// Share of the sun's light of 550 nm that does not come past the moon, [0, 1].
[[nodiscard]] double CoveredLight(const GeodeticPosition& place, const UtcInstant& instant);

/// The eclipse at a place whose maximum, the least distance of the centres, falls into so many
/// seconds from an instant. Contacts are those of almanacs: the sun's radius is 959.63 arcseconds at
/// 1 au (Auwers), the moon's for the outer contacts 0.2725076 equatorial radii of the earth (IAU
/// 1982, over its mountains), for the inner ones 0.272281 (through its valleys; both as in Espenak
/// and Meeus 2006, NASA/TP-2006-214141). Within 5 s of NASA's Besselian elements for 2026 August 12
/// in Spain. Outside 1960-2026 a second of delta-T moves them by up to a second.
/// @param within_s  > 0, 2 days at most.
[[nodiscard]] std::optional<SolarEclipse> FindSolarEclipse(const GeodeticPosition& place,
                                                           const UtcInstant& from, double within_s);

/// What an eclipse of the sun does.
enum class EclipseEvent { kFirstContact, kSecondContact, kMaximum, kThirdContact, kLastContact };

/// "first-contact", "second-contact", "eclipse-maximum", "third-contact", "last-contact"; nothing for
/// another name.
[[nodiscard]] std::optional<EclipseEvent> EclipseEventFromName(std::string_view name);

/// Nothing for the inner contacts of a partial eclipse.
[[nodiscard]] std::optional<UtcInstant> InstantOf(EclipseEvent event, const SolarEclipse& eclipse);

}  // namespace alpenglow::atmosphere
