// SPDX-License-Identifier: MIT
#include "renderer/effects/effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

std::string FaultOf(const std::string& text) {
  return tests::FaultOf([&] { return EffectsFromText(text); });
}

TEST(Effects, AListSwitchesOnExactlyTheseInWholeAir) {
  EXPECT_EQ(EffectsFromText("sky,aerial"),
            EffectSet({Effect::kSky, Effect::kAerial, Effect::kMolecules, Effect::kAerosol,
                       Effect::kOzone, Effect::kFineAir, Effect::kFineSpectrum}));
  EXPECT_EQ(EffectsFromText("sky,molecules"), EffectSet({Effect::kSky, Effect::kMolecules}));
}

TEST(Effects, AMinusTakesAway) {
  const EffectSet without = EffectSet::All().Without(Effect::kOzone).Without(Effect::kShafts);
  EXPECT_EQ(EffectsFromText("all"), EffectSet::All());
  EXPECT_EQ(EffectsFromText("all,-ozone,-shafts"), without);
  EXPECT_EQ(EffectsFromText("-shafts,-ozone"), without);
}

TEST(Effects, NamesAreReadBack) {
  EXPECT_EQ(NameOf(EffectSet::All()), "all");
  EXPECT_EQ(NameOf(EffectSet::All().Without(Effect::kShafts)), "all,-shafts");
  for (const EffectText& text : EffectTexts()) {
    EXPECT_EQ(&TextOf(text.effect), &text) << "the table is in the order of the effects";
    const EffectSet without = EffectSet::All().Without(text.effect);
    EXPECT_EQ(EffectsFromText(NameOf(without)), without) << text.name;
  }
  EXPECT_EQ(EffectsFromText(NameOf(EffectSet())), EffectSet());
}

TEST(Effects, ANameThatIsNotKnownIsRefusedWithTheNearest) {
  EXPECT_THAT(FaultOf("shaft"), HasSubstr("effect \"shaft\" is not known; did you mean shafts?"));
  EXPECT_THAT(FaultOf("bloom"), HasSubstr("known: all, sky, aerial"));
  EXPECT_THAT(FaultOf("sky,,aerial"), HasSubstr("effect \"\" is not known"));
  EXPECT_THAT(FaultOf(""), HasSubstr("effect \"\" is not known"));
  EXPECT_THAT(FaultOf("all,-rain"), HasSubstr("effect \"rain\" is not known"));
}

}  // namespace
}  // namespace alpenglow::renderer
