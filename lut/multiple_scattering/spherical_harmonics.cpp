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
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/medium/phase_table.h"
#include "lut/tables/table_axes.h"

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

// Returns the edges of panels, as ascending cosines. The phase function and the Legendre
// polynomials up to `degree` are smooth on the scale of each panel: panels are at most 40 / degree
// wide and shrink towards both ends of the axis, so that lobes a microradian wide are resolved.
std::vector<double> PanelEdges(int degree) {
  const double widest = 40.0 / std::max(degree, 40);
  std::vector<double> angle;  // descending, of the half in front
  for (double next = 0.5 * kPi; next > 1e-6; next -= std::min(0.5 * next, widest))
    angle.push_back(next);
  std::vector<double> edges{-1.0};
  for (auto next = angle.rbegin(); next != angle.rend(); ++next) edges.push_back(-std::cos(*next));
  for (auto next = angle.begin() + 1; next != angle.end(); ++next) edges.push_back(std::cos(*next));
  edges.push_back(1.0);
  return edges;
}

// Returns the edges of the panels of tables, as ascending cosines: their nodes.
std::vector<double> PanelEdgesOfTables() {
  std::vector<double> edges{-1.0};
  constexpr double kLast = static_cast<double>(PhaseTable::kNodes - 1);
  for (std::size_t node = PhaseTable::kNodes - 2; node > 0; --node) {
    const double s = static_cast<double>(node) / kLast;
    edges.push_back(std::cos(kPi * s * s * s));
  }
  edges.push_back(1.0);
  return edges;
}

// Returns the number of Gauss nodes that integrate Legendre polynomials up to `degree` over a panel
// of this width [rad], in which they turn by degree * width: half a node per radian of half the
// width, and a margin that grows more slowly.
int NodesOver(double width_rad, int degree) {
  const double turn = width_rad * degree;
  return std::min(4 + static_cast<int>(0.25 * turn + 2.0 * std::sqrt(turn)), kMaxGaussNodes);
}

/// Cosines with their weights; padded with weights of 0 to a multiple of kLanes.
struct PhaseQuadrature {
  static constexpr std::size_t kLanes = 8;  // nodes per vector
  std::vector<double> cosine, weight;
};

PhaseQuadrature QuadratureOver(const std::vector<double>& edges, int nodes) {
  const GaussRule& rule = GaussLegendre(nodes);
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

TableQuadrature MakeTableQuadrature(int degree) {
  constexpr double kWidest_rad = 3.0 * kPi / static_cast<double>(PhaseTable::kNodes - 1);
  TableQuadrature of_tables{QuadratureOver(PanelEdgesOfTables(), NodesOver(kWidest_rad, degree)),
                            {}};
  for (const double cosine : of_tables.rule.cosine)
    of_tables.position.push_back(PhaseTable::Position(cosine));
  return of_tables;
}

// Returns a quadrature for the degree or a higher one, made once.
const TableQuadrature& QuadratureOfTables(int degree) {
  constexpr int kLow = 16, kMiddle = 170, kHigh = 1500, kHighest = 8200;
  if (degree <= kLow) {
    static const TableQuadrature low = MakeTableQuadrature(kLow);
    return low;
  }
  if (degree <= kMiddle) {
    static const TableQuadrature middle = MakeTableQuadrature(kMiddle);
    return middle;
  }
  if (degree <= kHigh) {
    static const TableQuadrature high = MakeTableQuadrature(kHigh);
    return high;
  }
  static const TableQuadrature highest = MakeTableQuadrature(kHighest);
  return highest;
}

PhaseQuadrature QuadratureOf(const PhaseTable& table, const TableQuadrature& of_tables) {
  PhaseQuadrature rule = of_tables.rule;
  for (std::size_t i = 0; i < rule.weight.size(); ++i)
    rule.weight[i] *= table.At(of_tables.position[i]);
  return rule;
}

// Returns the quadrature; its weights include the phase function.
PhaseQuadrature QuadratureOf(const PhaseFunction& phase, int degree) {
  if (phase.kind == PhaseKind::kTable) {
    return QuadratureOf(*phase.table, QuadratureOfTables(degree));
  }
  PhaseQuadrature rule = QuadratureOver(PanelEdges(degree), 32);
  for (std::size_t i = 0; i < rule.weight.size(); ++i)
    rule.weight[i] *= Phase(phase, rule.cosine[i]);
  return rule;
}

// Returns the coefficients by quadrature.
std::vector<double> IntegratedCoefficients(const PhaseFunction& phase, int degree) {
  constexpr std::size_t kLanes = PhaseQuadrature::kLanes;  // hides the latency of a recurrence
  const PhaseQuadrature rule = QuadratureOf(phase, degree);
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
  return shared::AzimuthCosine(mu, mu_s, nu, sines);
}

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
  const PhaseForm& form = FormOf(phase.kind);
  return form.legendre != nullptr ? form.legendre(phase, degree)
                                  : IntegratedCoefficients(phase, degree);
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
