// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_optics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase_table.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

constexpr int kRadiusSamples = 20000;
constexpr std::size_t kRadiusBins = 24;
constexpr double kLeastRadius_um = 1.0, kMostRadius_um = 200.0;
// Angles are dense in the forward peak; near 180 degrees they are 0.25 degrees apart.
constexpr int kMeanAngles = 2160;

double BinRadius_um(double bin) {
  return kLeastRadius_um * std::pow(kMostRadius_um / kLeastRadius_um, bin / kRadiusBins);
}

/// Returns the extinction of a field by bins of the effective radius, with the sum 1.
std::vector<double> RadiusShares(const CloudField& field) {
  std::vector<double> share(kRadiusBins, 0.0);
  const CloudBox bounds = field.Bounds();
  double sum = 0.0;
  for (int i = 1; i <= kRadiusSamples; ++i) {
    const glm::dvec3 at(Halton(i, 2), Halton(i, 3), Halton(i, 5));
    const glm::dvec3 point = bounds.low + at * (bounds.high - bounds.low);
    const double per_m = field.Extinction_per_m(point);
    if (per_m == 0.0) continue;
    const double bin = kRadiusBins * std::log(field.EffectiveRadius_um(point) / kLeastRadius_um) /
                       std::log(kMostRadius_um / kLeastRadius_um);
    share[static_cast<std::size_t>(std::clamp(bin, 0.0, kRadiusBins - 1.0))] += per_m;
    sum += per_m;
  }
  for (double& each : share) each = sum > 0.0 ? each / sum : 1.0 / kRadiusBins;
  return share;
}

/// @param share  of the extinction by bin; empty if the radius does not matter.
PhaseFunction MeanPhase(const CloudPhases& phases, const std::vector<double>& share) {
  if (!phases.depends_on_radius()) return phases.Drawn(1.0, 0.0);
  std::vector<double> angle_deg, per_sr;
  for (int i = 0; i <= kMeanAngles; ++i) {
    angle_deg.push_back(180.0 * std::pow(static_cast<double>(i) / kMeanAngles, 3));
    const double cosine = std::cos(angle_deg.back() * kRadiansPerDegree);
    double mean = 0.0;
    for (std::size_t bin = 0; bin < share.size(); ++bin) {
      if (share[bin] == 0.0) continue;
      mean += share[bin] * phases.Value(BinRadius_um(static_cast<double>(bin) + 0.5), cosine);
    }
    per_sr.push_back(mean);
  }
  return {.kind = PhaseKind::kTable,
          .table = std::make_shared<const PhaseTable>(std::move(angle_deg), std::move(per_sr))};
}

}  // namespace

CloudHarmonics CloudHarmonicsOf(const glm::dvec3& direction) {
  const auto x = static_cast<float>(direction.x), y = static_cast<float>(direction.y),
             z = static_cast<float>(direction.z);
  return {0.282094792F,
          0.488602512F * y,
          0.488602512F * z,
          0.488602512F * x,
          1.092548431F * x * y,
          1.092548431F * y * z,
          0.315391565F * (3.0F * z * z - 1.0F),
          1.092548431F * x * z,
          0.546274215F * (x * x - y * y),
          0.590043590F * y * (3.0F * x * x - y * y),
          2.890611442F * x * y * z,
          0.457045799F * y * (5.0F * z * z - 1.0F),
          0.373176333F * z * (5.0F * z * z - 3.0F),
          0.457045799F * x * (5.0F * z * z - 1.0F),
          1.445305721F * z * (x * x - y * y),
          0.590043590F * x * (x * x - 3.0F * y * y)};
}

PhaseFunction MeanCloudPhase(const CloudField& field, const CloudPhases& phases) {
  return MeanCloudPhases(field, {phases}).front();
}

std::vector<PhaseFunction> MeanCloudPhases(const CloudField& field,
                                           const std::vector<CloudPhases>& bands) {
  const bool depends_on_radius = std::ranges::any_of(
      bands, [](const CloudPhases& phases) { return phases.depends_on_radius(); });
  const std::vector<double> share = depends_on_radius ? RadiusShares(field) : std::vector<double>{};
  std::vector<PhaseFunction> means(bands.size());
  tbb::parallel_for(std::size_t{0}, bands.size(),
                    [&](std::size_t i) { means[i] = MeanPhase(bands[i], share); });
  return means;
}

CloudOptics::CloudOptics(const CloudField& field, const CloudScatterers& scatterers)
    : CloudOptics(MeanCloudPhase(field, scatterers.phases),
                  scatterers.albedo.value_or(field.single_scattering_albedo())) {}

CloudOptics::CloudOptics(PhaseFunction phase, double albedo)
    : phase_(std::move(phase)), peak_(phase_, kCloudDegree), albedo_(albedo) {
  FindFactors();
}

CloudOptics::CloudOptics(PhaseFunction phase, const PhaseFunction& peak, double albedo)
    : phase_(std::move(phase)), peak_(peak, kCloudDegree), albedo_(albedo) {
  FindFactors();
}

CloudOptics CloudOptics::WithAlbedo(double albedo) const {
  CloudOptics other = *this;
  other.albedo_ = albedo;
  other.FindFactors();
  return other;
}

void CloudOptics::FindFactors() {
  RequireInRange(albedo_, 0.0, 1.0, "the albedo of single scattering in clouds");
  const std::vector<double> chi = LegendreCoefficients(phase_, kCloudDegree);
  const double f = peak_.fraction();
  for (std::size_t l = 0; l < factor_.size(); ++l) {
    factor_[l] = static_cast<float>(scaled_albedo() * (chi[l] - f) / (1.0 - f));
  }
}

CloudHarmonics CloudOptics::SourceFactors(const glm::dvec3& direction) const {
  CloudHarmonics factors = CloudHarmonicsOf(direction);
  for (std::size_t l = 0, i = 0; l < factor_.size(); ++l) {
    for (; i < (l + 1) * (l + 1); ++i) factors[i] *= factor_[l];
  }
  return factors;
}

}  // namespace alpenglow::renderer
