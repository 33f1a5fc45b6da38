// SPDX-License-Identifier: MIT
#include "lut/picture/picture_text.h"

#include <fmt/format.h>

#include <charconv>

#include "atmosphere/text/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

/// Calls `refuse` unless the whole text is a number.
template <typename Number, typename Refuse>
Number NumberFromText(std::string_view text, const Refuse& refuse) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) refuse();
  return number;
}

}  // namespace

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
  if (name == "agx") return ToneCurve::kAgx;
  if (name == "aces") return ToneCurve::kAces;
  if (name == "reinhard") return ToneCurve::kReinhard;
  if (name == "pbr-neutral") return ToneCurve::kPbrNeutral;
  if (name == "linear") return ToneCurve::kLinear;
  throw InputError(fmt::format(
      "tone curve is \"{}\"; it must be agx, aces, reinhard, pbr-neutral or linear", name));
}

std::string NameOf(ToneCurve curve) {
  switch (curve) {
    case ToneCurve::kAgx:
      return "agx";
    case ToneCurve::kAces:
      return "aces";
    case ToneCurve::kReinhard:
      return "reinhard";
    case ToneCurve::kPbrNeutral:
      return "pbr-neutral";
    case ToneCurve::kLinear:
      return "linear";
  }
  throw InternalError("unknown tone curve");
}

}  // namespace alpenglow::lut
