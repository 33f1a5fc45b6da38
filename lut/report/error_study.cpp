// SPDX-License-Identifier: MIT
#include "lut/report/error_study.h"

#include <oneapi/tbb/parallel_for.h>

#include "atmosphere/base/error.h"

namespace alpenglow::lut {
namespace {

double ScaleOf(const ReferenceValue& reference, std::size_t band) {
  return reference.scale.empty() ? 1.0 : reference.scale[band];
}

}  // namespace

double NoiseOf(const std::vector<ReferenceValue>& references) {
  std::vector<double> noises;
  for (const ReferenceValue& reference : references) {
    for (std::size_t band = 0; band < reference.sigma.size(); ++band)
      noises.push_back(reference.sigma[band] / ScaleOf(reference, band));
  }
  return RmsOf(noises);
}

ErrorStatistics ErrorsOf(const std::vector<ReferenceValue>& references,
                         const std::vector<std::vector<double>>& answers, const ErrorRule& rule) {
  ALPENGLOW_ENSURE(answers.size(), ==, references.size());
  std::vector<double> errors;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const ReferenceValue& reference = references[i];
    for (std::size_t band = 0; band < reference.value.size(); ++band)
      errors.push_back(
          rule.error(answers[i][band], reference.value[band], ScaleOf(reference, band)));
  }
  return ErrorStatistics(std::move(errors), NoiseOf(references));
}

ErrorStatistics StrictErrorsOf(const std::vector<ReferenceValue>& references,
                               const std::vector<std::vector<double>>& answers) {
  ALPENGLOW_ENSURE(answers.size(), ==, references.size());
  std::vector<double> errors, noises;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const ReferenceValue& reference = references[i];
    for (std::size_t band = 0; band < reference.value.size(); ++band) {
      const double truth = reference.value[band];
      if (!(truth > kDarkestValue)) continue;
      errors.push_back(std::abs(answers[i][band] - truth) / truth);
      if (!reference.sigma.empty()) noises.push_back(reference.sigma[band] / truth);
    }
  }
  return ErrorStatistics(std::move(errors), RmsOf(noises));
}

void ForEachCase(std::size_t count, const std::function<void(std::size_t)>& work) {
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (!Interrupted()) work(i);
  });
  ThrowIfInterrupted();
}

}  // namespace alpenglow::lut
