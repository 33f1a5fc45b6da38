// SPDX-License-Identifier: MIT
#include "renderer/layers/layer_mode.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

/// Returns c_l = w' (2 l + 1) chi'_l / 2.
double DegreeOfScattering(const ScaledLayer& layer, int l) {
  return 0.5 * layer.albedo * (2.0 * l + 1.0) * layer.chi[static_cast<std::size_t>(l)];
}

/// Returns S_e (parity 0) or S_o (parity 1).
DenseMatrix SymmetricForm(const StreamSet& streams, const ScaledLayer& layer, int m, int parity) {
  DenseMatrix form(streams.size());
  for (std::size_t i = 0; i < streams.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double scattered = 0.0;
      for (int l = m + parity; l < streams.streams(); l += 2) {
        scattered += 2.0 * DegreeOfScattering(layer, l) * streams.Legendre(m, l, i) *
                     streams.Legendre(m, l, j);
      }
      scattered *= std::sqrt(streams.weight(i) * streams.weight(j));
      form(i, j) = ((i == j ? 1.0 : 0.0) - scattered) / std::sqrt(streams.mu(i) * streams.mu(j));
      form(j, i) = form(i, j);
    }
  }
  return form;
}

/// Returns S_e or S_o for scattering whose norm is that of the phase function, w' times the largest
/// chi'_l of the parity. Gauss's rule exceeds it for narrow lobes backwards, which scatter more light
/// than arrives then.
DenseMatrix WithinNorm(const StreamSet& streams, const ScaledLayer& layer, int m, int parity,
                       const DenseMatrix& form) {
  constexpr double kMostOfOdd = 1.0 - 1e-9;  // S_o has an inverse
  double norm = 0.0;
  for (int l = m + parity; l < streams.streams(); l += 2) {
    norm = std::max(norm, layer.albedo * layer.chi[static_cast<std::size_t>(l)]);
  }
  if (parity == 1) norm = std::min(norm, kMostOfOdd);
  const std::size_t n = streams.size();
  const auto roots = [&](const DenseMatrix& matrix, double power) {
    DenseMatrix scaled = matrix;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        scaled(i, j) *= std::pow(streams.mu(i) * streams.mu(j), power);
      }
    }
    return scaled;
  };
  SymmetricEigen kept = EigenOfSymmetric(roots(form, 0.5));  // 1 - scattering
  for (double& value : kept.value) value = std::max(value, 1.0 - norm);
  return roots(kept.vector.WithColumnsTimes(kept.value) * kept.vector.Transposed(), -0.5);
}

}  // namespace

EndSlopes EndSlopesOf(double k, double depth) {
  if (k == 0.0) return {1.0 / depth, 1.0 / depth};
  const double fall = std::exp(-k * depth);
  const double scale = -k / std::expm1(-2.0 * k * depth);
  return {scale * (1.0 + fall * fall), 2.0 * scale * fall};
}

LayerMode::LayerMode(const StreamSet& streams, const ScaledLayer& layer, int m) : m_(m) {
  const DenseMatrix form_o = SymmetricForm(streams, layer, m, 1);
  auto factor = CholeskyFactor(form_o);
  if (!factor) factor = CholeskyFactor(WithinNorm(streams, layer, m, 1, form_o));
  ALPENGLOW_ENSURE(factor.has_value(), ==, true);
  const auto eigen_of = [&](const DenseMatrix& form_e) {
    return EigenOfSymmetric(factor->Transposed() * form_e * *factor);
  };
  const DenseMatrix form_e = SymmetricForm(streams, layer, m, 0);
  SymmetricEigen eigen = eigen_of(form_e);
  const auto [least, largest] = std::minmax_element(eigen.value.begin(), eigen.value.end());
  if (*least < -1e-9 * *largest) eigen = eigen_of(WithinNorm(streams, layer, m, 0, form_e));
  // Without absorption rounding may make the eigenvalue 0 negative.
  for (const double value : eigen.value) decay_.push_back(std::sqrt(std::max(value, 0.0)));
  even_ = *factor * eigen.vector;
  odd_ = InverseOf(even_).Transposed();
  SetEmission(streams, layer);
  SetResponse(layer.depth);
}

void LayerMode::SetEmission(const StreamSet& streams, const ScaledLayer& layer) {
  const std::size_t n = streams.size();
  emission_.assign(static_cast<std::size_t>(streams.streams()) * n, 0.0);
  for (int l = m_; l < streams.streams(); ++l) {
    const DenseMatrix& basis = (l - m_) % 2 == 0 ? even_ : odd_;
    for (std::size_t i = 0; i < n; ++i) {
      const double at_stream = DegreeOfScattering(layer, l) * streams.Legendre(m_, l, i) *
                               std::sqrt(streams.weight(i) / streams.mu(i));
      for (std::size_t j = 0; j < n; ++j) {
        emission_[static_cast<std::size_t>(l) * n + j] += at_stream * basis(i, j);
      }
    }
  }
}

void LayerMode::SetResponse(double depth) {
  const std::size_t n = decay_.size();
  const DenseMatrix one = DenseMatrix::Identity(n);
  if (!(depth > 0.0)) {
    reflection_ = DenseMatrix(n);
    transmission_ = one;
    return;
  }
  std::vector<double> about_middle, across_middle;
  for (const double k : decay_) {
    end_slopes_.push_back(EndSlopesOf(k, depth));
    const double x = 0.5 * k * depth;
    const double tangent = std::tanh(x);
    about_middle.push_back(k * tangent);
    across_middle.push_back(x > 0.0 ? k / tangent : 2.0 / depth);
  }
  const DenseMatrix transposed = odd_.Transposed();
  const DenseMatrix even = InverseOf(one + odd_.WithColumnsTimes(about_middle) * transposed);
  const DenseMatrix odd = InverseOf(one + odd_.WithColumnsTimes(across_middle) * transposed);
  reflection_ = even + odd - one;
  transmission_ = even - odd;
}

EvenAndOdd LayerMode::EmissionAt(const std::vector<double>& legendre) const {
  const std::size_t n = decay_.size();
  EvenAndOdd sums{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  for (auto l = static_cast<std::size_t>(m_); l < legendre.size(); ++l) {
    std::vector<double>& sum = (l - static_cast<std::size_t>(m_)) % 2 == 0 ? sums.even : sums.odd;
    for (std::size_t j = 0; j < n; ++j) sum[j] += legendre[l] * emission_[l * n + j];
  }
  return sums;
}

std::vector<double> LayerMode::SourceOf(const std::vector<double>& value,
                                        const std::vector<double>& slope) const {
  const std::size_t n = decay_.size(), m = static_cast<std::size_t>(m_);
  std::vector<double> source(emission_.size() / n, 0.0);
  for (std::size_t l = m; l < source.size(); ++l) {
    const std::vector<double>& amplitude = (l - m) % 2 == 0 ? value : slope;
    for (std::size_t j = 0; j < n; ++j) source[l] += emission_[l * n + j] * amplitude[j];
  }
  return source;
}

}  // namespace alpenglow::renderer
