// SPDX-License-Identifier: MIT
#include "lut/report/report_baselines.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "lut/evaluate/eval.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {
namespace {

float Kilometres(double metres) { return static_cast<float>(metres / kMetresPerKilometre); }

/// Coefficients of one wavelength, in [1/km] and float.
struct BandCoefficients {
  Extinction<float> extinction;
  float mie_scattering;

  BandCoefficients(const Medium& medium, std::size_t band)
      : extinction{PerKilometre(medium.rayleigh_scattering_per_m[band]),
                   PerKilometre(medium.mie_extinction_per_m[band]),
                   PerKilometre(medium.ozone_absorption_per_m[band])},
        mie_scattering(PerKilometre(medium.mie_scattering_per_m[band])) {}

  /// Returns the light that a sample scatters towards the observer under radiance 1 from all
  /// directions.
  [[nodiscard]] float ScatteredAt(const RaySamples<float>& samples, std::size_t i) const {
    const float view = OpticalDepthOf(
        extinction, {samples.view_rayleigh[i], samples.view_mie[i], samples.view_ozone[i]});
    return samples.weight[i] * std::exp(-view) *
           (extinction.rayleigh * samples.rayleigh_density[i] +
            mie_scattering * samples.mie_density[i]);
  }
  [[nodiscard]] float ToSun(const RaySamples<float>& samples, std::size_t i) const {
    return OpticalDepthOf(extinction,
                          {samples.sun_rayleigh[i], samples.sun_mie[i], samples.sun_ozone[i]});
  }

 private:
  static float PerKilometre(double per_m) {
    return static_cast<float>(per_m * kMetresPerKilometre);
  }
};

Spectrum TransmittanceOf(const Medium& medium, float rayleigh_km, float mie_km, float ozone_km) {
  Spectrum result(medium.wavelengths_nm.size());
  for (std::size_t band = 0; band < result.size(); ++band) {
    const BandCoefficients sigma(medium, band);
    result[band] = std::exp(-OpticalDepthOf(sigma.extinction, {rayleigh_km, mie_km, ozone_km}));
  }
  return result;
}

/// Returns the ozone density relative to the peak.
float OzoneDensity(const OzoneLayer& layer, float altitude_km) {
  if (layer.shape == OzoneShape::kSmooth)
    return shared::SmoothOzoneDensity<float>(altitude_km, Kilometres(layer.top_m));
  return shared::TentDensity<float>(altitude_km, Kilometres(layer.bottom_m),
                                    Kilometres(layer.peak_m), Kilometres(layer.top_m));
}

/// Returns the column [km] to space of an exponential layer. Below the horizontal it is twice the
/// column at the perigee minus the column behind the observer.
float ChapmanColumn(ChapmanRule rule, float altitude, float mu, float scale_height, float radius) {
  const auto column = [&](float h, float cosine) {
    return scale_height * std::exp(-h / scale_height) *
           ChapmanFunction(rule, (radius + h) / scale_height, cosine);
  };
  if (mu >= 0.0F) return column(altitude, mu);
  const float perigee = shared::PerigeeAltitude<float>(altitude, mu, radius);
  return 2.0F * column(perigee, 0.0F) - column(altitude, -mu);
}

}  // namespace

std::vector<RayNode> MarchNodes(MarchRule rule, int steps, const RayExtent& extent) {
  const double length = extent.end_m - extent.begin_m;
  const double n = steps;
  std::vector<RayNode> nodes;
  for (int i = 0; i < steps; ++i) {
    if (rule == MarchRule::kQuadratic) {
      const double begin = i / n * (i / n), end = (i + 1) / n * ((i + 1) / n);
      nodes.push_back(
          {extent.begin_m + length * (begin + 0.3 * (end - begin)), length * (end - begin)});
    } else if (rule == MarchRule::kMidpoint) {
      nodes.push_back({extent.begin_m + length * (i + 0.5) / n, length / n});
    } else {
      nodes.push_back({extent.begin_m + length * i / n, length / n * (i == 0 ? 0.5 : 1.0)});
    }
  }
  if (rule == MarchRule::kTrapezoid) nodes.push_back({extent.end_m, 0.5 * length / n});
  return nodes;
}

Spectrum MarchedTransmittance(const Medium& medium, const ViewRay& ray, MarchRule rule, int steps) {
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const float h0 = Kilometres(ray.altitude_m), mu = static_cast<float>(ray.mu);
  const float radius = Kilometres(medium.planet_radius_m);
  const float mie_height = Kilometres(medium.mie_scale_height_m);
  const float length = Kilometres(extent.end_m - extent.begin_m);
  float rayleigh = 0.0F, mie = 0.0F, ozone = 0.0F;
  const auto add = [&](float share, float weight) {
    const float h = std::max(shared::AltitudeAlongRay<float>(
                                 h0, mu, Kilometres(extent.begin_m) + share * length, radius),
                             0.0F);
    rayleigh += weight * static_cast<float>(
                             MoleculeDensity(medium, kMetresPerKilometre * static_cast<double>(h)));
    mie += weight * std::exp(-h / mie_height);
    ozone += weight * OzoneDensity(medium.ozone, h);
  };
  const float step = 1.0F / static_cast<float>(steps);
  const bool trapezoid = rule == MarchRule::kTrapezoid;
  ALPENGLOW_ENSURE(rule != MarchRule::kQuadratic, ==, true);
  for (int i = 0; i < steps; ++i) {
    const float at = static_cast<float>(i) + (trapezoid ? 0.0F : 0.5F);
    add(at * step, trapezoid && i == 0 ? 0.5F * step : step);
  }
  if (trapezoid) add(1.0F, 0.5F * step);
  return TransmittanceOf(medium, length * rayleigh, length * mie, length * ozone);
}

float ChapmanFunction(ChapmanRule rule, float x, float cos_chi) {
  if (rule == ChapmanRule::kSchueler) {
    const float c = std::sqrt(0.5F * std::numbers::pi_v<float> * x);
    return c / ((c - 1.0F) * cos_chi + 1.0F);
  }
  const float c = cos_chi;
  return 0.5F * c + 0.761643F * (1.0F + x * (2.0F - c * c)) /
                        (x * c + std::sqrt(x * (1.47721F + 0.273828F * x * c * c)));
}

Spectrum ChapmanTransmittance(const SingleScattering<float>& air, ChapmanRule rule,
                              const ViewRay& ray) {
  const Medium& medium = air.medium();
  const float h = Kilometres(ray.altitude_m), mu = static_cast<float>(ray.mu);
  const float radius = Kilometres(medium.planet_radius_m);
  const auto ozone = air.ColumnsToSpace(ray.altitude_m, ray.mu)[2];
  const auto share = static_cast<float>(medium.rayleigh_deficit.share);
  const float molecules =
      (1.0F + share) *
          ChapmanColumn(rule, h, mu, Kilometres(medium.rayleigh_scale_height_m), radius) -
      share *
          ChapmanColumn(rule, h, mu, Kilometres(medium.rayleigh_deficit.scale_height_m), radius);
  return TransmittanceOf(medium, molecules,
                         ChapmanColumn(rule, h, mu, Kilometres(medium.mie_scale_height_m), radius),
                         Kilometres(static_cast<double>(ozone)));
}

IsotropicTable::IsotropicTable(const Medium& medium, const Size& size)
    : air_(medium), size_(size), texels_(size.side * size.side * air_.bands()) {
  ALPENGLOW_ENSURE(size.side, >=, 2U);
  tbb::parallel_for(std::size_t{0}, size_.side, [&](std::size_t row) {
    for (std::size_t column = 0; column < size_.side; ++column) FillTexel(row, column);
  });
}

IsotropicTable::Light IsotropicTable::GatherFrom(const ViewRay& ray) const {
  const Medium& medium = air_.medium();
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const auto samples = air_.SampleAt(ray, MarchNodes(MarchRule::kMidpoint, size_.steps, extent));
  const std::optional<double> ground_mu_s = SunOnGround(medium, ray);
  const Spectrum along = air_.TransmittanceAlong(ray);
  const Spectrum beam = ground_mu_s && *ground_mu_s > 0.0
                            ? air_.TransmittanceToSpace(0.0, *ground_mu_s)
                            : Spectrum(air_.bands());
  Light light{Spectrum(air_.bands()), Spectrum(air_.bands())};
  for (std::size_t band = 0; band < air_.bands(); ++band) {
    const BandCoefficients sigma(medium, band);
    float direct = 0.0F;
    for (std::size_t i = 0; i < samples.count; ++i) {
      const float reached = sigma.ScatteredAt(samples, i);
      light.series[band] += reached;
      direct += reached * samples.lit[i] * std::exp(-sigma.ToSun(samples, i));
    }
    const double ground = static_cast<double>(along[band] * beam[band]) *
                          ground_mu_s.value_or(0.0) * medium.ground_albedo[band] / kPi;
    light.second[band] = direct / (4.0F * std::numbers::pi_v<float>)+static_cast<float>(ground);
  }
  return light;
}

void IsotropicTable::FillTexel(std::size_t row, std::size_t column) {
  const auto unit = [&](std::size_t i) {
    return static_cast<double>(i) / static_cast<double>(size_.side - 1);
  };
  const double altitude_m = unit(row) * air_.medium().atmosphere_height_m;
  const double mu_s = 2.0 * unit(column) - 1.0;
  const int side = size_.directions_side;
  const std::size_t bands = air_.bands();
  Light mean{Spectrum(bands), Spectrum(bands)};
  for (int k = 0; k < side * side; ++k) {
    const double mu = 1.0 - 2.0 * (k / side + 0.5) / side;
    const double azimuth = 2.0 * kPi * (k % side + 0.5) / side;
    const double nu =
        mu * mu_s + std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s)) * std::cos(azimuth);
    const Light light = GatherFrom({altitude_m, mu, mu_s, nu});
    for (std::size_t band = 0; band < bands; ++band) {
      mean.second[band] += light.second[band] / static_cast<float>(side * side);
      mean.series[band] += light.series[band] / static_cast<float>(side * side);
    }
  }
  for (std::size_t band = 0; band < bands; ++band) {
    texels_[(row * size_.side + column) * bands + band] =
        mean.second[band] / (1.0F - mean.series[band]);
  }
}

Spectrum IsotropicTable::InscatterAlong(const RaySamples<float>& samples) const {
  const Medium& medium = air_.medium();
  const std::size_t bands = air_.bands();
  const double top = medium.atmosphere_height_m / kMetresPerKilometre;
  Spectrum light(bands);
  std::vector<BandCoefficients> coefficients;
  for (std::size_t band = 0; band < bands; ++band) coefficients.emplace_back(medium, band);
  for (std::size_t i = 0; i < samples.count; ++i) {
    const auto row =
        AxisPosition::FromUnit(static_cast<double>(samples.altitude[i]) / top, size_.side);
    const auto column =
        AxisPosition::FromUnit(0.5 * (static_cast<double>(samples.mu_s[i]) + 1.0), size_.side);
    const float* low = &texels_[(row.low * size_.side + column.low) * bands];
    const float* high = low + size_.side * bands;
    for (std::size_t band = 0; band < bands; ++band) {
      const BandCoefficients& sigma = coefficients[band];
      const float psi =
          (low[band] * column.Weight(0) + low[bands + band] * column.Weight(1)) * row.Weight(0) +
          (high[band] * column.Weight(0) + high[bands + band] * column.Weight(1)) * row.Weight(1);
      light[band] += psi * sigma.ScatteredAt(samples, i);
    }
  }
  return light;
}

}  // namespace alpenglow::lut
