// SPDX-License-Identifier: MIT
#include "renderer/illumination/night_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

/// Returns a spectrum of half sodium, half LED light, with a total luminance of 1 cd/m^2.
Spectrum LampsOfUnitLuminance(const BandColour& colour) {
  constexpr double kSodium_k = 2050.0, kLed_k = 4000.0, kShare = 0.5;
  const std::vector<double>& wavelengths_nm = colour.wavelengths_nm();
  Spectrum sum(wavelengths_nm.size());
  for (const double temperature_k : {kSodium_k, kLed_k}) {
    std::vector<double> values;
    for (const double nm : wavelengths_nm) values.push_back(BlackBodyRadiance(nm, temperature_k));
    const double luminance = colour.Xyz(values)[1];
    for (std::size_t band = 0; band < sum.size(); ++band)
      sum[band] += static_cast<float>(kShare * values[band] / luminance);
  }
  return sum;
}

bool Scatters(const Medium& medium) {
  const auto any = [](const std::vector<double>& per_m) {
    return std::any_of(per_m.begin(), per_m.end(), [](double value) { return value > 0.0; });
  };
  return any(medium.rayleigh_scattering_per_m) || any(medium.mie_scattering_per_m);
}

glm::dvec3 Refracted(const glm::dvec3& enu, const RefractedView& view) {
  const double elevation = std::asin(std::clamp(enu.z, -1.0, 1.0));
  return EnuFromAngles(view.LiftedElevationOf(elevation), std::atan2(enu.x, enu.y)).xyz;
}

StarLight LightOf(const PointLight& point, const glm::dvec3& direction, const BandColour& colour) {
  const std::vector<double>& wavelengths_nm = colour.wavelengths_nm();
  const double temperature = TemperatureOf(point.colour_index);
  Spectrum spectrum(wavelengths_nm.size());
  for (std::size_t band = 0; band < spectrum.size(); ++band)
    spectrum[band] = static_cast<float>(1e6 * BlackBodyRadiance(wavelengths_nm[band], temperature));
  const double of_spectrum = colour.Xyz(spectrum)[1];
  const double lux = IlluminanceOf(point.magnitude);
  return {direction, static_cast<float>(lux / of_spectrum) * spectrum, lux};
}

/// Returns the direction after the rotation of the earth under the stars.
glm::dvec3 After(const glm::dvec3& ecef, double seconds) {
  const double turned = -kEarthRotation_rad_per_s * seconds;
  const double c = std::cos(turned), s = std::sin(turned);
  return {c * ecef.x - s * ecef.y, s * ecef.x + c * ecef.y, ecef.z};
}

/// Returns light of a spectrum, scaled to a luminance of 1 cd/m^2.
/// @param shape  function from wavelength [nm] to relative radiance.
template <typename Shape>
Spectrum OfUnitLuminance(const std::vector<double>& wavelengths_nm, const BandColour& colour,
                         const Shape& shape) {
  Spectrum light(wavelengths_nm.size());
  std::vector<double> values;
  for (const double wavelength : wavelengths_nm) values.push_back(shape(wavelength));
  const double luminance = colour.Xyz(values)[1];
  for (std::size_t band = 0; band < light.size(); ++band)
    light[band] = static_cast<float>(values[band] / luminance);
  return light;
}

// Returns the spectrum of magnitudes U to I at their effective wavelengths, from the irradiance of
// magnitude 0: Bessell, Castelli, Plez (1998), Astron. Astrophys. 333, 231, table A2.
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

Spectrum Skyglow(double zenith, double ground_m, const SingleScattering<float>& air,
                 const BandColour& colour) {
  if (!Scatters(air.medium())) return Spectrum(air.bands());
  const double wanted = std::max(
      LuminanceOfSurfaceBrightness(zenith) - LuminanceOfSurfaceBrightness(kNaturalZenith), 0.0);
  const Spectrum lamps = LampsOfUnitLuminance(colour);
  const Spectrum left = air.TransmittanceToSpace(ground_m, 1.0);
  Spectrum seen(lamps.size());
  for (std::size_t band = 0; band < lamps.size(); ++band)
    seen[band] = (1.0F - left[band]) * lamps[band];
  return static_cast<float>(wanted / colour.Xyz(seen)[1]) * lamps;
}

OpenShutter OpenFor(double open_s, double pixel_angle_rad) {
  // An arc of angle t deviates by t^2 / 8 from its chord.
  const double step_rad = std::sqrt(8.0 * 0.1 * pixel_angle_rad);
  const double turned_rad = kEarthRotation_rad_per_s * open_s;
  return {open_s, static_cast<int>(std::ceil(turned_rad / step_rad))};
}

double FaintestStar(double lux, double pixel_angle_rad) {
  constexpr double kUnseenStar = 1e-3;
  return MagnitudeOf(kUnseenStar * pixel_angle_rad * pixel_angle_rad / kPi * lux);
}

std::vector<StarLight> StarLightsOver(const Place& eye, const UtcTime& instant,
                                      const RefractedView& view, const BandColour& colour,
                                      double faintest, const OpenShutter& shutter) {
  const LocalFrame local(kWgs84, eye);
  std::vector<StarLight> lights;
  const auto add = [&](const PointLight& point) {
    if (point.magnitude > faintest) return;
    const auto seen_after = [&](double seconds) {
      const Vector<Ecef> ecef{After(point.direction.xyz, seconds)};
      return Refracted(local.EnuFromEcef(ecef).xyz, view);
    };
    lights.push_back(LightOf(point, seen_after(0.0), colour));
    for (int i = 0; shutter.steps > 0 && i <= shutter.steps; ++i)
      lights.back().way.push_back(seen_after(shutter.open_s * (i / double(shutter.steps) - 0.5)));
  };
  for (const PointLight& planet : PlanetsAt(eye, instant)) add(planet);
  for (const PointLight& star : StarsAt(instant, faintest)) add(star);
  return lights;
}

NightLight::NightLight(const NightSky& sky, const SingleScattering<float>& air,
                       const BandColour& colour, const glm::dvec3& up, double altitude_m,
                       const std::optional<Spectrum>& towns)
    : sky_(sky), up_(up), altitude_m_(altitude_m) {
  constexpr double kStars_k = 5000.0, kGround = 1.0 / 6.0;
  const auto& wavelengths_nm = air.medium().wavelengths_nm;
  airglow_ = OfUnitLuminance(wavelengths_nm, colour, AirglowSpectrum);
  starlight_ = OfUnitLuminance(wavelengths_nm, colour,
                               [](double nm) { return BlackBodyRadiance(nm, kStars_k); });
  zodiacal_ = Spectrum(wavelengths_nm.size());
  for (std::size_t band = 0; band < zodiacal_.size(); ++band)
    zodiacal_[band] = static_cast<float>(SolarIrradiance(wavelengths_nm[band]));
  // Integrate over equal areas of the hemisphere's projection.
  constexpr int kRings = 8, kSectors = 16;
  Spectrum above(zodiacal_.size()), left(zodiacal_.size()), kept(zodiacal_.size());
  const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0.3, 1.0, 0.1), up));
  const glm::dvec3 north = glm::cross(up, east);
  for (int ring = 0; ring < kRings; ++ring) {
    const double sine = std::sqrt((ring + 0.5) / kRings), cosine = std::sqrt(1.0 - sine * sine);
    const Spectrum through = air.TransmittanceToSpace(std::max(altitude_m, 0.0), cosine);
    for (int sector = 0; sector < kSectors; ++sector) {
      const double turn = 2.0 * kPi * (sector + 0.5) / kSectors;
      const Spectrum light =
          Above(cosine * up + sine * (std::cos(turn) * east + std::sin(turn) * north));
      above = above + light;
      left = left + through * light;
    }
    kept = kept + through;
  }
  constexpr auto kShare = static_cast<float>(1.0 / (kRings * kSectors));
  scattered_ = static_cast<float>(0.5 * (1.0 + kGround)) * (kShare * above);
  if (towns) scattered_ = scattered_ + *towns;
  level_ = Spectrum(above.size());
  for (std::size_t band = 0; band < above.size(); ++band) {
    const float hidden = 1.0F - kept[band] / static_cast<float>(kRings);
    level_[band] = static_cast<float>(kPi) * (kShare * left[band] + hidden * scattered_[band]);
  }
}

Spectrum NightLight::Above(const glm::dvec3& direction) const {
  const NightRadiance radiance = sky_.Towards(direction, up_, altitude_m_);
  return static_cast<float>(radiance.airglow_cd_per_m2) * airglow_ +
         static_cast<float>(radiance.zodiacal_per_irradiance) * zodiacal_ +
         static_cast<float>(radiance.starlight_cd_per_m2) * starlight_;
}

Spectrum NightLight::OnSurface(double cos_up) const {
  return static_cast<float>(0.5 * (1.0 + cos_up)) * level_;
}

}  // namespace alpenglow::renderer
