// SPDX-License-Identifier: MIT
// Diffuse light at a place as the moments of DiffuseLight, ready to be scattered by any phase
// function:
//
//   J(look) = sum over l, m of  chi_l L_lm Y_lm(look)
//
// Light of the sky on surfaces that see only a part of it.
//
// In a direction of azimuth p and elevation e a surface of normal n = (n_h(p) along the azimuth,
// n_z up) receives L (n_z sin e + n_h cos e). Over the open part of one azimuth, from the horizon's
// sine s up, that is
//
//   n_z A(p, s) + n_h B(p, s),   A = integral of L s ds,   B = integral of L sqrt(1 - s^2) ds,
//
// both tabulated over s for kHorizonAzimuths sectors, L being the mean of a
// sector of the sky with its aureole (SkyView). The lower end is the horizon
// or the surface's own plane, whichever is higher. Between altitudes and
// places the sky keeps its shape and follows the irradiance of a level plane.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/ground/band_light.h"
#include "renderer/layer.h"
#include "renderer/shadow/horizon_map.h"

namespace alpenglow::renderer {

/// Around one vertical, under one sun, at several altitudes. Per unit solar irradiance. Immutable.
class SkyMoments {
 public:
  /// @param up, to_sun  unit vectors. @param altitudes_m  ascending.
  SkyMoments(const DiffuseLight& diffuse, const glm::dvec3& up, const glm::dvec3& to_sun,
             std::vector<double> altitudes_m);

  [[nodiscard]] double mu_s() const { return mu_s_; }

  /// The same without light that comes evenly from below, `radiance` at all altitudes.
  [[nodiscard]] SkyMoments WithoutGround(const BandLight& radiance) const;

  /// What a phase function of these Legendre coefficients scatters into an eye that looks along
  /// `look`, at each of the altitudes [1/sr]. With all coefficients 1: the radiance from there.
  [[nodiscard]] std::vector<BandLight> Towards(const glm::dvec3& look,
                                               const std::vector<double>& chi) const;

  /// Linear between the altitudes, the end's beyond them.
  [[nodiscard]] BandLight At(const std::vector<BandLight>& of_altitudes, double altitude_m) const;

 private:
  glm::dvec3 up_, to_sun_;
  double mu_s_;
  int degree_;
  std::size_t bands_;
  std::vector<double> altitudes_m_;
  std::vector<std::vector<float>> values_;  // [altitude][moment * bands + band]
};

/// Where the outer side of a surface looks, azimuth by azimuth.
struct SurfaceSectors {
  float up;         // n_z
  Horizons along;   // n_h
  Horizons lowest;  // sines of the elevations between which the surface faces a direction
  Horizons highest;
};

/// @param normal  unit: east, north, up at the place.
[[nodiscard]] SurfaceSectors SectorsOf(const glm::dvec3& normal);

/// Integral of n_z s + n_h sqrt(1 - s^2) over [low, high] by s: what a sector of radiance 1 brings
/// per radian of azimuth, to 1e-4.
[[nodiscard]] float SectorIntegral(float up, float along, float low, float high);

/// What each sector brings from the ground below its
/// horizon, when that has radiance 1, per radian of azimuth.
[[nodiscard]] Horizons GroundShares(const SurfaceSectors& surface, const Horizons& horizons);

/// The sky for one position of the sun. Immutable; safe to ask from many threads.
class OpenSky {
 public:
  /// @param to_sun  unit, in the frame of the horizons.
  /// Where the ground lies.
  struct Extent {
    double lowest_m, highest_m;  // altitudes
    double radius_m;             // distance from the frame's origin, at most
  };
  OpenSky(const AirIntegrator<float>& air, const DiffuseLight& diffuse, const glm::dvec3& to_sun,
          const Extent& extent);

  /// Irradiance per unit solar irradiance [1] from directions over the horizon, where that is not
  /// below HorizonMap::kLowest.
  /// @param mu_s  zenith cosine of the sun at the place.
  [[nodiscard]] Bands<float> Irradiance(double altitude_m, double mu_s,
                                        const SurfaceSectors& surface,
                                        const Horizons& horizons) const;

  /// Radiance of the sky per unit solar irradiance [1/sr] in a direction (east, north, up at the
  /// place): linear between means over sectors and over steps of 0.011 of the elevation's sine; in
  /// lower directions that of the horizon.
  [[nodiscard]] Bands<float> Radiance(double altitude_m, double mu_s,
                                      const glm::dvec3& direction) const;

  [[nodiscard]] std::size_t bands() const { return bands_; }

  static constexpr std::size_t kNodes = 97;  // over the sine, from kLowest to 1
  static constexpr std::size_t kLevels = 16;
  static constexpr std::size_t kSuns = 9;

  /// The tables that Irradiance reads, for other programs that read them. The floats live as long as
  /// the sky; the number of bands is rounded up to a multiple of 4.
  struct Tables {
    double lowest_m, highest_m;               // altitudes of the first level and the last
    double first_mu_s, mu_s_step;             // of the suns
    std::span<const float> level_irradiance;  // [level][sun][band]
    std::span<const float> integral;  // [level][azimuth][node][A, B][band], relative to that
  };
  [[nodiscard]] Tables tables() const {
    return {lowest_m_, highest_m_, first_mu_s_, mu_s_step_, level_irradiance_, integral_};
  }

 private:
  [[nodiscard]] std::vector<float> TableAt(const AirIntegrator<float>& air,
                                           const DiffuseLight& diffuse, double altitude_m,
                                           const glm::dvec3& to_sun) const;
  /// On a level plane.
  [[nodiscard]] Bands<float> LevelIrradiance(double altitude_m, double mu_s) const;
  void KeepRadiances();
  [[nodiscard]] std::size_t Level(double altitude_m) const;
  [[nodiscard]] std::size_t level_floats() const { return kHorizonAzimuths * kNodes * 2 * stride_; }

  std::size_t bands_, stride_;  // stride: bands rounded up to a multiple of 4
  double lowest_m_, highest_m_;
  double first_mu_s_, mu_s_step_;
  std::vector<float> level_irradiance_;  // [level][sun][band]
  /// Relative to LevelIrradiance: [level][azimuth][node][A, B][band].
  std::vector<float> integral_;
  std::vector<float> radiance_;  // the same, means between nodes: [level][azimuth][node][band]
};

}  // namespace alpenglow::renderer
