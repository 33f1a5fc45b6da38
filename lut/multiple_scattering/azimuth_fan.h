// SPDX-License-Identifier: MIT
// This header provides AzimuthFan: MultipleScattering along one view ray for many azimuths of the
// sun, at the cost of a few.
//
// All directions of one zenith angle share altitudes, columns and harmonics; only the sun's angles
// differ. The moments are therefore interpolated in altitude, and summed over degree, once per
// sample. For each azimuth there remains a cubic interpolation between a few nodes of the sun's
// angle.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"

namespace alpenglow::lut {

class AzimuthFan {
 public:
  /// Keeps a reference to `light`.
  explicit AzimuthFan(const MultipleScattering& light);

  /// Returns the in-scattered light of orders two and up [1/sr]: [direction * bands + band].
  /// @param samples  samples along `ray`, taken with the sun in the zenith, so that no part is in
  ///   shadow.
  /// @param ray      altitude, zenith cosine and sun zenith cosine at the observer; its nu is not
  ///   used.
  /// @param nus      cosine of the angle between each direction and the sun.
  /// Agrees with MultipleScattering::InscatterByMoments of these samples to 1.2e-4 of the brightest
  /// value (asserted by aureole_test).
  [[nodiscard]] std::vector<float> InscatterAlong(const RaySamples<float>& samples,
                                                  const ViewRay& ray,
                                                  std::span<const float> nus) const;

 private:
  struct Line;
  static constexpr std::size_t kLanes = 4;
  using Factors = std::array<float, (kMaxMoments + kTensorMoments) * kLanes>;
  /// Nodes of the sun's angle from the first to the last.
  struct SunRange {
    int low, high;
  };
  [[nodiscard]] Factors FactorsAt(const RaySamples<float>& samples, std::size_t s,
                                  std::size_t first_band) const;
  void FillRows(const RaySamples<float>& samples, std::size_t s, std::size_t first_band,
                const SunRange& suns, float* rows) const;
  void AddBlock(const Line& line, std::size_t first_band, std::span<float> light) const;
  [[nodiscard]] const float* Values() const;

  const MultipleScattering& light_;
  std::size_t stride_;            // number of bands, rounded up to whole blocks
  DeltaScaledMedium scattering_;  // medium in which the moments are transported
  std::vector<float> padded_;     // smooth() of light_ with stride_; empty if it already has it
  std::vector<float> position_of_mu_s_;  // over [-1, 1]: position among the sun nodes
  std::vector<float> twilight_of_mu_s_;  // TwilightOf at the same values of mu_s
  std::vector<float> twilight_;          // TwilightOf at the nodes
  std::vector<float> sun_sine_;          // sines of the nodes' sun zenith angles
};

}  // namespace alpenglow::lut
