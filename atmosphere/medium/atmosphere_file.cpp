// SPDX-License-Identifier: MIT
#include "atmosphere/medium/atmosphere_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/text_file.h"
#include "atmosphere/base/toml_table.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/aerosol_mixture.h"
#include "atmosphere/medium/medium_fields.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/medium/phase_table.h"

namespace alpenglow::atmosphere {
namespace {

using Names = std::vector<std::string>;
using Values = std::vector<double>;
using Phases = std::vector<PhaseFunction>;

// Values of mie.phase that are not a PhaseKind, or that need more than parameters.
constexpr const char* kFog = "fog";
constexpr const char* kTablePhase = "table";
const Names kTableKeys{"phase_file", "phase_angles_deg", "phase_per_sr"};
const Names kAerosolAmounts{"visibility_m", "turbidity", "optical_depth_550"};

// Throws if a table contains two keys that set the same quantity.
void RequireOneOf(const TomlTable& table, const Names& keys) {
  std::string first;
  for (const std::string& key : keys) {
    if (!table.Has(key)) continue;
    if (!first.empty()) {
      table.Fail(key, fmt::format("{} is given beside {}; give one of them", table.FullName(key),
                                  table.FullName(first)));
    }
    first = key;
  }
}

void RequireNameIn(const TomlTable& table, const std::string& key, const std::string& name,
                   const Names& names) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const auto nearest = NearestName(name, names);
  table.Fail(
      key, fmt::format("{} is \"{}\"; it must be one of {}{}", table.FullName(key), name,
                       fmt::join(names, ", "), nearest ? "; did you mean " + *nearest + "?" : ""));
}

class AtmosphereFile {
 public:
  AtmosphereFile(std::string_view text, const std::string& origin, const MediumUse& use)
      : root_(text, origin), use_(use), folder_(FolderOf(origin)), preset_(PresetOf(root_)) {
    planet_ = Section("planet");
    spectrum_ = Section("spectrum");
    rayleigh_ = Section("rayleigh");
    mie_ = Section("mie");
    aerosol_ = Section("aerosol");
    ozone_ = Section("ozone");
  }

  Medium Read() {
    Medium medium = OnWavelengthsOfFile();
    const Values scattering_share = ScatteringShare(medium);
    medium = root_.Truth("polarised").value_or(medium.polarised)
                 ? InPolarisedLight(std::move(medium), preset_)
                 : InScalarLight(std::move(medium));
    if (planet_) ReadPlanet(medium);
    if (spectrum_) ReadFields(*spectrum_, "spectrum", medium);
    if (rayleigh_) ReadRayleigh(medium);
    if (mie_) ReadMie(medium);
    if (aerosol_) ReadAerosol(scattering_share, medium);
    if (ozone_) ReadOzone(medium);
    RequireComplete(medium);
    RequireFaultless(medium);
    if (medium != MediumPreset(preset_)) medium.name = fmt::format("custom (from {})", preset_);
    return medium;
  }

 private:
  static std::string PresetOf(const TomlTable& root) {
    Names names;
    for (const TomlKey& key : TopFieldsOfMedium().Keys()) names.push_back(key.key);
    for (const TomlFields<Medium>& section : SectionsOfMedium()) names.push_back(section.name);
    root.AllowOnly(names);
    const std::string preset = root.Text("preset").value_or("earth");
    RequireNameIn(root, "preset", preset, MediumPresetNames());
    return preset;
  }

  /// Returns the section, all of whose values are accepted by the rows of its keys.
  [[nodiscard]] std::optional<TomlSection> Section(const std::string& name) const {
    const std::optional<TomlTable> table = root_.Table(name);
    if (!table) return std::nullopt;
    return TomlSection(*table, SectionOfMedium(name).Keys());
  }

  /// Sets the members of the keys that a section has.
  void ReadFields(const TomlSection& section, const std::string& name, Medium& medium) const {
    for (const TomlField<Medium>& field : SectionOfMedium(name).fields) {
      if (!field.member.set) continue;
      std::optional<TomlValue> value = section.Value(field.key);
      if (!value) continue;
      if (auto* const list = std::get_if<Values>(&*value)) {
        const bool is_for_all = list->size() == 1 && field.member.type.one_for_all;
        if (!is_for_all) PutInOrder(section, field.key, medium.wavelengths_nm.size(), *list);
      }
      field.member.set(*value, medium);
    }
  }

  /// Puts a list of the file into the order of ascending wavelengths. Throws InputError unless it
  /// has one value per wavelength.
  void PutInOrder(const TomlTable& table, const std::string& key, std::size_t count,
                  Values& values) const {
    if (values.size() != count) {
      table.Fail(key, fmt::format("{} has {} values; it must have {}, one per wavelength",
                                  table.FullName(key), values.size(), count));
    }
    if (reversed_) std::reverse(values.begin(), values.end());
  }

  Values SetOfBands(double bands) const {
    for (const int count : kWavelengthSetSizes) {
      if (bands == count) return WavelengthSet(count);
    }
    spectrum_->Fail("bands", fmt::format("spectrum.bands is {}; it must be one of {}", bands,
                                         fmt::join(kWavelengthSetSizes, ", ")));
  }

  // Returns the wavelengths in ascending order, and stores whether the lists of the file must be
  // reversed.
  std::optional<Values> Wavelengths() {
    if (!spectrum_) return std::nullopt;
    RequireOneOf(*spectrum_, {"wavelengths_nm", "bands"});
    if (const auto bands = spectrum_->Number("bands")) {
      Values set = SetOfBands(*bands);
      if (set.size() > use_.most_wavelengths) {
        spectrum_->Fail("bands", fmt::format("spectrum.bands is {}; it must be at most {} for {}",
                                             *bands, use_.most_wavelengths, use_.purpose));
      }
      return set;
    }
    const std::string key = "wavelengths_nm";
    std::optional<Values> values = spectrum_->Numbers(key);
    if (!values) return std::nullopt;
    if (values->empty()) spectrum_->Fail(key, FaultOfWavelengths(*values, use_)->text);
    reversed_ = values->front() > values->back();
    if (reversed_) std::reverse(values->begin(), values->end());
    for (std::size_t i = 1; i < values->size(); ++i) {
      if ((*values)[i] > (*values)[i - 1]) continue;
      spectrum_->Fail(key, fmt::format("spectrum.wavelengths_nm has {} beside {}; it must strictly "
                                       "ascend or strictly descend",
                                       (*values)[i - 1], (*values)[i]));
    }
    if (const auto fault = FaultOfWavelengths(*values, use_)) spectrum_->Fail(key, fault->text);
    return values;
  }

  // Returns the preset on the wavelengths of the file. Lists for which the preset has no data are
  // left empty, to be filled from the file.
  Medium OnWavelengthsOfFile() {
    const std::optional<Values> wavelengths_nm = Wavelengths();
    Medium medium = MediumPreset(preset_);
    if (!wavelengths_nm || *wavelengths_nm == medium.wavelengths_nm) return medium;
    if (preset_ != "bruneton2017" && wavelengths_nm->front() >= kFirstPresetWavelength_nm &&
        wavelengths_nm->back() <= kLastPresetWavelength_nm) {
      return MediumPreset(preset_, *wavelengths_nm);
    }
    medium.wavelengths_nm = *wavelengths_nm;
    for (Values* list : {&medium.solar_irradiance, &medium.ground_albedo,
                         &medium.rayleigh_scattering_per_m, &medium.mie_scattering_per_m,
                         &medium.mie_extinction_per_m, &medium.ozone_absorption_per_m}) {
      list->clear();
    }
    medium.mie_phase = AerosolPhase(preset_, *wavelengths_nm);
    return medium;
  }

  void ReadPlanet(Medium& medium) const {
    if (planet_->Has("radius_m")) medium.follows_wgs84 = false;
    ReadFields(*planet_, "planet", medium);
  }

  // If the file gives the density profile of the molecules, refraction follows that profile.
  void ReadRayleigh(Medium& medium) const {
    if (rayleigh_->Has("scale_height_m")) medium.rayleigh_deficit = {};
    if (rayleigh_->Has("scale_height_m") || rayleigh_->Has("deficit"))
      medium.refraction = RefractionBy::kMolecules;
    ReadFields(*rayleigh_, "rayleigh", medium);
    if (rayleigh_->Has("deficit_scale_height_m") && medium.rayleigh_deficit.share == 0.0) {
      rayleigh_->Fail("deficit_scale_height_m",
                      "rayleigh.deficit_scale_height_m has no effect without rayleigh.deficit");
    }
  }

  void ReadMie(Medium& medium) const {
    ReadFields(*mie_, "mie", medium);
    ReadPhase(medium);
  }

  void ReadPhase(Medium& medium) const {
    Phases& phases = medium.mie_phase;
    const std::optional<std::string> name = mie_->Text("phase");
    RefuseKeysOfOtherPhases(name.value_or(""));
    if (name == kFog) {
      phases = {DropletsOfFile()};
    } else if (name == kTablePhase) {
      phases = TableOfFile(medium.wavelengths_nm);
    } else if (name || (mie_->Has("g") && phases.front().kind == PhaseKind::kTable)) {
      const PhaseKind kind = name ? KindOf(*name) : PhaseKind::kCornetteShanks;
      if (kind != phases.front().kind) phases = {LobeInsteadOf(phases.front().kind, kind)};
    }
    for (const PhaseParameter& parameter : PhaseParameters()) {
      const PhaseForm& form = FormOf(phases.front().kind);
      ReadParameter(parameter, name != kFog && ParameterOf(form, parameter.key), medium);
    }
    const bool equal = std::equal(phases.begin() + 1, phases.end(), phases.begin());
    if (equal) phases.resize(1);
  }

  // Returns a lobe of this kind to replace the different kind of the preset. A Cornette-Shanks lobe
  // may replace the preset's table and then has its mean cosine at 550 nm; any other lobe needs its
  // own g.
  PhaseFunction LobeInsteadOf(PhaseKind of_preset, PhaseKind kind) const {
    if (!ParameterOf(FormOf(kind), "g") || mie_->Has("g")) return {.kind = kind};
    const bool has_mixture = aerosol_ && aerosol_->Has("mixture");
    if (kind == PhaseKind::kCornetteShanks && of_preset == PhaseKind::kTable && !has_mixture) {
      const double mean_cosine = MeanCosine(AerosolPhase(preset_, {550.0}).front());
      return {.kind = kind, .g = CornetteShanksG(mean_cosine)};
    }
    mie_->Fail("phase",
               fmt::format("mie.phase is \"{}\", not the preset's: give mie.g too, for a g "
                           "of one phase function is not that of another",
                           NameOf(kind)));
  }

  void RefuseKeysOfOtherPhases(const std::string& phase) const {
    const auto refuse = [&](const std::string& key, const char* owner) {
      if (mie_->Has(key) && phase != owner) {
        mie_->Fail(key, fmt::format("mie.{} has no effect without phase = \"{}\"", key, owner));
      }
    };
    refuse("droplet_diameter_um", kFog);
    for (const std::string& key : kTableKeys) refuse(key, kTablePhase);
  }

  PhaseFunction DropletsOfFile() const {
    const auto diameter_um = mie_->Number("droplet_diameter_um");
    if (!diameter_um) mie_->Fail("phase", "mie.phase is \"fog\": give mie.droplet_diameter_um too");
    return DropletPhase(*diameter_um);
  }

  // Reads phase tables from a separate file, or from lists in this file: one table for all
  // wavelengths, or one table per wavelength, concatenated.
  Phases TableOfFile(const Values& wavelengths_nm) const {
    const auto shared = [](PhaseTable table) {
      return PhaseFunction{.kind = PhaseKind::kTable,
                           .table = std::make_shared<const PhaseTable>(std::move(table))};
    };
    if (const auto file = mie_->Text("phase_file")) {
      RequireOneOf(*mie_, {"phase_file", "phase_angles_deg"});
      const SpectralPhase spectral = ReadSpectralPhase(folder_ / *file);
      Phases phases;
      for (const double wavelength_nm : wavelengths_nm) {
        phases.push_back(shared(spectral.At(wavelength_nm)));
      }
      return phases;
    }
    const auto angles = mie_->Numbers("phase_angles_deg");
    const auto values = mie_->Numbers("phase_per_sr");
    if (!angles || !values || angles->empty()) {
      mie_->Fail("phase",
                 "mie.phase is \"table\": give mie.phase_file too, or mie.phase_angles_deg "
                 "and mie.phase_per_sr");
    }
    const std::size_t count = values->size() / angles->size();
    if (values->size() % angles->size() != 0 || (count != 1 && count != wavelengths_nm.size())) {
      mie_->Fail(
          "phase_per_sr",
          fmt::format("mie.phase_per_sr has {} values; it must have {}, one per angle, or {}, "
                      "one per angle and wavelength",
                      values->size(), angles->size(), angles->size() * wavelengths_nm.size()));
    }
    Phases phases;
    try {
      for (auto row = values->begin(); row != values->end();
           row += static_cast<std::ptrdiff_t>(angles->size())) {
        phases.push_back(
            shared(PhaseTable(*angles, {row, row + static_cast<std::ptrdiff_t>(angles->size())})));
      }
    } catch (const InputError& error) {
      mie_->Fail("phase_per_sr", std::string("mie.") + error.what());
    }
    if (reversed_) std::reverse(phases.begin(), phases.end());
    return phases;
  }

  PhaseKind KindOf(const std::string& name) const {
    try {
      return PhaseKindFromName(name);
    } catch (const InputError& error) {
      mie_->Fail("phase", std::string("mie.") + error.what());
    }
  }

  // Reads one value for all wavelengths, or one value per wavelength.
  void ReadParameter(const PhaseParameter& parameter, bool has_it, Medium& medium) const {
    const std::string key = parameter.key;
    if (!mie_->Has(key)) return;
    Phases& phases = medium.mie_phase;
    if (!has_it) {
      mie_->Fail(
          key, fmt::format("mie.{} has no effect: the phase function {} has no such parameter", key,
                           NameOf(phases.front().kind)));
    }
    Values values = *mie_->Numbers(key);
    const std::size_t count = medium.wavelengths_nm.size();
    if (values.size() == 1) {
      values.resize(phases.size(), values.front());
    } else {
      PutInOrder(*mie_, key, count, values);
      if (phases.size() != count) phases.resize(count, phases.front());
    }
    for (std::size_t i = 0; i < values.size(); ++i) phases[i].*parameter.member = values[i];
  }

  // Returns the single scattering albedo of the preset's aerosol; empty if the preset has no data.
  static Values ScatteringShare(const Medium& medium) {
    Values share;
    for (std::size_t i = 0; i < medium.mie_extinction_per_m.size(); ++i) {
      share.push_back(medium.mie_scattering_per_m[i] / medium.mie_extinction_per_m[i]);
    }
    return share;
  }

  double AerosolAt550(const Medium& medium) const {
    const TomlSection& table = *aerosol_;
    if (const auto depth = table.Number("optical_depth_550")) {
      return *depth / medium.mie_scale_height_m;
    }
    RequireList(medium.rayleigh_scattering_per_m, "rayleigh.scattering_per_m");
    const double molecules = MoleculesAt550_per_m(medium);
    if (const auto turbidity = table.Number("turbidity")) {
      return (*turbidity - 1.0) * molecules * MoleculeColumn_m(medium) / medium.mie_scale_height_m;
    }
    const double visibility_m = *table.Number("visibility_m");
    const double extinction = kOpticalDepthOfVisibility / visibility_m - molecules;
    if (!(extinction >= 0.0)) {
      table.Fail("visibility_m",
                 fmt::format("aerosol.visibility_m is {}; the molecules alone limit "
                             "it to {:.0f}",
                             visibility_m, kOpticalDepthOfVisibility / molecules));
    }
    return extinction;
  }

  bool HasAmount() const {
    return std::any_of(kAerosolAmounts.begin(), kAerosolAmounts.end(),
                       [&](const std::string& key) { return aerosol_->Has(key); });
  }

  // Applies the spectrum, phase function and layer of the mixture, and its load unless the file
  // gives one.
  void ReadMixture(const std::string& name, Medium& medium) const {
    const TomlSection& table = *aerosol_;
    RequireNameIn(table, "mixture", name, AerosolMixtureNames());
    if (table.Has("angstrom_exponent")) {
      table.Fail("angstrom_exponent",
                 "aerosol.angstrom_exponent has no effect: the mixture has a spectrum of its own");
    }
    for (const PhaseParameter& parameter : PhaseParameters()) {
      const char* key = parameter.key;
      if (!mie_ || !mie_->Has(key) || mie_->Has("phase")) continue;
      mie_->Fail(key, fmt::format("mie.{} has no effect: the mixture has a phase function of its "
                                  "own; give mie.phase too",
                                  key));
    }
    AerosolOptics optics = AerosolMixture(name, medium.wavelengths_nm);
    if (!(mie_ && mie_->Has("scale_height_m"))) medium.mie_scale_height_m = optics.scale_height_m;
    if (!(mie_ && mie_->Has("phase"))) medium.mie_phase = std::move(optics.phase);
    const auto albedo = table.Number("single_scattering_albedo");
    const double scale = HasAmount() ? AerosolAt550(medium) / optics.extinction_550_per_m : 1.0;
    medium.mie_extinction_per_m = std::move(optics.extinction_per_m);
    medium.mie_scattering_per_m = std::move(optics.scattering_per_m);
    for (std::size_t i = 0; i < medium.wavelengths_nm.size(); ++i) {
      medium.mie_extinction_per_m[i] *= scale;
      medium.mie_scattering_per_m[i] *= scale;
      if (albedo) medium.mie_scattering_per_m[i] = *albedo * medium.mie_extinction_per_m[i];
    }
  }

  void ReadAerosol(Values scattering_share, Medium& medium) const {
    const TomlSection& table = *aerosol_;
    RequireOneOf(table, kAerosolAmounts);
    if (!HasAmount() && !table.Has("mixture")) {
      root_.Fail("aerosol", fmt::format("aerosol needs mixture or one of {}",
                                        fmt::join(kAerosolAmounts, ", ")));
    }
    for (const char* key : {"scattering_per_m", "extinction_per_m"}) {
      if (mie_ && mie_->Has(key)) {
        mie_->Fail(key, fmt::format("mie.{} is given beside [aerosol]; give one of them", key));
      }
    }
    if (const auto mixture = table.Text("mixture")) return ReadMixture(*mixture, medium);
    if (const auto albedo = table.Number("single_scattering_albedo")) {
      scattering_share.assign(medium.wavelengths_nm.size(), *albedo);
    }
    RequireList(scattering_share, "aerosol.single_scattering_albedo");
    const double exponent = table.Number("angstrom_exponent").value_or(1.3);
    const double at_550 = AerosolAt550(medium);
    medium.mie_extinction_per_m.clear();
    medium.mie_scattering_per_m.clear();
    for (std::size_t i = 0; i < medium.wavelengths_nm.size(); ++i) {
      const double extinction = at_550 * std::pow(medium.wavelengths_nm[i] / 550.0, -exponent);
      medium.mie_extinction_per_m.push_back(extinction);
      medium.mie_scattering_per_m.push_back(extinction * scattering_share[i]);
    }
  }

  OzoneShape ShapeOfOzone(OzoneShape of_preset) const {
    const TomlSection& table = *ozone_;
    const bool edges = table.Has("bottom_m") || table.Has("top_m");
    const auto name = table.Text("profile");
    if (!name) return edges ? OzoneShape::kTent : of_preset;
    if (*name == "tent") return OzoneShape::kTent;
    for (const char* edge : {"bottom_m", "top_m"}) {
      if (table.Has(edge)) {
        table.Fail(edge, fmt::format("ozone.{} has no effect: a smooth profile reaches from the "
                                     "ground to three times ozone.peak_m",
                                     edge));
      }
    }
    return OzoneShape::kSmooth;
  }

  // A profile of another shape keeps the column of the preset.
  void ReadProfile(Medium& medium) const {
    const OzoneLayer of_preset = medium.ozone;
    const OzoneShape shape = ShapeOfOzone(of_preset.shape);
    if (shape != of_preset.shape)
      medium.ozone = shape == OzoneShape::kTent ? OzoneLayer{} : SmoothOzone();
    ReadFields(*ozone_, "ozone", medium);
    if (shape == OzoneShape::kSmooth) medium.ozone = SmoothOzone(medium.ozone.peak_m);
    if (shape == of_preset.shape || ozone_->Has("absorption_per_m")) return;
    for (double& peak : medium.ozone_absorption_per_m) {
      peak *= EquivalentDepth_m(of_preset) / EquivalentDepth_m(medium.ozone);
    }
  }

  void ReadOzone(Medium& medium) const {
    const TomlSection& table = *ozone_;
    RequireOneOf(table, {"absorption_per_m", "dobson"});
    ReadProfile(medium);
    if (!(medium.ozone.bottom_m < medium.ozone.top_m)) RequireFaultless(medium);
    const auto dobson = table.Number("dobson");
    if (!dobson) return;
    if (medium.wavelengths_nm.front() < kFirstPresetWavelength_nm) {
      table.Fail("dobson", fmt::format("ozone.dobson needs cross sections, which are known from {} "
                                       "nm on; give ozone.absorption_per_m",
                                       kFirstPresetWavelength_nm));
    }
    medium.ozone_absorption_per_m.clear();
    for (const double wavelength_nm : medium.wavelengths_nm) {
      medium.ozone_absorption_per_m.push_back(
          OzoneAbsorptionAtPeak(*dobson, medium.ozone, wavelength_nm));
    }
  }

  void RequireList(const Values& list, const std::string& key) const {
    if (!list.empty()) return;
    spectrum_->Fail(
        "wavelengths_nm",
        fmt::format(
            "spectrum.wavelengths_nm leaves the data of preset {} ({}); give {} "
            "too",
            preset_,
            preset_ == "bruneton2017"
                ? "440, 550 and 680 nm"
                : fmt::format("{} to {} nm", kFirstPresetWavelength_nm, kLastPresetWavelength_nm),
            key));
  }

  void RequireComplete(const Medium& medium) const {
    RequireList(medium.solar_irradiance, "spectrum.solar_irradiance");
    RequireList(medium.ground_albedo, "planet.ground_albedo");
    RequireList(medium.rayleigh_scattering_per_m, "rayleigh.scattering_per_m");
    RequireList(medium.mie_scattering_per_m, "mie.scattering_per_m");
    RequireList(medium.mie_extinction_per_m, "mie.extinction_per_m");
    RequireList(medium.ozone_absorption_per_m, "ozone.absorption_per_m");
  }

  /// Throws the fault with the line of its key, or else of the first of its causes that the file
  /// has: what the file does not set is that of the preset.
  void RequireFaultless(const Medium& medium) const {
    const std::optional<MediumFault> fault = FindFault(medium, use_);
    if (!fault) return;
    FailAtKey(fault->key, fault->text);
    for (const std::string& cause : fault->causes) FailAtKey(cause, fault->text);
    const std::optional<TomlTable> section = SectionOf(fault->key);
    (section ? *section : root_).Fail(KeyInSection(fault->key), fault->text);
  }

  [[nodiscard]] static std::string KeyInSection(const std::string& key) {
    return key.substr(key.find('.') + 1);
  }
  [[nodiscard]] std::optional<TomlTable> SectionOf(const std::string& key) const {
    return root_.Table(key.substr(0, key.find('.')));
  }
  /// Throws if the file has the key.
  void FailAtKey(const std::string& key, const std::string& fault) const {
    const std::optional<TomlTable> section = SectionOf(key);
    if (section && section->Has(KeyInSection(key))) section->Fail(KeyInSection(key), fault);
  }

  TomlTable root_;
  MediumUse use_;
  std::filesystem::path folder_;  // folder of the file; names of other files are relative to it
  std::string preset_;
  std::optional<TomlSection> planet_, spectrum_, rayleigh_, mie_, aerosol_, ozone_;
  bool reversed_ = false;
};

std::string ListOf(const std::vector<double>& values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

std::string ParameterLine(const PhaseParameter& parameter,
                          const std::vector<PhaseFunction>& phases) {
  std::vector<double> values;
  for (const PhaseFunction& phase : phases) values.push_back(phase.*parameter.member);
  return fmt::format("{} = {}\n", parameter.key, ListOf(values));
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
  for (const PhaseParameter& parameter : FormOf(kind).parameters)
    lines += ParameterLine(parameter, phases);
  return lines;
}

std::string TextOf(const TomlValue& value) {
  if (const auto* const list = std::get_if<Values>(&value)) return ListOf(*list);
  if (const auto* const name = std::get_if<std::string>(&value))
    return fmt::format("\"{}\"", *name);
  if (const auto* const truth = std::get_if<bool>(&value)) return fmt::format("{}", *truth);
  return fmt::format("{}", std::get<double>(value));
}

/// Returns whether a key has an effect. Keys without effect, and the default of refraction, are not
/// written.
bool IsWritten(const std::string& section, const std::string& key, const Medium& medium) {
  if (section == "rayleigh" && key.starts_with("deficit"))
    return medium.rayleigh_deficit.share != 0.0;
  if (key == "refraction") return medium.refraction == RefractionBy::kAlmanacs;
  if (section == "ozone" && (key == "bottom_m" || key == "top_m"))
    return medium.ozone.shape == OzoneShape::kTent;
  return true;
}

std::string LinesOf(const TomlFields<Medium>& section, const Medium& medium) {
  std::string lines;
  for (const TomlField<Medium>& field : section.fields) {
    if (!field.member.get || !IsWritten(section.name, field.key, medium)) continue;
    if (const auto value = field.member.get(medium))
      lines += fmt::format("{} = {}\n", field.key, TextOf(*value));
  }
  if (section.name == "mie") lines += PhaseLines(medium.mie_phase);
  if (lines.empty() || section.name.empty()) return lines;
  return fmt::format("[{}]\n{}", section.name, lines);
}

}  // namespace

Medium MediumFromToml(std::string_view text, const std::string& origin, const MediumUse& use) {
  return AtmosphereFile(text, origin, use).Read();
}

Medium ReadMedium(const std::filesystem::path& file, const MediumUse& use) {
  return MediumFromToml(ReadTextFile(file), file.string(), use);
}

std::string TomlFromMedium(const Medium& medium) {
  std::string text = LinesOf(TopFieldsOfMedium(), medium);
  for (const TomlFields<Medium>& section : SectionsOfMedium()) text += LinesOf(section, medium);
  if (MediumHash(MediumFromToml(text, "medium")) != MediumHash(medium)) {
    throw InputError(fmt::format(
        "medium {}: its phase function has a parameter set that it does not use", medium.name));
  }
  return text;
}

}  // namespace alpenglow::atmosphere
