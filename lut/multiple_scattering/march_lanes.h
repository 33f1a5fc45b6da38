// SPDX-License-Identifier: MIT
// This header provides the marches that carry one order's light, and sunlight scattered once, to a
// node. It is a part of moment_kernel.cpp.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/ray/ray.h"
#include "lut/multiple_scattering/moment_lanes.h"
#include "lut/multiple_scattering/polarised_scattering.h"

namespace alpenglow::lut {
namespace {

// Finds the source of a march point per cos(m phi) at every sun node, summed over altitude and
// degree: row (1 + sun) of kRow vectors.
template <std::size_t kDegree, std::size_t kStep, std::size_t kLast, std::size_t kNode,
          std::size_t kRow>
void ContractRows(const MomentGrid& grid, const MarchPoint& point, const Eight* factor,
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

// Finds the factors of moments in the source of a march point: [tap * vectors + vector]. For
// polarised light, scattering by molecules is excluded; the tensor provides it.
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

// Adds a node beyond each end, so that every tap has four neighbours.
template <std::size_t kRow>
void AddEnds(std::size_t suns, float* rows) {
  constexpr std::size_t kStep = kRow * 8;
  for (std::size_t i = 0; i < kStep; ++i) {
    float* at = rows + i;
    at[0] = shared::BeyondEnd<float>(at[kStep], at[2 * kStep], at[3 * kStep]);
    float* end = at + (suns + 1) * kStep;
    const float* last = at + (suns - 2) * kStep;
    end[0] = shared::BeyondEnd<float>(last[2 * kStep], last[kStep], last[0]);
  }
}

// Finds the tensor at every sun node times the molecules' factors: (D/10 T20, D/10 T21) and (D/10
// T22, moment 00 Y00), in the last two vectors of each row.
template <std::size_t kDegree>
void ContractTensor(const MomentGrid& grid, const MarchPoint& point, const MarchLight& light,
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

/// Positions of the suns of all azimuths at a march point: neighbouring nodes and local azimuths.
template <std::size_t kPairs>
struct AzimuthTaps {
  alignas(64) float cell[kMostAzimuths];
  alignas(64) float weight[4][kMostAzimuths];
  alignas(64) float cosine[2 * kPairs][kMostAzimuths];  // of m phi, times SinePower if polarised
  alignas(64) float sine[2][kMostAzimuths];             // phi, 2 phi, times SinePower; if polarised
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
void FindTaps(const MomentGrid& grid, const MarchDirection& direction, const MarchPoint& point,
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

// Weights of four rows of suns, and the start of the first row.
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

// Adds the light that molecules at a march point scatter along one azimuth: I, Q and U.
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

// Finds the source of a march point at every sun node, in rows that begin one node before the
// first. With polarised light, the tensor provides the light of molecules in the last two vectors
// of a row.
template <std::size_t kDegree, bool kPolarised, std::size_t kRow>
void Contract(const MomentGrid& grid, const MarchPoint& point, const MarchLight& light,
              const BlockShape& shape, const float* previous, float* rows) {
  constexpr std::size_t kNode = PackedVectors(kDegree, kPolarised);
  if (!kPolarised || !point.only_molecules) {
    Eight factor[4 * kPackedRow[kDegree + 1]];
    FindFactors<kDegree, kPolarised>(point, light, shape, factor);
    if (point.only_molecules) {
      ContractRows<kDegree, 2, 2, kNode, kRow>(grid, point, factor, previous, rows);
    } else {
      ContractRows<kDegree, 1, kDegree, kNode, kRow>(grid, point, factor, previous, rows);
    }
  }
  if constexpr (kPolarised) ContractTensor<kDegree>(grid, point, light, shape, previous, rows);
  AddEnds<kRow>(grid.suns, rows);
}

template <std::size_t kDegree, bool kPolarised>
void ArriveOfDegree(const MomentGrid& grid, const MarchDirection& direction,
                    const MarchPoint* points, const MarchLight* lights, std::size_t count,
                    const BlockShape& shape, const float* previous, float* rows, float* arriving) {
  constexpr std::size_t kPairs = kDegree / 2 + 1;
  constexpr std::size_t kRow = kPairs + (kPolarised ? 2 : 0), kStokes = kPolarised ? 3 : 1;
  AzimuthTaps<kPairs> taps;
  for (std::size_t s = 0; s < count; ++s) {
    const MarchPoint& point = points[s];
    Contract<kDegree, kPolarised, kRow>(grid, point, lights[s], shape, previous, rows);
    const std::size_t pairs = kPolarised && point.only_molecules ? 0 : kPairs;
    const TensorStokes<float> stokes = TensorStokesAlong<float>(point.mu, point.sine);
    float* light = arriving;
    for (std::size_t sun = 0; sun < grid.suns; ++sun) {
      FindTaps<kPairs>(grid, direction, point, sun, taps);
      for (std::size_t k = 0; k < direction.azimuths; ++k, light += kStokes * 8) {
        const std::size_t cell = static_cast<std::size_t>(static_cast<int>(taps.cell[k]));
        const SunRows at{rows + cell * kRow * 8, V(taps.weight[0][k]), V(taps.weight[1][k]),
                         V(taps.weight[2][k]), V(taps.weight[3][k])};
        if constexpr (kPolarised) AddTensorLight<kPairs>(point, stokes, taps, k, at, light);
        Eight sum = LoadEight(light);
        for (std::size_t p = 0; p < pairs; ++p)
          Add(sum, Pair(taps.cosine[2 * p][k], taps.cosine[2 * p + 1][k]),
              BetweenSuns<kRow>(at, p));
        StoreEight(light, sum);
      }
    }
  }
}

void Arrive(const MomentGrid& grid, const MarchDirection& direction, const MarchPoint* points,
            const MarchLight* lights, std::size_t count, const BlockShape& shape,
            const float* previous, float* rows, float* arriving) {
  OfDegree(grid, [&](auto degree, auto polarised) {
    ArriveOfDegree<degree(), polarised()>(grid, direction, points, lights, count, shape, previous,
                                          rows, arriving);
  });
}

// Places nodes by the gentle stretch of ray_map.glsl: all pieces have the same number of nodes.
void Place(const LitPieces& pieces, const LitPoints& points) {
  using namespace shared;
  using Lanes = BatchOf<float>;
  using T = typename Lanes::Type;
  const T h0(pieces.altitude_km), mu0(pieces.mu), radius(pieces.radius_km), zero(0.0F), one(1.0F),
      gentle(1.0F), map(pieces.map_lengths_per_km),
      extinction(pieces.extinction / pieces.map_lengths_per_km);
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
    const T b = PanelStretch<T>(low * map, cosine, length * map, extinction, gentle, radius * map);
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

}  // namespace
}  // namespace alpenglow::lut
