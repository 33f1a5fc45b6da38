// SPDX-License-Identifier: MIT
#include "renderer/media/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "renderer/media/local_medium.h"

namespace alpenglow::renderer {
namespace {

/// Returns the positions in (0, 1) at which a cubic has its extremes, in order, with 0 first and 1
/// last.
std::vector<double> MonotoneParts(const std::array<double, 4>& b) {
  // A third of the derivative is first (1 - s)^2 + 2 middle s (1 - s) + last s^2.
  const double first = b[1] - b[0], middle = b[2] - b[1], last = b[3] - b[2];
  const double a = first - 2.0 * middle + last, half_b = middle - first;
  const double root = half_b * half_b - a * first;
  std::vector<double> ends{0.0};
  if (root > 0.0) {
    // The sum of two terms of one sign loses no digits; the product of the roots gives the other.
    const double q = -(half_b + std::copysign(std::sqrt(root), half_b));
    for (const double s : {q / a, first / q}) {
      if (s > 0.0 && s < 1.0) ends.push_back(s);
    }
    std::sort(ends.begin(), ends.end());
  }
  ends.push_back(1.0);
  return ends;
}

/// Returns the position in [low, high] at which a monotone part of a cubic has a value.
double PositionOf(const CubicPiece& piece, double low, double high, double value) {
  constexpr int kHalvings = 50;
  const bool rises = piece.At(low) < value;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    ((piece.At(middle) < value) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

TransferFunction::TransferFunction(const std::vector<TransferNode>& nodes,
                                   const std::vector<double>& wavelengths_nm)
    : wavelengths_nm_(wavelengths_nm) {
  ALPENGLOW_ENSURE(nodes.size(), >=, 2U);
  for (const TransferNode& node : nodes) {
    if (!values_.empty()) ALPENGLOW_ENSURE(node.value, >, values_.back());
    values_.push_back(node.value);
    extinction_per_m_.push_back(node.extinction_per_m);
    temperature_k_.push_back(node.temperature_k);
    albedo_.push_back(
        InBands(AlbedoFromLinearSrgb(node.albedo, wavelengths_nm), wavelengths_nm.size()));
  }
}

TransferFunction::Place TransferFunction::PlaceOf(double value) const {
  const auto after = std::upper_bound(values_.begin() + 1, values_.end() - 1, value);
  const auto node = static_cast<std::size_t>(after - values_.begin()) - 1;
  const double share = (value - values_[node]) / (values_[node + 1] - values_[node]);
  return {node, std::clamp(share, 0.0, 1.0)};
}

double TransferFunction::Extinction(double value) const {
  const Place at = PlaceOf(value);
  return std::lerp(extinction_per_m_[at.node], extinction_per_m_[at.node + 1], at.share);
}

double TransferFunction::LargestExtinction(double least, double largest) const {
  double most = std::max(Extinction(least), Extinction(largest));
  for (std::size_t node = 0; node < values_.size(); ++node) {
    if (values_[node] > least && values_[node] < largest)
      most = std::max(most, extinction_per_m_[node]);
  }
  return most;
}

bool TransferFunction::IsLinear(double least, double largest) const {
  const auto first = std::upper_bound(values_.begin(), values_.end(), least);
  return first == values_.end() || *first >= largest;
}

std::pair<double, double> TransferFunction::NodesAround(double value) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto after = std::upper_bound(values_.begin(), values_.end(), value);
  return {after == values_.begin() ? -kNone : *(after - 1),
          after == values_.end() ? kNone : *after};
}

TransferFunction::Colour TransferFunction::ColourOf(double value) const {
  const Place at = PlaceOf(value);
  const std::size_t bands = wavelengths_nm_.size();
  Colour colour{SpectrumOf<double>(bands), SpectrumOf<double>(bands)};
  const double temperature_k =
      std::lerp(temperature_k_[at.node], temperature_k_[at.node + 1], at.share);
  for (std::size_t band = 0; band < bands; ++band) {
    colour.albedo[band] = std::lerp(albedo_[at.node][band], albedo_[at.node + 1][band], at.share);
    if (temperature_k > 0.0)
      colour.emission[band] =
          (1.0 - colour.albedo[band]) * BlackBodyRadiance(wavelengths_nm_[band], temperature_k);
  }
  return colour;
}

std::vector<double> TransferFunction::Crossings(const CubicPiece& piece) const {
  std::vector<double> at{0.0};
  const auto [least, largest] =
      std::minmax_element(piece.coefficients.begin(), piece.coefficients.end());
  const std::vector<double> parts = MonotoneParts(piece.coefficients);
  auto node = std::upper_bound(values_.begin(), values_.end(), *least);
  for (; node != values_.end() && *node < *largest; ++node) {
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      if ((piece.At(parts[i]) < *node) != (piece.At(parts[i + 1]) < *node))
        at.push_back(PositionOf(piece, parts[i], parts[i + 1], *node));
    }
  }
  std::sort(at.begin(), at.end());
  at.push_back(1.0);
  return at;
}

double TransferFunction::Integral(const CubicPiece& piece) const {
  constexpr double kGauss = 0.21132486540518712;  // (1 - 1 / sqrt 3) / 2
  const std::array<double, 4>& b = piece.coefficients;
  const double length = piece.end - piece.begin;
  const auto [least, largest] = std::minmax_element(b.begin(), b.end());
  if (IsLinear(*least, *largest)) return length * Extinction(0.25 * (b[0] + b[1] + b[2] + b[3]));
  double sum = 0.0;
  const std::vector<double> at = Crossings(piece);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    // Two Gauss points are exact for a linear function of a cubic.
    const double inside = kGauss * (at[i + 1] - at[i]);
    sum += 0.5 * (at[i + 1] - at[i]) *
           (Extinction(piece.At(at[i] + inside)) + Extinction(piece.At(at[i + 1] - inside)));
  }
  return length * sum;
}

}  // namespace alpenglow::renderer
