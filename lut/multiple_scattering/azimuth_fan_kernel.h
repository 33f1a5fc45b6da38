// SPDX-License-Identifier: MIT
// This header declares the loops of AzimuthFan over samples, sun angles and azimuths, which process
// four bands at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Task of `contract`: interpolates the moments of four bands in altitude at one sample and sums
/// them over degree, for `suns` consecutive nodes of the sun's angle.
struct FanContraction {
  const float* nodes[4];  // at the four altitudes: first node, moment 0, first of four bands
  float weights[4];       // weights of the altitudes
  std::size_t suns;
  std::size_t sun_stride;     // floats between nodes of the sun's angle
  std::size_t moment_stride;  // floats between moments
  int degree;
  std::size_t tensor;    // channel of T20 (polarised_scattering.h); 0 if light is unpolarised
  const float* factors;  // four per moment: source per moment
  float* rows;           // [(sun * (degree + 1) + m) * 4]
};

/// Task of `find_suns`: finds the position of the sun at one sample for `count` azimuths.
struct FanSuns {
  std::size_t count;
  const float* nu;              // cosines between view ray and sun
  float radius_mu_s, distance;  // sun's cosine: (radius_mu_s + distance nu) / radius
  float inverse_radius;
  float mu;                         // cosine of the view's zenith angle at the sample
  const float* coordinate_of_mu_s;  // table over [-1, 1] of the position among the sun nodes
  const float* twilight_of_mu_s;    // table with the cells of coordinate_of_mu_s
  float table_cells;
  float* position;  // position among the nodes of the sun's angle
  float* twilight;  // factor of the light after interpolation
  float* cosine;    // cosine of the azimuth between view and sun
  float* sun_sine;  // sine of the sun's zenith angle, or null
};

/// Task of `gather`: adds the light of one sample.
struct FanGathering {
  std::size_t count;
  const float* position;
  const float* twilight;
  const float* cosine;
  const float* sun_sine;  // factor of the rows, raised to a power (SinePower), or null
  int first_sun, suns;    // node of the first row; number of rows
  int degree;
  const float* rows;
  float* light;  // four per direction
};

struct AzimuthFanKernel {
  void (*contract)(const FanContraction& work);
  void (*find_suns)(const FanSuns& work);
  void (*gather)(const FanGathering& work);
};

ALPENGLOW_DECLARE_KERNEL(AzimuthFanKernel);

}  // namespace alpenglow::lut
