// SPDX-License-Identifier: MIT
// Lamps, and the air around them.
//
// A lamp is a small luminous sphere: outside of its radius, its irradiance is I(direction)
// [cd or W/sr] over d^2. The air is a sum of layers, each of exponential density over a flat
// ground,
//
//   sigma(z) = sigma(0) exp(-z / H),          z = altitude_at_origin + up . p
//
// with H infinite for a homogeneous layer. Over L kilometres the curved ground falls L^2 / 8R below the
// flat ground that touches it in the middle: 2 m over 10 km. Columns along straight lines have a
// closed form:
//
//   integral from a to b of density = |b - a| (rho(a) - rho(b)) / ((z(b) - z(a)) / H)
//
// This header also compiles the shared source lamp_ray.glsl as C++.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/medium/phase.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/shared_glsl/shared_math.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "atmosphere/lamp/lamp_ray.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::atmosphere {

/// Relative intensity tabulated over two angles: gamma from the lamp's axis, and C around the axis
/// from its side vector towards side x axis. For a lamp that shines down and is seen from above, C
/// is counterclockwise (ANSI/IESNA LM-63-2002, section 3, horizontal angles of type C). Linear
/// between the angles, 0 beyond the last gamma.
struct LampTable {
  std::vector<double> gamma_rad;  // ascending from >= 0 to <= pi, at least 2
  std::vector<double> c_rad;      // ascending in [0, 2 pi], 0 first; one value: rotational symmetry
  std::vector<double> intensity;  // [c * gamma_rad.size() + gamma], >= 0

  bool operator==(const LampTable&) const = default;
};

/// Angular distribution of a lamp's light, relative to its intensity.
struct LampProfile {
  enum class Kind {
    kIsotropic,
    kCosinePower,  // cos^exponent of the angle to the axis, 0 behind the lamp
    kCone,         // 1 inside inner_rad, 0 outside outer_rad, smoothstep in the cosine between
    kTable,
  };
  Kind kind = Kind::kIsotropic;
  double exponent = 1.0;  // of kCosinePower, >= 0
  double inner_rad = 0.0, outer_rad = 0.0;
  LampTable table;

  bool operator==(const LampProfile&) const = default;
};

struct Lamp {
  glm::dvec3 position_m{0.0};
  /// Within this distance of the lamp the light scattered by the air is that at this distance,
  /// which keeps the radiance of a ray through the lamp finite. 0 is a point.
  double radius_m = 0.0;
  LampProfile profile;
  glm::dvec3 axis{0.0, 0.0, -1.0};  // unit vector
  glm::dvec3 side{1.0, 0.0, 0.0};   // unit vector, perpendicular to the axis: C = 0 in a table
};

/// Returns the intensity in a direction, relative to the lamp's intensity. The direction is given
/// by its cosines to axis, side and side x axis.
[[nodiscard]] double RelativeIntensity(const LampProfile& profile, const glm::dvec3& cosines);
/// Returns the relative intensity in a unit direction.
[[nodiscard]] double RelativeIntensity(const Lamp& lamp, const glm::dvec3& direction);

/// Throws InputError naming `prefix`.cone and so on for an invalid profile: angles not in order,
/// tables of the wrong size, values negative or not finite.
void Validate(const LampProfile& profile, const std::string& prefix);

inline constexpr std::size_t kMostLampLayers = 4;

/// One constituent of the air around lamps.
struct LampLayer {
  double scale_height_m = std::numeric_limits<double>::infinity();  // > 0; infinite: homogeneous
  double base_m = 0.0;                  // altitude for which the coefficients below are given
  SpectrumOf<double> scattering_per_m;  // at its base
  SpectrumOf<double> extinction_per_m;  // at its base, >= scattering
  PhaseFunction phase;

  /// Returns the logarithm of the density relative to the density at the base; at most 80, see
  /// LayerLogDensity.
  [[nodiscard]] double LogDensity(double altitude_m) const;
  [[nodiscard]] double Density(double altitude_m) const;
  /// Returns the column [m] of relative density along a straight line between two altitudes.
  [[nodiscard]] double ColumnBetween(double length_m, double from_m, double to_m) const;
};

/// The air around lamps: 1 to kMostLampLayers layers with the same number of bands.
struct LampAir {
  std::vector<LampLayer> layers;
  glm::dvec3 up{0.0, 0.0, 1.0};
  double altitude_at_origin_m = 0.0;

  [[nodiscard]] std::size_t bands() const { return layers.front().scattering_per_m.size(); }
  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
};

/// Returns air with one layer of uniform density and one band.
[[nodiscard]] LampAir HomogeneousAir(double scattering_per_m, double extinction_per_m,
                                     const PhaseFunction& phase);

/// Returns the transmittance of the straight line between two points, in every band. Relative error
/// below 1e-12 times the optical depth, or 1e-12.
[[nodiscard]] SpectrumOf<double> TransmittanceBetween(const LampAir& air, const glm::dvec3& from,
                                                      const glm::dvec3& to);

/// Returns the column [m] over a length between points of relative densities rho_a and rho_b, which
/// are rise_over_h = (z_b - z_a) / H scale heights apart.
[[nodiscard]] double ExponentialColumn(double length_m, double rho_a, double rho_b,
                                       double rise_over_h);

}  // namespace alpenglow::atmosphere
