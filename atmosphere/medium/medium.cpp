// SPDX-License-Identifier: MIT
#include "atmosphere/medium/medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"
#include "atmosphere/time_place/geodesy.h"

namespace alpenglow::atmosphere {
namespace {

using Fault = std::optional<MediumFault>;
using ranges::Range;

Fault OutOfRange(const std::string& key, double value, const Range& range) {
  if (value >= range.low && value <= range.high)
    return std::nullopt;  // written so that NaN is a fault
  return MediumFault{
      key, fmt::format("{} is {}; it must lie in [{}, {}]", key, value, range.low, range.high)};
}

}  // namespace

std::optional<MediumFault> FaultOfWavelengths(const std::vector<double>& wavelengths_nm,
                                              const MediumUse& use) {
  const std::string key = "spectrum.wavelengths_nm";
  if (wavelengths_nm.empty() || wavelengths_nm.size() > use.most_wavelengths) {
    return MediumFault{
        key, fmt::format("{} has {} values; it must have 1 to {}{}{}", key, wavelengths_nm.size(),
                         use.most_wavelengths, use.purpose.empty() ? "" : " for ", use.purpose)};
  }
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i) {
    if (Fault fault = OutOfRange(key, wavelengths_nm[i], ranges::kWavelength_nm)) return fault;
    if (i > 0 && !(wavelengths_nm[i] > wavelengths_nm[i - 1])) {
      return MediumFault{key, fmt::format("{} has {} after {}; it must be strictly ordered", key,
                                          wavelengths_nm[i], wavelengths_nm[i - 1])};
    }
  }
  if (!use.shows_colours) return std::nullopt;
  if (const auto fault = FaultOfColours(wavelengths_nm)) return MediumFault{key, *fault};
  return std::nullopt;
}

namespace {

struct NamedList {
  const char* key;
  const std::vector<double>& values;
  const Range& range;
};

Fault FaultOfLists(const Medium& medium) {
  const NamedList lists[] = {
      {"spectrum.solar_irradiance", medium.solar_irradiance, ranges::kSolarIrradiance},
      {"planet.ground_albedo", medium.ground_albedo, ranges::kAlbedo},
      {"rayleigh.scattering_per_m", medium.rayleigh_scattering_per_m, ranges::kCoefficient_per_m},
      {"mie.scattering_per_m", medium.mie_scattering_per_m, ranges::kCoefficient_per_m},
      {"mie.extinction_per_m", medium.mie_extinction_per_m, ranges::kCoefficient_per_m},
      {"ozone.absorption_per_m", medium.ozone_absorption_per_m, ranges::kCoefficient_per_m},
  };
  for (const NamedList& list : lists) {
    if (list.values.size() != medium.wavelengths_nm.size()) {
      return MediumFault{
          list.key, fmt::format("{} has {} values; it must have {}, one per wavelength", list.key,
                                list.values.size(), medium.wavelengths_nm.size())};
    }
    for (const double value : list.values) {
      if (Fault fault = OutOfRange(list.key, value, list.range)) return fault;
    }
  }
  return std::nullopt;
}

Fault FaultOfExtinction(const Medium& medium) {
  for (std::size_t i = 0; i < medium.wavelengths_nm.size(); ++i) {
    const double scattering = medium.mie_scattering_per_m[i];
    const double extinction = medium.mie_extinction_per_m[i];
    if (!(extinction >= scattering)) {
      return MediumFault{"mie.scattering_per_m",
                         fmt::format("mie.scattering_per_m is {} at {} nm; it must not exceed "
                                     "mie.extinction_per_m, {}",
                                     scattering, medium.wavelengths_nm[i], extinction),
                         {"mie.extinction_per_m"}};
    }
  }
  return std::nullopt;
}

// The density must decrease from the ground upwards. At the ground the deficit must not decrease
// faster than the main term; above the ground its decrease is then always the smaller of the two.
Fault FaultOfDeficit(const Medium& medium) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  const double least = medium.rayleigh_scale_height_m * deficit.share / (1.0 + deficit.share);
  if (deficit.share == 0.0 || (deficit.scale_height_m >= least &&
                               deficit.scale_height_m <= medium.rayleigh_scale_height_m)) {
    return std::nullopt;
  }
  return MediumFault{
      "rayleigh.deficit_scale_height_m",
      fmt::format("rayleigh.deficit_scale_height_m is {}; with this deficit it must lie in [{}, "
                  "{}], so that the air thins out upwards",
                  deficit.scale_height_m, least, medium.rayleigh_scale_height_m),
      {"rayleigh.deficit", "rayleigh.scale_height_m"}};
}

Fault FaultOfScalars(const Medium& medium) {
  const struct {
    const char* key;
    double value;
    const Range& range;
  } scalars[] = {
      {"planet.radius_m", medium.planet_radius_m, ranges::kPlanetRadius_m},
      {"planet.atmosphere_top_m", medium.atmosphere_height_m, ranges::kAtmosphereTop_m},
      {"rayleigh.scale_height_m", medium.rayleigh_scale_height_m, ranges::kScaleHeight_m},
      {"rayleigh.deficit", medium.rayleigh_deficit.share, ranges::kDeficit},
      {"rayleigh.deficit_scale_height_m", medium.rayleigh_deficit.scale_height_m,
       ranges::kScaleHeight_m},
      {"mie.scale_height_m", medium.mie_scale_height_m, ranges::kScaleHeight_m},
      {"ozone.bottom_m", medium.ozone.bottom_m, ranges::kOzoneAltitude_m},
      {"ozone.peak_m", medium.ozone.peak_m, ranges::kOzoneAltitude_m},
      {"ozone.top_m", medium.ozone.top_m, ranges::kOzoneAltitude_m},
  };
  for (const auto& scalar : scalars) {
    if (Fault fault = OutOfRange(scalar.key, scalar.value, scalar.range)) return fault;
  }
  if (Fault fault = FaultOfDeficit(medium)) return fault;
  const OzoneLayer& ozone = medium.ozone;
  if (ozone.shape == OzoneShape::kTent &&
      !(ozone.top_m - ozone.bottom_m >= 2.0 * ranges::kLeastOzoneSide_m)) {
    return MediumFault{"ozone.top_m",
                       fmt::format("ozone.top_m is {} and ozone.bottom_m {}; the top must lie {} m "
                                   "or more above the bottom, and ozone.peak_m between them",
                                   ozone.top_m, ozone.bottom_m, 2.0 * ranges::kLeastOzoneSide_m),
                       {"ozone.bottom_m"}};
  }
  if (!(ozone.peak_m - ozone.bottom_m >= ranges::kLeastOzoneSide_m &&
        ozone.top_m - ozone.peak_m >= ranges::kLeastOzoneSide_m)) {
    return MediumFault{
        "ozone.peak_m",
        fmt::format("ozone.peak_m is {}; it must lie between ozone.bottom_m, {}, and "
                    "ozone.top_m, {}, {} m or more from each",
                    ozone.peak_m, ozone.bottom_m, ozone.top_m, ranges::kLeastOzoneSide_m),
        {"ozone.bottom_m", "ozone.top_m"}};
  }
  if (ozone.shape == OzoneShape::kSmooth && ozone != SmoothOzone(ozone.peak_m)) {
    return MediumFault{"ozone.profile",
                       fmt::format("ozone.profile is smooth; its bottom is 0 and its top three "
                                   "times ozone.peak_m, not {} and {}",
                                   ozone.bottom_m, ozone.top_m)};
  }
  return std::nullopt;
}

/// A limit that depends on another parameter.
struct Limit {
  double value;
  std::string reason;  // "with rayleigh.scale_height_m 100"; empty for a limit of its own
  std::string key;     // of the other parameter
  std::string remedy;  // how to change that one for a wider range
};

// Two limits of different causes may leave no value; the message then names both.
Fault OutOfLimits(const std::string& key, double value, const Limit& low, const Limit& high) {
  if (value >= low.value && value <= high.value) return std::nullopt;
  const bool is_low = value < low.value;
  const std::vector<std::string> causes{is_low ? low.key : high.key, is_low ? high.key : low.key};
  if (low.value > high.value) {
    return MediumFault{key,
                       fmt::format("{} is {}, but no value is possible: {} it must be at least {}, "
                                   "and {} at most {}; {}, or {}",
                                   key, value, low.reason, low.value, high.reason, high.value,
                                   high.remedy, low.remedy),
                       causes};
  }
  return MediumFault{key,
                     fmt::format("{} is {}; {} it must lie in [{}, {}]", key, value,
                                 is_low ? low.reason : high.reason, low.value, high.value),
                     causes};
}

// The closed forms are series in scale height over radius.
Fault FaultOfRadius(const Medium& medium) {
  const auto with = [](double factor, const char* key, double value) {
    return Limit{factor * value, fmt::format("with {} {}", key, value), key, ""};
  };
  Limit low = with(ranges::kLeastRadiusInScaleHeights, "rayleigh.scale_height_m",
                   medium.rayleigh_scale_height_m);
  const Limit of_aerosol =
      with(ranges::kLeastRadiusInScaleHeights, "mie.scale_height_m", medium.mie_scale_height_m);
  if (of_aerosol.value > low.value) low = of_aerosol;
  if (medium.ozone.shape == OzoneShape::kSmooth) {
    const Limit of_ozone = {
        ranges::kLeastRadiusInSmoothOzone * medium.ozone.top_m,
        fmt::format("with the smooth ozone layer of ozone.peak_m {}", medium.ozone.peak_m),
        "ozone.peak_m", ""};
    if (of_ozone.value > low.value) low = of_ozone;
  }
  return OutOfLimits("planet.radius_m", medium.planet_radius_m, low,
                     {ranges::kPlanetRadius_m.high, "", "", ""});
}

// The closed forms for columns of ozone and of the molecules' deficit integrate each layer to its
// own end, not to the top of the atmosphere.
Fault FaultOfTop(const Medium& medium) {
  const double scale_height_m = medium.rayleigh_scale_height_m;
  Limit high = {ranges::kHighestTopInScaleHeights * scale_height_m,
                fmt::format("with rayleigh.scale_height_m {}", scale_height_m),
                "rayleigh.scale_height_m", ""};
  Limit low = {ranges::kAtmosphereTop_m.low, "", "", ""};
  const std::vector<double>& ozone = medium.ozone_absorption_per_m;
  if (std::any_of(ozone.begin(), ozone.end(), [](double peak) { return peak > 0.0; })) {
    const bool smooth = medium.ozone.shape == OzoneShape::kSmooth;
    const double part = smooth ? ranges::kEndOfSmoothOzone : 1.0;
    const char* key = smooth ? "ozone.peak_m" : "ozone.top_m";
    const double highest = high.value / part / (smooth ? SmoothOzone(1.0).top_m : 1.0);
    low = {part * medium.ozone.top_m, fmt::format("with ozone up to {}", medium.ozone.top_m), key,
           fmt::format("lower {} to {:.6g} or leave out ozone (ozone.dobson = 0)", key, highest)};
  }
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  const double end_of_deficit = ranges::kEndOfDeficit * deficit.scale_height_m;
  if (deficit.share > 0.0 && end_of_deficit > low.value) {
    const char* key = "rayleigh.deficit_scale_height_m";
    low = {end_of_deficit, fmt::format("with {} {}", key, deficit.scale_height_m), key,
           fmt::format("lower {} to {:.6g}", key, high.value / ranges::kEndOfDeficit)};
  }
  high.remedy = fmt::format("raise rayleigh.scale_height_m to {:.6g} or more",
                            low.value / ranges::kHighestTopInScaleHeights);
  high.value = std::min(high.value, ranges::kAtmosphereTop_m.high);
  return OutOfLimits("planet.atmosphere_top_m", medium.atmosphere_height_m, low, high);
}

Fault FaultOfPhase(const Medium& medium) {
  const std::vector<PhaseFunction>& phases = medium.mie_phase;
  if (phases.size() != 1 && phases.size() != medium.wavelengths_nm.size()) {
    return MediumFault{"mie.phase", fmt::format("mie.phase has {} values; it must have 1 or {}, "
                                                "one per wavelength",
                                                phases.size(), medium.wavelengths_nm.size())};
  }
  for (const PhaseFunction& phase : phases) {
    if (phase.kind != phases.front().kind) {
      return MediumFault{"mie.phase", fmt::format("mie.phase is {} beside {}; it must be of one "
                                                  "kind at all wavelengths",
                                                  NameOf(phase.kind), NameOf(phases.front().kind))};
    }
    try {
      Validate(phase, "mie");
    } catch (const InputError& error) {
      const std::string text = error.what();
      return MediumFault{text.substr(0, text.find(' ')), text};
    }
  }
  return std::nullopt;
}

Fault FaultOfDepolarisation(const Medium& medium) {
  const std::string key = "rayleigh.depolarisation";
  const std::vector<double>& values = medium.rayleigh_depolarisation;
  if (values.size() != 1 && values.size() != medium.wavelengths_nm.size()) {
    return MediumFault{
        key, fmt::format("{} has {} values; it must have 1 or {}, one per wavelength", key,
                         values.size(), medium.wavelengths_nm.size())};
  }
  for (const double value : values) {
    if (Fault fault = OutOfRange(key, value, ranges::kDepolarisation)) return fault;
  }
  return std::nullopt;
}

void AddPhase(const PhaseFunction& phase, Fnv1a& fnv) {
  fnv.Add(NameOf(phase.kind));
  fnv.Add(phase.g);
  fnv.Add(phase.g_back);
  fnv.Add(phase.back_weight);
  fnv.Add(phase.alpha);
  if (phase.table) fnv.Add(phase.table->hash());
}

// Scalar light without depolarisation adds nothing to the hash, so such a medium keeps the hash
// that it had before these two parameters existed.
void AddPolarisation(const Medium& medium, Fnv1a& fnv) {
  const std::size_t bands = medium.wavelengths_nm.size();
  std::vector<double> depolarisation;
  for (std::size_t band = 0; band < bands; ++band)
    depolarisation.push_back(Depolarisation(medium, band));
  if (depolarisation != std::vector<double>(bands, 0.0)) fnv.Add(depolarisation);
  if (medium.polarised) fnv.Add(std::uint64_t{1});
}

bool AllShareOnePhase(const Medium& medium) {
  return std::equal(medium.mie_phase.begin() + 1, medium.mie_phase.end(), medium.mie_phase.begin());
}

}  // namespace

std::vector<double> MiePhaseValues(const Medium& medium, double cos_scattering) {
  std::vector<double> values;
  values.reserve(medium.wavelengths_nm.size());
  for (const PhaseFunction& phase : medium.mie_phase) {
    values.push_back(Phase(phase, cos_scattering));
  }
  if (values.size() == 1) values.resize(medium.wavelengths_nm.size(), values.front());
  return values;
}

std::vector<double> RayleighPhaseValues(const Medium& medium, double cos_scattering) {
  std::vector<double> values;
  values.reserve(medium.wavelengths_nm.size());
  for (const double depolarisation : medium.rayleigh_depolarisation)
    values.push_back(shared::PhaseMolecules(cos_scattering, depolarisation));
  if (values.size() == 1) values.resize(medium.wavelengths_nm.size(), values.front());
  return values;
}

OzoneLayer SmoothOzone(double peak_m) {
  return {.bottom_m = 0.0, .peak_m = peak_m, .top_m = 3.0 * peak_m, .shape = OzoneShape::kSmooth};
}

double EquivalentDepth_m(const OzoneLayer& layer) {
  if (layer.shape == OzoneShape::kTent) return 0.5 * (layer.top_m - layer.bottom_m);
  constexpr double kPeak = 27.0 * 27.0 * 27.0 * 27.0 / 256.0;
  constexpr double kBeta = 1.0 / 6435.0;  // integral of (y (1 - y)^2)^4: 4! 8! / 13!
  return layer.top_m * kPeak * kBeta;
}

std::optional<MediumFault> FindFault(const Medium& medium, const MediumUse& use) {
  if (Fault fault = FaultOfWavelengths(medium.wavelengths_nm, use)) return fault;
  if (Fault fault = FaultOfScalars(medium)) return fault;
  if (Fault fault = FaultOfLists(medium)) return fault;
  if (Fault fault = FaultOfRadius(medium)) return fault;
  if (Fault fault = FaultOfTop(medium)) return fault;
  if (Fault fault = FaultOfExtinction(medium)) return fault;
  if (Fault fault = FaultOfDepolarisation(medium)) return fault;
  return FaultOfPhase(medium);
}

void Validate(const Medium& medium, const MediumUse& use) {
  if (const Fault fault = FindFault(medium, use)) throw InputError(fault->text);
}

std::uint64_t MediumHash(const Medium& medium) {
  Fnv1a fnv;
  fnv.Add(std::uint64_t{medium.follows_wgs84});
  fnv.Add(medium.planet_radius_m);
  fnv.Add(medium.atmosphere_height_m);
  fnv.Add(medium.wavelengths_nm);
  fnv.Add(medium.solar_irradiance);
  fnv.Add(medium.ground_albedo);
  fnv.Add(medium.rayleigh_scattering_per_m);
  fnv.Add(medium.rayleigh_scale_height_m);
  if (medium.rayleigh_deficit.share != 0.0) {
    fnv.Add(medium.rayleigh_deficit.share);
    fnv.Add(medium.rayleigh_deficit.scale_height_m);
  }
  fnv.Add(medium.mie_scattering_per_m);
  fnv.Add(medium.mie_extinction_per_m);
  fnv.Add(medium.mie_scale_height_m);
  for (const PhaseFunction& phase : medium.mie_phase) {
    AddPhase(phase, fnv);
    if (AllShareOnePhase(medium)) break;  // one phase for all, or equal phases, give the same hash
  }
  fnv.Add(medium.ozone_absorption_per_m);
  fnv.Add(medium.ozone.bottom_m);
  fnv.Add(medium.ozone.peak_m);
  fnv.Add(medium.ozone.top_m);
  if (medium.ozone.shape != OzoneShape::kTent) fnv.Add(std::uint64_t{1});
  AddPolarisation(medium, fnv);
  return fnv.hash();
}

double MoleculeDensity(const Medium& medium, double altitude_m) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  return (1.0 + deficit.share) * std::exp(-altitude_m / medium.rayleigh_scale_height_m) -
         deficit.share * std::exp(-altitude_m / deficit.scale_height_m);
}

double MoleculeColumn_m(const Medium& medium) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  return (1.0 + deficit.share) * medium.rayleigh_scale_height_m -
         deficit.share * deficit.scale_height_m;
}

double OsculatingRadius(const Medium& medium, double latitude_rad) {
  return medium.follows_wgs84 ? OsculatingRadius(kWgs84, latitude_rad) : medium.planet_radius_m;
}

Medium OnOsculatingSphere(Medium medium, double latitude_rad) {
  medium.planet_radius_m = OsculatingRadius(medium, latitude_rad);
  return medium;
}

namespace {

std::string ListOf(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

// Writes one value if all wavelengths share the phase function, else one value per wavelength.
std::string ParameterLine(const char* key, double PhaseFunction::*parameter,
                          const std::vector<PhaseFunction>& phases) {
  std::vector<double> values;
  for (const PhaseFunction& phase : phases) values.push_back(phase.*parameter);
  return fmt::format("{} = {}\n", key, ListOf(values));
}

// Tables with different angles at different wavelengths cannot be written as text.
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
