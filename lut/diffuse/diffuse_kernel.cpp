// SPDX-License-Identifier: MIT
#include "lut/diffuse/diffuse_kernel.h"

#include <utility>

#include "atmosphere/number/constants.h"
#include "lut/diffuse/diffuse_lanes.h"
#include "lut/diffuse/march_lanes.h"

namespace alpenglow {
namespace {

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
  const T below = min(Lanes::Floor(at), last);
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
