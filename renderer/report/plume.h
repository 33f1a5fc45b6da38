// SPDX-License-Identifier: MIT
// A plume of smoke as a local volume and as a field of clouds with exactly the same densities, to
// compare the light of both.
#pragma once

#include <memory>

#include "renderer/clouds/cloud_field.h"
#include "renderer/layer.h"
#include "renderer/media/local_volume.h"

namespace alpenglow::renderer {

struct PlumeCase {
  double largest_depth = 10.0;  // optical, over the columns along x, y and z
  double albedo = 1.0;
  double g = 0.85;
  int samples = 64;  // along each side of 640 m
};

/// The light of `volume` is that of `field`. Both are 640 m wide around the origin of x and y, from
/// z = 0 on.
struct Plume {
  std::shared_ptr<const LocalVolume> volume;  // of one band
  CloudField field;
  PhaseFunction phase;
};

/// Returns a plume whose densities fall off to 0 at the surface of an ellipsoid and are torn by noise.
[[nodiscard]] Plume MakePlume(const PlumeCase& of);

}  // namespace alpenglow::renderer
