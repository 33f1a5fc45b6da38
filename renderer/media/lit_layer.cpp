// SPDX-License-Identifier: MIT
#include "renderer/media/lit_layer.h"

#include <algorithm>

namespace alpenglow::renderer {

LitLayer::LitLayer(const ExponentialLayer& layer, const MediaSources& sources)
    : layer_(layer),
      sources_(sources),
      light_(layer, sources.air.multiple_scattering(), sources.light.direction,
             sources.SunInAir({0.0, 0.0, layer.HeadAltitude()}),
             sources.PastClouds(std::max(layer.bottom_m(), 0.0))) {}

double LitLayer::DepthToSun(const glm::dvec3& point) const {
  return layer_.optics().extinction_per_m[0] *
         layer_.ColumnToSpace(point, sources_.light.direction.seen);
}

class LitLayer::OnOneRay final : public MediumOnRay {
 public:
  OnOneRay(const LitLayer& lit, const glm::dvec3& origin, const glm::dvec3& direction)
      : lit_(lit), origin_(origin), direction_(direction), look_(lit.light_.LookAlong(direction)) {}

  void AddSource(const LightOnPoint& light, double density, Spectrum& sum) const override {
    const BeamDepths depths{lit_.DepthToSun(light.point),
                            lit_.layer_.optics().extinction_per_m[0] *
                                lit_.layer_.Column(origin_, direction_, light.distance_m)};
    const auto once = static_cast<float>(lit_.light_.beam().Source(look_.beam, depths));
    const LayerLight::Glow glow = lit_.light_.GlowAt(look_, light.altitude_m);
    const Spectrum lit = light.LitThrough(light.depth);
    const Spectrum scattered =
        lit * (once * light.in_air + glow.of_sun) + light.sky_left * glow.of_sky;
    const auto per_m = static_cast<float>(density * lit_.layer_.optics().scattering_per_m[0]);
    const Spectrum& irradiance = lit_.sources_.light.irradiance;
    for (std::size_t band = 0; band < sum.size(); ++band) {
      sum[band] += per_m * irradiance[band] * scattered[band];
    }
  }

 private:
  const LitLayer& lit_;
  glm::dvec3 origin_, direction_;
  LayerLight::Look look_;
};

std::unique_ptr<const MediumOnRay> LitLayer::OnRay(const glm::dvec3& origin,
                                                   const glm::dvec3& direction) const {
  return std::make_unique<OnOneRay>(*this, origin, direction);
}

// The width of the disk does not matter for a layer.
void LitLayer::AddDepthToLight(const glm::dvec3& point, const glm::dvec3& /*to_disk*/,
                               SpectrumOf<double>& depth) const {
  const double of_layer = light_.beam().peak_scale() * DepthToSun(point);
  for (std::size_t band = 0; band < depth.size(); ++band) depth[band] += of_layer;
}

float LitLayer::SkyLeft(double altitude_m) const { return light_.SkyLeft(altitude_m); }

void LitLayer::ChangeSky(double altitude_m, double cos_up, SkyThroughMedia& sky) const {
  const float left = light_.SkyLeft(altitude_m);
  sky.left = left * sky.left;
  sky.added = left * sky.added + light_.OnSurface(altitude_m, cos_up);
}

}  // namespace alpenglow::renderer
