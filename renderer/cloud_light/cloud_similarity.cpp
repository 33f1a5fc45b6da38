// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_similarity.h"

#include <cmath>
#include <vector>

#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/cloud_light/cloud_optics.h"

namespace alpenglow::renderer {
namespace {

/// The fraction f of a phase function that goes straight on, and the lobe that is left.
struct SimilarLobe {
  double fraction, g;
};

SimilarLobe SimilarLobeOf(const PhaseFunction& phase) {
  const std::vector<double> chi = LegendreCoefficients(phase, 2);
  return {chi[2], (chi[1] - chi[2]) / (1.0 - chi[2])};
}

}  // namespace

CloudSimilarity::CloudSimilarity(const CloudField& field, const CloudScatterers& scatterers)
    : CloudSimilarity(MeanCloudPhase(field, scatterers.phases),
                      scatterers.albedo.value_or(field.single_scattering_albedo())) {}

CloudSimilarity::CloudSimilarity(const PhaseFunction& phase, double albedo)
    : phase_{.kind = PhaseKind::kHenyeyGreenstein, .g = SimilarLobeOf(phase).g},
      peak_(ForwardPeak::BesideLobe(phase, SimilarLobeOf(phase).fraction, phase_.g)),
      scale_(1.0 - peak_.fraction() * albedo),
      albedo_((1.0 - peak_.fraction()) * albedo / scale_) {}

double CloudSimilarity::LastTrueSource(double cos_scattering, double to_sun) const {
  return peak_.Broadened(cos_scattering, (1.0 - scale_) * to_sun) * std::exp(-scale_ * to_sun);
}

}  // namespace alpenglow::renderer
