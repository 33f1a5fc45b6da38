// SPDX-License-Identifier: MIT
#include "lut/report/error_study.h"

#include <oneapi/tbb/parallel_for.h>

#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"

namespace alpenglow::lut {
namespace {

/// Errors, and the standard errors of the references that they contain.
struct ErrorList {
  std::vector<double> errors;
  double noise_squares = 0.0;
  std::size_t noisy = 0;

  void AddNoise(const ReferenceValue& reference, std::size_t band, double scale) {
    if (reference.sigma.empty()) return;
    const double noise = reference.sigma[band] / scale;
    noise_squares += noise * noise;
    ++noisy;
  }
  [[nodiscard]] double Noise() const {
    return noisy == 0 ? 0.0 : std::sqrt(noise_squares / static_cast<double>(noisy));
  }
};

double ScaleOf(const ReferenceValue& reference, std::size_t band) {
  return reference.scale.empty() ? 1.0 : reference.scale[band];
}

}  // namespace

double NoiseOf(const std::vector<ReferenceValue>& references) {
  ErrorList list;
  for (const ReferenceValue& reference : references) {
    for (std::size_t band = 0; band < reference.value.size(); ++band)
      list.AddNoise(reference, band, ScaleOf(reference, band));
  }
  return list.Noise();
}

ErrorStatistics StatisticsOf(const std::vector<ReferenceValue>& references,
                             const std::vector<std::vector<double>>& answers,
                             const ErrorRule& rule) {
  ALPENGLOW_ENSURE(answers.size(), ==, references.size());
  ErrorList all, strict;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const ReferenceValue& reference = references[i];
    for (std::size_t band = 0; band < reference.value.size(); ++band) {
      const double truth = reference.value[band], scale = ScaleOf(reference, band);
      all.errors.push_back(rule.error(answers[i][band], truth, scale));
      all.AddNoise(reference, band, scale);
      if (!(truth > kDarkestValue)) continue;
      strict.errors.push_back(std::abs(answers[i][band] - truth) / truth);
      strict.AddNoise(reference, band, truth);
    }
  }
  ErrorStatistics result = StatisticsOfErrors(std::move(all.errors), all.Noise());
  if (!rule.has_strict) return result;
  const double noise = strict.Noise();
  const ErrorStatistics relative = StatisticsOfErrors(std::move(strict.errors), noise);
  result.strict_rms = relative.rms;
  result.strict_percentile_99 = relative.percentile_99;
  return result;
}

ErrorStatistics StatisticsOfErrors(std::vector<double> errors, double noise) {
  if (errors.empty()) return {};
  RequireFinite(errors, "errors of a method");
  std::sort(errors.begin(), errors.end());
  const std::size_t n = errors.size();
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  const double rms_squared = squares / static_cast<double>(n) - noise * noise;
  ErrorStatistics result;
  result.median = errors[n / 2];
  result.percentile_99 = errors[std::min(n - 1, n * 99 / 100)];
  result.largest = errors.back();
  result.rms_is_bound = noise > 0.0 && rms_squared < 0.25 * noise * noise;
  result.rms = result.rms_is_bound ? 0.5 * noise : std::sqrt(rms_squared);
  result.strict_rms = result.rms;
  result.strict_percentile_99 = result.percentile_99;
  return result;
}

void ForEachCase(std::size_t count, const std::function<void(std::size_t)>& work) {
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (!Interrupted()) work(i);
  });
  ThrowIfInterrupted();
}

}  // namespace alpenglow::lut
