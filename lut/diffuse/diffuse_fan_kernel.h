// SPDX-License-Identifier: MIT
// The loops of DiffuseFan over samples, sun angles and azimuths, four bands at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "atmosphere/dialect/instruction_set.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Moments of four bands at one sample, altitude interpolated and degree summed, for `suns`
/// consecutive nodes of the sun's angle.
struct FanContraction {
  const float* nodes[4];  // at the four altitudes: the first node, moment 0, first of four bands
  float weights[4];       // of the altitudes
  std::size_t suns;
  std::size_t sun_stride;     // floats between nodes of the sun's angle
  std::size_t moment_stride;  // between moments
  int degree;
  std::size_t tensor;    // channel of T20 (polarised_light.h); 0: light is not polarised
  const float* factors;  // four a moment: source per moment
  float* rows;           // [(sun * (degree + 1) + m) * 4]
};

/// Where the sun stands at one sample, seen under `count` azimuths.
struct FanSuns {
  std::size_t count;
  const float* nu;              // cosines between view and sun
  float radius_mu_s, distance;  // sun's cosine: (radius_mu_s + distance nu) / radius
  float inverse_radius;
  float mu;                         // of the view there
  const float* coordinate_of_mu_s;  // table over [-1, 1] of the position among the sun nodes
  const float* twilight_of_mu_s;    // table of the same cells
  float table_cells;
  float* position;  // among the nodes of the sun's angle
  float* twilight;  // what light is multiplied by after interpolation
  float* cosine;    // of the azimuth between view and sun
  float* sun_sine;  // of the sun's zenith angle, or null
};

/// Adds one sample's light.
struct FanGathering {
  std::size_t count;
  const float* position;
  const float* twilight;
  const float* cosine;
  const float* sun_sine;  // by whose power rows are to be multiplied (SinePower), or null
  int first_sun, suns;    // of the rows: the nodes that they stand for
  int degree;
  const float* rows;
  float* light;  // four a direction
};

struct DiffuseFanKernel {
  void (*contract)(const FanContraction& work);
  void (*find_suns)(const FanSuns& work);
  void (*gather)(const FanGathering& work);
};

ALPENGLOW_DECLARE_KERNEL(DiffuseFanKernel);

}  // namespace alpenglow::lut
