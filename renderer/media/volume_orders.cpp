// SPDX-License-Identifier: MIT
#include "renderer/media/volume_orders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLeastMeanCosine = -0.3;
// Below this fraction of the forward peak the tables of ForwardPeak lose their digits.
constexpr double kLeastPeak = 1e-6;
// The mean cosine of a phase function of Henyey and Greenstein with a peak of 10^-6 (g^4), which
// stands for those without one in the moments.
constexpr double kNearlyIsotropic = 0.032;
// Optical depth of a cell, without the forward peak, below which smaller cells change nothing.
constexpr double kVolumeCellDepth = 0.3;
constexpr int kLeastCells = 6, kMostCellsAlong = 400;  // of the finest grid, along an axis
constexpr int kMostSamplesPerSide = 4;
constexpr double kY00 = 0.28209479177387814;  // 1 / sqrt(4 pi)

double PeakFractionOf(const PhaseFunction& phase) {
  return LegendreCoefficients(phase, kCloudDegree + 1).back();
}

/// Returns the phase function of the moments.
PhaseFunction WithPeak(const PhaseFunction& phase) {
  if (PeakFractionOf(phase) >= kLeastPeak) return phase;
  return {.kind = PhaseKind::kHenyeyGreenstein, .g = kNearlyIsotropic};
}

/// Returns the number of cells of a grid along each axis of a box.
std::array<int, 3> CellCountOf(const glm::dvec3& size_m, double side_m, int least) {
  std::array<int, 3> count{};
  for (int axis = 0; axis < 3; ++axis)
    count[static_cast<std::size_t>(axis)] =
        std::clamp(static_cast<int>(std::lround(size_m[axis] / side_m)), least, kMostCellsAlong);
  return count;
}

/// Returns the number of samples along each side of a cell that resolves a density.
int SamplesPerSide(const LocalBody& volume, double most_cells) {
  const auto samples = volume.Samples();
  if (!samples) return 2;
  const double all = 1.0 * (*samples)[0] * (*samples)[1] * (*samples)[2];
  return std::clamp(static_cast<int>(std::lround(std::cbrt(all / most_cells))), 2,
                    kMostSamplesPerSide);
}

}  // namespace

bool HasOrdersOf(const PhaseFunction& phase) {
  return MeanCosine(phase) >= kLeastMeanCosine && PeakFractionOf(phase) < 1.0;
}

VolumeOrders::VolumeOrders(const LocalBody& volume, const VolumeIllumination& light,
                           double most_cells)
    : volume_(volume),
      frame_from_body_(volume.placement().across, volume.placement().ahead, volume.placement().up),
      to_sun_(light.to_sun),
      has_peak_(PeakFractionOf(volume.optics().phase) >= kLeastPeak),
      samples_per_side_(SamplesPerSide(volume, most_cells)) {
  const MediumOptics& optics = volume.optics();
  const std::size_t bands = optics.extinction_per_m.size();
  const CloudOptics white(WithPeak(optics.phase), 1.0);
  extinction_per_m_ = SpectrumOf<double>(bands);
  for (std::size_t band = 0; band < bands; ++band) {
    const double extinction_per_m = optics.extinction_per_m[band];
    const double albedo = extinction_per_m > 0.0
                              ? std::min(optics.scattering_per_m[band] / extinction_per_m, 1.0)
                              : 0.0;
    optics_.push_back(std::make_shared<const CloudOptics>(white.WithAlbedo(albedo)));
    extinction_per_m_[band] = optics_.back()->extinction_scale() * extinction_per_m;
  }
  cells_ = Cells(most_cells);
  SolveAll(light);
}

glm::dvec3 VolumeOrders::InBody(const glm::dvec3& point) const {
  return (point - volume_.placement().bottom) * frame_from_body_;
}

glm::dvec3 VolumeOrders::InFrame(const glm::dvec3& in_body) const {
  return volume_.placement().bottom + frame_from_body_ * in_body;
}

template <typename Visit>
void VolumeOrders::EachSample(const CloudBox& cell, const Visit& visit) const {
  const glm::dvec3 step = (cell.high - cell.low) / static_cast<double>(samples_per_side_);
  for (int z = 0; z < samples_per_side_; ++z) {
    for (int y = 0; y < samples_per_side_; ++y) {
      for (int x = 0; x < samples_per_side_; ++x) {
        const glm::dvec3 point = InFrame(cell.low + (glm::dvec3(x, y, z) + 0.5) * step);
        const double density = volume_.DensityAt(point);
        if (density > 0.0) visit(point, density);
      }
    }
  }
}

CloudCellContent VolumeOrders::ContentOf(const CloudBox& cell) const {
  double sum = 0.0;
  int dense = 0;
  EachSample(cell, [&](const glm::dvec3&, double density) {
    sum += density;
    ++dense;
  });
  if (dense == 0) return {};
  return {sum / dense, dense / std::pow(samples_per_side_, 3)};
}

std::vector<std::shared_ptr<const CloudCells>> VolumeOrders::Cells(double most_cells) const {
  const glm::dvec3& size_m = volume_.placement().size_m;
  double thickest_per_m = 0.0;
  for (std::size_t band = 0; band < optics_.size(); ++band)
    thickest_per_m = std::max(thickest_per_m, extinction_per_m_[band]);
  const double least_side_m = std::cbrt(size_m.x * size_m.y * size_m.z / most_cells);
  const double side_m = std::max(least_side_m, kVolumeCellDepth / thickest_per_m);
  std::vector<std::shared_ptr<const CloudCells>> grids;
  for (const int times : {4, 2, 1}) {
    CloudCellLattice lattice{CellCountOf(size_m, times * side_m, std::max(kLeastCells / times, 1)),
                             glm::dvec3(-0.5 * size_m.x, -0.5 * size_m.y, 0.0), glm::dvec3(1.0)};
    for (int axis = 0; axis < 3; ++axis) {
      int& count = lattice.count[static_cast<std::size_t>(axis)];
      lattice.cell_m[axis] = size_m[axis] / count;
      // Light just outside of the body is that of the cells around it.
      lattice.origin_m[axis] -= lattice.cell_m[axis];
      count += 2;
    }
    grids.push_back(std::make_shared<const CloudCells>(
        lattice, [&](const CloudBox& cell) { return ContentOf(cell); }));
  }
  return grids;
}

CloudHarmonics VolumeOrders::SunIn(const CloudBox& cell, double scaled_per_m,
                                   const VolumeIllumination& light) const {
  const glm::dvec3 step = (cell.high - cell.low) / static_cast<double>(samples_per_side_);
  const glm::dvec3 to_sun = light.to_sun * frame_from_body_;
  // The mean length of a beam in the part of the cell that a sample stands for.
  const double chord_m = 1.0 / (std::abs(to_sun.x) / step.x + std::abs(to_sun.y) / step.y +
                                std::abs(to_sun.z) / step.z);
  double sum = 0.0, densities = 0.0;
  EachSample(cell, [&](const glm::dvec3& point, double density) {
    const double half = 0.5 * scaled_per_m * density * chord_m;
    // The mean of the beam over this length, relative to that in its middle.
    const double mean = half > 1e-3 ? std::sinh(std::min(half, 30.0)) / half : 1.0;
    sum += density * std::min(mean * std::exp(-scaled_per_m * light.sun_column_m(point)), 1.0);
    densities += density;
  });
  CloudHarmonics beam = CloudHarmonicsOf(-to_sun);
  const auto irradiance = static_cast<float>(densities > 0.0 ? sum / densities : 0.0);
  for (float& moment : beam) moment *= irradiance;
  return beam;
}

CloudHarmonics VolumeOrders::OwnIn(const CloudBox& cell, std::size_t band,
                                   const VolumeIllumination& light) const {
  // The mean of 1 / r^2 over a ball is that at its radius times 0.58; the ball has the volume of the
  // part of a cell that a sample stands for.
  constexpr double kLeastDistance = 0.36;
  const glm::dvec3 step = (cell.high - cell.low) / static_cast<double>(samples_per_side_);
  const double least_m = kLeastDistance * std::cbrt(step.x * step.y * step.z);
  CloudHarmonics own{};
  double densities = 0.0;
  EachSample(cell, [&](const glm::dvec3& point, double density) {
    densities += density;
    if (!light.lamps) return;
    for (const LampBeam& beam : light.lamps(point, band, least_m)) {
      const CloudHarmonics of = CloudHarmonicsOf(beam.travel * frame_from_body_);
      const auto weight = static_cast<float>(density * beam.irradiance *
                                             std::exp(-extinction_per_m_[band] * beam.column_m));
      for (std::size_t k = 0; k < own.size(); ++k) own[k] += weight * of[k];
    }
  });
  for (float& moment : own) moment /= static_cast<float>(std::max(densities, 1e-30));
  if (light.emits) {
    own[0] += static_cast<float>(volume_.optics().emission_per_m[band] /
                                 (extinction_per_m_[band] * optics_[band]->scaled_albedo() * kY00));
  }
  return own;
}

void VolumeOrders::SolveAll(const VolumeIllumination& light) {
  const std::size_t bands = optics_.size();
  sun_.resize(bands);
  sky_.resize(bands);
  own_.resize(bands);
  if (cells_.back()->full() == 0) return;
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
  const CloudMomentSolver solver(cells_, volume_.optics().extinction_per_m[band], optics_[band]);
  const auto moments = [&](const CloudIllumination& of) {
    return std::make_shared<const CloudMoments>(solver.Light(of).moments);
  };
  const double scaled_per_m = extinction_per_m_[band];
  if (light.sun_column_m && !sun_[band]) {
    sun_[band] = moments({.entering = nullptr, .incident = [&](const CloudBox& cell) {
                            return SunIn(cell, scaled_per_m, light);
                          }});
  }
  if (light.sky) {
    sky_[band] =
        moments({.entering =
                     [&](const glm::dvec3& travel) {
                       return static_cast<double>(light.sky(-(frame_from_body_ * travel))[band]);
                     },
                 .incident = nullptr});
  }
  const bool emits = light.emits && volume_.optics().emission_per_m[band] > 0.0;
  if (light.lamps || emits) {
    own_[band] = moments({.entering = nullptr, .incident = [&](const CloudBox& cell) {
                            return OwnIn(cell, band, light);
                          }});
  }
}

VolumeOrders::Look VolumeOrders::LookAlong(const glm::dvec3& look) const {
  Look along{look, optics_.front()->peak().AtAngle(glm::dot(look, to_sun_)), {}};
  for (const auto& optics : optics_)
    along.factors.push_back(optics->SourceFactors(-(look * frame_from_body_)));
  return along;
}

VolumeOrders::Scattered VolumeOrders::At(const Place& place, const Look& look) const {
  const std::size_t bands = optics_.size();
  Scattered light{Spectrum(bands), Spectrum(bands), Spectrum(bands)};
  const CloudCells::Mixture around = cells_.back()->Around(InBody(place.point));
  for (std::size_t band = 0; band < bands; ++band) {
    const auto source = [&](const std::shared_ptr<const CloudMoments>& moments) {
      return moments ? std::max(moments->Source(around, look.factors[band]), 0.0F) : 0.0F;
    };
    const double first = FirstOfSun(look, band, place.column_to_sun_m + place.column_to_eye_m) *
                         std::exp(-extinction_per_m_[band] * place.column_to_sun_m);
    light.sun[band] = std::max(static_cast<float>(first) + source(sun_[band]), 0.0F);
    light.sky[band] = source(sky_[band]);
    light.own[band] = source(own_[band]);
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
