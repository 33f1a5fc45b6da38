// SPDX-License-Identifier: MIT
#include "viewer/passes/tone_map_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/numerics.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::viewer {
namespace {

// Trilinear interpolation as a graphics card does it, of a colour in stops over saturation.
std::array<double, 3> CodeOf(const ToneTable& table, const std::array<double, 3>& stops) {
  std::array<int, 3> cell{};
  std::array<double, 3> along{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double range = ToneTable::kHighestStop - ToneTable::kLowestStop;
    const double at = (stops[c] - ToneTable::kLowestStop) / range * (ToneTable::kSide - 1);
    cell[c] = std::clamp(static_cast<int>(at), 0, ToneTable::kSide - 2);
    along[c] = std::clamp(at - cell[c], 0.0, 1.0);
  }
  std::array<double, 3> code{};
  for (int corner = 0; corner < 8; ++corner) {
    std::size_t index = 0;
    double weight = 1.0;
    for (int c = 2; c >= 0; --c) {
      const int step = corner >> c & 1;
      const auto i = static_cast<std::size_t>(c);
      index = index * ToneTable::kSide + static_cast<std::size_t>(cell[i] + step);
      weight *= step == 1 ? along[i] : 1.0 - along[i];
    }
    for (std::size_t c = 0; c < 3; ++c)
      code[c] += weight * static_cast<double>(table.codes()[index][c]);
  }
  return code;
}

/// Of the table, in codes of 8 bits, ascending.
std::vector<double> ErrorsOf(AgxLook look) {
  const ToneTable table(look);
  std::vector<double> errors;
  for (int i = 1; i <= 20000; ++i) {
    // Colours as nature has them: channels within three stops of each other.
    const double brightness = -10.0 + 14.0 * Halton(i, 2);
    const std::array<double, 3> stops = {brightness, brightness - 1.5 + 3.0 * Halton(i, 3),
                                         brightness - 3.0 + 6.0 * Halton(i, 5)};
    const Rgb<double> light = DisplayLight<double>(
        ToneCurve::kAgx, {std::exp2(stops[0]), std::exp2(stops[1]), std::exp2(stops[2])}, 1.0,
        look);
    const std::array<double, 3> code = CodeOf(table, stops);
    for (std::size_t c = 0; c < 3; ++c)
      errors.push_back(255.0 * std::abs(code[c] - shared::SrgbCode(light[c])));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(ToneTable, ShowsTheCurveToAFractionOfACode) {
  const std::vector<double> errors = ErrorsOf(AgxLook::kPhoto);
  EXPECT_LT(errors[errors.size() / 2], 0.06);
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.25) << "less than half the dither";
  EXPECT_LT(errors.back(), 0.9);
}

TEST(ToneTable, OtherLooksAreOffWhereTheyClipAChannel) {
  for (const AgxLook look : {AgxLook::kNone, AgxLook::kPunchy}) {
    const std::vector<double> errors = ErrorsOf(look);
    EXPECT_LT(errors[errors.size() / 2], 0.1) << NameOf(look);
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.5) << NameOf(look);
    EXPECT_LT(errors[errors.size() * 99 / 100], 3.0) << NameOf(look) << ": an edge between nodes";
  }
}

}  // namespace
}  // namespace alpenglow::viewer
