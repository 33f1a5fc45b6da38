// SPDX-License-Identifier: MIT
// The table of phase functions: one row for each PhaseKind, with its name, its parameters and their
// ranges, its value, mean cosine, samples and Legendre coefficients, and its expression in shaders.
// The formulas of the values are in phase.glsl.
#pragma once

#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere {

/// A parameter of phase functions, with its key, unit and meaning in atmosphere.toml.
struct PhaseParameter {
  const char* key;
  double PhaseFunction::*member;
  double low, high;
  bool has_ends;  // whether low and high are values of the parameter
  const char* unit;
  const char* text;
};

struct PhaseForm {
  PhaseKind kind;
  const char* name;  // in atmosphere.toml
  std::span<const PhaseParameter> parameters;
  /// Return the value [1/sr], in double precision and as shaders compute it.
  double (*value)(const PhaseFunction& phase, double cos_scattering);
  float (*value_in_float)(const PhaseFunction& phase, float cos_scattering);
  /// The value in shared texts of the cosine `c` and the vector `p` of g, g_back, back_weight and
  /// alpha (PhaseVectorOf). A shader that has one formula is faster than one that chooses at run
  /// time.
  const char* expression;
  double (*mean_cosine)(const PhaseFunction& phase);
  /// Returns a cosine with the density 2 pi value(); rounding may leave [-1, 1].
  /// @param u  uniform in [0, 1).
  double (*sample)(const PhaseFunction& phase, double u);
  /// Returns chi_0 to chi_degree, where value() is the sum of (2 l + 1) / (4 pi) chi_l P_l. Null:
  /// there is no closed form, and the coefficients are integrals.
  std::vector<double> (*legendre)(const PhaseFunction& phase, int degree);
};

/// Returns all rows, in the order of PhaseKind.
[[nodiscard]] std::span<const PhaseForm> PhaseForms();
[[nodiscard]] const PhaseForm& FormOf(PhaseKind kind);

/// Returns every parameter that some phase function has, with its widest range.
[[nodiscard]] std::span<const PhaseParameter> PhaseParameters();
/// Returns the vector `p` of PhaseForm::expression: these parameters in their order.
[[nodiscard]] inline glm::dvec4 PhaseVectorOf(const PhaseFunction& phase) {
  return {phase.g, phase.g_back, phase.back_weight, phase.alpha};
}
/// Returns the parameter of a phase function with this key, if it has one.
[[nodiscard]] std::optional<PhaseParameter> ParameterOf(const PhaseForm& form,
                                                        std::string_view key);

}  // namespace alpenglow::atmosphere
