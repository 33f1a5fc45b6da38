// SPDX-License-Identifier: MIT
#include <alpenglow/atmosphere.h>
#include <fmt/format.h>

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "atmosphere/api/conversions.h"
#include "atmosphere/api/local_rays.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/single_scattering.h"

namespace alpenglow {

using atmosphere::Medium;

struct Atmosphere::State {
  explicit State(const Medium& of_medium) : medium(of_medium) {
    if (!atmosphere::FaultOfColours(medium.wavelengths_nm)) colour.emplace(medium.wavelengths_nm);
  }

  /// Returns the air, which is prepared on first use.
  [[nodiscard]] const atmosphere::SingleScattering<double>& air() const {
    std::call_once(air_asked, [this] { prepared.emplace(medium); });
    return *prepared;
  }

  [[nodiscard]] Spectrum TransmittanceAlong(const LocalPoint& eye, const Direction& direction,
                                            double distance_m) const;

  Medium medium;
  std::optional<atmosphere::BandColour> colour;  // empty: the wavelengths show no colours
  mutable std::once_flag air_asked;
  mutable std::optional<atmosphere::SingleScattering<double>> prepared;
};

namespace {

Spectrum Rounded(const SpectrumOf<double>& exact) {
  Spectrum rounded(exact.size());
  for (std::size_t band = 0; band < exact.size(); ++band)
    rounded[band] = static_cast<float>(exact[band]);
  return rounded;
}

}  // namespace

Spectrum Atmosphere::State::TransmittanceAlong(const LocalPoint& eye, const Direction& direction,
                                               double distance_m) const {
  if (!(distance_m >= 0.0)) {
    throw InputError(fmt::format("distance_m is {}; it must be at least 0", distance_m));
  }
  const AltitudeAndZenith place = AltitudeOf(eye, medium.planet_radius_m);
  const glm::dvec3 along = UnitVectorOf(direction);
  // Points are at most 1e12 m high: such a ray has left the air.
  constexpr double kSpace_m = 1e13;
  if (distance_m >= kSpace_m) {
    const double mu = CosineBetween(along, place.up);
    return Rounded(air().TransmittanceToSpace(std::max(place.altitude_m, 0.0), mu));
  }
  return Rounded(air().TransmittanceAlong(RayFrom(place, along, along, distance_m)));
}

Atmosphere::Atmosphere() {
  static const Atmosphere earth(atmosphere::MediumPreset("earth"));
  state_ = earth.state_;
}

Atmosphere::Atmosphere(const Medium& medium) {
  atmosphere::Validate(medium, atmosphere::kForLight);
  state_ = std::make_shared<const State>(medium);
}

Atmosphere Atmosphere::Preset(std::string_view name) {
  return Atmosphere(atmosphere::MediumPreset(name));
}

Atmosphere Atmosphere::Preset(std::string_view name, const std::vector<double>& wavelengths_nm) {
  return Atmosphere(atmosphere::MediumPreset(name, wavelengths_nm));
}

std::vector<std::string> Atmosphere::PresetNames() { return atmosphere::MediumPresetNames(); }

Atmosphere Atmosphere::Read(const std::filesystem::path& file) {
  return Atmosphere(atmosphere::ReadMedium(file, atmosphere::kForLight));
}

Atmosphere Atmosphere::FromToml(std::string_view text) {
  return Atmosphere(atmosphere::MediumFromToml(text, "atmosphere", atmosphere::kForLight));
}

std::string Atmosphere::ToToml() const { return atmosphere::TomlFromMedium(medium()); }

Atmosphere Atmosphere::AtLatitude(double latitude_deg) const {
  atmosphere::RequireInRange(latitude_deg, -90.0, 90.0, "latitude");
  return Atmosphere(
      atmosphere::OnOsculatingSphere(medium(), latitude_deg * atmosphere::kRadiansPerDegree));
}

const std::string& Atmosphere::name() const { return medium().name; }

std::span<const double> Atmosphere::wavelengths_nm() const { return medium().wavelengths_nm; }

std::span<const double> Atmosphere::solar_irradiance_w_per_m2_nm() const {
  return medium().solar_irradiance;
}

double Atmosphere::planet_radius_m() const { return medium().planet_radius_m; }

double Atmosphere::top_m() const { return medium().atmosphere_height_m; }

std::uint64_t Atmosphere::hash() const { return atmosphere::MediumHash(medium()); }

LinearRgb Atmosphere::ColourOf(const Spectrum& light) const {
  const std::vector<double>& sun = medium().solar_irradiance;
  if (light.size() != sun.size()) {
    throw InputError(
        fmt::format("a spectrum has {} bands; it must have {}", light.size(), sun.size()));
  }
  if (!state_->colour) throw InputError(*atmosphere::FaultOfColours(medium().wavelengths_nm));
  std::array<double, Spectrum::kMostBands> scaled{};
  for (std::size_t band = 0; band < sun.size(); ++band) {
    RequireFinite(light[band], fmt::format("band {} of the spectrum", band));
    scaled[band] = sun[band] * static_cast<double>(light[band]);
  }
  const auto [red, green, blue] = state_->colour->LinearSrgb({scaled.data(), sun.size()});
  return {red, green, blue};
}

Spectrum Atmosphere::Transmittance(const LocalPoint& eye, const Direction& direction,
                                   double distance_m) const {
  return state_->TransmittanceAlong(eye, direction, distance_m);
}

void Atmosphere::Transmittance(const OneOrMany<LocalPoint>& eyes,
                               const OneOrMany<Direction>& directions,
                               const OneOrMany<double>& distances_m,
                               std::span<float> result) const {
  const std::size_t bands = wavelengths_nm().size(), rays = RaysOf(result, bands);
  RequireLength("eyes", eyes, rays);
  RequireLength("directions", directions, rays);
  RequireLength("distances_m", distances_m, rays);
  oneapi::tbb::parallel_for(std::size_t{0}, rays, [&](std::size_t i) {
    const Spectrum light = state_->TransmittanceAlong(eyes[i], directions[i], distances_m[i]);
    std::ranges::copy(light.values(), result.begin() + static_cast<std::ptrdiff_t>(i * bands));
  });
}

const Medium& Atmosphere::medium() const { return state_->medium; }

void RefuseBands(std::size_t bands) {
  throw InputError(fmt::format("bands is {}; it must lie in [0, {}]", bands, Spectrum::kMostBands));
}

void RefuseBand(std::size_t band, std::size_t bands) {
  throw InputError(fmt::format("band is {}; the spectrum has {} bands", band, bands));
}

void RefuseOperands(std::size_t bands, std::size_t others) {
  throw InputError(fmt::format(
      "two spectra have {} and {} bands; they must have as many as each other", bands, others));
}

double Luminance(const LinearRgb& colour) {
  RequireFinite(colour.red, "red");
  RequireFinite(colour.green, "green");
  RequireFinite(colour.blue, "blue");
  const auto& row = atmosphere::XyzFromLinearSrgb()[1];
  return row[0] * colour.red + row[1] * colour.green + row[2] * colour.blue;
}

}  // namespace alpenglow
