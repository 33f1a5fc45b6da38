// SPDX-License-Identifier: MIT
// This header provides the axes of MultipleScattering's table to code outside the kernels, the
// directions from the nodes of this table, and the points along them. Successive orders march along
// these for every band and order.
//
// It also provides the first of the successive orders: sunlight that arrives at the nodes after one
// scattering or after reflection by the ground.
#pragma once

#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/multiple_scattering/moment_kernel.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {

[[nodiscard]] MomentGrid GridOf(const Medium& medium, const MultipleScatteringOptions& options);

/// Returns the medium in which the moments are transported: without the forward peak if
/// MultipleScatteringOptions::delta_m is set.
[[nodiscard]] DeltaScaledMedium ScatteringMedium(const Medium& medium,
                                                 const MultipleScatteringOptions& options);

/// Returns the divisor of moments before they are interpolated between sun angles, in (0, 1].
[[nodiscard]] float TwilightOf(const MomentGrid& grid, double mu_s);

/// Returns the sun nodes around mu_s and their weights, for moments that are not divided by
/// TwilightOf.
[[nodiscard]] CubicTaps SunTaps(const MomentGrid& grid, double mu_s);

/// Returns TwilightOf at every sun node.
[[nodiscard]] std::vector<float> TwilightAtNodes(const MomentGrid& grid);

/// Returns the molecules' Legendre coefficient of degree 2: D / 10.
[[nodiscard]] float RayleighChi2(const Medium& medium, std::size_t band);

/// Returns the coefficients of the four bands from first_band on; 0 where the medium has fewer.
/// @param chi  of the aerosol: degree l of a band at [l * bands + band].
[[nodiscard]] BlockShape ShapeOfBlock(const Medium& medium, const std::vector<double>& chi,
                                      std::size_t degree, std::size_t first_band);

/// Returns the zenith cosine of a sun node. The nodes are those of MultipleScattering::SunNodes(),
/// except that for polarised light the last one lies close to the zenith.
[[nodiscard]] double MuSOfNode(const MomentGrid& grid, std::size_t sun);

/// Returns the sine of an angle in [0, pi] from its cosine.
[[nodiscard]] double SineOf(double cosine);
/// Returns the sine of the sun's zenith angle.
[[nodiscard]] float SunSine(double mu_s);

/// Returns the factor that restores a moment of order m which was divided at a node: SinePower for
/// polarised light, else 1.
[[nodiscard]] inline float SinePowerOf(const MomentGrid& grid, std::size_t m, float sun_sine) {
  return grid.polarised ? SinePower(m, sun_sine) : 1.0F;
}

/// Returns the index at which moment (l, m) of a block's bands begins in a packed node.
[[nodiscard]] constexpr std::size_t PackedIndex(std::size_t l, std::size_t m) {
  return (kPackedRow[l] + m / 2) * 8 + (m % 2) * kBlockBands;
}

/// Return the indices at which T2m of a block's bands, and the copy of moment 00, begin in a packed
/// node.
[[nodiscard]] constexpr std::size_t PackedTensorIndex(std::size_t degree, std::size_t m) {
  return (kPackedRow[degree + 1] + m / 2) * 8 + (m % 2) * kBlockBands;
}
[[nodiscard]] constexpr std::size_t PackedTensorTrace(std::size_t degree) {
  return PackedTensorIndex(degree, 3);
}

/// One direction at one altitude, for all suns and azimuths.
struct March {
  float mu = 0.0F, sine = 0.0F;
  float solid_angle = 0.0F;  // of the direction and its mirror image, per azimuth of half a turn
  std::array<float, kMaxMoments> legendre{};
  std::vector<MarchPoint> points;
  std::vector<std::array<float, 6>>
      air;                            // per point: weight [km], densities, columns from the node
  std::array<float, 3> columns_km{};  // of the whole march
  std::vector<double> panels;  // distances where the ray begins, is lowest (if between), ends [km]
  bool hits_ground = false;
  double ground_distance_km = 0.0;
  Spectrum ground_transmittance;
  std::vector<CubicTaps> ground_taps;  // [sun * azimuths + azimuth], for divided moments
};

class MomentMarches {
 public:
  /// @param chi  Legendre coefficients of aerosol scattering: degree l of a band at [l * bands +
  ///   band].
  MomentMarches(const SingleScattering<float>& air, const MultipleScatteringOptions& options,
                const std::vector<double>& chi);

  [[nodiscard]] const SingleScattering<float>& air() const { return *air_; }
  [[nodiscard]] const MomentGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<double>& chi() const { return *chi_; }
  [[nodiscard]] std::size_t azimuths() const { return azimuths_; }
  [[nodiscard]] double altitude_km(std::size_t i) const { return altitude_km_[i]; }
  [[nodiscard]] double mu_s(std::size_t sun) const { return mu_s_[sun]; }
  [[nodiscard]] double radius_km() const { return radius_km_; }
  [[nodiscard]] const std::vector<March>& At(std::size_t altitude) const {
    return marches_[altitude];
  }
  /// Returns cos(m phi) of all azimuths.
  [[nodiscard]] const float* AzimuthCosines(std::size_t m) const {
    return azimuth_cosines_[m].data();
  }
  /// Returns sin(m phi) of all azimuths for m = 1, 2.
  [[nodiscard]] const float* AzimuthSines(std::size_t m) const {
    return azimuth_sines_[m - 1].data();
  }
  [[nodiscard]] MarchDirection Direction(std::size_t altitude, const March& march) const;
  /// Returns the cosine of the angle between a march and the sun.
  [[nodiscard]] double Nu(const March& march, std::size_t sun, std::size_t azimuth) const;

 private:
  [[nodiscard]] std::vector<March> MarchesAt(std::size_t altitude,
                                             const MultipleScatteringOptions& options) const;
  /// Begin of a part of a march: distance and columns from the node.
  struct PartOfMarch {
    double begin_km;
    ColumnSet<float> columns;
  };
  void AddPoints(std::size_t altitude, const MultipleScatteringOptions& options, double mu,
                 March& march) const;
  void AppendPoints(const RaySamples<float>& samples, const PartOfMarch& part, int degree,
                    March& march) const;
  void AddGround(std::size_t altitude, March& march) const;

  const SingleScattering<float>* air_;
  const std::vector<double>* chi_;
  MomentGrid grid_;
  double radius_km_;
  bool is_deep_;  // marches are cut at optical depths
  std::size_t azimuths_;
  std::vector<double> altitude_km_, mu_s_;
  std::vector<float> mu_s_floats_, sine_s_;
  std::array<AlignedFloats, kMaxDegree + 1> azimuth_cosines_;
  std::array<AlignedFloats, 2> azimuth_sines_;
  std::vector<std::vector<March>> marches_;
};

/// Light along one march per unit solar irradiance: [(band * suns + sun) * azimuths + azimuth].
struct SunlightOfMarch {
  std::vector<float> radiance;   // [1/sr]
  std::vector<float> molecules;  // light that molecules scatter, without phase function [1]
};

[[nodiscard]] SunlightOfMarch SunlightScatteredOnce(const MomentMarches& marches,
                                                    std::size_t altitude, const March& march,
                                                    const MultipleScatteringOptions& options);

}  // namespace alpenglow::lut
