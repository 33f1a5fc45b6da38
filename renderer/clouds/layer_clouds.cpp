// SPDX-License-Identifier: MIT
#include "renderer/clouds/layer_clouds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "renderer/clouds/cloud_cover.h"
#include "renderer/clouds/periodic_map.h"
#include "renderer/clouds/portable_functions.h"
#include "renderer/clouds/shape_noise.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSteepness = 0.8;  // of F by z, because surfaces are not level
constexpr double kMapSpacing_m = 40.0;

/// Lengths of a layer.
struct DeckForm {
  double thickness_m;    // H
  double exponent;       // p
  double outer_slope_m;  // of h for u < 0
  double large_bumps_m;  // standard deviation of the noise with a period of kLargeTile_m
  double small_bumps_m;  // with a period of kSmallTile_m
  double base_waves_m;   // standard deviation of the altitude of the base
  double rim_rise_m;     // of the base where the layer ends
};

DeckForm DeckFormOf(const CloudOptions& options) {
  const double depth = options.depth_m;
  if (options.genus == CloudGenus::kStratocumulus) {
    return {0.9 * depth, 0.7, 0.9 * depth, 0.063 * depth, 0.05 * depth, 0.05 * depth, 0.14 * depth};
  }
  return {0.85 * depth, 0.5, 1.7 * depth, 0.0, 0.045 * depth, 0.0, 0.2 * depth};
}

/// h in units of H, as a function of u. A power of u is tabulated over its root, to 1e-4: the power
/// itself would take a third of the time of a field.
class RelativeThickness {
 public:
  explicit RelativeThickness(const DeckForm& form)
      : outer_slope_(form.outer_slope_m / form.thickness_m) {
    for (std::size_t i = 1; i < powers_.size(); ++i) {
      const double root = kMostRoot * static_cast<double>(i) / kSteps;
      powers_[i] = PortablePower(root * root, form.exponent);
    }
  }

  [[nodiscard]] double At(double u) const {
    if (u <= 0.0) return u * outer_slope_;
    const double at = std::min(std::sqrt(u) / kMostRoot, 1.0) * kSteps;
    const auto below = std::min(static_cast<std::size_t>(at), powers_.size() - 2);
    return powers_[below] +
           (at - static_cast<double>(below)) * (powers_[below + 1] - powers_[below]);
  }

 private:
  static constexpr double kMostRoot = 1.140175425099138;  // of 1.3
  static constexpr double kSteps = 512.0;

  double outer_slope_;
  std::array<double, 513> powers_{};
};

/// The map of a genus over the ground.
class ThicknessMap {
 public:
  ThicknessMap(const CloudOptions& options, double time_s) : options_(options), time_s_(time_s) {
    const glm::dvec2 along = WindDirection(options);
    // The rows repeat with the field if a whole number of waves fits along x and along y.
    waves_ = {std::round(along.x * options.period_m / kRow_m),
              std::round(along.y * options.period_m / kRow_m)};
  }

  [[nodiscard]] double At(const glm::dvec2& place) const {
    return options_.genus == CloudGenus::kStratocumulus ? Stratocumulus(place) : Altocumulus(place);
  }

 private:
  static constexpr double kRow_m = 1060.0;

  [[nodiscard]] double Noise(const GroundNoise& noise, const glm::dvec2& place) const {
    GroundNoise seeded = noise;
    seeded.seed += 1000U * options_.seed;
    return seeded.At(place, time_s_, options_.period_m);
  }
  [[nodiscard]] CellDistances Cells(double size_m, double change_s, std::uint32_t seed,
                                    const glm::dvec2& place) const {
    const int count = 2 * std::max(1, static_cast<int>(0.5 * options_.period_m / size_m + 0.5));
    return DistancesInCells(place * (count / options_.period_m), time_s_ / change_s, count,
                            seed + 1000U * options_.seed);
  }

  /// Returns noise as an offset on the ground; its two components are independent.
  [[nodiscard]] glm::dvec2 Offset(const GroundNoise& noise, const glm::dvec2& place) const {
    GroundNoise north = noise;
    north.seed += 100U;
    return {Noise(noise, place), Noise(north, place)};
  }

  [[nodiscard]] double Stratocumulus(const glm::dvec2& place) const {
    const glm::dvec2 bent = place + 600.0 * Offset({2560.0, 4, 0.55, 5000.0, 1}, place);
    const CellDistances large = Cells(2050.0, 7000.0, 3, bent);
    const CellDistances small = Cells(760.0, 2500.0, 4, bent);
    return 1.1 * SmoothRamp(0.0, 0.55, large.second - large.nearest) +
           0.5 * SmoothRamp(0.0, 0.5, small.second - small.nearest) +
           0.6 * Noise({2560.0, 6, 0.56, 6000.0, 5}, place);
  }

  [[nodiscard]] double Altocumulus(const glm::dvec2& place) const {
    const glm::dvec2 bent = place + 150.0 * Offset({1280.0, 3, 0.5, 2500.0, 1}, place) +
                            900.0 * Offset({5120.0, 1, 0.5, 9000.0, 6}, place);
    const CellDistances cells = Cells(400.0, 1800.0, 3, bent);
    const double rows = PortableCircle(glm::dot(waves_, bent) / options_.period_m).x;
    const double rows_here = SmoothRamp(-0.5, 0.4, Noise({3413.3, 2, 0.5, 9000.0, 9}, place));
    return 1.0 - 1.7 * cells.nearest * cells.nearest + 0.45 * rows_here * rows +
           1.1 * Noise({2560.0, 4, 0.55, 6000.0, 5}, place) +
           0.15 * Noise({320.0, 2, 0.5, 900.0, 8}, place);
  }

  const CloudOptions& options_;
  double time_s_;
  glm::dvec2 waves_;
};

class DeckShape final : public CloudShape {
 public:
  DeckShape(const CloudOptions& options, const CloudLattice& lattice, const CloudMatter& matter,
            double time_s)
      : form_(DeckFormOf(options)),
        relative_(form_),
        base_m_(options.base_altitude_m),
        rise_m_(time_s * 0.5),
        map_(static_cast<int>(options.period_m / kMapSpacing_m), options.period_m,
             [map = ThicknessMap(options, time_s)](const glm::dvec2& place) {
               return map.At(place);
             }),
        full_(map_.Quantile(0.97)) {
    const double least = map_.Quantile(0.0), most = map_.Quantile(1.0);
    const double margin = 0.5 * (most - least);
    threshold_ = -ParameterForCover(
        lattice, matter,
        [&](const glm::dvec3& point, double parameter) { return Depth(point, -parameter); },
        {options.cover, CoveredOpticalDepth(options.genus), -most - margin, -least + margin});
  }

  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const override {
    return Depth(point, threshold_);
  }

  [[nodiscard]] bool MayHoldCloud(const glm::dvec3& low, const glm::dvec3& high) const override {
    const double bumps = MostBumps();
    const double u = Share(map_.LargestIn(glm::dvec2(low), glm::dvec2(high)), threshold_);
    const double thickness = form_.thickness_m * relative_.At(u);
    return kSteepness * (base_m_ + thickness - low.z) + bumps > -kCloudMargin_m &&
           kSteepness * (high.z - base_m_ + kDeepestBase * form_.base_waves_m) + 0.5 * bumps >
               -kCloudMargin_m;
  }

 private:
  static constexpr double kDeepestBase = 6.0;  // standard deviations of the base's noise

  [[nodiscard]] double MostBumps() const {
    return ShapeNoise::Billow().Largest() * (form_.large_bumps_m + form_.small_bumps_m);
  }
  /// Returns u.
  [[nodiscard]] double Share(double value, double threshold) const {
    return (value - threshold) / std::max(full_ - threshold, 0.2);
  }

  [[nodiscard]] double Depth(const glm::dvec3& point, double threshold) const {
    const double u = Share(map_.At(glm::dvec2(point)), threshold);
    const double relative = relative_.At(u);
    const double top = base_m_ + form_.thickness_m * relative;
    if (kSteepness * (top - point.z) + MostBumps() <= -kCloudMargin_m) return kLeastCloudDepth_m;
    const glm::dvec3 risen = point - glm::dvec3(0.0, 0.0, rise_m_);
    const double bumps = form_.large_bumps_m * ShapeNoise::Billow().At(risen / kLargeTile_m) +
                         form_.small_bumps_m * ShapeNoise::Billow().At(risen / kSmallTile_m);
    const double waves =
        form_.base_waves_m *
        ShapeNoise::Billow().At(glm::dvec3(point.x, point.y, rise_m_) / kLargeTile_m + 0.375);
    const double base = base_m_ + waves + form_.rim_rise_m * std::max(0.0, 1.0 - 2.0 * relative);
    return std::min(kSteepness * (top - point.z) + bumps,
                    kSteepness * (point.z - base) + 0.5 * bumps);
  }

  DeckForm form_;
  RelativeThickness relative_;
  double base_m_, rise_m_;
  PeriodicMap map_;
  double full_;  // m_97
  double threshold_ = 0.0;
};

}  // namespace

std::unique_ptr<const CloudShape> LayerCloudShape(const CloudOptions& options,
                                                  const CloudLattice& lattice,
                                                  const CloudMatter& matter, double time_s) {
  return std::make_unique<DeckShape>(options, lattice, matter, time_s);
}

}  // namespace alpenglow::renderer
