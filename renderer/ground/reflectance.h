// SPDX-License-Identifier: MIT
// How surfaces send light on: reflectance distributions (BRDF) f [1/sr], radiance towards the eye
// per irradiance from a light,
//
//   L(to_eye) = integral of f(to_light, to_eye) L(to_light) cos(to_light, normal)
//
// of isotropic surfaces, in bands. Directions point away from the surface. All are reciprocal, and
// none sends on more than it receives; tests hold both against quadrature over the hemisphere.
//
// This header also reads the shared text reflectance.glsl as C++.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "atmosphere/dialect/shared_math.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "renderer/ground/reflectance.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// Cosines that the reflection of an isotropic surface depends on.
struct ReflectionAngles {
  double mu_light;     // normal and light, in (0, 1]
  double mu_eye;       // normal and eye, in (0, 1]
  double cos_between;  // light and eye
};

/// All unit vectors. Cosines with the normal are raised to 1e-4: what an interpolated normal turns
/// away from the eye is seen at a grazing angle.
[[nodiscard]] ReflectionAngles AnglesBetween(const glm::dvec3& normal, const glm::dvec3& to_light,
                                             const glm::dvec3& to_eye);

/// The directions that one stands for, in the sine of the elevation over the surface.
struct Spread {
  double below = 0.0, above = 0.0;  // from so much lower to so much higher, not negative
  double lifted = 0.0;  // share of all that lay under the horizontal, and counts as from there
};

/// A direction from which a glossy surface sees the sky, and the share of its radiance that goes
/// on to the eye.
struct MirroredRay {
  glm::dvec3 direction;  // unit; may point below the surface's horizon by a little
  double weight;
  Spread spread;
};

/// All of them: the reflected radiance is the sum of weights times radiances.
struct MirroredRays {
  static constexpr std::size_t kMost = 24;
  std::array<MirroredRay, kMost> rays;
  std::size_t count = 0;

  /// They live as long as this.
  [[nodiscard]] std::span<const MirroredRay> All() const& { return {rays.data(), count}; }
  std::span<const MirroredRay> All() const&& = delete;
  [[nodiscard]] double TotalWeight() const;
};

/// Reflectance of a surface of a refractive index for unpolarised light (Fresnel).
/// @param cosine  of the angle of incidence, in [0, 1].
[[nodiscard]] double FresnelReflectance(double cosine, double refractive_index);

/// Degree of polarisation, across the plane of incidence, of unpolarised light that such a surface
/// reflects: 1 at Brewster's angle, 0 at both ends.
[[nodiscard]] double FresnelPolarisation(double cosine, double refractive_index);

/// f0 + (1 - f0) (1 - cosine)^5: Schlick (1994), Computer Graphics Forum 13, 233.
[[nodiscard]] double SchlickReflectance(double cosine, double f0);

/// What a surface of an albedo has where it is wet: WetAlbedo of reflectance.glsl in all bands.
/// @param wetness  share of it that is wet, in [0, 1].
[[nodiscard]] Bands<float> Wetted(Bands<float> albedo, double wetness);

/// A diffuse surface of facets that shade each other (Oren, Nayar 1994), in the form of Portsmouth,
/// Kutz, Hill (2025), JCGT 14(1), which keeps what is reflected several times between them: a
/// surface of albedo 1 sends on all light.
class RoughDiffuse {
 public:
  /// @param roughness  in [0, 1]; 0 is Lambert's surface, 1 the roughest, 0.5 about that of the
  /// moon.
  explicit RoughDiffuse(double roughness);

  /// @param albedo  of a facet.
  [[nodiscard]] Bands<float> Brdf(const Bands<float>& albedo, const ReflectionAngles& at) const;
  /// Share of the light from a direction that is sent on (and of an even sky that is seen in it).
  [[nodiscard]] Bands<float> Albedo(const Bands<float>& albedo, double mu) const;

  /// What reflectance.glsl has of a roughness.
  [[nodiscard]] double roughness() const { return roughness_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double mean_single() const { return mean_single_; }

 private:
  // Albedo of light reflected once between facets that absorb nothing.
  [[nodiscard]] double Single(double mu) const;

  double roughness_, scale_, mean_single_;
};

/// A glossy coat over a diffuse body: Blinn's (1977) distribution of half vectors cos^n, normalised
/// so that a mirror at normal incidence sends on everything (Giesen 2009), with Schlick's Fresnel;
/// the body gets what the coat lets through, as Ashikhmin, Shirley (2000), J. Graphics Tools 5, 25.
class Glossy {
 public:
  /// @param roughness  in [0.1, 1]: n = 2 / roughness^4 - 2, as Walter et al. (2007), EGSR, relate
  /// it to the slopes of facets. The narrowest lobe is wider than the sun.
  /// @param f0  reflectance of the coat at normal incidence, in [0, 1]; 0.04 is that of glass.
  Glossy(double roughness, double f0);

  [[nodiscard]] double exponent() const { return exponent_; }
  [[nodiscard]] double f0() const { return f0_; }
  [[nodiscard]] double normalisation() const { return normalisation_; }
  /// Of the coat alone.
  [[nodiscard]] double Coat(const ReflectionAngles& at) const;
  /// Of both. @param albedo  of the body.
  [[nodiscard]] Bands<float> Brdf(const Bands<float>& albedo, const ReflectionAngles& at) const;
  /// Share of an even sky that the body sends on.
  [[nodiscard]] Bands<float> BodyAlbedo(const Bands<float>& albedo, double mu) const;
  /// What the coat shows: TotalWeight() is the albedo of the coat to 3 % of it up to roughness 0.5,
  /// to 15 % at 1.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  double exponent_, f0_, normalisation_;
};

/// Wind-blown water, deep and moderately clear.
///
/// Slopes of the waves are normally distributed with the variance 0.003 + 0.00512 W of Cox, Munk
/// (1954), J. Opt. Soc. Am. 44, 838, the same in all directions; waves hide each other as Smith
/// (1967), IEEE Trans. Antennas Propag. 15, 668, has it; their faces reflect by Fresnel's law with
/// index 1.34. Light from under the surface after Lee, Carder, Arnone (2002), Appl. Opt. 41, 5755,
/// of pure sea water with a little yellow substance (0.02 1/m at 440 nm) and fine particles (0.001
/// 1/m backwards at 550 nm).
class Water {
 public:
  static constexpr double kRefractiveIndex = 1.34;

  /// @param wind_m_per_s  10 m over the surface, in [0, 20]; measured up to 14.
  Water(double wind_m_per_s, std::span<const double> wavelengths_nm);

  /// Mean square of the waves' slope, both directions together.
  [[nodiscard]] double slope_variance() const { return variance_; }
  /// Of light from under the surface: pi times radiance over irradiance, sun and eye at the zenith.
  [[nodiscard]] const Bands<float>& under_surface() const { return under_surface_; }
  /// Distribution of the glitter [1/sr].
  /// @param variance  of the slopes that the normal does not show.
  [[nodiscard]] static double Glitter(const ReflectionAngles& at, double variance);
  /// Q over radiance of the glitter or of a mirrored ray, in the plane across that of light and
  /// eye: that of unpolarised light.
  [[nodiscard]] static double Polarisation(double cos_between);
  /// Of glitter and light from under the surface.
  [[nodiscard]] Bands<float> Brdf(const ReflectionAngles& at) const { return Brdf(at, variance_); }
  [[nodiscard]] Bands<float> Brdf(const ReflectionAngles& at, double variance) const;
  /// Share of an even sky that comes from under the surface.
  [[nodiscard]] Bands<float> BodyAlbedo(double mu) const;
  /// What the waves show of the sky; light that meets a second wave
  /// counts as coming from the horizon. TotalWeight() is the mean
  /// Fresnel reflectance of the faces that the eye sees, to 5 % of it.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  double variance_;
  Bands<float> under_surface_;
};

/// Deep clean snow by the asymptotic theory of Kokhanovsky, Zege (2004), Appl. Opt. 43, 1589:
///
///   f = R0 exp(-y K(mu_light) K(mu_eye) / R0) / pi,   y = sqrt(16 B a d / (9 (1 - g))),
///
/// K = 3/7 (1 + 2 mu), a the absorption of ice, d the grains' diameter, B = 1.6 and g = 0.845
/// their shape (Libois et al. 2014, J. Glaciology 60, 712), R0 the reflection without absorption of
/// Kokhanovsky (2005), J. Quant. Spectrosc. Radiat. Transfer 96, 1, which at grazing angles sends
/// on up to 1.14 of the light, times a factor of each direction that makes it 1.
class Snow {
 public:
  /// @param grain_diameter_m  in [5e-5, 5e-3]: 2e-4 fresh, 1e-3 old.
  Snow(double grain_diameter_m, std::span<const double> wavelengths_nm);

  [[nodiscard]] Bands<float> Brdf(const ReflectionAngles& at) const;
  /// Share of the light from a direction that is sent on: exp(-y K(mu)), which Brdf has to 0.01.
  [[nodiscard]] Bands<float> Albedo(double mu) const;
  /// The same of an even sky: exp(-y).
  [[nodiscard]] Bands<float> SphericalAlbedo() const;

  [[nodiscard]] const Bands<float>& y() const { return y_; }
  /// The factor of each direction, at even steps of the root of mu from 0 to 1.
  static constexpr std::size_t kBalanceNodes = 65;
  [[nodiscard]] static const std::array<double, kBalanceNodes>& BalanceNodes();

 private:
  Bands<float> y_;
};

}  // namespace alpenglow::renderer
