// SPDX-License-Identifier: MIT
// This header declares the loops of multiple_scattering.h and successive_orders.h, as one function
// table per instruction set.
//
// Moments are packed for lanes in blocks of four bands: a node holds, for l = 0 ... degree, vectors
// of eight floats, (m, band) for m = 2p and 2p + 1. The last vector of an even l is padded with
// zeros.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "atmosphere/ray/ray.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/layer.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::lut {

inline constexpr std::size_t kBlockBands = 4;
/// Number of vectors of eight floats before row l of a node; entry [degree + 1] is the size of a
/// whole node.
constexpr std::size_t kPackedRow[kMaxDegree + 2] = {0,  1,  2,  4,  6,  9,  12,
                                                    16, 20, 25, 30, 36, 42, 49};

/// An array of floats that begins at a multiple of 64 bytes.
class AlignedFloats {
 public:
  AlignedFloats() = default;
  explicit AlignedFloats(std::size_t count) : lines_((count + 15) / 16) {}
  [[nodiscard]] float* data() { return lines_.front().value.data(); }
  [[nodiscard]] const float* data() const { return lines_.front().value.data(); }
  [[nodiscard]] std::size_t size() const { return lines_.size() * 16; }

 private:
  struct alignas(64) Line {
    std::array<float, 16> value{};
  };
  std::vector<Line> lines_;
};

/// Returns the number of vectors of eight floats in a node. Polarised light
/// (polarised_scattering.h) needs two more, (T20, T21) and (T22, a copy of moment 00).
constexpr std::size_t PackedVectors(std::size_t degree, bool polarised) {
  return kPackedRow[degree + 1] + (polarised ? 2 : 0);
}

/// Nodes of the table: altitude = top u^2; sun as in MultipleScattering::SunCoordinate. Between sun
/// nodes moments are interpolated after division by Twilight(mu_s), the usual fall of their light
/// when the sun goes down, exp(-fall (x + sqrt(x^2 + width^2)) / 2) with x = start - mu_s. Moments
/// of polarised light are also divided by SinePower (polarised_scattering.h).
struct MomentGrid {
  std::size_t altitudes, suns, degree;
  bool polarised;
  float top_km;
  float sun_centre, sun_width;      // parameters of asinh
  float first_asinh, cells_a_unit;  // node = (asinh(...) - first_asinh) cells_a_unit
  float twilight_start, twilight_width, twilight_fall;
};

/// A point of a march, with the values that its source needs for every sun, band and order.
struct MarchPoint {
  std::array<std::uint32_t, 4> altitude_node;
  std::array<float, 4> altitude_weight;
  float mu, sine, distance_km, inverse_radius;  // 1 / distance from the planet's centre [1/km]
  bool only_molecules;                          // aerosol scatters too little to matter
  std::array<float, kMaxMoments> legendre;
};

/// Factors of the light that a point scatters into the ray, for four bands: transmittance, weight
/// and coefficient.
struct MarchLight {
  std::array<float, kBlockBands> rayleigh, mie;
};

/// A direction at a node's altitude, with the sun angles and azimuths there.
struct MarchDirection {
  float mu, sine, radius_km;  // radius_km of the node
  const float* mu_s;          // [suns]
  const float* sine_s;
  const float* azimuth_cosine;  // [azimuths]
  std::size_t azimuths;         // <= kMostAzimuths
};
inline constexpr std::size_t kMostAzimuths = 32;

/// Legendre coefficients of scattering, for four bands: chi_l of the aerosol, chi_2 of the
/// molecules (D / 10).
struct BlockShape {
  std::array<std::array<float, kBlockBands>, kMaxDegree + 1> mie;
  std::array<float, kBlockBands> rayleigh_chi2;
};

/// A block of bands in the form that look-ups need; coefficients per km.
struct MomentBlock {
  std::array<float, kBlockBands> rayleigh, mie_scattering, mie_extinction, ozone;
  BlockShape shape;
};

/// Straight pieces of rays from one node that lie in sunlight.
struct LitPieces {
  std::size_t count;         // multiple of 16
  const float *begin, *end;  // km from the node; begin == end: empty piece
  const float *nu, *mu_s;    // at the node
  float altitude_km, mu, radius_km;
  float extinction;           // at the ground [1/km], largest over bands
  float map_lengths_per_km;   // MapLengthsPerKm
  std::size_t nodes;          // of the Gauss rule
  const float *node, *gauss;  // on [0, 1]
};

/// Points on the lit pieces: [node * count + piece].
struct LitPoints {
  float *weight, *altitude, *mu, *absolute_mu, *mu_s;
};

/// A point at which light on a surface is looked up: 16 nodes of the table and the weights of their
/// moments, which are divided by Twilight.
struct SurfacePoint {
  std::array<std::uint32_t, 16> node;
  std::array<float, 16> weight;
  float sun_sine;                   // sine of the sun's zenith angle
  float normal_mu, normal_azimuth;  // cosines: angle to the vertical; azimuth from the sun's
};

struct ColumnPointers {
  const float *rayleigh, *mie, *ozone;
};

/// Scale heights of molecules and aerosol, and the deficit of molecules (MoleculeDeficit) [km].
struct LayerHeights {
  float rayleigh, mie, deficit, deficit_height;
};

struct MomentKernel {
  /// Adds the light of the previous order that arrives along a march to arriving[((sun * azimuths)
  /// + azimuth) * 8 + half * 4 + band], or, for a polarised grid, I, Q and U in the frame of
  /// polarised_scattering.h to arriving[(((sun * azimuths) + azimuth) * 3 + stokes) * 8 + half * 4
  /// + band]. The caller adds the two halves. `rows` is scratch space for (suns + 2) * (degree / 2
  /// + 3) * 8 floats. All arrays begin at multiples of 64 bytes.
  void (*arrive)(const MomentGrid& grid, const MarchDirection& direction, const MarchPoint* points,
                 const MarchLight* lights, std::size_t count, const BlockShape& shape,
                 const float* previous, float* rows, float* arriving);
  /// Places nodes on lit pieces.
  void (*place)(const LitPieces& pieces, const LitPoints& points);
  /// Finds the light of one band that is scattered once along lit pieces, without phase functions:
  /// rayleigh[piece], mie[piece] per unit scattering coefficient at the ground.
  void (*scatter)(const LitPieces& pieces, const LitPoints& points, const ColumnPointers& up,
                  const ColumnPointers& sun, const std::array<float, 6>& origin_and_perigee,
                  const std::array<float, 3>& extinction, const LayerHeights& layers,
                  float* rayleigh, float* mie);
  /// Finds the in-scattered light along a sampled ray: light[block * 4 + band]. Moments are packed
  /// and divided by Twilight: [((block * altitudes + altitude) * suns + sun) * node + i].
  void (*inscatter)(const MomentGrid& grid, const RaySamples<float>& samples, float nu,
                    const MomentBlock* blocks, std::size_t count, const float* moments,
                    float* light);
  /// Finds the light of the table on a surface: irradiance[block * 4 + band]. `moments` is laid out
  /// as for `inscatter`; `sky` is the irradiance of a horizontal plane: [(block * nodes + node) * 4
  /// + band].
  void (*irradiance)(const MomentGrid& grid, const SurfacePoint& point, std::size_t count,
                     const float* moments, const float* sky, float* irradiance);
};

ALPENGLOW_DECLARE_KERNEL(MomentKernel);

}  // namespace alpenglow::lut
