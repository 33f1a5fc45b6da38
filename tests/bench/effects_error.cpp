// SPDX-License-Identifier: MIT
// Measures the change of whole pictures and the time saved when effects are left out, and compares
// both with the prediction of the preview. Run by hand; results are in README.md.
//   studies effects_error [WIDTH HEIGHT [SCENE [preview]]]
// With "preview" it measures only the cost of the choice.
#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>

#include "tests/bench/studies.h"
#include "tests/fixtures/effect_scenes.h"

namespace alpenglow::renderer {
namespace {

struct Timed {
  HdrImage image;
  double seconds;
};

Timed Render(const SceneRenderer& renderer, const EffectScene& scene,
             const RenderSettings& settings) {
  const Stopwatch watch;
  HdrImage image = renderer.Render(scene.instant, settings);
  return {std::move(image), watch.seconds()};
}

void MeasurePreview(const EffectScene& scene, const RenderSettings& settings) {
  const SceneRenderer renderer(scene.scene);
  (void)renderer.RenderWithin(scene.instant, settings, {});
  const EffectChoice choice = renderer.RenderWithin(scene.instant, settings, {}).choice;
  fmt::print("{}: choosing takes {:.3f} s, {:.1f} % of {:.2f} s with everything\n", scene.name,
             choice.preview_s, 100.0 * choice.preview_s / choice.all_s, choice.all_s);
}

void Measure(const EffectScene& scene, RenderSettings settings) {
  const SceneRenderer renderer(scene.scene);
  const RenderSettings everything = settings;
  (void)renderer.Render(scene.instant, everything);  // prepares data that all pictures share
  const Timed all = Render(renderer, scene, settings);
  fmt::print("\n{} ({:.2f} s with everything)\n", scene.name, all.seconds);
  fmt::print("{:<22}{:>19}{:>19}{:>19}\n", "without", "rms said, is %", "99 % said, is %",
             "saves said, does s");
  const auto hold = [&](const std::string& name, EffectSet effects, const PreviewChange& said,
                        double saves_s) {
    settings.effects = effects;
    const Timed without = Render(renderer, scene, settings);
    const ErrorStatistics is = ChangeOf(all.image, without.image);
    fmt::print("{:<22}{:>10.3f}{:>9.3f}{:>10.3f}{:>9.3f}{:>10.3f}{:>9.3f}\n", name,
               100.0 * said.Rms(), 100.0 * is.Rms(), 100.0 * said.Quantile(0.99),
               100.0 * is.Quantile(0.99), saves_s, all.seconds - without.seconds);
  };
  for (const double budget : {0.01, 0.002}) {
    const EffectChoice choice =
        renderer.RenderWithin(scene.instant, everything, {.max_error = budget, .explain = true})
            .choice;
    for (const EffectEstimate& estimate : choice.estimates) {
      if (budget < 0.01 || !estimate.present) continue;
      hold(TextOf(estimate.effect).name, EffectSet::All().Without(estimate.effect), estimate.change,
           estimate.cost_s);
    }
    hold(fmt::format("within {} %", 100.0 * budget), choice.effects, choice.together,
         choice.all_s - choice.chosen_s);
    const EffectChoice plain = renderer.RenderWithin(scene.instant, everything, {budget}).choice;
    fmt::print("  left out: {}; the preview takes {:.3f} s, {:.1f} % of the picture\n",
               NotesOn(choice).at("alpenglow.note.effects_left_out"), plain.preview_s,
               100.0 * plain.preview_s / all.seconds);
  }
}

}  // namespace
}  // namespace alpenglow::renderer

void alpenglow::tests::EffectsError(int argc, char** argv) {
  using namespace alpenglow::renderer;
  RenderSettings settings;
  settings.width = argc > 2 ? std::atoi(argv[1]) : 320;
  settings.height = argc > 2 ? std::atoi(argv[2]) : 180;
  for (const EffectScene& scene : EffectScenes(std::filesystem::temp_directory_path().string())) {
    if (argc > 3 && scene.name != argv[3]) continue;
    if (argc > 4) {
      MeasurePreview(scene, settings);
    } else {
      Measure(scene, settings);
    }
  }
}
