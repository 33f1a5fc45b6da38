// SPDX-License-Identifier: MIT
// Provides the light of sun and sky in a scene's fog: FogMap, its table around one eye,
// FogPainter, which uploads it for fog_light.glsl, and SceneFog, which computes maps for a moving eye
// and sun beside drawing.
//
// A FogMap holds FogLight (renderer/media/fog_light.h) summed along rays, for interpolation on the
// GPU. Values are per unit solar irradiance. Along a ray they are relative to the fraction of light
// that the fog removes,
//
//   L(d) = (1 - T(d)) [p A + p' B + G + K],    T = exp(-tau(d)), of the fog alone
//
// A is the light of the sun itself, scattered with the fog's phase function p; B is the light in
// its forward peak, scattered with the lobe p'; G is the glow of the sun in the fog; K is the light
// of the sky. Tables are over the sine of the ray's elevation, its azimuth from the sun and
// (1 - T(d)) / (1 - T(end)), where the ray ends at the bare planet or in space. A, B and G are for
// open ground: terrain does not shade them.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/lighting.h"
#include "renderer/media/local_media.h"
#include "viewer/async/async_value.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Resolution of a map. Its mean difference from MediaLight is 0.1 % by day and 0.5 % with the sun
/// on the horizon, where light in fog decreases by a factor e every few metres (99 %: 2 % and 5 %;
/// kFineFog: half of all these). The computation time is proportional to elevations times azimuths.
struct FogMapSize {
  int elevations = 128;  // even: half of them above the horizon
  int azimuths = 16;     // from 0 to pi
  int depths = 12;

  bool operator==(const FogMapSize&) const = default;
};
inline constexpr FogMapSize kCoarseFog{48, 12, 8};
inline constexpr FogMapSize kFineFog{192, 24, 16};

/// Sun and eye in the frame east, north, up at the eye, on the sphere of the air's medium.
struct FogView {
  double altitude_m = 0.0;
  glm::dvec3 to_sun{0.0, 0.0, 1.0};  // unit, to the sun as seen
  glm::dvec3 to_sun_for_air{0.0, 0.0,
                            1.0};  // unit, from where it illuminates the sky (SunForAir of sun.h)
  double sun_radius_rad = 0.0046;
};

/// Table of the light in fog. It is immutable and needs no GPU.
struct FogMap {
  FogView view;
  FogMapSize size;
  /// A, B, G and K in this order: [((quantity * depths + depth) * azimuths + azimuth) * elevations
  /// + elevation].
  std::vector<glm::vec4> light;
  /// Irradiance of the fog's own light on level ground, and the additional irradiance on a vertical
  /// surface, at altitudes with an optical depth above of (i / last)^4 of the layer's: [row *
  /// kHeights + i]. W/m^2 per W/m^2.
  static constexpr int kHeights = 64;
  std::vector<glm::vec4> on_surface;
  double extinction_per_m, scale_height_m, base_m, top_m, radius_m;
  double depth;       // vertical optical depth of the layer
  double peak_scale;  // factor on optical depths that excludes the forward peak
  PhaseFunction phase;
  double broad_g;
};

/// @param fog  fog of LocalMedia; bottom_m: altitude of the ground below it.
/// @param air  medium of at most four bands.
/// tests/viewer/lamps/fog_map_test.cpp bounds the errors of rays against MediaLight.
[[nodiscard]] FogMap MakeFogMap(const LocalMedium& fog, double bottom_m, const SunlitAir& air,
                                const FogView& view, const FogMapSize& size = {});

/// Returns whether the map of one eye and sun is valid for others, to a few per cent: the eye is
/// within a tenth of the fog's scale height, at most 100 m, and the sun within a tenth of a degree.
/// Quantities that vary faster, transmittance and the phase function towards the sun, are not in
/// the map.
[[nodiscard]] bool Serves(const FogView& made, const FogView& wanted, double scale_height_m);

/// Mirrors the uniform block `Fog` of fog_light.glsl.
struct FogBlock {
  glm::vec4 layer, eye, sun, phase, map_size;
};
static_assert(sizeof(FogBlock) == 5 * sizeof(glm::vec4));

/// Returns texts for a fragment stage, which follow SharedTexts(): FogTo(direction, distance_km)
/// and the rest of fog_light.glsl. @param kind  kind of the fog's phase function.
[[nodiscard]] std::vector<ShaderPiece> FogTexts(PhaseKind kind);

/// Returns texts with these functions for scenes without fog.
[[nodiscard]] std::vector<ShaderPiece> NoFogTexts();

/// Binding points of the fog's data.
struct FogUnits {
  GLuint block = 9;
  int first = 13;  // first of two texture units
};

class FogPainter {
 public:
  explicit FogPainter(const FogUnits& units) : units_(units) {}
  void Connect(const ShaderProgram& program) const;
  /// Uploads a map.
  void Upload(const FogMap& map);
  /// Binds everything for the next draw call of a program of FogTexts(). @param map  the last
  /// uploaded map.
  void Bind(const FogMap& map, const FogView& now) const;

 private:
  FogUnits units_;
  GlBuffer block_;
  GlTexture light_, surface_;
};

class SceneFog {
 public:
  /// @param media  media whose last one is fog.
  SceneFog(LocalMedia media, const FogMapSize& size, const FogUnits& units);

  /// Sets the size of maps from the next Follow or Settle on.
  void SetSize(const FogMapSize& size);

  /// Takes a finished map and requests a missing one. Call it once a frame. It waits only for the
  /// first map in a medium.
  /// @param sun  apparent position, seen from the eye.
  void Follow(const std::shared_ptr<const SolvedAir>& air, const Eye& eye, const SunPosition& sun);
  /// Waits for the map of the view.
  void Settle(const std::shared_ptr<const SolvedAir>& air, const Eye& eye, const SunPosition& sun);

  /// Returns the extinction of the fog at an altitude [1/m].
  [[nodiscard]] double ExtinctionAt(double altitude_m) const;

  /// Connects a program of FogTexts() with the bound data.
  void Connect(const ShaderProgram& program) const { painter_.Connect(program); }
  /// Binds everything for the next draw call of such a program. Call it after Follow or Settle.
  void Bind(const Eye& eye, const SunPosition& sun) const;

 private:
  void BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad);

  std::shared_ptr<const LocalMedia> media_;
  FogMapSize size_;
  FogPainter painter_;
  std::shared_ptr<const SolvedAir> air_;  // medium of the maps; null: no map of this size yet
  std::optional<AsyncValue<FogView, FogMap>> maps_;
};

}  // namespace alpenglow::viewer
