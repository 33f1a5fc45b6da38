// SPDX-License-Identifier: MIT
#include "renderer/specular/point_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/path_sampling.h"

namespace alpenglow::renderer {
namespace {

// Prime to the bases of the photons, so that points along beams do not follow the places of photons.
constexpr int kDistanceBase = 41;

/// A distance along a beam, and the length of beam that it stands for.
struct SampledDistance {
  double along_m, stands_for_m;
};

/// Samples a distance with a density that falls as exp(-depth s / length).
SampledDistance DistanceOn(double length_m, double depth, double u) {
  // For small depths the density is even, and the quotients below are 0 / 0.
  if (depth < 1e-6) return {u * length_m, length_m};
  const double scattered = -std::expm1(-depth);
  const double along = -std::log1p(-u * scattered) / depth;
  return {along * length_m, length_m * scattered / depth * std::exp(depth * along)};
}

}  // namespace

PointMap::PointMap(std::span<const PhotonBeam> beams, LocalMedia media, double radius_m,
                   std::uint64_t seed)
    : media_(std::move(media)),
      radius_m_(RequireInRange(radius_m, std::numeric_limits<double>::min(),
                               std::numeric_limits<double>::max(), "the radius of points [m]")),
      points_(PointsOn(beams, media_, seed)),
      tree_(Boxes()) {}

PointMap::Points PointMap::PointsOn(std::span<const PhotonBeam> beams, const LocalMedia& media,
                                    std::uint64_t seed) {
  const double shift = atmosphere::reference::PathRandom(seed, 1, 0).Next();
  const MediaList& all = media.all();
  std::vector<double> before_m(all.size());
  Points points;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const PhotonBeam& beam = beams[i];
    if (beam.leg == 0) std::ranges::fill(before_m, 0.0);
    const double depth = LargestDepth(media, beam);
    const double u = Halton(static_cast<int>(i), kDistanceBase) + shift;
    const SampledDistance at = DistanceOn(beam.length_m, depth, u < 1.0 ? u : u - 1.0);
    points.all.push_back({beam.origin + at.along_m * beam.direction, beam.direction,
                          beam.area_m2 * at.stands_for_m});
    for (std::size_t m = 0; m < all.size(); ++m) {
      points.column_m.push_back(before_m[m] +
                                all[m]->Column(beam.origin, beam.direction, at.along_m));
      before_m[m] += all[m]->Column(beam.origin, beam.direction, beam.length_m);
    }
  }
  return points;
}

std::vector<Box> PointMap::Boxes() const {
  std::vector<Box> boxes;
  boxes.reserve(points_.all.size());
  for (const Point& point : points_.all) {
    boxes.push_back({point.place - radius_m_, point.place + radius_m_});
  }
  return boxes;
}

SpectrumOf<double> PointMap::Radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                      double length_m) const {
  const double per_area = 1.0 / (kPi * radius_m_ * radius_m_);
  const auto add = [&](std::uint32_t number, const ColumnsOnRay& on_ray,
                       std::vector<double>& columns_m, ScatteredLight& light) {
    const Point& point = points_.all[number];
    const glm::dvec3 from = point.place - origin;
    const double along_m = glm::dot(from, direction);
    const glm::dvec3 apart = from - along_m * direction;
    if (along_m < 0.0 || along_m > length_m || glm::dot(apart, apart) > radius_m_ * radius_m_)
      return;
    for (std::size_t m = 0; m < columns_m.size(); ++m)
      columns_m[m] = on_ray.At(m, along_m) + points_.column_m[number * columns_m.size() + m];
    light.Add(
        {point.place, -glm::dot(point.direction, direction), point.weight * per_area, columns_m});
  };
  return LightOfBoxes(tree_, media_, {origin, direction, length_m}, add);
}

}  // namespace alpenglow::renderer
