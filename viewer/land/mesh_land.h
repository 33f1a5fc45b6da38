// SPDX-License-Identifier: MIT
// Terrain from a single mesh: read, lit and drawn as a whole, and sampled on a grid of
// latitude and longitude for the lighting and shadow code.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/terrain/land_chunk.h"
#include "renderer/terrain/land_source.h"
#include "renderer/terrain/loaded_heights.h"
#include "renderer/terrain/terrain.h"
#include "viewer/land/chunk_set.h"
#include "viewer/land/land_pass.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Samples the heights of the highest surface of a mesh. The grid covers the mesh. If the mesh is
/// wider than the square around the place, the grid is as wide as the square and lies where the
/// mesh is nearest to the place. This works for meshes of any size and distance.
/// @param frame  of the mesh's coordinates.
/// @return empty if no two neighbouring samples could hit the mesh.
[[nodiscard]] std::optional<ElevationGrid> GridOverMesh(const Terrain& terrain,
                                                        const LocalFrame& frame, const Place& place,
                                                        double half_width_m, int most_samples);

class MeshLand {
 public:
  /// Starts to read a mesh.
  MeshLand(const LandSource::Mesh& source, const Ellipsoid& ellipsoid);

  /// Collects finished work. Throws InputError if the file cannot be read (ReadMesh).
  /// @param seconds  time since the last call.
  void Update(double seconds);
  void Wait() {
    reader_.Wait();
    lighter_.Wait();
  }
  void Draw(LandPass& pass, LandDrawn what, const LandLook& look, const Place& eye,
            GLuint view_binding);

  void Relight(LightOfVertices light) { fade_.Request(std::move(light)); }
  [[nodiscard]] EdgesOfVertices edges() const { return fade_.edges(); }
  [[nodiscard]] bool IsRelighting() const { return fade_.IsChanging(); }
  [[nodiscard]] bool IsRead() const { return terrain_ != nullptr; }

  /// Return viewer::GroundUnderEye, and the highest ground at the place.
  [[nodiscard]] std::optional<double> GroundUnder(const Place& place) const;
  [[nodiscard]] std::optional<double> HighestGround(const Place& place) const;
  /// Returns GridOverMesh of the mesh loaded now. Any thread may call it, at any later time.
  [[nodiscard]] GroundSampler Sampler() const;
  /// Returns the warnings about the file, once (MeshModel).
  [[nodiscard]] std::vector<std::string> PollNotes() { return std::exchange(notes_, {}); }
  /// Returns the size of the vertices and triangles, in memory and on the GPU.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Order {
    std::shared_ptr<const Terrain> terrain;
    LightOfVertices light;
  };
  struct Read {
    std::shared_ptr<const Terrain> terrain;
    std::string message;
  };
  void Upload();
  [[nodiscard]] const GlBuffer& LightOn(LightSide side) const {
    return side == LightSide::kFirst ? first_light_ : second_light_;
  }
  void DescribeLight(const GlBuffer& buffer, GLuint first_location) const;

  LocalFrame frame_;
  std::shared_ptr<const Terrain> terrain_;
  GlVertexArray layout_;
  GlBuffer positions_, normals_, triangles_, first_light_, second_light_;
  LightFade fade_;
  std::vector<std::string> notes_;
  AsyncValue<LandSource::Mesh, Read> reader_;
  AsyncValue<Order, std::vector<ChunkLight>> lighter_;
};

}  // namespace alpenglow::viewer
