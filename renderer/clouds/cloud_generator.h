// SPDX-License-Identifier: MIT
// Fields of all genera from options and a time.
//
// The field is byte-identical for the same options and time, on every machine with IEEE arithmetic
// and for any number of threads. It is seamless across its period. With time the wind carries it
// away, and its shape changes slowly: clouds grow and decay, the noise on them rises. Fields of two
// times a few seconds apart differ little, so that frames of a film can each have their own.
#pragma once

#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/cloud_options.h"

namespace alpenglow::renderer {

/// Returns the water or ice of a layer, its edges and its detail.
[[nodiscard]] CloudMatter MatterOf(const CloudOptions& options);

/// Returns the voxels of a layer, of 20 m.
[[nodiscard]] CloudLattice LatticeOf(const CloudOptions& options);

/// Returns a layer of clouds at a time. Its cover, by CoveredOpticalDepth, differs from that of the
/// options by less than 0.05. Throws InputError of CheckCloudOptions.
/// @param time_s  since any moment, in [0, 1e7].
[[nodiscard]] CloudField MakeCloudField(const CloudOptions& options, double time_s = 0.0);

}  // namespace alpenglow::renderer
