// SPDX-License-Identifier: MIT
// How a picture of physical light becomes one to look at: the eye's adaptation, exposure, curve.
//
// What people type about pictures: sizes, exposures, names of tone curves.
#pragma once

#include <optional>
#include <string>

#include "lut/picture/image.h"
#include "lut/picture/metering.h"
#include "lut/picture/tone_mapping.h"

namespace alpenglow::lut {

struct Look {
  ToneCurve curve = ToneCurve::kAgx;
  bool local_exposure = false;  // lut/picture/local_exposure.h
  bool rolls_off = false;       // lut/picture/local_exposure.h
  bool night_vision = false;    // lut/picture/eye.h
  AgxLook agx = AgxLook::kPhoto;
  WhiteBalance white = {};

  bool operator==(const Look&) const = default;
};

/// A tone curve by name, or "local": local exposure and AgX. Throws InputError for another name.
[[nodiscard]] Look LookFromName(const std::string& name);
/// Without the white balance, which has a name of its own.
[[nodiscard]] std::string NameOf(const Look& look);

/// What is seen of a picture.
struct PictureView {
  Projection projection = Projection::kCamera;
  double pixel_rad = 0.0;  // angle between neighbouring pixels in the middle; 0: night is not soft
};

/// The look for a picture: its white balance settled.
[[nodiscard]] Look Settled(Look look, const Image& image, const PictureView& view = {});

/// A picture as it is metered and developed: balanced, and with night vision as the eye sees it, as
/// soft as its acuity has it (eye.h). Of a look that is settled.
[[nodiscard]] Image Seen(const Image& image, const Look& look, const PictureView& view = {});

/// A picture from Seen(), developed. Throws InternalError for a pixel that is not finite.
[[nodiscard]] DisplayImage Develop(const Image& seen, double ev100, const Look& look);

/// Where the exposure of a picture comes from.
struct ExposureRule {
  enum class Kind {
    kMetered,   // CameraEv100 of what MeterEv100 says of the picture
    kIncident,  // IncidentEv100 of the light on the place: smooth in time, whatever is in view
    kFixed,
    kEye,  // EyeEv100 of what MeterEv100 says of the picture
  };
  Kind kind = Kind::kMetered;
  double ev100 = 0.0;  // kFixed

  bool operator==(const ExposureRule&) const = default;
};

/// The look of pictures that are exposed by a rule: those of an incident meter, which heeds the light on
/// a subject and not the sky behind it, roll off their highlights. "linear" shows them as they are.
[[nodiscard]] Look LookUnder(const ExposureRule& rule, Look look);

/// "auto", "eye", "incident", or a number in [-30, 30]; throws InputError for another text.
[[nodiscard]] ExposureRule ExposureRuleFromText(const std::string& text);

/// "metered", "eye", "incident" or "fixed".
[[nodiscard]] std::string NameOf(ExposureRule::Kind kind);

/// The exposure that lets a dusk be dark: the eye adapts in part. Brightness grows as the cube root of
/// luminance (Stevens 1961, "To honor Fechner and repeal his law", Science 133, 80-86), so what the
/// meter took for middle grey is shown x = (15 - EV) / 3 stops darker on the display than by day, which
/// is EV 15 and more; but always less than 6, where displays lose what there is:
/// x / (1 + (x / 6)^4)^(1/4) stops, within 0.2 of x down to EV 4. Light that falls by 20 % a minute
/// is shown by 7 % a minute darker.
/// @param metered_ev100  MeterEv100 of the picture.
[[nodiscard]] double EyeEv100(double metered_ev100, const Look& look);

/// The exposure of a camera that lets a night be dark. What the meter took for middle grey is shown
/// with k(L) / k(4096 cd/m^2) of the light that it has on the display by day, where the key is
///
///   k(L) = (1.03 - 2 / (2 + log10(L + 1))) (1 + 0.005 / L)^(-1/3),     L metered [cd/m^2].
///
/// The first factor is the key of Krawczyk, Myszkowski and Seidel (2005), "Perceptual effects in
/// real-time tone mapping" (SCCG '05), equation 11. It ends at 4.5 stops under the day's, the light of
/// a full moon. The second goes on below that by the cube root of luminance (Stevens, as above) where
/// rods alone see (0.005 cd/m^2, CIE 191). A dusk with the sun at -10 degrees is 4 stops darker than
/// noon, the light of a full moon 4.5, that of the stars 6, the meter's darkest less than 7.
/// @param metered_ev100  MeterEv100 of the picture.
[[nodiscard]] double CameraEv100(double metered_ev100, const Look& look);

/// The exposure by a rule from what MeterEv100 says of a picture.
/// @param rule  metered, eye or fixed; InternalError for incident, which is not of a picture.
[[nodiscard]] double Ev100By(const ExposureRule& rule, double metered_ev100, const Look& look);

/// The rule in words, for the files that it was used for.
[[nodiscard]] std::string RuleInWords(const ExposureRule& rule);

/// What an incident-light meter reads: E S / C = 2^EV with C = 250 for a flat receptor (ISO 2720).
/// @param illuminance_lux  on a horizontal plane, >= 0. Within [kDarkestEv100, kBrightestEv100].
[[nodiscard]] double IncidentEv100(double illuminance_lux);

struct ImageSize {
  int width = 1280;
  int height = 720;
};

/// "1280x720", each in [1, largest]; throws InputError.
[[nodiscard]] ImageSize ImageSizeFromText(const std::string& text, int largest = 16384);

/// "auto" is nothing, a number in [-30, 30] an exposure value; throws InputError for other texts.
[[nodiscard]] std::optional<double> Ev100FromText(const std::string& text);

/// "agx", "aces", "reinhard", "pbr-neutral" or "linear"; throws InputError for another name.
[[nodiscard]] ToneCurve ToneCurveFromName(const std::string& name);
[[nodiscard]] std::string NameOf(ToneCurve curve);

}  // namespace alpenglow::lut
