// SPDX-License-Identifier: MIT
// Skylight on surfaces whose horizon hides a part of the sky.
//
// OccludedSkyIrradiance integrates the sky over the directions that a surface sees. From azimuth p
// and elevation e, a surface of normal n = (n_h(p) along the azimuth, n_z up) receives L (n_z sin e
// + n_h cos e). The open part of one azimuth, above the sine s of the horizon, contributes
//
//   n_z A(p, s) + n_h B(p, s),   A = integral of L s ds,   B = integral of L sqrt(1 - s^2) ds.
//
// Both integrals are tabulated over s for kHorizonAzimuths sectors. L is the mean over a sector of
// the sky with its aureole (SkyView). The lower limit is the horizon or the surface's own plane,
// whichever is higher. Between altitudes and places the distribution of the sky is kept, and scaled
// with the irradiance of a level plane.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/layer.h"
#include "renderer/visibility/horizon_map.h"

namespace alpenglow::renderer {

/// Orientation of the outer side of a surface, by azimuth.
struct SurfaceSectors {
  float up;         // n_z
  Horizons along;   // n_h
  Horizons lowest;  // sines of the elevations between which the surface faces a direction
  Horizons highest;
};

/// @param normal  unit: east, north, up at the place.
[[nodiscard]] SurfaceSectors SectorsOf(const glm::dvec3& normal);

/// Returns the integral of n_z s + n_h sqrt(1 - s^2) over [low, high] in s, to 1e-4: the irradiance
/// from a sector of radiance 1, per radian of azimuth.
[[nodiscard]] float SectorIntegral(float up, float along, float low, float high);

/// Returns the irradiance from ground of radiance 1 below the horizon of each sector, per radian of
/// azimuth.
[[nodiscard]] Horizons GroundShares(const SurfaceSectors& surface, const Horizons& horizons);

/// Irradiance from the visible part of the sky, for one position of the sun. Immutable; safe to use
/// from many threads.
class OccludedSkyIrradiance {
 public:
  /// Extent of the ground.
  struct Extent {
    double lowest_m, highest_m;  // altitudes
    double radius_m;             // greatest distance from the frame's origin
  };
  /// @param to_light  unit, in the frame of the horizons.
  OccludedSkyIrradiance(const SingleScattering<float>& air,
                        const MultipleScattering& multiple_scattering, const glm::dvec3& to_light,
                        const Extent& extent);

  /// Returns the irradiance per unit solar irradiance [1] from directions above the horizon, which
  /// is taken to be at least HorizonMap::kLowest.
  /// @param mu_s  zenith cosine of the sun at the place.
  [[nodiscard]] Spectrum Irradiance(double altitude_m, double mu_s, const SurfaceSectors& surface,
                                    const Horizons& horizons) const;

  /// Returns the radiance of the sky per unit solar irradiance [1/sr] in a direction (east, north,
  /// up at the place). It is linear between means over sectors and over steps of 0.011 of the
  /// elevation's sine; directions below the horizontal have the radiance of the horizontal.
  [[nodiscard]] Spectrum Radiance(double altitude_m, double mu_s,
                                  const glm::dvec3& direction) const;

  [[nodiscard]] std::size_t bands() const { return bands_; }

  static constexpr std::size_t kNodes = 97;  // over the sine, from kLowest to 1
  static constexpr std::size_t kLevels = 16;
  static constexpr std::size_t kSuns = 9;

  /// The tables that Irradiance reads, for other programs. The floats live as long as this sky; the
  /// number of bands is rounded up to a multiple of 4.
  struct Tables {
    double lowest_m, highest_m;               // altitudes of the first and the last level
    double first_mu_s, mu_s_step;             // of the suns
    std::span<const float> level_irradiance;  // [level][sun][band]
    std::span<const float> integral;  // [level][azimuth][node][A, B][band], over level_irradiance
  };
  [[nodiscard]] Tables tables() const {
    return {lowest_m_, highest_m_, first_mu_s_, mu_s_step_, level_irradiance_, integral_};
  }

 private:
  [[nodiscard]] std::vector<float> TableAt(const SingleScattering<float>& air,
                                           const MultipleScattering& multiple_scattering,
                                           double altitude_m, const glm::dvec3& to_light) const;
  /// Returns the irradiance of a level plane.
  [[nodiscard]] Spectrum LevelIrradiance(double altitude_m, double mu_s) const;
  void KeepRadiances();
  [[nodiscard]] std::size_t Level(double altitude_m) const;
  [[nodiscard]] std::size_t level_floats() const { return kHorizonAzimuths * kNodes * 2 * stride_; }

  std::size_t bands_, stride_;  // stride: bands rounded up to a multiple of 4
  double lowest_m_, highest_m_;
  double first_mu_s_, mu_s_step_;
  std::vector<float> level_irradiance_;  // [level][sun][band]
  /// Relative to LevelIrradiance: [level][azimuth][node][A, B][band].
  std::vector<float> integral_;
  std::vector<float> radiance_;  // the same as means between nodes: [level][azimuth][node][band]
};

}  // namespace alpenglow::renderer
