// SPDX-License-Identifier: MIT
// Phase functions: how scattered light is distributed over angle. Every one is normalised so that
// its integral over the sphere is 1 [1/sr]. `cos_scattering` is the cosine between the directions
// of propagation before and after: forward is +1.
//
// Formulas are the shared text phase.glsl; here they become values that a medium can hold.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace alpenglow::atmosphere {

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
