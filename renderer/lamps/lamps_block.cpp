// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamps_block.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_forms.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

template <typename Values>
glm::vec4 FloatsOf(const Values& values, std::size_t count) {
  ALPENGLOW_ENSURE(count, <=, std::size_t{4});
  glm::vec4 bands(0.0F);
  for (std::size_t band = 0; band < count; ++band) {
    bands[static_cast<glm::length_t>(band)] = static_cast<float>(static_cast<double>(values[band]));
  }
  return bands;
}

/// Packs lamps for the GPU. Altitudes above the plane of a lamp's air are relative to
/// `reference_m`.
class LampPacking {
 public:
  LampPacking(const LampView& view, double reference_m, double planet_radius_m)
      : view_(view), reference_m_(reference_m), planet_radius_m_(planet_radius_m) {}

  [[nodiscard]] GpuLamp Packed(const ChosenLamp& chosen, bool with_core) const {
    const PlacedLamp& placed = *chosen.placed;
    const LampAlongRay along = AlongRay(placed, placed.direction, view_.pixel_angle_rad);
    const double z_eye = placed.air.AltitudeOf(view_.from_eye.origin_m());
    const double z_lamp = placed.air.AltitudeOf(placed.lamp.position_m);
    GpuLamp gpu{};
    gpu.position = {Turned(placed.lamp.position_m - view_.from_eye.origin_m()),
                    along.lamp.radius_m};
    gpu.intensity = FloatsOf(placed.intensity.values(), placed.intensity.size());
    gpu.axis = {Turned(placed.lamp.axis), static_cast<float>(placed.lamp.profile.kind)};
    gpu.side = {Turned(placed.lamp.side), static_cast<float>(chosen.table)};
    gpu.profile = {Edges(placed.lamp.profile), placed.distance_m, placed.HoldsEye() ? 1.0 : 0.0};
    gpu.up = {Turned(placed.air.up), z_eye - reference_m_};
    gpu.at_eye = {Densities(placed.air, z_eye), z_lamp - reference_m_};
    gpu.at_lamp = {Densities(placed.air, z_lamp), placed.lamp.radius_m};
    gpu.glow = {placed.mean_share, chosen.glow, with_core ? CoreOf(placed) : 0.0, 0.0};
    gpu.shade = {chosen.shade, chosen.first_plan, chosen.plan_levels,
                 AltitudeOverSphere(placed.lamp.position_m, planet_radius_m_)};
    return gpu;
  }

 private:
  [[nodiscard]] glm::vec3 Turned(const glm::dvec3& of_ground) const {
    return view_.from_eye.AlongBack(of_ground);
  }
  /// Returns the relative size of a lamp's core. Beams have a larger one, because their light
  /// changes over smaller angles than that of a lamp that shines evenly.
  [[nodiscard]] static double CoreOf(const PlacedLamp& placed) {
    constexpr double kOfBeams = 2.0;
    if (placed.HoldsEye()) return 0.0;
    return placed.lamp.profile.kind == LampProfile::Kind::kIsotropic ? 1.0 : kOfBeams;
  }
  /// Returns the cosines at which a cone has full intensity and none.
  [[nodiscard]] static glm::vec2 Edges(const LampProfile& profile) {
    return {std::cos(profile.inner_rad), std::cos(profile.outer_rad)};
  }
  [[nodiscard]] static glm::vec3 Densities(const LampAir& air, double altitude_m) {
    glm::dvec3 densities(0.0);
    for (std::size_t k = 0; k < air.layers.size(); ++k) {
      densities[static_cast<glm::length_t>(k)] = air.layers[k].Density(altitude_m);
    }
    return densities;
  }

  const LampView& view_;
  double reference_m_, planet_radius_m_;
};

void PutAir(const std::vector<LampLayer>& layers, std::size_t bands, double reference_m,
            LampsBlock& block) {
  for (std::size_t k = 0; k < layers.size(); ++k) {
    block.falls[static_cast<glm::length_t>(k)] = static_cast<float>(1.0 / layers[k].scale_height_m);
    block.bases[static_cast<glm::length_t>(k)] = static_cast<float>(layers[k].base_m - reference_m);
  }
  block.molecules = FloatsOf(layers[0].scattering_per_m.values(), bands);
  block.aerosol = FloatsOf(layers[1].scattering_per_m.values(), bands);
  block.dimming = FloatsOf(layers[1].extinction_per_m.values(), bands);
  block.mie_phase = ParametersOf(layers[1].phase);
  if (layers.size() < 3) return;
  ALPENGLOW_ENSURE(layers.size(), ==, std::size_t{3});
  const LampLayer& layer = layers[2];
  block.layer = {layer.scattering_per_m[0], layer.extinction_per_m[0], 0.0, 0.0};
  block.layer_phase = ParametersOf(layer.phase);
}

void PutColours(const BandColour& colour, LampsBlock& block) {
  const std::size_t bands = colour.wavelengths_nm().size();
  const auto rows = colour.linear_srgb_from_bands();
  for (std::size_t channel = 0; channel < 3; ++channel) {
    glm::vec4& row = channel == 0 ? block.red : channel == 1 ? block.green : block.blue;
    row = FloatsOf(rows.subspan(channel * bands, bands), bands);
  }
}

}  // namespace

glm::vec4 ParametersOf(const PhaseFunction& phase) { return glm::vec4(PhaseVectorOf(phase)); }

LampView LampViewFrom(const LocalFrame& ground, const Place& eye, double pixel_angle_rad) {
  return {{ground, LocalFrame(ground.ellipsoid(), eye)}, eye.height_m, pixel_angle_rad};
}

LampsBlock LampsBlockOf(std::vector<ChosenLamp> lamps, const std::vector<LampLayer>& layers,
                        const Medium& medium, const BandColour& colour, const LampView& view,
                        std::array<double, 2> core_rad) {
  ALPENGLOW_ENSURE(lamps.size(), <=, kMostGpuLamps);
  double reference_m = view.altitude_m;
  for (const ChosenLamp& lamp : lamps) {
    reference_m = std::min(reference_m, lamp.placed->air.AltitudeOf(lamp.placed->lamp.position_m));
  }
  LampsBlock block{};
  const auto shaped = std::stable_partition(lamps.begin(), lamps.end(), [](const ChosenLamp& lamp) {
    return lamp.placed->lamp.profile.kind == LampProfile::Kind::kIsotropic &&
           !lamp.placed->HoldsEye();
  });
  block.count = {static_cast<double>(lamps.size()), core_rad[0], std::max(core_rad[1], 1e-9),
                 static_cast<double>(shaped - lamps.begin())};
  block.planet = {medium.planet_radius_m / 1000.0, std::max(view.altitude_m, 0.0) / 1000.0, 0.0,
                  0.0};
  PutAir(layers, medium.wavelengths_nm.size(), reference_m, block);
  PutColours(colour, block);
  const glm::dmat3 eye_from_ground = glm::transpose(view.from_eye.axes());
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    block.ground[static_cast<std::size_t>(axis)] = {glm::vec3(eye_from_ground[axis]), 0.0F};
  }
  const LampPacking packing(view, reference_m, medium.planet_radius_m);
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    block.lamps[i] = packing.Packed(lamps[i], core_rad[1] > 0.0);
  }
  return block;
}

}  // namespace alpenglow::renderer
