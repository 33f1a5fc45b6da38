// SPDX-License-Identifier: MIT
#include "renderer/layers/layer_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

/// Rates closer than this to each other, relative, count as this far apart where a formula divides
/// by their difference.
constexpr double kResonance = 1e-6;

/// Returns a rate that differs from another one.
double ApartFrom(double rate, double other) {
  return std::abs(rate - other) < kResonance * other ? other * (1.0 + kResonance) : rate;
}

/// sinh(k (T - t)) / sinh(k T), sinh(k t) / sinh(k T), and their slopes.
struct HyperbolicPair {
  double falling, rising, falling_slope, rising_slope;
};

HyperbolicPair HyperbolicsAt(double k, double depth, double at) {
  if (k == 0.0) return {(depth - at) / depth, at / depth, -1.0 / depth, 1.0 / depth};
  const double from_top = std::exp(-k * at), from_bottom = std::exp(-k * (depth - at));
  const double scale = -1.0 / std::expm1(-2.0 * k * depth);
  return {-from_top * std::expm1(-2.0 * k * (depth - at)) * scale,
          -from_bottom * std::expm1(-2.0 * k * at) * scale,
          -k * from_top * (1.0 + from_bottom * from_bottom) * scale,
          k * from_bottom * (1.0 + from_top * from_top) * scale};
}

/// Returns the factor of cos m phi in a series of azimuth modes of a delta function.
double AzimuthFactor(int m) { return m == 0 ? 1.0 / kPi : 2.0 / kPi; }

double SteepEnough(double mu) {
  constexpr double kFlattest = 1e-6;
  return std::abs(mu) < kFlattest ? kFlattest : mu;
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace

LayerField LayerField::UnderSun(const LayerStack& stack, double mu_s) {
  if (!(mu_s > 0.0 && mu_s <= 1.0)) {
    throw InputError("mu_s is " + EnsuredText(mu_s) + "; it must lie in (0, 1]");
  }
  LayerField field(stack);
  field.mu_s_ = mu_s;
  for (int m = 0; m < stack.modes(); ++m) field.AddSunnyMode(m);
  return field;
}

LayerField LayerField::UnderUniformSky(const LayerStack& stack) {
  LayerField field(stack);
  field.from_above_ = 1.0;
  field.AddMode(0, {.from_above = stack.unit_light()}, std::vector<Solved>(stack.size()));
  return field;
}

LayerField LayerField::UnderSky(const LayerStack& stack,
                                const std::function<double(const LightWay&)>& sky) {
  LayerField field(stack);
  const StreamSet& streams = stack.streams();
  // The rule integrates the cosines of all modes: it has four nodes more than there are streams.
  const GaussRule& rule = GaussLegendre(std::min(streams.streams() + 4, kMaxGaussNodes));
  for (int m = 0; m < stack.modes(); ++m) {
    std::vector<double> from_above(streams.size(), 0.0);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      for (std::size_t k = 0; k < rule.node.size(); ++k) {
        const double azimuth = kPi * rule.node[k];
        from_above[i] += (m == 0 ? 1.0 : 2.0) * rule.weight[k] * std::cos(m * azimuth) *
                         sky({-streams.mu(i), azimuth}) * stack.unit_light()[i];
      }
    }
    field.AddMode(m, {.from_above = from_above}, std::vector<Solved>(stack.size()));
  }
  return field;
}

LayerField LayerField::OverUniformGround(const LayerStack& stack) {
  LayerField field(stack);
  field.of_ground_ = 1.0;
  field.AddMode(0, {.of_ground = stack.unit_light()}, std::vector<Solved>(stack.size()));
  return field;
}

double LayerField::BeamIn(double depth) const { return mu_s_ ? std::exp(-depth / *mu_s_) : 0.0; }
double LayerField::BeamAbove(std::size_t layer) const { return BeamIn(stack_.ScaledAbove(layer)); }

LayerField::Solved LayerField::Sunny(const LayerMode& mode, std::size_t layer, int m) const {
  const EvenAndOdd emission =
      mode.EmissionAt(AssociatedLegendre(m, stack_.streams().streams() - 1, *mu_s_));
  const double factor = AzimuthFactor(m) * BeamAbove(layer), rate = 1.0 / *mu_s_;
  Solved solved;
  for (std::size_t j = 0; j < mode.decay().size(); ++j) {
    solved.decay.push_back(ApartFrom(mode.decay()[j], rate));
    solved.source.push_back(factor * (emission.even[j] + emission.odd[j] * rate));
    solved.shift.push_back(-factor * emission.odd[j]);
  }
  return solved;
}

// With a = 0 at both ends, half of o leaves the layer and half of -o enters it. What enters is taken
// back with all that it causes.
LayerField::Leaving LayerField::LeavingSunny(const LayerMode& mode, const Solved& solved,
                                             double depth) const {
  const double rate = 1.0 / *mu_s_, beam = BeamIn(depth);
  std::vector<double> top, bottom;  // a' + g e^(-tau / mu_s), halved
  for (std::size_t j = 0; j < solved.decay.size(); ++j) {
    const double k = solved.decay[j];
    const EndSlopes ends = k == mode.decay()[j] ? mode.end_slopes()[j] : EndSlopesOf(k, depth);
    const double particular = solved.source[j] / (k * k - rate * rate);
    top.push_back(0.5 * (solved.shift[j] - particular * (rate - ends.own + beam * ends.other)));
    bottom.push_back(
        0.5 * (solved.shift[j] * beam - particular * (rate * beam - ends.other + beam * ends.own)));
  }
  const std::vector<double> o_top = mode.odd() * top, o_bottom = mode.odd() * bottom;
  Leaving leaving{mode.reflection() * o_top, mode.transmission() * o_top};
  const std::vector<double> up = mode.transmission() * o_bottom;
  const std::vector<double> down = mode.reflection() * o_bottom;
  for (std::size_t i = 0; i < o_top.size(); ++i) {
    leaving.up[i] += o_top[i] - up[i];
    leaving.down[i] -= o_bottom[i] + down[i];
  }
  return leaving;
}

void LayerField::AddSunnyMode(int m) {
  std::vector<Solved> solved;
  ModeSources sources;
  for (std::size_t n = 0; n < stack_.size(); ++n) {
    const LayerMode& mode = stack_.mode(m, n);
    const double depth = stack_.scaled(n).depth;
    solved.push_back(Sunny(mode, n, m));
    const std::vector<double> none(mode.decay().size(), 0.0);
    Leaving leaving = depth > 0.0 ? LeavingSunny(mode, solved.back(), depth) : Leaving{none, none};
    sources.up.push_back(std::move(leaving.up));
    sources.down.push_back(std::move(leaving.down));
  }
  if (m == 0) {
    sources.of_ground = Scaled(stack_.unit_light(),
                               stack_.ground_albedo() / kPi * *mu_s_ * BeamAbove(stack_.size()));
  }
  AddMode(m, sources, std::move(solved));
}

void LayerField::AddMode(int m, const ModeSources& sources, std::vector<Solved> solved) {
  const std::vector<InterfaceLight> light = stack_.Solve(m, sources);
  for (std::size_t n = 0; n < stack_.size(); ++n) {
    const LayerMode& mode = stack_.mode(m, n);
    const auto amplitudes = [&](const InterfaceLight& at) {
      std::vector<double> even = at.up, odd = at.up;
      for (std::size_t i = 0; i < even.size(); ++i) {
        even[i] += at.down[i];
        odd[i] -= at.down[i];
      }
      return Amplitudes{mode.odd().TransposedTimes(even), mode.even().TransposedTimes(odd)};
    };
    Solved& layer = solved[n];
    layer.top = amplitudes(light[n]);
    layer.bottom = amplitudes(light[n + 1]);
    if (layer.decay.empty()) layer.decay = mode.decay();
    layer.source.resize(layer.decay.size(), 0.0);
    layer.shift.resize(layer.decay.size(), 0.0);
  }
  solved_.push_back(std::move(solved));
}

bool LayerField::IsThin(double decay, double depth) const {
  constexpr double kLinear = 1e-3;
  return std::max(decay, mu_s_ ? 1.0 / *mu_s_ : 0.0) * depth < kLinear;
}

LayerField::Amplitudes LayerField::At(const Solved& layer, const LayerPlace& place) const {
  const double depth = stack_.scaled(place.layer).depth;
  const double share = depth > 0.0 ? place.depth / depth : 0.0;
  const double beam = BeamIn(place.depth), beam_below = BeamIn(depth);
  Amplitudes at;
  for (std::size_t j = 0; j < layer.decay.size(); ++j) {
    const double k = layer.decay[j], top = layer.top.value[j], bottom = layer.bottom.value[j];
    if (IsThin(k, depth)) {
      at.value.push_back(std::lerp(top, bottom, share));
      at.slope.push_back(std::lerp(layer.top.slope[j], layer.bottom.slope[j], share));
      continue;
    }
    const HyperbolicPair pair = HyperbolicsAt(k, depth, place.depth);
    double value = top * pair.falling + bottom * pair.rising;
    double slope = top * pair.falling_slope + bottom * pair.rising_slope;
    if (mu_s_) {
      const double rate = 1.0 / *mu_s_, particular = layer.source[j] / (k * k - rate * rate);
      value += particular * (beam - pair.falling - beam_below * pair.rising);
      slope += layer.shift[j] * beam -
               particular * (rate * beam + pair.falling_slope + beam_below * pair.rising_slope);
    }
    at.value.push_back(value);
    at.slope.push_back(slope);
  }
  return at;
}

LayerFluxes LayerField::Fluxes(double depth) const {
  const LayerPlace place = PlaceAtDepth(stack_, depth);
  const LayerMode& mode = stack_.mode(0, place.layer);
  const Amplitudes at = At(solved_[0][place.layer], place);
  const std::vector<double> even = mode.even() * at.value, odd = mode.odd() * at.slope;
  LayerFluxes fluxes{};
  for (std::size_t i = 0; i < even.size(); ++i) {
    fluxes.up += kPi * stack_.unit_light()[i] * (even[i] + odd[i]);
    fluxes.down += kPi * stack_.unit_light()[i] * (even[i] - odd[i]);
  }
  if (!mu_s_) return fluxes;
  // Light in the peak is diffuse light.
  fluxes.direct = *mu_s_ * BeamIn(depth);
  fluxes.down += *mu_s_ * BeamAbove(place.layer) * BeamIn(place.depth) - fluxes.direct;
  return fluxes;
}

double LayerField::Radiance(double depth, const LightWay& way) const {
  const LightWay steep{SteepEnough(RequireInRange(way.mu, -1.0, 1.0, "mu")), way.azimuth};
  const std::vector<LineSegment> line = LineOfSight(stack_, PlaceAtDepth(stack_, depth), steep.mu);
  return AlongLine(line, steep) + (mu_s_ ? SunScatteredOnce(stack_, *mu_s_, line, steep) : 0.0);
}

double LayerField::RadianceOfHigherOrders(double depth, const LightWay& way) const {
  const LightWay steep{SteepEnough(RequireInRange(way.mu, -1.0, 1.0, "mu")), way.azimuth};
  return AlongLine(LineOfSight(stack_, PlaceAtDepth(stack_, depth), steep.mu), steep);
}

double LayerField::AlongLine(const std::vector<LineSegment>& line, const LightWay& way) const {
  double sum = 0.0;
  for (const LineSegment& segment : line) {
    if (!(segment.to > segment.from)) continue;
    for (std::size_t m = 0; m < solved_.size(); ++m) {
      sum += segment.left * std::cos(static_cast<double>(m) * way.azimuth) *
             InSegment(static_cast<int>(m), segment, way.mu);
    }
  }
  const LineSegment& last = line.back();
  return sum + last.left * std::exp(-(last.to - last.from) / std::abs(way.mu)) * Behind(way.mu);
}

std::vector<double> LayerField::SourceOfHigherOrders(double depth) const {
  const LayerPlace place = PlaceAtDepth(stack_, depth);
  std::vector<double> source;
  for (std::size_t m = 0; m < solved_.size(); ++m) {
    const Amplitudes at = At(solved_[m][place.layer], place);
    const std::vector<double> of_mode =
        stack_.mode(static_cast<int>(m), place.layer).SourceOf(at.value, at.slope);
    source.insert(source.end(), of_mode.begin(), of_mode.end());
  }
  return source;
}

double LayerField::Behind(double mu) const {
  if (mu < 0.0) return from_above_;
  const LayerFluxes fluxes = Fluxes(stack_.DepthAbove(stack_.size()));
  return of_ground_ + stack_.ground_albedo() / kPi * (fluxes.down + fluxes.direct);
}

double LayerField::InSegment(int m, const LineSegment& segment, double mu) const {
  const Solved& layer = solved_[static_cast<std::size_t>(m)][segment.layer];
  const Amplitudes from = At(layer, {segment.layer, segment.from});
  const Amplitudes to = At(layer, {segment.layer, segment.to});
  const EvenAndOdd emission =
      stack_.mode(m, segment.layer)
          .EmissionAt(AssociatedLegendre(m, stack_.streams().streams() - 1, mu));
  const double length = segment.to - segment.from;
  double sum = 0.0;
  for (std::size_t j = 0; j < layer.decay.size(); ++j) {
    const double k = layer.decay[j];
    const double s = std::copysign(ApartFrom(1.0 / std::abs(mu), k), mu);
    // The weight is 1 at the end that is nearer to the eye.
    const double far = std::exp(-std::abs(s) * length);
    const double w_from = s > 0.0 ? 1.0 : far, w_to = s > 0.0 ? far : 1.0;
    const double ends = w_to * to.value[j] - w_from * from.value[j];
    const double slopes = w_to * to.slope[j] - w_from * from.slope[j];
    if (IsThin(std::max(k, std::abs(s)), length)) {
      sum += 0.5 * length *
             (emission.even[j] * (w_to * to.value[j] + w_from * from.value[j]) +
              emission.odd[j] * (w_to * to.slope[j] + w_from * from.slope[j]));
      continue;
    }
    const double rate = s + (mu_s_ ? 1.0 / *mu_s_ : 0.0);
    const double beam =
        ExponentialIntegral(w_from * BeamIn(segment.from), w_to * BeamIn(segment.to), rate, length);
    const double of_value =
        (slopes + s * ends + (layer.source[j] + layer.shift[j] * rate) * beam) / (k * k - s * s);
    const double of_slope = ends + s * of_value + layer.shift[j] * beam;
    sum += emission.even[j] * of_value + emission.odd[j] * of_slope;
  }
  return sum / std::abs(mu);
}

}  // namespace alpenglow::renderer
