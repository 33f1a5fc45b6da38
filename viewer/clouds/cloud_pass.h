// SPDX-License-Identifier: MIT
// Draws the light of clouds before the picture: the layers along the rays of one of 1, 4 or 9 pixels
// (clouds/march.frag.glsl), then their colours behind air (clouds/colour.frag.glsl). The programs of
// the picture interpolate the result (clouds/picture.glsl) and take the shadows of clouds from the
// same textures (clouds/light.glsl).
//
// A frame that continues a moving picture follows only a quarter of the rays, another one each time. The
// others have the light of the frame before, moved to where their clouds are seen now
// (clouds/renew.frag.glsl). So no light is older than three frames, and none is kept after jumps.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/mat3x3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "viewer/clouds/cloud_follower.h"
#include "viewer/clouds/cloud_quality.h"
#include "viewer/clouds/cloud_textures.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Returns the texts of clouds for a fragment stage of the picture.
/// @param layers  number of layers that are drawn, >= 1.
[[nodiscard]] std::vector<ShaderPiece> CloudTexts(int layers);

/// Binding points of the data of clouds.
struct CloudUnits {
  GLuint block;
  int first;    // of kTextures units that programs of the picture read
  int surface;  // the surface map
  int march;    // of CloudTextures::kMarchUnits units that only the passes before the picture read

  static constexpr int kTextures = 4;  // light of new and of earlier clouds; clouds; their beam
};

/// The picture that clouds are gathered for.
struct CloudFrame {
  int width, height;
  glm::mat3 screen_from_direction;  // times the distance along the view; (-1, -1) to (1, 1)
  double eye_altitude_m;
  bool continues;  // the frame before was drawn shortly before
};

class CloudPass {
 public:
  /// Properties of a program of colours.
  struct Kind {
    int layers;
    bool two_lights;
    auto operator<=>(const Kind&) const = default;
  };
  /// Makes the program that gives clouds their colours, with the view, the air and its tables connected.
  using MakeColours = std::function<ShaderProgram(const Kind& kind)>;

  /// @param view  texts of the view.
  CloudPass(std::vector<ShaderPiece> view, GLuint view_binding, MakeColours colours,
            const CloudUnits& units);

  /// Gathers the light of all layers in a view, whose surface map is bound.
  void Gather(const CloudFollower& clouds, const CloudsBlock& block, const CloudFrame& frame,
              const CloudQuality& quality);
  /// Gives the gathered light its colours.
  void Colour(const CloudFollower& clouds, bool two_lights, int width, int height);
  /// Connects a program of the picture.
  void Connect(const ShaderProgram& program) const;
  /// Binds everything for the next draw call of a program that is connected and in use.
  void Bind(const ShaderProgram& program) const;

 private:
  using MarchKind = std::pair<int, int>;  // steps, steps towards the light
  /// The light of all layers in a frame, and the clouds that it is of.
  struct Gathered {
    CloudFrame frame;
    CloudsBlock block;
    CloudQuality quality;
    std::shared_ptr<const CloudTextures> shown, earlier;
    std::vector<RenderTarget> layers;
  };
  /// Rays of a map: the texel of the first, and texels from each to the next.
  struct MapRays {
    int x, y, step;
  };
  /// Returns whether a frame may take over light of the last one.
  [[nodiscard]] static bool Continues(const Gathered& last, const Gathered& next);
  [[nodiscard]] const ShaderProgram& March(const CloudQuality& quality);
  [[nodiscard]] const ShaderProgram& Renewal();
  /// Uses a program with clouds/rays.glsl for a picture of this size.
  void UseForRays(const ShaderProgram& program, int width, int height) const;
  void PaintLayer(const ShaderProgram& march, const CloudFollower& clouds, std::size_t layer,
                  const MapRays& rays) const;
  /// Gathers a quarter of the rays of each layer, and fills the map from the last frame.
  void Renew(const CloudFollower& clouds, const Gathered& last, const Gathered& next);
  void RenewLayer(std::size_t layer, const Gathered& last, const Gathered& next,
                  const MapRays& rays);

  std::vector<ShaderPiece> view_;
  GLuint view_binding_;
  MakeColours make_colours_;
  CloudUnits units_;
  std::map<MarchKind, ShaderProgram> marches_;
  std::map<Kind, ShaderProgram> colours_;
  std::optional<ShaderProgram> renewal_;
  std::optional<Gathered> gathered_;
  std::vector<RenderTarget> spare_;  // layers of the frame before, to be drawn into next
  std::optional<RenderTarget> quarter_;
  int renewals_ = 0;
  std::optional<RenderTarget> clouds_;
  int scale_ = 1;
  GlBuffer block_;
  GlVertexArray no_vertices_;
};

}  // namespace alpenglow::viewer
