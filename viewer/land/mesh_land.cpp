// SPDX-License-Identifier: MIT
#include "viewer/land/mesh_land.h"

#include <cstddef>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "renderer/terrain/obj_file.h"
#include "viewer/land/loaded_heights.h"

namespace alpenglow {
namespace {

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

ChunkLight Packed(const VertexLight& light) {
  ChunkLight packed{};
  for (std::size_t band = 0; band < light.sky.size(); ++band)
    packed.sky[band] = glm::packHalf1x16(light.sky[band]);
  packed.coarse_sky = packed.sky;
  packed.sun_x.fill(glm::packHalf1x16(light.sun_x));
  return packed;
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
  for (const VertexLight& lit : light(frame, vertices)) packed.push_back(Packed(lit));
  return packed;
}

}  // namespace

MeshLand::MeshLand(std::filesystem::path file, const LocalFrame& frame)
    : file_(std::move(file)),
      frame_(frame),
      reader_([](const std::filesystem::path& path) {
        return std::make_shared<const Terrain>(ReadObj(path).mesh);
      }),
      lighter_([frame](const Order& order) {
        return LightOfMesh(order.terrain->mesh(), frame, order.light);
      }) {
  reader_.Ask(file_);
}

void MeshLand::Upload() {
  const TriangleMesh& mesh = terrain_->mesh();
  glBindVertexArray(layout_.id());
  alpenglow::Upload(GL_ARRAY_BUFFER, positions_, mesh.positions);
  alpenglow::Upload(GL_ARRAY_BUFFER, normals_, mesh.normals);
  alpenglow::Upload(GL_ELEMENT_ARRAY_BUFFER, triangles_, mesh.triangles);
  DescribeVectors(0, positions_);
  DescribeVectors(1, positions_);
  DescribeVectors(3, normals_);
  DescribeVectors(4, normals_);
  const std::vector<ChunkLight> light(mesh.positions.size(), Packed({}));
  alpenglow::Upload(GL_ARRAY_BUFFER, first_light_, light);
  alpenglow::Upload(GL_ARRAY_BUFFER, second_light_, light);
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
  describe(first_location + 2, 2, offsetof(ChunkLight, sun_x));
}

void MeshLand::Update(double seconds) {
  if (auto read = reader_.Take()) {
    terrain_ = std::move(*read);
    Upload();
  }
  if (!terrain_) return;
  const auto light = lighter_.Take();
  if (light) alpenglow::Upload(GL_ARRAY_BUFFER, LightOn(fade_.from()), *light);
  const int before = fade_.number();
  fade_.Advance(seconds, light.has_value());
  if (fade_.number() != before) lighter_.Ask({terrain_, fade_.light()});
}

void MeshLand::Draw(const LandPass& pass, LandDrawn what, const GeodeticPosition& eye,
                    GLuint view_binding) {
  if (!terrain_) return;
  glBindVertexArray(layout_.id());
  DescribeLight(LightOn(fade_.from()), 5);
  DescribeLight(LightOn(Other(fade_.from())), 8);
  const LandBlock block = LandBlockOf(EyeInAnchor(frame_, eye), fade_.share());
  pass.Run(what, block, view_binding, false, [&] {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * terrain_->mesh().triangles.size()),
                   GL_UNSIGNED_INT, nullptr);
  });
}

std::optional<double> MeshLand::GroundUnder(const GeodeticPosition& place) const {
  if (!terrain_) return std::nullopt;
  constexpr double kFromHeight_m = 20000.0;  // over any mountain
  GeodeticPosition high = place;
  high.height_m = kFromHeight_m;
  const glm::dvec3 down = -EyeInAnchor(frame_, place).up;
  const auto hit = terrain_->Intersect(frame_.EnuFromGeodetic(high).xyz, down);
  if (!hit) return std::nullopt;
  return kFromHeight_m - hit->distance_m;
}

std::optional<ElevationGrid> MeshLand::SampledGrid(const GeodeticPosition& place,
                                                   double half_width_m, int most_samples) const {
  if (!terrain_ || most_samples < 2) return std::nullopt;
  LandLattice one_radian;
  one_radian.step_lon_rad = 1.0;
  one_radian.step_lat_rad = 1.0;
  one_radian.north_rad = place.latitude_rad;
  const SampleSize radian = SampleSizeAt(one_radian, place.latitude_rad);
  ElevationGrid grid;
  grid.columns = most_samples;
  grid.rows = most_samples;
  grid.step_lon_rad = 2.0 * half_width_m / radian.column_m / (most_samples - 1);
  grid.step_lat_rad = 2.0 * half_width_m / radian.row_m / (most_samples - 1);
  grid.west_rad = place.longitude_rad - half_width_m / radian.column_m;
  grid.north_rad = place.latitude_rad + half_width_m / radian.row_m;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto ground =
          GroundUnder({grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column), 0.0});
      grid.height_m.push_back(ground ? static_cast<float>(*ground)
                                     : std::numeric_limits<float>::quiet_NaN());
    }
  }
  return grid;
}

std::size_t MeshLand::bytes() const {
  if (!terrain_) return 0;
  const TriangleMesh& mesh = terrain_->mesh();
  return 2 * (24 * mesh.positions.size() + 12 * mesh.triangles.size()) +
         2 * sizeof(ChunkLight) * mesh.positions.size();
}

}  // namespace alpenglow
