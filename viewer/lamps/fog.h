// SPDX-License-Identifier: MIT
// Light of sun and sky in a scene's fog around one eye, ready for interpolation by a graphics card:
// FogLight (renderer/media/fog_light.h) summed along rays. Per unit solar irradiance.
//
// Along a ray light is kept over the share of light that the fog takes away,
//
//   L(d) = (1 - T(d)) [p A + p' B + G + K],    T = exp(-tau(d)), of the fog alone
//
// A of the sun itself with the fog's phase function p, B of what its forward peak takes along with
// the lobe p', G of the sun's glow in the fog, K of the sky. Tables are over the sine of the ray's
// elevation, its azimuth from the sun and (1 - T(d)) / (1 - T(end)), where the ray ends at the bare
// planet or in space. A, B and G are those of open ground: terrain does not shade them.
//
// A FogMap that follows eye and sun, made beside drawing.
//
// A FogMap on the graphics card, for fog_light.glsl.
//
// The fog of a scene on the graphics card: a FogMap that is made beside drawing, for other air and
// other sizes by a job of its own.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/sun/sun.h"
#include "renderer/light/lighting.h"
#include "renderer/media/local_media.h"
#include "viewer/air/solved_air.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/job/latest_job.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// How fine a map is. Off from MediaLight by 0.1 % in the mean by day and 0.5 % with the sun on the
/// horizon, where light in fog falls by e every few metres (99 %: 2 % and 5 %; fine: half of all).
/// The time to make one grows with elevations times azimuths.
struct FogMapSize {
  int elevations = 128;  // even: half of them over the horizon
  int azimuths = 16;     // from 0 to pi
  int depths = 12;

  bool operator==(const FogMapSize&) const = default;
};
inline constexpr FogMapSize kCoarseFog{48, 12, 8};
inline constexpr FogMapSize kFineFog{192, 24, 16};

/// Sun and eye, east, north and up at the eye, on the sphere of the air's medium.
struct FogView {
  double altitude_m = 0.0;
  glm::dvec3 to_sun{0.0, 0.0, 1.0};  // unit, to where it is seen
  glm::dvec3 to_sun_for_air{0.0, 0.0,
                            1.0};  // unit, to where it lights the sky from (SunForAir of sun.h)
  double sun_radius_rad = 0.0046;
};

/// Immutable once made; no graphics card needed.
struct FogMap {
  FogView view;
  FogMapSize size;
  /// A, B, G and K, one after another: [((quantity * depths + depth) * azimuths + azimuth) *
  /// elevations + elevation].
  std::vector<glm::vec4> light;
  /// What the fog's own light brings to level ground and what a surface that stands upright gets
  /// more, at altitudes whose optical depth above is (i / last)^4 of the layer's: [row * kHeights +
  /// i]. W/m^2 per W/m^2.
  static constexpr int kHeights = 64;
  std::vector<glm::vec4> on_surface;
  double extinction_per_m, scale_height_m, base_m, top_m, radius_m;
  double depth;       // of the layer, vertical
  double peak_scale;  // of optical depths, without what the forward peak takes along
  PhaseFunction phase;
  double broad_g;
};

/// @param fog  of LocalMedia; bottom_m: altitude of the ground under it.
/// @param air  of at most four bands.
/// Errors of rays against MediaLight: tests/viewer/lamps/fog_map_test.cpp.
[[nodiscard]] FogMap MakeFogMap(const LocalMedium& fog, double bottom_m, const SunlitAir& air,
                                const FogView& view, const FogMapSize& size = {});

/// Whether light around this eye and under this sun is that of the map, but for a few per cent: the
/// eye within a tenth of the fog's scale height, the sun within a tenth of a degree. What falls off
/// faster, transmittance and the phase function towards the sun, is not in the map.
[[nodiscard]] bool Serves(const FogMap& map, const FogView& view);

class FogFollower {
 public:
  using Make = std::function<FogMap(const FogView&)>;
  /// @param make  called on a thread of this; what it refers to must outlive this.
  explicit FogFollower(Make make) : job_(std::move(make)) {}

  /// Takes in what is finished and asks for what is needed. True when map() is a new one.
  [[nodiscard]] bool Follow(const FogView& view);
  /// Waits for a map for the view.
  void Wait(const FogView& view);
  [[nodiscard]] const std::optional<FogMap>& map() const { return map_; }

 private:
  std::optional<FogMap> map_;
  LatestJob<FogView, FogMap> job_;
};

/// `block Fog` of fog_light.glsl.
struct FogBlock {
  glm::vec4 layer, eye, sun, phase, map_size;
};
static_assert(sizeof(FogBlock) == 5 * sizeof(glm::vec4));

/// Texts for a fragment stage, after SharedTexts(): FogTo(direction, distance_km) and the rest of
/// fog_light.glsl. @param kind  of the fog's phase function.
[[nodiscard]] std::vector<ShaderPiece> FogTexts(PhaseKind kind);

/// The same functions where there is no fog.
[[nodiscard]] std::vector<ShaderPiece> NoFogTexts();

/// Where what fog reads is bound.
struct FogUnits {
  GLuint block = 9;
  int first = 13;  // of two texture units
};

class FogPainter {
 public:
  explicit FogPainter(const FogUnits& units) : units_(units) {}
  void Connect(const ShaderProgram& program) const;
  /// Takes a map in.
  void Upload(const FogMap& map);
  /// For the next draw of a program of FogTexts(). @param map  that was taken in last.
  void Bind(const FogMap& map, const FogView& now) const;

 private:
  FogUnits units_;
  GlBuffer block_;
  GlTexture light_, surface_;
};

class SceneFog {
 public:
  /// @param media  the last of which is fog.
  SceneFog(LocalMedia media, const FogMapSize& size, const FogUnits& units);

  /// Of maps from the next Follow or Settle on.
  void SetSize(const FogMapSize& size);

  /// Once a frame: takes over what is ready and asks for what is missing. Waits only for the first
  /// map in an air.
  /// @param sun  apparent, seen from the eye.
  void Follow(const std::shared_ptr<const SolvedAir>& air, const Eye& eye, const SunPosition& sun);
  /// Waits for what the view needs.
  void Settle(const std::shared_ptr<const SolvedAir>& air, const Eye& eye, const SunPosition& sun);

  /// At an altitude [1/m].
  [[nodiscard]] double ExtinctionAt(double altitude_m) const;

  /// Ties a program of FogTexts() to what it reads.
  void Connect(const ShaderProgram& program) const { painter_.Connect(program); }
  /// For the next draw of such a program. After Follow or Settle.
  void Bind(const Eye& eye, const SunPosition& sun) const;

 private:
  void BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad);

  std::shared_ptr<const LocalMedia> media_;
  FogMapSize size_;
  FogPainter painter_;
  std::shared_ptr<const SolvedAir> air_;  // that maps are made in; null: none yet of this size
  std::optional<FogFollower> follower_;
};

}  // namespace alpenglow::viewer
