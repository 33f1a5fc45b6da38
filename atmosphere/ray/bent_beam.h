// SPDX-License-Identifier: MIT
// Sunlight that falls on ground, fog and volumes along bent rays, against that of straight ones.
//
// Where a disk is seen at an elevation e, a surface across its beams gets
//
//   E = E_0 T(h, e) F(h, e),  F = exp(-more optical depth) (de / de_true) cos(e) / cos(e_true)
//
// T of the straight ray from height h along e. The bent ray stays lower, so it passes more air, and
// refraction, which grows downwards, makes the disk as much flatter as it spreads its light. Radiance
// over the square of the refractive index stays as it is along a ray (Born and Wolf 1999, Principles
// of Optics, 3.1.2), and that square is 1 within 6e-4.
//
// F lies in a table over sqrt(h) and over log(1 + (sin e - sin of the horizon) / s). Elevations are
// those at which the disk's middle is seen at the place itself. Ozone is left out, as by
// BentView::MoreOpticalDepth.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/bent_ray.h"

namespace alpenglow::atmosphere {

/// For one medium, at any height. Immutable.
class BentBeam {
 public:
  /// The beam is that of straight rays in a medium whose air does not bend gently (GentleAirOf of bent_view.h).
  explicit BentBeam(const Medium& medium);

  /// Returns F, by band. Under the horizon it is that on it, above the air that at its top.
  /// Light of the beam is within 2 % of an integration along bent rays from 0.1 degrees up at 0, 3
  /// and 8 km, and within 3 % from 0.3 degrees over the horizon between the table's heights
  /// (tests/atmosphere/ray/bent_beam_test.cpp).
  [[nodiscard]] Bands<float> OverStraight(double altitude_m, double mu) const;

  /// Returns the irradiance across the beams of a sun whose irradiance above the air is 1.
  /// @param air  of the medium. @param mu  zenith cosine of where the disk is seen, not behind the
  ///     planet.
  [[nodiscard]] Bands<float> Left(const AirIntegrator<float>& air, double altitude_m,
                                  double mu) const;

 private:
  struct Node {
    glm::dvec2 more_m;  // columns of molecules and aerosol, more than if straight
    double log_spread;
  };
  struct Row {
    double horizon_mu;
    std::vector<Node> nodes;
  };
  [[nodiscard]] static Row RowAt(const AirIntegrator<double>& straight, const BendingAir& air,
                                 double height_m);
  [[nodiscard]] Node At(double altitude_m, double mu) const;

  std::size_t bands_;
  double top_m_;
  std::vector<double> molecules_per_m_, aerosol_per_m_;  // extinction at altitude 0
  std::vector<Row> rows_;                                // none: nothing bends
};

}  // namespace alpenglow::atmosphere
