// SPDX-License-Identifier: MIT
#include "renderer/report/eddington_stack.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/layers/dense_matrix.h"
#include "renderer/layers/stream_set.h"

namespace alpenglow::renderer {
namespace {

/// Returns the phase function of Legendre coefficients [1/sr].
double PhaseOfMoments(const std::vector<double>& chi, double nu) {
  const std::vector<double> legendre =
      AssociatedLegendre(0, static_cast<int>(chi.size()) - 1, std::clamp(nu, -1.0, 1.0));
  double sum = 0.0;
  for (std::size_t l = 0; l < chi.size(); ++l)
    sum += (2.0 * static_cast<double>(l) + 1.0) * chi[l] * legendre[l];
  return sum / (4.0 * kPi);
}

/// Returns the integral over [from, to] of a function whose logarithm is linear, with these values at
/// both ends.
double LogLinearIntegral(double log_first, double log_last, double length) {
  const double fall = std::abs(log_first - log_last);
  const double mean = fall < 1e-8 ? 1.0 - 0.5 * fall : -std::expm1(-fall) / fall;
  return length * std::exp(std::max(log_first, log_last)) * mean;
}

}  // namespace

EddingtonStack::EddingtonStack(const std::vector<LayerOptics>& layers, double ground_albedo,
                               double mu_s)
    : ground_albedo_(ground_albedo), mu_s_(mu_s) {
  ALPENGLOW_ENSURE(layers.empty(), ==, false);
  ALPENGLOW_ENSURE(mu_s, >, 0.0);
  for (const LayerOptics& optics : layers) AddLayer(optics);
  Solve();
}

void EddingtonStack::AddLayer(const LayerOptics& optics) {
  // Without any absorption both exponentials are the same solution. A millionth separates them.
  LayerOptics absorbing = optics;
  absorbing.albedo = std::min(optics.albedo, 1.0 - 1e-6);
  const ScaledLayer scaled = DeltaScaled(absorbing, 2);
  const double w = scaled.albedo;
  // Eddington's phase function sends more light back than arrives if g is below -2/3.
  const double g = std::max(scaled.chi[1], -2.0 / 3.0);
  const double k = std::sqrt(3.0 * (1.0 - w) * (1.0 - w * g));
  // If the beam decays like diffuse light, the particular solution has a pole that the boundary
  // conditions cancel.
  const double mu = std::abs(k * mu_s_ - 1.0) < 1e-4 ? (1.0 - 1e-4) / k : mu_s_;
  const double above =
      layers_.empty() ? 0.0 : layers_.back().above + layers_.back().depth / layers_.back().scale;
  const double scaled_above =
      layers_.empty() ? 0.0 : layers_.back().scaled_above + layers_.back().depth;
  const double source = w / (4.0 * kPi);
  const double own = 3.0 * mu * mu * source * (1.0 + g - w * g) / (k * k * mu * mu - 1.0);
  const double beam = std::exp(-scaled_above / mu_s_);
  layers_.push_back({.above = above,
                     .scaled_above = scaled_above,
                     .scale = scaled.scale,
                     .depth = scaled.depth,
                     .albedo = w,
                     .g = g,
                     .own_once = absorbing.albedo / scaled.scale,
                     .k = k,
                     .slope = k / (1.0 - w * g),
                     .own = beam * own,
                     .own_slope = beam * 3.0 * mu * ((1.0 - w) * own - source),
                     .chi = optics.chi});
}

void EddingtonStack::Solve() {
  const std::size_t count = layers_.size();
  DenseMatrix matrix(2 * count);
  std::vector<double> right(2 * count, 0.0);
  // Adds mean * I0 + slope * I1 of a layer at its top or bottom to one equation.
  const auto add = [&](std::size_t row, std::size_t j, bool at_top, double mean, double slope) {
    const Layer& layer = layers_[j];
    const double across = std::exp(-layer.k * layer.depth);
    const double falling = at_top ? 1.0 : across, rising = at_top ? across : 1.0;
    matrix(row, 2 * j) += falling * (mean + slope * layer.slope);
    matrix(row, 2 * j + 1) += rising * (mean - slope * layer.slope);
    const double beam = at_top ? 1.0 : std::exp(-layer.depth / mu_s_);
    right[row] -= beam * (mean * layer.own + slope * layer.own_slope);
  };
  add(0, 0, true, 1.0, 2.0 / 3.0);
  for (std::size_t j = 0; j + 1 < count; ++j) {
    add(2 * j + 1, j, false, 1.0, 0.0);
    add(2 * j + 1, j + 1, true, -1.0, 0.0);
    add(2 * j + 2, j, false, 0.0, 1.0);
    add(2 * j + 2, j + 1, true, 0.0, -1.0);
  }
  const Layer& last = layers_.back();
  add(2 * count - 1, count - 1, false, 1.0 - ground_albedo_, -2.0 / 3.0 * (1.0 + ground_albedo_));
  right.back() +=
      ground_albedo_ * mu_s_ / kPi * std::exp(-(last.scaled_above + last.depth) / mu_s_);
  const std::vector<double> solved = InverseOf(matrix) * right;
  for (std::size_t j = 0; j < count; ++j) {
    layers_[j].falling = solved[2 * j];
    layers_[j].rising = solved[2 * j + 1];
  }
}

const EddingtonStack::Layer& EddingtonStack::LayerAt(double depth) const {
  std::size_t i = 0;
  while (i + 1 < layers_.size() && depth >= layers_[i + 1].above) ++i;
  return layers_[i];
}

EddingtonStack::Field EddingtonStack::In(const Layer& layer, double below_top) const {
  const double falling = layer.falling * std::exp(-layer.k * below_top);
  const double rising = layer.rising * std::exp(-layer.k * (layer.depth - below_top));
  const double beam = std::exp(-below_top / mu_s_);
  return {falling + rising + layer.own * beam,
          layer.slope * (falling - rising) + layer.own_slope * beam};
}

LayerFluxes EddingtonStack::Fluxes(double depth) const {
  const Layer& layer = LayerAt(depth);
  const double below_top = std::clamp(layer.scale * (depth - layer.above), 0.0, layer.depth);
  const Field field = In(layer, below_top);
  const double direct = mu_s_ * std::exp(-depth / mu_s_);
  const double with_peak = mu_s_ * std::exp(-(layer.scaled_above + below_top) / mu_s_);
  return {.up = kPi * (field.mean - 2.0 / 3.0 * field.slope),
          .down = kPi * (field.mean + 2.0 / 3.0 * field.slope) + with_peak - direct,
          .direct = direct};
}

double EddingtonStack::Radiance(double depth, const LightWay& way) const {
  const Layer &at = LayerAt(depth), &last = layers_.back();
  const double eye = at.scaled_above + std::clamp(at.scale * (depth - at.above), 0.0, at.depth);
  const double bottom = last.scaled_above + last.depth;
  double light = 0.0;
  for (const Layer& layer : layers_) {
    const double end = layer.scaled_above + layer.depth;
    const Part part = way.mu > 0.0 ? Part{std::max(eye, layer.scaled_above), end}
                                   : Part{layer.scaled_above, std::min(eye, end)};
    if (part.from < part.to) light += InPart(layer, part, eye, way);
  }
  if (way.mu > 0.0) {
    const Field field = In(last, last.depth);
    const double down =
        kPi * (field.mean + 2.0 / 3.0 * field.slope) + mu_s_ * std::exp(-bottom / mu_s_);
    light += ground_albedo_ * down / kPi * std::exp(-(bottom - eye) / way.mu);
  }
  return std::max(light, 0.0);  // I0 + I1 mu may be negative near the edge of the stack
}

double EddingtonStack::InPart(const Layer& layer, const Part& part, double eye,
                              const LightWay& way) const {
  const double steep = std::abs(way.mu), length = (part.to - part.from) / steep;
  // Returns the integral of e^(-rate t) e^(-way to the eye), with t from a depth on.
  const auto along = [&](double rate, double begin) {
    const auto log_at = [&](double depth) {
      return -rate * (depth - begin) - std::abs(depth - eye) / steep;
    };
    return LogLinearIntegral(log_at(part.from), log_at(part.to), length);
  };
  const double top = layer.scaled_above, tilt = -layer.g * way.mu;
  const double nu =
      std::sqrt((1.0 - way.mu * way.mu) * (1.0 - mu_s_ * mu_s_)) * std::cos(way.azimuth) -
      way.mu * mu_s_;
  const double falling = layer.falling * (1.0 + tilt * layer.slope) * along(layer.k, top);
  const double rising =
      layer.rising * (1.0 - tilt * layer.slope) * along(-layer.k, top + layer.depth);
  const double own = (layer.own + tilt * layer.own_slope) * along(1.0 / mu_s_, top);
  const double once = layer.own_once * PhaseOfMoments(layer.chi, nu) * along(1.0 / mu_s_, 0.0);
  return layer.albedo * (falling + rising + own) + once;
}

}  // namespace alpenglow::renderer
