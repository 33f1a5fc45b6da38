// SPDX-License-Identifier: MIT
// Measures relief finer than an elevation model (renderer/relief/README.md):
//   relief_study [PICTURE.png [MODEL [EAST_KM SOUTH_KM]]]
// MODEL is an elevation model; without one it is the built-in range. The study takes 12 km x 12 km,
// EAST_KM and SOUTH_KM from the north-western sample. It prints slopes by octave of wavelength, of
// the model and of one with a third of its resolution, both with and without relief; reflectance by
// footprint; the mean over samples; times. The picture shows 1.3 km x 1.3 km around the highest
// place from above: the model with the cover of the relief at the left, with relief at the right.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <ctime>
#include <exception>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/image/png.h"
#include "renderer/elevation/elevation.h"
#include "renderer/procedural_mountains/procedural_mountains.h"
#include "renderer/relief/detailed_ground.h"
#include "renderer/surface/surface.h"
#include "tests/bench/processor_time.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSide_m = 12000.0;
constexpr double kMetresPerRadian = 6371000.0;

/// Returns the samples of a square of kSide_m.
MetricGrid WindowOf(const ElevationGrid& grid, double east_m, double south_m) {
  MetricGrid window;
  const double latitude = grid.LatitudeOfRow(grid.rows / 2);
  window.spacing_north_m = grid.step_lat_rad * kMetresPerRadian;
  window.spacing_east_m = grid.step_lon_rad * kMetresPerRadian * std::cos(latitude);
  const int first_column = static_cast<int>(east_m / window.spacing_east_m);
  const int first_row = static_cast<int>(south_m / window.spacing_north_m);
  window.columns = static_cast<int>(kSide_m / window.spacing_east_m);
  window.rows = static_cast<int>(kSide_m / window.spacing_north_m);
  if (first_column < 0 || first_row < 0 || first_column + window.columns > grid.columns ||
      first_row + window.rows > grid.rows)
    throw InputError("the square of 12 km lies outside the model");
  for (int row = 0; row < window.rows; ++row)
    for (int column = 0; column < window.columns; ++column)
      window.height_m.push_back(grid.at(first_row + row, first_column + column));
  return window;
}

/// Returns the means of 3 x 3 samples. Their first sample is the second one of the finer grid.
MetricGrid Coarser(const MetricGrid& fine) {
  MetricGrid coarse{
      fine.columns / 3, fine.rows / 3, 3.0 * fine.spacing_east_m, 3.0 * fine.spacing_north_m, {}};
  for (int row = 0; row < coarse.rows; ++row) {
    for (int column = 0; column < coarse.columns; ++column) {
      float sum = 0.0F;
      for (int k = 0; k < 9; ++k)
        sum += fine.height_m[static_cast<std::size_t>((3 * row + k / 3) * fine.columns +
                                                      3 * column + k % 3)];
      coarse.height_m.push_back(sum / 9.0F);
    }
  }
  return coarse;
}

constexpr std::size_t kPoints = 1024;
constexpr double kStep_m = 2.0;
constexpr int kOctaves = 8;  // of wavelength: 1024-512 m, ..., 8-4 m

void Transform(std::vector<std::complex<double>>& values) {
  const std::size_t count = values.size();
  if (count == 1) return;
  std::vector<std::complex<double>> even, odd;
  for (std::size_t i = 0; i < count; i += 2) {
    even.push_back(values[i]);
    odd.push_back(values[i + 1]);
  }
  Transform(even);
  Transform(odd);
  for (std::size_t k = 0; k < count / 2; ++k) {
    const auto turned = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(k) /
                                            static_cast<double>(count)) *
                        odd[k];
    values[k] = even[k] + turned;
    values[k + count / 2] = even[k] - turned;
  }
}

using Octaves = std::array<double, kOctaves>;

/// Returns mean squares of the slope along a profile by octave of wavelength.
Octaves SquareSlopes(const std::vector<double>& height_m) {
  std::vector<std::complex<double>> slope(kPoints);
  double window_power = 0.0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double window =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / kPoints);
    slope[i] = window * (height_m[i + 1] - height_m[i]) / kStep_m;
    window_power += window * window;
  }
  Transform(slope);
  Octaves sum{};
  for (std::size_t k = 1; k < kPoints / 2; ++k) {
    const double wave_m = kPoints * kStep_m / static_cast<double>(k);
    const int octave = static_cast<int>(std::floor(std::log2(1024.0 / wave_m)));
    if (octave >= 0 && octave < kOctaves)
      sum[static_cast<std::size_t>(octave)] += 2.0 * std::norm(slope[k]) / (kPoints * window_power);
  }
  return sum;
}

/// Sums over the profiles of a kind of ground.
struct Spectrum {
  Octaves squares{};
  int profiles = 0;

  void Add(const Octaves& of_profile) {
    for (std::size_t k = 0; k < kOctaves; ++k) squares[k] += of_profile[k];
    ++profiles;
  }
  [[nodiscard]] std::string Line(const char* name) const {
    std::string line = fmt::format("{:38} {:4}", name, profiles);
    for (const double square : squares)
      line += fmt::format(" {:6.3f}", std::sqrt(square / std::max(profiles, 1)));
    return line;
  }
};

/// Calls `use` with the profiles of a window: start, and step to the east and north.
template <typename Use>
void ForEachProfile(const Use& use) {
  for (int line = 0; line < 60; ++line) {
    const double across_m = 1000.0 + 10000.0 * (line + 0.5) / 60.0;
    for (const double start_m : {1500.0, 4500.0, 7500.0}) {
      use(start_m, -across_m, kStep_m, 0.0);
      use(across_m, -start_m, 0.0, -kStep_m);
    }
  }
}

void PrintSpectra(const DetailedGround& ground, const DetailedGround& coarse) {
  fmt::print("rms slope along profiles by octave of wavelength [m]\n{:38} {:>4}", "ground", "n");
  for (int k = 0; k < kOctaves; ++k) fmt::print(" {:>6}", fmt::format("-{}", 512 >> k));
  fmt::print("\n");
  const double shift_m = ground.model().spacing_m();  // of the coarser model's first sample
  std::array<std::array<Spectrum, 4>, 2> spectra;
  ForEachProfile([&](double east_m, double north_m, double step_east, double step_north) {
    std::array<std::vector<double>, 4> height;
    double steepness = 0.0;
    for (std::size_t i = 0; i <= kPoints; ++i) {
      const double x = east_m + static_cast<double>(i) * step_east;
      const double y = north_m + static_cast<double>(i) * step_north;
      const ModelAt<double> model = ground.model().At(x, y);
      steepness += std::hypot(model.slope_east, model.slope_north) / (kPoints + 1);
      const double coarse_m = coarse.model().At(x - shift_m, y + shift_m).height_m;
      height[0].push_back(model.height_m);
      height[1].push_back(model.height_m + ground.HeightAt(x, y, kStep_m).height_m);
      height[2].push_back(coarse_m);
      height[3].push_back(coarse_m + coarse.HeightAt(x - shift_m, y + shift_m, kStep_m).height_m);
    }
    if (steepness > 0.3 && steepness < 0.5) return;
    for (std::size_t k = 0; k < 4; ++k)
      spectra[steepness < 0.4 ? 0 : 1][k].Add(SquareSlopes(height[k]));
  });
  const std::array<const char*, 4> names{"model", "model with relief", "3 x coarser model",
                                         "3 x coarser model with relief"};
  for (const int steep : {1, 0})
    for (std::size_t k = 0; k < 4; ++k)
      fmt::print("{}\n", spectra[static_cast<std::size_t>(steep)][k].Line(
                             fmt::format("{}, {}", steep ? "steep" : "gentle", names[k]).c_str()));
}

double GreenAlbedo(const SurfaceShares<double>& shares,
                   const MountainSurface::Materials& materials) {
  const auto green = [](const alpenglow::Spectrum& bands) { return static_cast<double>(bands[0]); };
  return (shares.bedrock + shares.scree) * green(materials.rock) +
         shares.meadow * green(materials.meadow) + shares.forest * green(materials.conifers) +
         shares.snow * green(materials.snow);
}

constexpr std::array<double, 8> kFootprints_m{0.1, 0.5, 2.0, 5.0, 10.0, 30.0, 60.0, 100.0};

/// Returns a number below a size, from a rule that covers it evenly.
double Spread(int i, double ratio, double size) {
  const double turns = i * ratio;
  return size * (turns - std::floor(turns));
}

void PrintReflectance(const DetailedGround& ground, const MountainCover& cover) {
  const MountainSurface surface(std::vector<double>{550.0}, cover);
  constexpr std::array<const char*, 5> kKinds{"rock and scree", "meadow", "forest", "snow's edge",
                                              "all"};
  std::array<std::array<double, kFootprints_m.size()>, 5> sums{};
  std::array<int, 5> counts{};
  for (int i = 0; i < 20000; ++i) {
    const double x = 500.0 + Spread(i, 0.7548776662466927, 11000.0);
    const double y = -500.0 - Spread(i, 0.5698402909980532, 11000.0);
    std::array<double, kFootprints_m.size()> albedo;
    const SurfaceShares<double> wide = ground.HeightAt(x, y, 60.0).shares;
    for (std::size_t k = 0; k < albedo.size(); ++k)
      albedo[k] = GreenAlbedo(ground.HeightAt(x, y, kFootprints_m[k]).shares, surface.materials());
    const std::size_t kind = wide.snow > 0.2 && wide.snow < 0.8 ? 3
                             : wide.bedrock + wide.scree > 0.6  ? 0
                             : wide.meadow > 0.6                ? 1
                             : wide.forest > 0.6                ? 2
                                                                : 4;
    for (std::size_t to = 0; to < 5; ++to) {
      if (to != kind && to != 4) continue;  // the last one has all
      for (std::size_t k = 0; k < albedo.size(); ++k) sums[to][k] += albedo[k];
      ++counts[to];
    }
  }
  fmt::print("\nmean reflectance (550 nm) by footprint [m]\n{:20} {:>6}", "kind at 60 m", "n");
  for (const double footprint_m : kFootprints_m) fmt::print(" {:>6}", footprint_m);
  fmt::print("\n");
  for (std::size_t kind = 0; kind < 5; ++kind) {
    fmt::print("{:20} {:6}", kKinds[kind], counts[kind]);
    for (const double sum : sums[kind]) fmt::print(" {:6.4f}", sum / std::max(counts[kind], 1));
    fmt::print("\n");
  }
}

void PrintMeans(const DetailedGround& ground) {
  double squares = 0.0, mean_squares = 0.0, largest = 0.0, total = 0.0;
  constexpr int kCells = 400, kPerAxis = 10;
  for (int i = 0; i < kCells; ++i) {
    const int column =
        5 + static_cast<int>(Spread(i, 0.7548776662466927, ground.model().columns() - 10.0));
    const int row =
        5 + static_cast<int>(Spread(i, 0.5698402909980532, ground.model().rows() - 10.0));
    double mean = 0.0;
    for (int k = 0; k < kPerAxis * kPerAxis; ++k) {
      const double x = (column - 0.5 + (k % kPerAxis + 0.5) / kPerAxis);
      const double y = (row - 0.5 + (k / kPerAxis + 0.5) / kPerAxis);
      const double height = ground
                                .HeightAt(x * ground.model().spacing_east_m(),
                                          -y * ground.model().spacing_north_m(), 2.0)
                                .height_m;
      mean += height / (kPerAxis * kPerAxis);
      squares += height * height;
      largest = std::max(largest, std::abs(height));
    }
    total += mean;
    mean_squares += mean * mean;
  }
  fmt::print(
      "\nrelief above the model: {:.2f} m rms, largest {:.1f} m; mean over a sample's cell "
      "{:.3f} m, {:.2f} m rms\n",
      std::sqrt(squares / (kCells * kPerAxis * kPerAxis)), largest, total / kCells,
      std::sqrt(mean_squares / kCells));
}

void PrintTimes(const DetailedGround& ground, const MountainCover& cover) {
  fmt::print("\ntime of one evaluation in float [ns] by footprint [m]\n{:20}", "");
  constexpr std::array<double, 6> kTimed_m{1.0, 2.0, 5.0, 20.0, 60.0, 200.0};
  for (const double footprint_m : kTimed_m) fmt::print(" {:>6}", footprint_m);
  for (const bool with_slope : {false, true}) {
    fmt::print("\n{:20}", with_slope ? "with gradient" : "height and shares");
    for (const double footprint_m : kTimed_m) {
      constexpr int kPlaces = 20000;
      std::vector<BlockPlace<float>> places;
      std::vector<ModelAt<float>> models;
      for (int i = 0; i < kPlaces; ++i) {
        const double x = Spread(i, 0.7548776662466927, kSide_m);
        const double y = -Spread(i, 0.5698402909980532, kSide_m);
        const ModelAt<double> model = ground.model().At(x, y);
        places.push_back(BlockPlaceOf<float>(x, y));
        models.push_back({static_cast<float>(model.height_m), static_cast<float>(model.slope_east),
                          static_cast<float>(model.slope_north),
                          static_cast<float>(model.bend_east_per_m),
                          static_cast<float>(model.bend_across_per_m),
                          static_cast<float>(model.bend_north_per_m)});
      }
      const ReliefScale scale{ground.model().spacing_m(), footprint_m};
      double sum = 0.0;
      const std::clock_t begin = std::clock();
      for (std::size_t i = 0; i < kPlaces; ++i)
        sum += static_cast<double>((with_slope ? SlopedReliefAt(places[i], models[i], cover, scale)
                                               : ReliefAt(places[i], models[i], cover, scale))
                                       .height_m);
      const double ns = 1e9 * tests::ProcessorSecondsSince(begin) / kPlaces;
      fmt::print(" {:6.0f}", std::isfinite(sum) ? ns : -1.0);
    }
  }
  fmt::print("\n");
}

constexpr int kHalf = 640;  // pixels of one half, 2 m each

std::array<double, 3> ColourOf(const SurfaceShares<double>& shares) {
  const std::array<double, 5> share{shares.bedrock, shares.scree, shares.meadow, shares.forest,
                                    shares.snow};
  constexpr std::array<std::array<double, 3>, 5> kColours{{{0.15, 0.145, 0.14},
                                                           {0.24, 0.23, 0.21},
                                                           {0.098, 0.115, 0.055},
                                                           {0.038, 0.054, 0.027},
                                                           {0.82, 0.84, 0.86}}};
  std::array<double, 3> colour{};
  for (std::size_t k = 0; k < 5; ++k)
    for (std::size_t c = 0; c < 3; ++c) colour[c] += share[k] * kColours[k][c];
  return colour;
}

/// Returns the highest place that is 1 km or more inside the rim.
std::array<double, 2> HighestOf(const HeightSpline& model) {
  std::array<double, 2> place{};
  double highest_m = -1e9;
  for (double x = 1000.0; x < kSide_m - 1000.0; x += 50.0) {
    for (double y = -1000.0; y > 1000.0 - kSide_m; y -= 50.0) {
      const double height_m = model.At(x, y).height_m;
      if (height_m <= highest_m) continue;
      highest_m = height_m;
      place = {x, y};
    }
  }
  return place;
}

void WritePicture(const DetailedGround& ground, const std::string& file) {
  lut::DisplayImage image{2 * kHalf, kHalf, {}};
  const auto [middle_east_m, middle_north_m] = HighestOf(ground.model());
  for (int row = 0; row < kHalf; ++row) {
    for (int column = 0; column < 2 * kHalf; ++column) {
      const double x = middle_east_m + 2.0 * (column % kHalf) - kHalf;
      const double y = middle_north_m - 2.0 * row + kHalf;
      const Relief<double> at = ground.At(x, y, 2.0);
      const ModelAt<double> model = ground.model().At(x, y);
      const bool is_model = column < kHalf;
      const double gx = is_model ? model.slope_east : at.slope_east;
      const double gy = is_model ? model.slope_north : at.slope_north;
      // The sun is in the west-north-west, 40 degrees high.
      const double cosine = (0.66 * gx - 0.38 * gy + 0.64) / std::sqrt(1.0 + gx * gx + gy * gy);
      const double light = 0.15 + std::max(cosine, 0.0);
      for (const double albedo : ColourOf(at.shares)) {
        const double value = std::pow(std::clamp(1.1 * albedo * light, 0.0, 1.0), 1.0 / 2.2);
        image.rgb.push_back(static_cast<std::uint8_t>(255.0 * value + 0.5));
      }
    }
  }
  lut::WritePng(file, image, {});
}

double NumberOf(const std::string& text) {
  const std::optional<double> number = ParseNumber(text);
  if (!number) throw InputError(fmt::format("\"{}\" is no number of kilometres", text));
  return *number;
}

int Run(const std::vector<std::string>& arguments) {
  const bool has_file = arguments.size() > 1;
  const ElevationGrid grid = has_file ? ReadElevation(arguments[1], VoidPolicy::kFill).grid
                                      : ProceduralMountains(PlaceFromRadians(0.813, 0.14, 0.0));
  const auto kilometres = [&](std::size_t i, double otherwise) {
    return 1000.0 * (arguments.size() > i ? NumberOf(arguments[i]) : otherwise);
  };
  const MetricGrid window = WindowOf(grid, kilometres(2, 29.0), kilometres(3, 32.0));
  const MountainCover cover{1900.0, 2600.0};
  const SampleMeaning meaning = has_file ? SampleMeaning::kCellMeans : SampleMeaning::kPoints;
  const DetailedGround ground(window, meaning, cover);
  const DetailedGround coarse(Coarser(window), SampleMeaning::kCellMeans, cover);
  fmt::print("model: {} x {} samples, {:.1f} m x {:.1f} m\n", window.columns, window.rows,
             window.spacing_east_m, window.spacing_north_m);
  if (!arguments.empty()) WritePicture(ground, arguments[0]);
  PrintSpectra(ground, coarse);
  PrintReflectance(ground, cover);
  PrintMeans(ground);
  PrintTimes(ground, cover);
  return 0;
}

}  // namespace
}  // namespace alpenglow::renderer

int main(int count, char** arguments) {
  try {
    return alpenglow::renderer::Run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "relief_study: {}\n", error.what());
    return 3;
  }
}
