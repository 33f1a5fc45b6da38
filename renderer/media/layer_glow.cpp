// SPDX-License-Identifier: MIT
#include "renderer/media/layer_glow.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr double kThinNodes = 0.05, kDenseNodes = 100.0;

}  // namespace

GlowNodes::GlowNodes(double depth)
    : depth_(depth),
      dense_depth_(std::min(depth, kDenseNodes)),
      log_(std::log1p(dense_depth_ / kThinNodes)),
      last_(depth > kDenseNodes ? kGlowNodes - 2.0 : kGlowNodes - 1.0) {}

double GlowNodes::Depth(std::size_t node) const {
  if (node + 1 == kGlowNodes) return depth_;
  const double sine = std::sin(0.5 * kPi * static_cast<double>(node) / last_);
  return std::min(kThinNodes * std::expm1(log_ * sine * sine), dense_depth_);
}

double GlowNodes::NodeAt(double depth) const {
  if (!(depth_ > 0.0)) return 0.0;
  if (depth > dense_depth_) {
    return last_ + std::min((depth - dense_depth_) / (depth_ - dense_depth_), 1.0);
  }
  const double share = std::log1p(depth / kThinNodes) / log_;
  return last_ * 2.0 / kPi * std::asin(std::sqrt(std::clamp(share, 0.0, 1.0)));
}

GlowDirection::GlowDirection(const LayerStack& stack, const LightWay& way) : way_(way) {
  constexpr double kFlattest = 1e-6;
  if (std::abs(way_.mu) < kFlattest) way_.mu = kFlattest;
  const int streams = stack.streams().streams();
  for (int m = 0; m < stack.modes(); ++m) {
    for (const double value : AssociatedLegendre(m, streams - 1, way_.mu)) {
      harmonics_.push_back(value * std::cos(m * way_.azimuth));
    }
  }
  const GlowNodes nodes(stack.optics(0).optical_depth);
  for (std::size_t i = 0; i + 1 < kGlowNodes; ++i) {
    const std::size_t node = way_.mu < 0.0 ? i : kGlowNodes - 2 - i;
    const double depth = stack.scaled(0).scale * (nodes.Depth(node + 1) - nodes.Depth(node));
    const double x = depth / std::abs(way_.mu);
    // Sources are linear within an interval. Below 1e-4 the first terms of the series are exact.
    const double light = std::exp(-x);
    const double mean = x > 1e-4 ? -std::expm1(-x) / x : 1.0 - 0.5 * x;
    const double to = x > 1e-4 ? 1.0 - mean : 0.5 * x;
    intervals_.push_back({light, std::max(mean - light, 0.0), to});
  }
}

LayerGlow::LayerGlow(const LayerStack& stack, const LayerField& field, double mu_s)
    : layer_(stack.scaled(0)), albedo_(stack.optics(0).albedo) {
  const GlowNodes nodes(stack.optics(0).optical_depth);
  for (std::size_t i = 0; i < kGlowNodes; ++i) {
    const double depth = nodes.Depth(i);
    source_.push_back(field.SourceOfHigherOrders(depth));
    const LayerFluxes fluxes = field.Fluxes(depth);
    const double direct = mu_s > 0.0 ? mu_s * std::exp(-layer_.scale * depth / mu_s) : 0.0;
    fluxes_.push_back({fluxes.up, fluxes.down + fluxes.direct - direct, direct});
  }
  of_ground_ = stack.ground_albedo() / kPi * (fluxes_.back().down + fluxes_.back().direct);
}

std::vector<double> LayerGlow::Towards(const GlowDirection& direction, double from_above) const {
  std::vector<double> light(kGlowNodes, 0.0);
  if (!(albedo_ > 0.0)) return light;
  const bool is_down = direction.way_.mu < 0.0;
  double radiance = is_down ? from_above : of_ground_, before = 0.0;
  for (std::size_t step = 0; step < kGlowNodes; ++step) {
    const std::size_t node = is_down ? step : kGlowNodes - 1 - step;
    const double source = std::inner_product(source_[node].begin(), source_[node].end(),
                                             direction.harmonics_.begin(), 0.0);
    if (step > 0) {
      const GlowDirection::Interval& interval = direction.intervals_[step - 1];
      radiance = interval.light * radiance + interval.from * before + interval.to * source;
    }
    before = source;
    light[node] = (layer_.scale * source + (1.0 - layer_.scale) * radiance) / albedo_;
  }
  return light;
}

}  // namespace alpenglow::renderer
