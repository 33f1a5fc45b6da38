// SPDX-License-Identifier: MIT
#include "lut/medium_toml.h"

#include "atmosphere/error.h"

namespace alpenglow {
namespace {

std::string ListOf(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string PhaseLines(const PhaseFunction& phase) {
  std::string lines = fmt::format("phase = \"{}\"\n", NameOf(phase.kind));
  if (phase.kind != PhaseKind::kRayleigh) lines += fmt::format("g = {}\n", phase.g);
  if (phase.kind == PhaseKind::kDoubleHenyeyGreenstein) {
    lines += fmt::format("g_back = {}\nback_weight = {}\n", phase.g_back, phase.back_weight);
  }
  if (phase.kind == PhaseKind::kDraine) lines += fmt::format("alpha = {}\n", phase.alpha);
  return lines;
}

}  // namespace

std::string TomlFromMedium(const Medium& medium) {
  const std::string text =
      fmt::format("[planet]\nradius_m = {}\nfollows_wgs84 = {}\natmosphere_top_m = {}\n",
                  medium.planet_radius_m, medium.follows_wgs84, medium.atmosphere_height_m) +
      fmt::format("ground_albedo = {}\n", ListOf(medium.ground_albedo)) +
      fmt::format("[spectrum]\nwavelengths_nm = {}\nsolar_irradiance = {}\n",
                  ListOf(medium.wavelengths_nm), ListOf(medium.solar_irradiance)) +
      fmt::format("[rayleigh]\nscattering_per_m = {}\nscale_height_m = {}\n",
                  ListOf(medium.rayleigh_scattering_per_m), medium.rayleigh_scale_height_m) +
      fmt::format("[mie]\nscattering_per_m = {}\nextinction_per_m = {}\nscale_height_m = {}\n",
                  ListOf(medium.mie_scattering_per_m), ListOf(medium.mie_extinction_per_m),
                  medium.mie_scale_height_m) +
      PhaseLines(medium.mie_phase) +
      fmt::format("[ozone]\nabsorption_per_m = {}\nbottom_m = {}\npeak_m = {}\ntop_m = {}\n",
                  ListOf(medium.ozone_absorption_per_m), medium.ozone.bottom_m, medium.ozone.peak_m,
                  medium.ozone.top_m);
  if (MediumHash(MediumFromToml(text, "medium")) != MediumHash(medium)) {
    throw InputError(fmt::format(
        "medium {}: its phase function has a parameter set that it does not use", medium.name));
  }
  return text;
}

}  // namespace alpenglow
