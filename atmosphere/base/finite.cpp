// SPDX-License-Identifier: MIT
#include "atmosphere/base/finite.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::atmosphere {
namespace {

template <typename Real>
void RequireAllFinite(std::span<const Real> values, std::string_view what) {
  const auto fault = std::find_if_not(values.begin(), values.end(),
                                      [](Real value) { return std::isfinite(value); });
  if (fault == values.end()) return;
  throw InternalError(fmt::format("{}: a result is {}; please report this", what, *fault));
}

}  // namespace

void RequireFinite(std::span<const float> values, std::string_view what) {
  RequireAllFinite(values, what);
}

void RequireFinite(std::span<const double> values, std::string_view what) {
  RequireAllFinite(values, what);
}

}  // namespace alpenglow::atmosphere
