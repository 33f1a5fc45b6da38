// SPDX-License-Identifier: MIT
// Code of this layer names everything of the layers below without qualification.
#pragma once

#include "lut/layer.h"

namespace alpenglow::renderer {
using namespace lut;
}
