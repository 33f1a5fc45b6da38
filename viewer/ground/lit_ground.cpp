// SPDX-License-Identifier: MIT
#include "viewer/ground/lit_ground.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "viewer/ground/ground_block.h"

namespace alpenglow::viewer {

template <typename Visit>
void MeshHeights::VisitCells(const Visit& visit) const {
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Cells under = Under(mesh_.triangles[i]);
    for (std::size_t row = under.first_row; row <= under.last_row; ++row) {
      for (std::size_t column = under.first_column; column <= under.last_column; ++column)
        visit(row * columns_ + column, i);
    }
  }
}

// A cell has two triangles on average.
MeshHeights::MeshHeights(const TriangleMesh& mesh) : mesh_(mesh) {
  if (mesh.triangles.empty()) return;
  const FlatRectangle all = RectangleOf(mesh);
  west_m_ = all.west_m;
  south_m_ = all.south_m;
  const double area_m2 = std::max(all.width_m * all.depth_m, 1e-6);
  cell_m_ = std::sqrt(2.0 * area_m2 / static_cast<double>(mesh.triangles.size()));
  cell_m_ = std::max(cell_m_, 1e-6 * std::max(all.width_m, all.depth_m));
  columns_ = static_cast<std::size_t>(all.width_m / cell_m_) + 1;
  rows_ = static_cast<std::size_t>(all.depth_m / cell_m_) + 1;
  first_.assign(columns_ * rows_ + 1, 0);
  VisitCells([&](std::size_t cell, std::uint32_t) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell < columns_ * rows_; ++cell) first_[cell + 1] += first_[cell];
  triangles_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  VisitCells([&](std::size_t cell, std::uint32_t i) { triangles_[next[cell]++] = i; });
}

MeshHeights::Cells MeshHeights::Under(const std::array<std::uint32_t, 3>& triangle) const {
  const auto cell = [&](double metres, double first_m, std::size_t cells) {
    return std::min(static_cast<std::size_t>((metres - first_m) / cell_m_), cells - 1);
  };
  float west = mesh_.positions[triangle[0]][0], east = west;
  float south = mesh_.positions[triangle[0]][1], north = south;
  for (const std::uint32_t corner : {triangle[1], triangle[2]}) {
    west = std::min(west, mesh_.positions[corner][0]);
    east = std::max(east, mesh_.positions[corner][0]);
    south = std::min(south, mesh_.positions[corner][1]);
    north = std::max(north, mesh_.positions[corner][1]);
  }
  return {cell(static_cast<double>(west), west_m_, columns_),
          cell(static_cast<double>(east), west_m_, columns_),
          cell(static_cast<double>(south), south_m_, rows_),
          cell(static_cast<double>(north), south_m_, rows_)};
}

std::optional<double> MeshHeights::At(double x_m, double y_m) const {
  const double column = (x_m - west_m_) / cell_m_, row = (y_m - south_m_) / cell_m_;
  if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns_) &&
        row < static_cast<double>(rows_)))
    return std::nullopt;
  const std::size_t cell =
      static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const auto& triangle = mesh_.triangles[triangles_[i]];
    const auto corner = [&](std::size_t k, std::size_t axis) {
      return static_cast<double>(mesh_.positions[triangle[k]][axis]);
    };
    const double ax = corner(1, 0) - corner(0, 0), ay = corner(1, 1) - corner(0, 1);
    const double bx = corner(2, 0) - corner(0, 0), by = corner(2, 1) - corner(0, 1);
    const double px = x_m - corner(0, 0), py = y_m - corner(0, 1);
    const double area = ax * by - ay * bx;
    if (area == 0.0) continue;
    const double b = (px * by - py * bx) / area, c = (ax * py - ay * px) / area;
    constexpr double kRounding = 1e-6;
    if (b < -kRounding || c < -kRounding || b + c > 1.0 + kRounding) continue;
    const double z = corner(0, 2);
    return z + b * (corner(1, 2) - z) + c * (corner(2, 2) - z);
  }
  return std::nullopt;
}

namespace {

/// Runs work that libraries would spread over all processors on one thread, so that drawing keeps
/// the others.
template <typename Work>
auto OnThisThread(const Work& work) {
  tbb::task_arena alone(1);
  return alone.execute(work);
}

LampLight NoLamps(const SceneGround& ground, const Medium& medium) {
  Scene scene;
  scene.place = ground.frame.origin();
  scene.medium = medium;
  return LampLight(scene, ground, medium, BandColour(medium.wavelengths_nm));
}

const Terrain& TerrainOf(const SceneGround& ground) {
  ALPENGLOW_ENSURE(ground.terrain.has_value(), ==, true);
  return *ground.terrain;
}

}  // namespace

SceneGround GroundOf(const ElevationGrid& grid, const LocalFrame& frame) {
  return OnThisThread([&] {
    return SceneGround{frame, Terrain(MeshFromElevation(grid, frame)), 0.0, "", true};
  });
}

GroundSite::GroundSite(SceneGround ground, const GroundCover& cover,
                       std::shared_ptr<const ColourDrape> drape, SiteAir air)
    : air_(std::move(air)),
      ground_(std::move(ground)),
      geometry_(ground_, medium(), true),
      material_(cover, std::move(drape), medium().wavelengths_nm),
      no_lamps_(NoLamps(ground_, medium())),
      horizons_(ground_, medium()),
      heights_(TerrainOf(ground_).mesh()),
      light_({ground_, geometry_, no_lamps_, horizons_, material_},
             {*air_.single_scattering, *air_.beam, *air_.multiple_scattering}) {
  ALPENGLOW_ENSURE(ground_.is_one_surface, ==, true);
  OnThisThread([&] { (void)horizons_.Get(); });
}

GroundVertex GroundSite::Vertex(const std::array<float, 3>& position_m,
                                const std::array<float, 3>& normal) const {
  const auto z_m =
      heights_.At(static_cast<double>(position_m[0]), static_cast<double>(position_m[1]));
  return {position_m, normal, z_m ? static_cast<float>(*z_m) : position_m[2]};
}

std::shared_ptr<const TerrainIrradiance> GroundSite::Under(const Lighting& light) const {
  return light_.OnTerrain({light, nullptr});
}

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

TerrainIrradiance::OnSlope GroundSky::On(const GroundVertex& vertex) const {
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
