// SPDX-License-Identifier: MIT
// The passes that draw terrain: targets, uniform block, shader programs and depth mode.
//
// HorizonTexture holds the sines of the terrain's horizon towards the current sun. When the sun has
// moved since the shadow edges of the vertices were computed, they are replaced by edges from this
// horizon. It is coarser (HorizonMap: one node every few hundred metres, sixteen azimuths).
//
// GBuffer holds the visible terrain per pixel. The first pass of a frame draws it, and the
// picture pass reads it. DepthPrepass holds the depth of the terrain at the size of the screen, for
// pictures whose lighting is rendered at a lower resolution.
#pragma once

#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/visibility/horizon_map.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/land/chunk_set.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Terrain horizons for positions in a local frame.
struct TerrainHorizon {
  std::shared_ptr<const HorizonMap> map;
  LocalFrame frame;
};

/// Linear map from a point of a frame to texture coordinates. The texels are the nodes of a grid; u
/// and v are the dot products of these rows with (x, y, z, 1) [m].
struct PlaceOnGrid {
  glm::vec4 u{0.0F}, v{0.0F};
};
/// Returns the map from points of the frame `of_places` to the texture of a grid.
/// @param grid  in the frame `of_grid`.
[[nodiscard]] PlaceOnGrid PlaceOnGridOf(const HeightRaster& grid, const LocalFrame& of_grid,
                                        const LocalFrame& of_places);

class HorizonTexture {
 public:
  void Use(const TerrainHorizon& horizon);
  [[nodiscard]] bool HasAny() const { return horizon_.has_value(); }

  /// Returns the map from points of an anchor's frame to the texture.
  [[nodiscard]] PlaceOnGrid PlaceIn(const LocalFrame& anchor) const;

  /// Binds the sines of the horizon towards a direction to a texture unit.
  void Bind(int unit, const Vector<Ecef>& to_light);

 private:
  void Upload(double azimuth_rad);

  std::optional<TerrainHorizon> horizon_;
  std::optional<double> azimuth_rad_;  // azimuth of the uploaded horizon
  GlTexture texture_;
};

/// The visible terrain per pixel. The depth is 0 where there is no terrain.
class GBuffer : public RenderTarget {
 public:
  enum Output : std::size_t {
    /// Four floats: normal in the eye's frame, octahedral (gbuffer/octahedral.glsl); elevation of
    /// the shadow-casting disk above the terrain's edge, in radii of the disk; distance [m], 0: no
    /// terrain.
    kSurface,
    /// Four half floats each: irradiance of the sky lit by the sun and by the moon, in bands, as in
    /// VertexLight.
    kSky,
    kMoonSky,
  };

  /// @param width, height >= 1.
  GBuffer(int width, int height)
      : RenderTarget(width, height,
                     {PixelFormat::kRgba32F, PixelFormat::kRgba16F, PixelFormat::kRgba16F},
                     Depth::k32Bit) {}
};

/// Depth only, with the convention of a GBuffer: 0 where there is no terrain.
class DepthPrepass : public RenderTarget {
 public:
  /// @param width, height >= 1.
  DepthPrepass(int width, int height) : RenderTarget(width, height, {}, Depth::k32Bit) {}
};

/// Mirrors the uniform block `Land` of land/block.glsl.
struct LandBlock {
  static constexpr std::size_t kMostLevels = 32;
  glm::vec4 eye_high, eye_low;
  glm::vec4 east, north, up;
  glm::vec4 eye_sample, eye_above, pixel;
  glm::vec4 horizon_u, horizon_v;
  glm::vec4 risen, globe;
  std::array<glm::vec4, kMostLevels> turning;
};
static_assert(sizeof(LandBlock) == (12 + LandBlock::kMostLevels) * sizeof(glm::vec4));

/// Returns a block without levels, in which vertices do not morph. The size of the picture is that
/// of the viewport.
/// @param anchor     frame of the vertices.
/// @param new_light  weight of the new light.
[[nodiscard]] LandBlock LandBlockOf(const LocalFrame& anchor, const Place& eye, double new_light);

/// Shadow edges of the current sun (HorizonTexture), which replace those stored in the vertices.
struct MomentaryEdges {
  double share = 0.0;  // weight; 0: the vertices' shadow edges only
  Vector<Ecef> to_light{};
  double radius_rad = 0.0;
};

/// Target of a terrain pass: all outputs of a GBuffer, or only depth into a DepthPrepass.
enum class LandDrawn { kSurface, kOutline };

/// The parts of the land program that a picture needs.
struct LandLook {
  bool bends = true;    // refraction of the block View
  bool moonlit = true;  // the output GBuffer::kMoonSky, which is undefined otherwise
};

/// Identifies one program of land.
struct LandProgramKind {
  LandDrawn drawn;
  bool bends, moonlit;
  bool fades;                // the old light of vertices has a weight
  bool has_momentary_edges;  // MomentaryEdges

  auto operator<=>(const LandProgramKind&) const = default;
};
/// Returns the texts of a program before land/land.vert.glsl and before its fragment stage.
[[nodiscard]] std::vector<ShaderPiece> LandVertexTexts(const LandProgramKind& kind);
[[nodiscard]] std::vector<ShaderPiece> LandFragmentTexts(const LandProgramKind& kind,
                                                         const ShaderPiece& depth);

class LandPass {
 public:
  LandPass();

  /// Location of the first attribute of the light that fades out, and of the one that fades in.
  static constexpr unsigned kOldLight = 5, kNewLight = 10;
  /// Attributes of land/land.vert.glsl, in the order of their locations.
  static constexpr std::array<const char*, 15> kAttributes{
      "position",          "coarse_position",
      "sample_place",      "normal",
      "coarse_normal",     "sky",
      "coarse_sky",        "moon_sky",
      "coarse_moon_sky",   "disk_over_edge",
      "new_sky",           "new_coarse_sky",
      "new_moon_sky",      "new_coarse_moon_sky",
      "new_disk_over_edge"};

  /// Clears the bound GBuffer or DepthPrepass.
  static void Clear(LandDrawn drawn);
  void Use(const TerrainHorizon& horizon) { horizon_.Use(horizon); }
  void Use(const MomentaryEdges& edges) { edges_ = edges; }
  void Use(const EdgesOfVertices& edges) { edges_of_vertices_ = edges; }
  [[nodiscard]] bool HasHorizon() const { return horizon_.HasAny(); }

  /// Sets the program and the OpenGL state, then calls `draw`. The uniform block View must be bound
  /// to `view_binding`. Texture unit 0 is used.
  /// @param anchor    frame of the vertices.
  /// @param one_side  whether triangles that face away are culled.
  void Run(LandDrawn drawn, const LandLook& look, LandBlock block, const LocalFrame& anchor,
           GLuint view_binding, bool one_side, const std::function<void()>& draw);

  /// Creates one program that the next pictures may need, and returns whether there was one left.
  /// Drivers finish a program on its first draw, which takes tenths of a second. The targets of the
  /// last surface must be bound; nothing is drawn into them.
  bool MakeOneReady();

  /// Returns the shader text for the depth mode that the current OpenGL context supports.
  [[nodiscard]] static ShaderPiece DepthText();

 private:
  [[nodiscard]] const ShaderProgram& ProgramOf(const LandProgramKind& kind);
  void Draw(const LandProgramKind& kind, const ShaderProgram& program, bool one_side,
            const std::function<void()>& draw) const;
  void BindEdges(const ShaderProgram& program);
  [[nodiscard]] glm::vec4 RisenSinceMade(const LocalFrame& anchor) const;

  HorizonTexture horizon_;
  MomentaryEdges edges_;
  EdgesOfVertices edges_of_vertices_;
  bool reversed_depth_;
  GlBuffer block_;
  GLuint view_binding_ = 0;                   // of the last surface or outline
  std::optional<LandProgramKind> last_kind_;  // of the last surface
  GlVertexArray no_vertices_;
  std::map<LandProgramKind, ShaderProgram> programs_;  // created on first use
};

}  // namespace alpenglow::viewer
