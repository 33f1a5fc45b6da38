// SPDX-License-Identifier: MIT
#include "viewer/paint/tone_table.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <cstddef>

#include "lut/picture/tone_curve.h"

namespace alpenglow {
namespace {

std::array<float, ToneTable::kSide> Nodes() {
  std::array<float, ToneTable::kSide> nodes{};
  constexpr double kRange = ToneTable::kHighestStop - ToneTable::kLowestStop;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(nodes.size() - 1);
    nodes[i] = static_cast<float>(std::exp2(ToneTable::kLowestStop + kRange * share));
  }
  return nodes;
}

}  // namespace

ToneTable::ToneTable(AgxLook look) {
  const auto nodes = Nodes();
  codes_.resize(std::size_t{kSide} * kSide * kSide);
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t blue) {
    auto code = codes_.begin() + static_cast<std::ptrdiff_t>(blue * nodes.size() * nodes.size());
    for (const float green : nodes) {
      for (const float red : nodes) {
        const Rgb<float> light =
            DisplayLight<float>(ToneCurve::kAgx, {red, green, nodes[blue]}, 1.0F, look);
        *code++ = {shared::SrgbCode(light[0]), shared::SrgbCode(light[1]),
                   shared::SrgbCode(light[2])};
      }
    }
  });
}

}  // namespace alpenglow
