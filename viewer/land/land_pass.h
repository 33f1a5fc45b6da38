// SPDX-License-Identifier: MIT
// The horizon of terrain towards the sun of this moment, on the graphics card: where the sun has moved
// on and the edges of shade that vertices have are those before another sun, the vertices take theirs
// from it. It is coarser (HorizonMap: a node every few hundred metres, sixteen azimuths).
//
// What the eye sees of the terrain, a pixel each: the first pass of a frame draws it, the picture
// reads it.
//
// Where land stands in a picture of the screen's size, while its light is painted in a smaller one.
//
// The pass that draws land: its program, what the program reads, depth.
#pragma once

#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/shadow/horizon_map.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/chunk_set.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Horizons around places of a frame.
struct TerrainHorizon {
  std::shared_ptr<const HorizonMap> map;
  LocalFrame frame;
};

/// Where a place of a frame lies in a texture whose texels are the nodes of a grid: u and v are the products
/// of these rows and (x, y, z, 1) [m].
struct PlaceOnGrid {
  glm::vec4 u{0.0F}, v{0.0F};
};
/// @param grid  in the first frame; places are those of the second.
[[nodiscard]] PlaceOnGrid PlaceOnGridOf(const HeightRaster& grid, const LocalFrame& of_grid,
                                        const LocalFrame& of_places);

class HorizonTexture {
 public:
  void Use(const TerrainHorizon& horizon);
  [[nodiscard]] bool HasAny() const { return horizon_.has_value(); }

  /// Where a place of an anchor's frame lies in the texture.
  [[nodiscard]] PlaceOnGrid PlaceIn(const LocalFrame& anchor) const;

  /// Binds the sines of the horizon towards a direction to a texture unit.
  void Bind(int unit, const Vector<Ecef>& to_sun);

 private:
  void Upload(double azimuth_rad);

  std::optional<TerrainHorizon> horizon_;
  std::optional<double> azimuth_rad_;  // that the texture has
  GlTexture texture_;
};

/// Its depth is 0 where there is no land.
class SurfaceMap : public RenderTarget {
 public:
  enum Output : std::size_t {
    /// Four floats: normal in the eye's frame, octahedral (octahedral.glsl); height of the disk that
    /// throws shadows over the terrain's edge, in its radii; distance [m], 0: no terrain.
    kSurface,
    /// Four half floats each: irradiance of the sun's sky and of the moon's in bands, as in VertexLight.
    kSky,
    kMoonSky,
  };

  /// @param width, height >= 1.
  SurfaceMap(int width, int height)
      : RenderTarget(width, height,
                     {PixelFormat::kRgba32F, PixelFormat::kRgba16F, PixelFormat::kRgba16F},
                     Depth::k32Bit) {}
};

/// Depth alone, as the depth of a SurfaceMap: 0 where there is no land.
class LandOutline : public RenderTarget {
 public:
  /// @param width, height >= 1.
  LandOutline(int width, int height) : RenderTarget(width, height, {}, Depth::k32Bit) {}
};

/// What the eye sees, as in view_block.glsl: axes in its frame (east, north, up).
struct LandView {
  glm::dvec3 right{1.0, 0.0, 0.0};  // times the tangent of half the view's width
  glm::dvec3 up{0.0, 0.0, 1.0};     // times the tangent of half its height
  glm::dvec3 forward{0.0, 1.0, 0.0};
  int rays = 1;              // that a pixel will have: for more, land is finer
  double bends_per_m = 0.0;  // most curvature of rays, which lifts land
};

/// `block Land` of land_block.glsl.
struct LandBlock {
  static constexpr std::size_t kMostLevels = 32;
  glm::vec4 eye_high, eye_low;
  glm::vec4 east, north, up;
  glm::vec4 eye_sample, eye_above, pixel;
  glm::vec4 horizon_u, horizon_v;
  glm::vec4 risen;
  std::array<glm::vec4, kMostLevels> turning;
};
static_assert(sizeof(LandBlock) == (11 + LandBlock::kMostLevels) * sizeof(glm::vec4));

/// An eye and its axes in the frame of an anchor.
struct EyeInAnchor {
  glm::dvec3 at, east, north, up;

  EyeInAnchor(const LocalFrame& anchor, const GeodeticPosition& eye);
  /// From the eye's frame.
  [[nodiscard]] glm::dvec3 Turned(const glm::dvec3& v) const {
    return v.x * east + v.y * north + v.z * up;
  }
  /// A point of the anchor's frame in the eye's.
  [[nodiscard]] glm::dvec3 From(const glm::dvec3& point) const {
    const glm::dvec3 v = point - at;
    return {glm::dot(v, east), glm::dot(v, north), glm::dot(v, up)};
  }
};

/// A block without levels: vertices stay where they are. The picture's size is the viewport's.
/// @param new_light  share of the new light.
[[nodiscard]] LandBlock LandBlockOf(const EyeInAnchor& eye, double new_light);

/// Edges of shade before the sun of this moment instead of those that vertices have (HorizonTexture).
struct MomentaryEdges {
  double share = 0.0;  // 0: those of the vertices alone
  Vector<Ecef> to_sun{};
  double sun_radius_rad = 0.0;
};

/// What is drawn of land: all that SurfaceMap holds, or its depth alone, into a LandOutline.
enum class LandDrawn { kSurface, kOutline };

class LandPass {
 public:
  LandPass();

  /// Locations of the first attribute of the light that fades, and of the one that comes.
  static constexpr unsigned kOldLight = 5, kNewLight = 10;
  /// Attributes of land.vert.glsl, in the order of their locations.
  static constexpr std::array<const char*, 15> kAttributes{
      "position",          "coarse_position",
      "sample_place",      "normal",
      "coarse_normal",     "sky",
      "coarse_sky",        "moon_sky",
      "coarse_moon_sky",   "disk_over_edge",
      "new_sky",           "new_coarse_sky",
      "new_moon_sky",      "new_coarse_moon_sky",
      "new_disk_over_edge"};

  /// Empties the bound SurfaceMap or LandOutline.
  static void Clear(LandDrawn drawn);
  void Use(const TerrainHorizon& horizon) { horizon_.Use(horizon); }
  void Use(const MomentaryEdges& edges) { edges_ = edges; }
  void Use(const EdgesOfVertices& edges) { edges_of_vertices_ = edges; }
  [[nodiscard]] bool HasHorizon() const { return horizon_.HasAny(); }

  /// Sets program and state and calls `draw`. The uniform block View must be bound to
  /// `view_binding`. Texture unit 0 is used.
  /// @param anchor  the frame of the vertices.
  /// @param one_side  leave out triangles that face away.
  void Run(LandDrawn drawn, LandBlock block, const LocalFrame& anchor, GLuint view_binding,
           bool one_side, const std::function<void()>& draw);

  /// The text that says what depth is of the driver's context.
  [[nodiscard]] static ShaderPiece DepthText();

 private:
  [[nodiscard]] const ShaderProgram& ProgramOf(LandDrawn drawn) const;
  void BindEdges(const ShaderProgram& program);
  [[nodiscard]] glm::vec4 RisenSinceMade(const LocalFrame& anchor) const;

  HorizonTexture horizon_;
  MomentaryEdges edges_;
  EdgesOfVertices edges_of_vertices_;
  bool reversed_depth_;
  GlBuffer block_;
  mutable std::optional<ShaderProgram> surface_, outline_;  // made when they are first drawn with
};

/// What land.frag.glsl and land_outline.frag.glsl are put together with.
/// @param depth  LandPass::DepthText, or the other.
[[nodiscard]] std::vector<ShaderPiece> LandTexts(const ShaderPiece& depth);

}  // namespace alpenglow::viewer
