// SPDX-License-Identifier: MIT
// How scattering polarises: what becomes of Stokes parameters. Q > 0 vibrates in the plane of
// scattering; the entries [1/sr] are those of every scatterer that is its own mirror image:
//
//   | I |     | a1  b1   0   0 |  | I |
//   | Q |  =  | b1  a2   0   0 |  | Q |
//   | U |     |  0   0  a3  b2 |  | U |
//   | V |     |  0   0 -b2  a4 |  | V |
//
// a1 is the phase function: what unpolarised light is scattered by. Hovenier, van der Mee and Domke
// (2004), "Transfer of Polarized Light in Planetary Atmospheres"; Q as in Hansen and Travis (1974),
// Space Sci. Rev. 16, 527.
//
// Phase functions: how scattered light is distributed over angle. Every one is normalised so that
// its integral over the sphere is 1 [1/sr]. `cos_scattering` is the cosine between the directions
// of propagation before and after: forward is +1.
//
// Formulas are the shared text phase.glsl; here they become values that a medium can hold.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::atmosphere {

struct ScatteringMatrix {
  double a1 = 0.0, a2 = 0.0, a3 = 0.0, a4 = 0.0, b1 = 0.0, b2 = 0.0;  // [1/sr]
};

/// The largest depolarisation of molecules: of needles that light shakes along one axis alone.
inline constexpr double kLargestDepolarisation = 0.5;

/// Molecules that are not quite round: with c = cos_scattering, D = (1 - d) / (1 + d / 2),
/// D' = (1 - 2 d) / (1 - d) (Hansen and Travis 1974, 2.15 and 2.16)
///
///   4 pi a1 = 3/4 D (1 + c^2) + 1 - D   4 pi a3 = 3/2 D c       4 pi b1 = -3/4 D (1 - c^2)
///   4 pi a2 = 3/4 D (1 + c^2)           4 pi a4 = 3/2 D D' c    b2 = 0
///
/// @param depolarisation  d, in [0, kLargestDepolarisation]: of light scattered by 90 degrees, what
///   vibrates in the plane of scattering over what vibrates across it. @param cos_scattering  in
///   [-1, 1].
[[nodiscard]] ScatteringMatrix RayleighMatrix(double depolarisation, double cos_scattering);

/// Depolarisation of dry air with 360 ppm of carbon dioxide. Its King factor F, by which it scatters
/// more than round molecules of its refractivity would, is the mean of its gases' by volume: Bates
/// (1984), Planet. Space Sci. 32, 785, as Bodhaine et al. (1999), J. Atmos. Oceanic Technol. 16,
/// 1854, have it (equations 5, 6 and 23); d = 6 (F - 1) / (7 F + 3). About 0.028 in the visible.
/// @param wavelength_nm  in [200, 4000]: beyond what was measured to the red F hardly changes.
[[nodiscard]] double AirDepolarisation(double wavelength_nm);

/// What spheres do to polarised light, beside their phase function: ratios to a1 at the same number
/// of scattering angles, uniform from 0 to 180 degrees, linear between. a2 = a1 and a4 = a3.
struct SphereRatios {
  std::vector<double> a3, b1, b2;
};

/// @param phase_per_sr  a1. @param cos_scattering  in [-1, 1].
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

/// Schlick's k = 1.55 g - 0.55 g^3 exceeds 1 from g = 0.938 on, where his formula is no longer a
/// phase function: |g| must stay below this.
inline constexpr double kLargestSchlickG = 0.938;

/// Parameters of one phase function. Unused ones keep their defaults.
struct PhaseFunction {
  PhaseKind kind = PhaseKind::kCornetteShanks;
  double g = 0.8;            // asymmetry parameter of the (first) lobe, in (-1, 1); see Schlick
  double g_back = 0.0;       // of the second lobe where there are two, in (-1, 1)
  double back_weight = 0.0;  // share of the second lobe, in [0, 1]
  double alpha = 1.0;        // Draine: 0 Henyey-Greenstein, 1 Cornette-Shanks; in [0, 100]
  std::shared_ptr<const PhaseTable> table = nullptr;  // of kTable

  /// Equal values; tables of equal samples are equal.
  bool operator==(const PhaseFunction& other) const;
};

/// Phase function value [1/sr].
/// @param cos_scattering  in [-1, 1]; values beyond by rounding are clamped.
[[nodiscard]] double Phase(const PhaseFunction& phase, double cos_scattering);

/// Mean of cos_scattering over the lobe. Exact (closed form; of a table, of its broken line).
[[nodiscard]] double MeanCosine(const PhaseFunction& phase);

/// A cosine drawn with the density 2 pi Phase(). @param u uniform in [0, 1). The distribution is
/// that of Phase() to 1e-9; where there are not two lobes the cosine grows with u.
[[nodiscard]] double SampleCosine(const PhaseFunction& phase, double u);

/// Diameters of droplets [um] that FogPhase knows.
inline constexpr double kSmallestDroplet_um = 1.5;
inline constexpr double kLargestDroplet_um = 50.0;

/// The phase function of fog whose droplets have this diameter: Henyey-Greenstein for the forward
/// peak, Draine's for the rest, fitted to Lorenz-Mie theory by Jendersie and d'Eon (2023). At 550
/// nm less than 0.16 of the light goes elsewhere than Lorenz and Mie say, of up to 5 um less than
/// 0.11; by a lobe of Henyey and Greenstein of the same mean cosine it is
/// over 0.2 from 3 um on. Grey.
/// @param droplet_diameter_um  in [1.5, 50]; throws InputError naming `key` beyond.
[[nodiscard]] PhaseFunction FogPhase(double droplet_diameter_um,
                                     const std::string& key = "droplet_diameter_um");

/// "henyey-greenstein" and so on, as in atmosphere.toml; throws InputError for another name.
[[nodiscard]] PhaseKind PhaseKindFromName(std::string_view name);
[[nodiscard]] std::string NameOf(PhaseKind kind);

/// Throws InputError naming `prefix`.g and so on when a parameter is out of its range.
void Validate(const PhaseFunction& phase, const std::string& prefix);

}  // namespace alpenglow::atmosphere
