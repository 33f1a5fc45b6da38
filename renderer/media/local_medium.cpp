// SPDX-License-Identifier: MIT
#include "renderer/media/local_medium.h"

namespace alpenglow::renderer {

SpectrumOf<double> InBands(const std::vector<double>& values, std::size_t bands) {
  SpectrumOf<double> spectrum(bands);
  for (std::size_t band = 0; band < bands; ++band)
    spectrum[band] = values.size() == 1 ? values.front() : values[band];
  return spectrum;
}

MediumOptics OpticsFromLists(const std::vector<double>& extinction_per_m,
                             const std::vector<double>& albedo, const PhaseFunction& phase,
                             std::size_t bands) {
  const SpectrumOf<double> extinction = InBands(extinction_per_m, bands);
  return {extinction, extinction * InBands(albedo, bands), SpectrumOf<double>(bands), phase};
}

std::optional<double> TerrainTop(const SceneGround& ground, double x, double y) {
  constexpr double kAbove_m = 20000.0;
  if (!ground.terrain) return std::nullopt;
  const auto hit = ground.terrain->Intersect({x, y, kAbove_m}, {0.0, 0.0, -1.0});
  if (!hit) return std::nullopt;
  return kAbove_m - hit->distance_m;
}

}  // namespace alpenglow::renderer
