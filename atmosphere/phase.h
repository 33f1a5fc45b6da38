// SPDX-License-Identifier: MIT
// Phase functions: how scattered light is distributed over angle. Every one is normalised so that
// its integral over the sphere is 1 [1/sr]. `cos_scattering` is the cosine between the directions
// of propagation before and after: forward is +1.
//
// Formulas are the shared text phase.glsl; here they become values that a medium can hold.
#pragma once

#include <string>
#include <string_view>

namespace alpenglow {

enum class PhaseKind {
  kRayleigh,
  kHenyeyGreenstein,
  kDoubleHenyeyGreenstein,
  kCornetteShanks,
  kSchlick,
  kDraine,
};

/// Schlick's k = 1.55 g - 0.55 g^3 exceeds 1 from g = 0.938 on, where his formula is no longer a
/// phase function: |g| must stay below this.
inline constexpr double kLargestSchlickG = 0.938;

/// Parameters of one phase function. Unused ones keep their defaults.
struct PhaseFunction {
  PhaseKind kind = PhaseKind::kCornetteShanks;
  double g = 0.8;            // asymmetry parameter of the (first) lobe, in (-1, 1); see Schlick
  double g_back = 0.0;       // second lobe of the double Henyey-Greenstein, in (-1, 1)
  double back_weight = 0.0;  // share of the second lobe, in [0, 1]
  double alpha = 1.0;        // Draine: 0 Henyey-Greenstein, 1 Cornette-Shanks; in [0, 1]

  bool operator==(const PhaseFunction&) const = default;
};

/// Phase function value [1/sr].
/// @param cos_scattering  in [-1, 1]; values beyond by rounding are clamped.
[[nodiscard]] double Phase(const PhaseFunction& phase, double cos_scattering);

/// Mean of cos_scattering over the lobe. Exact (closed form).
[[nodiscard]] double MeanCosine(const PhaseFunction& phase);

/// A cosine drawn with the density 2 pi Phase(). @param u uniform in [0, 1). The distribution is
/// that of Phase() to 1e-9; for all but the double Henyey-Greenstein the cosine grows with u.
[[nodiscard]] double SampleCosine(const PhaseFunction& phase, double u);

/// "henyey-greenstein" and so on, as in atmosphere.toml; throws InputError for another name.
[[nodiscard]] PhaseKind PhaseKindFromName(std::string_view name);
[[nodiscard]] std::string NameOf(PhaseKind kind);

/// Throws InputError naming `prefix`.g and so on when a parameter is out of its range.
void Validate(const PhaseFunction& phase, const std::string& prefix);

}  // namespace alpenglow
