// SPDX-License-Identifier: MIT
#include "renderer/light/night_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/colour/black_body.h"
#include "atmosphere/number/constants.h"

namespace alpenglow::renderer {
namespace {

/// Light of a spectrum whose luminance is 1 cd/m^2.
template <typename Spectrum>
BandLight OfUnitLuminance(const std::vector<double>& wavelengths_nm, const BandColour& colour,
                          const Spectrum& spectrum) {
  BandLight light(wavelengths_nm.size());
  std::vector<double> values;
  for (const double wavelength : wavelengths_nm) values.push_back(spectrum(wavelength));
  const double luminance = colour.Xyz(values)[1];
  for (std::size_t band = 0; band < light.count; ++band)
    light[band] = static_cast<float>(values[band] / luminance);
  return light;
}

// Of magnitudes U to I at their effective wavelengths, by the irradiance of magnitude 0 there:
// Bessell, Castelli, Plez (1998), Astron. Astrophys. 333, 231, table A2.
double AirglowSpectrum(double wavelength_nm) {
  struct Filter {
    double wavelength_nm, of_magnitude_0, magnitude;
  };
  static constexpr std::array<Filter, 5> kFilters{{{366.0, 417.5, 22.28},
                                                   {438.0, 632.0, 22.64},
                                                   {545.0, 363.1, 21.61},
                                                   {641.0, 217.7, 20.87},
                                                   {798.0, 112.6, 19.71}}};
  static const SampledFunction kLogarithm = [] {
    std::vector<double> x, y;
    for (const Filter& filter : kFilters) {
      x.push_back(filter.wavelength_nm);
      y.push_back(std::log(filter.of_magnitude_0) - 0.4 * std::log(10.0) * filter.magnitude);
    }
    return SampledFunction(x, y);
  }();
  return std::exp(kLogarithm(wavelength_nm));
}

}  // namespace

NightLight::NightLight(const NightSky& sky, const AirIntegrator<float>& air,
                       const BandColour& colour, const glm::dvec3& up, double altitude_m,
                       const std::optional<BandLight>& towns)
    : sky_(sky), up_(up), altitude_m_(altitude_m) {
  constexpr double kStars_k = 5000.0, kGround = 1.0 / 6.0;
  const auto& wavelengths_nm = air.medium().wavelengths_nm;
  airglow_ = OfUnitLuminance(wavelengths_nm, colour, AirglowSpectrum);
  starlight_ = OfUnitLuminance(wavelengths_nm, colour,
                               [](double nm) { return BlackBodyRadiance(nm, kStars_k); });
  zodiacal_ = BandLight(wavelengths_nm.size());
  for (std::size_t band = 0; band < zodiacal_.count; ++band)
    zodiacal_[band] = static_cast<float>(SolarIrradiance(wavelengths_nm[band]));
  // Equal shares of the hemisphere's projection.
  constexpr int kRings = 8, kSectors = 16;
  BandLight above(zodiacal_.count), left(zodiacal_.count), kept(zodiacal_.count);
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0.3, 1.0, 0.1), up));
  const glm::dvec3 north = glm::cross(up, east);
  for (int ring = 0; ring < kRings; ++ring) {
    const double sine = std::sqrt((ring + 0.5) / kRings), cosine = std::sqrt(1.0 - sine * sine);
    const BandLight through = air.TransmittanceToSpace(std::max(altitude_m, 0.0), cosine);
    for (int sector = 0; sector < kSectors; ++sector) {
      const double turn = 2.0 * kPi * (sector + 0.5) / kSectors;
      const BandLight light =
          Above(cosine * up + sine * (std::cos(turn) * east + std::sin(turn) * north));
      above = above + light;
      left = left + through * light;
    }
    kept = kept + through;
  }
  constexpr auto kShare = static_cast<float>(1.0 / (kRings * kSectors));
  scattered_ = static_cast<float>(0.5 * (1.0 + kGround)) * (kShare * above);
  if (towns) scattered_ = scattered_ + *towns;
  level_ = BandLight(above.count);
  for (std::size_t band = 0; band < above.count; ++band) {
    const float hidden = 1.0F - kept[band] / static_cast<float>(kRings);
    level_[band] = static_cast<float>(kPi) * (kShare * left[band] + hidden * scattered_[band]);
  }
}

BandLight NightLight::Above(const glm::dvec3& direction) const {
  const NightRadiance radiance = sky_.Towards(direction, up_, altitude_m_);
  return static_cast<float>(radiance.airglow_cd_per_m2) * airglow_ +
         static_cast<float>(radiance.zodiacal_per_irradiance) * zodiacal_ +
         static_cast<float>(radiance.starlight_cd_per_m2) * starlight_;
}

BandLight NightLight::OnSurface(double cos_up) const {
  return static_cast<float>(0.5 * (1.0 + cos_up)) * level_;
}

}  // namespace alpenglow::renderer
