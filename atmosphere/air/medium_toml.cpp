// SPDX-License-Identifier: MIT
#include "atmosphere/air/medium_toml.h"

#include <fmt/format.h>

#include "atmosphere/air/phase_table.h"
#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

std::string ListOf(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

// One value when all wavelengths share the phase function, else one per wavelength.
std::string ParameterLine(const char* key, double PhaseFunction::*parameter,
                          const std::vector<PhaseFunction>& phases) {
  std::vector<double> values;
  for (const PhaseFunction& phase : phases) values.push_back(phase.*parameter);
  return fmt::format("{} = {}\n", key, ListOf(values));
}

// Tables of different angles at different wavelengths have no text.
std::string TableLines(const std::vector<PhaseFunction>& phases) {
  std::vector<double> values;
  for (const PhaseFunction& phase : phases) {
    const std::vector<double>& row = phase.table->per_sr();
    values.insert(values.end(), row.begin(), row.end());
  }
  return fmt::format("phase = \"table\"\nphase_angles_deg = {}\nphase_per_sr = {}\n",
                     ListOf(phases.front().table->angle_deg()), ListOf(values));
}

std::string PhaseLines(const std::vector<PhaseFunction>& phases) {
  const PhaseKind kind = phases.front().kind;
  if (kind == PhaseKind::kTable) return TableLines(phases);
  std::string lines = fmt::format("phase = \"{}\"\n", NameOf(kind));
  if (kind != PhaseKind::kRayleigh) lines += ParameterLine("g", &PhaseFunction::g, phases);
  if (kind == PhaseKind::kDoubleHenyeyGreenstein || kind == PhaseKind::kHenyeyGreensteinDraine) {
    lines += ParameterLine("g_back", &PhaseFunction::g_back, phases);
    lines += ParameterLine("back_weight", &PhaseFunction::back_weight, phases);
  }
  if (kind == PhaseKind::kDraine || kind == PhaseKind::kHenyeyGreensteinDraine)
    lines += ParameterLine("alpha", &PhaseFunction::alpha, phases);
  return lines;
}

std::string LayerLines(const OzoneLayer& ozone) {
  if (ozone.shape == OzoneShape::kSmooth) {
    return fmt::format("profile = \"smooth\"\npeak_m = {}\n", ozone.peak_m);
  }
  return fmt::format("profile = \"tent\"\nbottom_m = {}\npeak_m = {}\ntop_m = {}\n", ozone.bottom_m,
                     ozone.peak_m, ozone.top_m);
}

std::string DeficitLines(const MoleculeDeficit& deficit) {
  if (deficit.share == 0.0) return "";
  return fmt::format("deficit = {}\ndeficit_scale_height_m = {}\n", deficit.share,
                     deficit.scale_height_m);
}

}  // namespace

std::string TomlFromMedium(const Medium& medium) {
  const std::string text =
      fmt::format("polarised = {}\n", medium.polarised) +
      fmt::format("[planet]\nradius_m = {}\nfollows_wgs84 = {}\natmosphere_top_m = {}\n",
                  medium.planet_radius_m, medium.follows_wgs84, medium.atmosphere_height_m) +
      fmt::format("ground_albedo = {}\n", ListOf(medium.ground_albedo)) +
      fmt::format("[spectrum]\nwavelengths_nm = {}\nsolar_irradiance = {}\n",
                  ListOf(medium.wavelengths_nm), ListOf(medium.solar_irradiance)) +
      fmt::format("[rayleigh]\nscattering_per_m = {}\nscale_height_m = {}\n",
                  ListOf(medium.rayleigh_scattering_per_m), medium.rayleigh_scale_height_m) +
      DeficitLines(medium.rayleigh_deficit) +
      fmt::format("depolarisation = {}\n", ListOf(medium.rayleigh_depolarisation)) +
      (medium.refraction == RefractionBy::kAlmanacs ? "refraction = \"almanacs\"\n" : "") +
      fmt::format("[mie]\nscattering_per_m = {}\nextinction_per_m = {}\nscale_height_m = {}\n",
                  ListOf(medium.mie_scattering_per_m), ListOf(medium.mie_extinction_per_m),
                  medium.mie_scale_height_m) +
      PhaseLines(medium.mie_phase) +
      fmt::format("[ozone]\nabsorption_per_m = {}\n", ListOf(medium.ozone_absorption_per_m)) +
      LayerLines(medium.ozone);
  if (MediumHash(MediumFromToml(text, "medium")) != MediumHash(medium)) {
    throw InputError(fmt::format(
        "medium {}: its phase function has a parameter set that it does not use", medium.name));
  }
  return text;
}

}  // namespace alpenglow::atmosphere
