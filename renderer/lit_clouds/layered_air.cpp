// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/layered_air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "renderer/layers/layer_beam.h"
#include "renderer/layers/layer_stack.h"
#include "renderer/layers/stream_set.h"

namespace alpenglow::renderer {
namespace {

double Overlap_m(const AltitudeRange& a, const AltitudeRange& b) {
  return std::max(std::min(a.high_m, b.high_m) - std::max(a.low_m, b.low_m), 0.0);
}

/// Returns Lambda_l^m(mu) cos(m azimuth), in the order of LayerField::SourceOfHigherOrders.
std::vector<double> HarmonicsOf(const LightWay& way) {
  std::vector<double> harmonics;
  for (int m = 0; m < kLayerStreams; ++m) {
    for (const double value : AssociatedLegendre(m, kLayerStreams - 1, way.mu))
      harmonics.push_back(value * std::cos(m * way.azimuth));
  }
  return harmonics;
}

double Into(const std::vector<double>& harmonics, const std::vector<double>& source) {
  return std::inner_product(harmonics.begin(), harmonics.end(), source.begin(), 0.0);
}

}  // namespace

LayeredSun SunOverLayers(const SolvedAir& air, double mu_s) {
  const Spectrum zenith = air.BeamLeft(0.0, 1.0), slant = air.BeamLeft(0.0, mu_s);
  LayeredSun sun{mu_s, {}, {}};
  for (std::size_t band = 0; band < zenith.size(); ++band) {
    const double vertical = -std::log(static_cast<double>(zenith[band]));
    const double along = -std::log(static_cast<double>(slant[band]));
    sun.optical_depth.push_back(std::isfinite(vertical) ? vertical : 0.0);
    sun.cosine_of_air.push_back(
        vertical > 0.0 && std::isfinite(along) ? std::clamp(vertical / along, mu_s, 1.0) : mu_s);
  }
  return sun;
}

LayeredAir::LayeredAir(const Medium& medium, const std::vector<LayeredCloud>& clouds,
                       const LayeredSun& sun)
    : air_(medium, kLayerStreams) {
  std::vector<double> cuts_m = air_.Cuts_m();
  for (const LayeredCloud& cloud : clouds) {
    cuts_m.push_back(cloud.range_m.low_m);
    cuts_m.push_back(cloud.range_m.high_m);
  }
  std::sort(cuts_m.begin(), cuts_m.end(), std::greater<>());
  cuts_m.erase(std::unique(cuts_m.begin(), cuts_m.end()), cuts_m.end());
  for (std::size_t i = 0; i + 1 < cuts_m.size(); ++i) {
    const AltitudeRange range_m{cuts_m[i + 1], cuts_m[i]};
    const bool is_cloudy = std::any_of(clouds.begin(), clouds.end(), [&](const auto& cloud) {
      return Overlap_m(cloud.range_m, range_m) > 0.0;
    });
    layers_.push_back({range_m, is_cloudy, {}});
  }
  changes_.assign(layers_.size() + 1, {Spectrum(air_.bands()), Spectrum(air_.bands())});
  for (std::size_t band = 0; band < air_.bands(); ++band) AddBand(clouds, sun, band);
}

void LayeredAir::AddBand(const std::vector<LayeredCloud>& clouds, const LayeredSun& sun,
                         std::size_t band) {
  std::vector<LayerOptics> clear, cloudy;
  for (const Layer& layer : layers_) {
    clear.push_back(air_.Between(layer.range_m, band));
    std::vector<LayerOptics> mixture{clear.back()};
    for (const LayeredCloud& cloud : clouds) {
      const double whole_m = cloud.range_m.high_m - cloud.range_m.low_m;
      mixture.push_back(cloud.optics);
      mixture.back().optical_depth *= Overlap_m(cloud.range_m, layer.range_m) / whole_m;
    }
    cloudy.push_back(MixedLayer(mixture));
  }
  const double albedo = air_.medium().ground_albedo[band], mu_s = sun.cosine_of_air[band];
  const LayerStack clear_stack(clear, albedo, kLayerStreams);
  const LayerStack cloudy_stack(cloudy, albedo, kLayerStreams);
  const LayerField without = LayerField::UnderSun(clear_stack, mu_s);
  const LayerField with = LayerField::UnderSun(cloudy_stack, mu_s);
  // The beam of unit irradiance has the cosine of the round planet on level ground.
  const double absorbed = sun.optical_depth[band] - clear_stack.DepthAbove(layers_.size());
  const double irradiance = sun.mu_s / mu_s * std::exp(-std::max(absorbed, 0.0) / mu_s);
  for (std::size_t i = 0; i <= layers_.size(); ++i) {
    const LayerFluxes a = with.Fluxes(cloudy_stack.DepthAbove(i));
    const LayerFluxes b = without.Fluxes(clear_stack.DepthAbove(i));
    changes_[i].down[band] = static_cast<float>(irradiance * (a.down - b.down));
    changes_[i].up[band] = static_cast<float>(irradiance * (a.up - b.up));
  }
  const auto middle = [](const LayerStack& stack, std::size_t i) {
    return 0.5 * (stack.DepthAbove(i) + stack.DepthAbove(i + 1));
  };
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    layers_[i].bands.push_back({with.SourceOfHigherOrders(middle(cloudy_stack, i)),
                                without.SourceOfHigherOrders(middle(clear_stack, i))});
  }
}

LayeredAir::Change LayeredAir::ChangeAt(double altitude_m) const {
  std::size_t i = 0;
  while (i + 1 < layers_.size() && layers_[i].range_m.low_m > altitude_m) ++i;
  const AltitudeRange& range_m = layers_[i].range_m;
  const double within = (range_m.high_m - altitude_m) / (range_m.high_m - range_m.low_m);
  const auto share = static_cast<float>(std::clamp(within, 0.0, 1.0));
  const auto between = [&](const Spectrum& above, const Spectrum& below) {
    return (1.0F - share) * above + share * below;
  };
  return {between(changes_[i].down, changes_[i + 1].down),
          between(changes_[i].up, changes_[i + 1].up)};
}

double LayeredAir::AirWithin(const Layer& layer, const AltitudeRange& stretch_m) const {
  const AltitudeRange within_m{std::max(layer.range_m.low_m, stretch_m.low_m),
                               std::min(layer.range_m.high_m, stretch_m.high_m)};
  return within_m.high_m > within_m.low_m ? air_.Between(within_m, 0).optical_depth : 0.0;
}

Spectrum LayeredAir::FactorTowards(const AltitudeRange& stretch_m, const LightWay& way) const {
  return FactorFor(stretch_m, HarmonicsOf(way));
}

Spectrum LayeredAir::MeanFactor(const AltitudeRange& stretch_m) const {
  return FactorFor(stretch_m, {1.0});
}

Spectrum LayeredAir::FactorFor(const AltitudeRange& stretch_m,
                               const std::vector<double>& harmonics) const {
  std::vector<double> clouds(air_.bands(), 0.0), clear = clouds;
  for (const Layer& layer : layers_) {
    const double weight = layer.is_cloudy ? 0.0 : AirWithin(layer, stretch_m);
    if (!(weight > 0.0)) continue;
    for (std::size_t band = 0; band < clouds.size(); ++band) {
      clouds[band] += weight * Into(harmonics, layer.bands[band].clouds);
      clear[band] += weight * Into(harmonics, layer.bands[band].clear);
    }
  }
  Spectrum factor(air_.bands(), 1.0F);
  for (std::size_t band = 0; band < factor.size(); ++band) {
    if (clear[band] > 0.0)
      factor[band] = static_cast<float>(std::max(clouds[band] / clear[band], 0.0));
  }
  return factor;
}

}  // namespace alpenglow::renderer
