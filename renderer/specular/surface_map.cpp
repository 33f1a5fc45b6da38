// SPDX-License-Identifier: MIT
#include "renderer/specular/surface_map.h"

#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

SurfaceMap::SurfaceMap(std::span<const PhotonBeam> beams, double radius_m)
    : radius_m_(RequireInRange(radius_m, std::numeric_limits<double>::min(),
                               std::numeric_limits<double>::max(), "the radius of spots [m]")),
      spots_(SpotsOf(beams)),
      tree_(Boxes()) {}

std::vector<SurfaceMap::Spot> SurfaceMap::SpotsOf(std::span<const PhotonBeam> beams) {
  std::vector<Spot> spots;
  for (const PhotonBeam& beam : beams) {
    if (beam.ends_on_surface)
      spots.push_back({beam.origin + beam.length_m * beam.direction, beam.area_m2});
  }
  return spots;
}

std::vector<Box> SurfaceMap::Boxes() const {
  std::vector<Box> boxes;
  boxes.reserve(spots_.size());
  for (const Spot& spot : spots_) boxes.push_back({spot.place - radius_m_, spot.place + radius_m_});
  return boxes;
}

double SurfaceMap::Irradiance(const glm::dvec3& point) const {
  const double squared_m2 = radius_m_ * radius_m_;
  double sum = 0.0;
  tree_.VisitAlong(BoxRay(point, {0.0, 0.0, 1.0}, 0.0), [&](std::uint32_t number) {
    const glm::dvec3 apart = point - spots_[number].place;
    const double share = 1.0 - glm::dot(apart, apart) / squared_m2;
    if (share > 0.0) sum += share * spots_[number].area_m2;
  });
  return 2.0 / (kPi * squared_m2) * sum;
}

}  // namespace alpenglow::renderer
