// SPDX-License-Identifier: MIT
// The content of scenes that paths do not trace.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Returns the content of a scene that ScenePathTracer does not trace, each with the key of
/// scene.toml in brackets; empty if it traces the whole scene.
[[nodiscard]] std::vector<std::string> UntracedContent(const Scene& scene);

/// Throws InputError naming the UntracedContent of a scene, if there is any.
void RequireTraceable(const Scene& scene);

}  // namespace alpenglow::renderer
