// SPDX-License-Identifier: MIT
// The loops of multiple_scattering.h and successive_orders.h, one table an instruction set.
//
// Moments are packed for lanes in blocks of four bands: a node holds,
// for l = 0 ... degree, vectors of eight floats, (m, band) for m = 2p
// and 2p + 1. The last vector of an even l is padded with zeros.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "atmosphere/dialect/instruction_set.h"
#include "atmosphere/ray/ray.h"
#include "lut/layer.h"

namespace alpenglow::lut {

inline constexpr std::size_t kBlockBands = 4;
inline constexpr std::size_t kLargestDegree = 12;
inline constexpr std::size_t kLargestMoments = (kLargestDegree + 1) * (kLargestDegree + 2) / 2;
/// Vectors of eight floats before the row l of a node; of a whole node: [degree + 1].
constexpr std::size_t kPackedRow[kLargestDegree + 2] = {0,  1,  2,  4,  6,  9,  12,
                                                        16, 20, 25, 30, 36, 42, 49};

/// Floats that begin at a multiple of 64 bytes.
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

/// Vectors of eight floats of a node: of polarised light (polarised_light.h) two more, (T20, T21) and
/// (T22, moment 00 again).
constexpr std::size_t PackedVectors(std::size_t degree, bool polarised) {
  return kPackedRow[degree + 1] + (polarised ? 2 : 0);
}

/// Nodes of the table: altitude = top u^2; sun as DiffuseLight::SunCoordinate. Between sun nodes
/// moments are interpolated after division by Twilight(mu_s), the usual fall of their light when
/// the sun goes down, exp(-fall (x + sqrt(x^2 + width^2)) / 2) with x = start - mu_s; those of
/// polarised light also by SinePower (polarised_light.h).
struct DiffuseGrid {
  std::size_t altitudes, suns, degree;
  bool polarised;
  float top_km;
  float sun_centre, sun_width;      // of asinh
  float first_asinh, cells_a_unit;  // node = (asinh(...) - first_asinh) cells_a_unit
  float twilight_start, twilight_width, twilight_fall;
};

/// A point of a march: what the source there needs, whatever sun, band and order.
struct MarchPoint {
  std::array<std::uint32_t, 4> altitude_node;
  std::array<float, 4> altitude_weight;
  float mu, sine, distance_km, inverse_radius;  // 1 / distance from the planet's centre [1/km]
  bool only_molecules;                          // too little aerosol to matter
  std::array<float, kLargestMoments> legendre;
};

/// What a point scatters into the ray for four bands: transmittance, weight and coefficient.
struct MarchLight {
  std::array<float, kBlockBands> rayleigh, mie;
};

/// A direction at a node's altitude, and the suns there.
struct MarchDirection {
  float mu, sine, radius_km;  // of the node
  const float* mu_s;          // [suns]
  const float* sine_s;
  const float* azimuth_cosine;  // [azimuths]
  std::size_t azimuths;         // <= kMostAzimuths
};
inline constexpr std::size_t kMostAzimuths = 32;

/// Legendre coefficients of the aerosol's phase function, for four bands.
using BlockChi = std::array<std::array<float, kBlockBands>, kLargestDegree + 1>;

/// A block of bands as look-ups need it; coefficients per km.
struct DiffuseBlock {
  std::array<float, kBlockBands> rayleigh, mie_scattering, mie_extinction, ozone;
  std::array<float, kBlockBands> rayleigh_chi2;  // of the molecules: D / 10
  BlockChi chi;
};

/// Straight pieces of rays from one node in sunlight.
struct LitPieces {
  std::size_t count;         // multiple of 16
  const float *begin, *end;  // km from the node; begin == end: nothing
  const float *nu, *mu_s;    // at the node
  float altitude_km, mu, radius_km;
  float extinction;           // at the ground [1/km], largest over bands
  float map_lengths_per_km;   // MapLengthsPerKm
  std::size_t nodes;          // of the Gauss rule
  const float *node, *gauss;  // on [0, 1]
};

/// Points on them: [node * count + piece].
struct LitPoints {
  float *weight, *altitude, *mu, *absolute_mu, *mu_s;
};

/// Where light on a surface is looked up: 16 nodes of the table and the weights of their moments,
/// which are divided by Twilight.
struct SurfacePoint {
  std::array<std::uint32_t, 16> node;
  std::array<float, 16> weight;
  float sun_sine;                   // of its zenith angle
  float normal_mu, normal_azimuth;  // cosines: to the vertical, of the azimuth from the sun's
};

struct ColumnPointers {
  const float *rayleigh, *mie, *ozone;
};

/// Scale heights of molecules and aerosol, and the deficit of molecules (MoleculeDeficit) [km].
struct LayerHeights {
  float rayleigh, mie, deficit, deficit_height;
};

/// What scatters along marches, for four bands: the aerosol's chi_l, the molecules' chi_2.
struct BlockShape {
  BlockChi mie;
  std::array<float, kBlockBands> rayleigh_chi2;
};

struct DiffuseKernel {
  /// Light of the previous order that arrives along a march: adds to
  /// arriving[((sun * azimuths) + azimuth) * 8 + half * 4 + band]; the two halves
  /// are to be added. `rows` is room for (suns + 2) * (degree / 2 + 3) * 8 floats.
  /// All begin at multiples of 64 bytes.
  void (*arrive)(const DiffuseGrid& grid, const MarchDirection& direction, const MarchPoint* points,
                 const MarchLight* lights, std::size_t count, const BlockShape& shape,
                 const float* previous, float* rows, float* arriving);
  /// The same of a polarised grid: I, Q and U at [(((sun * azimuths) + azimuth) * 3 + stokes) * 8 +
  /// half * 4 + band], in the frame of polarised_light.h.
  void (*arrive_polarised)(const DiffuseGrid& grid, const MarchDirection& direction,
                           const MarchPoint* points, const MarchLight* lights, std::size_t count,
                           const BlockShape& shape, const float* previous, float* rows,
                           float* arriving);
  /// Places nodes on lit pieces.
  void (*place)(const LitPieces& pieces, const LitPoints& points);
  /// Light scattered once along lit pieces without phase functions, of one band: rayleigh[piece],
  /// mie[piece] per unit scattering coefficient at the ground.
  void (*scatter)(const LitPieces& pieces, const LitPoints& points, const ColumnPointers& up,
                  const ColumnPointers& sun, const std::array<float, 6>& origin_and_perigee,
                  const std::array<float, 3>& extinction, const LayerHeights& layers,
                  float* rayleigh, float* mie);
  /// Inscattered light along a sampled ray: light[block * 4 + band]. Moments are packed and divided
  /// by Twilight: [((block * altitudes + altitude) * suns + sun) * node + i].
  void (*inscatter)(const DiffuseGrid& grid, const RaySamples<float>& samples, float nu,
                    const DiffuseBlock* blocks, std::size_t count, const float* moments,
                    float* light);
  /// Light of the table on a surface: irradiance[block * 4 + band]. `moments` as above, `sky` what
  /// falls on a horizontal plane: [(block * nodes + node) * 4 + band].
  void (*irradiance)(const DiffuseGrid& grid, const SurfacePoint& point, std::size_t count,
                     const float* moments, const float* sky, float* irradiance);
};

ALPENGLOW_DECLARE_KERNEL(DiffuseKernel);

}  // namespace alpenglow::lut
