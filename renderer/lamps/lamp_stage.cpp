// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_stage.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/surface/inside_planet.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

SpectrumOf<double> ScaledBands(const std::vector<double>& values, double scale) {
  SpectrumOf<double> bands(values.size());
  for (std::size_t band = 0; band < values.size(); ++band) bands[band] = scale * values[band];
  return bands;
}

/// Returns the scale height of the exponential that matches the molecules' density at the ground
/// and 4 km up. It is within 2 % of the density between them, where lamps are.
double MoleculeHeight_m(const Medium& medium) {
  constexpr double kHigh_m = 4000.0;
  return -kHigh_m / std::log(MoleculeDensity(medium, kHigh_m));
}

LampLayer Drops(const MediumLayer& layer, double base_m, std::size_t bands) {
  LampLayer drops;
  drops.scale_height_m = layer.scale_height_m;
  drops.base_m = base_m;
  const std::vector<double> grey(bands, layer.extinction_per_m);
  drops.scattering_per_m = ScaledBands(grey, layer.albedo);
  drops.extinction_per_m = ScaledBands(grey, 1.0);
  drops.phase = layer.phase;
  return drops;
}

/// The first layers are those of the air.
constexpr std::size_t kAirLayers = 2;

/// Returns the layers of molecules and aerosol.
std::vector<LampLayer> LampLayersOf(const Medium& medium) {
  LampLayer molecules;
  molecules.scale_height_m = MoleculeHeight_m(medium);
  molecules.scattering_per_m = ScaledBands(medium.rayleigh_scattering_per_m, 1.0);
  molecules.extinction_per_m = molecules.scattering_per_m;
  molecules.phase.kind = PhaseKind::kRayleigh;
  LampLayer aerosol;
  aerosol.scale_height_m = medium.mie_scale_height_m;
  aerosol.scattering_per_m = ScaledBands(medium.mie_scattering_per_m, 1.0);
  aerosol.extinction_per_m = ScaledBands(medium.mie_extinction_per_m, 1.0);
  // Paths from lamps are short, so their light is scattered with the phase function of the middle
  // wavelength.
  aerosol.phase = MiePhase(medium, medium.wavelengths_nm.size() / 2);
  return {molecules, aerosol};
}

}  // namespace

LampStage::LampStage(const Scene& scene, const SceneGround& ground, const Medium& medium)
    : ground_(&ground),
      planet_radius_m_(medium.planet_radius_m),
      layers_(LampLayersOf(medium)),
      bands_(medium.wavelengths_nm.size()) {
  for (const MediumLayer& layer : scene.layers) {
    const double base_m = layer.base_height_m.value_or(TerrainUnder({0.0, 0.0, 0.0}, 0.0));
    layers_.push_back(Drops(layer, base_m, bands_));
  }
  ALPENGLOW_ENSURE(layers_.size(), <=, kMostLampLayers);
}

double LampStage::AltitudeOf(const glm::dvec3& point) const {
  return AltitudeOverSphere(point, planet_radius_m_);
}

glm::dvec3 LampStage::UpAt(const glm::dvec3& point) const {
  return glm::normalize(point + glm::dvec3(0.0, 0.0, planet_radius_m_));
}

std::optional<SurfaceUnder> LampStage::TerrainAt(const glm::dvec3& point) const {
  if (!ground_->terrain) return std::nullopt;
  return SurfaceUnderPoint(*ground_->terrain, point, {0.0, 0.0, 1.0});
}

double LampStage::TerrainUnder(const glm::dvec3& point, double otherwise) const {
  const std::optional<SurfaceUnder> surface = TerrainAt(point);
  return surface ? point.z + surface->height_m : otherwise;
}

double LampStage::HeightOverGround(const glm::dvec3& point) const {
  const double none = point.z - AltitudeOf(point);
  return std::max(point.z - TerrainUnder(point, none), 0.0);
}

double LampStage::PlanetUnder(const glm::dvec3& point) const {
  const double across = std::min(std::hypot(point.x, point.y) / planet_radius_m_, 1.0);
  return -planet_radius_m_ * across * across / (1.0 + std::sqrt(1.0 - across * across));
}

bool LampStage::HiddenByPlanet(const glm::dvec3& from, const glm::dvec3& to) const {
  return PlanetHides(from, to, planet_radius_m_,
                     [&](const glm::dvec3& point) { return TerrainAt(point).has_value(); });
}

bool LampStage::Sees(const glm::dvec3& from, const glm::dvec3& to) const {
  if (HiddenByPlanet(from, to)) return false;
  if (!ground_->terrain) return true;
  const glm::dvec3 way = to - from;
  const double length = glm::length(way);
  if (length < 1e-6) return true;
  return !ground_->terrain->Occluded(from, way / length, way / length, length);
}

bool LampStage::Shades(const Lamp& lamp, const glm::dvec3& smooth_point,
                       const glm::dvec3& geometric_normal) const {
  const glm::dvec3 way = lamp.position_m - smooth_point;
  const double distance = std::max(glm::length(way), lamp.radius_m);
  if (HiddenByPlanet(smooth_point, lamp.position_m)) return true;
  return ground_->terrain &&
         ground_->terrain->Occluded(smooth_point, geometric_normal, way / distance, distance);
}

LampAir LampStage::AirAround(const glm::dvec3& middle) const {
  LampAir air;
  air.layers = layers_;
  air.up = UpAt(middle);
  air.altitude_at_origin_m = AltitudeOf(middle) - glm::dot(air.up, middle);
  return air;
}

Spectrum LampStage::LayerTransmittance(const glm::dvec3& from, const glm::dvec3& direction,
                                       double length_m) const {
  // A layer ends where it is 50 scale heights thin; a homogeneous layer has no end.
  const double length = std::isinf(length_m) ? 1e6 : length_m;
  SpectrumOf<double> depth(bands_);
  for (const LampLayer& layer : std::span(layers_).subspan(kAirLayers)) {
    if (layer.extinction_per_m[0] <= 0.0) continue;
    const double column =
        layer.ColumnBetween(length, AltitudeOf(from), AltitudeOf(from + length * direction));
    for (std::size_t band = 0; band < bands_; ++band)
      depth[band] += layer.extinction_per_m[band] * column;
  }
  Spectrum left(bands_);
  for (std::size_t band = 0; band < bands_; ++band)
    left[band] = static_cast<float>(std::exp(-depth[band]));
  return left;
}

}  // namespace alpenglow::renderer
