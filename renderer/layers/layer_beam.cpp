// SPDX-License-Identifier: MIT
#include "renderer/layers/layer_beam.h"

#include <algorithm>
#include <cmath>

#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {

LayerOptics GreyLayer(const PhaseFunction& phase, double depth, double albedo) {
  LayerOptics optics{depth, albedo, LegendreCoefficients(phase, kLayerStreams)};
  // Rounding of an integral must not exceed the range.
  for (double& chi : optics.chi) chi = std::clamp(chi, -1.0, 1.0);
  optics.chi[0] = 1.0;
  return optics;
}

LayerBeam::LayerBeam(const PhaseFunction& phase, double albedo) : phase_(phase) {
  constexpr double kLeastPeak = 1e-4;
  if (!(DeltaScaled(GreyLayer(phase, 1.0, albedo), kLayerStreams).peak > kLeastPeak)) return;
  peak_.emplace(phase, kLayerStreams - 1);
  peak_scale_ = 1.0 - albedo * peak_->fraction();
}

double LayerBeam::Angle::At(double peak_depth) const {
  return peak_ ? factor_ * peak_->Effective(peak_depth) : factor_;
}

LayerBeam::Angle LayerBeam::AtAngle(double cos_scattering) const {
  Angle angle;
  if (peak_) angle.peak_ = peak_->AtAngle(cos_scattering);
  angle.factor_ = peak_ ? 1.0 - peak_->fraction() : Phase(phase_, cos_scattering);
  return angle;
}

double LayerBeam::Source(const Angle& angle, const BeamDepths& depths) const {
  constexpr double kOpaque = 30.0;
  const double to_eye = std::min(depths.to_eye, kOpaque);
  return angle.At(PeakDepth(depths.to_sun + to_eye)) *
         std::exp(PeakDepth(to_eye) - peak_scale_ * depths.to_sun);
}

}  // namespace alpenglow::renderer
