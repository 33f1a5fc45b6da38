// SPDX-License-Identifier: MIT
#include "lut/diffuse/diffuse_kernel.h"

#include <type_traits>
#include <utility>

#include "atmosphere/ray/batch.h"
#include "atmosphere/ray/optical_depth.h"

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
// (1 + sun). A node beyond each end continues the line through the last two, so that every tap has
// four neighbours.
template <std::size_t kDegree, std::size_t kStep, std::size_t kLast>
void ContractRows(const DiffuseGrid& grid, const MarchPoint& point, const Eight* factor,
                  const float* previous, float* rows) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  constexpr std::size_t kNode = kPackedRow[kDegree + 1];
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
          Add(sum[p], factor[tap * kNode + i], LoadEight(at + i * 8));
        }
      }
    }
    for (std::size_t p = 0; p < kPairs; ++p)
      StoreEight(rows + ((sun + 1) * kPairs + p) * 8, sum[p]);
  }
}

template <std::size_t kDegree>
void Contract(const DiffuseGrid& grid, const MarchPoint& point, const MarchLight& light,
              const BlockChi& chi, const float* previous, float* rows) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  constexpr std::size_t kNode = kPackedRow[kDegree + 1];
  Eight factor[4 * kNode];
  for (std::size_t l = 0; l <= kDegree; ++l) {
    alignas(64) float source[8];
    const float rayleigh_chi = l == 0 ? 1.0F : l == 2 ? 0.1F : 0.0F;
    for (std::size_t band = 0; band < 8; ++band)
      source[band] =
          light.rayleigh[band % 4] * rayleigh_chi + light.mie[band % 4] * chi[l][band % 4];
    const Eight of_row = LoadEight(source);
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const std::size_t m = l * (l + 1) / 2 + 2 * p;
      Eight legendre = Pair(point.legendre[m], 2 * p < l ? point.legendre[m + 1] : 0.0F);
      for (std::size_t i = 0; i < kParts; ++i) legendre.part[i] *= of_row.part[i];
      for (std::size_t tap = 0; tap < 4; ++tap) {
        Eight& weighted = factor[tap * kNode + kPackedRow[l] + p];
        weighted = Zero();
        Add(weighted, V(point.altitude_weight[tap]), legendre);
      }
    }
  }
  if (point.only_molecules) {
    ContractRows<kDegree, 2, 2>(grid, point, factor, previous, rows);
  } else {
    ContractRows<kDegree, 1, kDegree>(grid, point, factor, previous, rows);
  }
  for (std::size_t i = 0; i < kPairs * 8; ++i) {
    rows[i] = 2.0F * rows[kPairs * 8 + i] - rows[2 * kPairs * 8 + i];
    const float* last = rows + grid.suns * kPairs * 8 + i;
    rows[(grid.suns + 1) * kPairs * 8 + i] =
        2.0F * last[0] - last[-static_cast<std::ptrdiff_t>(kPairs * 8)];
  }
}

/// Where the suns of all azimuths stand at a march point: neighbours and local azimuths.
template <std::size_t kPairs>
struct AzimuthTaps {
  alignas(64) float cell[kMostAzimuths];
  alignas(64) float weight[4][kMostAzimuths];
  alignas(64) float cosine[2 * kPairs][kMostAzimuths];  // of m phi
};

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
  }
}

template <std::size_t kDegree>
void ArriveOfDegree(const DiffuseGrid& grid, const MarchDirection& direction,
                    const MarchPoint* points, const MarchLight* lights, std::size_t count,
                    const BlockChi& chi, const float* previous, float* rows, float* arriving) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  AzimuthTaps<kPairs> taps;
  for (std::size_t s = 0; s < count; ++s) {
    Contract<kDegree>(grid, points[s], lights[s], chi, previous, rows);
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
    default:
      return run(std::integral_constant<std::size_t, 6>{});
  }
}

void Arrive(const DiffuseGrid& grid, const MarchDirection& direction, const MarchPoint* points,
            const MarchLight* lights, std::size_t count, const BlockChi& chi, const float* previous,
            float* rows, float* arriving) {
  OfDegree(grid.degree, [&](auto degree) {
    ArriveOfDegree<degree()>(grid, direction, points, lights, count, chi, previous, rows, arriving);
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
  alignas(64) float harmonic[28][kChunk];
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

// norm_lm of the real harmonics, l major (spherical_harmonics.h).
constexpr float kNorm[28] = {
    0.282094792F,   0.488602512F,   0.488602512F,    0.630783131F,   0.36418281F,  0.182091405F,
    0.746352665F,   0.3046972F,     0.0963537148F,   0.0393362393F,  0.846284375F, 0.267618617F,
    0.0630783131F,  0.0168583883F,  0.00596034034F,  0.93560258F,    0.241571547F, 0.0456527313F,
    0.00931882475F, 0.00219646806F, 0.000694584187F, 1.01710724F,    0.221950995F, 0.0350935337F,
    0.00584892228F, 0.00106786222F, 0.000227668991F, 6.57223766e-05F};

template <std::size_t kDegree, typename T, typename Visit>
void VisitHarmonics(const T& mu, const T& sine, const T& cosine, const Visit& visit) {
  T diagonal(1.0F), cos_before = cosine, cos_now(1.0F);  // cos((m - 1) phi), cos(m phi)
  for (std::size_t m = 0; m <= kDegree; ++m) {
    T lower(0.0F), value = diagonal;
    for (std::size_t l = m; l <= kDegree; ++l) {
      const std::size_t i = l * (l + 1) / 2 + m;
      visit(i, T(T(kNorm[i]) * value * cos_now));
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
  const T u = sqrt(max(Lanes::Load(&samples.altitude[first]), T(0.0F)) * T(1.0F / grid.top_km));
  StoreTaps<T>(u * T(static_cast<float>(grid.altitudes - 1)), grid.altitudes, one,
               chunk.altitude_cell, chunk.altitude_weight);
  StoreTaps<T>(SunPosition<T>(grid, mu_s), grid.suns, Twilight<T>(grid, mu_s), chunk.sun_cell,
               chunk.sun_weight);
}

// Moments from vector kBegin on, summed over 16 nodes:
// spelled out, so that the sums stay in registers.
template <std::size_t... kIndex>
void SumTaps(const float* const* node, const float* weight, float* moments,
             std::index_sequence<kIndex...>) {
  Eight sum[sizeof...(kIndex)] = {(static_cast<void>(kIndex), Zero())...};
  for (std::size_t tap = 0; tap < 16; ++tap) {
    const V w(weight[tap]);
    const float* at = node[tap];
    (Add(sum[kIndex], w, LoadEight(at + kIndex * 8)), ...);
  }
  (StoreEight(moments + kIndex * 8, sum[kIndex]), ...);
}

// Adds light that moments of rows 0 to kLast scatter at a sample.
template <std::size_t kLast, std::size_t kStep>
void AddRows(const Chunk& chunk, std::size_t s, const float* const* node, const float* weight,
             const Eight* chi, Eight& rayleigh, Eight& mie) {
  constexpr std::size_t kCount = kPackedRow[kLast + 1];
  alignas(64) float moments[kCount * 8];
  SumTaps(node, weight, moments, std::make_index_sequence<kCount>{});
  for (std::size_t l = 0; l <= kLast; l += kStep) {
    Eight light = Zero();
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const std::size_t m = l * (l + 1) / 2 + 2 * p;
      Add(light, Pair(chunk.harmonic[m][s], 2 * p < l ? chunk.harmonic[m + 1][s] : 0.0F),
          LoadEight(moments + (kPackedRow[l] + p) * 8));
    }
    if (l == 0) Add(rayleigh, V(1.0F), light);
    if (l == 2) Add(rayleigh, V(0.1F), light);
    Add(mie, chi[l], light);
  }
}

template <std::size_t kDegree>
void AddSample(const DiffuseGrid& grid, const Chunk& chunk, std::size_t s,
               const RaySamples<float>& samples, std::size_t sample, const DiffuseBlock& block,
               const Eight* chi, const float* moments, float* light) {
  constexpr std::size_t kNode = kPackedRow[kDegree + 1] * 8;
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
  Eight rayleigh = Zero(), mie = Zero();
  if (fine) {
    AddRows<kDegree, 1>(chunk, s, node, weight, chi, rayleigh, mie);
  } else if (aerosol) {
    AddRows<kCoarseDegree, 1>(chunk, s, node, weight, chi, rayleigh, mie);
  } else {
    AddRows<2, 2>(chunk, s, node, weight, chi, rayleigh, mie);
  }
  alignas(64) float of_rayleigh[8], of_mie[8];
  StoreEight(of_rayleigh, rayleigh);
  StoreEight(of_mie, mie);
  for (std::size_t band = 0; band < kBlockBands; ++band) {
    const float r = of_rayleigh[band] + of_rayleigh[band + 4];
    const float m = of_mie[band] + of_mie[band + 4];
    light[band] +=
        rayleigh_share[band] * (r > 0.0F ? r : 0.0F) + mie_share[band] * (m > 0.0F ? m : 0.0F);
  }
}

template <std::size_t kDegree>
void InscatterOfDegree(const DiffuseGrid& grid, const RaySamples<float>& samples, float nu,
                       const DiffuseBlock* blocks, std::size_t count, const float* moments,
                       float* light) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  using T = typename Lanes::Type;
  const std::size_t block_stride = grid.altitudes * grid.suns * kPackedRow[kDegree + 1] * 8;
  Chunk chunk;
  for (std::size_t first = 0; first < samples.padded; first += kChunk) {
    Prepare<kDegree>(grid, samples, first, nu, chunk);
    const std::size_t size = samples.count - first < kChunk ? samples.count - first : kChunk;
    for (std::size_t b = 0; b < count; ++b) {
      Eight chi[kDegree + 1];
      for (std::size_t l = 0; l <= kDegree; ++l) {
        alignas(64) float twice[8];
        for (std::size_t band = 0; band < 8; ++band) twice[band] = blocks[b].chi[l][band % 4];
        chi[l] = LoadEight(twice);
      }
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
        AddSample<kDegree>(grid, chunk, s, samples, first + s, blocks[b], chi,
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
    InscatterOfDegree<degree()>(grid, samples, nu, blocks, count, moments, light);
  });
}

// pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, pi / 64: the clamped cosine's zonal coefficients.
constexpr float kClampedCosine[kLargestDegree + 1] = {
    3.14159265F, 2.09439510F, 0.785398163F, 0.0F, -0.130899694F, 0.0F, 0.0490873852F};

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
Eight SumOverNodes(const SurfacePoint& point, const float* moments, const Eight* factor) {
  constexpr std::size_t kNode = kPackedRow[kDegree + 1] * 8;
  Eight light = Zero();
  for (std::size_t l = 0; l <= kDegree; ++l) {
    if (l > 1 && l % 2 == 1) continue;  // the clamped cosine has none of these
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const std::size_t i = kPackedRow[l] + p;
      Eight moment = Zero();
      for (std::size_t tap = 0; tap < 16; ++tap)
        Add(moment, V(point.weight[tap]), LoadEight(moments + point.node[tap] * kNode + i * 8));
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
  float of_moment[28];
  VisitHarmonics<kDegree, float>(mu, std::sqrt(sine2 > 0.0F ? sine2 : 0.0F), point.normal_azimuth,
                                 [&](std::size_t i, float y) { of_moment[i] = y; });
  Eight factor[kPackedRow[kDegree + 1]];
  for (std::size_t l = 0; l <= kDegree; ++l) {
    const std::size_t first = l * (l + 1) / 2;
    of_moment[first] -= missing * kNorm[first];  // the harmonic of the vertical
    for (std::size_t p = 0; p <= l / 2; ++p) {
      const float even = kClampedCosine[l] * of_moment[first + 2 * p];
      const float odd = 2 * p < l ? kClampedCosine[l] * of_moment[first + 2 * p + 1] : 0.0F;
      factor[kPackedRow[l] + p] = Pair(even, odd);
    }
  }
  const std::size_t nodes = grid.altitudes * grid.suns;
  for (std::size_t block = 0; block < count; ++block) {
    alignas(64) float light[8];
    StoreEight(light, SumOverNodes<kDegree>(
                          point, moments + block * nodes * kPackedRow[kDegree + 1] * 8, factor));
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
  static constexpr DiffuseKernel kernel{Arrive, Place, Scatter, Inscatter, Irradiance};
  return kernel;
}

}  // namespace alpenglow
