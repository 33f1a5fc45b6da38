// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_grid_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kMetresOfKilometre = 1000.0;
constexpr float kRadiusWithoutCloud_um = 10.0F;
constexpr double kMostGridPoints = 2e8;

/// Points of a file.
struct PointGrid {
  std::array<int, 3> count{};
  glm::dvec2 spacing_m{0.0};
  std::vector<double> altitudes_m;
  CloudSamples samples;  // at the points, x fastest

  [[nodiscard]] std::size_t Layer() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
  }
};

class PointGridReader {
 public:
  explicit PointGridReader(const std::filesystem::path& file) : file_(file), stream_(file) {
    if (!stream_ || std::filesystem::is_directory(file)) RefuseFile(file, "cannot be read");
  }

  [[nodiscard]] PointGrid Read() {
    PointGrid grid;
    constexpr std::array kCounts{"nx", "ny", "nz"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      grid.count[axis] = static_cast<int>(Whole(kCounts[axis], Next(kCounts[axis]), 2.0, 8192.0));
    }
    CheckPoints(grid.count);
    grid.spacing_m.x = kMetresOfKilometre * InRange("dx", Next("dx"), 1e-6, 100.0);
    grid.spacing_m.y = kMetresOfKilometre * InRange("dy", Next("dy"), 1e-6, 100.0);
    for (int level = 0; level < grid.count[2]; ++level) {
      const double z = kMetresOfKilometre * InRange("z", Next("z"), -1.0, 100.0);
      if (level > 0 && z <= grid.altitudes_m.back()) Fail("the altitudes do not ascend");
      grid.altitudes_m.push_back(z);
    }
    if (!words_.empty()) Fail("more numbers than nz altitudes");
    ReadPoints(grid);
    return grid;
  }

 private:
  [[noreturn]] void Fail(std::string_view fault) const {
    throw InputError(fmt::format("{}:{}: {}", file_.string(), line_number_, fault));
  }

  /// Reads the next line with words; returns false at the end of the file.
  bool NextLine() {
    while (std::getline(stream_, line_)) {
      ++line_number_;
      const std::string_view text = std::string_view(line_).substr(0, line_.find_first_of("#!"));
      words_ = WordsOf(text);
      std::reverse(words_.begin(), words_.end());  // the next word is the last
      if (!words_.empty()) return true;
    }
    if (stream_.bad()) RefuseFile(file_, "cannot be read to its end");
    return false;
  }

  /// Returns the next word of the header.
  [[nodiscard]] std::string_view Next(std::string_view name) {
    if (words_.empty() && !NextLine()) Fail(fmt::format("the file ends before {}", name));
    const std::string_view word = words_.back();
    words_.pop_back();
    return word;
  }

  [[nodiscard]] double InRange(std::string_view name, std::string_view word, double low,
                               double high) const {
    const std::optional<double> value = ParseNumber(word);
    if (!value || !(*value >= low && *value <= high)) {
      Fail(fmt::format("{} is \"{}\"; it must be a number in [{}, {}]", name, Printable(word), low,
                       high));
    }
    return *value;
  }
  [[nodiscard]] double Whole(std::string_view name, std::string_view word, double low,
                             double high) const {
    const double value = InRange(name, word, low, high);
    if (value != std::floor(value)) {
      Fail(fmt::format("{} is {}; it must be a whole number", name, value));
    }
    return value;
  }

  void CheckPoints(const std::array<int, 3>& count) const {
    const double points = static_cast<double>(count[0]) * count[1] * count[2];
    if (points > kMostGridPoints) {
      Fail(fmt::format("{} x {} x {} points; there may be {} at most", count[0], count[1], count[2],
                       kMostGridPoints));
    }
  }

  void ReadPoints(PointGrid& grid) {
    const std::size_t points = grid.Layer() * static_cast<std::size_t>(grid.count[2]);
    grid.samples.extinction_per_m.assign(points, 0.0F);
    grid.samples.effective_radius_um.assign(points, kRadiusWithoutCloud_um);
    std::vector<bool> is_known(points);
    while (NextLine()) {
      if (words_.size() != 4 && words_.size() != 5) {
        Fail(fmt::format("{} numbers; a line has i, j, k, the extinction and possibly the radius",
                         words_.size()));
      }
      std::size_t point = 0, stride = 1;
      constexpr std::array kIndices{"i", "j", "k"};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double index = Whole(kIndices[axis], Next(kIndices[axis]), 1.0, grid.count[axis]);
        point += stride * (static_cast<std::size_t>(index) - 1);
        stride *= static_cast<std::size_t>(grid.count[axis]);
      }
      if (is_known[point]) Fail("this point has a line already");
      is_known[point] = true;
      const double extinction = InRange("extinction", Next("extinction"), 0.0, 1e6);
      grid.samples.extinction_per_m[point] = static_cast<float>(extinction / kMetresOfKilometre);
      if (words_.empty()) continue;
      const double least = extinction > 0.0 ? 0.01 : 0.0;
      const double radius = InRange("effective radius", Next("radius"), least, 1e4);
      if (radius > 0.0) grid.samples.effective_radius_um[point] = static_cast<float>(radius);
    }
  }

  std::filesystem::path file_;
  std::ifstream stream_;
  std::string line_;
  int line_number_ = 0;
  std::vector<std::string_view> words_;
};

/// Returns samples on equidistant levels.
/// @param values  of the points of the file.
std::vector<float> OnLevels(const PointGrid& grid, const std::vector<float>& values, int levels,
                            double step_m) {
  const std::size_t layer = grid.Layer();
  std::vector<float> samples;
  samples.reserve(layer * static_cast<std::size_t>(levels));
  std::size_t below = 0;
  for (int level = 0; level < levels; ++level) {
    const double z = std::min(grid.altitudes_m.front() + step_m * level, grid.altitudes_m.back());
    while (below + 2 < grid.altitudes_m.size() && grid.altitudes_m[below + 1] <= z) ++below;
    const double low = grid.altitudes_m[below], high = grid.altitudes_m[below + 1];
    const auto share = static_cast<float>((z - low) / (high - low));
    for (std::size_t i = 0; i < layer; ++i) {
      const float under = values[below * layer + i], over = values[(below + 1) * layer + i];
      samples.push_back((1.0F - share) * under + share * over);
    }
  }
  return samples;
}

}  // namespace

CloudField ReadCloudGrid(const std::filesystem::path& file, bool is_periodic) {
  PointGrid grid = PointGridReader(file).Read();
  const double height = grid.altitudes_m.back() - grid.altitudes_m.front();
  double nearest = height;
  for (std::size_t i = 1; i < grid.altitudes_m.size(); ++i) {
    nearest = std::min(nearest, grid.altitudes_m[i] - grid.altitudes_m[i - 1]);
  }
  const double intervals = std::ceil(height / nearest * (1.0 - 1e-9));
  if (intervals > 8192.0) {
    RefuseFile(file, fmt::format("altitudes {} m apart in {} m; at most 8192 levels are stored",
                                 nearest, height));
  }
  CloudLattice lattice;
  lattice.is_periodic = is_periodic;
  const int ends = is_periodic ? 0 : 1;
  lattice.voxels = {grid.count[0] - ends, grid.count[1] - ends, static_cast<int>(intervals)};
  lattice.voxel_m = glm::dvec3(grid.spacing_m, height / intervals);
  lattice.origin_m = {0.0, 0.0, grid.altitudes_m.front()};
  for (std::vector<float>* values :
       {&grid.samples.extinction_per_m, &grid.samples.effective_radius_um}) {
    *values = OnLevels(grid, *values, lattice.voxels[2] + 1, lattice.voxel_m.z);
  }
  return {lattice, grid.samples};
}

}  // namespace alpenglow::renderer
