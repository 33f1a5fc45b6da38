// SPDX-License-Identifier: MIT
#include "renderer/effects/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "lut/cli/program.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr std::array<EffectText, kEffects> kTexts{{
    {Effect::kSky, "sky", "the air in front of space is black", false, false},
    {Effect::kAerial, "aerial", "no air in front of the ground", false, false},
    {Effect::kMultipleScattering, "multiple-scattering",
     "light comes to the eye scattered once, or not at all", false, false},
    {Effect::kSkylight, "skylight", "the sky does not light the ground", false, false},
    {Effect::kHorizons, "horizons", "terrain hides no part of the sky from the ground", false,
     false},
    {Effect::kBounce, "bounce", "slopes send no light to each other", false, false},
    {Effect::kShafts, "shafts", "terrain does not shade air and clouds", false, false},
    {Effect::kShadows, "shadows", "terrain casts no shadows on the ground", false, false},
    {Effect::kRelief, "relief", "ground between samples of elevation is smooth", false, false},
    {Effect::kLights, "lights", "lamps are off", false, false},
    {Effect::kBeams, "beams", "air does not scatter the light of lamps to the eye", false, false},
    {Effect::kLayerGlow, "fog-glow", "fog scatters light of lamps alone", false, false},
    {Effect::kVolumes, "volumes", "volumes of smoke and fog are not there", false, false},
    {Effect::kClouds, "clouds", "no clouds", false, false},
    {Effect::kCloudShadows, "cloud-shadows",
     "clouds cast no shadows on the ground and into the air", false, false},
    {Effect::kCloudGlow, "cloud-glow",
     "air and ground get no light from clouds, and clouds none from lamps", false, false},
    {Effect::kMoonlight, "moonlight", "the moon is seen and lights nothing", false, false},
    {Effect::kNightSky, "night-sky", "no airglow, zodiacal light and Milky Way", false, false},
    {Effect::kStars, "stars", "neither stars nor planets", false, false},
    {Effect::kRefraction, "refraction",
     "the disk of a low sun is round, sea and mountains stand where they "
     "would without air",
     false, false},
    {Effect::kMolecules, "molecules", "air without molecules", true, true},
    {Effect::kAerosol, "aerosol", "air without aerosol", true, true},
    {Effect::kOzone, "ozone", "air without ozone", true, true},
    {Effect::kFineAir, "fine-air", "half as many nodes along rays through the air", true, false},
    {Effect::kFineSpectrum, "fine-spectrum", "four bands", true, false},
}};

EffectSet PartsOfAir() {
  EffectSet parts;
  for (const EffectText& text : kTexts) {
    if (text.is_of_air) parts = parts.With(text.effect);
  }
  return parts;
}

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const EffectText& text : kTexts) names.emplace_back(text.name);
  return names;
}

Effect EffectFromName(std::string_view name) {
  for (const EffectText& text : kTexts) {
    if (name == text.name) return text.effect;
  }
  const std::vector<std::string> names = Names();
  const auto nearest = NearestName(name, names);
  throw InputError(fmt::format("effect \"{}\" is not known; {}", name,
                               nearest ? fmt::format("did you mean {}?", *nearest)
                                       : fmt::format("known: all, {}", fmt::join(names, ", "))));
}

std::string Joined(const std::vector<Effect>& effects, std::string_view prefix) {
  std::string joined;
  for (const Effect effect : effects) {
    joined += fmt::format("{}{}{}", joined.empty() ? "" : ",", prefix, TextOf(effect).name);
  }
  return joined;
}

}  // namespace

std::span<const EffectText> EffectTexts() { return kTexts; }

const EffectText& TextOf(Effect effect) { return kTexts[static_cast<std::size_t>(effect)]; }

std::vector<Effect> EffectSet::List() const {
  std::vector<Effect> list;
  for (const EffectText& text : kTexts) {
    if (Has(text.effect)) list.push_back(text.effect);
  }
  return list;
}

std::string NamesOfEffects() { return fmt::format("{}", fmt::join(Names(), ", ")); }

EffectSet EffectsFromText(std::string_view text) {
  EffectSet effects = text.starts_with('-') ? EffectSet::All() : EffectSet();
  bool names_air = false, takes_all = text.starts_with('-');
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string_view name = text.substr(at, comma - at);
    at = comma + 1;
    if (name == "all") {
      effects = EffectSet::All();
      takes_all = true;
    } else if (name.starts_with('-')) {
      effects = effects.Without(EffectFromName(name.substr(1)));
    } else {
      const Effect effect = EffectFromName(name);
      effects = effects.With(effect);
      names_air = names_air || TextOf(effect).is_of_air;
    }
  }
  if (names_air || takes_all) return effects;
  for (const Effect part : PartsOfAir().List()) effects = effects.With(part);
  return effects;
}

std::string NameOf(EffectSet effects) {
  std::vector<Effect> off;
  for (const EffectText& text : kTexts) {
    if (!effects.Has(text.effect)) off.push_back(text.effect);
  }
  return off.empty() ? "all" : "all," + Joined(off, "-");
}

}  // namespace alpenglow::renderer
