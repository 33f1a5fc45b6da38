// SPDX-License-Identifier: MIT
// Land that is one mesh (OBJ): read, lit and drawn whole.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/terrain/terrain.h"
#include "viewer/job/latest_job.h"
#include "viewer/land/land_chunk.h"
#include "viewer/land/land_pass.h"
#include "viewer/land/light_fade.h"

namespace alpenglow {

class MeshLand {
 public:
  /// Begins to read a Wavefront OBJ whose coordinates are metres in `frame`.
  MeshLand(std::filesystem::path file, const LocalFrame& frame);

  /// Takes what has become ready. Throws InputError when the file cannot be read (ReadObj).
  /// @param seconds  since the last call.
  void Update(double seconds);
  void Wait() {
    reader_.Wait();
    lighter_.Wait();
  }
  void Draw(const LandPass& pass, LandDrawn what, const GeodeticPosition& eye, GLuint view_binding);

  void Relight(LightOfVertices light) { fade_.Ask(std::move(light)); }
  [[nodiscard]] bool IsRelighting() const { return fade_.IsChanging(); }
  [[nodiscard]] bool IsRead() const { return terrain_ != nullptr; }

  [[nodiscard]] std::optional<double> GroundUnder(const GeodeticPosition& place) const;
  /// Heights under the vertical through each of the grid's places.
  [[nodiscard]] std::optional<ElevationGrid> SampledGrid(const GeodeticPosition& place,
                                                         double half_width_m,
                                                         int most_samples) const;
  /// Of the vertices and triangles, here and on the card.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Order {
    std::shared_ptr<const Terrain> terrain;
    LightOfVertices light;
  };
  void Upload();
  [[nodiscard]] const GlBuffer& LightOn(LightSide side) const {
    return side == LightSide::kFirst ? first_light_ : second_light_;
  }
  void DescribeLight(const GlBuffer& buffer, GLuint first_location) const;

  std::filesystem::path file_;
  LocalFrame frame_;
  std::shared_ptr<const Terrain> terrain_;
  GlVertexArray layout_;
  GlBuffer positions_, normals_, triangles_, first_light_, second_light_;
  LightFade fade_;
  LatestJob<std::filesystem::path, std::shared_ptr<const Terrain>> reader_;
  LatestJob<Order, std::vector<ChunkLight>> lighter_;
};

}  // namespace alpenglow
