// SPDX-License-Identifier: MIT
// The files that a scene is made from.
#pragma once

#include <vector>

#include "lut/program/output_name.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Every file that a scene names and that is read when it is rendered, under the name of its key.
[[nodiscard]] std::vector<NamedFile> FilesOf(const Scene& scene);

}  // namespace alpenglow::renderer
