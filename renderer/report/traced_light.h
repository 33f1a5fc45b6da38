// SPDX-License-Identifier: MIT
// Light of one ray by paths, on one thread, so that the report can time it beside fast methods.
#pragma once

#include <cstddef>
#include <cstdint>

#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_tracking.h"

namespace alpenglow::renderer {

/// Returns the light of a ray by independent batches of paths, with standard errors from their
/// scatter; the errors of one batch are 0.
/// @param paths_per_batch  at most kPathsPerBatch: the points of a lattice, evenly spread over it.
[[nodiscard]] CloudRadiance TracedLight(const CloudPathTracer& tracer, const CloudRay& ray,
                                        std::uint64_t seed, std::size_t batches,
                                        std::size_t paths_per_batch);

/// Returns a seed that depends on the direction and the origin of a ray alone. It differs from the
/// seeds of references, which are small.
[[nodiscard]] std::uint64_t SeedOf(const CloudRay& ray);

}  // namespace alpenglow::renderer
