// SPDX-License-Identifier: MIT
// Effects that a picture can omit: their names, the change of a picture, and the choice.
#include "renderer/effects/effect_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "renderer/effects/effects.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/flat_picture.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

/// Pilot pictures of grey pixels, which each missing effect darkens by a share.
struct GreyPreview {
  explicit GreyPreview(std::map<Effect, double> darkens) : darkens_(std::move(darkens)) {
    preview.groups = {PreviewGrid(160, 90, 400)};
    preview.pixels_of_picture = 160.0 * 90.0;
    preview.render = [this](EffectSet effects) {
      ++rendered;
      double value = 100.0;
      for (const auto& [effect, share] : darkens_) {
        if (!effects.Has(effect)) value *= 1.0 - share;
      }
      PreviewPicture picture{HdrImage(static_cast<int>(preview.groups[0].size()), 1), 1.0};
      for (auto& rgb : picture.image.rgb) rgb.fill(static_cast<float>(value));
      return picture;
    };
  }

  EffectPreview preview;
  int rendered = 0;

 private:
  std::map<Effect, double> darkens_;
};

constexpr EffectSet kThree{Effect::kSky, Effect::kShafts, Effect::kRelief};

constexpr EffectBudget kOnePercent{.max_error = 0.01};

TEST(EffectChoice, OnlySmallChangesAreLeftOut) {
  GreyPreview grey({{Effect::kSky, 0.5}, {Effect::kShafts, 0.004}, {Effect::kRelief, 0.003}});
  const EffectChoice choice = ChooseEffects(grey.preview, kThree, kOnePercent);
  EXPECT_EQ(choice.effects, EffectSet({Effect::kSky}));
  EXPECT_EQ(choice.LeftOut(), EffectSet({Effect::kShafts, Effect::kRelief}));
  EXPECT_NEAR(choice.together.Rms(), 0.007, 1e-4) << "both, as they add up";
}

TEST(EffectChoice, ChangesThatAreSmallOnlyAloneAreNotAllLeftOut) {
  GreyPreview grey({{Effect::kSky, 0.006}, {Effect::kShafts, 0.007}, {Effect::kRelief, 0.002}});
  const EffectChoice choice = ChooseEffects(grey.preview, kThree, kOnePercent);
  EXPECT_EQ(choice.LeftOut(), EffectSet({Effect::kSky, Effect::kRelief})) << "smallest first";
  EXPECT_LE(choice.together.RmsAtMost(), 0.01);
}

TEST(EffectChoice, ChangesThatCancelMayBeLeftOutTogether) {
  GreyPreview grey({{Effect::kSky, 0.009}, {Effect::kShafts, -0.008}});
  EXPECT_EQ(ChooseEffects(grey.preview, kThree, kOnePercent).LeftOut(), kThree)
      << "what is rendered decides, not a sum of sizes";
}

TEST(EffectChoice, OnePixelInAHundredMayChangeByFourBudgets) {
  const auto left_out = [](double change) {
    GreyPreview grey({{Effect::kShafts, 0.0}});
    const auto render = grey.preview.render;
    grey.preview.render = [&, render](EffectSet effects) {
      PreviewPicture picture = render(effects);
      if (effects.Has(Effect::kShafts)) return picture;
      for (std::size_t i = 0; i < picture.image.rgb.size(); i += 40)
        picture.image.rgb[i].fill(static_cast<float>(100.0 * (1.0 - change)));
      return picture;
    };
    return ChooseEffects(grey.preview, {Effect::kShafts}, kOnePercent)
        .LeftOut()
        .Has(Effect::kShafts);
  };
  EXPECT_TRUE(left_out(0.038)) << "0.6 % rms";
  EXPECT_FALSE(left_out(0.042)) << "0.7 % rms, but more than 4 % in one pixel of 40";
}

TEST(EffectChoice, ASmallGroupCountsAlone) {
  GreyPreview grey({{Effect::kLights, 0.0}});
  grey.preview.groups.push_back({{3, 4}, {5, 6}});
  grey.preview.render = [&](EffectSet effects) {
    const std::size_t whole = grey.preview.groups[0].size();
    PreviewPicture picture{HdrImage(static_cast<int>(whole) + 2, 1), 1.0};
    for (auto& rgb : picture.image.rgb) rgb.fill(100.0F);
    if (!effects.Has(Effect::kLights)) picture.image.rgb[whole].fill(90.0F);
    return picture;
  };
  const EffectChoice choice = ChooseEffects(grey.preview, {Effect::kLights}, kOnePercent);
  EXPECT_TRUE(choice.effects.Has(Effect::kLights));
  EXPECT_EQ(choice.estimates[0].change.groups.front().Rms(), 0.0);
  EXPECT_GT(choice.estimates[0].change.Rms(), 0.05);
}

TEST(EffectChoice, FreeEffectsAreKeptAndAbsentOnesNotRendered) {
  GreyPreview grey({{Effect::kSky, 0.5}});
  grey.preview.present = EffectSet::All().Without(Effect::kLights);
  const EffectSet wanted{Effect::kSky, Effect::kLights, Effect::kOzone};
  const EffectChoice choice = ChooseEffects(grey.preview, wanted, kOnePercent);
  EXPECT_EQ(choice.effects, wanted);
  EXPECT_EQ(grey.rendered, 2) << "with everything, and without sky";
}

TEST(EffectChoice, TheChoiceDoesNotDependOnTheClock) {
  for (const double slow : {1e-3, 1.0}) {
    GreyPreview grey({{Effect::kSky, 0.006}, {Effect::kShafts, 0.007}});
    const auto render = grey.preview.render;
    grey.preview.render = [&, render](EffectSet effects) {
      PreviewPicture picture = render(effects);
      picture.seconds = effects.Has(Effect::kSky) ? slow : 1.0 / slow;
      return picture;
    };
    EXPECT_EQ(ChooseEffects(grey.preview, kThree, kOnePercent).LeftOut(),
              EffectSet({Effect::kSky, Effect::kRelief}));
  }
}

TEST(EffectChoice, ExplainingHasALineForEachEffect) {
  GreyPreview grey({{Effect::kSky, 0.5}, {Effect::kShafts, 0.004}});
  const EffectChoice choice =
      ChooseEffects(grey.preview, kThree.With(Effect::kOzone),
                    {.max_error = 0.01, .explain = true, .leave_out = false});
  EXPECT_EQ(choice.LeftOut(), EffectSet());
  const std::string text = ExplainText(choice);
  for (const char* line : {"\nsky ", "\nshafts ", "\nrelief ", "\nozone ", "\nall left out "})
    EXPECT_THAT(text, HasSubstr(line));
  EXPECT_THAT(text, HasSubstr("kept, free"));
}

TEST(EffectChoice, RefinementsAreReportedAndNotApplied) {
  GreyPreview grey({{Effect::kSky, 0.5}});
  grey.preview.refinements.push_back({"finer", [&] {
                                        PreviewPicture picture = grey.preview.render(kThree);
                                        for (auto& rgb : picture.image.rgb) rgb.fill(101.0F);
                                        picture.seconds *= 3.0;
                                        return picture;
                                      }});
  const EffectChoice choice =
      ChooseEffects(grey.preview, kThree, {.max_error = 0.01, .explain = true});
  ASSERT_EQ(choice.refinements.size(), 1U);
  EXPECT_NEAR(choice.refinements[0].change.Rms(), 0.01, 1e-4);
  EXPECT_GT(choice.refinements[0].cost_s, 0.0);
  EXPECT_THAT(ExplainText(choice), HasSubstr("\nfiner "));
  EXPECT_TRUE(ChooseEffects(grey.preview, kThree, kOnePercent).refinements.empty());
}

TEST(PreviewGrid, HasOnePixelInEveryCell) {
  for (const auto [width, height] : {std::array{1280, 720}, {96, 54}, {1, 1}, {1, 300}, {7, 5}}) {
    std::set<std::pair<int, int>> seen;
    const auto places = PreviewGrid(width, height, std::min(400, width * height));
    for (const PixelPlace& place : places) {
      EXPECT_TRUE(place.x >= 0 && place.x < width && place.y >= 0 && place.y < height);
      seen.insert({place.x, place.y});
    }
    EXPECT_EQ(seen.size(), places.size()) << width << " x " << height;
    EXPECT_GE(places.size(), static_cast<std::size_t>(std::min(300, width * height)));
  }
}

TEST(PilotSpiral, StaysWithinItsRadiusAndThePicture) {
  const auto places = PilotSpiral(100, 50, {50.0, 49.0}, 10.0, 200);
  EXPECT_GT(places.size(), 80U);
  EXPECT_LT(places.size(), 200U) << "nearly half lies below the picture";
  for (const PixelPlace& place : places) {
    EXPECT_LT(place.y, 50);
    EXPECT_LE(std::hypot(place.x + 0.5 - 50.0, place.y + 0.5 - 49.0), 10.8);
  }
  EXPECT_TRUE(PilotSpiral(100, 50, {-500.0, 20.0}, 10.0, 20).empty());
}

TEST(Effects, AListSelectsTheseEffectsInWholeAir) {
  EXPECT_EQ(EffectsFromText("sky,aerial"),
            EffectSet({Effect::kSky, Effect::kAerial, Effect::kMolecules, Effect::kAerosol,
                       Effect::kOzone, Effect::kFineAir, Effect::kFineSpectrum}));
  EXPECT_EQ(EffectsFromText("sky,molecules"), EffectSet({Effect::kSky, Effect::kMolecules}));
}

TEST(Effects, AMinusRemovesAnEffect) {
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

TEST(Effects, AnUnknownNameIsRefusedWithTheNearest) {
  for (const auto& [text, fault] :
       {std::pair{"shaft", "effect \"shaft\" is not known; did you mean shafts?"},
        {"bloom", "known: all, sky, aerial"},
        {"sky,,aerial", "effect \"\" is not known"},
        {"", "effect \"\" is not known"},
        {"all,-rain", "effect \"rain\" is not known"}})
    EXPECT_THAT(tests::FaultOf([&, &text = text] { return EffectsFromText(text); }),
                HasSubstr(fault))
        << text;
}

HdrImage Grey(float value) { return tests::FlatPicture(20, 10, value); }

TEST(PictureChange, IsTheRelativeErrorOfSmallChanges) {
  const ErrorStatistics change = ChangeOf(Grey(100.0F), Grey(101.0F));
  EXPECT_NEAR(change.Rms(), 0.01, 1e-4) << "against the mean of both";
  EXPECT_NEAR(change.Quantile(0.99), 0.01, 1e-4);
  EXPECT_EQ(ChangeOf(Grey(100.0F), Grey(100.0F)).Rms(), 0.0);
}

TEST(PictureChange, IsSymmetricAndAtMostTwo) {
  EXPECT_EQ(PixelChange({1.0F, 2.0F, 3.0F}, {2.0F, 2.0F, 0.0F}, 0.1),
            PixelChange({2.0F, 2.0F, 0.0F}, {1.0F, 2.0F, 3.0F}, 0.1));
  EXPECT_EQ(PixelChange({5.0F, 5.0F, 5.0F}, {0.0F, 0.0F, 0.0F}, 0.1), 2.0);
  EXPECT_EQ(PixelChange({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F}, 0.1), 0.0);
}

TEST(PictureChange, DarkPixelsCountLess) {
  // Half of the pixels are middle grey; the others have a thousandth of it, and double.
  HdrImage reference = Grey(100.0F), other = Grey(100.0F);
  for (std::size_t i = 0; i < reference.rgb.size(); i += 4) {
    reference.rgb[i] = {0.1F, 0.1F, 0.1F};
    other.rgb[i] = {0.2F, 0.2F, 0.2F};
  }
  EXPECT_NEAR(ChangeFloor(reference), 100.0 / 16.0, 0.5) << "four steps below what is metered";
  EXPECT_LT(ChangeOf(reference, other).Rms(), 0.02);
}

TEST(PictureChange, ColourCountsAtEqualLuminance) {
  EXPECT_GT(PixelChange({0.0F, 0.1F, 1.0F}, {0.23F, 0.1F, 0.3F}, 0.01), 0.5);
}

TEST(PictureChange, ASampleBoundsTheWholePicture) {
  // Changes are up to a percent and, in one pixel of 20, ten times as much.
  std::mt19937 random(1);
  const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const double squares = 1e-4 / 3.0 * (0.95 + 0.05 * 100.0);
  int bounded = 0;
  for (int start = 0; start < 1000; ++start) {
    std::vector<double> sample;
    for (int i = 0; i < 400; ++i) sample.push_back(0.01 * unit() * (unit() < 0.05 ? 10.0 : 1.0));
    const ErrorStatistics estimate(sample);
    bounded += estimate.RmsAtMost() >= std::sqrt(squares) ? 1 : 0;
    EXPECT_GE(estimate.RmsAtMost(), estimate.Rms());
    EXPECT_GE(estimate.QuantileAtMost(0.99), estimate.Quantile(0.99));
  }
  EXPECT_GE(bounded, 970) << "three standard errors, of a few large changes";
}

}  // namespace
}  // namespace alpenglow::renderer
