// SPDX-License-Identifier: MIT
// What the ground is made of: albedo by slope and altitude in bands, and relief finer than the
// mesh.
//
// What the ground of a scene is made of, place by place, and how it sends light on.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/sun/time.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/colour_drape.h"
#include "renderer/ground/land_cover.h"
#include "renderer/ground/reflectance.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// A point of the ground as its material sees it.
struct GroundPoint {
  double east_m, north_m;  // anchored to the planet, so that the pattern does not follow the eye
  double altitude_m;
  double across_m;            // width of a ray of the picture: finer detail is left out
  double cosine = 1.0;        // of the ray and the normal of the mesh
  double up_m = 0.0;          // as east_m, over the plane of the pattern
  double normal_north = 0.0;  // component of the normal of the mesh
  double sea_s = 0.0;         // time of the waves
};

/// Families of noise of ground_cover.glsl, in the order of ground.glsl.
enum class GroundNoise { kBroad, kFine, kRelief, kGrain, kWaves };
inline constexpr std::size_t kGroundNoises = 5;

/// One octave of a family: a lattice of squares in the plane of the pattern, which continues
/// upwards along a line of its own that leans by 31 degrees. On a cliff an octave is drawn out along
/// the line's foot, but each along another: on no face are all of them, as they are where a pattern
/// is projected straight down. An octave of waves leans not; it travels.
struct NoiseOctave {
  double wavelength_m;  // side of a square
  std::uint32_t seed;
  double lean_east, lean_north;    // to the east and north per metre upwards
  double drift_east, drift_north;  // m/s

  /// Where a point lies, in squares; that of waves in [-2^31, 2^31), for lattices of 2^32 are the
  /// same over and over.
  [[nodiscard]] glm::dvec2 PlaceOf(const GroundPoint& point) const;
};

/// All of a family, longest first.
[[nodiscard]] std::span<const NoiseOctave> OctavesOf(GroundNoise family);

/// The time of waves: seconds since the beginning of 2020.
[[nodiscard]] double SeaTime(const UtcInstant& instant);

/// Phase speed of waves of deep water [m/s], omega^2 = g k + (s / rho) k^3 with the surface tension
/// of water, s / rho = 7.4e-5 m^3/s^2: Lamb (1932), Hydrodynamics, section 267.
/// @param wave_number  [1/m].
[[nodiscard]] double WaveSpeed(double wave_number);

/// Water at a point: the slopes of the waves that a footprint resolves, and what is left.
struct WavySurface {
  double slope_east = 0.0, slope_north = 0.0;
  double slope_variance;  // of the waves that are not resolved

  [[nodiscard]] glm::dvec3 Normal(const glm::dvec3& up) const;
};

/// @param slope_variance  of all waves.
[[nodiscard]] WavySurface WavesAt(const GroundPoint& point, double slope_variance);

/// Lambertian albedo of mountain ground: forest and meadow below the tree line, rock and scree
/// above it and on steep slopes, snow above the snow line where the slope holds it, lower on shaded
/// slopes than on sunny ones. Broad-leaved woods and grass are green below the lines of the day. Lines
/// waver by fractal noise from 10 m to 1 km, as on real mountains; crowns and rocks are lighter and
/// darker spots from 12 m down to 1.5 m, and a meadow is even. Detail that a ray does not resolve
/// fades to its mean: up to footprints of 100 m the mean albedo changes by at most 3 %. Beyond, it
/// falls at the tree line, which there no longer wavers, by 10 % and under snow by 25 %.
class MountainSurface {
 public:
  /// Albedos of pure materials.
  struct Materials {
    Bands<float> conifers, leaves, yellow_leaves, bare_trees, meadow, dry_meadow, rock, snow;
  };

  /// @param wetness  of rock and meadow, in [0, 1]; leaves of a wood shed water.
  MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover,
                  double wetness = 0.0);

  [[nodiscard]] const MountainCover& cover() const { return cover_; }
  [[nodiscard]] const Materials& materials() const { return materials_; }

  /// @param normal_up  vertical component of the unit normal, 1 on level ground.
  /// @param mapped  instead of what altitude and slope make of it; the snow of the season lies on it.
  [[nodiscard]] Bands<float> Albedo(const GroundPoint& point, double normal_up,
                                    const std::optional<MappedCover>& mapped = std::nullopt) const;

  /// The normal with the relief that a mesh of 30 to 100 m spacing does not have, in waves of 220 to
  /// 7 m: unit, tilted by about 6.4 degrees rms where the footprint is small, unchanged where it is
  /// over 110 m.
  [[nodiscard]] static glm::dvec3 DetailedNormal(const GroundPoint& point,
                                                 const glm::dvec3& normal);

 private:
  MountainCover cover_;
  Materials materials_;
};

class GroundMaterial;

/// The ground at a place: how it sends light on.
class GroundPatch {
 public:
  /// @param albedo  of the diffuse body; not used by water and snow.
  GroundPatch(const GroundMaterial& material, GroundCover::Kind kind, BandLight albedo)
      : material_(material), kind_(kind), albedo_(std::move(albedo)) {}
  /// Water.
  GroundPatch(const GroundMaterial& material, const GroundPoint& at);

  [[nodiscard]] bool IsWater() const { return kind_ == GroundCover::Kind::kWater; }
  /// Of water, with the waves that are resolved there.
  [[nodiscard]] glm::dvec3 WaterNormal(const glm::dvec3& up) const { return waves_.Normal(up); }
  /// Whether it mirrors the sky.
  [[nodiscard]] bool IsGlossy() const {
    return IsWater() || kind_ == GroundCover::Kind::kBlinnPhong;
  }

  /// Radiance over irradiance from one direction [1/sr].
  [[nodiscard]] BandLight Brdf(const ReflectionAngles& at) const;
  /// Of water, the part of it that the surface mirrors.
  [[nodiscard]] double Glitter(const ReflectionAngles& at) const {
    return Water::Glitter(at, waves_.slope_variance);
  }
  /// Share of an even sky that is sent to an eye, but for what is mirrored.
  [[nodiscard]] BandLight BodyAlbedo(double mu_eye) const;
  /// Empty for what is not glossy.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  const GroundMaterial& material_;
  GroundCover::Kind kind_;
  BandLight albedo_;
  WavySurface waves_{0.0, 0.0, 0.0};
};

/// Immutable; safe to ask from many threads.
class GroundMaterial {
 public:
  /// @param drape  colours or land cover over the terrain, or nothing.
  GroundMaterial(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                 std::span<const double> wavelengths_nm);

  /// The terrain at a point.
  /// @param at  the point as its material sees it; normal_up: vertical component of the normal of
  ///     the mesh.
  /// @param season  what covers mountains.
  [[nodiscard]] GroundPatch OfTerrain(const GroundPoint& at, const glm::dvec3& point,
                                      double normal_up, const MountainSurface& season) const;
  /// The planet beyond terrain.
  /// @param planet_albedo  where the cover is that of mountains: of the season's low land around
  ///     terrain, the medium's where there is none.
  [[nodiscard]] GroundPatch OfPlanet(const GroundPoint& at, const BandLight& planet_albedo) const;

  /// Whether any of it mirrors the sky.
  [[nodiscard]] bool HasGloss() const;

  [[nodiscard]] const GroundCover& cover() const { return cover_; }
  [[nodiscard]] const ColourDrape* drape() const { return drape_.get(); }
  [[nodiscard]] const BandsOfColour& bands_of_colour() const { return bands_of_colour_; }
  /// Of the cover's one colour.
  [[nodiscard]] const BandLight& albedo() const { return albedo_; }
  [[nodiscard]] const RoughDiffuse& rough() const { return rough_; }
  [[nodiscard]] const Glossy& glossy() const { return glossy_; }
  [[nodiscard]] const Water& water() const { return water_; }
  [[nodiscard]] const Snow& snow() const { return snow_; }
  /// The highest ground that is sea; nothing: there is none.
  [[nodiscard]] std::optional<double> WaterLine_m() const;

 private:
  friend class GroundPatch;
  /// @param draped  what the drape shows there.
  [[nodiscard]] BandLight AlbedoAt(const GroundPoint& at, double normal_up,
                                   const MountainSurface& season,
                                   const std::optional<std::array<double, 3>>& draped) const;
  [[nodiscard]] bool HasLandCover() const { return drape_ && drape_->IsLandCover(); }

  GroundCover cover_;
  std::shared_ptr<const ColourDrape> drape_;
  BandsOfColour bands_of_colour_;
  BandLight albedo_;
  RoughDiffuse rough_;
  Glossy glossy_;
  Water water_;
  Snow snow_;
};

}  // namespace alpenglow::renderer
