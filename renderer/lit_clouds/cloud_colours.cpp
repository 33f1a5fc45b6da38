// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_colours.h"

#include <algorithm>
#include <cstddef>

#include "renderer/cloud_light/plane_parallel_light.h"

namespace alpenglow::renderer {
namespace {

int PeakDegreeOf(const CloudLight& light) {
  return light.plane_parallel() != nullptr ? kLayerStreams - 1 : kCloudDegree;
}

}  // namespace

CloudColours::CloudColours(const CloudLight& light, const std::vector<CloudPhases>& bands)
    : colours_(light.optics().phase(), MeanCloudPhases(light.field(), bands), PeakDegreeOf(light)) {
}

Spectrum CloudColours::Of(double sun, const OnceScattered& once) const {
  Spectrum relative(colours_.bands(), 1.0F);
  if (!(sun > 0.0)) return relative;
  const SpectrumOf<double> differences = colours_.Differences(once);
  for (std::size_t band = 0; band < differences.size(); ++band)
    relative[band] = static_cast<float>(std::max(1.0 + differences[band] / sun, 0.0));
  return relative;
}

}  // namespace alpenglow::renderer
