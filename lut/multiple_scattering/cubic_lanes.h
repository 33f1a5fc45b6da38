// SPDX-License-Identifier: MIT
// Cubic interpolation (cubic_taps.glsl) and the cosine of the azimuth (azimuth_cosine.glsl) in numbers
// or batches. This header is a part of the kernels of this folder, which are compiled once per
// instruction set.
#pragma once

#include "atmosphere/ray/batch.h"

namespace alpenglow::lut {
namespace {

template <typename T>
struct Weights {
  T w0, w1, w2, w3;
};

namespace shared {
using namespace atmosphere::shared;
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "lut/tables/azimuth_cosine.glsl"
//
#include "lut/tables/cubic_taps.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace shared

template <typename T>
Weights<T> Cubic(const T& t) {
  using namespace shared;
  return {CubicWeight0<T>(t), CubicWeight1<T>(t), CubicWeight2<T>(t), CubicWeight3<T>(t)};
}

}  // namespace
}  // namespace alpenglow::lut
