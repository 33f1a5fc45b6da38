// SPDX-License-Identifier: MIT
// This header provides the ground of an elevation model with relief finer than its samples. The
// mean of the relief over the cell of each sample is stored and taken off, so that the mean height
// of the ground over a sample stays the model's.
//
// The correction of a sample is the mean of 4 x 4 reliefs in its cell, for a footprint of a sixth
// of the spacing: 4 bytes per sample. A spline that has the corrections as its cell means
// (height_spline.h) is taken off. Used by the study and tests so far.
#pragma once

#include "renderer/material/land_cover.h"
#include "renderer/relief/height_spline.h"
#include "renderer/relief/relief.h"

namespace alpenglow::renderer {

/// Ground with relief. Immutable.
class DetailedGround {
 public:
  /// Throws InputError as HeightSpline does. It takes 16 evaluations per sample.
  DetailedGround(const MetricGrid& grid, SampleMeaning meaning, const MountainCover& cover);

  /// Returns the ground at a place [m] (height_spline.h) for a footprint [m]: Relief::height_m is
  /// relative to the model, with the correction. The mean over the cell of a sample is within 1 m
  /// rms of the model's for a spacing of up to 90 m.
  [[nodiscard]] Relief<double> At(double east_m, double north_m, double footprint_m) const;
  /// Returns the height and shares alone: slopes are those of the model. It takes about
  /// half the time.
  [[nodiscard]] Relief<double> HeightAt(double east_m, double north_m, double footprint_m) const;

  [[nodiscard]] const HeightSpline& model() const { return model_; }

 private:
  [[nodiscard]] MetricGrid MeanRelief() const;

  MountainCover cover_;
  HeightSpline model_;
  HeightSpline correction_;
};

}  // namespace alpenglow::renderer
