// SPDX-License-Identifier: MIT
#include "lut/diffuse/diffuse_kernel.h"

#include <type_traits>
#include <utility>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/batch.h"
#include "atmosphere/ray/optical_depth.h"
#include "lut/diffuse/tensor_moments.h"

namespace alpenglow {
namespace {

// Lanes of work that comes by eights: at most eight, fewer where the processor has fewer.
#if defined(ALPENGLOW_SIMD) && !defined(XSIMD_NO_SUPPORTED_ARCHITECTURE)
constexpr std::size_t kWidth = BatchOf<float>::kLanes < 8 ? BatchOf<float>::kLanes : 8;
using V = xsimd::make_sized_batch_t<float, kWidth>;
V Load(const float* from) { return V::load_aligned(from); }
void Store(float* to, const V& value) { value.store_aligned(to); }
V Floor(const V& value) { return xsimd::floor(value); }
V Clamped(const V& value, const V& low, const V& high) {
  return xsimd::min(xsimd::max(value, low), high);
}
#else
constexpr std::size_t kWidth = 1;
using V = float;
V Load(const float* from) { return *from; }
void Store(float* to, const V& value) { *to = value; }
V Floor(const V& value) { return std::floor(value); }
V Clamped(const V& value, const V& low, const V& high) {
  return value < low ? low : high < value ? high : value;
}
#endif

constexpr std::size_t kParts = 8 / kWidth;

/// Eight floats: four bands of an even m, four of the next.
struct Eight {
  V part[kParts];
};

Eight LoadEight(const float* from) {
  Eight value;
  for (std::size_t i = 0; i < kParts; ++i) value.part[i] = Load(from + i * kWidth);
  return value;
}

void StoreEight(float* to, const Eight& value) {
  for (std::size_t i = 0; i < kParts; ++i) Store(to + i * kWidth, value.part[i]);
}

// sum + factor * value
void Add(Eight& sum, const V& factor, const Eight& value) {
  for (std::size_t i = 0; i < kParts; ++i) sum.part[i] += factor * value.part[i];
}
void Add(Eight& sum, const Eight& factor, const Eight& value) {
  for (std::size_t i = 0; i < kParts; ++i) sum.part[i] += factor.part[i] * value.part[i];
}

Eight Zero() {
  Eight zero;
  for (std::size_t i = 0; i < kParts; ++i) zero.part[i] = V(0.0F);
  return zero;
}

#if defined(ALPENGLOW_SIMD) && !defined(XSIMD_NO_SUPPORTED_ARCHITECTURE)
// a four times, b four times.
Eight Pair(float a, float b) {
  Eight value;
  if constexpr (kWidth == 8) {
    alignas(64) constexpr float kHalf[8] = {0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F, 1.0F};
    value.part[0] = xsimd::select(Load(kHalf) > V(0.5F), V(b), V(a));
  } else {
    for (std::size_t i = 0; i < kParts; ++i) value.part[i] = V(i * kWidth < 4 ? a : b);
  }
  return value;
}
#else
Eight Pair(float a, float b) {
  Eight value;
  for (std::size_t i = 0; i < kParts; ++i) value.part[i] = i < 4 ? a : b;
  return value;
}
#endif

template <typename T>
struct Weights {
  T w0, w1, w2, w3;
};

namespace shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "lut/table/cubic_taps.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace shared

template <typename T>
Weights<T> Cubic(const T& t) {
  using namespace shared;
  return {CubicWeight0<T>(t), CubicWeight1<T>(t), CubicWeight2<T>(t), CubicWeight3<T>(t)};
}

template <typename T>
T SunPosition(const DiffuseGrid& grid, const T& mu_s) {
  using namespace shared;
  const T x = (mu_s - T(grid.sun_centre)) * T(1.0F / grid.sun_width);
  const T magnitude = abs(x);
  const T asinh = log(magnitude + sqrt(magnitude * magnitude + T(1.0F)));
  const T signed_asinh = select(x < T(0.0F), T(-asinh), asinh);
  return (signed_asinh - T(grid.first_asinh)) * T(grid.cells_a_unit);
}

// A batch of half of this set's size is another set's type: what the compiler does not inline of it
// would have that set's name. Its exponential is taken in lanes of this set.
template <typename T>
T Exponential(const T& value) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  if constexpr (std::is_same_v<T, Lanes::Type>) {
    return exp(value);
  } else {
    alignas(64) float lanes[Lanes::kLanes] = {};
    Store(lanes, value);
    Lanes::Store(lanes, exp(Lanes::Load(lanes)));
    return Load(lanes);
  }
}

template <typename T>
T Twilight(const DiffuseGrid& grid, const T& mu_s) {
  using namespace shared;
  const T x = T(grid.twilight_start) - mu_s;
  const T width(grid.twilight_width);
  return Exponential<T>(T(-0.5F * grid.twilight_fall) * (x + sqrt(x * x + width * width)));
}

template <typename T>
T CosineOfAzimuth(const T& mu, const T& sine, const T& mu_s, const T& nu) {
  using namespace shared;
  const T sine_s_squared = (T(1.0F) - mu_s) * (T(1.0F) + mu_s);
  const T sines = sine * sqrt(max(sine_s_squared, T(1e-12F)));
  const T cosine = (nu - mu * mu_s) / max(sines, T(1e-6F));
  return min(max(cosine, T(-1.0F)), T(1.0F));
}

// Source of a march point per cos(m phi) at every sun node, altitude and degree summed: row
// (1 + sun) of kRow vectors.
template <std::size_t kDegree, std::size_t kStep, std::size_t kLast, std::size_t kNode,
          std::size_t kRow>
void ContractRows(const DiffuseGrid& grid, const MarchPoint& point, const Eight* factor,
                  const float* previous, float* rows) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  constexpr std::size_t kMoments = kPackedRow[kDegree + 1];
  const std::size_t stride = grid.suns * kNode * 8;
  const float* node[4] = {
      previous + point.altitude_node[0] * stride, previous + point.altitude_node[1] * stride,
      previous + point.altitude_node[2] * stride, previous + point.altitude_node[3] * stride};
  for (std::size_t sun = 0; sun < grid.suns; ++sun) {
    Eight sum[kPairs];
    for (std::size_t p = 0; p < kPairs; ++p) sum[p] = Zero();
    for (std::size_t tap = 0; tap < 4; ++tap) {
      const float* at = node[tap] + sun * kNode * 8;
      for (std::size_t l = 0; l <= kLast; l += kStep) {
        for (std::size_t p = 0; p <= l / 2; ++p) {
          const std::size_t i = kPackedRow[l] + p;
          Add(sum[p], factor[tap * kMoments + i], LoadEight(at + i * 8));
        }
      }
    }
    for (std::size_t p = 0; p < kPairs; ++p) StoreEight(rows + ((sun + 1) * kRow + p) * 8, sum[p]);
  }
}

// Factors of moments in the source of a march point: [tap * vectors + vector]. Of polarised light
// what molecules scatter is left to the tensor.
template <std::size_t kDegree, bool kPolarised>
void FindFactors(const MarchPoint& point, const MarchLight& light, const BlockShape& shape,
                 Eight* factor) {
  constexpr std::size_t kMoments = kPackedRow[kDegree + 1];
  for (std::size_t l = 0; l <= kDegree; ++l) {
    alignas(64) float source[8];
    for (std::size_t band = 0; band < 8; ++band) {
      const std::size_t lane = band % 4;
      const float rayleigh_chi = kPolarised ? 0.0F
                                 : l == 0   ? 1.0F
                                 : l == 2   ? shape.rayleigh_chi2[lane]
                                            : 0.0F;
      source[band] = light.rayleigh[lane] * rayleigh_chi + light.mie[lane] * shape.mie[l][lane];
    }
    const Eight of_row = LoadEight(source);
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const std::size_t m = l * (l + 1) / 2 + 2 * p;
      Eight legendre = Pair(point.legendre[m], 2 * p < l ? point.legendre[m + 1] : 0.0F);
      for (std::size_t i = 0; i < kParts; ++i) legendre.part[i] *= of_row.part[i];
      for (std::size_t tap = 0; tap < 4; ++tap) {
        Eight& weighted = factor[tap * kMoments + kPackedRow[l] + p];
        weighted = Zero();
        Add(weighted, V(point.altitude_weight[tap]), legendre);
      }
    }
  }
}

// A node beyond each end continues the line through the last two, so that every tap has four
// neighbours.
template <std::size_t kRow>
void AddEnds(std::size_t suns, float* rows) {
  for (std::size_t i = 0; i < kRow * 8; ++i) {
    rows[i] = 2.0F * rows[kRow * 8 + i] - rows[2 * kRow * 8 + i];
    const float* last = rows + suns * kRow * 8 + i;
    rows[(suns + 1) * kRow * 8 + i] = 2.0F * last[0] - last[-static_cast<std::ptrdiff_t>(kRow * 8)];
  }
}

template <std::size_t kDegree>
void Contract(const DiffuseGrid& grid, const MarchPoint& point, const MarchLight& light,
              const BlockShape& shape, const float* previous, float* rows) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  constexpr std::size_t kNode = kPackedRow[kDegree + 1];
  Eight factor[4 * kNode];
  FindFactors<kDegree, false>(point, light, shape, factor);
  if (point.only_molecules) {
    ContractRows<kDegree, 2, 2, kNode, kPairs>(grid, point, factor, previous, rows);
  } else {
    ContractRows<kDegree, 1, kDegree, kNode, kPairs>(grid, point, factor, previous, rows);
  }
  AddEnds<kPairs>(grid.suns, rows);
}

// The tensor at every sun node times what molecules scatter: (D/10 T20, D/10 T21) and (D/10 T22,
// moment 00 Y00), in the last two vectors of each row.
template <std::size_t kDegree>
void ContractTensor(const DiffuseGrid& grid, const MarchPoint& point, const MarchLight& light,
                    const BlockShape& shape, const float* previous, float* rows) {
  constexpr std::size_t kNode = PackedVectors(kDegree, true);
  constexpr std::size_t kRow = kDegree / 2 + 3;
  alignas(64) float degree2[8], degree0[8];
  for (std::size_t band = 0; band < 8; ++band) {
    degree2[band] = light.rayleigh[band % 4] * shape.rayleigh_chi2[band % 4];
    degree0[band] = band < 4 ? degree2[band] : light.rayleigh[band % 4] * point.legendre[0];
  }
  const Eight first = LoadEight(degree2), second = LoadEight(degree0);
  for (std::size_t sun = 0; sun < grid.suns; ++sun) {
    Eight sum[2] = {Zero(), Zero()};
    for (std::size_t tap = 0; tap < 4; ++tap) {
      const float* at =
          previous +
          ((point.altitude_node[tap] * grid.suns + sun) * kNode + kPackedRow[kDegree + 1]) * 8;
      const V weight(point.altitude_weight[tap]);
      Add(sum[0], weight, LoadEight(at));
      Add(sum[1], weight, LoadEight(at + 8));
    }
    float* row = rows + ((sun + 1) * kRow + kDegree / 2 + 1) * 8;
    Eight source[2] = {Zero(), Zero()};
    Add(source[0], first, sum[0]);
    Add(source[1], second, sum[1]);
    StoreEight(row, source[0]);
    StoreEight(row + 8, source[1]);
  }
}

/// Where the suns of all azimuths stand at a march point: neighbours and local azimuths.
template <std::size_t kPairs>
struct AzimuthTaps {
  alignas(64) float cell[kMostAzimuths];
  alignas(64) float weight[4][kMostAzimuths];
  alignas(64) float cosine[2 * kPairs][kMostAzimuths];  // of m phi, times SinePower if polarised
  alignas(64) float sine[2][kMostAzimuths];             // of phi and 2 phi, the same; if polarised
};

// Multiplies cosines by powers of the sun's zenith sine, and finds the sines of azimuths.
template <std::size_t kPairs>
void ScaleAzimuths(const V& mu_s, const V& cosine, std::size_t k, AzimuthTaps<kPairs>& taps) {
  using namespace shared;
  const V zero(0.0F), one(1.0F);
  const V squared = max((one - mu_s) * (one + mu_s), zero);
  const V sun_sine = sqrt(squared);
  const V sine = sqrt(max((one - cosine) * (one + cosine), zero));
  Store(taps.sine[0] + k, sun_sine * sine);
  Store(taps.sine[1] + k, squared * V(2.0F) * sine * cosine);
  Store(taps.cosine[1] + k, sun_sine * Load(taps.cosine[1] + k));
  for (std::size_t m = 2; m < 2 * kPairs; ++m)
    Store(taps.cosine[m] + k, squared * Load(taps.cosine[m] + k));
}

template <std::size_t kPairs>
void FindTaps(const DiffuseGrid& grid, const MarchDirection& direction, const MarchPoint& point,
              std::size_t sun, AzimuthTaps<kPairs>& taps) {
  const float mu_s0 = direction.mu_s[sun];
  const V flat(direction.mu * mu_s0), sines(direction.sine * direction.sine_s[sun]);
  const V last(static_cast<float>(grid.suns - 2));
  for (std::size_t k = 0; k < direction.azimuths; k += kWidth) {
    const V nu = Clamped(flat + sines * Load(direction.azimuth_cosine + k), V(-1.0F), V(1.0F));
    const V mu_s = Clamped(
        (V(direction.radius_km * mu_s0) + V(point.distance_km) * nu) * V(point.inverse_radius),
        V(-1.0F), V(1.0F));
    const V position =
        Clamped(SunPosition<V>(grid, mu_s), V(0.0F), V(static_cast<float>(grid.suns - 1)));
    const V cell = Clamped(Floor(position), V(0.0F), last);
    const V light = Twilight<V>(grid, mu_s);
    const Weights<V> cubic = Cubic<V>(position - cell);
    Store(taps.cell + k, cell);
    Store(taps.weight[0] + k, cubic.w0 * light);
    Store(taps.weight[1] + k, cubic.w1 * light);
    Store(taps.weight[2] + k, cubic.w2 * light);
    Store(taps.weight[3] + k, cubic.w3 * light);
    const V cosine = CosineOfAzimuth<V>(V(point.mu), V(point.sine), mu_s, nu);
    V before(1.0F), now = cosine;
    Store(taps.cosine[0] + k, before);
    for (std::size_t m = 1; m < 2 * kPairs; ++m) {
      Store(taps.cosine[m] + k, now);
      const V next = V(2.0F) * cosine * now - before;
      before = now;
      now = next;
    }
    if (grid.polarised) ScaleAzimuths<kPairs>(mu_s, cosine, k, taps);
  }
}

template <std::size_t kDegree>
void ArriveOfDegree(const DiffuseGrid& grid, const MarchDirection& direction,
                    const MarchPoint* points, const MarchLight* lights, std::size_t count,
                    const BlockShape& shape, const float* previous, float* rows, float* arriving) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  AzimuthTaps<kPairs> taps;
  for (std::size_t s = 0; s < count; ++s) {
    Contract<kDegree>(grid, points[s], lights[s], shape, previous, rows);
    float* light = arriving;
    for (std::size_t sun = 0; sun < grid.suns; ++sun) {
      FindTaps<kPairs>(grid, direction, points[s], sun, taps);
      for (std::size_t k = 0; k < direction.azimuths; ++k, light += 8) {
        const float* row =
            rows + static_cast<std::size_t>(static_cast<int>(taps.cell[k])) * kPairs * 8;
        const V w0(taps.weight[0][k]), w1(taps.weight[1][k]), w2(taps.weight[2][k]),
            w3(taps.weight[3][k]);
        Eight sum = LoadEight(light);
        for (std::size_t p = 0; p < kPairs; ++p) {
          Eight there = Zero();
          Add(there, w0, LoadEight(row + p * 8));
          Add(there, w1, LoadEight(row + (kPairs + p) * 8));
          Add(there, w2, LoadEight(row + (2 * kPairs + p) * 8));
          Add(there, w3, LoadEight(row + (3 * kPairs + p) * 8));
          Add(sum, Pair(taps.cosine[2 * p][k], taps.cosine[2 * p + 1][k]), there);
        }
        StoreEight(light, sum);
      }
    }
  }
}

// Weights of four rows of suns, and where the first of them begins.
struct SunRows {
  const float* row;
  V w0, w1, w2, w3;
};

template <std::size_t kRow>
Eight BetweenSuns(const SunRows& at, std::size_t vector) {
  const float* row = at.row + vector * 8;
  Eight there = Zero();
  Add(there, at.w0, LoadEight(row));
  Add(there, at.w1, LoadEight(row + kRow * 8));
  Add(there, at.w2, LoadEight(row + 2 * kRow * 8));
  Add(there, at.w3, LoadEight(row + 3 * kRow * 8));
  return there;
}

// Adds what a march point's molecules send along one azimuth: I, Q and U.
template <std::size_t kPairs>
void AddTensorLight(const MarchPoint& point, const TensorStokes<float>& stokes,
                    const AzimuthTaps<kPairs>& taps, std::size_t k, const SunRows& at,
                    float* light) {
  constexpr std::size_t kRow = kPairs + 2;
  const Eight first = BetweenSuns<kRow>(at, kPairs), second = BetweenSuns<kRow>(at, kPairs + 1);
  const float cosine = taps.cosine[1][k], cosine2 = taps.cosine[2][k];
  const float of_first[3][2] = {{point.legendre[3], point.legendre[4] * cosine},
                                {stokes.q20, stokes.q21 * cosine},
                                {0.0F, stokes.u21 * taps.sine[0][k]}};
  const float of_second[3][2] = {{point.legendre[5] * cosine2, 1.0F},
                                 {stokes.q22 * cosine2, 0.0F},
                                 {stokes.u22 * taps.sine[1][k], 0.0F}};
  for (std::size_t i = 0; i < 3; ++i) {
    Eight sum = LoadEight(light + i * 8);
    Add(sum, Pair(of_first[i][0], of_first[i][1]), first);
    Add(sum, Pair(of_second[i][0], of_second[i][1]), second);
    StoreEight(light + i * 8, sum);
  }
}

template <std::size_t kDegree>
void ArrivePolarisedOfDegree(const DiffuseGrid& grid, const MarchDirection& direction,
                             const MarchPoint* points, const MarchLight* lights, std::size_t count,
                             const BlockShape& shape, const float* previous, float* rows,
                             float* arriving) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  constexpr std::size_t kRow = kPairs + 2;
  AzimuthTaps<kPairs> taps;
  for (std::size_t s = 0; s < count; ++s) {
    const MarchPoint& point = points[s];
    const std::size_t pairs = point.only_molecules ? 0 : kPairs;
    if (!point.only_molecules) {
      Eight factor[4 * kPackedRow[kDegree + 1]];
      FindFactors<kDegree, true>(point, lights[s], shape, factor);
      ContractRows<kDegree, 1, kDegree, PackedVectors(kDegree, true), kRow>(grid, point, factor,
                                                                            previous, rows);
    }
    ContractTensor<kDegree>(grid, point, lights[s], shape, previous, rows);
    AddEnds<kRow>(grid.suns, rows);
    const TensorStokes<float> stokes = TensorStokesAlong<float>(point.mu, point.sine);
    float* light = arriving;
    for (std::size_t sun = 0; sun < grid.suns; ++sun) {
      FindTaps<kPairs>(grid, direction, point, sun, taps);
      for (std::size_t k = 0; k < direction.azimuths; ++k, light += 3 * 8) {
        const std::size_t cell = static_cast<std::size_t>(static_cast<int>(taps.cell[k]));
        const SunRows at{rows + cell * kRow * 8, V(taps.weight[0][k]), V(taps.weight[1][k]),
                         V(taps.weight[2][k]), V(taps.weight[3][k])};
        AddTensorLight<kPairs>(point, stokes, taps, k, at, light);
        if (pairs == 0) continue;
        Eight sum = LoadEight(light);
        for (std::size_t p = 0; p < pairs; ++p)
          Add(sum, Pair(taps.cosine[2 * p][k], taps.cosine[2 * p + 1][k]),
              BetweenSuns<kRow>(at, p));
        StoreEight(light, sum);
      }
    }
  }
}

// Calls run with the degree as a constant.
template <typename Run>
void OfDegree(std::size_t degree, const Run& run) {
  switch (degree) {
    case 2:
      return run(std::integral_constant<std::size_t, 2>{});
    case 3:
      return run(std::integral_constant<std::size_t, 3>{});
    case 4:
      return run(std::integral_constant<std::size_t, 4>{});
    case 5:
      return run(std::integral_constant<std::size_t, 5>{});
    case 6:
      return run(std::integral_constant<std::size_t, 6>{});
    case 8:
      return run(std::integral_constant<std::size_t, 8>{});
    default:
      return run(std::integral_constant<std::size_t, kLargestDegree>{});
  }
}

void Arrive(const DiffuseGrid& grid, const MarchDirection& direction, const MarchPoint* points,
            const MarchLight* lights, std::size_t count, const BlockShape& shape,
            const float* previous, float* rows, float* arriving) {
  OfDegree(grid.degree, [&](auto degree) {
    ArriveOfDegree<degree()>(grid, direction, points, lights, count, shape, previous, rows,
                             arriving);
  });
}

void ArrivePolarised(const DiffuseGrid& grid, const MarchDirection& direction,
                     const MarchPoint* points, const MarchLight* lights, std::size_t count,
                     const BlockShape& shape, const float* previous, float* rows, float* arriving) {
  OfDegree(grid.degree, [&](auto degree) {
    ArrivePolarisedOfDegree<degree()>(grid, direction, points, lights, count, shape, previous, rows,
                                      arriving);
  });
}

// By the gentle stretch of ray_map.glsl: all pieces have as many nodes.
void Place(const LitPieces& pieces, const LitPoints& points) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  using T = typename Lanes::Type;
  const T h0(pieces.altitude_km), mu0(pieces.mu), radius(pieces.radius_km), zero(0.0F), one(1.0F),
      gentle(1.0F);
  for (std::size_t i = 0; i < pieces.count; i += Lanes::kLanes) {
    const T begin = Lanes::Load(pieces.begin + i), end = Lanes::Load(pieces.end + i);
    const T nu = Lanes::Load(pieces.nu + i), mu_s0 = Lanes::Load(pieces.mu_s + i);
    const T length = end - begin;
    const T z_begin = AltitudeAlongRay<T>(h0, mu0, begin, radius);
    const T z_end = AltitudeAlongRay<T>(h0, mu0, end, radius);
    const auto up = z_end >= z_begin;
    const T low = max(min(z_begin, z_end), zero);
    const T at = select(up, begin, end);
    const T cosine = abs(ZenithCosineAlongRay<T>(h0, mu0, at, low, radius));
    const T b = PanelStretch<T>(low, cosine, length, T(pieces.extinction), gentle, radius);
    const auto straight = b < T(0.25F);
    const T stretch = select(straight, one, b);
    const T scale = StretchedScale<T>(length, T(exp(stretch)));
    for (std::size_t n = 0; n < pieces.nodes; ++n) {
      const T v(pieces.node[n]);
      const T growth = exp(stretch * v);
      const T t = select(straight, T(length * v), StretchedDistance<T>(scale, growth));
      const T slope = select(straight, length, StretchedSlope<T>(scale, stretch, growth));
      const T d = select(up, T(begin + t), T(end - t));
      const T h = max(AltitudeAlongRay<T>(h0, mu0, d, radius), zero);
      const T mu = ZenithCosineAlongRay<T>(h0, mu0, d, h, radius);
      const std::size_t out = n * pieces.count + i;
      Lanes::Store(points.weight + out, T(pieces.gauss[n]) * slope);
      Lanes::Store(points.altitude + out, h);
      Lanes::Store(points.mu + out, mu);
      Lanes::Store(points.absolute_mu + out, T(abs(mu)));
      Lanes::Store(points.mu_s + out, SunCosineAlongRay<T>(h0, mu_s0, nu, d, h, radius));
    }
  }
}

void Scatter(const LitPieces& pieces, const LitPoints& points, const ColumnPointers& up,
             const ColumnPointers& sun, const std::array<float, 6>& origin_and_perigee,
             const std::array<float, 3>& extinction, const LayerHeights& layers, float* rayleigh,
             float* mie) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  using T = typename Lanes::Type;
  const T mu0(pieces.mu);
  const T origin_rayleigh(origin_and_perigee[0]), origin_mie(origin_and_perigee[1]),
      origin_ozone(origin_and_perigee[2]), low_rayleigh(origin_and_perigee[3]),
      low_mie(origin_and_perigee[4]), low_ozone(origin_and_perigee[5]);
  for (std::size_t i = 0; i < pieces.count; i += Lanes::kLanes) {
    T rayleigh_sum(0.0F), mie_sum(0.0F);
    for (std::size_t n = 0; n < pieces.nodes; ++n) {
      const std::size_t at = n * pieces.count + i;
      const T mu = Lanes::Load(points.mu + at), h = Lanes::Load(points.altitude + at);
      const T depth =
          T(extinction[0]) * (ColumnBetween<T>(mu0, mu, origin_rayleigh,
                                               Lanes::Load(up.rayleigh + at), low_rayleigh) +
                              Lanes::Load(sun.rayleigh + at)) +
          T(extinction[1]) *
              (ColumnBetween<T>(mu0, mu, origin_mie, Lanes::Load(up.mie + at), low_mie) +
               Lanes::Load(sun.mie + at)) +
          T(extinction[2]) *
              (ColumnBetween<T>(mu0, mu, origin_ozone, Lanes::Load(up.ozone + at), low_ozone) +
               Lanes::Load(sun.ozone + at));
      const T light = Lanes::Load(points.weight + at) * exp(-depth);
      rayleigh_sum +=
          light * MoleculeDensity<T>(h, layers.rayleigh, layers.deficit, layers.deficit_height);
      mie_sum += light * exp(-h / T(layers.mie));
    }
    Lanes::Store(rayleigh + i, rayleigh_sum);
    Lanes::Store(mie + i, mie_sum);
  }
}

/// A few samples of a ray, ready for the table: [.][sample].
constexpr std::size_t kChunk = BatchOf<float>::kLanes;
struct Chunk {
  alignas(64) float altitude_cell[kChunk], sun_cell[kChunk];
  alignas(64) float altitude_weight[4][kChunk], sun_weight[4][kChunk];
  alignas(64) float harmonic[kLargestMoments][kChunk];
};

// Weights at the ends of an axis, where the node beyond continues the line through the last two.
template <typename T>
Weights<T> Folded(const Weights<T>& w, const T& cell, const T& last) {
  using namespace shared;
  const auto first = cell < T(0.5F);
  const auto end = cell > last - T(0.5F);
  Weights<T> out = w;
  out.w1 = select(first, T(out.w1 + T(2.0F) * w.w0), out.w1);
  out.w2 = select(first, T(out.w2 - w.w0), out.w2);
  out.w0 = select(first, T(0.0F), out.w0);
  out.w1 = select(end, T(out.w1 - w.w3), out.w1);
  out.w2 = select(end, T(out.w2 + T(2.0F) * w.w3), out.w2);
  out.w3 = select(end, T(0.0F), out.w3);
  return out;
}

template <typename T>
void StoreTaps(const T& position, std::size_t nodes, const T& factor, float* cell,
               float (*weight)[kChunk]) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  const T last(static_cast<float>(nodes - 2));
  const T at = min(max(position, T(0.0F)), T(static_cast<float>(nodes - 1)));
#if defined(ALPENGLOW_SIMD) && !defined(XSIMD_NO_SUPPORTED_ARCHITECTURE)
  const T below = min(xsimd::floor(at), last);
#else
  const T below = min(std::floor(at), last);
#endif
  const Weights<T> w = Folded<T>(Cubic<T>(at - below), below, last);
  Lanes::Store(cell, below);
  Lanes::Store(weight[0], w.w0 * factor);
  Lanes::Store(weight[1], w.w1 * factor);
  Lanes::Store(weight[2], w.w2 * factor);
  Lanes::Store(weight[3], w.w3 * factor);
}

constexpr double Root(double square) {
  double root = square < 1.0 ? 1.0 : square;
  for (double next = 0.5 * (root + square / root); next < root; next = 0.5 * (root + square / root))
    root = next;
  return root;
}

struct Norms {
  float of[kLargestMoments];
};

// norm_lm of the real harmonics, l major (spherical_harmonics.h).
constexpr Norms FindNorms() {
  Norms norms{};
  for (std::size_t l = 0, i = 0; l <= kLargestDegree; ++l) {
    for (std::size_t m = 0; m <= l; ++m, ++i) {
      double square = (m == 0 ? 1.0 : 2.0) * static_cast<double>(2 * l + 1) / (4.0 * kPi);
      for (std::size_t k = l - m + 1; k <= l + m; ++k) square /= static_cast<double>(k);
      norms.of[i] = static_cast<float>(Root(square));
    }
  }
  return norms;
}
constexpr Norms kNorm = FindNorms();

template <std::size_t kDegree, typename T, typename Visit>
void VisitHarmonics(const T& mu, const T& sine, const T& cosine, const Visit& visit) {
  T diagonal(1.0F), cos_before = cosine, cos_now(1.0F);  // cos((m - 1) phi), cos(m phi)
  for (std::size_t m = 0; m <= kDegree; ++m) {
    T lower(0.0F), value = diagonal;
    for (std::size_t l = m; l <= kDegree; ++l) {
      const std::size_t i = l * (l + 1) / 2 + m;
      visit(i, T(T(kNorm.of[i]) * value * cos_now));
      const T next =
          (T(static_cast<float>(2 * l + 1)) * mu * value - T(static_cast<float>(l + m)) * lower) *
          T(1.0F / static_cast<float>(l + 1 - m));
      lower = value;
      value = next;
    }
    diagonal = diagonal * T(static_cast<float>(2 * m + 1)) * sine;
    const T cos_next = T(2.0F) * cosine * cos_now - cos_before;
    cos_before = cos_now;
    cos_now = cos_next;
  }
}

template <std::size_t kDegree>
void Prepare(const DiffuseGrid& grid, const RaySamples<float>& samples, std::size_t first, float nu,
             Chunk& chunk) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  using T = typename Lanes::Type;
  const T one(1.0F);
  const T mu = Lanes::Load(&samples.mu[first]), mu_s = Lanes::Load(&samples.mu_s[first]);
  const T sine = sqrt(max((one - mu) * (one + mu), T(0.0F)));
  VisitHarmonics<kDegree, T>(
      mu, sine, CosineOfAzimuth<T>(mu, sine, mu_s, T(nu)),
      [&](std::size_t i, const T& y) { Lanes::Store(chunk.harmonic[i], y); });
  if (grid.polarised) {
    const T squared = max((one - mu_s) * (one + mu_s), T(0.0F));
    const T sun_sine = sqrt(squared);
    for (std::size_t l = 1; l <= kDegree; ++l) {
      float(*row)[kChunk] = chunk.harmonic + l * (l + 1) / 2;
      Lanes::Store(row[1], sun_sine * Lanes::Load(row[1]));
      for (std::size_t m = 2; m <= l; ++m) Lanes::Store(row[m], squared * Lanes::Load(row[m]));
    }
  }
  const T u = sqrt(max(Lanes::Load(&samples.altitude[first]), T(0.0F)) * T(1.0F / grid.top_km));
  StoreTaps<T>(u * T(static_cast<float>(grid.altitudes - 1)), grid.altitudes, one,
               chunk.altitude_cell, chunk.altitude_weight);
  StoreTaps<T>(SunPosition<T>(grid, mu_s), grid.suns, Twilight<T>(grid, mu_s), chunk.sun_cell,
               chunk.sun_weight);
}

// Some vectors of a node, summed over 16 nodes: the first kRows of those that are wanted and, after
// them, the ones from kFrom on. Spelled out, so that the sums stay in registers.
template <std::size_t kRows, std::size_t kFrom, std::size_t kFirst, std::size_t... kIndex>
void SumTapsAt(const float* const* node, const float* weight, float* moments,
               std::index_sequence<kIndex...>) {
  const auto place = [](std::size_t i) { return (i < kRows ? i : kFrom + i - kRows) * 8; };
  Eight sum[sizeof...(kIndex)] = {(static_cast<void>(kIndex), Zero())...};
  for (std::size_t tap = 0; tap < 16; ++tap) {
    const V w(weight[tap]);
    const float* at = node[tap];
    (Add(sum[kIndex], w, LoadEight(at + place(kFirst + kIndex))), ...);
  }
  (StoreEight(moments + (kFirst + kIndex) * 8, sum[kIndex]), ...);
}

// All kCount of them, as many at a time as there are registers for.
template <std::size_t kRows, std::size_t kFrom, std::size_t kCount, std::size_t kFirst = 0>
void SumTaps(const float* const* node, const float* weight, float* moments) {
  constexpr std::size_t kMost = 18;
  constexpr std::size_t kHere = kCount - kFirst < kMost ? kCount - kFirst : kMost;
  SumTapsAt<kRows, kFrom, kFirst>(node, weight, moments, std::make_index_sequence<kHere>{});
  if constexpr (kFirst + kHere < kCount)
    SumTaps<kRows, kFrom, kCount, kFirst + kHere>(node, weight, moments);
}

// What a degree of the moments sends along the ray at a sample, before phase functions.
Eight LightOfDegree(const Chunk& chunk, std::size_t s, std::size_t l, const float* moments) {
  Eight light = Zero();
  for (std::size_t p = 0; p <= l / 2; ++p) {
    const std::size_t m = l * (l + 1) / 2 + 2 * p;
    Add(light, Pair(chunk.harmonic[m][s], 2 * p < l ? chunk.harmonic[m + 1][s] : 0.0F),
        LoadEight(moments + (kPackedRow[l] + p) * 8));
  }
  return light;
}

// What molecules send of polarised light; `tensor` is two vectors (PackedVectors).
Eight LightOfTensor(const Chunk& chunk, std::size_t s, const float* tensor,
                    const Eight& rayleigh_chi2) {
  const Eight second = LoadEight(tensor + 8);
  Eight degree2 = Zero(), light = Zero();
  Add(degree2, Pair(chunk.harmonic[3][s], chunk.harmonic[4][s]), LoadEight(tensor));
  Add(degree2, Pair(chunk.harmonic[5][s], 0.0F), second);
  Add(light, rayleigh_chi2, degree2);
  Add(light, Pair(0.0F, chunk.harmonic[0][s]), second);
  return light;
}

/// What molecules and aerosol scatter of the moments at a sample, per unit coefficient.
struct Scattered {
  Eight rayleigh, mie;
};

// Of the moments of rows 0 to kLast. All that a node holds of them is read in one pass.
template <std::size_t kDegree, std::size_t kLast, std::size_t kStep, bool kPolarised>
Scattered ScatteredByRows(const Chunk& chunk, std::size_t s, const float* const* node,
                          const float* weight, const Eight* chi, const Eight& rayleigh_chi2) {
  constexpr std::size_t kRows = kPackedRow[kLast + 1];
  constexpr std::size_t kMore =
      kPolarised ? PackedVectors(kDegree, true) - kPackedRow[kDegree + 1] : 0;
  alignas(64) float moments[(kRows + kMore) * 8];
  SumTaps<kRows, kPackedRow[kDegree + 1], kRows + kMore>(node, weight, moments);
  Scattered light{Zero(), Zero()};
  for (std::size_t l = 0; l <= kLast; l += kStep) {
    const Eight of_degree = LightOfDegree(chunk, s, l, moments);
    if (!kPolarised && l == 0) Add(light.rayleigh, V(1.0F), of_degree);
    if (!kPolarised && l == 2) Add(light.rayleigh, rayleigh_chi2, of_degree);
    Add(light.mie, chi[l], of_degree);
  }
  if (kPolarised) light.rayleigh = LightOfTensor(chunk, s, moments + kRows * 8, rayleigh_chi2);
  return light;
}

// Where molecules alone scatter.
template <std::size_t kDegree, bool kPolarised>
Scattered ScatteredByMolecules(const Chunk& chunk, std::size_t s, const float* const* node,
                               const float* weight, const Eight* chi, const Eight& rayleigh_chi2) {
  if constexpr (kPolarised) {
    alignas(64) float tensor[2 * 8];
    SumTaps<0, kPackedRow[kDegree + 1], 2>(node, weight, tensor);
    return {LightOfTensor(chunk, s, tensor, rayleigh_chi2), Zero()};
  } else {
    return ScatteredByRows<kDegree, 2, 2, false>(chunk, s, node, weight, chi, rayleigh_chi2);
  }
}

/// Legendre coefficients of a block, for both halves of eight lanes.
template <std::size_t kDegree>
struct EightChi {
  Eight mie[kDegree + 1];
  Eight rayleigh2;
};

template <std::size_t kDegree, bool kPolarised>
void AddSample(const DiffuseGrid& grid, const Chunk& chunk, std::size_t s,
               const RaySamples<float>& samples, std::size_t sample, const DiffuseBlock& block,
               const EightChi<kDegree>& chi, const float* moments, float* light) {
  constexpr std::size_t kNode = PackedVectors(kDegree, kPolarised) * 8;
  // Shares of what molecules scatter below which aerosol needs no more moments than they do, or
  // only those to degree 3.
  constexpr float kNoAerosol = 3e-4F, kCoarseAerosol = 1e-3F;
  constexpr std::size_t kCoarseDegree = kDegree < 3 ? kDegree : 3;
  const auto first_altitude = static_cast<int>(chunk.altitude_cell[s]) - 1;
  const auto first_sun = static_cast<int>(chunk.sun_cell[s]) - 1;
  const auto last_altitude = static_cast<int>(grid.altitudes) - 1;
  const auto last_sun = static_cast<int>(grid.suns) - 1;
  const auto within = [](int node, int last) {
    return static_cast<std::size_t>(node < 0 ? 0 : node > last ? last : node);
  };
  const std::size_t column[4] = {
      within(first_sun, last_sun) * kNode, within(first_sun + 1, last_sun) * kNode,
      within(first_sun + 2, last_sun) * kNode, within(first_sun + 3, last_sun) * kNode};
  const float* node[16];
  float weight[16];
  for (int a = 0; a < 4; ++a) {
    const float* row = moments + within(first_altitude + a, last_altitude) * grid.suns * kNode;
    for (int b = 0; b < 4; ++b) {
      node[a * 4 + b] = row + column[b];
      weight[a * 4 + b] = chunk.altitude_weight[a][s] * chunk.sun_weight[b][s];
    }
  }
  float rayleigh_share[kBlockBands], mie_share[kBlockBands];
  bool aerosol = false, fine = false;
  for (std::size_t band = 0; band < kBlockBands; ++band) {
    rayleigh_share[band] = block.rayleigh[band] * samples.rayleigh_density[sample];
    mie_share[band] = block.mie_scattering[band] * samples.mie_density[sample];
    aerosol = aerosol || mie_share[band] > kNoAerosol * rayleigh_share[band];
    fine = fine || mie_share[band] > kCoarseAerosol * rayleigh_share[band];
  }
  const Scattered scattered = fine ? ScatteredByRows<kDegree, kDegree, 1, kPolarised>(
                                         chunk, s, node, weight, chi.mie, chi.rayleigh2)
                              : aerosol ? ScatteredByRows<kDegree, kCoarseDegree, 1, kPolarised>(
                                              chunk, s, node, weight, chi.mie, chi.rayleigh2)
                                        : ScatteredByMolecules<kDegree, kPolarised>(
                                              chunk, s, node, weight, chi.mie, chi.rayleigh2);
  alignas(64) float of_rayleigh[8], of_mie[8];
  StoreEight(of_rayleigh, scattered.rayleigh);
  StoreEight(of_mie, scattered.mie);
  for (std::size_t band = 0; band < kBlockBands; ++band) {
    const float r = of_rayleigh[band] + of_rayleigh[band + 4];
    const float m = of_mie[band] + of_mie[band + 4];
    light[band] +=
        rayleigh_share[band] * (r > 0.0F ? r : 0.0F) + mie_share[band] * (m > 0.0F ? m : 0.0F);
  }
}

Eight Twice(const std::array<float, kBlockBands>& bands) {
  alignas(64) float twice[8];
  for (std::size_t band = 0; band < 8; ++band) twice[band] = bands[band % 4];
  return LoadEight(twice);
}

template <std::size_t kDegree, bool kPolarised>
void InscatterOfDegree(const DiffuseGrid& grid, const RaySamples<float>& samples, float nu,
                       const DiffuseBlock* blocks, std::size_t count, const float* moments,
                       float* light) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  using T = typename Lanes::Type;
  const std::size_t block_stride =
      grid.altitudes * grid.suns * PackedVectors(kDegree, kPolarised) * 8;
  Chunk chunk;
  for (std::size_t first = 0; first < samples.padded; first += kChunk) {
    Prepare<kDegree>(grid, samples, first, nu, chunk);
    const std::size_t size = samples.count - first < kChunk ? samples.count - first : kChunk;
    for (std::size_t b = 0; b < count; ++b) {
      EightChi<kDegree> chi;
      for (std::size_t l = 0; l <= kDegree; ++l) chi.mie[l] = Twice(blocks[b].chi[l]);
      chi.rayleigh2 = Twice(blocks[b].rayleigh_chi2);
      alignas(64) float attenuation[kBlockBands][kChunk];
      for (std::size_t band = 0; band < kBlockBands; ++band) {
        const Extinction<T> extinction{T(blocks[b].rayleigh[band]),
                                       T(blocks[b].mie_extinction[band]), T(blocks[b].ozone[band])};
        const ColumnSet<T> columns{Lanes::Load(&samples.view_rayleigh[first]),
                                   Lanes::Load(&samples.view_mie[first]),
                                   Lanes::Load(&samples.view_ozone[first])};
        const T depth = OpticalDepthOf(extinction, columns);
        Lanes::Store(attenuation[band], Lanes::Load(&samples.weight[first]) * exp(-depth));
      }
      for (std::size_t s = 0; s < size; ++s) {
        if (samples.weight[first + s] == 0.0F) continue;  // a place, not a node
        float source[kBlockBands] = {0.0F, 0.0F, 0.0F, 0.0F};
        AddSample<kDegree, kPolarised>(grid, chunk, s, samples, first + s, blocks[b], chi,
                                       moments + b * block_stride, source);
        for (std::size_t band = 0; band < kBlockBands; ++band)
          light[b * kBlockBands + band] += attenuation[band][s] * source[band];
      }
    }
  }
}

void Inscatter(const DiffuseGrid& grid, const RaySamples<float>& samples, float nu,
               const DiffuseBlock* blocks, std::size_t count, const float* moments, float* light) {
  OfDegree(grid.degree, [&](auto degree) {
    if (grid.polarised) {
      InscatterOfDegree<degree(), true>(grid, samples, nu, blocks, count, moments, light);
    } else {
      InscatterOfDegree<degree(), false>(grid, samples, nu, blocks, count, moments, light);
    }
  });
}

// The clamped cosine's zonal coefficients: pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, pi / 64 ...
constexpr float kClampedCosine[kLargestDegree + 1] = {
    3.14159265F,    2.09439510F, 0.785398163F,  0.0F, -0.130899694F,  0.0F, 0.0490873852F, 0.0F,
    -0.0245436926F, 0.0F,        0.0143171540F, 0.0F, -0.00920388473F};

// P_l(x), the first even l that moments to this degree lack.
template <std::size_t kDegree>
float FirstMissingLegendre(float x) {
  constexpr std::size_t kEven = kDegree / 2 * 2 + 2;
  float before = 1.0F, now = x;
  for (std::size_t l = 1; l < kEven; ++l) {
    const float next = (static_cast<float>(2 * l + 1) * x * now - static_cast<float>(l) * before) *
                       (1.0F / static_cast<float>(l + 1));
    before = now;
    now = next;
  }
  return now;
}

// Moments of a point summed over its nodes, times the factors of a surface.
template <std::size_t kDegree>
Eight SumOverNodes(const SurfacePoint& point, std::size_t node_floats, const float* moments,
                   const Eight* factor) {
  Eight light = Zero();
  for (std::size_t l = 0; l <= kDegree; ++l) {
    if (l > 1 && l % 2 == 1) continue;  // the clamped cosine has none of these
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const std::size_t i = kPackedRow[l] + p;
      Eight moment = Zero();
      for (std::size_t tap = 0; tap < 16; ++tap)
        Add(moment, V(point.weight[tap]),
            LoadEight(moments + point.node[tap] * node_floats + i * 8));
      Add(light, factor[i], moment);
    }
  }
  return light;
}

// The clamped cosine has no odd terms beyond l = 1, so what the series misses on a surface that
// looks up (where the truth is known: `sky`) it misses on one that looks down. Between them it is
// taken to follow the first even Legendre polynomial that is missing.
template <std::size_t kDegree>
void IrradianceOfDegree(const DiffuseGrid& grid, const SurfacePoint& point, std::size_t count,
                        const float* moments, const float* sky, float* irradiance) {
  const float mu = point.normal_mu;
  const float missing = FirstMissingLegendre<kDegree>(mu);
  const float sine2 = (1.0F - mu) * (1.0F + mu);
  float of_moment[kLargestMoments];
  VisitHarmonics<kDegree, float>(mu, std::sqrt(sine2 > 0.0F ? sine2 : 0.0F), point.normal_azimuth,
                                 [&](std::size_t i, float y) { of_moment[i] = y; });
  Eight factor[kPackedRow[kDegree + 1]];
  for (std::size_t l = 0; l <= kDegree; ++l) {
    const std::size_t first = l * (l + 1) / 2;
    of_moment[first] -= missing * kNorm.of[first];  // the harmonic of the vertical
    if (grid.polarised) {
      for (std::size_t m = 1; m <= l; ++m) of_moment[first + m] *= SinePower(m, point.sun_sine);
    }
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const float even = kClampedCosine[l] * of_moment[first + 2 * p];
      const float odd = 2 * p < l ? kClampedCosine[l] * of_moment[first + 2 * p + 1] : 0.0F;
      factor[kPackedRow[l] + p] = Pair(even, odd);
    }
  }
  const std::size_t nodes = grid.altitudes * grid.suns;
  const std::size_t node_floats = PackedVectors(kDegree, grid.polarised) * 8;
  for (std::size_t block = 0; block < count; ++block) {
    alignas(64) float light[8];
    StoreEight(light, SumOverNodes<kDegree>(point, node_floats,
                                            moments + block * nodes * node_floats, factor));
    for (std::size_t band = 0; band < kBlockBands; ++band) {
      float from_sky = 0.0F;
      for (std::size_t tap = 0; tap < 16; ++tap) {
        from_sky += point.weight[tap] * sky[(block * nodes + point.node[tap]) * kBlockBands + band];
      }
      const float sum = light[band] + light[band + 4] + missing * from_sky;
      irradiance[block * kBlockBands + band] = sum > 0.0F ? sum : 0.0F;
    }
  }
}

void Irradiance(const DiffuseGrid& grid, const SurfacePoint& point, std::size_t count,
                const float* moments, const float* sky, float* irradiance) {
  OfDegree(grid.degree, [&](auto degree) {
    IrradianceOfDegree<degree()>(grid, point, count, moments, sky, irradiance);
  });
}

}  // namespace

template <>
const DiffuseKernel& KernelOf<DiffuseKernel, kThisSet>() {
  static constexpr DiffuseKernel kernel{Arrive,  ArrivePolarised, Place,
                                        Scatter, Inscatter,       Irradiance};
  return kernel;
}

}  // namespace alpenglow
