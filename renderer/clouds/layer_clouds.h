// SPDX-License-Identifier: MIT
// Stratocumulus and altocumulus: layers whose thickness is a map over the ground.
//
//   F(x, y, z) = min(0.8 (z_base + h(u) - z) + d(x, y, z),  0.8 (z - z_base - b(x, y)) + d / 2)
//   u          = (m(x, y) - t) / (m_97 - t)
//   h(u)       = H min(u, 1.3)^p  for u > 0,  slope u for u <= 0
//
// m is the map of the genus, t its threshold, m_97 its 97th percentile, d billow noise of the top
// and b the waves of the base, which rises at the rims. The threshold is found for a cover. No noise
// is longer than an eighth of the default period: a field has many gaps in every period, so that from
// above none marks where it repeats.
//
//   stratocumulus  closed cells of 2 km and of 760 m, within noise of 2.5 km and less (spectrum about
//                  k^-5/3: Cahalan and Snider 1989, Remote Sens. Environ. 28, 95)
//   altocumulus    cells of 400 m in rows across the wind, in patches of 2.5 km
#pragma once

#include <memory>

#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/cloud_options.h"

namespace alpenglow::renderer {

/// Returns the shape of stratocumulus or altocumulus at a time, with the cover of the options.
/// @param matter  for the optical depths that make the cover.
[[nodiscard]] std::unique_ptr<const CloudShape> LayerCloudShape(const CloudOptions& options,
                                                                const CloudLattice& lattice,
                                                                const CloudMatter& matter,
                                                                double time_s);

}  // namespace alpenglow::renderer
