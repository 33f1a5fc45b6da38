// SPDX-License-Identifier: MIT
// Froxels, written anew from their publication, for the report to compare with: Hillaire (2020),
// Computer Graphics Forum 39, 13, section 5.4.
//
// The topics of the report of pictures, each measured on its own.
//
// Speed and accuracy of pictures held against each other, in one run: `skyseries report`.
//
// Topics: aerial perspective and transmittance before terrain, shafts, one lamp in fog, many
// lamps, whole pictures. Rows, folders and pages are those of lut/report/report.h;
// WriteReport writes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/report/report.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "renderer/layer.h"
#include "renderer/light/aerial_perspective.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// The slices of a volume of froxels that one ray goes through: what the air does up to each,
/// linear between. Slice k of 32 ends at 128 km (k / 32)^2 and is marched to from the eye in
/// 2 k steps.
class FroxelColumn {
 public:
  static constexpr int kSlices = 32;
  static constexpr double kFarthest_m = 128e3;
  static constexpr int kSide = 32;  // of the volume, across the picture

  FroxelColumn(const AirIntegrator<float>& air, const ViewRay& ray) : slices_(kSlices + 1) {
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

/// The air in front of terrain, in unbroken sunlight:
/// light scattered on the way, and transmittance.
[[nodiscard]] ReportTopic MeasureAerialPerspective(const Medium& medium,
                                                   const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureTransmittanceToTerrain(const Medium& medium,
                                                        const ReportEffort& effort);

/// Light scattered once where terrain lets the sun into the air.
[[nodiscard]] ReportTopic MeasureShafts(const ReportEffort& effort);

/// Light of one lamp in the air, and of many.
[[nodiscard]] ReportTopic MeasureAirlight(const ReportEffort& effort);
[[nodiscard]] ReportTopic MeasureManyLamps(const ReportEffort& effort);

/// Whole pictures.
[[nodiscard]] ReportTopic MeasurePictures(const ReportEffort& effort);

/// A runway at night in height fog, from 38 m over its approach: so many lamps in two rows along
/// it, and the landing lights of an aeroplane when `with_beam`.
[[nodiscard]] Scene RunwayScene(int lamps, bool with_beam);

/// Measures everything: a minute or two; `mediums` are those of the air before terrain. Stops
/// between methods when the program is interrupted.
[[nodiscard]] Report MeasurePictureReport(const ReportOptions& options);

}  // namespace alpenglow::renderer
