// SPDX-License-Identifier: MIT
#include "renderer/layers/layer_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

void RequireLayerOptics(const LayerOptics& optics, const std::string& name) {
  RequireInRange(optics.optical_depth, 0.0, std::numeric_limits<double>::max(),
                 name + ".optical_depth");
  RequireInRange(optics.albedo, 0.0, 1.0, name + ".albedo");
  if (optics.chi.empty()) throw InputError(name + ".chi is empty; it must begin with 1");
  RequireInRange(optics.chi[0], 1.0, 1.0, name + ".chi[0]");
  for (std::size_t l = 1; l < optics.chi.size(); ++l) {
    RequireInRange(optics.chi[l], -1.0, 1.0, fmt::format("{}.chi[{}]", name, l));
  }
}

ScaledLayer DeltaScaled(const LayerOptics& optics, int streams) {
  const auto count = static_cast<std::size_t>(streams);
  ScaledLayer scaled;
  scaled.chi = optics.chi;
  scaled.chi.resize(count + 1, 0.0);
  scaled.peak = std::max(*std::min_element(scaled.chi.begin(), scaled.chi.end()), 0.0);
  scaled.chi.pop_back();
  scaled.scale = 1.0 - optics.albedo * scaled.peak;
  scaled.depth = scaled.scale * optics.optical_depth;
  // A layer of the peak alone scatters nothing.
  const double rest = 1.0 - scaled.peak;
  scaled.albedo = scaled.scale > 0.0 ? optics.albedo * rest / scaled.scale : 0.0;
  for (double& chi : scaled.chi) chi = rest > 0.0 ? (chi - scaled.peak) / rest : 0.0;
  return scaled;
}

LayerOptics MixedLayer(const std::vector<LayerOptics>& constituents) {
  LayerOptics mixed;
  double scattering = 0.0;
  std::vector<double> moments;
  for (const LayerOptics& one : constituents) {
    RequireLayerOptics(one, "constituent");
    const double of_one = one.albedo * one.optical_depth;
    mixed.optical_depth += one.optical_depth;
    scattering += of_one;
    moments.resize(std::max(moments.size(), one.chi.size()), 0.0);
    for (std::size_t l = 0; l < one.chi.size(); ++l) moments[l] += of_one * one.chi[l];
  }
  if (scattering > 0.0) {
    for (double& moment : moments) moment /= scattering;
    moments[0] = 1.0;  // without the rounding of the quotient
    mixed.chi = std::move(moments);
  }
  mixed.albedo = mixed.optical_depth > 0.0 ? std::min(scattering / mixed.optical_depth, 1.0) : 1.0;
  return mixed;
}

}  // namespace alpenglow::renderer
