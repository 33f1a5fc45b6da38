// SPDX-License-Identifier: MIT
// Light of all orders of scattering in a body (LocalBody), here also called a volume.
//
// Light that is scattered more than once has the moments M_lm on cells of cloud_light/cloud_moments.h,
// solved in the frame of the body. In the medium without the forward peak (cloud_light/cloud_optics.h)
// of scaled extinction sigma' the source of the body is
//
//   sigma' (w' p_eff(nu, f w (tau_s + tau)) E exp(-tau'_s) + sum w' chi'_l Y_lm M_lm)
//
// where E is the irradiance of the sun without the body, tau_s and tau are the optical depths of the
// body towards the sun and the eye, and p_eff (cloud_phase/forward_peak.h) has the light of the peak.
// M has three parts:
//
//   - light of the sun for unit irradiance, one solution for every pair of extinction and albedo;
//   - light of the sky, one solution for every band: it enters from the directions of the solution
//     as it arrives at the middle of the body;
//   - light of lamps and the body's own emission, one solution for every band.
//
// The light of the sun times the irradiance at a point is that of the body under the same irradiance
// everywhere: a shadow of terrain that covers a part of it is not blurred.
//
// Bodies of any optical depth are solved in cells of limited depth (volume_cells.h). The light of
// higher orders on a ray is that of the limited body at the same optical depth from the eye.
//
// Bounds that tests/renderer/media/volume_orders_test.cpp asserts:
//
//   - against traced paths the light of plumes is within 6 % (root mean square) for a largest
//     optical depth of 10, also for mean cosines of -0.5 and -0.7, and within 9 % for 50;
//   - a white body in uniform light is invisible within 1 %, for optical depths up to 10^5;
//   - the middles of faces of a deep white box have the light of a deep plane medium within 8 %;
//   - deep white balls send back the light of the sun within 6 %.
//
// The middles of deep balls are too dark, and edges of deep boxes are dark over a tenth of their length.
//
// Below a mean cosine of -0.3 moments are those of the whole phase function: the peak is backward,
// and its moments above degree 3 are lost. Below -0.7 the light has no error bound.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/cloud_light/cloud_moments.h"
#include "renderer/cloud_light/cloud_optics.h"
#include "renderer/media/local_body.h"
#include "renderer/media/volume_cells.h"

namespace alpenglow::renderer {

/// The light of a lamp at a point.
struct LampBeam {
  glm::dvec3 travel;  // unit
  double irradiance;  // without the body on its way [W m^-2 nm^-1]
  double column_m;    // of the body on its way
  double away_m;      // of the lamp from the point
};

/// The sources of light in a body. Functions are called from many threads.
struct VolumeIllumination {
  glm::dvec3 to_sun{0.0, 0.0, 1.0};  // in the frame of SceneGround, unit
  bool has_sun = false;              // whether the sun shines on the body
  /// Returns the radiance that arrives from a direction, in any unit; null: none.
  std::function<Spectrum(const glm::dvec3& from)> sky;
  /// Returns the beams of lamps at a point; null: no lamps.
  /// @param least_m  distances to lamps count as at least this.
  std::function<std::vector<LampBeam>(const glm::dvec3& point, std::size_t band, double least_m)>
      lamps;
  bool emits = false;
};

/// Immutable; safe to use from many threads. It refers to the body.
class VolumeOrders {
 public:
  /// Solves with as many threads as are free; the result does not depend on their number.
  /// @param most_cells  of the finest grid in the box of the body, >= 64.
  VolumeOrders(const LocalBody& volume, const VolumeIllumination& light,
               double most_cells = kMostCells);

  static constexpr double kMostCells = 32768.0;

  /// Returns the memory of cells and moments [bytes].
  [[nodiscard]] std::size_t bytes() const;

  [[nodiscard]] const CloudOptics& OpticsOf(std::size_t band) const { return *optics_[band]; }
  /// Returns the scaled extinction at density 1 [1/m].
  [[nodiscard]] const SpectrumOf<double>& extinction_per_m() const { return extinction_per_m_; }

  /// The light of one direction of view.
  struct Look {
    glm::dvec3 direction;
    ForwardPeak::Angle peak;              // of the sun
    std::vector<CloudHarmonics> factors;  // [band]
    std::vector<VolumeWay> ways;          // through each of the limited bodies
  };
  /// Returns the values for OwnAt() alone. @param look  unit.
  [[nodiscard]] Look LookTowards(const glm::dvec3& look) const;
  /// @param look  from the eye, unit.
  [[nodiscard]] Look LookAlong(const glm::dvec3& eye, const glm::dvec3& look) const;

  /// A point of a body on a ray from the eye.
  struct Place {
    const glm::dvec3& point;
    double column_to_sun_m, column_to_eye_m;  // of the body
  };
  /// Light that is scattered into a direction of view, per unit of scaled extinction.
  struct Scattered {
    Spectrum sun;  // for unit irradiance of the sun without the body [1/sr]
    Spectrum sky;  // in the unit of VolumeIllumination::sky
    Spectrum own;  // of lamps from the second order on, and of emission from other points
                   // [W m^-2 sr^-1 nm^-1]
  };
  [[nodiscard]] Scattered At(const Place& place, const Look& look) const;
  /// Returns Scattered::own alone, as if the body were not limited (volume_cells.h).
  [[nodiscard]] Spectrum OwnAt(const glm::dvec3& point, const Look& look) const;

  /// Returns w' p_eff at a band, the factor on the light of a lamp in the source of the first order
  /// [1/sr].
  /// @param column_m  of the body towards the lamp and the eye, summed.
  [[nodiscard]] double FirstOfLamp(double cos_scattering, std::size_t band, double column_m) const;

 private:
  [[nodiscard]] double FirstOfSun(const Look& look, std::size_t band, double column_m) const;
  [[nodiscard]] double PeakDepth(std::size_t band, double column_m) const;
  void MakeCells(double most_cells);
  void Solve(std::size_t band, const VolumeIllumination& light);
  void SolveAll(const VolumeIllumination& light);
  /// Returns the moments of the sun's beam in full cells for unit irradiance.
  [[nodiscard]] std::vector<CloudHarmonics> SunIn(const CloudCells& cells, std::size_t band) const;
  /// Returns those of lamps and emission.
  [[nodiscard]] std::vector<CloudHarmonics> OwnIn(const CloudCells& cells, std::size_t band,
                                                  const VolumeIllumination& light) const;
  [[nodiscard]] CloudHarmonics LampsIn(const CloudBox& cell, std::size_t band,
                                       const VolumeIllumination& light) const;
  /// Returns the mean emission in a cell at density 1 [W m^-2 sr^-1 nm^-1 / m].
  [[nodiscard]] double EmissionIn(const CloudBox& cell, std::size_t band) const;
  [[nodiscard]] const VolumeCells& CellsOf(std::size_t band) const {
    return *cells_[cells_of_band_[band]];
  }

  const LocalBody& volume_;
  glm::dvec3 to_sun_;
  bool has_peak_;
  std::vector<std::shared_ptr<const CloudOptics>> optics_;  // [band]
  SpectrumOf<double> extinction_per_m_;
  std::vector<std::unique_ptr<const VolumeCells>> cells_;  // one for all bands if none is limited
  std::vector<std::size_t> cells_of_band_;                 // in cells_
  // Moments of each band; null where there is no light:
  std::vector<std::shared_ptr<const CloudMoments>> sun_, sky_, own_;
};

}  // namespace alpenglow::renderer
