// SPDX-License-Identifier: MIT
// Code of this layer names everything of the layers below without qualification.
#pragma once

namespace alpenglow::atmosphere {}
namespace alpenglow::lut {
using namespace atmosphere;
}
