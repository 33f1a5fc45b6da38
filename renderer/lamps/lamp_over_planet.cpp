// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_over_planet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"

namespace alpenglow::renderer {
namespace {

/// The densities of the layers at a point, relative to those at their bases, and the logarithms.
struct LayerDensities {
  std::array<double, kMostLampLayers> log{}, value{};
};
using LayerColumns = std::array<double, kMostLampLayers>;

class RayOverPlanet {
 public:
  RayOverPlanet(const LampOverPlanet& at, const glm::dvec3& direction)
      : at_(at),
        direction_(direction),
        centre_m_(0.0, 0.0, -(at.planet_radius_m + at.point_altitude_m)),
        nearest_m_(glm::dot(at.to_lamp_m, direction)),
        approach_m_(std::max(glm::length(nearest_m_ * direction - at.to_lamp_m), kNearest_m)),
        at_lamp_(DensitiesAt(at.to_lamp_m)) {
    ALPENGLOW_ENSURE(at.layers.size(), <=, kMostLampLayers);
  }

  [[nodiscard]] SpectrumOf<double> Light() const {
    SpectrumOf<double> sum(at_.layers.front().scattering_per_m.size());
    const double end = End(), begin = Dawn(end);
    const std::vector<double> cuts = Cuts(begin, end);
    const GaussRule& rule = GaussLegendre(3);
    double t_before = begin;
    LayerDensities before = DensitiesAt(begin * direction_);
    LayerColumns column{};
    AddColumns({glm::dvec3(0.0), DensitiesAt(glm::dvec3(0.0))}, {begin * direction_, before},
               column);
    for (std::size_t piece = 0; piece + 1 < cuts.size(); ++piece) {
      const double width = cuts[piece + 1] - cuts[piece];
      for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double t = cuts[piece] + width * rule.node[i];
        const LayerDensities here = DensitiesAt(t * direction_);
        AddColumn(t - t_before, before, here, column);
        if (!IsShaded(t)) Scatter(t, here, column, rule.weight[i] * width, sum);
        before = here;
        t_before = t;
      }
    }
    return sum;
  }

 private:
  /// Lengths of the first pieces of a ray, and the ratio of each piece to the one before.
  static constexpr double kFirst_m = 300.0, kGrowth = 2.5;
  static constexpr double kNearest_m = 1.0;

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const {
    return glm::length(point - centre_m_) - at_.planet_radius_m;
  }
  [[nodiscard]] double GroundRadius() const { return at_.planet_radius_m + at_.ground_altitude_m; }

  // A ray ends at the ground, or where the lamp's light along it is negligible.
  [[nodiscard]] double End() const {
    const double end = 4.0 * glm::length(at_.to_lamp_m) + 20e3;
    const double down = glm::dot(centre_m_, direction_);
    const double aside = glm::length(centre_m_ - down * direction_);
    if (down <= 0.0 || aside >= GroundRadius()) return end;
    const double half = std::sqrt((GroundRadius() - aside) * (GroundRadius() + aside));
    return std::clamp(down - half, 0.0, end);
  }

  // Returns whether the planet shades a point of the ray from the lamp.
  [[nodiscard]] bool IsShaded(double t) const {
    const glm::dvec3 way = t * direction_ - at_.to_lamp_m;
    const glm::dvec3 to_centre = centre_m_ - at_.to_lamp_m;
    const double length = glm::length(way);
    const double along = glm::dot(to_centre, way) / length;
    if (along <= 0.0 || along >= length) return false;
    return glm::length(to_centre - along / length * way) < GroundRadius();
  }

  // Returns where the ray leaves the shadow of the planet in which it begins: its end if it does
  // not, 0 if it begins in the light.
  [[nodiscard]] double Dawn(double end) const {
    if (!IsShaded(0.0) || IsShaded(end)) return IsShaded(0.0) ? end : 0.0;
    double low = 0.0, high = end;
    for (int i = 0; i < 24; ++i) {
      const double middle = 0.5 * (low + high);
      (IsShaded(middle) ? low : high) = middle;
    }
    return high;
  }

  // Pieces are short where the ray begins to be lit, and before and behind the point nearest to the
  // lamp.
  [[nodiscard]] std::vector<double> Cuts(double begin, double end) const {
    std::vector<double> cuts{begin};
    const auto add = [&](double from, double to, double first) {
      for (double step = first; from + step < to; step *= kGrowth) cuts.push_back(from + step);
    };
    const double first = std::min(kFirst_m, approach_m_);
    if (nearest_m_ > begin && nearest_m_ < end) {
      const double middle = 0.5 * (begin + nearest_m_);
      add(begin, middle, kFirst_m);
      const std::size_t half = cuts.size();
      for (double step = first; step < nearest_m_ - middle; step *= kGrowth)
        cuts.push_back(nearest_m_ - step);
      std::reverse(cuts.begin() + static_cast<std::ptrdiff_t>(half), cuts.end());
      cuts.push_back(nearest_m_);
      add(nearest_m_, end, first);
    } else {
      add(begin, end, kFirst_m);
    }
    cuts.push_back(end);
    return cuts;
  }

  [[nodiscard]] LayerDensities DensitiesAt(const glm::dvec3& point) const {
    LayerDensities densities;
    const double altitude = AltitudeOf(point);
    for (std::size_t k = 0; k < at_.layers.size(); ++k) {
      densities.log[k] = at_.layers[k].LogDensity(altitude);
      densities.value[k] = std::exp(densities.log[k]);
    }
    return densities;
  }

  void AddColumn(double length_m, const LayerDensities& a, const LayerDensities& b,
                 LayerColumns& sum) const {
    for (std::size_t k = 0; k < at_.layers.size(); ++k)
      sum[k] += ExponentialColumn(length_m, a.value[k], b.value[k], a.log[k] - b.log[k]);
  }

  struct PointInLayers {
    glm::dvec3 point;
    LayerDensities densities;
  };
  void AddColumns(const PointInLayers& from, const PointInLayers& to, LayerColumns& sum) const {
    constexpr double kPiece_m = 25e3;
    constexpr int kMostPieces = 16;
    const glm::dvec3 way = to.point - from.point;
    const double length = glm::length(way);
    const int pieces = std::clamp(static_cast<int>(std::ceil(length / kPiece_m)), 1, kMostPieces);
    LayerDensities before = from.densities;
    for (int i = 1; i <= pieces; ++i) {
      const LayerDensities next =
          i == pieces ? to.densities
                      : DensitiesAt(from.point + static_cast<double>(i) / pieces * way);
      AddColumn(length / pieces, before, next, sum);
      before = next;
    }
  }

  // Adds the light that a piece of the ray scatters, dimmed by the air.
  void Scatter(double t, const LayerDensities& here, LayerColumns column, double length_m,
               SpectrumOf<double>& sum) const {
    const glm::dvec3 way = t * direction_ - at_.to_lamp_m;
    const double far = std::max(glm::length(way), kNearest_m);
    AddColumns({at_.to_lamp_m, at_lamp_}, {t * direction_, here}, column);
    const double from_lamp = length_m / (far * far);
    std::array<double, kMostLampLayers> scattered{};
    for (std::size_t k = 0; k < at_.layers.size(); ++k) {
      scattered[k] =
          from_lamp * here.value[k] * Phase(at_.layers[k].phase, -glm::dot(way, direction_) / far);
    }
    for (std::size_t band = 0; band < sum.size(); ++band) {
      double depth = 0.0, source = 0.0;
      for (std::size_t k = 0; k < at_.layers.size(); ++k) {
        depth += at_.layers[k].extinction_per_m[band] * column[k];
        source += at_.layers[k].scattering_per_m[band] * scattered[k];
      }
      sum[band] += source * std::exp(-depth);
    }
  }

  const LampOverPlanet& at_;
  glm::dvec3 direction_, centre_m_;
  double nearest_m_, approach_m_;
  LayerDensities at_lamp_;
};

}  // namespace

SpectrumOf<double> AirlightOverPlanet(const LampOverPlanet& at, const glm::dvec3& direction) {
  return RayOverPlanet(at, direction).Light();
}

}  // namespace alpenglow::renderer
