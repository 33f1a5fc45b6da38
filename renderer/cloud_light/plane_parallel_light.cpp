// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/plane_parallel_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

// Rays flatter than this count as horizontal.
constexpr double kFlattestRay = 1e-6;
// A flatter beam brings no light to a layer.
constexpr double kFlattestBeam = 1e-4;
constexpr double kOpaqueDepth = 40.0;

/// Returns the mean of x in [0, depth] with the weight e^-x.
double MeanDepth(double depth) {
  if (depth < 1e-3) return 0.5 * depth;
  return 1.0 - depth * std::exp(-depth) / -std::expm1(-depth);
}

}  // namespace

PlaneParallelCloud::PlaneParallelCloud(const CloudField& field, const CloudOptics& optics)
    : depths_(field),
      albedo_(optics.albedo()),
      beam_(optics.phase(), albedo_),
      stack_({GreyLayer(optics.phase(), depths_.whole(), albedo_)}, 0.0, kLayerStreams),
      sky_(LayerField::UnderUniformSky(stack_)),
      ground_(LayerField::OverUniformGround(stack_)) {}

std::optional<PlaneParallelCloud::Crossing> PlaneParallelCloud::CrossingOf(const CloudRay& ray,
                                                                           double length_m) const {
  const double rise = ray.direction.z;
  const double reach_m = std::min(length_m, kFarthestCloud_m);
  Crossing crossing{0.0, reach_m, 0.0, 0.0};
  const bool is_flat = std::abs(rise) < kFlattestRay;
  if (is_flat) {
    if (ray.origin.z <= depths_.base_m() || ray.origin.z >= depths_.top_m()) return std::nullopt;
  } else {
    const double to_base_m = (depths_.base_m() - ray.origin.z) / rise;
    const double to_top_m = (depths_.top_m() - ray.origin.z) / rise;
    crossing.begin_m = std::max(std::min(to_base_m, to_top_m), 0.0);
    crossing.end_m = std::min(std::max(to_base_m, to_top_m), reach_m);
  }
  if (!(crossing.end_m > crossing.begin_m)) return std::nullopt;
  crossing.from = depths_.Above(ray.At(crossing.begin_m).z);
  crossing.to = depths_.Above(ray.At(crossing.end_m).z);
  crossing.along = is_flat ? depths_.Extinction_per_m(ray.origin.z) * reach_m
                           : std::abs(crossing.to - crossing.from) / std::abs(rise);
  crossing.scaled = stack_.scaled(0).scale * crossing.along;
  return crossing;
}

double PlaneParallelCloud::MeanDistance_m(const CloudRay& ray, const Crossing& crossing) const {
  if (!(crossing.along > 0.0)) return 0.0;
  const double share = MeanDepth(crossing.scaled) / crossing.scaled;
  if (std::abs(ray.direction.z) < kFlattestRay) {
    return std::lerp(crossing.begin_m, crossing.end_m, share);
  }
  const double altitude_m = depths_.AltitudeOf(std::lerp(crossing.from, crossing.to, share));
  return std::clamp((altitude_m - ray.origin.z) / ray.direction.z, crossing.begin_m,
                    crossing.end_m);
}

CloudRayParts PlaneParallelCloud::Unlit(const CloudRay& ray, const Crossing& crossing) const {
  const double left = std::exp(-crossing.scaled);
  const LightWay way{-ray.direction.z, 0.0};
  const auto between = [&](const LayerField& light) {
    const double behind = left > 0.0 ? left * light.Radiance(crossing.to, way) : 0.0;
    return std::clamp(light.Radiance(crossing.from, way) - behind, 0.0, 1.0 - left);
  };
  CloudRayParts parts;
  parts.sky = between(sky_);
  parts.ground = albedo_ < 1.0 ? between(ground_) : 1.0 - left - parts.sky;
  parts.transmittance = std::exp(-crossing.along);
  parts.scaled_transmittance = left;
  parts.mean_distance_m = MeanDistance_m(ray, crossing);
  return parts;
}

CloudRayParts PlaneParallelCloud::UnlitAlong(const CloudRay& ray, double length_m) const {
  const auto crossing = CrossingOf(ray, length_m);
  return crossing ? Unlit(ray, *crossing) : CloudRayParts{};
}

PlaneParallelSun::PlaneParallelSun(std::shared_ptr<const PlaneParallelCloud> cloud,
                                   const CloudSunDepths& to_sun)
    : cloud_(std::move(cloud)),
      to_sun_(to_sun.to_sun()),
      is_from_below_(to_sun_.z < 0.0),
      mu_s_(std::max(std::abs(to_sun_.z), kFlattestBeam)),
      left_(is_from_below_ ? to_sun.MeanTransmittance(cloud_->depths().base_m()) : 1.0),
      field_(LayerField::UnderSun(cloud_->stack(), mu_s_)) {}

double PlaneParallelSun::UpAtTop() const {
  const double depth = is_from_below_ ? cloud_->depths().whole() : 0.0;
  const LayerFluxes fluxes = field_.Fluxes(depth);
  return left_ * (is_from_below_ ? fluxes.down : fluxes.up);
}

double PlaneParallelSun::DownAtBase() const {
  const double depth = is_from_below_ ? 0.0 : cloud_->depths().whole();
  const LayerFluxes fluxes = field_.Fluxes(depth);
  return left_ * (is_from_below_ ? fluxes.up : fluxes.down);
}

void PlaneParallelSun::AddScatteredOnce(const CloudRay& ray,
                                        const PlaneParallelCloud::Crossing& lit,
                                        CloudRayParts& parts) const {
  constexpr int kNodes = 16;
  const LayerBeam& beam = cloud_->beam();
  const double scale = beam.peak_scale();
  const double rise = MuOf(ray) / mu_s_;  // depth to the sun that a unit of depth to the eye adds
  const double depth = std::min(lit.along, kOpaqueDepth / scale);
  const double begin = scale * lit.from / mu_s_;
  const double end = begin + scale * (1.0 + rise) * depth;
  // The end with more light is the origin of the exponential.
  const bool begins_bright = end >= begin;
  const double brightest = std::min(begin, end), change = std::abs(end - begin);
  const double fading = -std::expm1(-change);
  parts.once.cos_scattering = glm::dot(ray.direction, to_sun_);
  const LayerBeam::Angle angle = beam.AtAngle(parts.once.cos_scattering);
  const double weight = change > 1e-6 ? depth * fading / change : depth;
  const double light = left_ * cloud_->albedo() * weight * std::exp(-brightest);
  const GaussRule& rule = GaussLegendre(kNodes);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double share =
        change > 1e-6 ? -std::log1p(-rule.node[i] * fading) / change : rule.node[i];
    const double to_eye = depth * (begins_bright ? share : 1.0 - share);
    const double peak_depth = beam.PeakDepth(lit.from / mu_s_ + (1.0 + rise) * to_eye);
    parts.first += light * rule.weight[i] * angle.At(peak_depth);
    parts.once.Add(light * rule.weight[i] * beam.beside_peak(), peak_depth);
  }
}

PlaneParallelCloud::Crossing PlaneParallelSun::BelowLitSide(
    PlaneParallelCloud::Crossing crossing) const {
  if (!is_from_below_) return crossing;
  crossing.from = cloud_->depths().whole() - crossing.from;
  crossing.to = cloud_->depths().whole() - crossing.to;
  return crossing;
}

double PlaneParallelSun::HigherOrders(const CloudRay& ray,
                                      const PlaneParallelCloud::Crossing& crossing) const {
  const PlaneParallelCloud::Crossing lit = BelowLitSide(crossing);
  const LightWay way{MuOf(ray), AzimuthFromBeam(ray.direction, to_sun_)};
  const double left = std::exp(-lit.scaled);
  const double behind = left > 0.0 ? left * field_.RadianceOfHigherOrders(lit.to, way) : 0.0;
  return left_ * std::max(field_.RadianceOfHigherOrders(lit.from, way) - behind, 0.0);
}

CloudRayParts PlaneParallelSun::Along(const CloudRay& ray, double length_m) const {
  const auto crossing = cloud_->CrossingOf(ray, length_m);
  if (!crossing) return {};
  CloudRayParts parts = cloud_->Unlit(ray, *crossing);
  parts.higher[0] += HigherOrders(ray, *crossing);
  AddScatteredOnce(ray, BelowLitSide(*crossing), parts);
  return parts;
}

}  // namespace alpenglow::renderer
