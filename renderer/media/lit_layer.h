// SPDX-License-Identifier: MIT
// The light of a layer (LayerLight) as one of the media of a scene.
#pragma once

#include <glm/vec3.hpp>
#include <memory>

#include "renderer/media/exponential_layer.h"
#include "renderer/media/layer_light.h"
#include "renderer/media/lit_medium.h"

namespace alpenglow::renderer {

class LitLayer final : public LitMedium {
 public:
  /// Refers to both.
  LitLayer(const ExponentialLayer& layer, const MediaSources& sources);

  [[nodiscard]] std::unique_ptr<const MediumOnRay> OnRay(
      const glm::dvec3& origin, const glm::dvec3& direction) const override;
  void AddDepthToLight(const glm::dvec3& point, const glm::dvec3& to_disk,
                       SpectrumOf<double>& depth) const override;
  [[nodiscard]] float SkyLeft(double altitude_m) const override;
  void ChangeSky(double altitude_m, double cos_up, SkyThroughMedia& sky) const override;

 private:
  class OnOneRay;

  /// Returns the optical depth of the layer between a point and the sun.
  [[nodiscard]] double DepthToSun(const glm::dvec3& point) const;

  const ExponentialLayer& layer_;
  const MediaSources& sources_;
  LayerLight light_;
};

}  // namespace alpenglow::renderer
