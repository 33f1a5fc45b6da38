// SPDX-License-Identifier: MIT
// This header makes the names of the layers below visible in this layer without qualification.
#pragma once

#include "lut/layer.h"

namespace alpenglow::renderer {
using namespace lut;
}
