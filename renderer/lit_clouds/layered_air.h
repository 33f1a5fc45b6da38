// SPDX-License-Identifier: MIT
// The light of clouds that are the same at every place, solved together with the air around them.
//
// Air and clouds are one stack of plane layers over the ground (layers/layer_stack.h), solved in each
// band in 12 streams; the same air without clouds is another stack. A clear sky is known better, with
// the round planet, so that only differences and ratios of both are used:
//
//   d = d_clear + (d'_clouds - d'_clear)     diffuse light downwards, likewise upwards
//   J = J_clear J'_clouds / J'_clear         light that air scatters more than once
//
// with d' and J' of the stacks. J' is by direction, and has the light that clouds scatter once. The beam
// behind clouds has the light in their forward peak.
//
// The beam has the air mass of the round planet: its cosine in a stack is that with which the vertical
// optical depth of all air leaves as much of the beam. Ozone dims the beam above all layers.
#pragma once

#include <cstddef>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/layer.h"
#include "renderer/layers/layer_field.h"
#include "renderer/lit_clouds/air_layers.h"
#include "renderer/lit_clouds/cloud_chords.h"

namespace alpenglow::renderer {

/// A plane-parallel layer of clouds. Its optical depth counts as even over its altitudes.
struct LayeredCloud {
  AltitudeRange range_m;
  LayerOptics optics;
};

/// The sun over a stack.
struct LayeredSun {
  double mu_s;                        // on the round planet, > 0
  std::vector<double> cosine_of_air;  // of each band: with the air mass, in (0, 1]
  std::vector<double> optical_depth;  // of each band: vertical, of all air with ozone
};

/// @param mu_s  cosine of the sun's zenith angle on level ground, in (0, 1].
[[nodiscard]] LayeredSun SunOverLayers(const SolvedAir& air, double mu_s);

/// The light of one sun in clouds and air. Immutable; safe to use from many threads.
class LayeredAir {
 public:
  /// @param clouds  at least one, of altitudes from 0 on. Throws InputError of LayerStack.
  LayeredAir(const Medium& medium, const std::vector<LayeredCloud>& clouds, const LayeredSun& sun);

  /// Diffuse irradiances of level planes with clouds less those without, per unit solar irradiance.
  struct Change {
    Spectrum down, up;
  };
  [[nodiscard]] Change ChangeAt(double altitude_m) const;

  /// Returns the light that air scatters more than once into a direction, relative to that without
  /// clouds: the mean of layers of air, weighted by their depth.
  /// @param stretch_m  altitudes of a part of a ray on one side of every cloud.
  /// @param way  in which the light travels, with the azimuth from that of the beam.
  [[nodiscard]] Spectrum FactorTowards(const AltitudeRange& stretch_m, const LightWay& way) const;
  /// Returns the same for the mean over all directions.
  [[nodiscard]] Spectrum MeanFactor(const AltitudeRange& stretch_m) const;

 private:
  /// Light of one band that a layer scatters more than once, by azimuth mode and degree
  /// (LayerField::SourceOfHigherOrders).
  struct Sources {
    std::vector<double> clouds, clear;
  };
  struct Layer {
    AltitudeRange range_m;
    bool is_cloudy;
    std::vector<Sources> bands;  // in its middle
  };

  /// @param harmonics  of the way; the first one alone: of the mean over all directions.
  [[nodiscard]] Spectrum FactorFor(const AltitudeRange& stretch_m,
                                   const std::vector<double>& harmonics) const;
  void AddBand(const std::vector<LayeredCloud>& clouds, const LayeredSun& sun, std::size_t band);
  /// Returns the optical depth of the air of a layer that a stretch passes, in the first band.
  [[nodiscard]] double AirWithin(const Layer& layer, const AltitudeRange& stretch_m) const;

  AirLayers air_;
  std::vector<Layer> layers_;    // from the highest to the lowest
  std::vector<Change> changes_;  // at their interfaces
};

}  // namespace alpenglow::renderer
