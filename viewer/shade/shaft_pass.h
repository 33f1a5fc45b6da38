// SPDX-License-Identifier: MIT
// Shafts as a pass of their own: what shade takes from the rays of every few pixels, for the
// picture to take between them.
//
// In every direction light that is missing runs smoothly over the picture but at the edges of
// terrain, where it jumps with the distance that rays come. So the map holds both, and the picture
// takes the mean of what its neighbours say that have come about as far as its own ray
// (shafts.glsl).
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/shade/shade_texture.h"

namespace alpenglow::viewer {

/// Sizes of the pass.
struct ShaftDetail {
  int scale;  // a ray for so many pixels across, and up
  ShadeSteps steps;
};

class ShaftPass {
 public:
  /// @param air  texts that say what View is and define SingleTo (shade_march.glsl) and SkyRadiance. Their blocks
  ///             and samplers are for the caller to bind, in program().
  /// @param has_fog  these are followed by FogTexts, and shade takes sunlight from fog, too.
  explicit ShaftPass(std::vector<ShaderPiece> air, bool has_fog = false);

  [[nodiscard]] const ShaderProgram& program() const { return program_; }

  /// Paints for a picture of that size. Only where shade.Shades().
  /// @param surface_unit  of a map of that size whose fourth component is the distance to terrain
  ///                      [m], 0 where none is seen.
  /// @param shade_unit    free.
  void Paint(const ShadeTexture& shade, const glm::dmat4& map_from_eye, int width, int height,
             int surface_unit, int shade_unit, const ShaftDetail& detail);

  /// Whether Paint has been called.
  [[nodiscard]] bool HasMap() const { return map_.has_value(); }
  /// Gives a program, which becomes the one in use, what shafts.glsl reads: from two units. After Paint.
  void Bind(const ShaderProgram& picture, int unit) const;

 private:
  bool has_fog_;
  ShaderProgram program_;
  GlVertexArray no_vertices_;
  std::optional<RenderTarget> map_;
  int scale_ = 1;
};

/// Texts of the pass but its last, shafts.frag.glsl; parameters as of ShaftPass.
[[nodiscard]] std::vector<ShaderPiece> ShaftPassTexts(std::vector<ShaderPiece> air, bool has_fog);

/// What the fragment shader of a picture needs to ask TakenByShade.
[[nodiscard]] std::vector<ShaderPiece> ShaftTexts();

}  // namespace alpenglow::viewer
