// SPDX-License-Identifier: MIT
// Shafts: the volumetric shadows of terrain in the air.
//
// ShadeTexture holds a SunShadowMap on the GPU. A new map is uploaded line by line while the
// previous one is in use.
//
// ShaftPass renders the light that shadows remove from the ray of every few pixels, and the picture
// interpolates between them. In any direction the removed light is smooth over the picture, except
// at edges of terrain, where it jumps with the length of the ray. The map therefore holds both
// values, and the picture averages those neighbours whose rays are about as long as its own
// (shafts/picture.glsl).
//
// ShadeFollower updates the map for a moving eye and sun. Maps are made on a worker thread and
// uploaded some lines per frame. A new map is requested when the sun has moved by a fifth of its
// radius, when the eye has moved by a fifth of the map's half width, or when the ground has
// changed. Until it is ready, the previous map is used. At sixty times real time this takes five
// maps per second, each at most a third of a second late: the shadow lags by a third of the disk's
// radius, which is less than the width of its edges, and moves in steps of a fifth. At a thousand
// times real time it lags by five disks and moves in steps of three.
//
// Accuracy and cost by tests/bench/shade_error: the built-in range, 1280x720 with software OpenGL
// on two shared cores; errors relative to ShadowHeights as fractions of the light of unshadowed
// air, away from edges, for the sun at 15 to 1 degrees in front of and behind the eye.
//
//             mean             99th percentile   map        pass
//   low       0.15 - 0.6 %     1.5 - 6.7 %        13 ms       3.5 ms
//   medium    0.09 - 0.35 %    1.1 - 3.5 %        25 ms       7 ms
//   high      0.03 - 0.14 %    0.4 - 1.2 %       150 ms     120 ms
//
// The map is made on its own thread. Its heights take another 50, 90 and 360 ms once per place.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/terrain/loaded_heights.h"
#include "renderer/visibility/sun_shadow_map.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {

/// Resolution of ray marching in shafts/march.glsl.
struct ShadeSteps {
  int pieces;  // per ray interval; one table fetch of the air each
  int steps;   // per piece; one fetch of the map each
};

class ShadeTexture {
 public:
  /// Starts to upload a map. An unfinished upload of another map is abandoned.
  void TakeOver(std::shared_ptr<const SunShadowMap> map);
  /// Uploads up to `most_lines` lines of the new map through a texture unit. When all lines are
  /// uploaded, the map comes into use. Does nothing if there is no new map. Returns whether a map
  /// came into use.
  bool Upload(int most_lines, int unit);

  /// Returns whether a map is in use and it shadows anything.
  [[nodiscard]] bool Shades() const { return used_.map && !used_.map->ShadesNothing(); }
  /// Returns the map in use. Requires Shades().
  [[nodiscard]] const SunShadowMap& map() const { return *used_.map; }

  /// Sets the inputs of shafts/march.glsl in the program in use. Requires Shades().
  /// @param map_from_eye  from metres in the frame (east, north, up) at the eye to metres in the
  ///   frame of the map's heights.
  void Bind(const ShaderProgram& program, int unit, const glm::dmat4& map_from_eye,
            const ShadeSteps& steps) const;

 private:
  struct Held {
    GlTexture texture;
    std::shared_ptr<const SunShadowMap> map;
  };
  Held used_, coming_;
  int lines_sent_ = 0;
};

/// Resolution of the pass.
struct ShaftDetail {
  int scale;  // one ray per scale x scale pixels
  ShadeSteps steps;
};

class ShaftPass {
 public:
  /// @param air      texts that declare View and define SingleTo (shafts/march.glsl) and
  ///   SkyRadiance. The caller binds their blocks and samplers in program().
  /// @param has_media  whether MediaTexts follow them. Shadows then also remove sunlight from
  /// media.
  explicit ShaftPass(std::vector<ShaderPiece> air, bool has_media = false);

  [[nodiscard]] const ShaderProgram& program() const { return program_; }

  /// Renders the map of shafts for a picture of this size. Requires shade.Shades().
  /// @param surface_unit  holds a map of this size whose fourth component is the distance to
  ///   terrain [m], 0 where none is seen.
  /// @param shade_unit    free.
  void Paint(const ShadeTexture& shade, const glm::dmat4& map_from_eye, int width, int height,
             int surface_unit, int shade_unit, const ShaftDetail& detail);

  /// Returns whether Paint has been called.
  [[nodiscard]] bool HasMap() const { return map_.has_value(); }
  /// Sets the inputs of shafts/picture.glsl in a program, which becomes the one in use. The maps
  /// are bound to two units. Requires an earlier Paint.
  void Bind(const ShaderProgram& picture, int unit) const;

 private:
  bool has_media_;
  ShaderProgram program_;
  GlVertexArray no_vertices_;
  std::optional<RenderTarget> map_;
  int scale_ = 1;
};

/// Returns the texts of the pass that precede shafts/shafts.frag.glsl. The parameters are those of
/// ShaftPass.
[[nodiscard]] std::vector<ShaderPiece> ShaftPassTexts(std::vector<ShaderPiece> air, bool has_media);

/// Returns the texts that a fragment shader of the picture needs to call TakenByShade.
[[nodiscard]] std::vector<ShaderPiece> ShaftTexts();

struct ShadeSize {
  double half_width_m = 30e3;  // of the shadowing ground around the eye
  int samples = 1024;          // of the ground, per side at most
  int nodes_a_sample = 2;      // resampling factor; more preserve crests between nodes
  int cells = 1024;            // of the map, per side at most
  bool operator==(const ShadeSize&) const = default;
};

/// Keeps the map of shadows up to date. Must be used on the thread whose OpenGL context is current
/// at construction.
class ShadeFollower {
 public:
  explicit ShadeFollower(const Ellipsoid& ellipsoid);

  /// Sets the ground. An empty function means that there is none.
  void SetGround(GroundSampler sampler);
  void SetSize(const ShadeSize& size);

  /// Uploads finished maps through a texture unit and requests a new map if needed. Call it once
  /// per frame, before drawing. Never waits.
  /// @param light  in the frame east, north, up of the eye.
  /// @param share  the largest part of the light of any direction of the sky that this light brings,
  ///               in (0, 1]. The map of a light that brings little may be older: an edge of a shadow
  ///               is displaced by at most 0.2 radii of the disk over the share, and by 2 radii.
  void Follow(const Place& eye, const DistantLight& light, double share, int unit);
  /// Waits for the final result of Follow. Used for pictures that are saved.
  void WaitUntilReady(const Place& eye, const DistantLight& light, int unit);

  /// The map in use.
  [[nodiscard]] const ShadeTexture& shade() const { return texture_; }
  /// Returns whether the map in use is for a sun or moon within three degrees of this one. After a
  /// jump in time it differs for some frames.
  [[nodiscard]] bool IsOf(const Place& eye, const DistantLight& light) const;
  /// Returns the transformation from metres in the frame (east, north, up) at an eye to metres in
  /// the map's frame. Requires shade().Shades().
  [[nodiscard]] glm::dmat4 MapFromEye(const Place& eye) const;
  /// Computing time of the map in use; 0 before the first map.
  [[nodiscard]] double making_s() const { return used_ ? used_->making_s : 0.0; }

 private:
  struct Request {
    std::shared_ptr<const GroundSampler> ground;
    ShadeSize size;
    LocalFrame frame;
    glm::dvec3 to_light;  // in the frame
    double radius_rad;
    double most_step;  // to the direction of another light that this map suits, in radii
  };
  struct Made {
    LocalFrame frame;
    glm::dvec3 to_light;  // in the frame
    SunShadowMap map;
    double making_s;
  };
  /// Makes maps. It keeps the heights between maps of the same ground.
  class Maker;

  [[nodiscard]] Request RequestFor(const Place& eye, const DistantLight& light, double share) const;
  [[nodiscard]] static bool Suits(const Request& requested, const Request& wanted);
  void PollFinished();
  void Upload(int lines, int unit);

  Ellipsoid ellipsoid_;
  std::shared_ptr<const GroundSampler> ground_;
  ShadeSize size_;
  ShadeTexture texture_;
  std::shared_ptr<const Made> used_, coming_;
  AsyncValue<Request, std::shared_ptr<const Made>> maker_;
};

struct ShadeQuality {
  ShadeSize size;
  ShaftDetail detail;
};

inline constexpr ShadeQuality kLowShade{{30e3, 512, 2, 768}, {6, {2, 6}}};
/// A pass over the map of kLowShade with 0.47 times as many fetches: fewer rays and steps.
inline constexpr ShaftDetail kCoarseShaftDetail{8, {2, 5}};
inline constexpr ShadeQuality kMediumShade{{30e3, 1024, 2, 1024}, {5, {3, 6}}};
inline constexpr ShadeQuality kHighShade{{30e3, 1500, 3, 2048}, {2, {6, 8}}};

}  // namespace alpenglow::viewer
