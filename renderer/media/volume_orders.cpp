// SPDX-License-Identifier: MIT
#include "renderer/media/volume_orders.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <set>
#include <utility>

#include "atmosphere/base/error.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

// Below this mean cosine the medium without the forward peak has moments that no phase function has.
constexpr double kLeastMeanCosine = -0.3;
// Below this fraction of the forward peak the tables of ForwardPeak lose their digits.
constexpr double kLeastPeak = 1e-6;
// The mean cosine of a phase function of Henyey and Greenstein with a peak of 10^-6 (g^4), which
// stands for the peak of those without one.
constexpr double kNearlyIsotropic = 0.032;
// Deep bodies have light whose changes are much smaller than its error.
constexpr double kVolumeTolerance = 1e-3;
// Light from larger optical depths is not seen.
constexpr double kDeepestSeen = 16.0;
constexpr double kY00 = 0.28209479177387814;  // 1 / sqrt(4 pi)

double PeakFractionOf(const PhaseFunction& phase) {
  return LegendreCoefficients(phase, kCloudDegree + 1).back();
}

/// Returns whether the moments are those of the medium without the forward peak.
bool HasForwardPeak(const PhaseFunction& phase) {
  return MeanCosine(phase) >= kLeastMeanCosine && PeakFractionOf(phase) >= kLeastPeak;
}

CloudOptics WhiteOpticsOf(const PhaseFunction& phase) {
  if (HasForwardPeak(phase)) return {phase, 1.0};
  return {phase, {.kind = PhaseKind::kHenyeyGreenstein, .g = kNearlyIsotropic}, 1.0};
}

}  // namespace

VolumeOrders::VolumeOrders(const LocalBody& volume, const VolumeIllumination& light,
                           double most_cells)
    : volume_(volume), to_sun_(light.to_sun), has_peak_(HasForwardPeak(volume.optics().phase)) {
  const MediumOptics& optics = volume.optics();
  const std::size_t bands = optics.extinction_per_m.size();
  const CloudOptics white = WhiteOpticsOf(optics.phase);
  extinction_per_m_ = SpectrumOf<double>(bands);
  for (std::size_t band = 0; band < bands; ++band) {
    const double extinction_per_m = optics.extinction_per_m[band];
    const double albedo = extinction_per_m > 0.0
                              ? std::min(optics.scattering_per_m[band] / extinction_per_m, 1.0)
                              : 0.0;
    optics_.push_back(std::make_shared<const CloudOptics>(white.WithAlbedo(albedo)));
    extinction_per_m_[band] = optics_.back()->extinction_scale() * extinction_per_m;
  }
  MakeCells(most_cells);
  SolveAll(light);
}

std::size_t VolumeOrders::bytes() const {
  std::size_t sum = 0;
  for (const auto& cells : cells_)
    for (const std::shared_ptr<const CloudCells>& grid : cells->grids()) sum += grid->bytes();
  std::set<const CloudMoments*> counted{nullptr};  // bands of the same optics share their moments
  for (const auto* parts : {&sun_, &sky_, &own_}) {
    for (const std::shared_ptr<const CloudMoments>& moments : *parts) {
      if (counted.insert(moments.get()).second) sum += moments->bytes();
    }
  }
  return sum;
}

void VolumeOrders::MakeCells(double most_cells) {
  const std::size_t bands = extinction_per_m_.size();
  std::size_t thickest = 0;
  for (std::size_t band = 1; band < bands; ++band)
    if (extinction_per_m_[band] > extinction_per_m_[thickest]) thickest = band;
  const double thickest_per_m = extinction_per_m_[thickest];
  cells_.push_back(std::make_unique<const VolumeCells>(
      volume_, VolumeCells::Options{thickest_per_m, thickest_per_m, most_cells}));
  cells_of_band_.assign(bands, 0);
  if (!cells_.front()->is_limited()) return;
  std::vector<double> scaled_per_m{thickest_per_m};
  for (std::size_t band = 0; band < bands; ++band) {
    const auto same = std::ranges::find(scaled_per_m, extinction_per_m_[band]);
    cells_of_band_[band] = static_cast<std::size_t>(same - scaled_per_m.begin());
    if (same != scaled_per_m.end()) continue;
    scaled_per_m.push_back(extinction_per_m_[band]);
    cells_.push_back(std::make_unique<const VolumeCells>(
        volume_, VolumeCells::Options{thickest_per_m, scaled_per_m.back(), most_cells}));
  }
}

std::vector<CloudHarmonics> VolumeOrders::SunIn(const CloudCells& cells, std::size_t band) const {
  const glm::dvec3 travel = CellsOf(band).DirectionInCells(-to_sun_);
  std::vector<CloudHarmonics> moments(cells.full(), CloudHarmonicsOf(travel));
  const std::vector<float> beam = CellsOf(band).BeamIn(cells, travel, extinction_per_m_[band]);
  for (std::size_t cell = 0; cell < moments.size(); ++cell)
    for (float& moment : moments[cell]) moment *= beam[cell];
  return moments;
}

CloudHarmonics VolumeOrders::LampsIn(const CloudBox& cell, std::size_t band,
                                     const VolumeIllumination& light) const {
  // The mean of 1 / r^2 over a ball is that at its radius times 0.58; the ball has the volume of the
  // part of a cell that a sample stands for.
  constexpr double kLeastDistance = 0.36;
  const VolumeCells& cells = CellsOf(band);
  const glm::dvec3 step = (cell.high - cell.low) / static_cast<double>(cells.samples_per_side());
  const double least_m = kLeastDistance * std::cbrt(step.x * step.y * step.z);
  CloudHarmonics sum{};
  double densities = 0.0;
  cells.EachSample(cell, [&](const glm::dvec3& point, double density) {
    densities += density;
    for (const LampBeam& beam : light.lamps(point, band, least_m)) {
      const double column_m =
          cells.is_limited() ? cells.Column(point, -beam.travel, beam.away_m) : beam.column_m;
      const CloudHarmonics of = CloudHarmonicsOf(cells.DirectionInCells(beam.travel));
      const auto weight = static_cast<float>(density * beam.irradiance *
                                             std::exp(-extinction_per_m_[band] * column_m));
      for (std::size_t k = 0; k < kCloudMoments; ++k) sum[k] += weight * of[k];
    }
  });
  for (float& moment : sum) moment /= static_cast<float>(std::max(densities, 1e-30));
  return sum;
}

double VolumeOrders::EmissionIn(const CloudBox& cell, std::size_t band) const {
  double sum = 0.0, densities = 0.0;
  CellsOf(band).EachSample(cell, [&](const glm::dvec3& point, double density) {
    const std::optional<BodyColour> colour = volume_.ColourAt(point);
    densities += density;
    sum += density * (colour ? colour->emission_per_m : volume_.optics().emission_per_m)[band];
  });
  return sum / std::max(densities, 1e-30);
}

std::vector<CloudHarmonics> VolumeOrders::OwnIn(const CloudCells& cells, std::size_t band,
                                                const VolumeIllumination& light) const {
  std::vector<CloudHarmonics> own(cells.full());
  const double per_emission =
      1.0 / (extinction_per_m_[band] * optics_[band]->scaled_albedo() * kY00);
  tbb::parallel_for(std::size_t{0}, own.size(), [&](std::size_t number) {
    const glm::dvec3 middle = cells.Middle(number), half_m = 0.5 * cells.cell_m();
    const CloudBox cell{middle - half_m, middle + half_m};
    if (light.lamps) own[number] = LampsIn(cell, band, light);
    if (light.emits) own[number][0] += static_cast<float>(per_emission * EmissionIn(cell, band));
  });
  return own;
}

void VolumeOrders::SolveAll(const VolumeIllumination& light) {
  const std::size_t bands = optics_.size();
  sun_.resize(bands);
  sky_.resize(bands);
  own_.resize(bands);
  if (cells_.front()->grids().back()->full() == 0) return;
  const SpectrumOf<double>& extinction_per_m = volume_.optics().extinction_per_m;
  for (std::size_t band = 0; band < bands; ++band) {
    // Without scattering there is no light of higher orders.
    if (extinction_per_m[band] <= 0.0 || optics_[band]->albedo() <= 0.0) continue;
    for (std::size_t other = 0; other < band && !sun_[band]; ++other) {
      if (extinction_per_m[other] == extinction_per_m[band] &&
          optics_[other]->albedo() == optics_[band]->albedo())
        sun_[band] = sun_[other];
    }
    Solve(band, light);
  }
}

void VolumeOrders::Solve(std::size_t band, const VolumeIllumination& light) {
  const VolumeCells& cells = CellsOf(band);
  const CloudMomentSolver solver(cells.grids(), volume_.optics().extinction_per_m[band],
                                 optics_[band], {.tolerance = kVolumeTolerance});
  const auto moments = [&](const CloudIllumination& of) {
    return std::make_shared<const CloudMoments>(solver.Light(of).moments);
  };
  if (light.has_sun && !sun_[band]) {
    sun_[band] = moments(
        {.entering = nullptr, .incident = [&](const CloudCells& of) { return SunIn(of, band); }});
  }
  if (light.sky) {
    sky_[band] =
        moments({.entering =
                     [&](const glm::dvec3& travel) {
                       return static_cast<double>(light.sky(-cells.DirectionInFrame(travel))[band]);
                     },
                 .incident = nullptr});
  }
  const bool emits = light.emits && volume_.optics().emission_per_m[band] > 0.0;
  if (light.lamps || emits) {
    own_[band] = moments({.entering = nullptr, .incident = [&](const CloudCells& of) {
                            return OwnIn(of, band, light);
                          }});
  }
}

VolumeOrders::Look VolumeOrders::LookTowards(const glm::dvec3& look) const {
  Look along{look, optics_.front()->peak().AtAngle(glm::dot(look, to_sun_)), {}, {}};
  for (std::size_t band = 0; band < optics_.size(); ++band)
    along.factors.push_back(optics_[band]->SourceFactors(-CellsOf(band).DirectionInCells(look)));
  return along;
}

VolumeOrders::Look VolumeOrders::LookAlong(const glm::dvec3& eye, const glm::dvec3& look) const {
  Look along = LookTowards(look);
  for (std::size_t i = 0; i < cells_.size() && cells_.front()->is_limited(); ++i) {
    const auto band =
        static_cast<std::size_t>(std::ranges::find(cells_of_band_, i) - cells_of_band_.begin());
    along.ways.push_back(cells_[i]->WayAlong(eye, look, kDeepestSeen / extinction_per_m_[band]));
  }
  return along;
}

VolumeOrders::Scattered VolumeOrders::At(const Place& place, const Look& look) const {
  const std::size_t bands = optics_.size();
  Scattered light{Spectrum(bands), Spectrum(bands), Spectrum(bands)};
  std::vector<CloudCells::Mixture> around;  // of each of cells_
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    around.push_back(cells_[i]->Around(look.ways.empty() ? place.point
                                                         : look.ways[i].At(place.column_to_eye_m)));
  }
  for (std::size_t band = 0; band < bands; ++band) {
    const auto source = [&](const std::shared_ptr<const CloudMoments>& moments) {
      return moments
                 ? std::max(moments->Source(around[cells_of_band_[band]], look.factors[band]), 0.0F)
                 : 0.0F;
    };
    const double first = FirstOfSun(look, band, place.column_to_sun_m + place.column_to_eye_m) *
                         std::exp(-extinction_per_m_[band] * place.column_to_sun_m);
    light.sun[band] = std::max(static_cast<float>(first) + source(sun_[band]), 0.0F);
    light.sky[band] = source(sky_[band]);
    light.own[band] = source(own_[band]);
  }
  return light;
}

Spectrum VolumeOrders::OwnAt(const glm::dvec3& point, const Look& look) const {
  Spectrum light(optics_.size());
  std::vector<CloudCells::Mixture> around;  // of each of cells_
  for (const auto& cells : cells_) around.push_back(cells->Around(point));
  for (std::size_t band = 0; band < light.size(); ++band) {
    if (!own_[band]) continue;
    light[band] =
        std::max(own_[band]->Source(around[cells_of_band_[band]], look.factors[band]), 0.0F);
  }
  return light;
}

double VolumeOrders::FirstOfSun(const Look& look, std::size_t band, double column_m) const {
  const double albedo = optics_[band]->scaled_albedo();
  if (!has_peak_) return albedo * Phase(volume_.optics().phase, glm::dot(look.direction, to_sun_));
  return albedo * look.peak.Effective(PeakDepth(band, column_m));
}

double VolumeOrders::FirstOfLamp(double cos_scattering, std::size_t band, double column_m) const {
  const double albedo = optics_[band]->scaled_albedo();
  if (!has_peak_) return albedo * Phase(volume_.optics().phase, cos_scattering);
  return albedo * optics_[band]->peak().Effective(cos_scattering, PeakDepth(band, column_m));
}

double VolumeOrders::PeakDepth(std::size_t band, double column_m) const {
  return optics_[band]->peak().fraction() * volume_.optics().scattering_per_m[band] * column_m;
}

}  // namespace alpenglow::renderer
