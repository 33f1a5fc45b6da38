// SPDX-License-Identifier: MIT
#include "renderer/media/local_media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "renderer/scene/volume_file.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

constexpr double kThin = 1e-9;

}  // namespace

FogLayer::FogLayer(double base_m, double scale_height_m, double planet_radius_m, double top_m)
    : base_m_(base_m),
      scale_height_m_(scale_height_m),
      planet_radius_m_(planet_radius_m),
      top_m_(top_m),
      thin_m_(std::isinf(scale_height_m)
                  ? top_m
                  : std::min(base_m - scale_height_m * std::log(kThin), top_m)) {
  ALPENGLOW_ENSURE(scale_height_m, >, 0.0);
}

double FogLayer::AltitudeOf(const glm::dvec3& point) const {
  return AltitudeOverSphere(point, planet_radius_m_);
}

double FogLayer::DensityAtAltitude(double altitude_m) const {
  if (altitude_m > thin_m_) return 0.0;
  return shared::FogDensity(altitude_m - base_m_, scale_height_m_);
}

std::vector<DensePiece> FogLayer::PiecesAlong(const glm::dvec3& origin, const glm::dvec3& direction,
                                              double length_m) const {
  const glm::dvec3 from = origin + glm::dvec3(0.0, 0.0, planet_radius_m_);
  const double lowest_m = -glm::dot(from, direction);
  const double perigee_m = AltitudeOf(origin + lowest_m * direction);
  if (perigee_m >= thin_m_) return {};
  const double half =
      std::sqrt((thin_m_ - perigee_m) * (2.0 * planet_radius_m_ + thin_m_ + perigee_m));
  const double begin = std::max(lowest_m - half, 0.0);
  const double end = std::min(lowest_m + half, length_m);
  std::vector<DensePiece> pieces;
  const auto add = [&](double a, double b) {
    if (!(a < b)) return;
    const double most =
        std::max(DensityAt(origin + a * direction), DensityAt(origin + b * direction));
    if (most > 0.0) pieces.push_back({a, b, most});
  };
  add(begin, std::min(end, std::max(begin, lowest_m)));
  add(std::max(begin, std::min(end, lowest_m)), end);
  return pieces;
}

double FogLayer::ColumnAbove(double altitude_m) const {
  if (std::isinf(scale_height_m_)) return std::max(top_m_ - altitude_m, 0.0);
  return scale_height_m_ * DensityAtAltitude(altitude_m);
}

double FogLayer::ColumnToSpace(const glm::dvec3& point, const glm::dvec3& direction) const {
  const double altitude = AltitudeOf(point);
  const double r = planet_radius_m_ + altitude;
  const double mu = std::clamp(
      glm::dot(point + glm::dvec3(0.0, 0.0, planet_radius_m_), direction) / r, -1.0, 1.0);
  if (std::isinf(scale_height_m_)) {
    const double rest = (top_m_ - altitude) * (planet_radius_m_ + top_m_ + r);
    return rest <= 0.0 ? 0.0 : rest / (r * mu + std::sqrt(r * r * mu * mu + rest));
  }
  const auto upwards = [&](double from_m, double cosine) {
    return shared::FogColumnUp(from_m, cosine, DensityAtAltitude(from_m), scale_height_m_,
                               planet_radius_m_);
  };
  if (mu >= 0.0) return upwards(altitude, mu);
  const double perigee = altitude - r * (1.0 - std::sqrt(1.0 - mu * mu));
  return std::max(2.0 * upwards(perigee, 0.0) - upwards(altitude, -mu), 0.0);
}

namespace {

constexpr double kAboveMedia_m = 20000.0;

// Returns the value of a band from a list with one value, or one per band.
double ValueAt(const std::vector<double>& values, std::size_t band) {
  return values.size() == 1 ? values.front() : values[band];
}

MediumOptics OpticsOf(const Volume& volume, const std::vector<double>& wavelengths_nm) {
  const std::size_t bands = wavelengths_nm.size();
  MediumOptics optics{Bands<double>(bands), Bands<double>(bands), Bands<double>(bands),
                      volume.phase};
  for (std::size_t band = 0; band < bands; ++band) {
    const double extinction = ValueAt(volume.extinction_per_m, band);
    const double albedo = ValueAt(volume.albedo, band);
    optics.extinction_per_m[band] = extinction;
    optics.scattering_per_m[band] = extinction * albedo;
    optics.emission_per_m[band] = ValueAt(volume.emission_per_m, band);
    // Kirchhoff's law: absorption implies emission.
    if (volume.temperature_k) {
      optics.emission_per_m[band] += extinction * (1.0 - albedo) *
                                     BlackBodyRadiance(wavelengths_nm[band], *volume.temperature_k);
    }
  }
  return optics;
}

MediumOptics OpticsOf(const Fog& fog, std::size_t bands) {
  MediumOptics optics{Bands<double>(bands), Bands<double>(bands), Bands<double>(bands), fog.phase};
  for (std::size_t band = 0; band < bands; ++band) {
    optics.extinction_per_m[band] = fog.extinction_per_m;
    optics.scattering_per_m[band] = fog.extinction_per_m * fog.albedo;
  }
  return optics;
}

VolumePlacement PlacementOf(const Volume& volume, const SceneGround& ground) {
  GeodeticPosition place{volume.latitude_rad, volume.longitude_rad, 0.0};
  if (!volume.height.above_ground) place.height_m = volume.height.value_m;
  VolumePlacement placement;
  placement.bottom = ground.frame.EnuFromGeodetic(place).xyz;
  place.height_m += 1000.0;
  placement.up = (ground.frame.EnuFromGeodetic(place).xyz - placement.bottom) / 1000.0;
  if (volume.height.above_ground) {
    if (ground.terrain) {
      const auto hit = ground.terrain->Intersect(
          {placement.bottom.x, placement.bottom.y, kAboveMedia_m}, {0.0, 0.0, -1.0});
      if (hit) placement.bottom.z = kAboveMedia_m - hit->distance_m;
    }
    placement.bottom += volume.height.value_m * placement.up;
  }
  const glm::dvec3 ahead(std::sin(volume.heading_rad), std::cos(volume.heading_rad), 0.0);
  placement.up = glm::normalize(placement.up);
  placement.ahead = glm::normalize(ahead - glm::dot(ahead, placement.up) * placement.up);
  placement.across = glm::cross(placement.ahead, placement.up);
  placement.size_m = {volume.size_m[0], volume.size_m[1], volume.size_m[2]};
  placement.shape = volume.shape;
  return placement;
}

std::shared_ptr<const VolumeGrid> GridOf(const Volume& volume) {
  if (volume.grid.empty()) return nullptr;
  return std::make_shared<const VolumeGrid>(
      volume.grid_size ? ReadRawGrid(volume.grid, *volume.grid_size) : ReadNrrd(volume.grid));
}

double FogBase(const Fog& fog, const SceneGround& ground) {
  if (fog.base_height_m) return *fog.base_height_m;
  if (!ground.terrain) return 0.0;
  const auto hit = ground.terrain->Intersect({0.0, 0.0, kAboveMedia_m}, {0.0, 0.0, -1.0});
  return hit ? kAboveMedia_m - hit->distance_m : 0.0;
}

/// Returns the altitude of the lowest ground under the fog: that of the terrain, or of the planet
/// around it if the fog lies wholly below the terrain; no value if there is no fog above the
/// ground.
std::optional<double> FogBottom(const FogLayer& fog, const SceneGround& ground) {
  std::vector<double> lowest_m;
  if (ground.terrain) {
    lowest_m.push_back(std::numeric_limits<double>::infinity());
    for (const auto& [x, y, z] : ground.terrain->mesh().positions) {
      lowest_m.front() = std::min(lowest_m.front(), fog.AltitudeOf({x, y, z}));
    }
  }
  lowest_m.push_back(0.0);
  for (const double lowest : lowest_m) {
    const double bottom = std::max(fog.base_m(), lowest);
    if (fog.ColumnAbove(bottom) > 0.0) return bottom;
  }
  return std::nullopt;
}

}  // namespace

double LocalMedium::DensityAt(const glm::dvec3& point) const {
  return std::visit([&](const auto& of) { return of.DensityAt(point); }, body);
}

std::vector<DensePiece> LocalMedium::PiecesAlong(const glm::dvec3& origin,
                                                 const glm::dvec3& direction,
                                                 double length_m) const {
  return std::visit([&](const auto& of) { return of.PiecesAlong(origin, direction, length_m); },
                    body);
}

double LocalMedium::ColumnTowards(const glm::dvec3& point, const glm::dvec3& direction) const {
  if (const FogLayer* layer = fog()) return layer->ColumnToSpace(point, direction);
  return volume()->Column(point, direction, std::numeric_limits<double>::infinity());
}

namespace {

/// Returns whether a volume neither attenuates nor emits. Cutting rays at it would only add
/// rounding errors.
bool IsVoid(const Volume& volume) {
  const auto is_zero = [](double value) { return value == 0.0; };
  return std::all_of(volume.extinction_per_m.begin(), volume.extinction_per_m.end(), is_zero) &&
         std::all_of(volume.emission_per_m.begin(), volume.emission_per_m.end(), is_zero);
}

}  // namespace

LocalMedia::LocalMedia(const Scene& scene, const SceneGround& ground, const Medium& medium)
    : bands_(medium.wavelengths_nm.size()) {
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const Volume& volume = scene.volumes[i];
    try {
      LocalMedium made{
          LocalVolume(PlacementOf(volume, ground), volume.scale_height_m, GridOf(volume)),
          OpticsOf(volume, medium.wavelengths_nm)};
      if (!IsVoid(volume)) all_.push_back(std::move(made));
    } catch (const InputError& error) {
      throw InputError(fmt::format("volume {}: {}", i + 1, error.what()));
    }
  }
  if (scene.fog && scene.fog->extinction_per_m > 0.0) {
    const FogLayer layer(FogBase(*scene.fog, ground), scene.fog->scale_height_m,
                         medium.planet_radius_m, medium.atmosphere_height_m);
    if (const std::optional<double> bottom_m = FogBottom(layer, ground)) {
      all_.push_back({layer, OpticsOf(*scene.fog, bands_)});
      fog_bottom_m_ = *bottom_m;
    }
  }
}

LocalMedia::LocalMedia(std::vector<LocalMedium> all, std::size_t bands)
    : all_(std::move(all)), bands_(bands) {
  if (fog() != nullptr) fog_bottom_m_ = all_.back().fog()->base_m();
}

LocalMedia LocalMedia::WithoutGlow() const {
  LocalMedia dark = *this;
  for (LocalMedium& medium : dark.all_) medium.optics.emission_per_m = Bands<double>(bands_);
  return dark;
}

LocalMedia LocalMedia::Only(bool volumes, bool with_fog) const {
  LocalMedia some = *this;
  std::erase_if(some.all_, [&](const LocalMedium& medium) {
    return medium.fog() != nullptr ? !with_fog : !volumes;
  });
  return some;
}

Bands<double> LocalMedia::OpticalDepthTowards(const glm::dvec3& point,
                                              const glm::dvec3& direction) const {
  Bands<double> depth(bands_);
  for (const LocalMedium& medium : all_) {
    const double column = medium.ColumnTowards(point, direction);
    if (column == 0.0) continue;
    for (std::size_t band = 0; band < bands_; ++band) {
      depth[band] += column * medium.optics.extinction_per_m[band];
    }
  }
  return depth;
}

}  // namespace alpenglow::renderer
