// SPDX-License-Identifier: MIT
// DiffuseLight along one view ray under many azimuths of the sun, for the price of a few.
//
// All directions of one zenith angle share altitudes, columns and harmonics;
// only the sun's angles differ. The moments are therefore interpolated in
// altitude, and summed over degree, once a sample; what is left for each
// azimuth is a cubic interpolation between a few nodes of the sun's angle.
#pragma once

#include <span>
#include <vector>

#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"

namespace alpenglow::lut {

class DiffuseFan {
 public:
  /// Keeps a reference to `light`.
  explicit DiffuseFan(const DiffuseLight& light);

  /// In-scattered light of orders two and up [1/sr]: [direction * bands + band].
  /// @param samples  of a ray as `ray`, taken under a sun in the zenith (no part of it is dark).
  /// @param ray      altitude, zenith cosine and the sun's at the observer; its nu is not used.
  /// @param nus      of every direction, cosine between it and the sun.
  /// As DiffuseLight::InscatterAlong of the same samples, to 1e-4 of the brightest, where that has
  /// no forward peak apart; else of the degrees that it keeps.
  [[nodiscard]] std::vector<float> InscatterAlong(const RaySamples<float>& samples,
                                                  const ViewRay& ray,
                                                  std::span<const float> nus) const;

 private:
  struct Line;
  void AddBlock(const Line& line, std::size_t first_band, std::span<float> light) const;
  [[nodiscard]] const float* Values() const;

  const DiffuseLight& light_;
  std::size_t stride_;           // bands, rounded up to whole blocks
  std::vector<float> padded_;    // the values of light_ at this stride; empty where it is theirs
  std::vector<double> chi_mie_;  // [l * bands + band]
  std::vector<float> position_of_mu_s_;  // over [-1, 1]: among the nodes of the sun's angle
  std::vector<float> twilight_of_mu_s_;  // TwilightOf at the same places
  std::vector<float> twilight_;          // and at the nodes
  std::vector<float> sun_sine_;          // of the nodes' zenith angles
};

}  // namespace alpenglow::lut
