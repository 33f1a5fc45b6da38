// SPDX-License-Identifier: MIT
// A ShadeMap on the graphics card, taken over line by line while the one before is in use.
//
// Shafts as a pass of their own: what shade takes from the rays of every few pixels, for the
// picture to take between them.
//
// In every direction light that is missing runs smoothly over the picture but at the edges of
// terrain, where it jumps with the distance that rays come. So the map holds both, and the picture
// takes the mean of what its neighbours say that have come about as far as its own ray
// (shafts.glsl).
//
// Keeps the map of shade up with an eye that moves and a sun that does: made on a thread beside
// drawing, sent to the card some lines a frame.
//
// A map is asked for anew when the sun has moved by a fifth of its radius, when the eye has come a
// fifth of the map's half width, and when there is other ground. Until it is there the one before
// serves. At sixty times the pace of time that is five maps a second, each a third of a second late
// at most: shade lags by a third of the disk's radius, less than its edges are soft, and goes on in
// steps of a fifth. At a thousand times it lags by five disks and goes in steps of three.
//
// How fine shafts are drawn.
//
// tests/bench/shade_error: the built-in range, 1280x720 on software OpenGL with two cores, which
// others used too; errors against ShadowHeights as shares of the light of unshaded air, away from
// edges, for the sun at 15 to 1 degrees before and behind the eye.
//
//             mean             99th percentile   map        pass
//   low       0.15 - 0.6 %     1.5 - 6.7 %        13 ms       3.5 ms
//   medium    0.09 - 0.35 %    1.1 - 3.5 %        25 ms       7 ms
//   high      0.03 - 0.14 %    0.4 - 1.2 %       150 ms     120 ms
//
// The map is made on its own thread; the heights it is made from take 50, 90 and 360 ms more once a
// place.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/sun.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/job/latest_job.h"
#include "viewer/land/loaded_heights.h"
#include "viewer/shade/shade_map.h"

namespace alpenglow::viewer {

/// How finely rays are stepped through: shade_march.glsl.
struct ShadeSteps {
  int pieces;  // of a ray's stretch, one look at the table of the air each
  int steps;   // of a piece, one look at the map each
};

class ShadeTexture {
 public:
  /// A map to take over; one that is being taken over is given up.
  void TakeOver(std::shared_ptr<const ShadeMap> map);
  /// Sends up to so many of its lines, by way of a texture unit; once all are there the map is in use. Nothing to do: nothing
  /// is done.
  /// Returns whether a map came into use.
  bool Upload(int most_lines, int unit);

  /// Whether there is a map in use, and it shades anything.
  [[nodiscard]] bool Shades() const { return used_.map && !used_.map->ShadesNothing(); }
  /// The map in use. Only where Shades().
  [[nodiscard]] const ShadeMap& map() const { return *used_.map; }

  /// Gives the program in use what shade_march.glsl reads. Only where Shades().
  /// @param map_from_eye  from metres in the frame (east, north, up) at the eye to those of the
  ///                      frame of the map's heights.
  void Bind(const ShaderProgram& program, int unit, const glm::dmat4& map_from_eye,
            const ShadeSteps& steps) const;

 private:
  struct Held {
    GlTexture texture;
    std::shared_ptr<const ShadeMap> map;
  };
  Held used_, coming_;
  int lines_sent_ = 0;
};

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

struct ShadeSize {
  double half_width_m = 30e3;  // of the ground whose shade counts, around the eye
  int samples = 1024;          // of it a side at most
  int nodes_a_sample = 2;      // that they are read at: more keep crests that run between nodes
  int cells = 1024;            // of the map a side at most
  bool operator==(const ShadeSize&) const = default;
};

/// To be used on the thread of the context that is current when it is made.
class ShadeFollower {
 public:
  explicit ShadeFollower(const Ellipsoid& ellipsoid);

  /// Other ground, or more of it. An empty function: none.
  void SetGround(GroundSampler sampler);
  void SetSize(const ShadeSize& size);

  /// Once a frame, before drawing: takes over what is ready, by way of a texture unit, and asks for
  /// what is missing. Never waits.
  /// @param sun  apparent, seen from the eye.
  void Follow(const GeodeticPosition& eye, const SunPosition& sun, int unit);
  /// The same, but what Follow would show in the end is there when it returns: for pictures that
  /// are kept.
  void Settle(const GeodeticPosition& eye, const SunPosition& sun, int unit);

  /// What is shown.
  [[nodiscard]] const ShadeTexture& shade() const { return texture_; }
  /// Whether that is the shade of a sun or moon within three degrees of one: after a jump in time it is
  /// of another for some frames.
  [[nodiscard]] bool IsOf(const GeodeticPosition& eye, const SunPosition& sun) const;
  /// From metres in the frame (east, north, up) at an eye to those of the map's. Only where
  /// shade().Shades().
  [[nodiscard]] glm::dmat4 MapFromEye(const GeodeticPosition& eye) const;
  /// Time that the map shown took to make; 0 before the first.
  [[nodiscard]] double making_s() const { return used_ ? used_->making_s : 0.0; }

 private:
  struct Request {
    std::shared_ptr<const GroundSampler> ground;
    ShadeSize size;
    LocalFrame frame;
    glm::dvec3 to_sun;  // in the frame
    double sun_radius_rad;
  };
  struct Made {
    LocalFrame frame;
    glm::dvec3 to_sun;  // in the frame
    ShadeMap map;
    double making_s;
  };
  /// Makes maps; keeps heights between maps of the same ground.
  class Maker;

  [[nodiscard]] Request RequestFor(const GeodeticPosition& eye, const SunPosition& sun) const;
  [[nodiscard]] bool Suits(const Request& asked, const Request& wanted) const;
  void Ask(const GeodeticPosition& eye, const SunPosition& sun);
  void TakeFinished();
  void Upload(int lines, int unit);

  Ellipsoid ellipsoid_;
  std::shared_ptr<const GroundSampler> ground_;
  ShadeSize size_;
  ShadeTexture texture_;
  std::optional<Request> asked_;
  std::shared_ptr<const Made> used_, coming_;
  LatestJob<Request, std::shared_ptr<const Made>> maker_;
};

struct ShadeQuality {
  ShadeSize size;
  ShaftDetail detail;
};

inline constexpr ShadeQuality kLowShade{{30e3, 512, 2, 768}, {6, {2, 6}}};
/// A pass over kLowShade's map that looks at it 0.47 times as often: fewer rays and steps.
inline constexpr ShaftDetail kCoarseShaftDetail{8, {2, 5}};
inline constexpr ShadeQuality kMediumShade{{30e3, 1024, 2, 1024}, {5, {3, 6}}};
inline constexpr ShadeQuality kHighShade{{30e3, 1500, 3, 2048}, {2, {6, 8}}};

}  // namespace alpenglow::viewer
