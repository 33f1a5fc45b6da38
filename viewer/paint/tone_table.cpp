// SPDX-License-Identifier: MIT
#include "viewer/paint/tone_table.h"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>
#include <cstddef>

#include "lut/picture/tone_curve.h"

namespace alpenglow::viewer {
namespace {

std::vector<float> Nodes(int side) {
  std::vector<float> nodes(static_cast<std::size_t>(side));
  constexpr double kRange = ToneTable::kHighestStop - ToneTable::kLowestStop;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(nodes.size() - 1);
    nodes[i] = static_cast<float>(std::exp2(ToneTable::kLowestStop + kRange * share));
  }
  return nodes;
}

}  // namespace

ToneTable::ToneTable(AgxLook look, int side) : side_(side) {
  const std::vector<float> nodes = Nodes(side);
  codes_.resize(nodes.size() * nodes.size() * nodes.size());
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

}  // namespace alpenglow::viewer
