// SPDX-License-Identifier: MIT
// This header computes the light of sun, sky and lamps in local media (volumes and fog), and the
// transmittance of local media.
//
// Volumes scatter light once. Sunlight arrives through the air (RefractedBeam), the terrain's
// shadow, and every volume and the fog on its path. Skylight is given by its moments
// (MultipleScattering) and the phase function, and attenuated by the mean transmittance of the
// volumes over 26 directions. Light that a volume scatters again is neglected. Columns towards the
// sun through a gridded volume are taken from a grid of at most 64 samples per side; the error is 2
// % of the sun's light in turbulent smoke with as many samples itself.
//
// The eight lamps of the scene that are brightest at a volume light it, through air, fog and
// volumes (optical depths are from a grid of at most 24 samples per side), shadowed by terrain.
//
// Fog is lit by sun and sky to all orders as a level layer (EddingtonSlab) over the lowest ground.
// The first order of the sun is exact along the ray; its glow in fog is present only where terrain
// lets the sun in. Air scatters inside fog too, but is lit as if there were no media; media cast no
// shafts of shadow into the air.
//
// MarchMedia integrates light along a ray through local media:
//
//   L = integral of  T(t) sum over bodies density(t) j(t)  dt,     T = exp(-sum of columns)
//
// The ray is divided into panels. A panel has the 7 nodes of Kronrod's rule, three of which are
// Gauss nodes (Kronrod 1965; the numbers are those of QUADPACK, Piessens et al. 1983). Columns at
// the nodes are integrals of the polynomial through the densities there, so that only densities and
// sources need to be evaluated. The difference of the two rules is the error estimate; a panel
// whose error exceeds its share is halved. No panel is initially deeper than 2 in optical depth or
// longer than a block of a grid, so that none steps over unseen structure. Pieces without density
// are skipped.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/material/band_light.h"
#include "renderer/media/local_media.h"
#include "renderer/visibility/sunlit_path.h"

namespace alpenglow::renderer {

/// A stretch of the ray. Pieces are in order and do not overlap; there are no media between them.
struct MarchedPiece {
  double begin_m, end_m;
  // Transmittance for light from the end, and its mean over the piece:
  BandLight transmittance, mean_transmittance;
  // Transmittance of volumes alone, without fog, and its mean:
  BandLight past_volumes, mean_past_volumes;
};

struct MarchedLight {
  BandLight radiance;       // W m^-2 sr^-1 nm^-1
  BandLight transmittance;  // of all media; values below 1e-6 in every band are not resolved
  double error = 0.0;       // estimate, relative to the radiance of the brightest band
  std::size_t nodes = 0;    // number of evaluations of the sources
  std::vector<MarchedPiece> pieces;
};

/// Returns the light that bodies of these densities emit towards the origin at a point [W m^-2
/// sr^-1 nm^-1 per metre], without attenuation by media in between.
using MediaSource = std::function<BandLight(double distance_m, const glm::dvec3& point,
                                            std::span<const double> densities)>;

inline constexpr double kMarchTolerance = 2e-3;

/// Integrates the light along a ray.
/// @param direction  unit.
/// @param length_m  may be infinite.
/// @param tolerance  of the result's relative error, in [1e-6, 0.1]. It is tested against midpoint
///     sums a thousand times finer, over homogeneous, exponential and turbulent gridded bodies,
///     with sources that are smooth or follow a shadow: tests/renderer/media/media_march_test.cpp.
/// @param cuts_m  distances where panels must end: where the ray is nearest to a lamp.
[[nodiscard]] MarchedLight MarchMedia(const LocalMedia& media, const glm::dvec3& origin,
                                      const glm::dvec3& direction, double length_m,
                                      const MediaSource& source, double tolerance = kMarchTolerance,
                                      std::span<const double> cuts_m = {});

/// Media that attenuate light from behind them.
enum class Behind { kAll, kVolumes };

/// Returns the light of the air itself that arrives through media; it is scattered in front of
/// them, inside and behind them. The result is exact in front of and behind media. Within stretches
/// of media over which transmittance falls by 0.15 at most, light is assumed to increase linearly.
/// @param upto  light of the air up to a distance, increasing.
/// @param whole  of the whole ray.
[[nodiscard]] BandLight DimmedByMedia(const std::vector<MarchedPiece>& pieces,
                                      const std::function<BandLight(double)>& upto,
                                      const BandLight& whole, Behind behind);

/// Returns the transmittance of volumes over a distance, up to the ends of pieces.
[[nodiscard]] BandLight LeftByVolumes(const std::vector<MarchedPiece>& pieces, double distance_m,
                                      std::size_t bands);

/// Skylight on a surface inside or above fog.
struct SkyThroughFog {
  BandLight left;   // fraction of the irradiance from a clear sky
  BandLight added;  // irradiance from the fog, per unit solar irradiance [1]
};

/// Light in local media for one position of the sun. Immutable, safe to use from many threads.
/// Refers to geometry and lamps.
class MediaLight {
 public:
  /// @param lamps  light volumes; null: none.
  MediaLight(LocalMedia media, const SceneGeometry& geometry, const SolvedAir& air,
             const Lighting& light, const LampLight* lamps = nullptr);
  ~MediaLight();

  [[nodiscard]] const LocalMedia& media() const;

  /// Returns the light that media on a ray send to its origin, through the air.
  /// @param sunlit  stretches that terrain does not shade; null: the whole ray.
  [[nodiscard]] MarchedLight Along(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double length_m, const SunlitPath* sunlit,
                                   double tolerance = kMarchTolerance) const;

  /// Returns the transmittance of media for sunlight that arrives at a point from a direction.
  [[nodiscard]] BandLight SunLeft(const glm::dvec3& point, const glm::dvec3& to_sun) const;

  /// Returns the skylight on a surface.
  /// @param cos_up  between the surface's normal and the vertical.
  [[nodiscard]] SkyThroughFog SkyOnSurface(double altitude_m, double cos_up) const;

  struct State;  // defined in the source file

 private:
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::renderer
