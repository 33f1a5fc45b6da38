// SPDX-License-Identifier: MIT
// The method "integral" of eval.h, which also describes its estimate of the error.
#pragma once

#include <memory>
#include <optional>

#include "atmosphere/medium/medium.h"
#include "lut/evaluate/eval.h"

namespace alpenglow::lut {

struct IntegralOptions {
  int samples = 16;  // Gauss nodes per panel, in [2, 32]
  /// Relative error that determines the samples of every case, and the use of the reference
  /// solution if they do not suffice. It does not affect the error of light of higher orders.
  std::optional<double> max_error;
};

inline constexpr int kFewestSamples = 2;
inline constexpr int kMostSamples = 32;

/// Makes an evaluator. Throws InputError for more than kMaxBands wavelengths, and options out of
/// range.
[[nodiscard]] std::unique_ptr<Evaluator> MakeIntegralEvaluator(const Medium& medium,
                                                               const IntegralOptions& options = {});

}  // namespace alpenglow::lut
