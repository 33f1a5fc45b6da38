// SPDX-License-Identifier: MIT
#include "renderer/media/lit_layer.h"

namespace alpenglow::renderer {

LitLayer::LitLayer(const ExponentialLayer& layer, const MediaSources& sources)
    : layer_(layer),
      sources_(sources),
      light_(layer, sources.air.multiple_scattering(), sources.light.direction,
             sources.SunInAir({0.0, 0.0, layer.HeadAltitude()})) {}

double LitLayer::DepthToSun(const glm::dvec3& point) const {
  return layer_.optics().extinction_per_m[0] *
         layer_.ColumnToSpace(point, sources_.light.direction.seen);
}

class LitLayer::OnOneRay final : public MediumOnRay {
 public:
  OnOneRay(const LitLayer& lit, const glm::dvec3& direction)
      : lit_(lit), look_(lit.light_.LookAlong(direction)) {}

  void AddSource(const LightOnPoint& light, double density, Spectrum& sum) const override {
    const Spectrum lit = light.LitThrough(light.depth);
    const LayerLight::Scattered scattered = lit_.light_.At(
        look_, light.altitude_m, lit * light.in_air, lit, lit_.DepthToSun(light.point));
    const auto per_m = static_cast<float>(density * lit_.layer_.optics().scattering_per_m[0]);
    const Spectrum& irradiance = lit_.sources_.light.irradiance;
    for (std::size_t band = 0; band < sum.size(); ++band) {
      sum[band] += per_m * irradiance[band] *
                   (scattered.of_sun[band] + light.sky_left * scattered.of_sky[band]);
    }
  }

 private:
  const LitLayer& lit_;
  LayerLight::Look look_;
};

std::unique_ptr<const MediumOnRay> LitLayer::OnRay(const glm::dvec3& direction) const {
  return std::make_unique<OnOneRay>(*this, direction);
}

// The width of the disk does not matter for a layer.
void LitLayer::AddDepthToLight(const glm::dvec3& point, const glm::dvec3& /*to_disk*/,
                               SpectrumOf<double>& depth) const {
  const double of_layer = light_.peak_scale() * DepthToSun(point);
  for (std::size_t band = 0; band < depth.size(); ++band) depth[band] += of_layer;
}

float LitLayer::SkyLeft(double altitude_m) const { return light_.SkyLeft(altitude_m); }

void LitLayer::ChangeSky(double altitude_m, double cos_up, SkyThroughMedia& sky) const {
  const float left = light_.SkyLeft(altitude_m);
  sky.left = left * sky.left;
  sky.added = left * sky.added + light_.OnSurface(altitude_m, cos_up);
}

}  // namespace alpenglow::renderer
