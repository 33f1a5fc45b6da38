// SPDX-License-Identifier: MIT
#include "renderer/ground/ground_material.h"

#include <algorithm>
#include <utility>

#include "atmosphere/number/constants.h"
#include "renderer/ground/ground_cover.h"

namespace alpenglow::renderer {
namespace {

using Kind = GroundCover::Kind;

// Elevation models give the sea's level to a rounding.
constexpr double kWaterLine_m = 0.5;

}  // namespace

GroundPatch::GroundPatch(const GroundMaterial& material, const GroundPoint& at)
    : material_(material),
      kind_(Kind::kWater),
      albedo_(material.albedo().count),
      waves_(WavesAt(at, material.water().slope_variance())) {}

BandLight GroundPatch::Brdf(const ReflectionAngles& at) const {
  switch (kind_) {
    case Kind::kOrenNayar:
      return material_.rough_.Brdf(albedo_, at);
    case Kind::kBlinnPhong:
      return material_.glossy_.Brdf(albedo_, at);
    case Kind::kWater:
      return material_.water_.Brdf(at, waves_.slope_variance);
    case Kind::kSnow:
      return material_.snow_.Brdf(at);
    case Kind::kMountain:
    case Kind::kLambert:
      break;
  }
  return static_cast<float>(1.0 / kPi) * albedo_;
}

BandLight GroundPatch::BodyAlbedo(double mu_eye) const {
  switch (kind_) {
    case Kind::kOrenNayar:
      return material_.rough_.Albedo(albedo_, mu_eye);
    case Kind::kBlinnPhong:
      return material_.glossy_.BodyAlbedo(albedo_, mu_eye);
    case Kind::kWater:
      return material_.water_.BodyAlbedo(mu_eye);
    case Kind::kSnow:
      return material_.snow_.Albedo(mu_eye);
    case Kind::kMountain:
    case Kind::kLambert:
      break;
  }
  return albedo_;
}

MirroredRays GroundPatch::Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const {
  if (kind_ == Kind::kWater) return material_.water_.Mirrored(normal, to_eye);
  if (kind_ == Kind::kBlinnPhong) return material_.glossy_.Mirrored(normal, to_eye);
  return {};
}

GroundMaterial::GroundMaterial(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                               std::span<const double> wavelengths_nm)
    : cover_(cover),
      drape_(std::move(drape)),
      bands_of_colour_(wavelengths_nm),
      albedo_(Wetted(bands_of_colour_.Albedo(cover.albedo), cover.wetness)),
      rough_(cover.kind == Kind::kOrenNayar ? cover.roughness : 0.0),
      glossy_(cover.kind == Kind::kBlinnPhong ? cover.roughness : 1.0, cover.reflectance),
      water_(cover.wind_m_per_s, wavelengths_nm),
      snow_(cover.grain_diameter_m, wavelengths_nm) {}

bool GroundMaterial::HasGloss() const {
  return cover_.kind == Kind::kWater || cover_.kind == Kind::kBlinnPhong || cover_.sea_level_m ||
         HasLandCover();
}

std::optional<double> GroundMaterial::WaterLine_m() const {
  if (!cover_.sea_level_m) return std::nullopt;
  return *cover_.sea_level_m + kWaterLine_m;
}

BandLight GroundMaterial::AlbedoAt(const GroundPoint& at, double normal_up,
                                   const MountainSurface& season,
                                   const std::optional<std::array<double, 3>>& draped) const {
  if (draped && !HasLandCover()) return Wetted(bands_of_colour_.Albedo(*draped), cover_.wetness);
  if (cover_.kind != Kind::kMountain) return albedo_;
  if (!draped || shared::IsMapped((*draped)[1], (*draped)[2]) == 0.0)
    return season.Albedo(at, normal_up);
  return season.Albedo(
      at, normal_up,
      MappedCover{static_cast<float>((*draped)[0]), static_cast<float>((*draped)[1]),
                  static_cast<float>((*draped)[2])});
}

GroundPatch GroundMaterial::OfTerrain(const GroundPoint& at, const glm::dvec3& point,
                                      double normal_up, const MountainSurface& season) const {
  const auto water_line_m = WaterLine_m();
  if (cover_.kind == Kind::kWater || (water_line_m && at.altitude_m <= *water_line_m))
    return {*this, at};
  if (cover_.kind == Kind::kSnow) return {*this, cover_.kind, BandLight(albedo_.count)};
  std::optional<std::array<double, 3>> draped;
  if (drape_) draped = drape_->At(point, at.altitude_m, at.across_m);
  if (draped && HasLandCover() && shared::IsMappedWater((*draped)[0], (*draped)[1]) > 0.0)
    return {*this, at};
  return {*this, cover_.kind, AlbedoAt(at, normal_up, season, draped)};
}

GroundPatch GroundMaterial::OfPlanet(const GroundPoint& at, const BandLight& planet_albedo) const {
  const auto water_line_m = WaterLine_m();
  if (cover_.kind == Kind::kWater || (water_line_m && *water_line_m >= 0.0)) return {*this, at};
  if (cover_.kind == Kind::kMountain) return {*this, cover_.kind, planet_albedo};
  return {*this, cover_.kind, albedo_};
}

}  // namespace alpenglow::renderer
