// SPDX-License-Identifier: MIT
#include "renderer/procedural_mountains/land.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "lut/cli/output_file.h"
#include "renderer/layer.h"
#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

std::array<double, 4> CubicWeights(double t) {
  return {((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
          ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t};
}

double Slope(const Land& land, int row, int column) {
  const double east = static_cast<double>(land.at(row, column + 1) - land.at(row, column - 1));
  const double south = static_cast<double>(land.at(row + 1, column) - land.at(row - 1, column));
  return std::sqrt(east * east + south * south) / (2.0 * land.spacing_m);
}

double BinomialMean(const Land& land, int row, int column) {
  double sum = 0.0;
  for (int r = -1; r <= 1; ++r) {
    for (int c = -1; c <= 1; ++c) {
      sum +=
          (2 - std::abs(r)) * (2 - std::abs(c)) * static_cast<double>(land.at(row + r, column + c));
    }
  }
  return sum / 16.0;
}

// Visits every sample that is not on the rim from many threads: visit(row, column).
template <typename Visit>
void ForInside(int size, const Visit& visit) {
  tbb::parallel_for(1, std::max(size - 1, 1), [&](int row) {
    for (int column = 1; column < size - 1; ++column) visit(row, column);
  });
}

// The chains strike east-north-east. `along` runs along them, `across` runs southwards across them.
struct StrikeFrame {
  double along_km;
  double across_km;
};

constexpr double kCosStrike = 0.96;
constexpr double kSinStrike = 0.28;

StrikeFrame ToStrikeFrame(double x_km, double y_km) {
  return {kCosStrike * x_km + kSinStrike * y_km, kSinStrike * x_km - kCosStrike * y_km};
}

struct Chain {
  double across_km;
  double half_width_km;
  double uplift;
};
constexpr std::array<Chain, 5> kChains{{
    {-18.0, 6.5, 0.44},
    {-6.5, 7.0, 0.3},
    {6.5, 8.0, 0.5},
    {19.0, 8.0, 0.65},
    {31.0, 7.5, 0.85},
}};

struct Summit {
  double along_km;
  double across_km;
  double radius_km;
  double uplift;
};
constexpr std::array<Summit, 7> kSummits{{
    {4.0, 6.0, 4.8, 2.0},
    {-13.0, 6.5, 4.0, 0.45},
    {-12.0, -6.0, 3.5, 0.35},
    {-6.0, 18.0, 4.5, 0.35},
    {14.0, 19.0, 4.5, 0.7},
    {1.0, 30.5, 4.5, 0.9},
    {14.0, 30.0, 4.5, 1.0},
}};

// Returns 1 in the middle, 0 from distance 1 on, smooth at both.
double Bump(double distance) {
  const double inside = std::max(0.0, 1.0 - distance * distance);
  return inside * inside;
}

double SmoothStep(double t) {
  const double clamped = std::clamp(t, 0.0, 1.0);
  return clamped * clamped * (3.0 - 2.0 * clamped);
}

// Returns the uplift of the chains, which meander and vary along their strike.
double ChainUplift(const StrikeFrame& place, std::uint32_t range_seed) {
  double uplift = 0.0;
  for (std::size_t i = 0; i < kChains.size(); ++i) {
    const Chain& chain = kChains[i];
    const auto seed = range_seed + static_cast<std::uint32_t>(100 + 10 * i);
    constexpr double kWander_km = 3.5;
    constexpr double kOctaves_km = kWander_km * (1.0 + 0.5 + 0.25);  // no noise reaches 1
    const double from_chain_km = place.across_km - chain.across_km;
    if (std::abs(from_chain_km) > chain.half_width_km + kOctaves_km) continue;
    const double wander = kWander_km * FractalNoise(place.along_km / 17.0, 0.3, 3, seed);
    const double offset = (from_chain_km - wander) / chain.half_width_km;
    if (std::abs(offset) >= 1.0) continue;
    const double strength = 1.0 + 0.9 * FractalNoise(place.along_km / 9.0, 0.7, 2, seed + 5);
    uplift += chain.uplift * std::clamp(strength, 0.35, 1.4) * Bump(offset);
  }
  return uplift;
}

double SummitUplift(const StrikeFrame& place) {
  double uplift = 0.0;
  for (const Summit& summit : kSummits) {
    const double along = (place.along_km - summit.along_km) / summit.radius_km;
    const double across = (place.across_km - summit.across_km) / summit.radius_km;
    uplift += summit.uplift * Bump(std::sqrt(along * along + across * across));
  }
  return uplift;
}

// Returns 0 at the rim, 1 from `width_km` inwards.
double RimFade(double x_km, double y_km, double width_km) {
  return SmoothStep((kRangeHalfWidth_km - std::abs(x_km)) / width_km) *
         SmoothStep((kRangeHalfWidth_km - std::abs(y_km)) / width_km);
}

// Returns the place displaced by noise, so that nothing in the range is straight.
StrikeFrame Warped(double x_km, double y_km, std::uint32_t seed) {
  const double warp_x = 5.5 * FractalNoise(x_km / 17.0, y_km / 17.0, 4, seed + 1);
  const double warp_y = 5.5 * FractalNoise(x_km / 17.0, y_km / 17.0, 4, seed + 2);
  return ToStrikeFrame(x_km + warp_x, y_km + warp_y);
}

// Returns 0 in the northern foreland, 1 from the first chain on.
double South(const StrikeFrame& place) { return SmoothStep((place.across_km + 26.0) / 12.0); }

// Returns the weight of the ground of seed 0: 1 from 2 km south of the view northwards, 0 from 9 km
// south of the view southwards.
double ForelandShare(double y_km) {
  constexpr double kAlike_km = 2.0, kOther_km = 9.0;
  return SmoothStep((y_km - 1e-3 * kRangeViewNorth_m + kOther_km) / (kOther_km - kAlike_km));
}

// Returns the value of a range, blended into the value of seed 0 in the northern foreland.
template <typename Value>
double OverForeland(double y_km, std::uint32_t seed, const Value& value_of) {
  const double foreland = seed == 0 ? 1.0 : ForelandShare(y_km);
  if (foreland == 1.0) return value_of(std::uint32_t{0});
  if (foreland == 0.0) return value_of(seed);
  return std::lerp(value_of(seed), value_of(std::uint32_t{0}), foreland);
}

double UpliftOf(double x_km, double y_km, std::uint32_t seed) {
  const StrikeFrame place = Warped(x_km, y_km, seed);
  const double ridges = RidgedNoise(place.along_km / 13.0, place.across_km / 13.0, 4, seed + 3);
  const double mountains =
      (ChainUplift(place, seed) + SummitUplift(place)) * (0.35 + 1.15 * ridges);
  const double foreland = 0.02 + 0.04 * ridges + 0.05 * South(place);
  return (foreland + mountains) * RimFade(x_km, y_km, 9.0);
}

namespace fs = std::filesystem;

fs::path FileOf(const fs::path& folder, const WantedHeights& wanted) {
  return folder / fmt::format("{}-{:016x}.f32", wanted.name, wanted.fingerprint);
}

bool IsWanted(const std::vector<float>& height_m, const WantedHeights& wanted) {
  return height_m.size() == wanted.count && FingerprintOf(height_m) == wanted.fingerprint;
}

// Returns the heights of a file; nullopt if the file is missing or has other contents.
std::optional<std::vector<float>> Read(const fs::path& file, const WantedHeights& wanted) {
  std::error_code error;
  if (fs::file_size(file, error) != wanted.count * sizeof(float) || error) return std::nullopt;
  std::vector<float> height_m(wanted.count);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(height_m.data()),
              static_cast<std::streamsize>(height_m.size() * sizeof(float)));
  if (!stream || !IsWanted(height_m, wanted)) return std::nullopt;
  return height_m;
}

void RemoveOlder(const fs::path& file, const std::string& name) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(file.parent_path(), error)) {
    const std::string other = entry.path().filename().string();
    const bool is_alike = other.starts_with(name + "-") && other.ends_with(".f32");
    if (is_alike && entry.path() != file) fs::remove(entry.path(), error);
  }
}

void Keep(const fs::path& file, const WantedHeights& wanted, const std::vector<float>& height_m) {
  try {
    fs::create_directories(file.parent_path());
    WriteTextAtomically(
        file, {reinterpret_cast<const char*>(height_m.data()), height_m.size() * sizeof(float)});
    RemoveOlder(file, wanted.name);
  } catch (const OutputError&) {
  } catch (const fs::filesystem_error&) {
    // The next run generates the heights again.
  }
}

}  // namespace

float CubicHeight(const Land& land, double row, double column) {
  const int r = static_cast<int>(std::floor(row));
  const int c = static_cast<int>(std::floor(column));
  const auto row_weights = CubicWeights(row - r);
  const auto column_weights = CubicWeights(column - c);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const int at_row = std::clamp(r + i - 1, 0, land.size - 1);
    double line = 0.0;
    for (int j = 0; j < 4; ++j) {
      const int at_column = std::clamp(c + j - 1, 0, land.size - 1);
      line += column_weights[static_cast<std::size_t>(j)] *
              static_cast<double>(land.at(at_row, at_column));
    }
    sum += row_weights[static_cast<std::size_t>(i)] * line;
  }
  return static_cast<float>(sum);
}

Land Refined(const Land& coarse, double roughness_m, std::uint32_t seed) {
  Land fine{2 * coarse.size, 0.5 * coarse.spacing_m, {}};
  fine.height_m.resize(4 * coarse.height_m.size(), 0.0F);
  ForInside(fine.size, [&](int row, int column) {
    fine.height_m[fine.index(row, column)] =
        CubicHeight(coarse, 0.5 * row - 0.25, 0.5 * column - 0.25) +
        static_cast<float>(roughness_m * (LatticeUniform(column, row, seed) - 0.5));
  });
  return fine;
}

Land WithRibs(const Land& land, double height_m, double wavelength_km, std::uint32_t seed) {
  Land ribbed = land;
  ForInside(land.size, [&](int row, int column) {
    const double slope = Slope(land, row, column);
    const double strength = height_m * std::min(1.0, slope * slope);
    if (strength < 0.01 * height_m) return;
    const auto [x, y] = land.PlaceOf(row, column);
    const double ribs = RidgedNoise(x / wavelength_km, y / wavelength_km, 2, seed) - 0.5;
    ribbed.height_m[land.index(row, column)] += static_cast<float>(strength * ribs);
  });
  return ribbed;
}

Land Softened(const Land& land, const std::vector<float>& weight) {
  Land soft = land;
  ForInside(land.size, [&](int row, int column) {
    const std::size_t sample = land.index(row, column);
    if (weight[sample] == 0.0F) return;
    const auto mean = static_cast<float>(BinomialMean(land, row, column));
    soft.height_m[sample] += weight[sample] * (mean - land.height_m[sample]);
  });
  return soft;
}

Land Bent(const Land& land, double samples, double wavelength_km, std::uint32_t seed) {
  Land bent = land;
  ForInside(land.size, [&](int row, int column) {
    const auto [x, y] = land.PlaceOf(row, column);
    const double u = x / wavelength_km;
    const double v = y / wavelength_km;
    bent.height_m[land.index(row, column)] =
        CubicHeight(land, row + samples * FractalNoise(u, v, 3, seed),
                    column + samples * FractalNoise(u, v, 3, seed + 10));
  });
  return bent;
}

double RelativeUplift(double x_km, double y_km, std::uint32_t seed) {
  return OverForeland(y_km, seed, [&](std::uint32_t of) { return UpliftOf(x_km, y_km, of); });
}

double RelativeErodibility(double x_km, double y_km, std::uint32_t seed) {
  return OverForeland(y_km, seed, [&](std::uint32_t of) {
    return std::clamp(1.0 + 0.9 * FractalNoise(x_km / 6.0, y_km / 6.0, 4, of + 20), 0.5, 2.0);
  });
}

double SteepestSlope(double x_km, double y_km, double relative_uplift, std::uint32_t seed) {
  const double fresh = std::min(1.0, relative_uplift);
  const double layers = OverForeland(y_km, seed, [&](std::uint32_t of) {
    return FractalNoise(x_km / 2.3, y_km / 2.3, 4, of + 30);
  });
  return std::clamp(0.44 + 0.4 * fresh + 0.4 * layers, 0.35, 1.3);
}

double BaseHeight(double x_km, double y_km) { return 450.0 * RimFade(x_km, y_km, 10.0); }

double Alpine(double x_km, double y_km, std::uint32_t seed) {
  return RimFade(x_km, y_km, 9.0) *
         OverForeland(y_km, seed, [&](std::uint32_t of) { return South(Warped(x_km, y_km, of)); });
}

double CrestUnderView(double x_km, double y_km) {
  constexpr double kWhole_km = 0.3, kEnd_km = 6.0;
  const double away_km =
      std::hypot(x_km - 1e-3 * kRangeViewEast_m, y_km - 1e-3 * kRangeViewNorth_m);
  return SmoothStep((kEnd_km - away_km) / (kEnd_km - kWhole_km));
}

std::uint64_t FingerprintOf(const std::vector<float>& height_m) {
  Fnv1a hash;
  for (std::size_t i = 0; i + 1 < height_m.size(); i += 2) {
    const std::uint64_t low = std::bit_cast<std::uint32_t>(height_m[i]);
    const std::uint64_t high = std::bit_cast<std::uint32_t>(height_m[i + 1]);
    hash.Add(low | (high << 32));
  }
  return hash.hash();
}

std::optional<fs::path> CacheFolder() {
  if (const char* const own = std::getenv("ALPENGLOW_CACHE"))
    return *own == '\0' ? std::nullopt : std::optional<fs::path>(own);
  const char* const caches = std::getenv("XDG_CACHE_HOME");
  if (caches != nullptr && *caches == '/') return fs::path(caches) / "alpenglow";
  // Users of services have a home that does not exist: /nonexistent. It must not come into being.
  const char* const home = std::getenv("HOME");
  std::error_code ignored;
  if (home != nullptr && *home == '/' && fs::is_directory(home, ignored))
    return fs::path(home) / ".cache" / "alpenglow";
  return std::nullopt;
}

std::vector<float> HeightCache(const WantedHeights& wanted,
                               const std::function<std::vector<float>()>& make) {
  const std::optional<fs::path> folder = CacheFolder();
  if (!folder) return make();
  const fs::path file = FileOf(*folder, wanted);
  if (std::optional<std::vector<float>> kept = Read(file, wanted)) return std::move(*kept);
  std::vector<float> made = make();
  if (IsWanted(made, wanted)) Keep(file, wanted, made);
  return made;
}

}  // namespace alpenglow::renderer
