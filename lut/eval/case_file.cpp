// SPDX-License-Identifier: MIT
#include "lut/eval/case_file.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <string_view>
#include <vector>

#include "atmosphere/text/error.h"

namespace alpenglow::lut {
namespace {

enum Column : std::size_t { kId, kQuantity, kAltitude, kView, kAzimuth, kSun, kDistance };
constexpr std::array<std::string_view, 7> kColumnNames{"id",
                                                       "quantity",
                                                       "altitude_m",
                                                       "view_zenith_deg",
                                                       "relative_azimuth_deg",
                                                       "sun_zenith_deg",
                                                       "distance_m"};

const std::map<std::string_view, Quantity> kQuantities{
    {"transmittance", Quantity::kTransmittance},
    {"optical_depth", Quantity::kOpticalDepth},
    {"single", Quantity::kSingle},
    {"inscatter_single", Quantity::kInscatterSingle},
    {"total", Quantity::kTotal},
    {"stokes_q", Quantity::kStokesQ},
    {"stokes_u", Quantity::kStokesU},
    {"irradiance_sun", Quantity::kIrradianceSun},
    {"irradiance_sky", Quantity::kIrradianceSky}};

}  // namespace

CaseReader::CaseReader(const std::filesystem::path& file) : lines_(file, kColumnNames) {}

std::optional<Case> CaseReader::Next() {
  if (!lines_.Next()) return std::nullopt;
  Case result;
  result.line = lines_.line();
  result.id = lines_.Field(kId);
  if (result.id.empty()) Fail(result.line, "id is empty");
  if (lines_.Field(kQuantity) == "airlight") {
    Fail(result.line,
         "quantity airlight has columns of its own; put such cases in a file of theirs");
  }
  const auto quantity = kQuantities.find(lines_.Field(kQuantity));
  if (quantity == kQuantities.end()) {
    std::vector<std::string_view> names;
    for (const auto& [name, unused] : kQuantities) names.push_back(name);
    Fail(result.line, fmt::format("quantity is \"{}\"; it must be one of {}",
                                  lines_.Field(kQuantity), fmt::join(names, ", ")));
  }
  result.quantity = quantity->second;
  const double altitude_m = lines_.Number(kAltitude, -12000.0, 1e9);
  const double view_deg = lines_.Number(kView, 0.0, 180.0);
  result.relative_azimuth_deg = lines_.Number(kAzimuth, -360.0, 360.0);
  result.ray = RayFromAngles(altitude_m, view_deg, result.relative_azimuth_deg,
                             lines_.Number(kSun, 0.0, 180.0));
  if (!lines_.Field(kDistance).empty()) {
    result.ray.length_m = lines_.Number(kDistance, 0.0, 1e12);
  }
  return result;
}

}  // namespace alpenglow::lut
