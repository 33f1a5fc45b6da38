// SPDX-License-Identifier: MIT
// Makes the names of all layers below visible in this layer without qualification.
#pragma once

#include "renderer/layer.h"

namespace alpenglow::viewer {
using namespace renderer;
}
