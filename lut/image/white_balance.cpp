// SPDX-License-Identifier: MIT
#include "lut/image/white_balance.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/colour/spectrum.h"
#include "lut/image/metering.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

using Triple = std::array<double, 3>;

constexpr EnumNames kNamedKinds{{std::pair{WhiteBalance::Kind::kCamera, "camera"},
                                 {WhiteBalance::Kind::kDaylight, "daylight"},
                                 {WhiteBalance::Kind::kAuto, "auto"}}};

// Matrix of CAT16 and its inverse. Li et al. (2017), table of CAT16.
constexpr Matrix3 kConesFromXyz{{{0.401288, 0.650173, -0.051461},
                                 {-0.250268, 1.204414, 0.045854},
                                 {-0.002079, 0.048952, 0.953127}}};
constexpr Matrix3 kXyzFromCones{{{1.86206786, -1.01125463, 0.14918677},
                                 {0.38752654, 0.62144744, -0.00897398},
                                 {-0.01584150, -0.03412294, 1.04996444}}};

Matrix3 Product(const Matrix3& a, const Matrix3& b) {
  Matrix3 product{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (std::size_t k = 0; k < 3; ++k) product[row][column] += a[row][k] * b[k][column];
    }
  }
  return product;
}

Triple OfLuminanceOne(const Triple& xyz) { return {xyz[0] / xyz[1], 1.0, xyz[2] / xyz[1]}; }

Triple Planck(double kelvin) {
  Triple xyz{};
  for (double nm = 360.0; nm <= 830.0; nm += 5.0) {
    const Triple matching = ColourMatching(nm);
    const double radiance = BlackBodyRadiance(nm, kelvin);
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += radiance * matching[c];
  }
  return OfLuminanceOne(xyz);
}

// Returns XYZ of daylight, CIE 15:2018, section 4.1.2.
Triple Daylight(double kelvin) {
  const double a = 1e3 / kelvin;
  const double x = kelvin <= 7000.0 ? 0.244063 + a * (0.09911 + a * (2.9678 - a * 4.6070))
                                    : 0.237040 + a * (0.24748 + a * (1.9018 - a * 2.0064));
  const double y = -0.275 + x * (2.870 - 3.000 * x);
  return {x / y, 1.0, (1.0 - x - y) / y};
}

// Returns uv chromaticity of CIE 1960.
std::array<double, 2> Uv(const Triple& xyz) {
  const double sum = xyz[0] + 15.0 * xyz[1] + 3.0 * xyz[2];
  return {4.0 * xyz[0] / sum, 6.0 * xyz[1] / sum};
}

}  // namespace

bool WhiteBalance::IsDaylight() const {
  return kind == Kind::kDaylight || (kelvin && *kelvin == kDaylight_k);
}

std::vector<std::string> WhiteBalanceNames() { return kNamedKinds.All(); }

WhiteBalance WhiteBalanceFromText(const std::string& text) {
  if (const auto kind = kNamedKinds.Find(text)) return {*kind};
  double kelvin = 0.0;
  const char* end_of_text = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), end_of_text, kelvin);
  const bool is_whole = end == end_of_text || (*end == 'K' && end + 1 == end_of_text);
  if (error != std::errc() || !is_whole)
    throw InputError(fmt::format("white balance is \"{}\"; it must be {} or kelvins, as 5600", text,
                                 fmt::join(kNamedKinds.All(), ", ")));
  RequireInRange(kelvin, kWarmestWhite_k, kCoolestWhite_k, "white balance");
  return {WhiteBalance::Kind::kKelvin, kelvin};
}

std::string NameOf(const WhiteBalance& white) {
  if (white.kind == WhiteBalance::Kind::kDaylight) return "daylight (D65)";
  const std::string of_picture = white.IsOfPicture() ? kNamedKinds.Of(white.kind) : "";
  if (!white.kelvin) return of_picture;
  return fmt::format("{}{}{:.0f} K, CAT16", of_picture, of_picture.empty() ? "" : ", ",
                     *white.kelvin);
}

std::array<double, 3> WhiteOfTemperature(double kelvin) {
  constexpr double kPlanckTo_k = 4000.0, kDaylightFrom_k = 5000.0;
  if (kelvin <= kPlanckTo_k) return Planck(kelvin);
  if (kelvin >= kDaylightFrom_k) return Daylight(kelvin);
  const double share = (kelvin - kPlanckTo_k) / (kDaylightFrom_k - kPlanckTo_k);
  const Triple planck = Planck(kelvin), daylight = Daylight(kelvin);
  return {planck[0] + share * (daylight[0] - planck[0]), 1.0,
          planck[2] + share * (daylight[2] - planck[2])};
}

double TemperatureOf(const std::array<double, 3>& xyz) {
  constexpr double kPerMired = 1e6;
  const std::array<double, 2> wanted = Uv(xyz);
  const auto distance = [&](double mired) {
    const std::array<double, 2> light = Uv(WhiteOfTemperature(kPerMired / mired));
    return std::hypot(light[0] - wanted[0], light[1] - wanted[1]);
  };
  constexpr double kLow = kPerMired / kCoolestWhite_k, kHigh = kPerMired / kWarmestWhite_k;
  constexpr double kCoarse = 10.0;
  double nearest = kLow;
  for (double mired = kLow; mired <= kHigh; mired += kCoarse) {
    if (distance(mired) < distance(nearest)) nearest = mired;
  }
  double low = std::max(nearest - kCoarse, kLow), high = std::min(nearest + kCoarse, kHigh);
  while (high - low > 0.05) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    if (distance(a) < distance(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return kPerMired / (0.5 * (low + high));
}

double CameraWhite(double metered_ev100) {
  constexpr double kNight_k = 4000.0, kDuskEv100 = 4.0, kNightEv100 = -2.0, kPerMired = 1e6;
  const double share =
      std::clamp((kDuskEv100 - metered_ev100) / (kDuskEv100 - kNightEv100), 0.0, 1.0);
  if (share == 0.0) return kCameraDaylight_k;
  const double night = share * share * (3.0 - 2.0 * share);
  return kPerMired / (kPerMired / kCameraDaylight_k +
                      night * (kPerMired / kNight_k - kPerMired / kCameraDaylight_k));
}

WhiteBalance Settled(const WhiteBalance& white, const HdrImage& image, Projection projection) {
  constexpr double kWarmest_k = 3000.0, kCoolest_k = 7000.0;
  if (!white.IsOfPicture() || white.kelvin) return white;
  if (white.kind == WhiteBalance::Kind::kCamera)
    return {white.kind, CameraWhite(MeterEv100(image, kSunDiskLuminance_cd_per_m2, projection))};
  const Triple colour = MeteredColour(image, kSunDiskLuminance_cd_per_m2, projection);
  const double kelvin = TemperatureOf(XyzFromLinearSrgb() * colour);
  return {white.kind, std::clamp(kelvin, kWarmest_k, kCoolest_k)};
}

Matrix3 BalancingMatrix(const WhiteBalance& white) {
  if (white.IsDaylight()) return {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  if (!white.kelvin) throw InternalError("the white balance has no picture");
  const Triple shown = kConesFromXyz * (XyzFromLinearSrgb() * Triple{1.0, 1.0, 1.0});
  const Triple light = kConesFromXyz * WhiteOfTemperature(*white.kelvin);
  Matrix3 adapted = Product(kConesFromXyz, XyzFromLinearSrgb());
  for (std::size_t cone = 0; cone < 3; ++cone) {
    for (double& entry : adapted[cone]) entry *= shown[cone] / light[cone];
  }
  return Product(LinearSrgbFromXyz(), Product(kXyzFromCones, adapted));
}

HdrImage Balanced(HdrImage image, const WhiteBalance& white) {
  if (white.IsDaylight()) return image;
  const Matrix3 matrix = BalancingMatrix(white);
  tbb::parallel_for(std::size_t{0}, image.rgb.size(), [&](std::size_t i) {
    std::array<float, 3>& rgb = image.rgb[i];
    const Triple shown = matrix * Triple{double{rgb[0]}, double{rgb[1]}, double{rgb[2]}};
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(shown[c]);
  });
  return image;
}

}  // namespace alpenglow::lut
