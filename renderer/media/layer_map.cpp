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
#include "renderer/layers/layer_beam.h"
#include "renderer/media/layer_light.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kPeakNodes = 4;
enum Quantity : std::size_t { kBeam, kGlow = kPeakNodes, kSkyLight, kQuantities };
static_assert(kQuantities == LayerMap::kQuantities);

glm::vec4 InFloats(const Spectrum& light) {
  glm::vec4 values(0.0F);
  for (std::size_t band = 0; band < light.size(); ++band) {
    values[static_cast<glm::length_t>(band)] = light[band];
  }
  return values;
}

/// Lagrange's polynomials of e^(-x / X) through four depths x_k of the forward peak.
class PeakNodes {
 public:
  // Light that passed the depth x is attenuated by e^(-x s / (1 - s)), which is e^-5 at the deepest
  // node. There e^(-x / X) is e^-8/3: functions e^(-x a) with a of 0, 1/3, 2/3 and 1 are exact for a
  // depth of 8.
  explicit PeakNodes(double peak_scale) {
    constexpr double kSpan = 8.0 / 3.0;
    per_depth_ = kSpan / std::clamp(5.0 * (1.0 - peak_scale) / peak_scale, 1.0, 60.0);
    for (std::size_t k = 0; k < kPeakNodes; ++k) {
      const double chebyshev = std::cos(kPi * (static_cast<double>(k) + 0.5) / kPeakNodes);
      node_[k] = std::lerp(std::exp(-kSpan), 1.0, 0.5 + 0.5 * chebyshev);
    }
  }

  [[nodiscard]] double Depth(std::size_t k) const { return -std::log(node_[k]) / per_depth_; }

  [[nodiscard]] std::array<double, kPeakNodes> WeightsAt(double depth) const {
    const double at = std::exp(-depth * per_depth_);
    std::array<double, kPeakNodes> weights{};
    for (std::size_t k = 0; k < kPeakNodes; ++k) {
      weights[k] = 1.0;
      for (std::size_t j = 0; j < kPeakNodes; ++j) {
        if (j != k) weights[k] *= (at - node_[j]) / (node_[k] - node_[j]);
      }
    }
    return weights;
  }

 private:
  double per_depth_;  // 1 / X
  std::array<double, kPeakNodes> node_{};
};

/// The quantities, at one place of a ray or summed from the eye on.
using Quantities = std::array<glm::vec4, kQuantities>;

class LayerMarch {
 public:
  LayerMarch(const ExponentialLayer& layer, const SolvedAir& air, const EyeUnderLight& under)
      : layer_(layer),
        air_(air),
        under_(under),
        radius_m_(air.medium().planet_radius_m),
        eye_(0.0, 0.0, std::max(under.altitude_m, 0.0)),
        light_(layer, air.multiple_scattering(), under.light,
               SunInAir({0.0, 0.0, layer.HeadAltitude()}), LightPastClouds::Clear(air.bands())),
        nodes_(light_.beam().peak_scale()) {}

  [[nodiscard]] const LayerLight& light() const { return light_; }

  /// Returns u_k of a scattering angle.
  [[nodiscard]] glm::vec4 PhaseAt(double cos_scattering) const {
    const LayerBeam::Angle angle = light_.beam().AtAngle(cos_scattering);
    glm::vec4 phase(0.0F);
    for (std::size_t k = 0; k < kPeakNodes; ++k) {
      phase[static_cast<glm::length_t>(k)] = static_cast<float>(angle.At(nodes_.Depth(k)));
    }
    return phase;
  }

  /// Returns the quantities at fractions i / (depths - 1) of the light that the layer removes along
  /// the whole ray.
  [[nodiscard]] std::vector<Quantities> Along(const glm::dvec3& direction, int depths) const {
    const std::vector<Step> steps = StepsOf(direction);
    if (steps.empty()) return std::vector<Quantities>(static_cast<std::size_t>(depths));
    const LayerLight::Look look = light_.LookAlong(direction);
    std::vector<Quantities> light;
    for (const Step& step : steps) light.push_back(SourceAt(step, direction, look));
    std::vector<Quantities> nodes(static_cast<std::size_t>(depths), light.front());
    const double whole =
        layer_.optics().extinction_per_m[0] * layer_.Column(eye_, direction, EndOf(direction));
    for (std::size_t q = 0; q < kQuantities; ++q) {
      const double scale = q < kGlow ? light_.beam().peak_scale() : 1.0;
      SumUp(steps, light, {q, scale, -std::expm1(-scale * whole)}, nodes);
    }
    return nodes;
  }

 private:
  struct Step {
    double middle_m;
    double middle_depth, depth;  // optical depths from the eye to its middle and its end
  };

  /// One of the quantities.
  struct Summed {
    std::size_t number;
    double scale;  // of optical depths
    double whole;  // fraction of light that the layer removes along the whole ray
  };

  /// Replaces a quantity of every node but the first by its mean from the eye to there.
  static void SumUp(const std::vector<Step>& steps, const std::vector<Quantities>& light,
                    const Summed& of, std::vector<Quantities>& nodes) {
    const auto at = [&](std::size_t i) {
      return of.whole * static_cast<double>(i) / (static_cast<double>(nodes.size()) - 1.0);
    };
    glm::vec4 sum(0.0F);
    double taken = 0.0;
    std::size_t node = 1;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const glm::vec4& here = light[i][of.number];
      const double next = -std::expm1(-of.scale * steps[i].depth);
      for (; node < nodes.size() && at(node) <= next; ++node) {
        const glm::vec4 upto = sum + static_cast<float>(at(node) - taken) * here;
        nodes[node][of.number] = upto / static_cast<float>(at(node));
      }
      sum += static_cast<float>(next - taken) * here;
      taken = next;
    }
    for (; node < nodes.size(); ++node) {
      nodes[node][of.number] = sum / static_cast<float>(at(node));
    }
  }

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

  // Returns steps up to the distance at which MarchMedia takes the layer for opaque. They are so short
  // that neither the light in the layer nor its density changes much within one.
  [[nodiscard]] std::vector<Step> StepsOf(const glm::dvec3& direction) const {
    constexpr double kDepth = 0.1, kFall = 0.25, kOpaque = 13.9;
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
        const double before = tau;
        tau += step * extinction *
               (layer_.DensityAt(point) + 4.0 * layer_.DensityAt(eye_ + middle * direction) +
                layer_.DensityAt(eye_ + (t + step) * direction)) /
               6.0;
        steps.push_back({middle, 0.5 * (before + tau), tau});
        t += step;
        if (piece.end_m - t < kShortest_m) break;
      }
    }
    return steps;
  }

  // Returns the light scattered at this step, attenuated by the air in front of it.
  [[nodiscard]] Quantities SourceAt(const Step& step, const glm::dvec3& direction,
                                    const LayerLight::Look& look) const {
    const glm::dvec3 point = eye_ + step.middle_m * direction;
    const LayerBeam& beam = light_.beam();
    const double to_sun =
        layer_.optics().extinction_per_m[0] * layer_.ColumnToSpace(point, under_.light.seen);
    const LayerLight::Glow glow = light_.GlowAt(look, AltitudeOverSphere(point, radius_m_));
    const double albedo = layer_.optics().scattering_per_m[0] / layer_.optics().extinction_per_m[0];
    ViewRay ray{eye_.z, direction.z, 0.0, 0.0};
    ray.length_m = step.middle_m;
    ray.passes_ground = true;
    const Spectrum left =
        static_cast<float>(albedo) * air_.single_scattering().TransmittanceAlong(ray);
    Quantities source{};
    source[kGlow] = InFloats(left * glow.of_sun);
    source[kSkyLight] = InFloats(left * glow.of_sky);
    // Per fraction of the light that the layer removes without its forward peak.
    const double once = std::exp(-beam.peak_scale() * to_sun) / beam.peak_scale();
    const glm::vec4 sun = InFloats(static_cast<float>(once) * left * SunInAir(point));
    const auto weights = nodes_.WeightsAt(beam.PeakDepth(to_sun + step.middle_depth));
    for (std::size_t k = 0; k < kPeakNodes; ++k) {
      source[kBeam + k] = static_cast<float>(weights[k]) * sun;
    }
    return source;
  }

  const ExponentialLayer& layer_;
  SolvedAir air_;
  EyeUnderLight under_;
  double radius_m_;
  glm::dvec3 eye_;
  LayerLight light_;
  PeakNodes nodes_;
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
  const auto at = [&](std::size_t quantity, int depth, int azimuth, int elevation) {
    const auto of = [](int value) { return static_cast<std::size_t>(value); };
    return ((quantity * of(size.depths) + of(depth)) * of(size.azimuths) + of(azimuth)) *
               of(size.elevations) +
           of(elevation);
  };
  map.light.resize(at(kQuantities, 0, 0, 0));
  for (int azimuth = 0; azimuth < size.azimuths; ++azimuth) {
    const double turn = sun_azimuth + kPi * azimuth / (size.azimuths - 1.0);
    for (int elevation = 0; elevation < size.elevations; ++elevation) {
      const double sine = ElevationSine(elevation / (size.elevations - 1.0));
      const double cosine = std::sqrt(std::max(1.0 - sine * sine, 0.0));
      const std::vector<Quantities> nodes =
          march.Along({cosine * std::cos(turn), cosine * std::sin(turn), sine}, size.depths);
      for (int depth = 0; depth < size.depths; ++depth) {
        for (std::size_t q = 0; q < kQuantities; ++q) {
          map.light[at(q, depth, azimuth, elevation)] = nodes[static_cast<std::size_t>(depth)][q];
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
  LayerMap map;
  map.eye = under;
  map.size = size;
  map.extinction_per_m = layer.optics().extinction_per_m[0];
  map.scale_height_m = layer.scale_height_m();
  map.base_m = layer.base_m();
  map.top_m = air.medium().atmosphere_height_m;
  map.radius_m = air.medium().planet_radius_m;
  map.depth = map.extinction_per_m * layer.ColumnAbove(layer.bottom_m());
  map.peak_scale = march.light().beam().peak_scale();
  for (int i = 0; i < LayerMap::kAngles; ++i) {
    map.phase.push_back(
        march.PhaseAt(std::cos(kPi * std::pow(i / (LayerMap::kAngles - 1.0), 2.0))));
  }
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
