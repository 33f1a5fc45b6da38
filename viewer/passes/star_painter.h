// SPDX-License-Identifier: MIT
// Stars and planets of a view, drawn over the picture as small squares of pixels.
//
// They are points, as in the renderer (night_light.h, star_pixels.h). Their illuminance does not
// depend on the size of the picture: each is spread over pixels with the renderer's StarBell. They
// are seen through the air and are hidden by land and moon. Their list is made on a worker thread
// and rotates with the sky until the next list. By day there is none.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/base/async_value.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/illumination/night_light.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/media/scene_media.h"
#include "viewer/passes/frame_sky.h"
#include "viewer/passes/painted_view.h"

namespace alpenglow::viewer {

/// One star, in the layout of stars/star.vert.glsl.
struct StarPoint {
  glm::vec4 corner;      // lower left pixel; pixel of its centre
  glm::vec4 towards;     // unit vector east, north, up at the eye
  glm::vec4 light;       // irradiance above the air over solid angle of a pixel, per band
                         // [W m^-2 sr^-1 nm^-1]
  glm::vec4 across, up;  // weights of the first four columns and rows
  glm::vec4 last;        // weights of the fifth column and row
};

/// Where a star is without refraction, and by how much refraction R raises it after it has risen by
/// a small angle x [rad]: R(x) = lift_rad + x (per_rise + x per_rise_squared).
struct RefractedStar {
  glm::dvec3 truly;  // unit vector to the star without refraction
  double lift_rad, per_rise, per_rise_squared;
};

/// Stars, the brightest first. Their directions are also stored apart from their light: a frame
/// tests all of them for the few that are in the picture.
class StarList {
 public:
  /// @param bent  the refraction that raised the lights; null: they have true directions.
  // NOLINTNEXTLINE(google-explicit-constructor): a list is what its stars are
  StarList(std::vector<StarLight> lights, const RefractedView* bent = nullptr);

  [[nodiscard]] const std::vector<StarLight>& lights() const { return lights_; }
  /// Directions of lights().
  [[nodiscard]] const std::vector<glm::dvec3>& directions() const { return directions_; }
  /// Returns the number of stars that are not fainter.
  [[nodiscard]] std::size_t CountDownTo(double faintest_lux) const;

  /// Returns the unit vector to the apparent position of a star: its true direction is rotated,
  /// then refracted at its new elevation. During 30 seconds, in which a star rises by 0.13 degrees,
  /// the error is below 6", as that of RefractedView.
  /// @param star  position in lights().
  /// @param turn  rotation from the directions of the lights to the current ones.
  [[nodiscard]] glm::dvec3 Towards(std::size_t star, const glm::dmat3& turn) const;

 private:
  std::vector<StarLight> lights_;
  std::vector<glm::dvec3> directions_;
  std::vector<RefractedStar> refracted_;
};

/// The stars above an eye.
struct StarrySky {
  const StarList& stars;
  glm::dmat3 turn;      // from the directions of the lights to the current ones
  double faintest_lux;  // fainter stars are not drawn
  glm::dvec3 to_moon;   // unit vector to the moon, which hides stars
  double moon_radius_rad;
};

/// Returns the stars that are in the picture.
[[nodiscard]] std::vector<StarPoint> StarPointsIn(const PaintedView& view, const StarrySky& sky);

/// Returns the rotation of the sky during a time, for directions east, north, up at a latitude.
[[nodiscard]] glm::dmat3 TurnOfSky(double latitude_rad, double seconds);

/// Draws the stars. Must be used on the thread whose OpenGL context is current at construction.
class StarPainter {
 public:
  StarPainter();

  /// Takes over a finished list and requests a new one if needed. Call it once per frame. Never
  /// waits.
  void Follow(const PaintedView& view, const FrameSky& sky,
              const std::shared_ptr<const SolvedAir>& air);
  /// Waits for the list of exactly this instant.
  void WaitUntilReady(const PaintedView& view, const FrameSky& sky,
                      const std::shared_ptr<const SolvedAir>& air);

  /// Illuminance of a level surface by the sky in which the stars are seen; 0 by day.
  [[nodiscard]] double sky_lux() const { return sky_lux_; }
  /// Returns whether it is dark enough and the stars are known.
  [[nodiscard]] bool HasAny() const { return sky_lux_ > 0.0 && maker_.value(); }
  /// Draws once with the program if it has not been drawn yet. Drivers finish compiling it then,
  /// which takes tenths of a second.
  void MakeReady(const PaintedView& view, const SceneMedia& media);
  /// Returns the pixels that stars cover in a picture of a view.
  [[nodiscard]] std::vector<PixelBox> Seen(const PaintedView& view, const FrameSky& sky) const;
  /// Source of occlusion by land: the surface map, which has the size of the target, at the pixel
  /// of the star's centre; or the depth of the target for each pixel, if the depth test is enabled.
  enum class Land { kBySurface, kByDepth };
  /// Adds the stars to the bound target. Surface map, air and blocks must be bound.
  void Paint(const PaintedView& view, const FrameSky& sky, Land land, const SceneMedia& media);

 private:
  struct Request {
    Place place;
    UtcTime now;
    std::shared_ptr<const BandColour> colour;
    std::shared_ptr<const SolvedAir> air;  // refracts their light
  };
  struct Made {
    Request request;
    StarList stars;
  };

  [[nodiscard]] bool IsNight(const FrameSky& sky, const std::shared_ptr<const SolvedAir>& air);
  [[nodiscard]] static bool Suits(const Request& requested, const Request& wanted);
  void Connect(const SceneMedia& media);
  [[nodiscard]] std::vector<StarPoint> PointsIn(const PaintedView& view, const FrameSky& sky) const;
  void Draw(const std::vector<StarPoint>& points, const PaintedView& view, Land land) const;

  GlBuffer buffer_;
  GlVertexArray vertices_;
  std::optional<ShaderProgram> program_;  // created on first draw
  std::shared_ptr<const BandColour> colour_;
  double sky_lux_ = 0.0;  // illuminance by the sky; 0: day
  AsyncValue<Request, Made> maker_;
};

}  // namespace alpenglow::viewer
