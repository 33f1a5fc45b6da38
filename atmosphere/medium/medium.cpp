// SPDX-License-Identifier: MIT
#include "atmosphere/medium/medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/medium_fields.h"
#include "atmosphere/medium/phase_forms.h"
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

Fault FaultOfList(const std::string& key, const std::vector<double>& values, const TomlType& type,
                  const Medium& medium) {
  if (values.size() != medium.wavelengths_nm.size()) {
    return MediumFault{key, fmt::format("{} has {} values; it must have {}, one per wavelength",
                                        key, values.size(), medium.wavelengths_nm.size())};
  }
  for (const double value : values) {
    if (Fault fault = OutOfRange(key, value, {type.low, type.high})) return fault;
  }
  return std::nullopt;
}

/// Checks all members that are numbers, or all that are lists.
Fault FaultOfFields(const Medium& medium, TomlType::Kind kind) {
  for (const TomlFields<Medium>& section : SectionsOfMedium()) {
    for (const TomlField<Medium>& field : section.fields) {
      const TomlType& type = field.member.type;
      if (type.kind != kind || !field.member.get) continue;
      const std::string key = section.name + "." + field.key;
      if (key == "rayleigh.depolarisation") continue;  // FaultOfDepolarisation
      const TomlValue value = *field.member.get(medium);
      Fault fault = kind == TomlType::Kind::kNumber
                        ? OutOfRange(key, std::get<double>(value), {type.low, type.high})
                        : FaultOfList(key, std::get<std::vector<double>>(value), type, medium);
      if (fault) return fault;
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
  if (Fault fault = FaultOfFields(medium, TomlType::Kind::kNumber)) return fault;
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
  for (const PhaseParameter& parameter : PhaseParameters()) fnv.Add(phase.*parameter.member);
  if (phase.table) fnv.Add(phase.table->hash());
}

// Parameters that are as old as the hash are added in a fixed order; later ones are added by name,
// so that a medium with their default keeps its hash.
void AddLaterParameters(const Medium& medium, Fnv1a& fnv) {
  const Medium plain;
  for (const TomlFields<Medium>& section : SectionsOfMedium()) {
    for (const TomlField<Medium>& field : section.fields) {
      if (!field.is_recorded_by_name) continue;
      const std::optional<TomlValue> value = field.member.get(medium);
      if (!value || value == field.member.get(plain)) continue;
      fnv.Add(section.name + "." + field.key);
      std::visit(
          [&](const auto& one) {
            using Type = std::decay_t<decltype(one)>;
            if constexpr (std::is_same_v<Type, bool>) fnv.Add(std::uint64_t{one});
            if constexpr (std::is_same_v<Type, TomlRows>) {
              for (const std::vector<double>& row : one) fnv.Add(row);
            } else if constexpr (!std::is_same_v<Type, bool>) {
              fnv.Add(one);
            }
          },
          *value);
    }
  }
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
  if (Fault fault = FaultOfFields(medium, TomlType::Kind::kNumbers)) return fault;
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
  AddLaterParameters(medium, fnv);
  return fnv.hash();
}

double MoleculeDensity(const Medium& medium, double altitude_m) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  return (1.0 + deficit.share) * std::exp(-altitude_m / medium.rayleigh_scale_height_m) -
         deficit.share * std::exp(-altitude_m / deficit.scale_height_m);
}

double MoleculeColumn_m(const Medium& medium, double altitude_m) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  const auto column_m = [&](double scale_height_m) {
    return scale_height_m * std::exp(-altitude_m / scale_height_m);
  };
  return (1.0 + deficit.share) * column_m(medium.rayleigh_scale_height_m) -
         deficit.share * column_m(deficit.scale_height_m);
}

double OsculatingRadius(const Medium& medium, double latitude_rad) {
  return medium.follows_wgs84 ? OsculatingRadius(kWgs84, latitude_rad) : medium.planet_radius_m;
}

Medium OnOsculatingSphere(Medium medium, double latitude_rad) {
  medium.planet_radius_m = OsculatingRadius(medium, latitude_rad);
  return medium;
}

}  // namespace alpenglow::atmosphere
