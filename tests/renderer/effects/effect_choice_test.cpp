// SPDX-License-Identifier: MIT
#include "renderer/effects/effect_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

/// A picture of grey pixels that each missing effect darkens by a share.
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
      PreviewPicture picture{Image(static_cast<int>(preview.groups[0].size()), 1), 1.0};
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

TEST(EffectChoice, SmallChangesAreLeftOutAndLargeOnesKept) {
  GreyPreview grey({{Effect::kSky, 0.5}, {Effect::kShafts, 0.004}, {Effect::kRelief, 0.003}});
  const EffectChoice choice = ChooseEffects(grey.preview, kThree, {.max_error = 0.01});
  EXPECT_EQ(choice.effects, EffectSet({Effect::kSky}));
  EXPECT_EQ(choice.LeftOut(), EffectSet({Effect::kShafts, Effect::kRelief}));
  EXPECT_NEAR(choice.together.seen.rms, 0.007, 1e-4) << "both, as they add up";
}

TEST(EffectChoice, ChangesThatAreSmallAloneButNotTogetherAreNotAllLeftOut) {
  GreyPreview grey({{Effect::kSky, 0.006}, {Effect::kShafts, 0.007}, {Effect::kRelief, 0.002}});
  const EffectChoice choice = ChooseEffects(grey.preview, kThree, {.max_error = 0.01});
  EXPECT_EQ(choice.LeftOut(), EffectSet({Effect::kSky, Effect::kRelief})) << "smallest first";
  EXPECT_LE(choice.together.at_most.rms, 0.01);
}

TEST(EffectChoice, ChangesThatCancelMayBeLeftOutTogether) {
  GreyPreview grey({{Effect::kSky, 0.009}, {Effect::kShafts, -0.008}});
  EXPECT_EQ(ChooseEffects(grey.preview, kThree, {.max_error = 0.01}).LeftOut(), kThree)
      << "what is rendered decides, not a sum of sizes";
}

TEST(EffectChoice, APixelInAHundredMayChangeByFourBudgetsAndNotMore) {
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
    return ChooseEffects(grey.preview, {Effect::kShafts}, {.max_error = 0.01})
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
    PreviewPicture picture{Image(static_cast<int>(whole) + 2, 1), 1.0};
    for (auto& rgb : picture.image.rgb) rgb.fill(100.0F);
    if (!effects.Has(Effect::kLights)) picture.image.rgb[whole].fill(90.0F);
    return picture;
  };
  const EffectChoice choice = ChooseEffects(grey.preview, {Effect::kLights}, {.max_error = 0.01});
  EXPECT_TRUE(choice.effects.Has(Effect::kLights));
  EXPECT_EQ(choice.estimates[0].whole.seen.rms, 0.0);
  EXPECT_GT(choice.estimates[0].change.seen.rms, 0.05);
}

TEST(EffectChoice, WhatCostsNothingIsKeptAndWhatIsNotThereIsNotRendered) {
  GreyPreview grey({{Effect::kSky, 0.5}});
  grey.preview.present = EffectSet::All().Without(Effect::kLights);
  const EffectSet wanted{Effect::kSky, Effect::kLights, Effect::kOzone};
  const EffectChoice choice = ChooseEffects(grey.preview, wanted, {.max_error = 0.01});
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
    EXPECT_EQ(ChooseEffects(grey.preview, kThree, {.max_error = 0.01}).LeftOut(),
              EffectSet({Effect::kSky, Effect::kRelief}));
  }
}

TEST(EffectChoice, ExplainingKeepsAllThatItIsToldToAndHasALineForEach) {
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

TEST(EffectChoice, WhatMoreWouldChangeIsToldAndNotDone) {
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
  EXPECT_NEAR(choice.refinements[0].change.seen.rms, 0.01, 1e-4);
  EXPECT_GT(choice.refinements[0].cost_s, 0.0);
  EXPECT_THAT(ExplainText(choice), HasSubstr("\nfiner "));
  EXPECT_TRUE(ChooseEffects(grey.preview, kThree, {.max_error = 0.01}).refinements.empty());
}

TEST(PreviewGrid, HasAPixelInEveryCellAndNoneTwice) {
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

}  // namespace
}  // namespace alpenglow::renderer
