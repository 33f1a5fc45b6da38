// SPDX-License-Identifier: MIT
#include "renderer/media/layer_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/media/layer_light.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

enum Quantity { kDirect, kBroad, kGlow, kSkyLight, kQuantities };

glm::vec4 InFloats(const Spectrum& light) {
  glm::vec4 values(0.0F);
  for (std::size_t band = 0; band < light.size(); ++band) {
    values[static_cast<glm::length_t>(band)] = light[band];
  }
  return values;
}

/// The four quantities, summed from the eye on.
using Sums = std::array<glm::vec4, kQuantities>;

class LayerMarch {
 public:
  LayerMarch(const ExponentialLayer& layer, const SolvedAir& air, const EyeUnderLight& under)
      : layer_(layer),
        air_(air),
        under_(under),
        radius_m_(air.medium().planet_radius_m),
        eye_(0.0, 0.0, std::max(under.altitude_m, 0.0)),
        light_(layer, air.multiple_scattering(), under.light,
               SunInAir({0.0, 0.0, layer.HeadAltitude()})) {}

  [[nodiscard]] const LayerLight& light() const { return light_; }

  /// Returns the sums at fractions i / (depths - 1) of the light that the layer removes along the
  /// whole ray.
  [[nodiscard]] std::vector<Sums> Along(const glm::dvec3& direction, int depths) const {
    const std::vector<Step> steps = StepsOf(direction);
    std::vector<Sums> nodes(static_cast<std::size_t>(depths), Sums{});
    if (steps.empty()) return nodes;
    const double whole = steps.back().taken;
    Sums sum{}, before{};
    double taken = 0.0;
    std::size_t node = 1;
    const LayerLight::Look look = light_.LookAlong(direction);
    for (const Step& step : steps) {
      before = sum;
      const Sums here = SourceAt(step, direction, look);
      for (std::size_t q = 0; q < sum.size(); ++q) {
        sum[q] += static_cast<float>(step.taken - taken) * here[q];
      }
      if (taken == 0.0) nodes[0] = here;
      const auto at = [&](std::size_t i) {
        return whole * static_cast<double>(i) / (depths - 1.0);
      };
      for (; node < nodes.size() && at(node) <= step.taken * (1.0 + 1e-9); ++node) {
        const auto share = static_cast<float>((at(node) - taken) / (step.taken - taken));
        for (std::size_t q = 0; q < sum.size(); ++q) {
          nodes[node][q] =
              (before[q] + share * (sum[q] - before[q])) / static_cast<float>(at(node));
        }
      }
      taken = step.taken;
    }
    return nodes;
  }

 private:
  struct Step {
    double middle_m;
    double taken;  // fraction of light that the layer removes up to the end of this step
  };

  [[nodiscard]] Spectrum SunInAir(const glm::dvec3& point) const {
    const double altitude = std::max(AltitudeOverSphere(point, radius_m_), 0.0);
    const glm::dvec3 up = glm::normalize(point + glm::dvec3(0.0, 0.0, radius_m_));
    const double mu_s = std::clamp(glm::dot(up, under_.light.seen), -1.0, 1.0);
    const VisibleDisk disk =
        DiskOverHorizon(mu_s, shared::HorizonCosine(altitude, radius_m_), under_.radius_rad);
    if (disk.fraction <= 0.0) return Spectrum(air_.bands());
    return static_cast<float>(disk.fraction) * air_.BeamLeft(altitude, disk.mu_s_effective);
  }

  [[nodiscard]] double EndOf(const glm::dvec3& direction) const {
    if (shared::GroundClearance(eye_.z, direction.z, radius_m_) <= 0.0) {
      return std::numeric_limits<double>::infinity();
    }
    return shared::DistanceDownTo(eye_.z, direction.z, 0.0, radius_m_);
  }

  // Returns steps up to the distance at which the layer is opaque, so short that neither the light in
  // the layer nor its density changes much within one.
  [[nodiscard]] std::vector<Step> StepsOf(const glm::dvec3& direction) const {
    constexpr double kDepth = 0.1, kFall = 0.25, kOpaque = 12.0;
    constexpr double kShortest_m = 0.01;
    const double extinction = layer_.optics().extinction_per_m[0];
    std::vector<Step> steps;
    double tau = 0.0;
    for (const DensePiece& piece : layer_.PiecesAlong(eye_, direction, EndOf(direction))) {
      for (double t = piece.begin_m; t < piece.end_m && tau < kOpaque;) {
        const glm::dvec3 point = eye_ + t * direction;
        const double rise =
            glm::dot(direction, glm::normalize(point + glm::dvec3(0, 0, radius_m_)));
        const double per_m = extinction * layer_.DensityAt(point);
        const double h = layer_.scale_height_m();
        const double by_fall =
            std::isinf(h) ? piece.end_m : kFall * h / std::max(std::abs(rise), 1e-3);
        double step = std::min({kDepth / per_m, by_fall, 0.05 * (piece.end_m - piece.begin_m)});
        step = std::min(std::max(step, kShortest_m), piece.end_m - t);
        const double middle = t + 0.5 * step;
        tau += step * extinction *
               (layer_.DensityAt(point) + 4.0 * layer_.DensityAt(eye_ + middle * direction) +
                layer_.DensityAt(eye_ + (t + step) * direction)) /
               6.0;
        steps.push_back({middle, -std::expm1(-tau)});
        t += step;
        if (piece.end_m - t < kShortest_m) break;
      }
    }
    return steps;
  }

  // Returns the light scattered at this step, attenuated by the air in front of it.
  [[nodiscard]] Sums SourceAt(const Step& step, const glm::dvec3& direction,
                              const LayerLight::Look& look) const {
    const glm::dvec3 point = eye_ + step.middle_m * direction;
    const double altitude = AltitudeOverSphere(point, radius_m_);
    const double slant =
        layer_.optics().extinction_per_m[0] * layer_.ColumnToSpace(point, under_.light.seen);
    const Spectrum sun = SunInAir(point);
    Spectrum all(sun.size()), none(sun.size());
    std::ranges::fill(all.values(), 1.0F);
    const LayerLight::Scattered glow = light_.At(look, altitude, none, all, slant);
    const auto direct = static_cast<float>(std::exp(-slant));
    const auto with_peak = static_cast<float>(std::exp(-light_.peak_scale() * slant));
    const auto scattered = static_cast<float>(layer_.optics().scattering_per_m[0] /
                                              layer_.optics().extinction_per_m[0]);
    ViewRay ray{eye_.z, direction.z, 0.0, 0.0};
    ray.length_m = step.middle_m;
    ray.passes_ground = true;
    const Spectrum left = scattered * air_.single_scattering().TransmittanceAlong(ray);
    return {InFloats(direct * (left * sun)), InFloats((with_peak - direct) * (left * sun)),
            InFloats(left * glow.of_sun), InFloats(left * glow.of_sky)};
  }

  const ExponentialLayer& layer_;
  SolvedAir air_;
  EyeUnderLight under_;
  double radius_m_;
  glm::dvec3 eye_;
  LayerLight light_;
};

// Returns the sine of the elevation for a position in [0, 1] on the axis, which is dense at the
// horizontal.
double ElevationSine(double unit) {
  const double root = 2.0 * unit - 1.0;
  return root * std::abs(root);
}

void AddRays(const LayerMarch& march, LayerMap& map) {
  const LayerMapSize& size = map.size;
  const double sun_azimuth = std::atan2(map.eye.light.seen.y, map.eye.light.seen.x);
  const auto at = [&](int quantity, int depth, int azimuth, int elevation) {
    return static_cast<std::size_t>(
        ((quantity * size.depths + depth) * size.azimuths + azimuth) * size.elevations + elevation);
  };
  map.light.resize(at(kQuantities, 0, 0, 0));
  for (int azimuth = 0; azimuth < size.azimuths; ++azimuth) {
    const double turn = sun_azimuth + kPi * azimuth / (size.azimuths - 1.0);
    for (int elevation = 0; elevation < size.elevations; ++elevation) {
      const double sine = ElevationSine(elevation / (size.elevations - 1.0));
      const double cosine = std::sqrt(std::max(1.0 - sine * sine, 0.0));
      const std::vector<Sums> nodes =
          march.Along({cosine * std::cos(turn), cosine * std::sin(turn), sine}, size.depths);
      for (int depth = 0; depth < size.depths; ++depth) {
        for (int q = 0; q < kQuantities; ++q) {
          map.light[at(q, depth, azimuth, elevation)] =
              nodes[static_cast<std::size_t>(depth)][static_cast<std::size_t>(q)];
        }
      }
    }
  }
}

void AddSurfaces(const LayerMarch& march, const ExponentialLayer& layer, LayerMap& map) {
  map.on_surface.resize(2 * std::size_t{LayerMap::kHeights});
  for (int i = 0; i < LayerMap::kHeights; ++i) {
    const double share = std::pow(std::max(i / (LayerMap::kHeights - 1.0), 1e-3), 4.0);
    const double column = share * map.depth / map.extinction_per_m;
    const double altitude =
        std::isinf(layer.scale_height_m())
            ? map.top_m - column
            : map.base_m - layer.scale_height_m() * std::log(column / layer.scale_height_m());
    const glm::vec4 level = InFloats(march.light().OnSurface(altitude, 1.0));
    map.on_surface[static_cast<std::size_t>(i)] = level;
    map.on_surface[static_cast<std::size_t>(LayerMap::kHeights + i)] =
        InFloats(march.light().OnSurface(altitude, 0.0)) - level;
  }
}

}  // namespace

LayerMap MakeLayerMap(const ExponentialLayer& layer, const SolvedAir& air,
                      const EyeUnderLight& under, const LayerMapSize& size) {
  ALPENGLOW_ENSURE(air.bands(), <=, std::size_t{4});
  const LayerMarch march(layer, air, under);
  const std::vector<double> chi = LegendreCoefficients(layer.optics().phase, 2);
  LayerMap map;
  map.eye = under;
  map.size = size;
  map.extinction_per_m = layer.optics().extinction_per_m[0];
  map.scale_height_m = layer.scale_height_m();
  map.base_m = layer.base_m();
  map.top_m = air.medium().atmosphere_height_m;
  map.radius_m = air.medium().planet_radius_m;
  map.depth = map.extinction_per_m * layer.ColumnAbove(layer.bottom_m());
  map.peak_scale = march.light().peak_scale();
  map.phase = layer.optics().phase;
  map.broad_g = std::clamp(chi[1], -0.99, 0.99);
  AddRays(march, map);
  AddSurfaces(march, layer, map);
  return map;
}

bool Serves(const EyeUnderLight& made, const EyeUnderLight& wanted, double scale_height_m) {
  constexpr double kSun_rad = 0.1 * 3.14159265358979 / 180.0;
  const double step_m = 0.1 * std::min(scale_height_m, 1000.0);
  return std::abs(made.altitude_m - wanted.altitude_m) <= step_m &&
         glm::length(made.light.seen - wanted.light.seen) <= kSun_rad;
}

}  // namespace alpenglow::renderer
