// SPDX-License-Identifier: MIT
// The sun as a disk: how much of it stands over the horizon, and how bright it is.
#pragma once

namespace alpenglow::atmosphere {

/// The part of a disk that stands over the geometric horizon.
struct VisibleDisk {
  double fraction;        // of its area, [0, 1]
  double mu_s_effective;  // zenith cosine of the visible part's centre
};

/// @param mu_s        zenith cosine of the disk's centre, at the point.
/// @param horizon_mu  zenith cosine of the horizon at the point.
/// @param radius_rad  angular radius of the disk, > 0.
/// Area and centre of a circular segment; the horizon is a straight line over half a degree.
[[nodiscard]] VisibleDisk DiskOverHorizon(double mu_s, double horizon_mu, double radius_rad);

/// Solid angle of a disk of angular radius a [sr]: 2 pi (1 - cos a).
[[nodiscard]] double DiskSolidAngle(double radius_rad);

/// Brightness relative to the disk's mean at angular distance from its centre (0 centre, 1 limb):
/// (1 - u (1 - mu)) / (1 - u / 3), mu = sqrt(1 - rho^2), u = 0.6, the limb darkening of the
/// visible. Cox (2000), Allen's Astrophysical Quantities, 14.7.
[[nodiscard]] double LimbDarkening(double rho);

/// The same in one wavelength [nm]: Neckel (2005), Solar Physics 229, 13. Within 0.011 of the
/// centre's brightness of what Neckel and Labs (1994) measured from 390 to 1050 nm, rho up to 0.995.
/// Beyond [300, 1100] nm as at the ends.
[[nodiscard]] double LimbDarkening(double rho, double wavelength_nm);

/// The circle within which lies a share of the disk's light, by LimbDarkening(rho): its radius.
/// @param share  in [0, 1].
[[nodiscard]] double CircleOfLight(double share);

}  // namespace alpenglow::atmosphere
