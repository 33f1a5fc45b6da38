// SPDX-License-Identifier: MIT
#include "renderer/media/layer_glow.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

/// Returns the fraction of the layer's depth at a node.
double GlowShare(std::size_t node) {
  return std::pow(static_cast<double>(node) / (kGlowNodes - 1), 4);
}

}  // namespace

GlowDirection::GlowDirection(const LayerStack& stack, const LightWay& way) : way_(way) {
  constexpr double kFlattest = 1e-6;
  if (std::abs(way_.mu) < kFlattest) way_.mu = kFlattest;
  const int streams = stack.streams().streams();
  for (int m = 0; m < stack.modes(); ++m) {
    for (const double value : AssociatedLegendre(m, streams - 1, way_.mu)) {
      harmonics_.push_back(value * std::cos(m * way_.azimuth));
    }
  }
  for (std::size_t i = 0; i + 1 < kGlowNodes; ++i) {
    const std::size_t node = way_.mu < 0.0 ? i : kGlowNodes - 2 - i;
    const double depth = stack.scaled(0).depth * (GlowShare(node + 1) - GlowShare(node));
    const double x = depth / std::abs(way_.mu);
    // Sources are linear within an interval. Below 1e-4 the first terms of the series are exact.
    const double light = std::exp(-x);
    const double mean = x > 1e-4 ? -std::expm1(-x) / x : 1.0 - 0.5 * x;
    const double to = x > 1e-4 ? 1.0 - mean : 0.5 * x;
    intervals_.push_back({light, std::max(mean - light, 0.0), to});
  }
}

LayerGlow::LayerGlow(const LayerStack& stack, const LayerField& field, double mu_s)
    : layer_(stack.scaled(0)), mu_s_(mu_s), albedo_(stack.optics(0).albedo) {
  const double whole = stack.optics(0).optical_depth;
  for (std::size_t i = 0; i < kGlowNodes; ++i) {
    const double depth = whole * GlowShare(i);
    source_.push_back(field.SourceOfHigherOrders(depth));
    fluxes_.push_back(field.Fluxes(depth));
    if (mu_s_ > 0.0) {
      beam_.push_back(std::exp(-layer_.scale * depth / mu_s_));
      LayerFluxes& fluxes = fluxes_.back();
      fluxes.down += fluxes.direct - mu_s_ * beam_.back();
      fluxes.direct = mu_s_ * beam_.back();
    }
  }
  of_ground_ = stack.ground_albedo() / kPi * (fluxes_.back().down + fluxes_.back().direct);
}

double LayerGlow::TruncatedPhase(const LightWay& way) const {
  const double sines = std::sqrt((1.0 - way.mu * way.mu) * (1.0 - mu_s_ * mu_s_));
  const std::vector<double> series = LegendreSeries(static_cast<int>(layer_.chi.size()) - 1,
                                                    sines * std::cos(way.azimuth) - way.mu * mu_s_);
  return std::max(std::inner_product(series.begin(), series.end(), layer_.chi.begin(), 0.0), 0.0);
}

std::vector<double> LayerGlow::Towards(const GlowDirection& direction, double from_above) const {
  std::vector<double> light(kGlowNodes, 0.0);
  if (!(albedo_ > 0.0)) return light;
  const double phase = beam_.empty() ? 0.0 : layer_.albedo * TruncatedPhase(direction.way_);
  const bool is_down = direction.way_.mu < 0.0;
  double radiance = is_down ? from_above : of_ground_, before = 0.0;
  for (std::size_t step = 0; step < kGlowNodes; ++step) {
    const std::size_t node = is_down ? step : kGlowNodes - 1 - step;
    const double higher = std::inner_product(source_[node].begin(), source_[node].end(),
                                             direction.harmonics_.begin(), 0.0);
    const double source = higher + (beam_.empty() ? 0.0 : phase * beam_[node]);
    if (step > 0) {
      const GlowDirection::Interval& interval = direction.intervals_[step - 1];
      radiance = interval.light * radiance + interval.from * before + interval.to * source;
    }
    before = source;
    light[node] = (layer_.scale * higher + (1.0 - layer_.scale) * radiance) / albedo_;
  }
  return light;
}

}  // namespace alpenglow::renderer
