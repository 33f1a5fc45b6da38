// SPDX-License-Identifier: MIT
// This header lets code in namespace lut use all names of the layer below, atmosphere, without
// qualification.
#pragma once

namespace alpenglow::atmosphere {}
namespace alpenglow::lut {
using namespace atmosphere;
}
