// SPDX-License-Identifier: MIT
// This header provides sunlight scattered once, tabulated over altitude, view, sun and the angle
// between them.
//
//   texel = integral of sigma_s(h) T(observer to point) T(point to sun) ds   per unit irradiance
//
// for molecules and aerosol separately, per band, as float, without the phase functions: those are
// applied at the look-up (SingleScattering::Inscatter), which keeps the aureole sharp. There are
// two sets of axes:
//
//   Bruneton   those of table_maps.glsl, quadrilinear; angles nu that are impossible for a texel's
//              mu and mu_s are moved to the nearest possible, so that interpolation never uses an
//              invented value. After Bruneton and Neyret (2008), Computer Graphics Forum 27, 1079.
//   azimuth    r and mu as above; the azimuth from the sun, 0 to pi in equal steps, in place of nu,
//              so that no texel is wasted; the sun's zenith cosine dense around the terminator, as
//              in MultipleScattering; cubic except for mu. Texels hold fourth roots, so that light
//              which falls by decades in twilight is smooth. For programs of this project.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/tables/table_axes.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {

struct ScatteringTableSize {
  std::size_t nu = 8;          // >= 2
  std::size_t mu_s = 32;       // >= 2
  std::size_t mu = 128;        // even, >= 4: one half above the horizon, one below
  std::size_t altitudes = 32;  // >= 2
};

enum class ScatteringAxes { kBruneton, kAzimuth };

struct ScatteringTableOptions {
  ScatteringTableSize size;  // nu: number of azimuths for ScatteringAxes::kAzimuth
  /// Zenith cosine of the lowest sun; by default (nullopt) LowestUsefulSun() of the medium.
  std::optional<double> lowest_mu_s;
  ScatteringAxes axes = ScatteringAxes::kBruneton;
};

/// Returns the zenith cosine of the sun below which no observer up to the top sees sunlit air. The
/// sun is then three times the dip of the horizon seen from the top below the horizontal: two dips
/// are due to the view through the shell, one to the sunbeam.
[[nodiscard]] double LowestUsefulSun(const Medium& medium);

class ScatteringTable {
 public:
  /// Integrates every texel in parallel; the bytes do not depend on the number of threads.
  /// Stops between rows if the program is interrupted. Throws InputError, with the size in bytes,
  /// for a size that is not allowed.
  /// @param row_done  is called after each of the Rows(size) rows, from any thread; an exception
  ///   ends the work.
  explicit ScatteringTable(
      const Medium& medium, const ScatteringTableOptions& options = {},
      const std::function<void()>& row_done = [] {});

  /// Restores a stored table: texels as returned by texels(). Throws InputError unless their number
  /// matches the size and all lie in [0, 1].
  ScatteringTable(const Medium& medium, const ScatteringTableOptions& options,
                  std::vector<float> texels);

  /// Returns the light scattered once along the ray, interpolated, as factors of the two phase
  /// functions. It is never negative. Observers above the top are moved to where the ray enters.
  /// `transmittance` stays empty: TransmittanceTable provides it.
  ///
  /// Rays that end at length_m are differences of two look-ups, as in Bruneton and Neyret (2008):
  /// their absolute error is that of the whole rays, so short ones should be integrated instead.
  ///
  /// Error of the radiance against the reference solution at the default size, earth, observers to
  /// 12 km, all directions, as rms over the rms of the radiance and as the median of relative
  /// errors: sun above 5 degrees 1 % and 0.25 %, 5 to 0 degrees 1.5 % and 0.8 %, 0 to -6 degrees 40
  /// % and 15 %. In twilight eight angles between view and sun are too few for the glow over the
  /// sun. On azimuths, 8 x 32 x 64 x 48: 0.4 % and 0.15 %, 0.5 % and 0.2 %, 0.8 % and 0.45 %.
  [[nodiscard]] ScatteredOnce<float> Lookup(const ViewRay& ray) const;

  [[nodiscard]] const Medium& medium() const { return air_.medium(); }
  [[nodiscard]] const ScatteringTableSize& size() const { return size_; }
  [[nodiscard]] double lowest_mu_s() const { return lowest_mu_s_; }
  [[nodiscard]] ScatteringAxes axes() const { return axes_; }
  /// Size of the texels [bytes].
  [[nodiscard]] std::uint64_t bytes() const { return texels_.size() * sizeof(float); }
  [[nodiscard]] static constexpr std::size_t Rows(const ScatteringTableSize& size) {
    return size.mu * size.altitudes;
  }

  /// texels()[(((r * size().mu + mu) * size().nu + nu) * size().mu_s + mu_s) * 2 * bands + c] with
  /// channel c = band for molecules and bands + band for aerosol; fourth roots on the azimuth axes.
  [[nodiscard]] const std::vector<float>& texels() const { return texels_; }

  /// Returns the ray of a texel. In the lower half of the mu axis it hits the ground, in the upper
  /// half it misses the ground, regardless of rounding.
  [[nodiscard]] ViewRay RayOfTexel(std::size_t nu, std::size_t mu_s, std::size_t mu,
                                   std::size_t altitude) const;

 private:
  /// Start of a ray inside the shell, and whether the ray hits the ground.
  struct Start {
    double altitude_km, mu, mu_s;
    bool ground;
  };
  /// A texel of the plane of altitude and view angle.
  struct PlaneTap {
    std::size_t mu = 0, altitude = 0;
    float weight = 0.0F;
  };
  using PlaneTaps = std::array<PlaneTap, 8>;

  void FillRow(std::size_t row);
  [[nodiscard]] ScatteredOnce<float> Interpolate(const Start& start, double nu) const;
  [[nodiscard]] CubicTaps SunTaps(double mu_s) const;
  [[nodiscard]] CubicTaps AngleTaps(const Start& start, double nu) const;
  [[nodiscard]] PlaneTaps TapsByLength(const Start& start) const;
  [[nodiscard]] double LengthOf(bool ground, double altitude_km, double mu_unit) const;
  [[nodiscard]] double SunCosineOfTexel(std::size_t mu_s) const;
  [[nodiscard]] ScatteredOnce<float> LookupSegment(const ViewRay& ray,
                                                   const RayExtent& extent) const;
  [[nodiscard]] Start StartAt(const ViewRay& ray, double distance_m, bool ground) const;
  [[nodiscard]] std::size_t IndexOf(std::size_t nu, std::size_t mu_s, std::size_t mu,
                                    std::size_t altitude) const;

  SingleScattering<float> air_;
  ScatteringTableSize size_;
  double lowest_mu_s_;
  ScatteringAxes axes_;
  double radius_km_;
  double top_km_;
  std::vector<float> texels_;
};

}  // namespace alpenglow::lut
