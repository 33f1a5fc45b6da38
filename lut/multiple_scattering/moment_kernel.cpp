// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/moment_kernel.h"

#include <utility>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/four_bands.h"
#include "lut/multiple_scattering/march_lanes.h"
#include "lut/multiple_scattering/moment_lanes.h"

namespace alpenglow::lut {
namespace {

/// A few samples of a ray, prepared for look-ups in the table: [.][sample].
constexpr std::size_t kChunk = BatchOf<float>::kLanes;
struct Chunk {
  alignas(64) float altitude_cell[kChunk], sun_cell[kChunk];
  alignas(64) float altitude_weight[4][kChunk], sun_weight[4][kChunk];
  alignas(64) float harmonic[kMaxMoments][kChunk];
};

// Returns the weights at the ends of an axis, where the node beyond the end is BeyondEnd of the
// last three nodes.
template <typename T>
Weights<T> Folded(const Weights<T>& w, const T& cell, const T& last) {
  using namespace shared;
  const auto first = cell < T(0.5F);
  const auto end = cell > last - T(0.5F);
  Weights<T> out = w;
  const T three(3.0F);
  out.w1 = select(first, T(out.w1 + three * w.w0), out.w1);
  out.w2 = select(first, T(out.w2 - three * w.w0), out.w2);
  out.w3 = select(first, T(out.w3 + w.w0), out.w3);
  out.w0 = select(first, T(0.0F), out.w0);
  out.w2 = select(end, T(out.w2 + three * w.w3), out.w2);
  out.w1 = select(end, T(out.w1 - three * w.w3), out.w1);
  out.w0 = select(end, T(out.w0 + w.w3), out.w0);
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
  const T below = min(Lanes::Floor(at), last);
  const Weights<T> w = Folded<T>(Cubic<T>(at - below), below, last);
  Lanes::Store(cell, below);
  Lanes::Store(weight[0], w.w0 * factor);
  Lanes::Store(weight[1], w.w1 * factor);
  Lanes::Store(weight[2], w.w2 * factor);
  Lanes::Store(weight[3], w.w3 * factor);
}

template <std::size_t kDegree, typename T, typename Visit>
void VisitHarmonics(const T& mu, const T& sine, const T& cosine, const Visit& visit) {
  T diagonal(1.0F), cos_before = cosine, cos_now(1.0F);  // cos((m - 1) phi), cos(m phi)
  for (std::size_t m = 0; m <= kDegree; ++m) {
    T lower(0.0F), value = diagonal;
    for (std::size_t l = m; l <= kDegree; ++l) {
      const std::size_t i = l * (l + 1) / 2 + m;
      visit(i, T(T(kHarmonicNorm.of[i]) * value * cos_now));
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
void Prepare(const MomentGrid& grid, const RaySamples<float>& samples, std::size_t first, float nu,
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

Eight Twice(const std::array<float, kBlockBands>& bands) {
  alignas(64) float twice[8];
  for (std::size_t band = 0; band < 8; ++band) twice[band] = bands[band % 4];
  return LoadEight(twice);
}

/// The nodes around a point and their weights.
struct Taps {
  const float* node[16];
  float weight[16];
};

// A look-up reads the first kRows vectors of a node and those from kFrom on. Returns where the
// index-th of these vectors begins.
template <std::size_t kRows, std::size_t kFrom>
constexpr std::size_t PlaceOf(std::size_t index) {
  return (index < kRows ? index : kFrom + index - kRows) * 8;
}

// Sums these vectors over 16 nodes. The expression is expanded at compile time so that the sums
// stay in registers.
template <std::size_t kRows, std::size_t kFrom, std::size_t kFirst, std::size_t... kIndex>
void SumTapsAt(const Taps& taps, float* moments, std::index_sequence<kIndex...>) {
  Eight sum[sizeof...(kIndex)] = {(static_cast<void>(kIndex), Zero())...};
  for (std::size_t tap = 0; tap < 16; ++tap) {
    const V w(taps.weight[tap]);
    const float* at = taps.node[tap];
    (Add(sum[kIndex], w, LoadEight(at + PlaceOf<kRows, kFrom>(kFirst + kIndex))), ...);
  }
  (StoreEight(moments + (kFirst + kIndex) * 8, sum[kIndex]), ...);
}

#ifdef ALPENGLOW_BATCHES
// Sums two vectors at a time, if the instruction set has enough lanes.
template <std::size_t kRows, std::size_t kFrom, std::size_t kFirst, std::size_t... kIndex>
void SumPairsOfTapsAt(const Taps& taps, float* moments, std::index_sequence<kIndex...>) {
  using Wide = BatchOf<float>::Type;
  Wide sum[sizeof...(kIndex)] = {(static_cast<void>(kIndex), Wide(0.0F))...};
  for (std::size_t tap = 0; tap < 16; ++tap) {
    const Wide w(taps.weight[tap]);
    const float* at = taps.node[tap];
    ((sum[kIndex] += w * Wide::load_unaligned(at + PlaceOf<kRows, kFrom>(kFirst + 2 * kIndex))),
     ...);
  }
  (sum[kIndex].store_aligned(moments + (kFirst + 2 * kIndex) * 8), ...);
}
#endif

// Sums all kCount vectors, as many at a time as fit into registers.
template <std::size_t kRows, std::size_t kFrom, std::size_t kCount, std::size_t kFirst = 0>
void SumTaps(const Taps& taps, float* moments) {
  constexpr std::size_t kMost = 18;
  constexpr std::size_t kHere = kCount - kFirst < kMost ? kCount - kFirst : kMost;
#ifdef ALPENGLOW_BATCHES
  constexpr bool kPairs =
      BatchOf<float>::kLanes == 16 && kRows % 2 == 0 && kCount % 2 == 0 && kFirst % 2 == 0;
  if constexpr (kPairs) {
    SumPairsOfTapsAt<kRows, kFrom, kFirst>(taps, moments, std::make_index_sequence<kHere / 2>{});
  } else {
    SumTapsAt<kRows, kFrom, kFirst>(taps, moments, std::make_index_sequence<kHere>{});
  }
#else
  SumTapsAt<kRows, kFrom, kFirst>(taps, moments, std::make_index_sequence<kHere>{});
#endif
  if constexpr (kFirst + kHere < kCount)
    SumTaps<kRows, kFrom, kCount, kFirst + kHere>(taps, moments);
}

// Returns the light that moments of degree kL scatter into the ray at a sample, before phase
// functions.
template <std::size_t kL, std::size_t... kPair>
[[gnu::always_inline]] inline Eight LightOfDegree(const Chunk& chunk, std::size_t s,
                                                  const float* moments,
                                                  std::index_sequence<kPair...>) {
  constexpr std::size_t kFirst = kL * (kL + 1) / 2;
  Eight light = Zero();
  const auto odd = [&](std::size_t p) {
    return 2 * p < kL ? chunk.harmonic[kFirst + 2 * p + 1][s] : 0.0F;
  };
  (Add(light, Pair(chunk.harmonic[kFirst + 2 * kPair][s], odd(kPair)),
       LoadEight(moments + (kPackedRow[kL] + kPair) * 8)),
   ...);
  return light;
}

// Returns the polarised light that molecules scatter; `tensor` is two vectors (PackedVectors).
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

/// Light of the moments scattered by molecules and by aerosol at a sample, per unit coefficient.
struct Scattered {
  Eight rayleigh, mie;
};

/// Legendre coefficients of a block, repeated in both halves of eight lanes.
template <std::size_t kDegree>
struct EightChi {
  Eight mie[kDegree + 1];
  Eight rayleigh2;
};

template <std::size_t kL, bool kPolarised, std::size_t kDegree>
void AddDegree(const Chunk& chunk, std::size_t s, const float* moments,
               const EightChi<kDegree>& chi, Scattered& light) {
  const Eight of_degree =
      LightOfDegree<kL>(chunk, s, moments, std::make_index_sequence<kL / 2 + 1>{});
  if constexpr (!kPolarised && kL == 0) Add(light.rayleigh, V(1.0F), of_degree);
  if constexpr (!kPolarised && kL == 2) Add(light.rayleigh, chi.rayleigh2, of_degree);
  Add(light.mie, chi.mie[kL], of_degree);
}

// Returns the light of the moments of rows 0, kStep, ... kLast. All the values of a node that they
// need are read in one pass.
template <std::size_t kLast, std::size_t kStep, bool kPolarised, std::size_t kDegree>
Scattered ScatteredByRows(const Chunk& chunk, std::size_t s, const Taps& taps,
                          const EightChi<kDegree>& chi) {
  constexpr std::size_t kRows = kPackedRow[kLast + 1];
  constexpr std::size_t kMore =
      kPolarised ? PackedVectors(kDegree, true) - kPackedRow[kDegree + 1] : 0;
  alignas(64) float moments[(kRows + kMore) * 8];
  SumTaps<kRows, kPackedRow[kDegree + 1], kRows + kMore>(taps, moments);
  Scattered light{Zero(), Zero()};
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (AddDegree<kIndex * kStep, kPolarised>(chunk, s, moments, chi, light), ...);
  }
  (std::make_index_sequence<kLast / kStep + 1>{});
  if (kPolarised) light.rayleigh = LightOfTensor(chunk, s, moments + kRows * 8, chi.rayleigh2);
  return light;
}

// Returns the scattered light where only molecules scatter.
template <bool kPolarised, std::size_t kDegree>
Scattered ScatteredByMolecules(const Chunk& chunk, std::size_t s, const Taps& taps,
                               const EightChi<kDegree>& chi) {
  if constexpr (kPolarised) {
    alignas(64) float tensor[2 * 8];
    SumTaps<0, kPackedRow[kDegree + 1], 2>(taps, tensor);
    return {LightOfTensor(chunk, s, tensor, chi.rayleigh2), Zero()};
  } else {
    return ScatteredByRows<2, 2, false>(chunk, s, taps, chi);
  }
}

// Returns the sum of both halves, clamped to at least 0.
Four SumOfHalves(const Eight& eight) {
  alignas(64) float halves[8];
  StoreEight(halves, eight);
  const Four sum = LoadFour(halves) + LoadFour(halves + 4), dark = {};
  return sum > dark ? sum : dark;
}

// Returns the values of a chunk's four rows at a sample.
Four AtSample(const float (*rows)[kChunk], std::size_t s) {
  return Four{rows[0][s], rows[1][s], rows[2][s], rows[3][s]};
}

template <std::size_t kNode>
Taps TapsOf(const MomentGrid& grid, const Chunk& chunk, std::size_t s, const float* moments) {
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
  const Four of_suns = AtSample(chunk.sun_weight, s);
  Taps taps;
  for (int a = 0; a < 4; ++a) {
    const float* row = moments + within(first_altitude + a, last_altitude) * grid.suns * kNode;
    for (int b = 0; b < 4; ++b) taps.node[a * 4 + b] = row + column[b];
    StoreFour(taps.weight + a * 4, chunk.altitude_weight[a][s] * of_suns);
  }
  return taps;
}

/// A block of bands with the values that every sample needs.
template <std::size_t kDegree>
struct ReadyBlock {
  const MomentBlock& block;
  EightChi<kDegree> chi;
  float most_aerosol;  // largest ratio of aerosol to molecular scattering over bands, at altitude 0

  explicit ReadyBlock(const MomentBlock& of_block) : block(of_block), most_aerosol(0.0F) {
    for (std::size_t l = 0; l <= kDegree; ++l) chi.mie[l] = Twice(block.shape.mie[l]);
    chi.rayleigh2 = Twice(block.shape.rayleigh_chi2);
    for (std::size_t band = 0; band < kBlockBands; ++band) {
      const float ratio = block.mie_scattering[band] /
                          (block.rayleigh[band] > 1e-30F ? block.rayleigh[band] : 1e-30F);
      most_aerosol = ratio > most_aerosol ? ratio : most_aerosol;
    }
  }
};

template <bool kPolarised, std::size_t kDegree>
Four SourceAt(const MomentGrid& grid, const Chunk& chunk, std::size_t s,
              const RaySamples<float>& samples, std::size_t sample,
              const ReadyBlock<kDegree>& ready, const float* moments) {
  // Aerosol-to-molecule ratios of scattering. Below the first, aerosol needs no more moments than
  // molecules do; below the second, only the moments up to degree 3.
  constexpr float kNoAerosol = 3e-4F, kCoarseAerosol = 1e-3F;
  constexpr std::size_t kCoarseDegree = kDegree < 3 ? kDegree : 3;
  const Taps taps = TapsOf<PackedVectors(kDegree, kPolarised) * 8>(grid, chunk, s, moments);
  const float molecules = samples.rayleigh_density[sample], haze = samples.mie_density[sample];
  const float aerosol = ready.most_aerosol * haze;
  const Scattered scattered =
      aerosol > kCoarseAerosol * molecules
          ? ScatteredByRows<kDegree, 1, kPolarised>(chunk, s, taps, ready.chi)
      : aerosol > kNoAerosol * molecules
          ? ScatteredByRows<kCoarseDegree, 1, kPolarised>(chunk, s, taps, ready.chi)
          : ScatteredByMolecules<kPolarised>(chunk, s, taps, ready.chi);
  return molecules * LoadFour(ready.block.rayleigh.data()) * SumOfHalves(scattered.rayleigh) +
         haze * LoadFour(ready.block.mie_scattering.data()) * SumOfHalves(scattered.mie);
}

template <std::size_t kDegree, bool kPolarised>
void InscatterOfDegree(const MomentGrid& grid, const RaySamples<float>& samples, float nu,
                       const MomentBlock* blocks, std::size_t count, const float* moments,
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
      const ReadyBlock<kDegree> ready(blocks[b]);
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
      Four sum = LoadFour(light + b * kBlockBands);
      for (std::size_t s = 0; s < size; ++s) {
        if (samples.weight[first + s] == 0.0F) continue;  // a position, not a quadrature node
        sum += AtSample(attenuation, s) * SourceAt<kPolarised>(grid, chunk, s, samples, first + s,
                                                               ready, moments + b * block_stride);
      }
      StoreFour(light + b * kBlockBands, sum);
    }
  }
}

void Inscatter(const MomentGrid& grid, const RaySamples<float>& samples, float nu,
               const MomentBlock* blocks, std::size_t count, const float* moments, float* light) {
  OfDegree(grid, [&](auto degree, auto polarised) {
    InscatterOfDegree<degree(), polarised()>(grid, samples, nu, blocks, count, moments, light);
  });
}

// 2 pi integral of max(x, 0) P_l(x) dx: factor by which a Lambertian surface convolves moments of
// degree l (Ramamoorthi, Hanrahan 2001): pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, pi / 64 ...
constexpr float kClampedCosine[kMaxDegree + 1] = {
    3.14159265F,    2.09439510F, 0.785398163F,  0.0F, -0.130899694F,  0.0F, 0.0490873852F, 0.0F,
    -0.0245436926F, 0.0F,        0.0143171540F, 0.0F, -0.00920388473F};

// Returns P_l(x) for the lowest even l above the degree of the moments.
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

// Returns the moments of a point, summed over its nodes and multiplied by the factors of a surface.
template <std::size_t kDegree>
Eight SumOverNodes(const SurfacePoint& point, std::size_t node_floats, const float* moments,
                   const Eight* factor) {
  Eight light = Zero();
  for (std::size_t l = 0; l <= kDegree; ++l) {
    if (l > 1 && l % 2 == 1) continue;  // the clamped cosine has no odd terms beyond l = 1
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

// The clamped cosine has no odd terms beyond l = 1, so the truncation error of the series is equal
// on a surface that faces up (where `sky` gives the true value) and on one that faces down. Between
// them the error is assumed to follow the first even Legendre polynomial that the series lacks.
template <std::size_t kDegree>
void IrradianceOfDegree(const MomentGrid& grid, const SurfacePoint& point, std::size_t count,
                        const float* moments, const float* sky, float* irradiance) {
  const float mu = point.normal_mu;
  const float missing = FirstMissingLegendre<kDegree>(mu);
  const float sine2 = (1.0F - mu) * (1.0F + mu);
  float of_moment[kMaxMoments];
  VisitHarmonics<kDegree, float>(mu, std::sqrt(sine2 > 0.0F ? sine2 : 0.0F), point.normal_azimuth,
                                 [&](std::size_t i, float y) { of_moment[i] = y; });
  Eight factor[kPackedRow[kDegree + 1]];
  for (std::size_t l = 0; l <= kDegree; ++l) {
    const std::size_t first = l * (l + 1) / 2;
    of_moment[first] -=
        missing * kHarmonicNorm.of[first];  // subtracts the harmonic of the vertical
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

void Irradiance(const MomentGrid& grid, const SurfacePoint& point, std::size_t count,
                const float* moments, const float* sky, float* irradiance) {
  OfDegree(grid, [&](auto degree, auto /*polarised*/) {
    IrradianceOfDegree<degree()>(grid, point, count, moments, sky, irradiance);
  });
}

}  // namespace

const MomentKernel& KernelOf(KernelName<MomentKernel, kThisSet> /*name*/) {
  static constexpr MomentKernel kernel{Arrive, Place, Scatter, Inscatter, Irradiance};
  return kernel;
}

}  // namespace alpenglow::lut
