// SPDX-License-Identifier: MIT
// Light of the sun through the air without the tables of it, along straight rays: so that the
// ground can be tested alone.
#pragma once

#include "viewer/gl/shader.h"

namespace alpenglow::tests {

using namespace viewer;

/// After air/block.glsl; stands for the functions of air/tables.glsl.
inline ShaderPiece SunInClosedForm() {
  return {"sun in closed form",
          "vec4 TransmittanceToSun(float altitude_km, float mu_s) {\n"
          "  return exp(-OpticalDepth(ColumnsToSun(altitude_km, mu_s)));\n}\n"
          "vec4 BeamOfSun(float altitude_km, float mu_s) {\n"
          "  return TransmittanceToSun(altitude_km, mu_s);\n}\n"};
}

}  // namespace alpenglow::tests
