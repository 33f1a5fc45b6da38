// SPDX-License-Identifier: MIT
#include "lut/picture/stokes_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {

std::string NameOf(StokesLayer layer) {
  switch (layer) {
    case StokesLayer::kQ:
      return "stokes_q";
    case StokesLayer::kU:
      return "stokes_u";
    case StokesLayer::kPolarisation:
      return "polarisation";
  }
  throw InternalError("a layer without a name");
}

StokesLayer StokesLayerFromName(const std::string& name) {
  for (const StokesLayer layer : kStokesLayers) {
    if (NameOf(layer) == name) return layer;
  }
  throw InputError(
      fmt::format("layer \"{}\" is not one of stokes_q, stokes_u, polarisation", name));
}

std::vector<std::string> ChannelsOf(StokesLayer layer) {
  const std::string name = NameOf(layer);
  if (layer == StokesLayer::kPolarisation) return {name + ".degree", name + ".angle"};
  return {name + ".R", name + ".G", name + ".B"};
}

std::array<float, 2> DegreeAndAngle(double luminance, double q, double u) {
  const double polarised = std::hypot(q, u);
  if (!(luminance > 0.0) || polarised == 0.0) return {0.0F, 0.0F};
  return {static_cast<float>(std::min(polarised / luminance, 1.0)),
          static_cast<float>(0.5 * std::atan2(u, q) / kRadiansPerDegree)};
}

}  // namespace alpenglow::lut
