// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/spherical_harmonics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase_table.h"

namespace alpenglow::lut {
void RequireDegree(int degree) {
  if (std::find(kDegrees.begin(), kDegrees.end(), degree) == kDegrees.end())
    throw InputError(fmt::format("degree is {}; there are {}", degree, fmt::join(kDegrees, ", ")));
}

Moments LegendreTerms(int degree, float mu) {
  Moments p{};
  const float sine = std::sqrt(std::max((1.0F - mu) * (1.0F + mu), 0.0F));
  float diagonal = 1.0F;
  for (int m = 0; m <= degree; ++m) {
    p[MomentIndex(m, m)] = diagonal;
    if (m < degree) p[MomentIndex(m + 1, m)] = mu * static_cast<float>(2 * m + 1) * diagonal;
    for (int l = m + 2; l <= degree; ++l) {
      p[MomentIndex(l, m)] = (static_cast<float>(2 * l - 1) * mu * p[MomentIndex(l - 1, m)] -
                              static_cast<float>(l + m - 1) * p[MomentIndex(l - 2, m)]) /
                             static_cast<float>(l - m);
    }
    diagonal *= static_cast<float>(2 * m + 1) * sine;
  }
  for (std::size_t i = 0; i < MomentCount(degree); ++i) p[i] *= kHarmonicNorm.of[i];
  return p;
}

namespace {

// Returns cos(m phi) for m = 0 ... degree from cos(phi).
std::array<float, kMaxDegree + 1> CosineMultiples(int degree, float cosine) {
  std::array<float, kMaxDegree + 1> values{};
  values[0] = 1.0F;
  if (degree >= 1) values[1] = cosine;
  for (std::size_t m = 2; m <= static_cast<std::size_t>(degree); ++m) {
    values[m] = 2.0F * cosine * values[m - 1] - values[m - 2];
  }
  return values;
}

}  // namespace

Moments SphericalHarmonics(int degree, float mu, float cos_azimuth) {
  Moments y = LegendreTerms(degree, mu);
  const auto cosines = CosineMultiples(degree, cos_azimuth);
  for (int l = 0; l <= degree; ++l) {
    for (int m = 0; m <= l; ++m) y[MomentIndex(l, m)] *= cosines[static_cast<std::size_t>(m)];
  }
  return y;
}

float AzimuthCosine(float mu, float mu_s, float nu) {
  const float sines =
      std::sqrt(std::max((1.0F - mu) * (1.0F + mu) * (1.0F - mu_s) * (1.0F + mu_s), 1e-12F));
  return std::clamp((nu - mu * mu_s) / sines, -1.0F, 1.0F);
}

namespace {

// Returns the edges of panels, as ascending cosines. The phase function is smooth on the scale of
// each panel: the panels of a table end at its nodes, others shrink towards the forward peak, so
// that g = 0.999 is resolved.
std::vector<double> PanelEdges(const PhaseFunction& phase) {
  std::vector<double> edges{-1.0};
  if (phase.kind == PhaseKind::kTable) {
    constexpr double kLast = static_cast<double>(PhaseTable::kNodes - 1);
    for (std::size_t node = PhaseTable::kNodes - 2; node > 0; --node) {
      const double s = static_cast<double>(node) / kLast;
      edges.push_back(std::cos(kPi * s * s * s));
    }
  } else {
    edges.push_back(0.0);
    for (double gap = 0.5; gap > 1e-9; gap *= 0.5) edges.push_back(1.0 - gap);
  }
  edges.push_back(1.0);
  return edges;
}

/// Cosines with their weights; padded with weights of 0 to a multiple of kLanes.
struct PhaseQuadrature {
  static constexpr std::size_t kLanes = 8;  // nodes per vector
  std::vector<double> cosine, weight;
};

PhaseQuadrature QuadratureOver(const std::vector<double>& edges, const GaussRule& rule) {
  PhaseQuadrature quadrature;
  for (std::size_t panel = 0; panel + 1 < edges.size(); ++panel) {
    const double width = edges[panel + 1] - edges[panel];
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      quadrature.cosine.push_back(edges[panel] + width * rule.node[i]);
      quadrature.weight.push_back(2.0 * kPi * rule.weight[i] * width);
    }
  }
  constexpr std::size_t kLanes = PhaseQuadrature::kLanes;
  const std::size_t count = (quadrature.cosine.size() + kLanes - 1) / kLanes * kLanes;
  quadrature.cosine.resize(count, 0.0);
  quadrature.weight.resize(count, 0.0);
  return quadrature;
}

/// The quadrature that all tables share, and the positions of its cosines in a table.
struct TableQuadrature {
  PhaseQuadrature rule;
  std::vector<double> position;
};

TableQuadrature MakeTableQuadrature() {
  TableQuadrature of_tables{
      QuadratureOver(PanelEdges({.kind = PhaseKind::kTable}), GaussLegendre(4)), {}};
  for (const double cosine : of_tables.rule.cosine)
    of_tables.position.push_back(PhaseTable::Position(cosine));
  return of_tables;
}

// Returns the quadrature; its weights include the phase function.
PhaseQuadrature QuadratureOf(const PhaseFunction& phase) {
  if (phase.kind == PhaseKind::kTable) {
    static const TableQuadrature of_tables = MakeTableQuadrature();
    PhaseQuadrature rule = of_tables.rule;
    for (std::size_t i = 0; i < rule.weight.size(); ++i)
      rule.weight[i] *= phase.table->At(of_tables.position[i]);
    return rule;
  }
  PhaseQuadrature rule = QuadratureOver(PanelEdges(phase), GaussLegendre(32));
  for (std::size_t i = 0; i < rule.weight.size(); ++i)
    rule.weight[i] *= Phase(phase, rule.cosine[i]);
  return rule;
}

}  // namespace

std::vector<double> LegendreSeries(int degree, double nu) {
  std::vector<double> value(static_cast<std::size_t>(degree) + 1);
  double before = 0.0, now = 1.0;
  for (int l = 0; l <= degree; ++l) {
    value[static_cast<std::size_t>(l)] = (2.0 * l + 1.0) / (4.0 * kPi) * now;
    const double next = ((2.0 * l + 1.0) * nu * now - l * before) / (l + 1.0);
    before = now;
    now = next;
  }
  return value;
}

std::vector<double> LegendreCoefficients(const PhaseFunction& phase, int degree) {
  constexpr std::size_t kLanes = PhaseQuadrature::kLanes;  // hides the latency of a recurrence
  const PhaseQuadrature rule = QuadratureOf(phase);
  std::vector<double> sums(kLanes * (static_cast<std::size_t>(degree) + 1), 0.0);
  for (std::size_t first = 0; first < rule.cosine.size(); first += kLanes) {
    const double* x = &rule.cosine[first];
    std::array<double, kLanes> before{}, now{};
    std::copy_n(&rule.weight[first], kLanes, now.begin());
    for (int l = 0; l <= degree; ++l) {
      const double rising = (2.0 * l + 1.0) / (l + 1.0), falling = l / (l + 1.0);
      double* sum = &sums[kLanes * static_cast<std::size_t>(l)];
      for (std::size_t i = 0; i < kLanes; ++i) {
        sum[i] += now[i];
        const double next = rising * x[i] * now[i] - falling * before[i];
        before[i] = now[i];
        now[i] = next;
      }
    }
  }
  std::vector<double> chi;
  for (auto sum = sums.begin(); sum != sums.end(); sum += kLanes)
    chi.push_back(std::accumulate(sum, sum + kLanes, 0.0));
  return chi;
}

std::vector<double> MieLegendreCoefficients(const Medium& medium, int degree) {
  const std::size_t bands = medium.wavelengths_nm.size();
  const std::size_t different = medium.mie_phase.size();
  const auto degrees = static_cast<std::size_t>(degree) + 1;
  std::vector<double> chi(degrees * bands);
  for (std::size_t phase = 0; phase < different; ++phase) {
    const std::vector<double> row = LegendreCoefficients(medium.mie_phase[phase], degree);
    for (std::size_t l = 0; l < degrees; ++l) {
      for (std::size_t band = phase; band < bands; band += different)
        chi[l * bands + band] = row[l];
    }
  }
  return chi;
}

}  // namespace alpenglow::lut
