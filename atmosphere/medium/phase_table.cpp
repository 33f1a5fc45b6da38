// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include "atmosphere/base/csv_reader.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/text_file.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kGreatestPhase_per_sr = 1e12;
constexpr double kLastNode = static_cast<double>(PhaseTable::kNodes - 1);

double AngleAt(double position) {
  const double s = position / kLastNode;
  return kPi * s * s * s;
}

// Returns the solid angle per node: 2 pi sin(theta) d(theta)/ds ds.
double Measure(double position) {
  const double s = position / kLastNode;
  return 6.0 * kPi * kPi * s * s * std::sin(kPi * s * s * s) / kLastNode;
}

// Integrates over the first `share` of a cell, with four Gauss nodes.
template <typename Function>
double IntegralOverCell(std::size_t cell, double share, const Function& function) {
  const GaussRule& rule = GaussLegendre(4);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double position = static_cast<double>(cell) + share * rule.node[i];
    sum += rule.weight[i] * function(position) * Measure(position);
  }
  return sum * share;
}

void RequireSamples(const std::vector<double>& angle_deg, const std::vector<double>& per_sr) {
  if (angle_deg.size() < 5 || angle_deg.size() != per_sr.size()) {
    throw InputError(
        fmt::format("phase: {} angles with {} values; there must be at least 5 of both",
                    angle_deg.size(), per_sr.size()));
  }
  if (angle_deg.front() != 0.0 || angle_deg.back() != 180.0) {
    throw InputError(fmt::format("phase: angles from {} to {} degrees; they must run from 0 to 180",
                                 angle_deg.front(), angle_deg.back()));
  }
  for (std::size_t i = 0; i < per_sr.size(); ++i) {
    if (i > 0 && !(angle_deg[i] > angle_deg[i - 1])) {
      throw InputError(fmt::format("phase: {} degrees after {}; angles must strictly ascend",
                                   angle_deg[i], angle_deg[i - 1]));
    }
    if (!(per_sr[i] > 0.0 && per_sr[i] <= kGreatestPhase_per_sr)) {
      throw InputError(fmt::format("phase: {} per sr at {} degrees; it must lie in (0, 1e12]",
                                   per_sr[i], angle_deg[i]));
    }
  }
}

// Returns the slopes of the parabolas through three neighbours; 0 at both ends.
std::vector<double> SlopesOf(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> slope(x.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double before = x[i] - x[i - 1];
    const double after = x[i + 1] - x[i];
    slope[i] = ((y[i] - y[i - 1]) / before * after + (y[i + 1] - y[i]) / after * before) /
               (before + after);
  }
  return slope;
}

// Evaluates the curve through the samples at the nodes.
std::array<double, PhaseTable::kNodes> CurveAtNodes(const std::vector<double>& x,
                                                    const std::vector<double>& value) {
  std::vector<double> y;
  for (const double v : value) y.push_back(std::log(v));
  const std::vector<double> slope = SlopesOf(x, y);
  std::array<double, PhaseTable::kNodes> curve{};
  std::size_t i = 0;
  for (std::size_t node = 0; node < curve.size(); ++node) {
    const double angle = std::min(AngleAt(static_cast<double>(node)) / kRadiansPerDegree, x.back());
    while (i + 2 < x.size() && angle > x[i + 1]) ++i;
    const double width = x[i + 1] - x[i];
    const double t = (angle - x[i]) / width;
    const double u = 1.0 - t;
    curve[node] = std::exp(u * u * ((1.0 + 2.0 * t) * y[i] + t * width * slope[i]) +
                           t * t * ((3.0 - 2.0 * t) * y[i + 1] - u * width * slope[i + 1]));
  }
  return curve;
}

enum Column : std::size_t { kWavelength, kAngle, kValue };
constexpr std::array<std::string_view, 3> kColumns{"wavelength_nm", "angle_deg", "phase_per_sr"};
constexpr double kShortestWavelength_nm = 1.0, kLongestWavelength_nm = 1e6;

using PhaseSamples = std::map<double, std::map<double, double>>;  // by wavelength and angle

PhaseSamples SamplesOf(CsvReader& lines) {
  PhaseSamples samples;
  while (lines.Next()) {
    const double wavelength_nm =
        lines.Number(kWavelength, kShortestWavelength_nm, kLongestWavelength_nm);
    const double angle_deg = lines.Number(kAngle, 0.0, 180.0);
    const double value = lines.Number(kValue, 0.0, kGreatestPhase_per_sr);
    if (!samples[wavelength_nm].emplace(angle_deg, value).second)
      lines.Fail(lines.line(), fmt::format("{} nm has {} degrees twice", wavelength_nm, angle_deg));
  }
  return samples;
}

/// @param name  of the file, in messages.
SpectralPhase SpectralPhaseOf(const PhaseSamples& samples, const std::string& name) {
  SpectralPhase phase;
  for (const auto& [angle, value] : samples.begin()->second) phase.angle_deg.push_back(angle);
  for (const auto& [wavelength, row] : samples) {
    phase.wavelength_nm.push_back(wavelength);
    std::vector<double> angles;
    phase.per_sr.emplace_back();
    for (const auto& [angle, value] : row) {
      angles.push_back(angle);
      phase.per_sr.back().push_back(value);
    }
    if (angles != phase.angle_deg) {
      throw InputError(fmt::format("{}: {} nm has other angles than {} nm; they must be the same",
                                   name, wavelength, phase.wavelength_nm.front()));
    }
    try {
      static_cast<void>(PhaseTable(angles, phase.per_sr.back()));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: at {} nm, {}", name, wavelength, error.what()));
    }
  }
  return phase;
}

}  // namespace

PhaseTable::PhaseTable(std::vector<double> angle_deg, std::vector<double> per_sr)
    : angle_deg_(std::move(angle_deg)), per_sr_(std::move(per_sr)) {
  RequireSamples(angle_deg_, per_sr_);
  node_ = CurveAtNodes(angle_deg_, per_sr_);
  const auto value = [this](double position) { return At(position); };
  for (std::size_t cell = 0; cell + 1 < kNodes; ++cell) {
    share_[cell + 1] = share_[cell] + IntegralOverCell(cell, 1.0, value);
    mean_cosine_ += IntegralOverCell(
        cell, 1.0, [&](double position) { return value(position) * std::cos(AngleAt(position)); });
  }
  integral_ = share_.back();
  if (!(std::abs(integral_ - 1.0) <= kLargestDeviation)) {
    throw InputError(
        fmt::format("phase: the integral over the sphere is {:.4f}; it must be 1 "
                    "within {}",
                    integral_, kLargestDeviation));
  }
  for (double& node : node_) node /= integral_;
  for (double& share : share_) share /= integral_;
  mean_cosine_ /= integral_;
}

double PhaseTable::Position(double cos_scattering) {
  const double angle = std::acos(std::clamp(cos_scattering, -1.0, 1.0));
  return kLastNode * std::cbrt(angle * (1.0 / kPi));
}

double PhaseTable::At(double position) const {
  const auto cell = std::min(static_cast<std::size_t>(position), kNodes - 2);
  return node_[cell] + (position - static_cast<double>(cell)) * (node_[cell + 1] - node_[cell]);
}

double PhaseTable::Quantile(double u) const {
  const double wanted = 1.0 - u;  // fraction of the light scattered by less than the angle
  const auto above = std::upper_bound(share_.begin() + 1, share_.end() - 1, wanted);
  const auto cell = static_cast<std::size_t>(above - share_.begin()) - 1;
  const auto value = [this](double position) { return At(position); };
  double low = 0.0;
  double high = 1.0;
  double share = (wanted - share_[cell]) / (share_[cell + 1] - share_[cell]);
  for (int step = 0; step < 60; ++step) {
    const double excess = share_[cell] + IntegralOverCell(cell, share, value) - wanted;
    (excess > 0.0 ? high : low) = share;
    const double position = static_cast<double>(cell) + share;
    double next = share - excess / (value(position) * Measure(position));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - share) < 1e-13) break;
    share = next;
  }
  return std::cos(AngleAt(static_cast<double>(cell) + share));
}

std::uint64_t PhaseTable::hash() const {
  Fnv1a fnv;
  fnv.Add(angle_deg_);
  fnv.Add(per_sr_);
  return fnv.hash();
}

SpectralPhase SpectralPhaseFromRows(std::span<const double> wavelength_nm,
                                    std::span<const double> angle_deg,
                                    std::span<const double> per_sr) {
  SpectralPhase phase;
  for (std::size_t row = 0; row < per_sr.size(); ++row) {
    if (phase.wavelength_nm.empty() || phase.wavelength_nm.back() != wavelength_nm[row]) {
      phase.wavelength_nm.push_back(wavelength_nm[row]);
      phase.per_sr.emplace_back();
    }
    if (phase.per_sr.size() == 1) phase.angle_deg.push_back(angle_deg[row]);
    phase.per_sr.back().push_back(per_sr[row]);
  }
  return phase;
}

PhaseTable SpectralPhase::At(double wavelength) const {
  const auto above = std::upper_bound(wavelength_nm.begin(), wavelength_nm.end(), wavelength);
  const auto high = static_cast<std::size_t>(above - wavelength_nm.begin());
  if (high == 0) return {angle_deg, per_sr.front()};
  if (high == wavelength_nm.size()) return {angle_deg, per_sr.back()};
  const double share =
      (wavelength - wavelength_nm[high - 1]) / (wavelength_nm[high] - wavelength_nm[high - 1]);
  std::vector<double> values;
  for (std::size_t i = 0; i < angle_deg.size(); ++i) {
    values.push_back((1.0 - share) * per_sr[high - 1][i] + share * per_sr[high][i]);
  }
  return {angle_deg, std::move(values)};
}

SpectralPhase ReadSpectralPhase(const std::filesystem::path& file) {
  const std::string text = ReadTextFile(file);
  if (const auto format = FormatOf(text, text.size()))
    RefuseFormat(file, *format, "phase functions are read as CSV");
  CsvReader lines(text, file, kColumns, {.needed = kColumns.size(), .comments = true});
  return SpectralPhaseOf(SamplesOf(lines), file.string());
}

}  // namespace alpenglow::atmosphere
