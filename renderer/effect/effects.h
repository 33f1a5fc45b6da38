// SPDX-License-Identifier: MIT
// What a picture is made of, effect by effect, so that each can be left out: to compare, or because
// a scene does not need it.
//
// Effects of the picture are switched on and off freely. Parts of the air (molecules, aerosol,
// ozone) change the light that scattering at every order brings: leaving one out means another
// medium, solved anew.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::renderer {

/// One line here and one in the table of effects.cpp make a new effect.
enum class Effect : std::size_t {
  kSky,
  kAerial,
  kMultipleScattering,
  kSkylight,
  kHorizons,
  kBounce,
  kShafts,
  kShadows,
  kRelief,
  kLights,
  kBeams,
  kFogGlow,
  kVolumes,
  kMoonlight,
  kNightSky,
  kStars,
  kRefraction,
  kMolecules,
  kAerosol,
  kOzone,
  kFineAir,
  kFineSpectrum,
};
inline constexpr std::size_t kEffects = static_cast<std::size_t>(Effect::kFineSpectrum) + 1;

/// What an effect is called, and what the picture is without it.
struct EffectText {
  Effect effect;
  const char* name;      // as --effects takes it
  const char* left_out;  // "the sky is black"
  bool is_of_air;        // a part of the air: on unless a list names some of them
  bool is_free;          // leaving it out saves no time: never left out to save some
};

/// All effects, in the order of Effect.
[[nodiscard]] std::span<const EffectText> EffectTexts();
[[nodiscard]] const EffectText& TextOf(Effect effect);

/// A set of effects that are on.
class EffectSet {
 public:
  constexpr EffectSet() = default;  // none
  constexpr EffectSet(std::initializer_list<Effect> effects) {
    for (const Effect effect : effects) bits_ |= Bit(effect);
  }
  [[nodiscard]] static constexpr EffectSet All() {
    EffectSet all;
    all.bits_ = (1U << kEffects) - 1U;
    return all;
  }

  [[nodiscard]] constexpr bool Has(Effect effect) const { return (bits_ & Bit(effect)) != 0; }
  [[nodiscard]] constexpr EffectSet With(Effect effect) const {
    EffectSet more = *this;
    more.bits_ |= Bit(effect);
    return more;
  }
  [[nodiscard]] constexpr EffectSet Without(Effect effect) const {
    EffectSet less = *this;
    less.bits_ &= ~Bit(effect);
    return less;
  }
  /// What both have.
  [[nodiscard]] constexpr EffectSet And(EffectSet other) const {
    EffectSet both;
    both.bits_ = bits_ & other.bits_;
    return both;
  }
  [[nodiscard]] std::vector<Effect> List() const;
  constexpr bool operator==(const EffectSet&) const = default;
  /// An order for containers, without meaning.
  [[nodiscard]] constexpr bool operator<(const EffectSet& other) const {
    return bits_ < other.bits_;
  }

 private:
  static constexpr unsigned Bit(Effect effect) { return 1U << static_cast<unsigned>(effect); }
  unsigned bits_ = 0;
};

/// "sky, aerial, ...": the names of all effects.
[[nodiscard]] std::string NamesOfEffects();

/// Reads "all", or names separated by commas: exactly these effects, and of the parts of the air
/// all unless one is named. "-NAME" takes an effect away; a list that begins so begins with all:
/// "-shafts", "all,-ozone". Throws InputError for a name that is not known, with the nearest.
[[nodiscard]] EffectSet EffectsFromText(std::string_view text);

/// "all" or "all,-shafts,-ozone"; read back by EffectsFromText.
[[nodiscard]] std::string NameOf(EffectSet effects);

}  // namespace alpenglow::renderer
