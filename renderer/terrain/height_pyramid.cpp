// SPDX-License-Identifier: MIT
#include "renderer/terrain/height_pyramid.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

bool IsWhole(float height_m) {
  return std::isnan(height_m) || (height_m == std::round(height_m) && std::abs(height_m) < 32000);
}

// Returns the binomial mean if both neighbours exist, otherwise the middle value.
float Binomial(float before, float middle, float after) {
  const float mean = 0.25F * before + 0.5F * middle + 0.25F * after;
  return std::isnan(mean) ? middle : mean;
}

// The samples of a level along one axis, as indices into the next finer level.
struct Means {
  struct Mean {
    std::size_t middle;
    bool has_neighbours;
  };
  std::vector<Mean> of;
  std::size_t finer;  // number of samples of the finer level

  Means(int first_sample, int last_sample, int level)
      : finer(static_cast<std::size_t>(LevelAxis(first_sample, last_sample, level - 1).count())) {
    const LevelAxis axis(first_sample, last_sample, level);
    const LevelAxis from(first_sample, last_sample, level - 1);
    const int step = 1 << (level - 1);
    for (int index = 0; index < axis.count(); ++index) {
      const int sample = axis.SampleOf(index);
      of.push_back({static_cast<std::size_t>(from.IndexOf(sample)),
                    sample % (2 * step) == 0 && sample - step >= from.first &&
                        sample + step <= last_sample});
    }
  }
};

// Averages along the rows, then along the columns. On a rim the mean is taken along it, never
// across it.
std::vector<float> Coarser(const LatticeBox& box, int level, const std::vector<float>& finer) {
  const Means columns(box.first_column, box.last_column, level);
  const Means rows(box.first_row, box.last_row, level);
  const std::size_t width = columns.of.size();
  std::vector<float> narrow(width * rows.finer);
  for (std::size_t row = 0; row < rows.finer; ++row) {
    const float* const from = &finer[row * columns.finer];
    for (std::size_t i = 0; i < width; ++i) {
      const auto [at, both] = columns.of[i];
      narrow[row * width + i] = both ? Binomial(from[at - 1], from[at], from[at + 1]) : from[at];
    }
  }
  std::vector<float> means(width * rows.of.size());
  for (std::size_t j = 0; j < rows.of.size(); ++j) {
    const auto [row, both] = rows.of[j];
    const float* const at = &narrow[row * width];
    for (std::size_t i = 0; i < width; ++i)
      means[j * width + i] = both ? Binomial(*(at + i - width), at[i], at[i + width]) : at[i];
  }
  return means;
}

}  // namespace

HeightSamples::HeightSamples(std::vector<float> height_m) {
  if (!std::all_of(height_m.begin(), height_m.end(), IsWhole)) {
    real_m_ = std::move(height_m);
    return;
  }
  whole_m_.reserve(height_m.size());
  for (const float height : height_m)
    whole_m_.push_back(std::isnan(height) ? kNone : static_cast<std::int16_t>(height));
}

HeightPyramid::HeightPyramid(const LatticeBox& box, int level, std::vector<float> height_m)
    : box_(box), finest_(level) {
  const auto samples =
      static_cast<std::size_t>(LevelAxis(box.first_column, box.last_column, level).count() *
                               LevelAxis(box.first_row, box.last_row, level).count());
  ALPENGLOW_ENSURE(height_m.size(), ==, samples);
  const int across = std::max(box.last_column - box.first_column, box.last_row - box.first_row);
  for (int next = level + 1; (1 << next) < 2 * across; ++next) {
    std::vector<float> coarser = Coarser(box, next, height_m);
    levels_.push_back(std::make_shared<const HeightSamples>(std::move(height_m)));
    height_m = std::move(coarser);
  }
  levels_.push_back(std::make_shared<const HeightSamples>(std::move(height_m)));
}

std::size_t HeightPyramid::IndexOf(int level, int column, int row) const {
  const LevelAxis columns(box_.first_column, box_.last_column, level);
  const LevelAxis rows(box_.first_row, box_.last_row, level);
  return static_cast<std::size_t>(rows.IndexOf(row)) * static_cast<std::size_t>(columns.count()) +
         static_cast<std::size_t>(columns.IndexOf(column));
}

HeightPyramid HeightPyramid::From(int level) const {
  HeightPyramid coarser(*this);
  const int most = finest_ + static_cast<int>(levels_.size()) - 1;
  const int wanted = std::clamp(level, finest_, most);
  coarser.levels_.erase(coarser.levels_.begin(), coarser.levels_.begin() + (wanted - finest_));
  coarser.finest_ = wanted;
  return coarser;
}

// Interpolates bilinearly in the finest level.
float HeightPyramid::Between(int column, int row) const {
  const LevelAxis columns(box_.first_column, box_.last_column, finest_);
  const LevelAxis rows(box_.first_row, box_.last_row, finest_);
  struct Span {
    int low, high;
    float share;
  };
  const auto span = [](const LevelAxis& axis, int sample) {
    const int within = std::max(sample, std::min(axis.first, axis.last));
    const int index = std::clamp((within - axis.first) >> axis.level, 0, axis.count() - 1);
    const int low = axis.SampleOf(index);
    const int high = axis.SampleOf(std::min(index + 1, axis.count() - 1));
    return Span{
        low, high,
        high > low ? static_cast<float>(within - low) / static_cast<float>(high - low) : 0.0F};
  };
  const Span x = span(columns, column), y = span(rows, row);
  const auto along = [&](int at_row) {
    const float west = At(finest_, x.low, at_row);
    if (x.share == 0.0F) return west;
    return (1.0F - x.share) * west + x.share * At(finest_, x.high, at_row);
  };
  const float north = along(y.low);
  return y.share == 0.0F ? north : (1.0F - y.share) * north + y.share * along(y.high);
}

float HeightPyramid::At(int level, int column, int row) const {
  const int coarsest = finest_ + static_cast<int>(levels_.size()) - 1;
  if (level < finest_) return Between(column, row);
  const int from = std::min(level, coarsest);
  return levels_[static_cast<std::size_t>(from - finest_)]->at(IndexOf(from, column, row));
}

std::size_t HeightPyramid::bytes() const {
  std::size_t sum = 0;
  for (const auto& level : levels_) sum += level->bytes();
  return sum;
}

std::size_t HeightPyramid::BytesOf(const LatticeBox& box, int level) {
  const double columns = box.last_column - box.first_column + 1.0;
  const double rows = box.last_row - box.first_row + 1.0;
  return static_cast<std::size_t>(4.0 / 3.0 * sizeof(float) * columns * rows *
                                  std::pow(0.25, level));
}

}  // namespace alpenglow::renderer
