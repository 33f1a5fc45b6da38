// SPDX-License-Identifier: MIT
#include "renderer/layers/first_order.h"

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "atmosphere/math/numerics.h"
#include "renderer/layers/peak_series.h"

namespace alpenglow::renderer {
namespace {

/// The line of sight of one way, under one sun.
class SunlitLine {
 public:
  SunlitLine(const LayerStack& stack, double mu_s, const std::vector<LineSegment>& line,
             const LightWay& way)
      : stack_(stack),
        line_(line),
        mu_s_(mu_s),
        mu_(way.mu),
        rate_(1.0 / mu_s + 1.0 / way.mu),
        phase_(stack, CosineToSun(mu_s, way)) {}

  [[nodiscard]] double Radiance() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (line_[i].to > line_[i].from) sum += Weight(line_[i]) * MeanPhase(i);
    }
    return sum / std::abs(mu_);
  }

 private:
  static double CosineToSun(double mu_s, const LightWay& way) {
    const double sines = std::sqrt((1.0 - way.mu * way.mu) * (1.0 - mu_s * mu_s));
    return sines * std::cos(way.azimuth) - way.mu * mu_s;
  }

  [[nodiscard]] double FromEye(const LineSegment& segment, double depth) const {
    return (mu_ > 0.0 ? depth - segment.from : segment.to - depth) / std::abs(mu_);
  }

  /// Returns the integral of both exponentials over a segment, times the scattering.
  [[nodiscard]] double Weight(const LineSegment& segment) const {
    const auto light = [&](double depth) {
      const double to_sun = (stack_.ScaledAbove(segment.layer) + depth) / mu_s_;
      return std::exp(-to_sun - FromEye(segment, depth));
    };
    const double scattering =
        stack_.optics(segment.layer).albedo / stack_.scaled(segment.layer).scale;
    return scattering * segment.left *
           ExponentialIntegral(light(segment.from), light(segment.to), rate_,
                               segment.to - segment.from);
  }

  /// Returns p_eff over a segment, weighted by the light that arrives at the eye.
  [[nodiscard]] double MeanPhase(std::size_t number) const {
    if (!phase_.HasPeaks()) return phase_.At(line_[number].layer, {});
    const LineSegment& segment = line_[number];
    const GaussRule& rule = GaussLegendre(8);
    double mean = 0.0;
    for (std::size_t node = 0; node < rule.node.size(); ++node) {
      const double in = InFromBrightEnd(segment.to - segment.from, rule.node[node]);
      const double depth = rate_ > 0.0 ? segment.from + in : segment.to - in;
      mean += rule.weight[node] * phase_.At(segment.layer, PeakDepths(number, depth));
    }
    return mean;
  }

  /// Returns the distance from the end that sends most light, within which a fraction of the light
  /// arises.
  [[nodiscard]] double InFromBrightEnd(double length, double fraction) const {
    const double rate = std::abs(rate_);
    if (rate * length < 1e-9) return length * fraction;
    return -std::log1p(fraction * std::expm1(-rate * length)) / rate;
  }

  /// Returns w f tau of every layer from the sun to a depth in a segment and on to the eye.
  [[nodiscard]] std::vector<double> PeakDepths(std::size_t number, double depth) const {
    const LineSegment& segment = line_[number];
    std::vector<double> along(stack_.size(), 0.0);
    for (std::size_t n = 0; n < segment.layer; ++n) along[n] = stack_.scaled(n).depth / mu_s_;
    along[segment.layer] = depth / mu_s_ + FromEye(segment, depth);
    for (std::size_t i = 0; i < number; ++i) {
      along[line_[i].layer] += (line_[i].to - line_[i].from) / std::abs(mu_);
    }
    for (std::size_t n = 0; n < along.size(); ++n) {
      if (along[n] > 0.0) {
        along[n] *= stack_.optics(n).albedo * stack_.scaled(n).peak / stack_.scaled(n).scale;
      }
    }
    return along;
  }

  const LayerStack& stack_;
  const std::vector<LineSegment>& line_;
  double mu_s_, mu_;
  double rate_;  // of both exponentials, per depth
  PeakSeries phase_;
};

}  // namespace

double AzimuthFromBeam(const glm::dvec3& ray, const glm::dvec3& to_sun) {
  const glm::dvec2 a(ray), b(to_sun);
  return std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
}

double SunScatteredOnce(const LayerStack& stack, double mu_s, const std::vector<LineSegment>& line,
                        const LightWay& way) {
  return SunlitLine(stack, mu_s, line, way).Radiance();
}

}  // namespace alpenglow::renderer
