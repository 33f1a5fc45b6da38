// SPDX-License-Identifier: MIT
// C++ reading of tone_curve.glsl, and the curves put together for a colour.
#pragma once

#include <algorithm>
#include <array>

#include "atmosphere/dialect/shared_math.h"
#include "lut/picture/image.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/dialect/shared_begin.h"
#include "lut/picture/tone_curve.glsl"
#include "atmosphere/dialect/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow {

template <typename Real>
using Rgb = std::array<Real, 3>;

/// The colour without negative channels, of the same luminance (see tone_curve.glsl).
template <typename Real>
[[nodiscard]] Rgb<Real> InsideGamut(const Rgb<Real>& exposed) {
  const Real y = shared::Luminance(exposed[0], exposed[1], exposed[2]);
  const Real smallest = std::min({exposed[0], exposed[1], exposed[2]});
  return {shared::InnerChannel(exposed[0], smallest, y),
          shared::InnerChannel(exposed[1], smallest, y),
          shared::InnerChannel(exposed[2], smallest, y)};
}

template <typename Real>
[[nodiscard]] Rgb<Real> AgxLight(const Rgb<Real>& printed) {
  const Real share = shared::AgxWhiteShare(printed[0], printed[1], printed[2]);
  const Rgb<Real> code = {shared::AgxCode(printed[0], share), shared::AgxCode(printed[1], share),
                          shared::AgxCode(printed[2], share)};
  const Real code_share = shared::AgxWhiteShare(code[0], code[1], code[2]);
  return {shared::AgxLight(code[0], code_share), shared::AgxLight(code[1], code_share),
          shared::AgxLight(code[2], code_share)};
}

template <typename Real>
[[nodiscard]] Rgb<Real> AcesLight(const Rgb<Real>& printed) {
  const auto& [red, green, blue] = printed;
  const Rgb<Real> curved = {shared::AcesCurve(shared::AcesRed(red, green, blue)),
                            shared::AcesCurve(shared::AcesGreen(red, green, blue)),
                            shared::AcesCurve(shared::AcesBlue(red, green, blue))};
  return {shared::AcesLightRed(curved[0], curved[1], curved[2]),
          shared::AcesLightGreen(curved[0], curved[1], curved[2]),
          shared::AcesLightBlue(curved[0], curved[1], curved[2])};
}

template <typename Real>
[[nodiscard]] Rgb<Real> ReinhardLight(const Rgb<Real>& printed) {
  const Real y = shared::Luminance(printed[0], printed[1], printed[2]);
  const Real largest = std::max({printed[0], printed[1], printed[2]});
  return {shared::ReinhardLight(printed[0], largest, y),
          shared::ReinhardLight(printed[1], largest, y),
          shared::ReinhardLight(printed[2], largest, y)};
}

template <typename Real>
[[nodiscard]] Rgb<Real> NeutralLight(const Rgb<Real>& printed) {
  const Real largest = std::max({printed[0], printed[1], printed[2]});
  const Real smallest = std::min({printed[0], printed[1], printed[2]});
  return {shared::NeutralLight(printed[0], largest, smallest),
          shared::NeutralLight(printed[1], largest, smallest),
          shared::NeutralLight(printed[2], largest, smallest)};
}

/// Linear display light in [0, 1] of a finite linear sRGB colour times `scale` (ExposureScale).
template <typename Real>
[[nodiscard]] Rgb<Real> DisplayLight(ToneCurve curve, const Rgb<Real>& rgb, Real scale) {
  const Rgb<Real> exposed = InsideGamut<Real>({shared::ExposedChannel(rgb[0], scale),
                                               shared::ExposedChannel(rgb[1], scale),
                                               shared::ExposedChannel(rgb[2], scale)});
  if (curve == ToneCurve::kLinear) {
    return {std::min(exposed[0], Real(1)), std::min(exposed[1], Real(1)),
            std::min(exposed[2], Real(1))};
  }
  const Rgb<Real> printed = {shared::PrintedChannel(exposed[0]), shared::PrintedChannel(exposed[1]),
                             shared::PrintedChannel(exposed[2])};
  switch (curve) {
    case ToneCurve::kAgx:
    case ToneCurve::kLinear:
      break;
    case ToneCurve::kAces:
      return AcesLight(printed);
    case ToneCurve::kReinhard:
      return ReinhardLight(printed);
    case ToneCurve::kPbrNeutral:
      return NeutralLight(printed);
  }
  return AgxLight(printed);
}

}  // namespace alpenglow
