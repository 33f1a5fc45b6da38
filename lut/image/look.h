// SPDX-License-Identifier: MIT
// This header provides the conversion of an image of physical light to a displayed one: the eye's
// adaptation, exposure and tone curve.
//
// It also parses the texts of command lines for these: sizes, exposures, names of tone curves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lut/image/image.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"
#include "lut/image/white_balance.h"

namespace alpenglow::lut {

/// The part of DisplayOptions that determines the colours of a developed image.
struct Look {
  ToneCurve curve = ToneCurve::kAgx;
  bool local_exposure = false;  // LocallyExposed
  bool rolls_off = false;       // WithHighlightsRolledOff
  bool night_vision = false;    // lut/image/night_vision.h
  AgxLook agx = AgxLook::kPhoto;
  WhiteBalance white = {};

  bool operator==(const Look&) const = default;
};

/// Returns the look with a tone curve by name, or "local": local exposure and AgX. Throws
/// InputError for another name.
[[nodiscard]] Look LookFromName(const std::string& name);
/// Returns the names that LookFromName accepts.
[[nodiscard]] std::vector<std::string> LookNames();
/// Returns the name of the look without the white balance, which has its own name.
[[nodiscard]] std::string NameOf(const Look& look);

/// Geometry of the view of an image.
struct PictureView {
  Projection projection = Projection::kCamera;
  double pixel_rad = 0.0;  // angle between neighbouring pixels in the middle; 0: no night blur
};

/// Returns the look with the white balance of the image determined.
[[nodiscard]] Look Settled(Look look, const HdrImage& image, const PictureView& view = {});

/// Returns an image ready for metering and developing: white-balanced and, with night vision, with
/// the colours and acuity of the dark-adapted eye (night_vision.h). @param look  must be settled.
[[nodiscard]] HdrImage Seen(const HdrImage& image, const Look& look, const PictureView& view = {});

/// The part of DisplayOptions that determines the exposure of an image.
struct ExposureRule {
  enum class Kind {
    kMetered,   // CameraEv100 of the image's MeterEv100
    kIncident,  // IncidentEv100 of the light at the place: smooth in time, independent of the view
    kFixed,
    kEye,  // EyeEv100 of the image's MeterEv100
  };
  Kind kind = Kind::kMetered;
  double ev100 = 0.0;  // for kFixed

  bool operator==(const ExposureRule&) const = default;
};

/// Returns the look of images that are exposed by a rule. An incident meter measures the light on a
/// subject, not the sky behind it, so its images roll off their highlights. Images with the curve
/// "linear" do not.
[[nodiscard]] Look LookUnder(const ExposureRule& rule, Look look);

/// Return exposure and look of options for a display. Throw InputError for an unknown name and for
/// a value out of range.
[[nodiscard]] ExposureRule RuleOf(const DisplayOptions& options);
[[nodiscard]] Look LookOf(const DisplayOptions& options);

/// Parses "auto", "eye", "incident", or a number in [-30, 30]; throws InputError for another text.
[[nodiscard]] ExposureRule ExposureRuleFromText(const std::string& text);

/// Returns "metered", "eye", "incident" or "fixed".
[[nodiscard]] std::string NameOf(ExposureRule::Kind kind);

/// Returns an exposure that keeps a dusk dark, because the eye adapts only in part. Brightness
/// grows as the cube root of luminance (Stevens 1961, "To honor Fechner and repeal his law",
/// Science 133, 80-86). Metered middle grey is therefore shown x = (15 - EV) / 3 stops darker on
/// the display than by day, which is EV 15 and more, but always less than 6 stops darker, where
/// displays lose detail: x / (1 + (x / 6)^4)^(1/4) stops, within 0.2 of x down to EV 4. Light that
/// falls by 20 % a minute is shown 7 % darker a minute.
/// @param metered_ev100  MeterEv100 of the image.
[[nodiscard]] double EyeEv100(double metered_ev100, const Look& look);

/// Returns the exposure of a camera that keeps a night dark. Metered middle grey is shown with k(L)
/// / k(4096 cd/m^2) of its light on the display by day, where the key is
///
///   k(L) = (1.03 - 2 / (2 + log10(L + 1))) (1 + 0.005 / L)^(-1/3),     L metered [cd/m^2].
///
/// The first factor is the key of Krawczyk, Myszkowski and Seidel (2005), "Perceptual effects in
/// real-time tone mapping" (SCCG '05), equation 11. It ends 4.5 stops below the day's key, at the
/// light of a full moon. The second factor continues below that by the cube root of luminance
/// (Stevens, as above) where only rods see (0.005 cd/m^2, CIE 191). A dusk with the sun at -10
/// degrees is 4 stops darker than noon, the light of a full moon 4.5, the light of stars 6, the
/// meter's darkest less than 7.
/// @param metered_ev100  MeterEv100 of the image.
[[nodiscard]] double CameraEv100(double metered_ev100, const Look& look);

/// Returns the exposure by a rule from MeterEv100 of an image.
/// @param rule  metered, eye or fixed; InternalError for incident, which does not depend on the
///   image.
[[nodiscard]] double Ev100By(const ExposureRule& rule, double metered_ev100, const Look& look);

/// Look and exposure with which a picture is developed.
struct Development {
  Look look;  // with a definite white balance
  double ev100 = 0.0;
  std::string rule = {};        // exposure rule in words, if the picture's header states it
  std::string white_rule = {};  // rule of a white balance that is smooth over a series
};

/// Returns the rule in words, for the metadata of output files.
[[nodiscard]] std::string RuleInWords(const ExposureRule& rule);

/// Returns the exposure of an image for its header. @param rule_in_words  RuleInWords, or more.
[[nodiscard]] Metadata HeaderOfExposure(const ExposureRule& rule, double ev100,
                                        const std::string& rule_in_words);
/// Returns tone curve and white balance of a developed image for its header.
[[nodiscard]] Metadata HeaderOfLook(const Look& look);

/// Returns the reading of an incident-light meter: E S / C = 2^EV with C = 250 for a flat receptor
/// (ISO 2720).
/// @param illuminance_lux  on a horizontal plane, >= 0. The result lies within [kDarkestEv100,
///   kBrightestEv100].
[[nodiscard]] double IncidentEv100(double illuminance_lux);

struct ImageSize {
  int width = 1280;
  int height = 720;
};

/// Parses "1280x720", each in [1, largest]; throws InputError.
[[nodiscard]] ImageSize ImageSizeFromText(const std::string& text, int largest = 16384);

/// Parses an exposure: nullopt for "auto", an exposure value for a number in [-30, 30]; throws
/// InputError for other texts.
[[nodiscard]] std::optional<double> Ev100FromText(const std::string& text);

/// Converts between a tone curve and its name: "agx", "aces", "reinhard", "pbr-neutral" or
/// "linear"; throws InputError for another name.
[[nodiscard]] ToneCurve ToneCurveFromName(const std::string& name);
[[nodiscard]] std::string NameOf(ToneCurve curve);
[[nodiscard]] std::vector<std::string> ToneCurveNames();

}  // namespace alpenglow::lut
