// SPDX-License-Identifier: MIT
#include "renderer/effects/effect_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/cli/program.h"
#include "lut/image/metering.h"

namespace alpenglow::renderer {
namespace {

double Norm(const std::array<float, 3>& rgb) {
  double sum = 0.0;
  for (const float value : rgb) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum);
}

/// Returns the largest value of any group.
template <typename Value>
double LargestOf(const std::vector<ErrorStatistics>& groups, const Value& value) {
  double largest = 0.0;
  for (const ErrorStatistics& group : groups) largest = std::max(largest, value(group));
  return largest;
}

constexpr double kPercentileFactor = 4.0;  // 99th percentile allowed, in budgets

/// Returns the number of pixels of a picture's preview grid.
int PreviewSize(int width, int height) {
  constexpr double kLeast = 400.0, kMost = 2000.0, kShare = 1.0 / 512.0;
  const double pixels = static_cast<double>(width) * height;
  return static_cast<int>(std::min(std::clamp(kShare * pixels, kLeast, kMost), pixels));
}

bool IsWithin(const PreviewChange& change, double max_error) {
  return change.RmsAtMost() <= max_error &&
         change.QuantileAtMost(0.99) <= kPercentileFactor * max_error;
}

/// Returns the first pixels of a preview's picture.
HdrImage FirstPixels(const HdrImage& image, std::size_t count) {
  HdrImage first(static_cast<int>(count), 1);
  std::copy_n(image.rgb.begin(), count, first.rgb.begin());
  return first;
}

/// Compares preview pictures with the reference, the preview picture with all wanted effects.
class EffectComparison {
 public:
  EffectComparison(const EffectPreview& preview, EffectSet wanted, int repeats)
      : preview_(preview),
        repeats_(repeats),
        everything_(Render(wanted)),
        floor_(ChangeFloor(FirstPixels(everything_.image, preview.groups.front().size()))) {}

  struct Verdict {
    PreviewChange change;
    double picture_s;
  };

  [[nodiscard]] Verdict On(EffectSet effects) const { return On(Render(effects)); }
  [[nodiscard]] Verdict On(const PreviewPicture& picture) const {
    Verdict verdict{{}, PictureSeconds(picture)};
    std::size_t at = 0;
    for (const auto& group : preview_.groups) {
      std::vector<double> changes;
      for (std::size_t i = 0; i < group.size(); ++i, ++at) {
        changes.push_back(PixelChange(everything_.image.rgb[at], picture.image.rgb[at], floor_));
      }
      verdict.change.groups.emplace_back(std::move(changes));
    }
    return verdict;
  }

  [[nodiscard]] double everything_s() const { return PictureSeconds(everything_); }

 private:
  [[nodiscard]] PreviewPicture Render(EffectSet effects) const {
    PreviewPicture picture = preview_.render(effects);
    for (int i = 1; i < repeats_; ++i) {
      picture.seconds = std::min(picture.seconds, preview_.render(effects).seconds);
    }
    return picture;
  }

  [[nodiscard]] double PictureSeconds(const PreviewPicture& picture) const {
    return picture.seconds * preview_.pixels_of_picture /
           static_cast<double>(picture.image.rgb.size());
  }

  const EffectPreview& preview_;
  int repeats_;
  PreviewPicture everything_;
  double floor_;
};

/// Leaves out effects within the budget, smallest change first.
class Chooser {
 public:
  Chooser(const EffectComparison& comparison, EffectSet wanted, double max_error)
      : comparison_(comparison),
        max_error_(max_error),
        effects_(wanted),
        verdict_{{}, comparison.everything_s()} {}

  /// @param candidates  sorted by change, smallest first.
  void LeaveOut(const std::vector<EffectEstimate>& candidates) {
    std::size_t tried = 0;
    EffectSet fewer = effects_;
    double sum = 0.0;
    for (; tried < candidates.size(); ++tried) {  // while the sum stays within the budget
      sum += candidates[tried].change.RmsAtMost();
      if (sum > max_error_) break;
      fewer = fewer.Without(candidates[tried].effect);
    }
    if (!Try(fewer)) tried = 0;
    for (; tried < candidates.size(); ++tried) Try(effects_.Without(candidates[tried].effect));
  }

  [[nodiscard]] EffectSet effects() const { return effects_; }
  [[nodiscard]] const EffectComparison::Verdict& verdict() const { return verdict_; }

 private:
  bool Try(EffectSet fewer) {
    if (fewer == effects_) return true;
    const EffectComparison::Verdict verdict = comparison_.On(fewer);
    if (!IsWithin(verdict.change, max_error_)) return false;
    effects_ = fewer;
    verdict_ = verdict;
    return true;
  }

  const EffectComparison& comparison_;
  double max_error_;
  EffectSet effects_;
  EffectComparison::Verdict verdict_;
};

std::vector<RefinementEstimate> Refine(const EffectPreview& preview,
                                       const EffectComparison& comparison) {
  std::vector<RefinementEstimate> estimates;
  for (const Refinement& refinement : preview.refinements) {
    const EffectComparison::Verdict with = comparison.On(refinement.render());
    estimates.push_back({refinement.name, with.change, with.picture_s - comparison.everything_s()});
  }
  return estimates;
}

std::string Percent(double value) {
  const double percent = 100.0 * value;
  return percent == 0.0    ? "0 %"
         : percent < 0.001 ? "< 0.001 %"
         : percent < 1.0   ? fmt::format("{:.3f} %", percent)
                           : fmt::format("{:.1f} %", percent);
}

std::string Line(const std::string& name, const PreviewChange& change, double cost_s, double all_s,
                 const std::string& fate) {
  return fmt::format("{:<20}{:>11}{:>11}{:>11}{:>10.3f} s{:>8.1f} %  {}\n", name,
                     Percent(change.Rms()), Percent(change.RmsAtMost()),
                     Percent(change.Quantile(0.99)), cost_s, 100.0 * cost_s / all_s, fate);
}

}  // namespace

double PixelChange(const std::array<float, 3>& a, const std::array<float, 3>& b,
                   double floor_cd_per_m2) {
  const std::array<float, 3> difference{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  return Norm(difference) / std::max(0.5 * (Norm(a) + Norm(b)), floor_cd_per_m2);
}

double ChangeFloor(const HdrImage& reference) {
  constexpr double kStepsBelowMiddleGrey = 4.0;
  const double ev100 = MeterEv100(reference, kSunDiskLuminance_cd_per_m2);
  return kMeterConstant / 100.0 * std::exp2(ev100 - kStepsBelowMiddleGrey);
}

ErrorStatistics ChangeOf(const HdrImage& reference, const HdrImage& other) {
  ALPENGLOW_ENSURE(reference.rgb.size(), ==, other.rgb.size());
  const double floor = ChangeFloor(reference);
  std::vector<double> changes;
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    changes.push_back(PixelChange(reference.rgb[i], other.rgb[i], floor));
  }
  return ErrorStatistics(std::move(changes));
}

double PreviewChange::Rms() const {
  return LargestOf(groups, [](const ErrorStatistics& group) { return group.Rms(); });
}

double PreviewChange::RmsAtMost() const {
  return LargestOf(groups, [](const ErrorStatistics& group) { return group.RmsAtMost(); });
}

double PreviewChange::Quantile(double share) const {
  return LargestOf(groups, [&](const ErrorStatistics& group) { return group.Quantile(share); });
}

double PreviewChange::QuantileAtMost(double share) const {
  return LargestOf(groups,
                   [&](const ErrorStatistics& group) { return group.QuantileAtMost(share); });
}

std::vector<PixelPlace> PreviewGrid(int width, int height, int count) {
  const double side = std::sqrt(static_cast<double>(width) * height / count);
  const int columns = std::clamp(static_cast<int>(std::lround(width / side)), 1, width);
  const int rows = std::clamp(static_cast<int>(std::lround(height / side)), 1, height);
  std::vector<PixelPlace> places;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const int number = 1 + row * columns + column;
      const double x = (column + Halton(number, 2)) * width / columns;
      const double y = (row + Halton(number, 3)) * height / rows;
      places.push_back(
          {std::min(static_cast<int>(x), width - 1), std::min(static_cast<int>(y), height - 1)});
    }
  }
  return places;
}

std::vector<PixelPlace> PilotSpiral(int width, int height, const std::array<double, 2>& centre,
                                    double radius, int count) {
  std::vector<PixelPlace> places;
  for (int i = 0; i < count; ++i) {
    const double r = radius * std::sqrt((i + 0.5) / count);
    const double x = std::floor(centre[0] + r * std::cos(i * kGoldenAngle));
    const double y = std::floor(centre[1] + r * std::sin(i * kGoldenAngle));
    if (x >= 0.0 && x < width && y >= 0.0 && y < height)
      places.push_back({static_cast<int>(x), static_cast<int>(y)});
  }
  return places;
}

PreviewGroups PreviewPixels(const CameraRays& camera, int width, int height,
                            const glm::dvec3& to_sun, const std::vector<glm::dvec3>& lamps) {
  constexpr double kAroundSun_rad = 3.0 * kRadiansPerDegree;
  constexpr int kPixelsAroundSun = 48, kPixelsOfLamp = 3;
  constexpr std::size_t kMostLamps = 64;
  PreviewGroups groups{PreviewGrid(width, height, PreviewSize(width, height))};
  if (const auto sun = camera.PlaceOf(to_sun)) {
    groups.push_back(
        PilotSpiral(width, height, *sun, kAroundSun_rad / camera.PixelAngle(), kPixelsAroundSun));
  }
  std::vector<PixelPlace> near_lamps;
  for (std::size_t i = 0; i < lamps.size(); i += lamps.size() / kMostLamps + 1) {
    const auto lamp = camera.PlaceOf(lamps[i]);
    if (!lamp) continue;
    for (const PixelPlace& pixel : PilotSpiral(width, height, *lamp, 2.0, kPixelsOfLamp))
      near_lamps.push_back(pixel);
  }
  groups.push_back(near_lamps);
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

EffectSet EffectChoice::LeftOut() const {
  EffectSet left_out;
  for (const EffectEstimate& estimate : estimates) {
    if (!estimate.kept) left_out = left_out.With(estimate.effect);
  }
  return left_out;
}

EffectChoice ChooseEffects(const EffectPreview& preview, EffectSet wanted,
                           const EffectBudget& budget) {
  const Stopwatch watch;
  const EffectComparison comparison(preview, wanted, budget.explain ? 3 : 1);
  EffectChoice choice;
  choice.max_error = budget.max_error;
  choice.all_s = comparison.everything_s();
  std::vector<EffectEstimate> candidates;
  for (const Effect effect : wanted.List()) {
    EffectEstimate estimate{effect, {}};
    estimate.present = preview.present.Has(effect);
    if (TextOf(effect).is_free && !budget.explain) continue;
    if (estimate.present) {
      const EffectComparison::Verdict without = comparison.On(wanted.Without(effect));
      const double preparation_s = preview.preparation_s(effect);
      choice.all_s += preparation_s;
      estimate.change = without.change;
      estimate.cost_s = comparison.everything_s() - without.picture_s + preparation_s;
      if (!TextOf(effect).is_free && IsWithin(estimate.change, budget.max_error))
        candidates.push_back(estimate);
    }
    choice.estimates.push_back(estimate);
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.change.RmsAtMost() < b.change.RmsAtMost();
  });
  Chooser chooser(comparison, wanted, budget.max_error);
  if (budget.leave_out) chooser.LeaveOut(candidates);
  if (budget.explain) choice.refinements = Refine(preview, comparison);
  choice.effects = chooser.effects();
  choice.together = chooser.verdict().change;
  choice.chosen_s = chooser.verdict().picture_s;
  for (EffectEstimate& estimate : choice.estimates) {
    estimate.kept = choice.effects.Has(estimate.effect);
    if (estimate.kept) choice.chosen_s += preview.preparation_s(estimate.effect);
  }
  for (const auto& group : preview.groups) choice.preview_pixels += group.size();
  choice.preview_s = watch.seconds();
  return choice;
}

Metadata NotesOn(const EffectChoice& choice) {
  std::vector<std::string> names;
  for (const Effect effect : choice.LeftOut().List()) names.emplace_back(TextOf(effect).name);
  const auto change = [](double rms, double percentile_99) {
    return fmt::format("rms {}, 99th percentile {}", Percent(rms), Percent(percentile_99));
  };
  const PreviewChange& together = choice.together;
  return {{"alpenglow.note.effects_left_out",
           names.empty() ? "none" : fmt::format("{}", fmt::join(names, ","))},
          {"alpenglow.note.effects_change",
           fmt::format("{} (at most {})", change(together.Rms(), together.Quantile(0.99)),
                       change(together.RmsAtMost(), together.QuantileAtMost(0.99)))}};
}

std::string ExplainText(const EffectChoice& choice) {
  std::string text = fmt::format("{:<20}{:>11}{:>11}{:>11}{:>12}{:>10}\n", "without", "change rms",
                                 "at most", "99 %", "saves", "of frame");
  for (const EffectEstimate& estimate : choice.estimates) {
    const EffectText& effect = TextOf(estimate.effect);
    const std::string fate = !estimate.present ? "not in this scene"
                             : !estimate.kept  ? fmt::format("left out: {}", effect.left_out)
                             : effect.is_free  ? "kept, free"
                                               : "kept";
    text += Line(effect.name, estimate.change, estimate.cost_s, choice.all_s, fate);
  }
  text += Line("all left out", choice.together, choice.all_s - choice.chosen_s, choice.all_s,
               fmt::format("budget {} rms, {} at 99 %", Percent(choice.max_error),
                           Percent(kPercentileFactor * choice.max_error)));
  if (!choice.refinements.empty()) {
    text += fmt::format("{:<20}{:>11}{:>11}{:>11}{:>12}\n", "with", "", "", "", "costs");
  }
  for (const RefinementEstimate& more : choice.refinements)
    text += Line(more.name, more.change, more.cost_s, choice.all_s, "not asked for");
  text += fmt::format(
      "preview: {} pixels, {:.3f} s; the frame: {:.3f} s with everything, {:.3f} s as "
      "chosen\n",
      choice.preview_pixels, choice.preview_s, choice.all_s, choice.chosen_s);
  return text;
}

}  // namespace alpenglow::renderer
