// SPDX-License-Identifier: MIT
#include "renderer/relief/height_spline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

// Poles of the inverses of the sampled cubic B-spline (1, 4, 1) / 6, and of the sampled quartic one
// (1, 76, 230, 76, 1) / 384, whose samples are the cell means of a cubic one.
constexpr std::array<double, 1> kPointPoles{-0.2679491924311227};
constexpr std::array<double, 2> kMeanPoles{-0.36134122590022018, -0.013725429297339121};
constexpr int kHorizon = 30;  // samples after which a pole's power is below 1e-13

void CheckGrid(const MetricGrid& grid) {
  if (grid.columns < 1 || grid.rows < 1 ||
      grid.height_m.size() !=
          static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows))
    throw InputError(fmt::format("elevation model: {} x {} samples with {} heights", grid.columns,
                                 grid.rows, grid.height_m.size()));
  for (const double spacing_m : {grid.spacing_east_m, grid.spacing_north_m})
    if (!(spacing_m > 0.0 && std::isfinite(spacing_m)))
      throw InputError(
          fmt::format("elevation model: the spacing is {} m; it must be positive", spacing_m));
  for (std::size_t i = 0; i < grid.height_m.size(); ++i)
    if (!std::isfinite(grid.height_m[i]))
      throw InputError(fmt::format(
          "elevation model: sample {} of row {} has no height; fill voids before adding relief",
          i % static_cast<std::size_t>(grid.columns), i / static_cast<std::size_t>(grid.columns)));
}

/// Filters a line by 1 / (z + z^-1 - pole - 1 / pole), mirrored at both ends, with the gain 1 for
/// constants.
void FilterLine(std::vector<double>& line, double pole) {
  const int last = static_cast<int>(line.size()) - 1;
  if (last == 0) return;
  const auto mirrored = [&](int i) {
    const int period = 2 * last;
    const int k = i % period;
    return line[static_cast<std::size_t>(k > last ? period - k : k)];
  };
  double sum = 0.0, power = 1.0;
  for (int i = 0; i < kHorizon; ++i, power *= pole) sum += power * mirrored(i);
  line[0] = sum;
  for (std::size_t i = 1; i < line.size(); ++i) line[i] += pole * line[i - 1];
  const double before = line[line.size() - 2];
  line.back() = pole / (pole * pole - 1.0) * (line.back() + pole * before);
  for (std::size_t i = line.size() - 1; i-- > 0;) line[i] = pole * (line[i + 1] - line[i]);
  const double gain = (1.0 - pole) * (1.0 - 1.0 / pole);
  for (double& value : line) value *= gain;
}

/// Filters `count` samples that are `stride` apart.
void FilterSamples(std::vector<float>& samples, std::size_t first, std::size_t stride,
                   std::size_t count, std::span<const double> poles) {
  std::vector<double> line(count);
  for (std::size_t i = 0; i < count; ++i)
    line[i] = static_cast<double>(samples[first + i * stride]);
  for (const double pole : poles) FilterLine(line, pole);
  for (std::size_t i = 0; i < count; ++i) samples[first + i * stride] = static_cast<float>(line[i]);
}

/// Weights of four coefficients, and their first and second derivatives.
struct SplineWeights {
  std::array<double, 4> value, slope, bend;
};

SplineWeights SplineWeightsAt(double t) {
  const double s = 1.0 - t;
  return {{s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0,
           (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, t * t * t / 6.0},
          {-0.5 * s * s, -2.0 * t + 1.5 * t * t, 2.0 * s - 1.5 * s * s, 0.5 * t * t},
          {s, 3.0 * t - 2.0, 3.0 * s - 2.0, t}};
}

}  // namespace

HeightSpline::HeightSpline(const MetricGrid& grid, SampleMeaning meaning)
    : columns_(grid.columns),
      rows_(grid.rows),
      spacing_east_m_(grid.spacing_east_m),
      spacing_north_m_(grid.spacing_north_m),
      coefficients_m_(grid.height_m) {
  CheckGrid(grid);
  const auto columns = static_cast<std::size_t>(columns_), rows = static_cast<std::size_t>(rows_);
  const std::span<const double> poles =
      meaning == SampleMeaning::kPoints ? std::span<const double>(kPointPoles) : kMeanPoles;
  for (std::size_t row = 0; row < rows; ++row)
    FilterSamples(coefficients_m_, row * columns, 1, columns, poles);
  for (std::size_t column = 0; column < columns; ++column)
    FilterSamples(coefficients_m_, column, columns, rows, poles);
}

double HeightSpline::Coefficient(int column, int row) const {
  const auto mirrored = [](int i, int last) {
    const int folded = i < 0 ? -i : i > last ? 2 * last - i : i;
    return static_cast<std::size_t>(std::clamp(folded, 0, last));
  };
  return static_cast<double>(
      coefficients_m_[mirrored(row, rows_ - 1) * static_cast<std::size_t>(columns_) +
                      mirrored(column, columns_ - 1)]);
}

ModelAt<double> HeightSpline::At(double east_m, double north_m) const {
  const double x = std::clamp(east_m / spacing_east_m_, -0.5, columns_ - 0.5);
  const double y = std::clamp(-north_m / spacing_north_m_, -0.5, rows_ - 0.5);
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const SplineWeights of_x = SplineWeightsAt(x - column), of_y = SplineWeightsAt(y - row);
  ModelAt<double> at;
  for (int j = 0; j < 4; ++j) {
    double value = 0.0, slope = 0.0, bend = 0.0;
    for (int i = 0; i < 4; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double c = Coefficient(column - 1 + i, row - 1 + j);
      value += of_x.value[k] * c;
      slope += of_x.slope[k] * c;
      bend += of_x.bend[k] * c;
    }
    const auto k = static_cast<std::size_t>(j);
    at.height_m += of_y.value[k] * value;
    at.slope_east += of_y.value[k] * slope / spacing_east_m_;
    at.slope_north -= of_y.slope[k] * value / spacing_north_m_;
    at.bend_east_per_m += of_y.value[k] * bend / (spacing_east_m_ * spacing_east_m_);
    at.bend_across_per_m -= of_y.slope[k] * slope / (spacing_east_m_ * spacing_north_m_);
    at.bend_north_per_m += of_y.bend[k] * value / (spacing_north_m_ * spacing_north_m_);
  }
  return at;
}

}  // namespace alpenglow::renderer
