// SPDX-License-Identifier: MIT
// Provides functions that compute the tables of the air: directions of texels, values of four
// bands, phase functions, and the twilight factor by which texels are divided.
#pragma once

#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/ray/ray.h"
#include "lut/camera_tables/air_tables.h"

namespace alpenglow::lut {

/// Returns the position of node i of n in [0, 1].
[[nodiscard]] inline double Unit(int i, int n) { return static_cast<double>(i) / (n - 1); }

[[nodiscard]] glm::vec4 Vec4Of(const Spectrum& light);
[[nodiscard]] glm::vec4 Vec4Of(std::span<const float> per_band, std::size_t bands);

/// Returns a / b, and 0 where either is not positive.
[[nodiscard]] inline glm::vec4 Quotient(const glm::vec4& a, const glm::vec4& b) {
  glm::vec4 quotient(0.0F);
  for (glm::length_t band = 0; band < 4; ++band)
    quotient[band] = a[band] > 0.0F && b[band] > 0.0F ? a[band] / b[band] : 0.0F;
  return quotient;
}

/// A row of directions with one zenith angle [rad], its cosine and its sine.
struct AirRow {
  bool ground;
  double zenith_angle, mu, sine;
};

/// Returns rows from the horizon up to sky_range, followed by rows from the horizon down.
[[nodiscard]] std::vector<AirRow> RowsOf(const AirMap& map, int sky, double sky_range, int ground);
/// Returns the azimuths of columns from that of the sun.
[[nodiscard]] std::vector<double> AzimuthsOf(int columns);
/// Returns the cosine between a direction and the sun.
[[nodiscard]] double SunCosineOf(const AirRow& row, double mu_s, double azimuth);

/// Phase functions as evaluated by shaders.
class AirPhases {
 public:
  /// @param nodes  phase function of the aerosol, as in MediumTables::phase or AirTables::phase;
  ///     the caller keeps it alive.
  explicit AirPhases(const AirTexels& nodes) : nodes_(nodes) {}

  [[nodiscard]] static float OfMolecules(double nu);
  [[nodiscard]] glm::vec4 OfAerosol(double nu) const;

 private:
  const AirTexels& nodes_;
};

/// Returns AirTwilight of air_map.glsl at a distance along a ray.
[[nodiscard]] float TwilightAt(const AirMap& map, double mu_s, double nu, double distance_km);

/// Fills single, diffuse and extinction of the tables; all other members must be set.
/// @param once  phases of light scattered once.
void FillWays(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
              const AirPhases& once, AirTables& tables);

}  // namespace alpenglow::lut
