// SPDX-License-Identifier: MIT
#include "lut/image/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "lut/image/metering.h"
#include "lut/image/night_vision.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"
#include "lut/layer.h"

namespace alpenglow::lut {

namespace {

constexpr char kLocal[] = "local";

constexpr double kDayEv100 = 15.0;

double LuminanceAt(double ev100) { return kMeterConstant / 100.0 * std::exp2(ev100); }

/// Returns the exposure that shows the metered middle grey `stops` stops darker on the display than
/// metered_ev100 does.
double ShownDarker(double metered_ev100, double stops, const Look& look) {
  const auto shown = [&](double darker) {
    const double grey = LuminanceAt(-darker);
    return DisplayLight<double>(look.curve, {grey, grey, grey}, ExposureScale(0.0), look.agx)[1];
  };
  const double wanted = shown(0.0) * std::exp2(-stops);
  double low = 0.0, high = stops;  // below grey, curves have a slope of 1 or more
  while (shown(high) > wanted) high *= 2.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (shown(middle) > wanted ? low : high) = middle;
  }
  return metered_ev100 + low;
}

/// Returns the key k(L); look.h gives the formula and its sources.
double KeyOf(double luminance_cd_per_m2) {
  constexpr double kRodsAlone_cd_per_m2 = 0.005;
  const double key = 1.03 - 2.0 / (2.0 + std::log10(luminance_cd_per_m2 + 1.0));
  return key / std::cbrt(1.0 + kRodsAlone_cd_per_m2 / luminance_cd_per_m2);
}

/// Returns the number; calls `refuse` unless the whole text is a number.
template <typename Number, typename Refuse>
Number NumberFromText(std::string_view text, const Refuse& refuse) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) refuse();
  return number;
}

constexpr EnumNames kToneCurves{{std::pair{ToneCurve::kAgx, "agx"},
                                 {ToneCurve::kAces, "aces"},
                                 {ToneCurve::kReinhard, "reinhard"},
                                 {ToneCurve::kPbrNeutral, "pbr-neutral"},
                                 {ToneCurve::kLinear, "linear"}}};

}  // namespace

Look LookFromName(const std::string& name) {
  if (name == kLocal) return {.curve = ToneCurve::kAgx, .local_exposure = true};
  return {.curve = ToneCurveFromName(name)};
}

std::vector<std::string> LookNames() {
  std::vector<std::string> names = ToneCurveNames();
  names.emplace_back(kLocal);
  return names;
}

std::string NameOf(const Look& look) {
  return (look.local_exposure ? "local " : "") + NameOf(look.curve) +
         (look.curve == ToneCurve::kAgx ? ", " + NameOf(look.agx) : "") +
         (look.rolls_off ? ", highlights rolled off" : "") +
         (look.night_vision ? ", night vision" : "");
}

Look LookUnder(const ExposureRule& rule, Look look) {
  look.rolls_off = rule.kind == ExposureRule::Kind::kIncident && look.curve != ToneCurve::kLinear;
  return look;
}

Look Settled(Look look, const HdrImage& image, const PictureView& view) {
  look.white = Settled(look.white, image, view.projection);
  return look;
}

HdrImage Seen(const HdrImage& image, const Look& look, const PictureView& view) {
  HdrImage balanced = Balanced(image, look.white);
  if (!look.night_vision) return balanced;
  HdrImage seen = SeenByNight(std::move(balanced));
  return view.pixel_rad > 0.0 ? WithAcuityOfNight(std::move(seen), view.pixel_rad) : seen;
}

ExposureRule RuleOf(const DisplayOptions& options) {
  if (!options.ev100) return ExposureRuleFromText(options.exposure);
  return {ExposureRule::Kind::kFixed, RequireInRange(*options.ev100, -30.0, 30.0, "ev100")};
}

Look LookOf(const DisplayOptions& options) {
  Look look = LookFromName(options.tone_map);
  look.agx = AgxLookFromName(options.look);
  look.white = WhiteBalanceFromText(options.white_balance);
  look.night_vision = options.night_vision;
  return LookUnder(RuleOf(options), look);
}

ExposureRule ExposureRuleFromText(const std::string& text) {
  if (text == "incident") return {ExposureRule::Kind::kIncident};
  if (text == "eye") return {ExposureRule::Kind::kEye};
  if (const std::optional<double> ev100 = Ev100FromText(text))
    return {ExposureRule::Kind::kFixed, *ev100};
  return {};
}

std::string NameOf(ExposureRule::Kind kind) {
  using enum ExposureRule::Kind;
  constexpr EnumNames kNames{
      {std::pair{kMetered, "metered"}, {kIncident, "incident"}, {kFixed, "fixed"}, {kEye, "eye"}}};
  return kNames.Of(kind);
}

double EyeEv100(double metered_ev100, const Look& look) {
  constexpr double kBrightnessPower = 1.0 / 3.0, kMost_stops = 6.0;
  if (metered_ev100 >= kDayEv100) return metered_ev100;
  const double stops = kBrightnessPower * (kDayEv100 - metered_ev100);
  const double part = stops / kMost_stops;
  return ShownDarker(metered_ev100, stops / std::pow(1.0 + std::pow(part, 4.0), 0.25), look);
}

double CameraEv100(double metered_ev100, const Look& look) {
  if (metered_ev100 >= kDayEv100) return metered_ev100;
  const double key = KeyOf(LuminanceAt(metered_ev100)) / KeyOf(LuminanceAt(kDayEv100));
  return ShownDarker(metered_ev100, -std::log2(key), look);
}

double Ev100By(const ExposureRule& rule, double metered_ev100, const Look& look) {
  switch (rule.kind) {
    case ExposureRule::Kind::kMetered:
      return CameraEv100(metered_ev100, look);
    case ExposureRule::Kind::kEye:
      return EyeEv100(metered_ev100, look);
    case ExposureRule::Kind::kFixed:
      return rule.ev100;
    case ExposureRule::Kind::kIncident:
      break;
  }
  throw InternalError("an incident exposure is not of a picture");
}

std::string RuleInWords(const ExposureRule& rule) {
  switch (rule.kind) {
    case ExposureRule::Kind::kMetered:
      return MeterRule() + "; grey shown by the key of Krawczyk et al. under EV 15";
    case ExposureRule::Kind::kEye:
      return MeterRule() +
             "; grey shown by the cube root of luminance under EV 15, less than 6 stops";
    case ExposureRule::Kind::kFixed:
      return "as asked for";
    case ExposureRule::Kind::kIncident:
      return "illuminance of a horizontal plane at the eye, C 250";
  }
  throw InternalError("unknown rule of exposure");
}

Metadata HeaderOfExposure(const ExposureRule& rule, double ev100,
                          const std::string& rule_in_words) {
  return {{"alpenglow.ev100", fmt::format("{:.4f}", ev100)},
          {"alpenglow.exposure", NameOf(rule.kind)},
          {"alpenglow.exposure_rule", rule_in_words}};
}

Metadata HeaderOfLook(const Look& look) {
  return {{"alpenglow.tone_curve", NameOf(look)}, {"alpenglow.white_balance", NameOf(look.white)}};
}

double IncidentEv100(double illuminance_lux) {
  constexpr double kFlatReceptor = 250.0;  // C [lx s ISO]
  if (!(illuminance_lux > 0.0)) return kDarkestEv100;
  return std::clamp(std::log2(illuminance_lux * 100.0 / kFlatReceptor), kDarkestEv100,
                    kBrightestEv100);
}

ImageSize ImageSizeFromText(const std::string& text, int largest) {
  const auto refuse = [&] {
    throw InputError(
        fmt::format("size is \"{}\"; write it as 1280x720, each in [1, {}]", text, largest));
  };
  const auto side = [&](std::string_view digits) {
    const int pixels = NumberFromText<int>(digits, refuse);
    if (pixels < 1 || pixels > largest) refuse();
    return pixels;
  };
  const std::string_view whole = text;
  const std::size_t cross = whole.find('x');
  if (cross == std::string_view::npos) refuse();
  return {side(whole.substr(0, cross)), side(whole.substr(cross + 1))};
}

std::optional<double> Ev100FromText(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const double ev100 = NumberFromText<double>(text, [&] {
    throw InputError(
        fmt::format("exposure is \"{}\"; it must be auto, eye, incident or a number (EV)", text));
  });
  return RequireInRange(ev100, -30.0, 30.0, "exposure");
}

ToneCurve ToneCurveFromName(const std::string& name) {
  return kToneCurves.Named(name, "tone curve is \"{0}\"; it must be {2}");
}

std::string NameOf(ToneCurve curve) { return kToneCurves.Of(curve); }

std::vector<std::string> ToneCurveNames() { return kToneCurves.All(); }

}  // namespace alpenglow::lut
