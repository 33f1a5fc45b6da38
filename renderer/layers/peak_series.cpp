// SPDX-License-Identifier: MIT
#include "renderer/layers/peak_series.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {

PeakSeries::PeakSeries(const LayerStack& stack, double nu) : stack_(stack) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < stack.size(); ++n) {
    count = std::max(count, stack.optics(n).chi.size());
    has_peaks_ = has_peaks_ || stack.scaled(n).peak > 0.0;
  }
  legendre_ = LegendreSeries(static_cast<int>(count) - 1, nu);
}

/// Returns f a_l.
double PeakSeries::InPeak(std::size_t layer, std::size_t l) const {
  const double peak = stack_.scaled(layer).peak;
  const std::vector<double>& chi = stack_.optics(layer).chi;
  if (!(peak > 0.0)) return 0.0;
  if (l < static_cast<std::size_t>(stack_.streams().streams())) return peak;
  return l < chi.size() ? chi[l] : 0.0;
}

double PeakSeries::At(std::size_t layer, const std::vector<double>& peak_depths) const {
  const double all = std::accumulate(peak_depths.begin(), peak_depths.end(), 0.0);
  const std::vector<double>& chi = stack_.optics(layer).chi;
  double sum = 0.0;
  for (std::size_t l = 0; l < legendre_.size(); ++l) {
    double kept = 0.0;  // B_l
    for (std::size_t n = 0; n < peak_depths.size(); ++n) {
      if (peak_depths[n] > 0.0) kept += peak_depths[n] * InPeak(n, l) / stack_.scaled(n).peak;
    }
    const double in_peak = InPeak(layer, l);
    const double rest = (l < chi.size() ? chi[l] : 0.0) - in_peak;
    const double share = kept != 0.0 ? -std::expm1(-kept) / kept : 1.0;
    sum += legendre_[l] * (rest + in_peak * share) * std::exp(kept - all);
  }
  return sum;
}

}  // namespace alpenglow::renderer
