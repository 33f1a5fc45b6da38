// SPDX-License-Identifier: MIT
#include "viewer/lamps/phase_macro.h"

#include "atmosphere/text/error.h"

namespace alpenglow::viewer {

std::string PhaseExpression(PhaseKind kind) {
  switch (kind) {
    case PhaseKind::kRayleigh:
      return "PhaseRayleigh(c)";
    case PhaseKind::kHenyeyGreenstein:
      return "PhaseHenyeyGreenstein(c, p.x)";
    case PhaseKind::kDoubleHenyeyGreenstein:
      return "PhaseDoubleHenyeyGreenstein(c, p.x, p.y, p.z)";
    case PhaseKind::kCornetteShanks:
      return "PhaseCornetteShanks(c, p.x)";
    case PhaseKind::kSchlick:
      return "PhaseSchlick(c, p.x)";
    case PhaseKind::kDraine:
      return "PhaseDraine(c, p.x, p.w)";
    case PhaseKind::kHenyeyGreensteinDraine:
      return "PhaseHenyeyGreensteinDraine(c, p.x, p.y, p.z, p.w)";
    case PhaseKind::kTable:
      return "0.0";
  }
  throw InternalError("unknown kind of phase function");
}

glm::vec4 ParametersOf(const PhaseFunction& phase) {
  return {phase.g, phase.g_back, phase.back_weight, phase.alpha};
}

}  // namespace alpenglow::viewer
