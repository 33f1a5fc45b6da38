// SPDX-License-Identifier: MIT
#include "renderer/media/exponential_layer.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/media/lit_layer.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

constexpr double kThin = 1e-9;

double ThinAltitude(const LayerShape& shape) {
  if (std::isinf(shape.scale_height_m)) return shape.top_m;
  return std::min(shape.base_m - shape.scale_height_m * std::log(kThin), shape.top_m);
}

/// Altitude of a point, and the cosine between the vertical there and a direction.
struct PointOnRay {
  double altitude_m, mu;
};

PointOnRay PointOn(const ExponentialLayer& layer, const glm::dvec3& point,
                   const glm::dvec3& direction, double planet_radius_m) {
  const double altitude = layer.AltitudeOf(point);
  const double mu = glm::dot(point + glm::dvec3(0.0, 0.0, planet_radius_m), direction) /
                    (planet_radius_m + altitude);
  return {altitude, std::clamp(mu, -1.0, 1.0)};
}

double PerigeeOf(const PointOnRay& at, double planet_radius_m) {
  return at.altitude_m - (planet_radius_m + at.altitude_m) * (1.0 - std::sqrt(1.0 - at.mu * at.mu));
}

/// Returns the altitude of the lowest ground in a layer, which becomes ever denser downwards: that of
/// the terrain, or of the planet around it if the layer lies wholly below the terrain; no value if there
/// is no layer above the ground.
std::optional<double> BottomOf(const ExponentialLayer& layer, const SceneGround& ground) {
  std::vector<double> lowest_m;
  if (ground.terrain) {
    lowest_m.push_back(std::numeric_limits<double>::infinity());
    for (const auto& [x, y, z] : ground.terrain->mesh().positions) {
      lowest_m.front() = std::min(lowest_m.front(), layer.AltitudeOf({x, y, z}));
    }
  }
  lowest_m.push_back(0.0);
  for (const double lowest : lowest_m) {
    if (layer.ColumnAbove(lowest) > 0.0) return lowest;
  }
  return std::nullopt;
}

/// Returns the altitudes of a layer; no value if it lies wholly below the ground.
std::optional<LayerShape> ShapeOf(const MediumLayer& layer, const SceneGround& ground,
                                  const Medium& medium) {
  LayerShape shape;
  shape.base_m = layer.base_height_m.value_or(TerrainTop(ground, 0.0, 0.0).value_or(0.0));
  shape.scale_height_m = layer.scale_height_m;
  shape.planet_radius_m = medium.planet_radius_m;
  shape.top_m = medium.atmosphere_height_m;
  shape.bottom_m = BottomOf(ExponentialLayer(shape), ground);
  return shape.bottom_m ? std::optional(shape) : std::nullopt;
}

}  // namespace

ExponentialLayer::ExponentialLayer(const LayerShape& shape, MediumOptics optics)
    : LocalMedium(std::move(optics)), shape_(shape), thin_m_(ThinAltitude(shape)) {
  ALPENGLOW_ENSURE(shape.scale_height_m, >, 0.0);
}

double ExponentialLayer::HeadAltitude() const {
  if (std::isinf(shape_.scale_height_m)) return bottom_m();
  const double depth = optics().extinction_per_m[0] * ColumnAbove(bottom_m());
  return bottom_m() + shape_.scale_height_m * std::max(1.0, std::log(depth));
}

double ExponentialLayer::AltitudeOf(const glm::dvec3& point) const {
  return AltitudeOverSphere(point, shape_.planet_radius_m);
}

double ExponentialLayer::DensityAtAltitude(double altitude_m) const {
  if (altitude_m > thin_m_) return 0.0;
  return shared::LayerDensity(altitude_m - shape_.base_m, shape_.scale_height_m);
}

double ExponentialLayer::ColumnAbove(double altitude_m) const {
  if (std::isinf(shape_.scale_height_m)) return std::max(shape_.top_m - altitude_m, 0.0);
  return shape_.scale_height_m * DensityAtAltitude(altitude_m);
}

double ExponentialLayer::ColumnUp(double altitude_m, double mu) const {
  if (std::isinf(shape_.scale_height_m)) {
    const double r = shape_.planet_radius_m + altitude_m;
    const double rest = (shape_.top_m - altitude_m) * (shape_.planet_radius_m + shape_.top_m + r);
    return rest <= 0.0 ? 0.0 : rest / (r * mu + std::sqrt(r * r * mu * mu + rest));
  }
  return shared::LayerColumnUp(altitude_m, mu, DensityAtAltitude(altitude_m), shape_.scale_height_m,
                               shape_.planet_radius_m);
}

double ExponentialLayer::ColumnToSpace(const glm::dvec3& point, const glm::dvec3& direction) const {
  const PointOnRay at = PointOn(*this, point, direction, shape_.planet_radius_m);
  // In a homogeneous layer, the distance to the top holds below the horizontal, too.
  if (at.mu >= 0.0 || std::isinf(shape_.scale_height_m)) return ColumnUp(at.altitude_m, at.mu);
  const double perigee = PerigeeOf(at, shape_.planet_radius_m);
  return std::max(2.0 * ColumnUp(perigee, 0.0) - ColumnUp(at.altitude_m, -at.mu), 0.0);
}

double ExponentialLayer::Column(const glm::dvec3& origin, const glm::dvec3& direction,
                                double length_m) const {
  if (std::isinf(length_m)) return ColumnToSpace(origin, direction);
  const PointOnRay from = PointOn(*this, origin, direction, shape_.planet_radius_m);
  const PointOnRay to =
      PointOn(*this, origin + length_m * direction, direction, shape_.planet_radius_m);
  const bool has_perigee = from.mu < 0.0 && to.mu > 0.0;
  const double lowest = has_perigee ? PerigeeOf(from, shape_.planet_radius_m)
                                    : std::min(from.altitude_m, to.altitude_m);
  return shared::ColumnBetween(from.mu, to.mu, ColumnUp(from.altitude_m, std::abs(from.mu)),
                               ColumnUp(to.altitude_m, std::abs(to.mu)), ColumnUp(lowest, 0.0));
}

const LayerBeam& ExponentialLayer::beam() const {
  // A thread that waits for parallel work must not begin a task that waits for this.
  std::call_once(tabulated_, [this] {
    tbb::this_task_arena::isolate([this] {
      beam_.emplace(optics().phase, optics().scattering_per_m[0] / optics().extinction_per_m[0]);
    });
  });
  return *beam_;
}

std::vector<DensePiece> ExponentialLayer::PiecesAlong(const glm::dvec3& origin,
                                                      const glm::dvec3& direction,
                                                      double length_m) const {
  const glm::dvec3 from = origin + glm::dvec3(0.0, 0.0, shape_.planet_radius_m);
  const double lowest_m = -glm::dot(from, direction);
  const double perigee_m = AltitudeOf(origin + lowest_m * direction);
  if (perigee_m >= thin_m_) return {};
  const double half =
      std::sqrt((thin_m_ - perigee_m) * (2.0 * shape_.planet_radius_m + thin_m_ + perigee_m));
  const double begin = std::max(lowest_m - half, 0.0);
  const double end = std::min(lowest_m + half, length_m);
  std::vector<DensePiece> pieces;
  const auto add = [&](double a, double b) {
    if (!(a < b)) return;
    const double most =
        std::max(DensityAt(origin + a * direction), DensityAt(origin + b * direction));
    if (most > 0.0) pieces.push_back({a, b, most});
  };
  add(begin, std::min(end, std::max(begin, lowest_m)));
  add(std::max(begin, std::min(end, lowest_m)), end);
  return pieces;
}

double ExponentialLayer::LargestBetween(const glm::dvec3& from, const glm::dvec3& to,
                                        double /*largest*/) const {
  return std::max(DensityAt(from), DensityAt(to));
}

std::unique_ptr<const LitMedium> ExponentialLayer::LitBy(const MediaSources& sources) const {
  return std::make_unique<LitLayer>(*this, sources);
}

MediaList LayersOf(const Scene& scene, const SceneGround& ground, const Medium& medium) {
  MediaList layers;
  for (const MediumLayer& layer : scene.layers) {
    if (layer.extinction_per_m <= 0.0) continue;
    if (const std::optional<LayerShape> shape = ShapeOf(layer, ground, medium)) {
      layers.push_back(std::make_shared<const ExponentialLayer>(
          *shape, OpticsFromLists({layer.extinction_per_m}, {layer.albedo}, layer.phase,
                                  medium.wavelengths_nm.size())));
    }
  }
  return layers;
}

}  // namespace alpenglow::renderer
