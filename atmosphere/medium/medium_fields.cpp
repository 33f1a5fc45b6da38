// SPDX-License-Identifier: MIT
#include "atmosphere/medium/medium_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/medium/phase_forms.h"

namespace alpenglow::atmosphere {
namespace {

constexpr EnumNames kRefractions{
    {std::pair{RefractionBy::kMolecules, "molecules"}, {RefractionBy::kAlmanacs, "almanacs"}}};
constexpr EnumNames kOzoneShapes{
    {std::pair{OzoneShape::kSmooth, "smooth"}, {OzoneShape::kTent, "tent"}}};

using MediumRows = std::vector<TomlField<Medium>>;

constexpr std::pair<double, double> Pair(const ranges::Range& range) {
  return {range.low, range.high};
}

TomlMember<Medium> List(std::vector<double> Medium::*member, const ranges::Range& range) {
  return Numbers(member, Pair(range));
}

/// The medium has one value per wavelength; the file may have one for all.
TomlMember<Medium> GroundAlbedo() {
  TomlMember<Medium> member = OneForAll(List(&Medium::ground_albedo, ranges::kAlbedo));
  member.set = [](const TomlValue& value, Medium& medium) {
    medium.ground_albedo = std::get<std::vector<double>>(value);
    if (medium.ground_albedo.size() == 1)
      medium.ground_albedo.resize(medium.wavelengths_nm.size(), medium.ground_albedo.front());
  };
  return member;
}

TomlMember<Medium> OzoneAltitude(double OzoneLayer::*altitude) {
  return Number(&Medium::ozone, altitude, Pair(ranges::kOzoneAltitude_m));
}

MediumRows TopRows() {
  return {
      {"preset", Text<Medium>(), "",
       "`earth` (default), `clear-mountain`, `hazy`, `mars`, `bruneton2017`",
       "The air that the other keys modify. [medium/medium_presets.cpp](medium/medium_presets.cpp) "
       "gives the source of every number"},
      {"polarised", ReadApart(Truth(&Medium::polarised)), "",
       "default `true`, of the preset `bruneton2017` `false`",
       "`true`: light of all orders is polarised, and molecules have the depolarisation of the "
       "preset's gas. `false`: the light is scalar, as in other renderers, and molecules do not "
       "depolarise unless the file sets `rayleigh.depolarisation`"},
  };
}

MediumRows PlanetRows() {
  return {
      {"radius_m", Number(&Medium::planet_radius_m, Pair(ranges::kPlanetRadius_m)), "m",
       "and at least 25 scale heights of molecules and of aerosol; with a smooth layer of ozone at "
       "least 9 times `ozone.peak_m`",
       "Radius of the ground. If it is given, the planet is a sphere"},
      {"follows_wgs84", Truth(&Medium::follows_wgs84), "", "",
       "`true`: at each place the planet is the sphere that osculates the WGS84 ellipsoid. This is "
       "the default of the earth presets"},
      {"atmosphere_top_m", Number(&Medium::atmosphere_height_m, Pair(ranges::kAtmosphereTop_m)),
       "m",
       "and at most 300 scale heights of the molecules; at least `ozone.top_m` of a tent, 2.7 "
       "times "
       "`ozone.peak_m` of a smooth layer, and 8 times `rayleigh.deficit_scale_height_m` if there "
       "is "
       "a deficit",
       "Height of the top of the air above the ground"},
      {"ground_albedo", GroundAlbedo(), "1", "",
       "Reflectance of the ground for light of all orders: one value, or one per wavelength"},
  };
}

MediumRows SpectrumRows() {
  return {
      {"wavelengths_nm", ReadApart(List(&Medium::wavelengths_nm, ranges::kWavelength_nm)), "nm",
       "1 to 512 values (see below)",
       "Wavelengths, strictly ascending or strictly descending. Every list of the file has the "
       "same "
       "order. Outside the range of the preset's data (360 to 830 nm), the file must contain every "
       "list"},
      {"bands", Number<Medium>({3.0, 40.0}), "", "one of 3, 4, 5, 6, 8, 16 and 40",
       "A wavelength set that is optimised for colour, instead of `wavelengths_nm`. The default is "
       "4"},
      {"solar_irradiance", List(&Medium::solar_irradiance, ranges::kSolarIrradiance), "W m⁻² nm⁻¹",
       "", "Irradiance of the sun above the air, one value per wavelength"},
  };
}

MediumRows RayleighRows() {
  return {
      {"scattering_per_m", List(&Medium::rayleigh_scattering_per_m, ranges::kCoefficient_per_m),
       "m⁻¹", "", "Scattering coefficient at the ground, one value per wavelength"},
      {"scale_height_m", Number(&Medium::rayleigh_scale_height_m, Pair(ranges::kScaleHeight_m)),
       "m", "",
       "Scale height of the density. If it is given without `deficit`, the density is a single "
       "exponential"},
      {"deficit",
       Number(&Medium::rayleigh_deficit, &MoleculeDeficit::share, Pair(ranges::kDeficit)), "1", "",
       "Fraction of a second exponential that is subtracted from the first (`MoleculeDeficit` in "
       "[medium/medium.h](medium/medium.h)). The earth presets use it to follow the U.S. Standard "
       "Atmosphere"},
      {"deficit_scale_height_m",
       Number(&Medium::rayleigh_deficit, &MoleculeDeficit::scale_height_m,
              Pair(ranges::kScaleHeight_m)),
       "m", "and from `scale_height_m` × `deficit` / (1 + `deficit`) to `scale_height_m`",
       "Scale height of the second exponential"},
      {"depolarisation", OneForAll(List(&Medium::rayleigh_depolarisation, ranges::kDepolarisation)),
       "1", "",
       "Depolarisation of light that is scattered by 90 degrees: one value, or one per wavelength"},
      {"refraction", Name(&Medium::refraction, kRefractions, OneOf), "", "",
       "Decrease of the refractive index with height. It bends lines of sight and changes no "
       "light. "
       "`molecules` follows the density of the molecules; `almanacs` lifts a star on the horizon "
       "by "
       "34', as almanacs do. The earth presets use `almanacs`; if `scale_height_m` or `deficit` is "
       "given, the default is `molecules`"},
  };
}

std::string LimitsOf(const PhaseParameter& parameter) {
  return parameter.has_ends ? "" : "without these ends";
}

/// Returns the limits beyond the widest range: its ends, and narrower ranges of single phase
/// functions.
std::string AllLimitsOf(const PhaseParameter& parameter) {
  std::string limits = LimitsOf(parameter);
  for (const PhaseForm& form : PhaseForms()) {
    const PhaseParameter own = ParameterOf(form, parameter.key).value_or(parameter);
    if (own.low == parameter.low && own.high == parameter.high) continue;
    limits += fmt::format("{}of `{}` between {} and {}", limits.empty() ? "" : "; ", form.name,
                          own.low, own.high);
    if (!own.has_ends) limits += ", " + LimitsOf(own);
  }
  return limits;
}

TomlField<Medium> RowOf(const PhaseParameter& parameter) {
  return {parameter.key, Numbers<Medium>({parameter.low, parameter.high}), parameter.unit,
          AllLimitsOf(parameter),
          fmt::format("{}: one value, or one per wavelength", parameter.text)};
}

MediumRows MieRows() {
  MediumRows rows{
      {"scattering_per_m", List(&Medium::mie_scattering_per_m, ranges::kCoefficient_per_m), "m⁻¹",
       "and at most `extinction_per_m`",
       "Scattering coefficient at the ground, one value per wavelength"},
      {"extinction_per_m", List(&Medium::mie_extinction_per_m, ranges::kCoefficient_per_m), "m⁻¹",
       "", "Extinction coefficient at the ground, one value per wavelength"},
      {"scale_height_m", Number(&Medium::mie_scale_height_m, Pair(ranges::kScaleHeight_m)), "m", "",
       "Scale height of the density"},
      {"phase", Text<Medium>(), "", "see below", "Phase function"},
  };
  for (const PhaseParameter& parameter : PhaseParameters()) rows.push_back(RowOf(parameter));
  rows.insert(
      rows.end(),
      {
          {"phase_file", Text<Medium>(), "", "",
           "CSV file of the phase function `table`, relative to the atmosphere file"},
          {"phase_angles_deg", Numbers<Medium>({0.0, 180.0}), "degrees",
           "at least 5 values that strictly ascend from 0 to 180",
           "Scattering angles of `table`, instead of `phase_file`"},
          {"phase_per_sr", Numbers<Medium>({0.0, 1e12}), "sr⁻¹", "without 0",
           "Values of `table` at these angles: one list, or one list per wavelength, one after the "
           "other"},
          {"droplet_diameter_um", Number<Medium>({kSmallestDroplet_um, kLargestDroplet_um}), "µm",
           "", "Diameter of the droplets of `fog`"},
      });
  return rows;
}

MediumRows AerosolRows() {
  return {
      {"visibility_m", Number<Medium>({1.0, 1e7}), "m",
       "and at most the visibility in molecules alone", "Meteorological visibility at the ground"},
      {"turbidity", Number<Medium>({1.0, 1000.0}), "1", "",
       "Optical depth of air with haze, divided by the optical depth without it (McCartney 1976)"},
      {"optical_depth_550", Number<Medium>({0.0, 100.0}), "1", "",
       "Vertical optical depth of the aerosol at 550 nm"},
      {"angstrom_exponent", Number<Medium>({-1.0, 4.0}), "1", "default 1.3",
       "Exponent of the spectrum. It is not allowed with a mixture"},
      {"single_scattering_albedo", Number<Medium>({0.0, 1.0}), "1", "",
       "Scattering divided by extinction. The default is the value of the preset or the mixture"},
      {"mixture", Text<Medium>(), "", "a name below",
       "An OPAC mixture at 80 % relative humidity: spectrum, phase function, scale height and, "
       "unless the file gives an amount, load"},
  };
}

MediumRows OzoneRows() {
  return {
      {"absorption_per_m", List(&Medium::ozone_absorption_per_m, ranges::kCoefficient_per_m), "m⁻¹",
       "", "Absorption coefficient at the peak, one value per wavelength"},
      {"dobson", Number<Medium>({0.0, 10000.0}), "DU", "",
       "Vertical column, instead of `absorption_per_m`"},
      {"profile", ReadApart(Name(&Medium::ozone, &OzoneLayer::shape, kOzoneShapes, OneOf)), "", "",
       "Shape of the layer. If it differs from the preset's shape, the column is kept"},
      {"bottom_m", OzoneAltitude(&OzoneLayer::bottom_m), "m", "",
       "Lower end of a tent. If it is given, the shape is a tent"},
      {"peak_m", OzoneAltitude(&OzoneLayer::peak_m), "m", "and 1 m or more from both ends",
       "Altitude of the peak. A smooth layer extends from the ground to three times `peak_m`"},
      {"top_m", OzoneAltitude(&OzoneLayer::top_m), "m", "",
       "Upper end of a tent. If it is given, the shape is a tent"},
  };
}

}  // namespace

std::string NameOf(RefractionBy refraction) { return kRefractions.Of(refraction); }

const TomlFields<Medium>& TopFieldsOfMedium() {
  static const TomlFields<Medium> top{"", TopRows()};
  return top;
}

const std::vector<TomlFields<Medium>>& SectionsOfMedium() {
  static const std::vector<TomlFields<Medium>> sections{
      {"planet", PlanetRows()}, {"spectrum", SpectrumRows()}, {"rayleigh", RayleighRows()},
      {"mie", MieRows()},       {"aerosol", AerosolRows()},   {"ozone", OzoneRows()}};
  return sections;
}

const TomlFields<Medium>& SectionOfMedium(std::string_view name) {
  const auto& sections = SectionsOfMedium();
  const auto found = std::find_if(sections.begin(), sections.end(),
                                  [&](const auto& section) { return section.name == name; });
  if (found == sections.end()) throw InternalError("atmosphere.toml has no section of this name");
  return *found;
}

}  // namespace alpenglow::atmosphere
