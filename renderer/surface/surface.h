// SPDX-License-Identifier: MIT
// This header provides the materials of a scene's ground: the albedo of mountains by slope and
// altitude in bands, relief finer than the mesh, waves of water, and the reflection of each place.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/time_place/time.h"
#include "renderer/material/land_cover.h"
#include "renderer/material/reflectance.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/colour_drape.h"

namespace alpenglow::renderer {

/// A point of the ground with the inputs of its material.
struct GroundPoint {
  double east_m, north_m;  // in the plane of the pattern (ground_pattern.h)
  double altitude_m;
  double across_m;            // width of a camera ray: finer detail is left out
  double cosine = 1.0;        // of the ray and the normal of the mesh
  double up_m = 0.0;          // above the plane of the pattern
  double normal_north = 0.0;  // northward component of the normal of the mesh
  double sea_s = 0.0;         // time of the waves
};

/// Families of noise of ground_cover.glsl, in the order of ground/pattern.glsl.
enum class GroundNoise { kBroad, kFine, kRelief, kGrain, kWaves };
inline constexpr std::size_t kGroundNoises = 5;

/// One octave of a noise family: a lattice of squares in the plane of the pattern, extruded upwards
/// along a line that leans by 31 degrees. On a cliff, an octave is stretched along the projection
/// of its line. Each octave leans in another direction, so no cliff face stretches all of them, as
/// a pattern projected straight down would be. Octaves of waves do not lean; they travel.
struct NoiseOctave {
  double wavelength_m;  // side of a square
  std::uint32_t seed;
  double lean_east, lean_north;    // shift to the east and north per metre upwards
  double drift_east, drift_north;  // m/s

  /// Returns the position of a point, in squares. For waves it is wrapped to [-2^31, 2^31), because
  /// the noise repeats after 2^32 squares.
  [[nodiscard]] glm::dvec2 PlaceOf(const GroundPoint& point) const;
};

/// Returns all octaves of a family, longest first.
[[nodiscard]] std::span<const NoiseOctave> OctavesOf(GroundNoise family);

/// Returns the time of waves: seconds since the beginning of 2020.
[[nodiscard]] double SeaTime(const UtcTime& instant);

/// Returns the phase speed of waves in deep water [m/s], from omega^2 = g k + (s / rho) k^3 with
/// the surface tension of water, s / rho = 7.4e-5 m^3/s^2: Lamb (1932), Hydrodynamics, section 267.
/// @param wave_number  [1/m].
[[nodiscard]] double WaveSpeed(double wave_number);

/// Water at a point: the slopes of resolved waves, and the slope variance of the others.
struct WavySurface {
  double slope_east = 0.0, slope_north = 0.0;
  double slope_variance;  // of the waves that are not resolved

  /// @param up  in the frame of the pattern, like the result.
  [[nodiscard]] glm::dvec3 Normal(const glm::dvec3& up) const;
};

/// @param slope_variance  of all waves.
[[nodiscard]] WavySurface WavesAt(const GroundPoint& point, double slope_variance);

/// Lambertian albedo of mountain ground. Forest and meadow grow below the tree line, rock and scree
/// lie above it and on steep slopes, and snow lies above the snow line where the slope holds it,
/// lower on shaded slopes than on sunny ones. Broad-leaved woods and grass are green below the
/// lines of the day. Fractal noise from 10 m to 1 km makes the lines ragged, as on real mountains.
/// Crowns and rocks add lighter and darker spots from 12 m down to 1.5 m; meadows are uniform.
/// Detail that a ray does not resolve fades to its mean: up to footprints of 100 m the mean albedo
/// changes by at most 3 %. Beyond, it falls by 10 % at the tree line, which is no longer ragged
/// there, and by 25 % under snow.
class MountainSurface {
 public:
  /// Albedos of pure materials.
  struct Materials {
    Spectrum conifers, leaves, yellow_leaves, bare_trees, meadow, dry_meadow, rock, snow;
  };

  /// @param wetness  of rock and meadow, in [0, 1]; leaves of a wood shed water.
  MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover,
                  double wetness = 0.0);

  [[nodiscard]] const MountainCover& cover() const { return cover_; }
  [[nodiscard]] const Materials& materials() const { return materials_; }

  /// @param normal_up  vertical component of the unit normal, 1 on level ground.
  /// @param mapped  replaces the materials derived from altitude and slope; seasonal snow still
  ///     covers it.
  [[nodiscard]] Spectrum Albedo(const GroundPoint& point, double normal_up,
                                const std::optional<MappedCover>& mapped = std::nullopt) const;

  /// Returns the unit normal with the relief that a mesh of 30 to 100 m spacing lacks, in waves of
  /// 220 to 7 m, in the frame of the pattern like `normal`. The normal is tilted by about 6.4
  /// degrees rms where the footprint is small, and unchanged where it is over 110 m.
  [[nodiscard]] static glm::dvec3 DetailedNormal(const GroundPoint& point,
                                                 const glm::dvec3& normal);

 private:
  MountainCover cover_;
  Materials materials_;
};

class GroundMaterial;

/// The reflection of the ground at a place.
class GroundPatch {
 public:
  /// @param albedo  of the multiple_scattering body; not used for water and snow.
  GroundPatch(const GroundMaterial& material, GroundCover::Kind kind, Spectrum albedo)
      : material_(material), kind_(kind), albedo_(std::move(albedo)) {}
  /// Creates a patch of water.
  GroundPatch(const GroundMaterial& material, const GroundPoint& at);

  [[nodiscard]] bool IsWater() const { return kind_ == GroundCover::Kind::kWater; }
  /// Returns the normal of water, with the resolved waves.
  /// @param up  in the frame of the pattern, like the result.
  [[nodiscard]] glm::dvec3 WaterNormal(const glm::dvec3& up) const { return waves_.Normal(up); }
  /// Returns whether the patch mirrors the sky.
  [[nodiscard]] bool IsGlossy() const {
    return IsWater() || kind_ == GroundCover::Kind::kBlinnPhong;
  }

  /// Returns the radiance per irradiance from one direction [1/sr].
  [[nodiscard]] Spectrum Brdf(const ReflectionAngles& at) const;
  /// Returns the part of a water patch's BRDF that the surface mirrors [1/sr].
  [[nodiscard]] double Glitter(const ReflectionAngles& at) const {
    return Water::Glitter(at, waves_.slope_variance);
  }
  /// Returns the fraction of a uniform sky that is reflected to an eye, excluding mirrored light.
  [[nodiscard]] Spectrum BodyAlbedo(double mu_eye) const;
  /// Returns the mirrored rays; empty for patches that are not glossy.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  const GroundMaterial& material_;
  GroundCover::Kind kind_;
  Spectrum albedo_;
  WavySurface waves_{0.0, 0.0, 0.0};
};

/// The material of a scene's ground. Immutable; safe to use from many threads.
class GroundMaterial {
 public:
  /// @param drape  colours or land cover over the terrain, or null.
  GroundMaterial(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                 std::span<const double> wavelengths_nm);

  /// Returns the patch of terrain at a point.
  /// @param at  the point as input of its material.
  /// @param normal_up  vertical component of the normal of the mesh.
  /// @param season  cover of mountains.
  [[nodiscard]] GroundPatch OfTerrain(const GroundPoint& at, const glm::dvec3& point,
                                      double normal_up, const MountainSurface& season) const;
  /// Returns a patch of the planet outside the terrain.
  /// @param planet_albedo  used if the cover is that of mountains: the season's low land around
  ///     terrain, or the medium's albedo without terrain.
  [[nodiscard]] GroundPatch OfPlanet(const GroundPoint& at, const Spectrum& planet_albedo) const;

  /// Returns whether any of the ground mirrors the sky.
  [[nodiscard]] bool HasGloss() const;
  /// Returns whether a part of the ground may be water.
  [[nodiscard]] bool HasWater() const;

  [[nodiscard]] const GroundCover& cover() const { return cover_; }
  [[nodiscard]] const ColourDrape* drape() const { return drape_.get(); }
  [[nodiscard]] const BandsOfColour& bands_of_colour() const { return bands_of_colour_; }
  /// Albedo of the cover's single colour.
  [[nodiscard]] const Spectrum& albedo() const { return albedo_; }
  [[nodiscard]] const RoughDiffuse& rough() const { return rough_; }
  [[nodiscard]] const Glossy& glossy() const { return glossy_; }
  [[nodiscard]] const Water& water() const { return water_; }
  [[nodiscard]] const Snow& snow() const { return snow_; }
  /// Returns the greatest altitude of ground that is sea; empty: there is no sea.
  [[nodiscard]] std::optional<double> WaterLine_m() const;

 private:
  friend class GroundPatch;
  /// @param draped  value of the drape at the point.
  [[nodiscard]] Spectrum AlbedoAt(const GroundPoint& at, double normal_up,
                                  const MountainSurface& season,
                                  const std::optional<std::array<double, 3>>& draped) const;
  [[nodiscard]] bool HasLandCover() const { return drape_ && drape_->IsLandCover(); }

  GroundCover cover_;
  std::shared_ptr<const ColourDrape> drape_;
  BandsOfColour bands_of_colour_;
  Spectrum albedo_;
  RoughDiffuse rough_;
  Glossy glossy_;
  Water water_;
  Snow snow_;
};

}  // namespace alpenglow::renderer
