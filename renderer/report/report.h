// SPDX-License-Identifier: MIT
// The report `skyseries report` of speed and accuracy of pictures, measured against each other in
// one run.
//
// Topics, each measured on its own: aerial perspective and transmittance in front of terrain,
// shafts, one lamp in fog, many lamps, whole pictures. Rows, folders and pages are those of
// lut/report/report.h; WriteReport writes them.
//
// Froxels are reimplemented from their publication for comparison: Hillaire (2020), Computer
// Graphics Forum 39, 13, section 5.4.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/report/report.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/layer.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// The slices of a froxel volume along one ray: inscatter and transmittance up to each slice,
/// linear in between. Slice k of 32 ends at 128 km (k / 32)^2 and is marched to from the eye in 2 k
/// steps.
class FroxelColumn {
 public:
  static constexpr int kSlices = 32;
  static constexpr double kFarthest_m = 128e3;
  static constexpr int kSide = 32;  // froxels of the volume across the picture

  FroxelColumn(const SingleScattering<float>& air, const ViewRay& ray) : slices_(kSlices + 1) {
    slices_[0] = {Bands<float>(air.bands()), Bands<float>(air.bands())};
    for (std::size_t band = 0; band < air.bands(); ++band) slices_[0].transmittance[band] = 1.0F;
    const Medium& medium = air.medium();
    for (int k = 1; k <= kSlices; ++k) {
      ViewRay part = ray;
      part.length_m = kFarthest_m * k * k / (kSlices * kSlices);
      const RayExtent extent = ExtentOf(part, medium.planet_radius_m, medium.atmosphere_height_m);
      const auto once =
          air.Scatter(air.SampleAt(part, MarchNodes(MarchRule::kMidpoint, 2 * k, extent)));
      slices_[static_cast<std::size_t>(k)] = {
          air.Inscatter(once, ray.nu),
          MarchedTransmittance(medium, part, MarchRule::kMidpoint, 2 * k)};
    }
  }

  [[nodiscard]] Bands<float> Inscatter(double distance_m) const {
    return Between(distance_m, &AirAlongRay::inscatter);
  }
  [[nodiscard]] Bands<float> Transmittance(double distance_m) const {
    return Between(distance_m, &AirAlongRay::transmittance);
  }

 private:
  [[nodiscard]] Bands<float> Between(double distance_m, Bands<float> AirAlongRay::*part) const {
    const double slice =
        std::min(std::sqrt(distance_m / kFarthest_m) * kSlices, static_cast<double>(kSlices));
    const auto low = std::min(static_cast<std::size_t>(slice), std::size_t{kSlices} - 1);
    const auto share = static_cast<float>(slice - static_cast<double>(low));
    const Bands<float>& from = slices_[low].*part;
    const Bands<float>& to = slices_[low + 1].*part;
    Bands<float> mixed(from.count);
    for (std::size_t band = 0; band < mixed.count; ++band)
      mixed[band] = (1.0F - share) * from[band] + share * to[band];
    return mixed;
  }

  std::vector<AirAlongRay> slices_;
};

/// Measures the air in front of terrain, in unoccluded sunlight: inscatter and transmittance.
[[nodiscard]] ReportTopic MeasureAerialPerspective(const Medium& medium,
                                                   const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureTransmittanceToTerrain(const Medium& medium,
                                                        const ReportEffort& effort);

/// Measures single scattering in air that terrain shades in part.
[[nodiscard]] ReportTopic MeasureShafts(const ReportEffort& effort);

/// Measures the airlight of one lamp, and of many.
[[nodiscard]] ReportTopic MeasureAirlight(const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureManyLamps(const ReportEffort& effort);

/// Measures whole pictures.
[[nodiscard]] ReportTopic MeasurePictures(const ReportEffort& effort);

/// Returns a runway at night in height fog, seen from 38 m over its approach: `lamps` lamps in two
/// rows along it, and the landing lights of an aeroplane when `with_beam`.
[[nodiscard]] Scene RunwayScene(int lamps, bool with_beam);

/// Measures all topics, in one or two minutes; options.mediums apply to the air in front of
/// terrain. Stops between methods when the program is interrupted.
[[nodiscard]] Report MeasurePictureReport(const ReportOptions& options);

}  // namespace alpenglow::renderer
