// SPDX-License-Identifier: MIT
// Phase functions and scattering matrices: the angular distribution of scattered light, and its
// polarisation. Every phase function is normalised so that its integral over the sphere is 1
// [1/sr]. `cos_scattering` is the cosine between the directions of propagation before and after
// scattering: forward is +1. The formulas are in the shared source phase.glsl; here they become
// values that a medium can hold.
//
// A scattering matrix transforms Stokes parameters. Q > 0 is polarised in the scattering plane; the
// entries [1/sr] have this form for every scatterer that is its own mirror image:
//
//   | I |     | a1  b1   0   0 |  | I |
//   | Q |  =  | b1  a2   0   0 |  | Q |
//   | U |     |  0   0  a3  b2 |  | U |
//   | V |     |  0   0 -b2  a4 |  | V |
//
// a1 is the phase function of unpolarised light. Hovenier, van der Mee and Domke (2004), "Transfer
// of Polarized Light in Planetary Atmospheres"; Q as in Hansen and Travis (1974), Space Sci. Rev.
// 16, 527.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

struct ScatteringMatrix {
  double a1 = 0.0, a2 = 0.0, a3 = 0.0, a4 = 0.0, b1 = 0.0, b2 = 0.0;  // [1/sr]
};

/// The largest depolarisation of molecules: needles that are polarisable along one axis only.
inline constexpr double kLargestDepolarisation = 0.5;

/// Returns the scattering matrix of anisotropic molecules: with c = cos_scattering,
/// D = (1 - d) / (1 + d / 2), D' = (1 - 2 d) / (1 - d) (Hansen and Travis 1974, 2.15 and 2.16)
///
///   4 pi a1 = 3/4 D (1 + c^2) + 1 - D   4 pi a3 = 3/2 D c       4 pi b1 = -3/4 D (1 - c^2)
///   4 pi a2 = 3/4 D (1 + c^2)           4 pi a4 = 3/2 D D' c    b2 = 0
///
/// @param depolarisation  d, in [0, kLargestDepolarisation]: for light scattered by 90 degrees, the
/// ratio of the component polarised in the scattering plane to the component perpendicular to it.
/// @param cos_scattering  in [-1, 1].
[[nodiscard]] ScatteringMatrix RayleighMatrix(double depolarisation, double cos_scattering);

/// Returns the depolarisation of dry air with 360 ppm of carbon dioxide. The King factor F, the
/// ratio of its scattering to that of isotropic molecules with the same refractivity, is the mean
/// of the King factors of its gases by volume: Bates (1984), Planet. Space Sci. 32, 785, as given
/// by Bodhaine et al. (1999), J. Atmos. Oceanic Technol. 16, 1854 (equations 5, 6 and 23);
/// d = 6 (F - 1) / (7 F + 3). About 0.028 in the visible.
/// @param wavelength_nm  in [200, 4000]: beyond the measured range F hardly changes towards the
/// red.
[[nodiscard]] double AirDepolarisation(double wavelength_nm);

/// Polarisation by spheres, in addition to their phase function: ratios of matrix elements to a1,
/// at equally many scattering angles for each element, uniform from 0 to 180 degrees, linear
/// between. a2 = a1 and a4 = a3.
struct SphereRatios {
  std::vector<double> a3, b1, b2;
};

/// Returns the scattering matrix of spheres.
/// @param phase_per_sr  a1.
/// @param cos_scattering  in [-1, 1].
[[nodiscard]] ScatteringMatrix SphereMatrix(const SphereRatios& ratios, double phase_per_sr,
                                            double cos_scattering);

class PhaseTable;

enum class PhaseKind {
  kRayleigh,
  kHenyeyGreenstein,
  kDoubleHenyeyGreenstein,
  kCornetteShanks,
  kSchlick,
  kDraine,
  kHenyeyGreensteinDraine,
  kTable,
};

/// Schlick's k = 1.55 g - 0.55 g^3 exceeds 1 from g = 0.938 on, where the formula is no longer a
/// phase function: |g| must be less than this.
inline constexpr double kLargestSchlickG = 0.938;

/// Parameters of one phase function. Unused parameters keep their defaults.
struct PhaseFunction {
  PhaseKind kind = PhaseKind::kCornetteShanks;
  double g = 0.8;            // asymmetry parameter of the (first) lobe, in (-1, 1); see Schlick
  double g_back = 0.0;       // asymmetry parameter of the second lobe if there are two, in (-1, 1)
  double back_weight = 0.0;  // share of the second lobe, in [0, 1]
  double alpha = 1.0;        // Draine: 0 Henyey-Greenstein, 1 Cornette-Shanks; in [0, 100]
  std::shared_ptr<const PhaseTable> table = nullptr;  // table of kTable

  /// Compares by value; tables with equal samples are equal.
  bool operator==(const PhaseFunction& other) const;
};

/// Returns the value of the phase function [1/sr].
/// @param cos_scattering  in [-1, 1]; values beyond by rounding are clamped.
[[nodiscard]] double Phase(const PhaseFunction& phase, double cos_scattering);

/// Returns the mean of cos_scattering over the phase function. Exact: a closed form, or for a table
/// the integral of its piecewise linear function.
[[nodiscard]] double MeanCosine(const PhaseFunction& phase);

/// Samples a cosine with the density 2 pi Phase(). The distribution equals that of Phase() to 1e-9;
/// for a single lobe the cosine increases with u.
/// @param u uniform in [0, 1).
[[nodiscard]] double SampleCosine(const PhaseFunction& phase, double u);

/// Range of droplet diameters [um] that DropletPhase accepts.
inline constexpr double kSmallestDroplet_um = 1.5;
inline constexpr double kLargestDroplet_um = 50.0;

/// Returns the phase function of water droplets of this diameter: Henyey-Greenstein for the forward
/// peak and Draine's for the rest, fitted to Lorenz-Mie theory by Jendersie and d'Eon
/// (2023). At 550 nm less than 0.16 of the light is scattered into other directions than in
/// Lorenz-Mie theory, and less than 0.11 for diameters up to 5 um. For a Henyey-Greenstein lobe
/// with the same mean cosine this fraction is over 0.2 from 3 um on. The phase function is the same
/// at all wavelengths.
/// @param droplet_diameter_um  in [1.5, 50]; throws InputError naming `key` beyond.
[[nodiscard]] PhaseFunction DropletPhase(double droplet_diameter_um,
                                         const std::string& key = "droplet_diameter_um");

/// Returns the kind named "henyey-greenstein" and so on, as in atmosphere.toml; throws InputError
/// for an unknown name.
[[nodiscard]] PhaseKind PhaseKindFromName(std::string_view name);
[[nodiscard]] std::string NameOf(PhaseKind kind);

/// Throws InputError naming `prefix`.g and so on when a parameter is out of its range.
void Validate(const PhaseFunction& phase, const std::string& prefix);

}  // namespace alpenglow::atmosphere
