// SPDX-License-Identifier: MIT
#include "renderer/lamp/lamp_stage.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/ground/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

Bands<double> InDoubles(const std::vector<double>& values, double scale) {
  Bands<double> bands(values.size());
  for (std::size_t band = 0; band < values.size(); ++band) bands[band] = scale * values[band];
  return bands;
}

/// Scale height of the exponential that has the molecules' density at the ground and 4 km up:
/// within 2 % of it between, where lamps shine.
double MoleculeHeight_m(const Medium& medium) {
  constexpr double kHigh_m = 4000.0;
  return -kHigh_m / std::log(MoleculeDensity(medium, kHigh_m));
}

LampLayer Drops(const Fog& fog, double base_m, std::size_t bands) {
  LampLayer drops;
  drops.scale_height_m = fog.scale_height_m;
  drops.base_m = base_m;
  const std::vector<double> grey(bands, fog.extinction_per_m);
  drops.scattering_per_m = InDoubles(grey, fog.albedo);
  drops.extinction_per_m = InDoubles(grey, 1.0);
  drops.phase = fog.phase;
  return drops;
}

/// Molecules, aerosol and fog.
std::vector<LampLayer> LayersOf(const Medium& medium, const std::optional<Fog>& fog,
                                double fog_base_m) {
  LampLayer molecules;
  molecules.scale_height_m = MoleculeHeight_m(medium);
  molecules.scattering_per_m = InDoubles(medium.rayleigh_scattering_per_m, 1.0);
  molecules.extinction_per_m = molecules.scattering_per_m;
  molecules.phase.kind = PhaseKind::kRayleigh;
  LampLayer aerosol;
  aerosol.scale_height_m = medium.mie_scale_height_m;
  aerosol.scattering_per_m = InDoubles(medium.mie_scattering_per_m, 1.0);
  aerosol.extinction_per_m = InDoubles(medium.mie_extinction_per_m, 1.0);
  // Lamps are near: their light is scattered as at the middle wavelength.
  aerosol.phase = MiePhase(medium, medium.wavelengths_nm.size() / 2);
  std::vector<LampLayer> layers{molecules, aerosol};
  if (fog) layers.push_back(Drops(*fog, fog_base_m, medium.wavelengths_nm.size()));
  return layers;
}

}  // namespace

LampStage::LampStage(const Scene& scene, const SceneGround& ground, const Medium& medium)
    : ground_(&ground),
      planet_radius_m_(medium.planet_radius_m),
      has_fog_(scene.fog.has_value() && scene.fog->extinction_per_m > 0.0),
      bands_(medium.wavelengths_nm.size()) {
  double fog_base_m = 0.0;
  if (scene.fog) fog_base_m = scene.fog->base_height_m.value_or(TerrainUnder({0.0, 0.0, 0.0}, 0.0));
  layers_ = LayersOf(medium, scene.fog, fog_base_m);
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

bool LampStage::Sees(const glm::dvec3& from, const glm::dvec3& to) const {
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

Bands<float> LampStage::FogTransmittance(const glm::dvec3& from, const glm::dvec3& direction,
                                         double length_m) const {
  Bands<float> left(bands_);
  std::fill_n(left.value.begin(), left.count, 1.0F);
  if (!has_fog_) return left;
  const LampLayer& fog = layers_.back();
  // Fog ends where it is 50 scale heights thin; homogeneous fog ends nowhere.
  const double length = std::min(length_m, 1e6);
  const double column =
      fog.ColumnBetween(length, AltitudeOf(from), AltitudeOf(from + length * direction));
  for (std::size_t band = 0; band < left.count; ++band) {
    left[band] = static_cast<float>(std::exp(-fog.extinction_per_m[band] * column));
  }
  return left;
}

}  // namespace alpenglow::renderer
