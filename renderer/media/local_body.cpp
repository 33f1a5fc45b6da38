// SPDX-License-Identifier: MIT
#include "renderer/media/local_body.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/media/lit_volume.h"

namespace alpenglow::renderer {
namespace {

using Shape = VolumePlacement::Shape;

/// A line in the coordinates of the unit cube.
struct UnitLine {
  glm::dvec3 origin, direction;
};

std::optional<LineSpan> InUnitCube(const UnitLine& line, double length_m) {
  double begin = 0.0, end = length_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (line.direction[axis] == 0.0) {
      if (!(line.origin[axis] >= 0.0 && line.origin[axis] <= 1.0)) return std::nullopt;
      continue;
    }
    const double a = -line.origin[axis] / line.direction[axis];
    const double b = (1.0 - line.origin[axis]) / line.direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return std::nullopt;
  return LineSpan{begin, end};
}

// Returns the part of a line in the sphere of radius 1/2 in the middle of the cube.
std::optional<LineSpan> InUnitBall(const UnitLine& line, double length_m) {
  const glm::dvec3 from = line.origin - 0.5;
  const double a = glm::dot(line.direction, line.direction);
  const double nearest = -glm::dot(from, line.direction) / a;
  // Square the distance vector from the middle: b^2 - 4 a c would lose digits to cancellation.
  const glm::dvec3 off = from + nearest * line.direction;
  const double left = 0.25 - glm::dot(off, off);
  if (left <= 0.0) return std::nullopt;
  const double half = std::sqrt(left / a);
  const LineSpan span{std::max(nearest - half, 0.0), std::min(nearest + half, length_m)};
  if (!(span.begin_m < span.end_m)) return std::nullopt;
  return span;
}

}  // namespace

LocalBody::LocalBody(const VolumePlacement& placement, MediumOptics optics, ScatteringOrders orders)
    : LocalMedium(std::move(optics)), placement_(placement), orders_(orders) {
  for (int axis = 0; axis < 3; ++axis) ALPENGLOW_ENSURE(placement.size_m[axis], >, 0.0);
}

glm::dvec3 LocalBody::UnitFromFrame(const glm::dvec3& point) const {
  const glm::dvec3 off = point - placement_.bottom;
  return glm::dvec3(glm::dot(off, placement_.across) / placement_.size_m.x + 0.5,
                    glm::dot(off, placement_.ahead) / placement_.size_m.y + 0.5,
                    glm::dot(off, placement_.up) / placement_.size_m.z);
}

glm::dvec3 LocalBody::FrameFromUnit(const glm::dvec3& unit) const {
  return placement_.bottom + (unit.x - 0.5) * placement_.size_m.x * placement_.across +
         (unit.y - 0.5) * placement_.size_m.y * placement_.ahead +
         unit.z * placement_.size_m.z * placement_.up;
}

glm::dvec3 LocalBody::UnitsPerMetre(const glm::dvec3& direction) const {
  return glm::dvec3(glm::dot(direction, placement_.across), glm::dot(direction, placement_.ahead),
                    glm::dot(direction, placement_.up)) /
         placement_.size_m;
}

bool LocalBody::Contains(const glm::dvec3& point) const {
  const glm::dvec3 off = UnitFromFrame(point) - 0.5;
  return placement_.shape == Shape::kBox
             ? std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) <= 0.5
             : glm::dot(off, off) <= 0.25;
}

std::optional<LineSpan> LocalBody::SpanAlong(const glm::dvec3& origin, const glm::dvec3& direction,
                                             double length_m) const {
  const UnitLine line{UnitFromFrame(origin), UnitsPerMetre(direction)};
  return placement_.shape == Shape::kBox ? InUnitCube(line, length_m) : InUnitBall(line, length_m);
}

std::unique_ptr<const LitMedium> LocalBody::LitBy(const MediaSources& sources) const {
  return std::make_unique<LitVolume>(*this, sources);
}

VolumePlacement PlacementAt(Place place, const Height& height, double heading_rad,
                            const SceneGround& ground) {
  if (!height.above_ground) place.height_m = height.value_m;
  VolumePlacement placement;
  placement.bottom = ground.frame.EnuFromGeodetic(place).xyz;
  place.height_m += 1000.0;
  placement.up = (ground.frame.EnuFromGeodetic(place).xyz - placement.bottom) / 1000.0;
  if (height.above_ground) {
    placement.bottom.z =
        TerrainTop(ground, placement.bottom.x, placement.bottom.y).value_or(placement.bottom.z);
    placement.bottom += height.value_m * placement.up;
  }
  const glm::dvec3 ahead(std::sin(heading_rad), std::cos(heading_rad), 0.0);
  placement.up = glm::normalize(placement.up);
  placement.ahead = glm::normalize(ahead - glm::dot(ahead, placement.up) * placement.up);
  placement.across = glm::cross(placement.ahead, placement.up);
  return placement;
}

}  // namespace alpenglow::renderer
