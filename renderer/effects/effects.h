// SPDX-License-Identifier: MIT
// This header lists the effects of a picture. Each can be left out, for comparison or because a
// scene does not need it.
//
// Effects of the picture are switched freely. Parts of the air (molecules, aerosol, ozone)
// contribute to scattering of every order, so leaving one out requires solving another medium.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::renderer {

/// A new effect needs one line here and one in the table of effects.cpp.
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
  kLayerGlow,
  kVolumes,
  kClouds,
  kCloudShadows,
  kCloudGlow,
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

/// Name of an effect, and a description of the picture without it.
struct EffectText {
  Effect effect;
  const char* name;      // as in --effects
  const char* left_out;  // "the sky is black"
  bool is_of_air;        // part of the air: on unless a list names some of them
  bool is_free;          // leaving it out saves no time, so it is never left out automatically
};

/// All effects, in the order of Effect.
[[nodiscard]] std::span<const EffectText> EffectTexts();
[[nodiscard]] const EffectText& TextOf(Effect effect);

/// A set of enabled effects.
class EffectSet {
 public:
  constexpr EffectSet() = default;  // empty set
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
  /// Returns the intersection of two sets.
  [[nodiscard]] constexpr EffectSet And(EffectSet other) const {
    EffectSet both;
    both.bits_ = bits_ & other.bits_;
    return both;
  }
  [[nodiscard]] std::vector<Effect> List() const;
  constexpr bool operator==(const EffectSet&) const = default;
  /// Arbitrary order for containers.
  [[nodiscard]] constexpr bool operator<(const EffectSet& other) const {
    return bits_ < other.bits_;
  }

 private:
  static constexpr unsigned Bit(Effect effect) { return 1U << static_cast<unsigned>(effect); }
  unsigned bits_ = 0;
};

/// Returns the names of all effects: "sky, aerial, ...".
[[nodiscard]] std::string NamesOfEffects();

/// Reads "all", or names separated by commas. A list of names enables exactly these effects, and
/// all parts of the air unless it names one of them. "-NAME" removes an effect; a list that starts
/// with a removal starts from all effects: "-shafts", "all,-ozone". Throws InputError for an
/// unknown name, suggesting the nearest one.
[[nodiscard]] EffectSet EffectsFromText(std::string_view text);

/// Returns "all" or "all,-shafts,-ozone"; EffectsFromText reads it back.
[[nodiscard]] std::string NameOf(EffectSet effects);

}  // namespace alpenglow::renderer
