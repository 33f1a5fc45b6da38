// SPDX-License-Identifier: MIT
// Compares two sets of Bruneton's .dat files, table by table.
//   studies exchange_error OURS STOCK [LOWEST_SUN]
// OURS is written by `skylut build --layout bruneton`, STOCK by `precompute` of his demo, both for
// a lowest sun of 102 (default) or 120 degrees from the zenith. Differences are relative to STOCK,
// for texels with more than a thousandth of the largest value of their row in the report.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/layer.h"
#include "lut/tables/scattering_table.h"
#include "tests/bench/studies.h"

namespace alpenglow::lut {
namespace {

using Texels = std::vector<float>;  // RGBA

Texels Read(const std::string& file, std::size_t texels) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  Texels values(4 * texels);
  if (bytes.size() != values.size() * sizeof(float)) {
    throw InputError(fmt::format("{}: has {} bytes; it must have {}", file, bytes.size(),
                                 values.size() * sizeof(float)));
  }
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// Returns the elevation of the sun [deg] of one of the 32 columns of the scattering table.
double SunOfColumn(std::size_t column, double lowest_sun_deg) {
  constexpr double kPlanet_km = 6360.0, kTop_km = 60.0;
  const double mu_s = shared::SunCosineFromUnit<double>(
      static_cast<double>(column) / 31.0, std::cos(lowest_sun_deg * kRadiansPerDegree), kTop_km,
      kPlanet_km);
  return 90.0 - std::acos(mu_s) / kRadiansPerDegree;
}

struct Pair {
  double ours, stock;
};

/// Prints a line of the report.
void Print(const std::string& name, const std::vector<Pair>& pairs) {
  double largest = 0.0, ours = 0.0, stock = 0.0, squares = 0.0;
  for (const Pair& pair : pairs) largest = std::max(largest, pair.stock);
  std::vector<double> errors;
  for (const Pair& pair : pairs) {
    if (!(pair.stock > 1e-3 * largest)) continue;
    errors.push_back(std::abs(pair.ours / pair.stock - 1.0));
    squares += errors.back() * errors.back();
    ours += pair.ours;
    stock += pair.stock;
  }
  if (errors.empty()) return;
  std::sort(errors.begin(), errors.end());
  const auto quantile = [&](double share) {
    return 100.0 * errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  fmt::print("| {} | {} | {:.2g} % | {:.2g} % | {:.2g} % | {:.2g} % | {:+.2g} % |\n", name,
             errors.size(), 100.0 * std::sqrt(squares / static_cast<double>(errors.size())),
             quantile(0.5), quantile(0.99), quantile(1.0), 100.0 * (ours / stock - 1.0));
}

/// @param keep  predicate of a texel's number.
template <typename Keep>
void Compare(const std::string& name, const Texels& ours, const Texels& stock, bool alpha,
             const Keep& keep) {
  std::vector<Pair> pairs;
  for (std::size_t texel = 0; texel < ours.size() / 4; ++texel) {
    if (!keep(texel)) continue;
    for (std::size_t c = alpha ? 3 : 0; c < (alpha ? 4U : 3U); ++c) {
      pairs.push_back({double{ours[4 * texel + c]}, double{stock[4 * texel + c]}});
    }
  }
  Print(name, pairs);
}

void CompareScattering(const Texels& ours, const Texels& stock, double lowest_sun_deg) {
  struct Suns {
    const char* name;
    double low_deg, high_deg;
  };
  constexpr std::array<Suns, 4> kSuns{{{"sun above 10°", 10.0, 91.0},
                                       {"10° to 0°", 0.0, 10.0},
                                       {"0° to -6°", -6.0, 0.0},
                                       {"-6° to -12°", -12.0, -6.0}}};
  for (const bool alpha : {false, true}) {
    for (const Suns& suns : kSuns) {
      Compare(fmt::format("{}, {}", alpha ? "haze, once" : "molecules, all orders", suns.name),
              ours, stock, alpha, [&](std::size_t texel) {
                const double sun_deg = SunOfColumn(texel % 32, lowest_sun_deg);
                return sun_deg >= suns.low_deg && sun_deg < suns.high_deg;
              });
    }
  }
}

void CompareFolders(const std::string& ours, const std::string& stock, double lowest_sun_deg) {
  fmt::print("| table | texels | rms | median | 99 % | largest | of the sum |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  const auto all = [](std::size_t) { return true; };
  for (const auto& [name, texels] :
       {std::pair{"transmittance", 256U * 64U}, std::pair{"irradiance", 64U * 16U}}) {
    const std::string file = fmt::format("/{}.dat", name);
    Compare(name, Read(ours + file, texels), Read(stock + file, texels), false, all);
  }
  constexpr std::size_t kScattering = 256UL * 128UL * 32UL;
  CompareScattering(Read(ours + "/scattering.dat", kScattering),
                    Read(stock + "/scattering.dat", kScattering), lowest_sun_deg);
}

}  // namespace
}  // namespace alpenglow::lut

void alpenglow::tests::ExchangeError(int argc, char** argv) {
  if (argc < 3) throw atmosphere::InputError("usage: exchange_error OURS STOCK [LOWEST_SUN]");
  lut::CompareFolders(argv[1], argv[2], argc > 3 ? std::atof(argv[3]) : 102.0);
}
