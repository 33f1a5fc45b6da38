// SPDX-License-Identifier: MIT
// Predictions of the preview, compared with whole pictures.
#include "tests/fixtures/effect_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

RenderSettings SettingsOf(int width, int height) {
  return {.width = width, .height = height, .samples_per_pixel = 2, .layers = {}};
}
const RenderSettings kFull = SettingsOf(96, 54);
const RenderSettings kSmall = tests::ScaledDown(SettingsOf(48, 27), SettingsOf(32, 18));
// The preview has all its pixels.
const RenderSettings kTiny = SettingsOf(16, 9);

/// A scene of EffectScenes(), loaded once for all tests, with its pictures and choices.
class RenderedScene {
 public:
  explicit RenderedScene(const EffectScene& scene)
      : instant_(scene.instant), renderer_(scene.scene) {}

  [[nodiscard]] const HdrImage& With(EffectSet effects) {
    RenderSettings settings = kSmall;
    settings.effects = effects;
    const auto found = pictures_.find(effects);
    if (found != pictures_.end()) return found->second;
    return pictures_.try_emplace(effects, renderer_.Render(instant_, settings)).first->second;
  }
  [[nodiscard]] ChosenPicture Choose(double max_error, const RenderSettings& settings,
                                     bool explain = false) const {
    return renderer_.RenderWithin(instant_, settings, {.max_error = max_error, .explain = explain});
  }
  [[nodiscard]] const ChosenPicture& Within(double max_error) {
    const auto found = chosen_.find(max_error);
    if (found != chosen_.end()) return found->second;
    return chosen_.try_emplace(max_error, Choose(max_error, kSmall)).first->second;
  }
  [[nodiscard]] const HdrImage& WithAll() { return With(EffectSet::All()); }
  /// Returns estimates of all effects, including the free ones. The explanation solves the air in
  /// many bands.
  [[nodiscard]] std::vector<EffectEstimate> Explained() const {
    return Choose(0.01, kSmall, true).choice.estimates;
  }

 private:
  UtcTime instant_;
  SceneRenderer renderer_;
  std::map<EffectSet, HdrImage> pictures_;
  std::map<double, ChosenPicture> chosen_;
};

class LoadedScenes : public TemporaryFolder {
 protected:
  [[nodiscard]] RenderedScene& SceneNamed(const std::string& name) const {
    static std::map<std::string, RenderedScene> loaded;
    const auto found = loaded.find(name);
    if (found != loaded.end()) return found->second;
    for (const EffectScene& scene : EffectScenes(folder_.string())) {
      if (scene.name == name) return loaded.try_emplace(name, scene).first->second;
    }
    throw InternalError("no scene " + name);
  }
};

/// The scene in which free effects are estimated too.
const std::string kExplained = "from space";

class SceneEffects : public LoadedScenes, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    LoadedScenes::SetUp();
    scene_ = &SceneNamed(GetParam());
  }
  RenderedScene* scene_ = nullptr;
};

TEST_P(SceneEffects, PicturesOfTheChoiceStayWithinTheBudget) {
  for (const double budget : {0.01, 0.002}) {
    const ChosenPicture& chosen = scene_->Within(budget);
    const ErrorStatistics change = ChangeOf(scene_->WithAll(), chosen.image);
    EXPECT_LE(change.Rms(), budget) << NameOf(chosen.choice.effects);
    EXPECT_LE(change.Quantile(0.99), 4.0 * budget) << NameOf(chosen.choice.effects);
    EXPECT_EQ(scene_->With(chosen.choice.effects).rgb, chosen.image.rgb)
        << "the choice says what was rendered";
  }
}

TEST_P(SceneEffects, ThePilotPredictsTheChangeByEachEffect) {
  const bool explained = !tests::kSanitized && GetParam() == kExplained;
  for (const EffectEstimate& estimate :
       explained ? scene_->Explained() : scene_->Within(0.01).choice.estimates) {
    if (!estimate.present) continue;
    const HdrImage without = scene_->With(EffectSet::All().Without(estimate.effect));
    const double is = ChangeOf(scene_->WithAll(), without).Rms();
    const char* name = TextOf(estimate.effect).name;
    EXPECT_LE(is, estimate.change.RmsAtMost() + 1e-3)
        << name << ": three standard errors, and what falls between the preview's pixels";
    const ErrorStatistics& whole = estimate.change.groups.front();
    const double seen = whole.Rms(), at_most = whole.RmsAtMost();
    EXPECT_GE(is * is, 2.0 * seen * seen - at_most * at_most) << name << ": as many below";
    EXPECT_LT(seen, 2.0 * is + 1e-3) << name;
    EXPECT_LE(seen, estimate.change.Rms()) << name;
  }
}

const std::vector<const char*> kAllScenes{
    "noon clear", "noon haze",    "sunset",        "twilight", "from 10 km",
    "from space", "lamps in fog", "lamps at noon", "valley",   "cumulus"};
const std::vector<const char*> kDifferentScenes{"twilight", "lamps in fog"};
INSTANTIATE_TEST_SUITE_P(Of, SceneEffects,
                         testing::ValuesIn(tests::ScaledDown(kAllScenes, kDifferentScenes)),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

/// Tests of the effects that a scene needs.
class SceneNeeds : public LoadedScenes {
 protected:
  [[nodiscard]] EffectSet LeftOut(const std::string& name) const {
    return SceneNamed(name).Within(0.01).choice.LeftOut();
  }
  [[nodiscard]] double ChangeBy(Effect effect, const std::string& scene) const {
    RenderedScene& of = SceneNamed(scene);
    return ChangeOf(of.WithAll(), of.With(EffectSet::All().Without(effect))).Rms();
  }
};

TEST_F(SceneNeeds, TheSameChoiceForAnyNumberOfThreads) {
  const std::vector<const char*> names{"lamps in fog", "twilight"};
  for (const char* name : tests::ScaledDown(names, {names[0]})) {
    static_cast<void>(tests::EqualForAnyNumberOfThreads(
        [&] { return SceneNamed(name).Choose(0.005, kTiny).choice.effects; }));
  }
}

TEST_F(SceneNeeds, ShaftsAtSunsetAndNotAtNoon) {
  EXPECT_TRUE(LeftOut("noon clear").Has(Effect::kShafts));
  EXPECT_FALSE(LeftOut("sunset").Has(Effect::kShafts));
}

TEST_F(SceneNeeds, TheSkyByDayAndNotAtNight) {
  EXPECT_FALSE(LeftOut(tests::ScaledDown("noon haze", "noon clear")).Has(Effect::kSky));
  const EffectSet night = LeftOut("lamps in fog");
  EXPECT_TRUE(night.Has(Effect::kSky));
  EXPECT_TRUE(night.Has(Effect::kMultipleScattering));
  EXPECT_FALSE(night.Has(Effect::kBeams));
}

TEST_F(SceneNeeds, LampsByDayAndNotTheirLightInClearAir) {
  // Lamps are few pixels, so that the picture is larger.
  const EffectSet day = SceneNamed("lamps at noon").Choose(0.01, kFull).choice.LeftOut();
  EXPECT_FALSE(day.Has(Effect::kLights)) << "few pixels, but noticeable ones";
  EXPECT_TRUE(day.Has(Effect::kBeams));
}

TEST_F(SceneNeeds, OzoneTenTimesAsMuchInTwilightAsAtNoon) {
  EXPECT_GT(ChangeBy(Effect::kOzone, "twilight"), 10.0 * ChangeBy(Effect::kOzone, "noon clear"))
      << "a long way through the layer, and Chappuis' bands in a blue sky";
}

TEST_F(SceneNeeds, OnlyFourBandsByDay) {
  Scene scene = BareScene(2.0, 180.0, 10.0, 60.0);
  scene.medium = MediumPreset("earth", WavelengthSet(6));
  const SceneRenderer renderer(scene);
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const ChosenPicture chosen = renderer.RenderWithin(noon, kSmall, {.max_error = 0.05});
  EXPECT_TRUE(chosen.choice.LeftOut().Has(Effect::kFineSpectrum));
  EXPECT_LE(ChangeOf(renderer.Render(noon, kSmall), chosen.image).Rms(), 0.05);
  scene.medium = MediumPreset("earth", WavelengthSet(4));
  RenderSettings settings = kSmall;
  settings.effects = chosen.choice.effects.With(Effect::kFineSpectrum);
  EXPECT_EQ(SceneRenderer(scene).Render(noon, settings).rgb, chosen.image.rgb)
      << "the picture of four bands is that of a scene of four bands";
}

TEST_F(SceneNeeds, CloudsOnlyWhereTheSceneHasThem) {
  constexpr EffectSet kOfClouds{Effect::kClouds, Effect::kCloudShadows, Effect::kCloudGlow};
  Scene scene = BareScene(2.0, 180.0, 10.0, 60.0);
  const auto count_present = [&] {
    const ChosenPicture chosen = SceneRenderer(scene).RenderWithin(
        ParseInstant("2026-06-21T11:30:00Z"), kTiny, {.max_error = 0.01});
    return std::ranges::count_if(chosen.choice.estimates, [&](const EffectEstimate& estimate) {
      return estimate.present && kOfClouds.Has(estimate.effect);
    });
  };
  EXPECT_EQ(count_present(), 0);
  scene.clouds.resize(1);
  scene.clouds[0].options = DefaultCloudOptions(CloudGenus::kCirrus);
  scene.clouds[0].options.period_m = kPeriodStep_m;
  EXPECT_EQ(count_present(), 3);
}

TEST_F(SceneNeeds, CloudsAndTheirShadowsAndLightUnderCumulus) {
  for (const Effect effect : {Effect::kClouds, Effect::kCloudShadows, Effect::kCloudGlow}) {
    EXPECT_GT(ChangeBy(effect, "cumulus"), 0.02) << TextOf(effect).name;
  }
}

TEST_F(SceneNeeds, NoSkyBetweenTheWallsOfAValley) {
  EXPECT_TRUE(LeftOut("valley").Has(Effect::kSky));
}

}  // namespace
}  // namespace alpenglow::renderer
