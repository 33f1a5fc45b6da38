// SPDX-License-Identifier: MIT
// This header provides reflectance distributions (BRDF) f [1/sr] of isotropic surfaces, in bands,
// and the functions of the shared text reflectance.glsl in C++. f is the radiance towards the eye
// per irradiance from a light:
//
//   L(to_eye) = integral of f(to_light, to_eye) L(to_light) cos(to_light, normal)
//
// Directions point away from the surface. All distributions are reciprocal, and none reflects more
// than it receives; tests check both by quadrature over the hemisphere.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/shared_glsl/shared_math.h"
#include "renderer/layer.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/material/reflectance.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// Cosines that the reflection of an isotropic surface depends on.
struct ReflectionAngles {
  double mu_light;     // of normal and light, in (0, 1]
  double mu_eye;       // of normal and eye, in (0, 1]
  double cos_between;  // of light and eye
};

/// Returns the cosines between unit vectors. Cosines with the normal are at least 1e-4: a surface
/// whose interpolated normal faces away from the eye is shaded at a grazing angle.
[[nodiscard]] ReflectionAngles AnglesBetween(const glm::dvec3& normal, const glm::dvec3& to_light,
                                             const glm::dvec3& to_eye);

/// The range of directions that one direction represents, in the sine of the elevation over the
/// surface.
struct Spread {
  double below = 0.0, above = 0.0;  // extent below and above, not negative
  double lifted = 0.0;  // share of the range below the horizontal, which is moved onto it
};

/// A direction from which a glossy surface reflects the sky to the eye, and the fraction of its
/// radiance that reaches the eye.
struct MirroredRay {
  glm::dvec3 direction;  // unit; may point slightly below the surface's horizon
  double weight;
  Spread spread;
};

/// The mirrored rays of a surface: the reflected radiance is the sum of weights times radiances.
struct MirroredRays {
  static constexpr std::size_t kMost = 24;
  std::array<MirroredRay, kMost> rays;
  std::size_t count = 0;

  /// Returns a view of the rays that is valid as long as this object.
  [[nodiscard]] std::span<const MirroredRay> All() const& { return {rays.data(), count}; }
  std::span<const MirroredRay> All() const&& = delete;
  [[nodiscard]] double TotalWeight() const;
};

/// Returns the reflectance of a surface with a refractive index for unpolarised light (Fresnel).
/// @param cosine  of the angle of incidence, in [0, 1].
[[nodiscard]] double FresnelReflectance(double cosine, double refractive_index);

/// Returns the degree of polarisation of unpolarised light after such a reflection, perpendicular
/// to the plane of incidence: 1 at Brewster's angle, 0 at normal and grazing incidence.
[[nodiscard]] double FresnelPolarisation(double cosine, double refractive_index);

/// Returns f0 + (1 - f0) (1 - cosine)^5: Schlick (1994), Computer Graphics Forum 13, 233.
[[nodiscard]] double SchlickReflectance(double cosine, double f0);

/// Returns the albedo of a wet surface: WetAlbedo of reflectance.glsl in all bands.
/// @param wetness  fraction of the surface that is wet, in [0, 1].
[[nodiscard]] Spectrum Wetted(Spectrum albedo, double wetness);

/// A diffuse surface of facets that shade each other (Oren, Nayar 1994), in the form of Portsmouth,
/// Kutz, Hill (2025), JCGT 14(1), which includes multiple reflections between facets: a surface of
/// albedo 1 reflects all light.
class RoughDiffuse {
 public:
  /// @param roughness  in [0, 1]; 0 is a Lambertian surface, 1 the roughest; 0.5 is about that of
  ///     the moon.
  explicit RoughDiffuse(double roughness);

  /// @param albedo  of a facet.
  [[nodiscard]] Spectrum Brdf(const Spectrum& albedo, const ReflectionAngles& at) const;
  /// Returns the directional albedo (which is also the reflectance of a uniform sky seen from
  /// `mu`).
  [[nodiscard]] Spectrum Albedo(const Spectrum& albedo, double mu) const;

  /// Parameters of reflectance.glsl for this roughness.
  [[nodiscard]] double roughness() const { return roughness_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double mean_single() const { return mean_single_; }

 private:
  // Albedo of light reflected once between facets without absorption.
  [[nodiscard]] double Single(double mu) const;

  double roughness_, scale_, mean_single_;
};

/// A glossy coat over a diffuse body. Half vectors have Blinn's (1977) distribution cos^n,
/// normalised so that a mirror at normal incidence reflects everything (Giesen 2009), with
/// Schlick's Fresnel term. The body receives the light that the coat transmits, as in Ashikhmin,
/// Shirley (2000), J. Graphics Tools 5, 25.
class Glossy {
 public:
  /// @param roughness  in [0.1, 1]: n = 2 / roughness^4 - 2, as Walter et al. (2007), EGSR, relate
  ///     it to the slopes of facets. The narrowest lobe is wider than the sun.
  /// @param f0  reflectance of the coat at normal incidence, in [0, 1]; 0.04 for glass.
  Glossy(double roughness, double f0);

  [[nodiscard]] double exponent() const { return exponent_; }
  [[nodiscard]] double f0() const { return f0_; }
  [[nodiscard]] double normalisation() const { return normalisation_; }
  /// Returns the BRDF of the coat alone [1/sr].
  [[nodiscard]] double Coat(const ReflectionAngles& at) const;
  /// Returns the BRDF of coat and body [1/sr].
  /// @param albedo  of the body.
  [[nodiscard]] Spectrum Brdf(const Spectrum& albedo, const ReflectionAngles& at) const;
  /// Returns the fraction of a uniform sky that the body reflects.
  [[nodiscard]] Spectrum BodyAlbedo(const Spectrum& albedo, double mu) const;
  /// Returns the rays that the coat mirrors. TotalWeight() is the albedo of the coat within 3 % of
  /// it up to roughness 0.5, within 15 % at 1.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  double exponent_, f0_, normalisation_;
};

/// Wind-blown water, deep and moderately clear.
///
/// Slopes of the waves are normally distributed and isotropic with the variance 0.003 + 0.00512 W
/// of Cox, Munk (1954), J. Opt. Soc. Am. 44, 838. Waves hide each other as in Smith (1967), IEEE
/// Trans. Antennas Propag. 15, 668. Wave facets reflect by Fresnel's law with index 1.34. Light
/// from below the surface follows Lee, Carder, Arnone (2002), Appl. Opt. 41, 5755, for pure sea
/// water with a little yellow substance (0.02 1/m at 440 nm) and fine particles (0.001 1/m
/// backwards at 550 nm).
class Water {
 public:
  static constexpr double kRefractiveIndex = 1.34;

  /// @param wind_m_per_s  at 10 m above the surface, in [0, 20]; the slopes are measured up to 14.
  Water(double wind_m_per_s, std::span<const double> wavelengths_nm);

  /// Mean square of the waves' slope, summed over both directions.
  [[nodiscard]] double slope_variance() const { return variance_; }
  /// Reflectance of the water below the surface: pi times radiance over irradiance, with sun and
  /// eye at the zenith.
  [[nodiscard]] const Spectrum& under_surface() const { return under_surface_; }
  /// Returns the distribution of the glitter [1/sr].
  /// @param variance  of the slopes that the normal does not resolve.
  [[nodiscard]] static double Glitter(const ReflectionAngles& at, double variance);
  /// Returns Q over radiance of unpolarised light after reflection in glitter or a mirrored ray. Q
  /// refers to the plane perpendicular to the plane of light and eye.
  [[nodiscard]] static double Polarisation(double cos_between);
  /// Returns the BRDF of glitter plus light from below the surface.
  [[nodiscard]] Spectrum Brdf(const ReflectionAngles& at) const { return Brdf(at, variance_); }
  [[nodiscard]] Spectrum Brdf(const ReflectionAngles& at, double variance) const;
  /// Returns the fraction of a uniform sky that returns from below the surface.
  [[nodiscard]] Spectrum BodyAlbedo(double mu) const;
  /// Returns the rays that the waves mirror; light that meets a second wave counts as coming from
  /// the horizon. TotalWeight() is the mean Fresnel reflectance of the facets that the eye sees,
  /// within 5 % of it.
  [[nodiscard]] MirroredRays Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const;

 private:
  double variance_;
  Spectrum under_surface_;
};

/// Deep clean snow by the asymptotic theory of Kokhanovsky, Zege (2004), Appl. Opt. 43, 1589:
///
///   f = R0 exp(-y K(mu_light) K(mu_eye) / R0) / pi,   y = sqrt(16 B a d / (9 (1 - g))),
///
/// with K = 3/7 (1 + 2 mu), the absorption a of ice, the grain diameter d, and the grain shape
/// B = 1.6 and g = 0.845 (Libois et al. 2014, J. Glaciology 60, 712). R0 is the reflection without
/// absorption of Kokhanovsky (2005), J. Quant. Spectrosc. Radiat. Transfer 96, 1, which reflects up
/// to 1.14 of the light at grazing angles, times a factor for each direction that makes this 1.
class Snow {
 public:
  /// @param grain_diameter_m  in [5e-5, 5e-3]: 2e-4 fresh, 1e-3 old.
  Snow(double grain_diameter_m, std::span<const double> wavelengths_nm);

  [[nodiscard]] Spectrum Brdf(const ReflectionAngles& at) const;
  /// Returns the directional albedo exp(-y K(mu)), which the integral of Brdf matches within 0.01.
  [[nodiscard]] Spectrum Albedo(double mu) const;
  /// Returns the albedo for a uniform sky, exp(-y).
  [[nodiscard]] Spectrum SphericalAlbedo() const;

  [[nodiscard]] const Spectrum& y() const { return y_; }
  /// Factors of R0 per direction, at equal steps of the root of mu from 0 to 1.
  static constexpr std::size_t kBalanceNodes = 65;
  [[nodiscard]] static const std::array<double, kBalanceNodes>& BalanceNodes();

 private:
  Spectrum y_;
};

}  // namespace alpenglow::renderer
