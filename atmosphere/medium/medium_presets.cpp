// SPDX-License-Identifier: MIT
// Defines the named atmospheres, with the source of every number.
//
// Aerosol of the earth presets: Angstrom (1929), tau(lambda) = tau(550) (lambda / 550 nm)^-a, in
// one exponential layer; single scattering albedo and phase functions of OPAC mixtures at 80 %
// relative humidity (Hess, Koepke and Schult 1998, Bull. Amer. Meteor. Soc. 79, 831-844).
#include "atmosphere/medium/medium_presets.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/aerosol_mixture.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/medium/phase_table.h"

namespace alpenglow::atmosphere {

namespace {

template <typename Function>
std::vector<double> Evaluate(const std::vector<double>& wavelengths_nm, Function function) {
  std::vector<double> values;
  for (const double wavelength_nm : wavelengths_nm) values.push_back(function(wavelength_nm));
  return values;
}

struct Aerosol {
  const char* name;
  double optical_depth_550;
  double angstrom_exponent;
  std::array<double, 3> single_scattering_albedo;  // at 450, 550, 650 nm
  const char* mixture;                             // source of the phase function
};

// Albedos: OPAC. Optical depths are round numbers: "earth" is a clean continental day, visibility
// near 74 km (Koschmieder); "clear-mountain" the cleanest days of remote stations; "hazy" a summer
// day in the lowlands, visibility near 22 km. Exponent 1.3: the usual mean over land
// (Angstrom 1929).
constexpr Aerosol kEarthAerosols[] = {
    {"earth", 0.05, 1.3, {0.9304, 0.9253, 0.9186}, "continental_average"},
    {"clear-mountain", 0.02, 1.3, {0.9766, 0.9720, 0.9667}, "continental_clean"},
    {"hazy", 0.2, 1.3, {0.8977, 0.8925, 0.8849}, "continental_polluted"},
};

void AddAerosol(const Aerosol& aerosol, Medium& medium) {
  const SampledFunction albedo({450.0, 550.0, 650.0}, {aerosol.single_scattering_albedo.begin(),
                                                       aerosol.single_scattering_albedo.end()});
  medium.mie_scale_height_m = 1200.0;  // Elterman (1968), the layer below 5 km
  medium.mie_extinction_per_m = Evaluate(medium.wavelengths_nm, [&](double wavelength_nm) {
    return aerosol.optical_depth_550 * std::pow(wavelength_nm / 550.0, -aerosol.angstrom_exponent) /
           medium.mie_scale_height_m;
  });
  for (std::size_t i = 0; i < medium.wavelengths_nm.size(); ++i) {
    medium.mie_scattering_per_m.push_back(medium.mie_extinction_per_m[i] *
                                          albedo(medium.wavelengths_nm[i]));
  }
  medium.mie_phase = AerosolMixturePhase(aerosol.mixture, medium.wavelengths_nm);
}

Medium Earth(const Aerosol& aerosol, const std::vector<double>& wavelengths_nm) {
  Medium medium;
  medium.name = aerosol.name;
  medium.follows_wgs84 = true;
  medium.planet_radius_m = kEarthMeanRadius_m;
  medium.atmosphere_height_m = 120000.0;  // twilight comes from air above 60 km
  medium.wavelengths_nm = wavelengths_nm;
  medium.solar_irradiance = Evaluate(wavelengths_nm, SolarIrradiance);
  // The ground is a mixture of grass and soil, without the rise beyond 700 nm: 0.10 at 400 nm to
  // 0.15 at 700 nm. This is a plausible mean, not a measurement.
  const SampledFunction albedo({400.0, 700.0}, {0.10, 0.15});
  medium.ground_albedo = Evaluate(wavelengths_nm, albedo);
  medium.rayleigh_scattering_per_m = Evaluate(wavelengths_nm, RayleighScatteringAtSeaLevel);
  // This fit has the column of the U.S. Standard Atmosphere (1976), 8456 m, and its density within
  // 10 % below 25 km and 22 % up to 55 km. It was fitted to logarithms of density, with double
  // weight below 12 km. One exponential of 8 km is 2 times too dense at 40 km, the source of
  // twilight.
  medium.rayleigh_scale_height_m = 6800.0;
  medium.rayleigh_deficit = {0.42, 2857.0};
  // The fitted density decreases too slowly near the ground: it would lift a sun on the horizon by
  // 30'.
  medium.refraction = RefractionBy::kAlmanacs;
  AddAerosol(aerosol, medium);
  medium.ozone = SmoothOzone();
  medium.ozone_absorption_per_m = Evaluate(wavelengths_nm, [&](double wavelength_nm) {
    return OzoneAbsorptionAtPeak(300.0, medium.ozone, wavelength_nm);
  });
  return medium;
}

constexpr double kKingFactorOfCarbonDioxide = 1.15;  // Bodhaine et al. (1999)

// Returns Rayleigh scattering of carbon dioxide at the ground of Mars: refractivity 4.49e-4 and
// King factor F = 1.15 (depolarisation 0.08) in (24 pi^3 / lambda^4 N^2) ((n^2 - 1)/(n^2 + 2))^2 F,
// for 610 Pa and 210 K. The cross section at 532 nm, 1.32e-30 m^2, is 6 % above the measurement of
// Sneep and Ubachs (2005, JQSRT 92, 293-310); this scattering is a two-hundredth of the dust's.
double RayleighScatteringOnMars(double wavelength_nm) {
  constexpr double kLoschmidt_per_m3 = 2.6867811e25;
  constexpr double kMolecules_per_m3 = 610.0 / (1.380649e-23 * 210.0);
  constexpr double kIndex = 1.0 + 4.49e-4;
  constexpr double kLorentzLorenz = (kIndex * kIndex - 1.0) / (kIndex * kIndex + 2.0);
  const double wavelength_m = wavelength_nm * 1e-9;
  const double cross_section_m2 =
      24.0 * kPi * kPi * kPi * kLorentzLorenz * kLorentzLorenz * kKingFactorOfCarbonDioxide /
      (std::pow(wavelength_m, 4) * kLoschmidt_per_m3 * kLoschmidt_per_m3);
  return kMolecules_per_m3 * cross_section_m2;
}

struct MarsDust {
  SampledFunction relative_extinction, albedo;
  SpectralPhase phase;
};

// Reads the tables that tests/bench/mars_dust.cpp makes, with their sources.
MarsDust ReadMarsDust() {
  const auto optics = atmosphere::ReadColumns("atmosphere/data/mars_dust.csv", {0, 1, 2});
  const auto rows = atmosphere::ReadColumns("atmosphere/data/mars_dust_phase.csv", {0, 1, 2});
  return {SampledFunction(optics[0], optics[1]), SampledFunction(optics[0], optics[2]),
          SpectralPhaseFromRows(rows[0], rows[1], rows[2])};
}

const MarsDust& DustOfMars() {
  static const MarsDust dust = ReadMarsDust();
  return dust;
}

std::vector<PhaseFunction> PhasesOfMarsDust(const std::vector<double>& wavelengths_nm) {
  std::vector<PhaseFunction> phases;
  for (const double wavelength_nm : wavelengths_nm) {
    phases.push_back(
        {.kind = PhaseKind::kTable,
         .table = std::make_shared<const PhaseTable>(DustOfMars().phase.At(wavelength_nm))});
  }
  return phases;
}

// Returns Mars on a clear day of its dusty season: dust of optical depth 0.5, mixed with the gas.
Medium Mars(const std::vector<double>& wavelengths_nm) {
  constexpr double kDistance_au = 1.524;      // semi-major axis of the orbit
  constexpr double kDustOpticalDepth = 0.5;   // Smith et al. (1997), Science 278, 1758-1765
  constexpr double kScaleHeight_m = 11000.0;  // R T / M g at 210 K; the dust is well mixed
  const MarsDust& dust = DustOfMars();
  // The ground is bright and dusty (Bell et al. 1999, Icarus 138, 25-35), rounded to 0.02.
  const SampledFunction ground({400.0, 500.0, 600.0, 700.0, 800.0}, {0.06, 0.08, 0.20, 0.28, 0.30});
  Medium medium;
  medium.name = "mars";
  medium.follows_wgs84 = false;
  medium.planet_radius_m = 3389500.0;  // mean; Archinal et al. (2018), Celest. Mech. 130, 22
  medium.atmosphere_height_m = 120000.0;
  medium.wavelengths_nm = wavelengths_nm;
  medium.solar_irradiance = Evaluate(wavelengths_nm, [](double wavelength_nm) {
    return SolarIrradiance(wavelength_nm) / (kDistance_au * kDistance_au);
  });
  medium.ground_albedo = Evaluate(wavelengths_nm, ground);
  medium.rayleigh_scattering_per_m = Evaluate(wavelengths_nm, RayleighScatteringOnMars);
  medium.rayleigh_scale_height_m = kScaleHeight_m;
  medium.mie_scale_height_m = kScaleHeight_m;
  for (const double wavelength_nm : wavelengths_nm) {
    const double extinction =
        kDustOpticalDepth / kScaleHeight_m * dust.relative_extinction(wavelength_nm);
    medium.mie_extinction_per_m.push_back(extinction);
    medium.mie_scattering_per_m.push_back(extinction * dust.albedo(wavelength_nm));
  }
  medium.mie_phase = PhasesOfMarsDust(wavelengths_nm);
  medium.ozone_absorption_per_m.assign(wavelengths_nm.size(), 0.0);
  return medium;
}

// Returns the constants of Bruneton, E. (2017), "Precomputed Atmospheric Scattering: a New
// Implementation", which many engines use, with wavelengths in ascending order.
Medium Bruneton2017() {
  Medium medium;
  medium.name = "bruneton2017";
  medium.follows_wgs84 = false;
  medium.planet_radius_m = 6360000.0;
  medium.atmosphere_height_m = 60000.0;
  medium.wavelengths_nm = {440.0, 550.0, 680.0};
  medium.solar_irradiance = {1.91198, 1.8504, 1.474};
  medium.ground_albedo = {0.1, 0.1, 0.1};
  medium.rayleigh_scattering_per_m = {33.1e-6, 13.558e-6, 5.802e-6};
  medium.rayleigh_scale_height_m = 8000.0;
  medium.mie_scattering_per_m = {3.996e-6, 3.996e-6, 3.996e-6};
  medium.mie_extinction_per_m = {4.440e-6, 4.440e-6, 4.440e-6};
  medium.mie_scale_height_m = 1200.0;
  medium.mie_phase = {{.kind = PhaseKind::kCornetteShanks, .g = 0.8}};
  medium.ozone_absorption_per_m = {0.085e-6, 1.881e-6, 0.650e-6};
  medium.ozone = OzoneLayer{};
  return medium;
}

void RequireKnownName(std::string_view name) {
  const std::vector<std::string> names = MediumPresetNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  throw InputError(fmt::format("preset is \"{}\"; it must be one of {}", name, known));
}

void RequireTablesReach(std::string_view name, const std::vector<double>& wavelengths_nm) {
  for (const double wavelength_nm : wavelengths_nm) {
    RequireInRange(wavelength_nm, kFirstPresetWavelength_nm, kLastPresetWavelength_nm,
                   fmt::format("a wavelength [nm] of preset {}", name));
  }
}

using Row = std::vector<double> Medium::*;

constexpr std::array<Row, 6> kRows{
    &Medium::solar_irradiance,          &Medium::ground_albedo,
    &Medium::rayleigh_scattering_per_m, &Medium::mie_scattering_per_m,
    &Medium::mie_extinction_per_m,      &Medium::ozone_absorption_per_m};

/// Returns the preset named in a medium's name, if that preset has values at all wavelengths of the
/// tables.
std::optional<std::string> PresetOf(const Medium& medium) {
  for (const std::string& preset : MediumPresetNames()) {
    if (preset == "bruneton2017") continue;
    if (medium.name == preset || medium.name == "custom (from " + preset + ")") return preset;
  }
  return std::nullopt;
}

/// Returns the ratios of a medium to its preset; std::nullopt if the preset is zero and the medium
/// is not.
std::optional<std::vector<double>> Factors(const std::vector<double>& medium,
                                           const std::vector<double>& preset) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < medium.size(); ++i) {
    if (preset[i] == 0.0 && medium[i] != 0.0) return std::nullopt;
    factors.push_back(preset[i] == 0.0 ? 1.0 : medium[i] / preset[i]);
  }
  return factors;
}

/// Returns the depolarisation of the preset's gas if the medium has it at its own wavelengths.
std::vector<double> DepolarisationAt(const Medium& medium, const std::string& preset,
                                     const std::vector<double>& wavelengths_nm) {
  const std::vector<double>& here = medium.rayleigh_depolarisation;
  if (here == GasDepolarisation(preset, medium.wavelengths_nm))
    return GasDepolarisation(preset, wavelengths_nm);
  const SampledFunction at(medium.wavelengths_nm, here);
  std::vector<double> there;
  for (const double nm : wavelengths_nm) there.push_back(at(nm));
  return there;
}

bool LooksLikeFile(const std::string& text) {
  return text.find_first_of("./\\") != std::string::npos;
}

constexpr double kMostAerosol = 1000.0;

/// Returns a coefficient at 550 nm, linear between the wavelengths in the logarithms of wavelength and
/// coefficient; 0 if one of its neighbours is 0.
/// @param exponent  of the power of the wavelength beyond the wavelengths.
double CoefficientAt550(const std::vector<double>& wavelengths_nm,
                        const std::vector<double>& coefficients, double exponent) {
  constexpr double kGreen_nm = 550.0;
  const std::vector<double>&x = wavelengths_nm, &y = coefficients;
  const auto above = std::upper_bound(x.begin(), x.end(), kGreen_nm);
  const auto i = static_cast<std::size_t>(above - x.begin());
  if (above == x.begin()) return y.front() * std::pow(kGreen_nm / x.front(), exponent);
  if (above == x.end()) return y.back() * std::pow(kGreen_nm / x.back(), exponent);
  if (y[i - 1] == 0.0 || y[i] == 0.0) return 0.0;
  const double share = std::log(kGreen_nm / x[i - 1]) / std::log(x[i] / x[i - 1]);
  return y[i - 1] * std::pow(y[i] / y[i - 1], share);
}

/// Extinction at an altitude and 550 nm.
struct AirAt550 {
  double molecules_per_m, aerosol_per_m;
};

AirAt550 AirAt(const Medium& medium, double altitude_m) {
  const double height_m = std::max(altitude_m, 0.0);
  return {MoleculeDensity(medium, height_m) * MoleculesAt550_per_m(medium),
          std::exp(-height_m / medium.mie_scale_height_m) * AerosolAt550_per_m(medium)};
}

}  // namespace

double OzoneAbsorptionAtPeak(double column_dobson, const OzoneLayer& layer, double wavelength_nm) {
  constexpr double kMoleculesPerSquareMetreAndDobson = 2.6867811e20;
  return column_dobson * kMoleculesPerSquareMetreAndDobson / EquivalentDepth_m(layer) *
         OzoneCrossSection(wavelength_nm);
}

std::vector<std::string> MediumPresetNames() {
  return {"earth", "clear-mountain", "hazy", "mars", "bruneton2017"};
}

std::vector<double> GasDepolarisation(std::string_view preset,
                                      const std::vector<double>& wavelengths_nm) {
  RequireKnownName(preset);
  if (preset == "mars") {
    constexpr double kKing = kKingFactorOfCarbonDioxide;
    return std::vector<double>(wavelengths_nm.size(), 6.0 * (kKing - 1.0) / (7.0 * kKing + 3.0));
  }
  return Evaluate(wavelengths_nm, AirDepolarisation);
}

std::vector<PhaseFunction> AerosolPhase(std::string_view preset,
                                        const std::vector<double>& wavelengths_nm) {
  RequireKnownName(preset);
  for (const Aerosol& aerosol : kEarthAerosols) {
    if (preset == aerosol.name) return AerosolMixturePhase(aerosol.mixture, wavelengths_nm);
  }
  return preset == "mars" ? PhasesOfMarsDust(wavelengths_nm) : Bruneton2017().mie_phase;
}

Medium InPolarisedLight(Medium medium, std::string_view preset) {
  medium.polarised = true;
  medium.rayleigh_depolarisation = GasDepolarisation(preset, medium.wavelengths_nm);
  return medium;
}

Medium InScalarLight(Medium medium) {
  medium.polarised = false;
  medium.rayleigh_depolarisation = {0.0};
  return medium;
}

Medium MediumPreset(std::string_view name) {
  if (name == "bruneton2017") return Bruneton2017();
  return MediumPreset(name, WavelengthSet(4));
}

Medium MediumPreset(std::string_view name, const std::vector<double>& wavelengths_nm) {
  RequireKnownName(name);
  if (name == "bruneton2017") {
    Medium medium = Bruneton2017();
    if (wavelengths_nm == medium.wavelengths_nm) return medium;
    throw InputError("preset bruneton2017 is published at 440, 550 and 680 nm only");
  }
  RequireTablesReach(name, wavelengths_nm);
  const auto* aerosol = std::find_if(std::begin(kEarthAerosols), std::end(kEarthAerosols),
                                     [&](const Aerosol& one) { return name == one.name; });
  Medium medium =
      aerosol == std::end(kEarthAerosols) ? Mars(wavelengths_nm) : Earth(*aerosol, wavelengths_nm);
  medium = InPolarisedLight(std::move(medium), name);
  Validate(medium);
  return medium;
}

std::optional<Medium> OnBands(const Medium& medium, int bands) {
  const std::optional<std::string> name = PresetOf(medium);
  if (!name || medium.wavelengths_nm.front() < kFirstPresetWavelength_nm ||
      medium.wavelengths_nm.back() > kLastPresetWavelength_nm) {
    return std::nullopt;
  }
  const Medium here = MediumPreset(*name, medium.wavelengths_nm);
  const Medium there = MediumPreset(*name, WavelengthSet(bands));
  if (medium.mie_phase != here.mie_phase && medium.mie_phase.size() > 1) return std::nullopt;
  Medium result = medium;
  result.wavelengths_nm = there.wavelengths_nm;
  if (medium.mie_phase == here.mie_phase) result.mie_phase = there.mie_phase;
  if (result.rayleigh_depolarisation.size() > 1) {
    result.rayleigh_depolarisation = DepolarisationAt(medium, *name, there.wavelengths_nm);
  }
  for (const Row row : kRows) {
    const auto factors = Factors(medium.*row, here.*row);
    if (!factors) return std::nullopt;
    const SampledFunction factor(medium.wavelengths_nm, *factors);
    result.*row = there.*row;
    for (std::size_t i = 0; i < there.wavelengths_nm.size(); ++i)
      (result.*row)[i] *= factor(there.wavelengths_nm[i]);
  }
  return result;
}

Medium MediumFromChoice(const std::string& preset_or_file, const MediumUse& use,
                        const std::filesystem::path& folder) {
  const std::vector<std::string> presets = MediumPresetNames();
  if (std::find(presets.begin(), presets.end(), preset_or_file) != presets.end())
    return MediumPreset(preset_or_file);
  const std::filesystem::path file = folder / preset_or_file;
  std::error_code error;
  if (std::filesystem::exists(file, error) || LooksLikeFile(preset_or_file))
    return ReadMedium(file, use);
  const std::optional<std::string> nearest = NearestName(preset_or_file, presets);
  throw InputError(fmt::format("atmosphere \"{}\" is neither a file nor a preset; {}",
                               preset_or_file,
                               nearest ? fmt::format("did you mean {}?", *nearest)
                                       : fmt::format("presets are {}", fmt::join(presets, ", "))));
}

Medium Changed(Medium medium, const AirChoice& choice) {
  RequireInRange(choice.aerosol, 0.0, kMostAerosol, "aerosol");
  for (double& value : medium.mie_scattering_per_m) value *= choice.aerosol;
  for (double& value : medium.mie_extinction_per_m) value *= choice.aerosol;
  if (choice.ozone_du) {
    RequireInRange(*choice.ozone_du, 0.0, 10000.0, "ozone");
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
      medium.ozone_absorption_per_m[band] =
          OzoneAbsorptionAtPeak(*choice.ozone_du, medium.ozone, medium.wavelengths_nm[band]);
    }
  }
  if (choice.ground_albedo) {
    RequireInRange(*choice.ground_albedo, 0.0, 1.0, "ground albedo");
    std::fill(medium.ground_albedo.begin(), medium.ground_albedo.end(), *choice.ground_albedo);
  }
  Validate(medium);
  return medium;
}

double MoleculesAt550_per_m(const Medium& medium) {
  constexpr double kOfMolecules = -4.0;
  return CoefficientAt550(medium.wavelengths_nm, medium.rayleigh_scattering_per_m, kOfMolecules);
}

double AerosolAt550_per_m(const Medium& medium) {
  constexpr double kOfAerosol = -1.3;  // the default of aerosol.angstrom_exponent
  return CoefficientAt550(medium.wavelengths_nm, medium.mie_extinction_per_m, kOfAerosol);
}

double VisibilityOf(const Medium& medium) { return VisibilityAt(medium, 0.0, 0.0); }

double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m) {
  const AirAt550 air = AirAt(medium, altitude_m);
  return kOpticalDepthOfVisibility / (air.molecules_per_m + air.aerosol_per_m + more_per_m);
}

double AerosolForVisibility(const Medium& medium, double visibility_m, double altitude_m) {
  const AirAt550 air = AirAt(medium, altitude_m);
  const double wanted_per_m = kOpticalDepthOfVisibility / visibility_m - air.molecules_per_m;
  if (!(wanted_per_m > 0.0) || air.aerosol_per_m == 0.0) return 0.0;
  return std::min(wanted_per_m / air.aerosol_per_m, kMostAerosol);
}

double OzoneDobson(const Medium& medium) {
  double dobson = 0.0, most = 0.0;
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    const double of_one = OzoneAbsorptionAtPeak(1.0, medium.ozone, medium.wavelengths_nm[band]);
    if (of_one <= most) continue;
    most = of_one;
    dobson = medium.ozone_absorption_per_m[band] / of_one;
  }
  return dobson;
}

}  // namespace alpenglow::atmosphere
