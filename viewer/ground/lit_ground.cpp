// SPDX-License-Identifier: MIT
#include "viewer/ground/lit_ground.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/text/error.h"
#include "viewer/ground/on_this_thread.h"

namespace alpenglow::viewer {
namespace {

std::array<float, 3> InFloats(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

SiteFromFrame::SiteFromFrame(const LocalFrame& site, const LocalFrame& frame)
    : origin_(site.EnuFromGeodetic(frame.origin()).xyz) {
  for (const glm::length_t axis : {0, 1, 2}) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    turn_[axis] = site.EnuFromEcef(frame.EcefFromEnu(Vector<Enu>{unit})).xyz;
  }
}

std::array<float, 3> SiteFromFrame::Point(const glm::vec3& point_m) const {
  return InFloats(origin_ + turn_ * glm::dvec3(point_m));
}

std::array<float, 3> SiteFromFrame::Along(const glm::vec3& direction) const {
  return InFloats(turn_ * glm::dvec3(direction));
}

GroundSky::GroundSky(std::shared_ptr<const GroundSite> site, Lighting light)
    : site_(std::move(site)), light_(OnThisThread([&] {
        light.on_terrain = site_->Under(light);
        return std::move(light);
      })) {
  ALPENGLOW_ENSURE(site_->medium().wavelengths_nm.size(), <=, LitVertex{}.sky.size());
}

TerrainLight::OnSlope GroundSky::On(const GroundVertex& vertex) const {
  const SceneGeometry& geometry = site_->geometry();
  const glm::dvec3 point = InDoubles(vertex.position_m);
  const glm::dvec3 up = geometry.UpAt(point);
  const SlopePoint at{point, InDoubles(vertex.normal), up,
                      std::max(geometry.AltitudeOf(point), 0.0),
                      std::clamp(glm::dot(up, light_.to_sun_for_air), -1.0, 1.0)};
  return light_.on_terrain->On(at);
}

LitGround::LitGround(std::shared_ptr<const GroundSite> site, Lighting light,
                     const ShadowHeights::Options& shadow)
    : sky_(std::move(site), std::move(light)), shadow_(OnThisThread([&] {
        return ShadowHeights(sky_.site().ground().terrain->mesh(), lighting().to_sun,
                             lighting().sun_radius_rad, shadow);
      })) {}

float LitGround::EdgeOver(const GroundVertex& vertex) const {
  const glm::dvec3 point = InDoubles(vertex.position_m);
  return static_cast<float>(
      shadow_.Over({point.x, point.y, vertex.site_z_m}).Radii(LitVertex::kMostRadii));
}

}  // namespace alpenglow::viewer
