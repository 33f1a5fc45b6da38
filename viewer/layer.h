// SPDX-License-Identifier: MIT
// Code of this layer names everything of the layers below without qualification.
#pragma once

#include "renderer/layer.h"

namespace alpenglow::viewer {
using namespace renderer;
}
