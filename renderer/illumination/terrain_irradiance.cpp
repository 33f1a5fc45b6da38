// SPDX-License-Identifier: MIT
#include "renderer/illumination/terrain_irradiance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kMostHorizonNodes = std::size_t{1} << 18;

// Returns a direction as east, north, up at a place; the frame's axes are tilted with the vertical.
glm::dvec3 AtPlace(const glm::dvec3& direction, const glm::dvec3& up) {
  const double z = glm::dot(direction, up);
  return {direction.x - z * up.x, direction.y - z * up.y, z};
}

}  // namespace

std::shared_ptr<const TerrainHorizons> HorizonsOnDemand::Get() const {
  std::call_once(once_, [&] {
    if (ground_.terrain && ground_.is_one_surface)
      made_ = std::make_shared<const TerrainHorizons>(ground_.terrain->mesh(), medium_);
  });
  return made_;
}

TerrainHorizons::TerrainHorizons(const TriangleMesh& mesh, const Medium& medium)
    : TerrainHorizons(RasterOf(mesh, kMostHorizonNodes), mesh, medium) {}

TerrainHorizons::TerrainHorizons(const HeightRaster& heights, const TriangleMesh& mesh,
                                 const Medium& medium)
    : map_(heights, medium.planet_radius_m),
      views_(RasterOf(mesh, SlopeViews::kMostNodes), medium),
      extent_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
              0.0} {
  for (const float z : heights.z_m) {
    if (z <= HeightRaster::kNothing) continue;
    extent_.lowest_m = std::min(extent_.lowest_m, static_cast<double>(z));
    extent_.highest_m = std::max(extent_.highest_m, static_cast<double>(z));
  }
  for (const int row : {0, heights.rows - 1}) {
    for (const int column : {0, heights.columns - 1}) {
      const auto [x, y] = heights.Place(column, row);
      extent_.radius_m = std::max(extent_.radius_m, std::hypot(x, y));
    }
  }
}

TerrainIrradiance::TerrainIrradiance(std::shared_ptr<const TerrainHorizons> horizons,
                                     const SingleScattering<float>& air,
                                     const MultipleScattering& multiple_scattering,
                                     const glm::dvec3& to_light)
    : horizons_(std::move(horizons)),
      sky_(air, multiple_scattering, to_light,
           horizons_ ? horizons_->extent() : OccludedSkyIrradiance::Extent{0.0, 1.0, 5e5}) {}

void TerrainIrradiance::AddSlopes(const Medium& medium,
                                  const TerrainInterreflection::Outgoing& outgoing, double mu_s) {
  slopes_.emplace(horizons_->views(), medium, outgoing, sky_, mu_s);
}

TerrainIrradiance::OnSlope TerrainIrradiance::On(const SlopePoint& at) const {
  const SurfaceSectors surface = SectorsOf(AtPlace(at.normal, at.up));
  const Horizons horizons = horizons_->map().At(at.point);
  const Spectrum sky = sky_.Irradiance(at.altitude_m, at.mu_s, surface, horizons);
  return {sky, slopes_ ? slopes_->Irradiance(at.point, surface, horizons) : Spectrum(sky.size())};
}

Spectrum TerrainIrradiance::SkyRadiance(const SlopePoint& at, const glm::dvec3& direction) const {
  return sky_.Radiance(at.altitude_m, at.mu_s, AtPlace(direction, at.up));
}

double GroundShare(double sine, const Spread& spread, double horizon) {
  constexpr double kSharpest =
      0.011;  // a step of OccludedSkyIrradiance; neither sky nor horizons are finer
  const double range = std::max(spread.below + spread.above, kSharpest);
  const double lowest = sine + 0.5 * (spread.above - spread.below - range);
  const double within = std::clamp((horizon - lowest) / range, 0.0, 1.0);
  const double at_horizontal = std::clamp((horizon - sine) / kSharpest, 0.0, 1.0);
  return within + spread.lifted * (at_horizontal - within);
}

Spectrum TerrainIrradiance::Radiance(const SlopePoint& at, const glm::dvec3& direction,
                                     const Spread& spread) const {
  const glm::dvec3 here = AtPlace(direction, at.up);
  const Spectrum sky = sky_.Radiance(at.altitude_m, at.mu_s, here);
  if (!slopes_) return sky;
  const BetweenAzimuths azimuth(std::atan2(here.y, here.x));
  const double horizon = azimuth.Mean(horizons_->map().At(at.point));
  const auto ground = static_cast<float>(GroundShare(here.z, spread, horizon));
  if (ground <= 0.0F) return sky;
  const Spectrum over_it =
      sky_.Radiance(at.altitude_m, at.mu_s, glm::dvec3(here.x, here.y, std::max(here.z, horizon)));
  return (1.0F - ground) * sky + ground * slopes_->Radiance(at.point, azimuth, horizon, over_it);
}

double TerrainIrradiance::SkyShare(const SlopePoint& at, const glm::dvec3& direction,
                                   const Spread& spread) const {
  if (!slopes_) return 1.0;
  const glm::dvec3 here = AtPlace(direction, at.up);
  const BetweenAzimuths azimuth(std::atan2(here.y, here.x));
  return 1.0 - GroundShare(here.z, spread, azimuth.Mean(horizons_->map().At(at.point)));
}

}  // namespace alpenglow::renderer
