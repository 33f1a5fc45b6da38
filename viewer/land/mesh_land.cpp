// SPDX-License-Identifier: MIT
#include "viewer/land/mesh_land.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "renderer/surface/scene_ground.h"
#include "renderer/terrain/loaded_heights.h"

namespace alpenglow::viewer {
namespace {

/// A range to the east or north of a place [m].
struct Span {
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = -std::numeric_limits<double>::infinity();

  void Add(double metres) {
    low_m = std::min(low_m, metres);
    high_m = std::max(high_m, metres);
  }
  [[nodiscard]] double width_m() const { return high_m - low_m; }

  /// Returns the part of the range that is nearest to the place, at most 2 half_width_m wide.
  [[nodiscard]] Span Nearest(double half_width_m) const {
    if (width_m() <= 2.0 * half_width_m) return *this;
    const double middle_m = std::clamp(0.0, low_m + half_width_m, high_m - half_width_m);
    return {middle_m - half_width_m, middle_m + half_width_m};
  }
};

/// Returns the length [m] of one radian of longitude and latitude at a latitude.
SampleSize MetresOfRadian(double latitude_rad) {
  LandLattice one_radian;
  one_radian.step_lon_rad = 1.0;
  one_radian.step_lat_rad = 1.0;
  one_radian.north_rad = latitude_rad;
  return SampleSizeAt(one_radian, latitude_rad);
}

struct Extent {
  Span east, north;
};

/// Returns the bounding box of a mesh. Its edges may be curved in latitude and longitude, so their
/// midpoints are included.
Extent ExtentOf(const Terrain& terrain, const LocalFrame& frame, const Place& place,
                const SampleSize& radian) {
  const auto [low, high] = terrain.Bounds();
  Extent extent;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      const glm::dvec3 point = low + glm::dvec3(x, y, 0.5) * (high - low);
      const Place at = frame.GeodeticFromEnu({point});
      const double turn = std::remainder(at.longitude_rad() - place.longitude_rad(), 2.0 * kPi);
      extent.east.Add(turn * radian.column_m);
      extent.north.Add((at.latitude_rad() - place.latitude_rad()) * radian.row_m);
    }
  }
  return extent;
}

template <typename Row>
void Upload(GLenum target, const GlBuffer& buffer, const std::vector<Row>& rows) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, static_cast<GLsizeiptr>(rows.size() * sizeof(Row)), rows.data(),
               GL_STATIC_DRAW);
}

void DescribeVectors(GLuint location, const GlBuffer& buffer) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(float), nullptr);
}

ChunkLight PackedLight(const VertexLight& light) {
  const std::array<std::uint16_t, 4> sky = PackedShares(light.sky),
                                     moon_sky = PackedShares(light.moon_sky);
  const std::uint16_t disk_x = glm::packHalf1x16(light.disk_x);
  return {sky, sky, moon_sky, moon_sky, {disk_x, disk_x}};
}

std::vector<ChunkLight> LightOfMesh(const TriangleMesh& mesh, const LocalFrame& frame,
                                    const LightOfVertices& light) {
  std::vector<LandVertex> vertices;
  vertices.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto& p = mesh.positions[i];
    const auto& n = mesh.normals[i];
    vertices.push_back({{p[0], p[1], p[2]}, {n[0], n[1], n[2]}});
  }
  std::vector<ChunkLight> packed;
  packed.reserve(vertices.size());
  for (const VertexLight& lit : light.at(frame, vertices)) packed.push_back(PackedLight(lit));
  return packed;
}

}  // namespace

std::optional<ElevationGrid> GridOverMesh(const Terrain& terrain, const LocalFrame& frame,
                                          const Place& place, double half_width_m,
                                          int most_samples) {
  if (most_samples < 2 || terrain.mesh().triangles.empty()) return std::nullopt;
  const SampleSize radian = MetresOfRadian(place.latitude_rad());
  const Extent all = ExtentOf(terrain, frame, place, radian);
  const Span east = all.east.Nearest(half_width_m), north = all.north.Nearest(half_width_m);
  constexpr double kFinest_m = 0.01;
  const double step_m =
      std::max(std::max(east.width_m(), north.width_m()) / (most_samples - 1), kFinest_m);
  const auto samples = [&](const Span& span) {
    const double steps = std::ceil(span.width_m() / step_m - 1e-6);
    return std::clamp(static_cast<int>(steps) + 1, 2, most_samples);
  };
  ElevationGrid grid;
  grid.columns = samples(east);
  grid.rows = samples(north);
  grid.step_lon_rad = step_m / radian.column_m;
  grid.step_lat_rad = step_m / radian.row_m;
  grid.west_rad = place.longitude_rad() + east.low_m / radian.column_m;
  grid.north_rad = place.latitude_rad() + north.high_m / radian.row_m;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto ground = GroundHeightsAt(
          terrain, frame,
          PlaceFromRadians(grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column), 0.0));
      grid.height_m.push_back(ground ? static_cast<float>(ground->highest_m)
                                     : std::numeric_limits<float>::quiet_NaN());
    }
  }
  return grid;
}

MeshLand::MeshLand(const LandSource::Mesh& source, const Ellipsoid& ellipsoid)
    : frame_(ellipsoid, source.place),
      reader_([](const LandSource::Mesh& mesh) {
        MeshModel read = ReadMesh(mesh.file, mesh.up);
        return Read{std::make_shared<const Terrain>(std::move(read.mesh)), std::move(read.message)};
      }),
      lighter_([frame = frame_](const Order& order) {
        return LightOfMesh(order.terrain->mesh(), frame, order.light);
      }) {
  reader_.Request(source);
}

void MeshLand::Upload() {
  const TriangleMesh& mesh = terrain_->mesh();
  glBindVertexArray(layout_.id());
  viewer::Upload(GL_ARRAY_BUFFER, positions_, mesh.positions);
  viewer::Upload(GL_ARRAY_BUFFER, normals_, mesh.normals);
  viewer::Upload(GL_ELEMENT_ARRAY_BUFFER, triangles_, mesh.triangles);
  DescribeVectors(0, positions_);
  DescribeVectors(1, positions_);
  DescribeVectors(3, normals_);
  DescribeVectors(4, normals_);
  const std::vector<ChunkLight> light(mesh.positions.size(), PackedLight({}));
  viewer::Upload(GL_ARRAY_BUFFER, first_light_, light);
  viewer::Upload(GL_ARRAY_BUFFER, second_light_, light);
}

void MeshLand::DescribeLight(const GlBuffer& buffer, GLuint first_location) const {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  const auto describe = [](GLuint location, GLint count, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, count, GL_HALF_FLOAT, GL_FALSE, sizeof(ChunkLight),
                          reinterpret_cast<const void*>(offset));
  };
  describe(first_location, 4, offsetof(ChunkLight, sky));
  describe(first_location + 1, 4, offsetof(ChunkLight, coarse_sky));
  describe(first_location + 2, 4, offsetof(ChunkLight, moon_sky));
  describe(first_location + 3, 4, offsetof(ChunkLight, coarse_moon_sky));
  describe(first_location + 4, 2, offsetof(ChunkLight, disk_x));
}

void MeshLand::Update(double seconds) {
  if (auto read = reader_.Poll()) {
    terrain_ = std::move(read->terrain);
    if (!read->message.empty()) notes_.push_back(std::move(read->message));
    Upload();
  }
  if (!terrain_) return;
  const auto light = lighter_.Poll();
  if (light) viewer::Upload(GL_ARRAY_BUFFER, LightOn(fade_.from()), *light);
  const int before = fade_.number();
  fade_.Advance(seconds, light.has_value());
  if (fade_.number() != before) lighter_.Request({terrain_, fade_.light().value()});
  if (fade_.HasShown()) lighter_.GiveWay();
}

void MeshLand::Draw(LandPass& pass, LandDrawn what, const LandLook& look, const Place& eye,
                    GLuint view_binding) {
  if (!terrain_) return;
  glBindVertexArray(layout_.id());
  DescribeLight(LightOn(fade_.from()), LandPass::kOldLight);
  DescribeLight(LightOn(Other(fade_.from())), LandPass::kNewLight);
  const LandBlock block = LandBlockOf(frame_, eye, fade_.share());
  pass.Use(fade_.edges());
  pass.Run(what, look, block, frame_, view_binding, false, [&] {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * terrain_->mesh().triangles.size()),
                   GL_UNSIGNED_INT, nullptr);
  });
}

std::optional<double> MeshLand::GroundUnder(const Place& place) const {
  if (!terrain_) return std::nullopt;
  return GroundUnderEye(*terrain_, frame_, place);
}

std::optional<double> MeshLand::HighestGround(const Place& place) const {
  if (!terrain_) return std::nullopt;
  const std::optional<GroundHeights> ground = GroundHeightsAt(*terrain_, frame_, place);
  if (!ground) return std::nullopt;
  return ground->highest_m;
}

GroundSampler MeshLand::Sampler() const {
  return [terrain = terrain_, frame = frame_](const Place& place, double half_width_m,
                                              int most_samples) -> std::optional<ElevationGrid> {
    if (!terrain) return std::nullopt;
    return GridOverMesh(*terrain, frame, place, half_width_m, most_samples);
  };
}

std::size_t MeshLand::bytes() const {
  if (!terrain_) return 0;
  const TriangleMesh& mesh = terrain_->mesh();
  return 2 * (24 * mesh.positions.size() + 12 * mesh.triangles.size()) +
         2 * sizeof(ChunkLight) * mesh.positions.size();
}

}  // namespace alpenglow::viewer
