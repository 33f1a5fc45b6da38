// SPDX-License-Identifier: MIT
#include "lut/picture/look.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/text/error.h"
#include "lut/picture/night_vision.h"
#include "lut/picture/picture_text.h"

namespace alpenglow {

Look LookFromName(const std::string& name) {
  if (name == "local") return {.curve = ToneCurve::kAgx, .local_exposure = true};
  return {.curve = ToneCurveFromName(name)};
}

std::string NameOf(const Look& look) {
  return (look.local_exposure ? "local " : "") + NameOf(look.curve) +
         (look.curve == ToneCurve::kAgx ? ", " + NameOf(look.agx) : "") +
         (look.night_vision ? ", night vision" : "");
}

Image Seen(const Image& image, const Look& look) {
  return look.night_vision ? SeenByNight(image) : image;
}

ExposureRule ExposureRuleFromText(const std::string& text) {
  if (text == "incident") return {ExposureRule::Kind::kIncident};
  if (const std::optional<double> ev100 = Ev100FromText(text))
    return {ExposureRule::Kind::kFixed, *ev100};
  return {};
}

std::string NameOf(ExposureRule::Kind kind) {
  switch (kind) {
    case ExposureRule::Kind::kMetered:
      return "metered";
    case ExposureRule::Kind::kIncident:
      return "incident";
    case ExposureRule::Kind::kFixed:
      return "fixed";
  }
  throw InternalError("unknown rule of exposure");
}

double IncidentEv100(double illuminance_lux) {
  constexpr double kFlatReceptor = 250.0;  // C [lx s ISO]
  if (!(illuminance_lux > 0.0)) return kDarkestEv100;
  return std::clamp(std::log2(illuminance_lux * 100.0 / kFlatReceptor), kDarkestEv100,
                    kBrightestEv100);
}

}  // namespace alpenglow
