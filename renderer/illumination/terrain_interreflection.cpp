// SPDX-License-Identifier: MIT
#include "renderer/illumination/terrain_interreflection.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSector = 2.0 * kPi / static_cast<double>(kHorizonAzimuths);
// Steps of the air's optical depth: from 1e-4 upwards, 16 per doubling.
constexpr double kThinnest = 1e-4;
constexpr double kStepsPerDoubling = 16.0;

std::uint8_t AirStep(double depth) {
  const double step = kStepsPerDoubling * std::log2(std::max(depth / kThinnest, 1.0));
  return static_cast<std::uint8_t>(std::lround(std::min(step, 255.0)));
}

/// Returns the extinction [1/m] in the band in which the optical depth of air between slopes is
/// stored: the first band that the air dims at all. It is 0 in air without extinction.
double ReferenceExtinction(const Medium& medium, double altitude_m) {
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    const double rayleigh = medium.rayleigh_scattering_per_m[band];
    const double mie = medium.mie_extinction_per_m[band];
    if (rayleigh + mie == 0.0) continue;
    return rayleigh * std::exp(-altitude_m / medium.rayleigh_scale_height_m) +
           mie * std::exp(-altitude_m / medium.mie_scale_height_m);
  }
  return 0.0;
}

glm::dvec3 NormalAt(const HeightRaster& heights, int column, int row) {
  const auto height = [&](int c, int r) -> std::optional<double> {
    if (c < 0 || c >= heights.columns || r < 0 || r >= heights.rows) return std::nullopt;
    const float z = heights.at(c, r);
    if (z <= HeightRaster::kNothing) return std::nullopt;
    return static_cast<double>(z);
  };
  const auto here = static_cast<double>(heights.at(column, row));
  // At the rim and beside a void, the slope is that to the only neighbour.
  const auto fall = [&](const std::optional<double>& before, const std::optional<double>& after) {
    const int cells = (before ? 1 : 0) + (after ? 1 : 0);
    return cells == 0 ? 0.0
                      : (before.value_or(here) - after.value_or(here)) / (cells * heights.cell_m);
  };
  return glm::normalize(glm::dvec3(fall(height(column - 1, row), height(column + 1, row)),
                                   fall(height(column, row - 1), height(column, row + 1)), 1.0));
}

/// Ground between two elevations.
struct Strip {
  float weight;
  std::uint32_t node;
  double distance_m;
};

}  // namespace

double SlopeViews::AirDepth(std::uint8_t step) {
  return step == 0 ? 0.0 : kThinnest * std::exp2(static_cast<double>(step) / kStepsPerDoubling);
}

SlopeViews::SlopeViews(HeightRaster heights, const Medium& medium)
    : heights_(std::move(heights)),
      places_(heights_.z_m.size()),
      weight_(places_.size() * kHorizonAzimuths, 0.0F),
      seen_(weight_.size() * kStrips, 0),
      summit_m_(*std::max_element(heights_.z_m.begin(), heights_.z_m.end())) {
  ALPENGLOW_ENSURE(places_.size(), <, std::size_t{1} << 24);
  const auto for_all = [&](const auto& visit) {
    tbb::parallel_for(0, heights_.rows, [&](int row) {
      for (int column = 0; column < heights_.columns; ++column)
        if (heights_.at(column, row) > HeightRaster::kNothing) visit(column, row);
    });
  };
  for_all([&](int column, int row) {
    const auto [x, y] = heights_.Place(column, row);
    places_[heights_.index(column, row)] = {{x, y, static_cast<double>(heights_.at(column, row))},
                                            NormalAt(heights_, column, row)};
  });
  for_all([&](int column, int row) {
    for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth)
      Walk(heights_.index(column, row), azimuth, medium);
  });
}

void SlopeViews::Walk(std::size_t node, std::size_t azimuth, const Medium& medium) {
  constexpr double kGrowth = 1.2;
  constexpr std::size_t kMostStrips = 64;
  const SlopePlace& from = places_[node];
  const double x = std::cos(HorizonAzimuth(azimuth)), y = std::sin(HorizonAzimuth(azimuth));
  const auto up = static_cast<float>(from.normal.z);
  const auto along = static_cast<float>(from.normal.x * x + from.normal.y * y);
  const double plane = -static_cast<double>(along) / static_cast<double>(up);
  double highest = plane;  // tangent of the node's own plane, then of the highest ground so far
  const auto sine_of = [](double tangent) {
    return static_cast<float>(tangent / std::sqrt(1.0 + tangent * tangent));
  };
  const double c0 = (from.point.x - heights_.first_x_m) / heights_.cell_m;
  const double r0 = (from.point.y - heights_.first_y_m) / heights_.cell_m;
  const double summit_m = static_cast<double>(summit_m_) - from.point.z;
  std::array<Strip, kMostStrips> strips;
  std::size_t count = 0;
  float total = 0.0F;
  for (double distance = 1.0; count < kMostStrips;
       distance = std::max(distance + 1.0, distance * kGrowth)) {
    const int column = static_cast<int>(c0 + distance * x + 0.5);
    const int row = static_cast<int>(r0 + distance * y + 0.5);
    if (column < 0 || row < 0 || column >= heights_.columns || row >= heights_.rows) break;
    const double across = column - c0, along_rows = row - r0;
    const double flat_m = heights_.cell_m * std::sqrt(across * across + along_rows * along_rows);
    if (highest > 0.0 && summit_m < highest * flat_m) break;
    const std::size_t there = heights_.index(column, row);
    const double rise_m = static_cast<double>(heights_.z_m[there]) - from.point.z;
    if (!(rise_m > highest * flat_m) || there == node) continue;
    const double tangent = rise_m / flat_m;
    const float weight = SectorIntegral(up, along, sine_of(highest), sine_of(tangent));
    highest = tangent;
    if (weight <= 0.0F) continue;
    strips[count++] = {weight, static_cast<std::uint32_t>(there),
                       std::sqrt(flat_m * flat_m + rise_m * rise_m)};
    total += weight;
  }
  weight_[node * kHorizonAzimuths + azimuth] = total;
  std::size_t strip = 0;
  float passed = 0.0F;
  for (std::size_t k = 0; k < kStrips && count > 0; ++k) {
    const float wanted = total * (static_cast<float>(k) + 0.5F) / static_cast<float>(kStrips);
    while (strip + 1 < count && passed + strips[strip].weight < wanted)
      passed += strips[strip++].weight;
    const Strip& kept = strips[strip];
    const double middle_m = std::max(0.5 * (from.point.z + places_[kept.node].point.z), 0.0);
    const std::uint8_t air = AirStep(kept.distance_m * ReferenceExtinction(medium, middle_m));
    seen_[(node * kHorizonAzimuths + azimuth) * kStrips + k] =
        kept.node | (static_cast<std::uint32_t>(air) << 24);
  }
}

/// The four nodes around a point.
struct TerrainInterreflection::Neighbours {
  std::array<const float*, 4> light;
  std::array<std::size_t, 4> node;
  std::array<float, 4> share;

  Neighbours(const TerrainInterreflection& of, const glm::dvec3& point) {
    const HeightRaster& heights = of.views_.heights();
    const GridCell cell = CellAt(heights, point.x, point.y);
    const std::size_t first = heights.index(cell.column, cell.row);
    const auto columns = static_cast<std::size_t>(heights.columns);
    node = {first, first + 1, first + columns, first + columns + 1};
    share = {(1.0F - cell.x) * (1.0F - cell.y), cell.x * (1.0F - cell.y), (1.0F - cell.x) * cell.y,
             cell.x * cell.y};
    for (std::size_t k = 0; k < 4; ++k)
      light[k] = &of.light_[node[k] * kHorizonAzimuths * of.stride_];
  }
};

TerrainInterreflection::TerrainInterreflection(const SlopeViews& views, const Medium& medium,
                                               const Outgoing& outgoing,
                                               const OccludedSkyIrradiance& sky, double mu_s)
    : views_(views),
      bands_(medium.wavelengths_nm.size()),
      stride_((bands_ + 3) / 4 * 4),
      light_(views.places().size() * kHorizonAzimuths * stride_, 0.0F) {
  std::vector<float> through(256 * stride_, 0.0F);
  const double reference = ReferenceExtinction(medium, 0.0);
  for (std::size_t step = 0; step < 256; ++step) {
    const double depth = SlopeViews::AirDepth(static_cast<std::uint8_t>(step));
    const double length_m = reference > 0.0 ? depth / reference : 0.0;
    for (std::size_t band = 0; band < bands_; ++band) {
      const double extinction =
          medium.rayleigh_scattering_per_m[band] + medium.mie_extinction_per_m[band];
      through[step * stride_ + band] = static_cast<float>(std::exp(-length_m * extinction));
    }
  }
  std::vector<float> air(kHorizonAzimuths * stride_, 0.0F);
  for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth) {
    constexpr double kOverHorizon = 0.02;
    const double angle = HorizonAzimuth(azimuth);
    const Spectrum radiance =
        sky.Radiance(0.0, mu_s, {std::cos(angle), std::sin(angle), kOverHorizon});
    std::copy_n(radiance.values().begin(), bands_, &air[azimuth * stride_]);
  }
  std::vector<float> sent(views.places().size() * stride_, 0.0F);
  tbb::parallel_for(0, views.heights().rows, [&](int row) {
    for (int column = 0; column < views.heights().columns; ++column) {
      if (views.heights().at(column, row) <= HeightRaster::kNothing) continue;
      const std::size_t node = views.heights().index(column, row);
      const Spectrum radiance = outgoing(views.places()[node]);
      std::copy_n(radiance.values().begin(), bands_, &sent[node * stride_]);
    }
  });
  Gather(sent, through, air);
}

void TerrainInterreflection::Gather(const std::vector<float>& sent,
                                    const std::vector<float>& through,
                                    const std::vector<float>& air) {
  tbb::parallel_for(0, views_.heights().rows, [&](int row) {
    for (int column = 0; column < views_.heights().columns; ++column) {
      const std::size_t node = views_.heights().index(column, row);
      for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth) {
        float* into = &light_[(node * kHorizonAzimuths + azimuth) * stride_];
        std::fill_n(into, stride_, 0.0F);
        const float weight = views_.Weight(node, azimuth) / static_cast<float>(SlopeViews::kStrips);
        if (weight <= 0.0F) continue;
        const float* over_horizon = &air[azimuth * stride_];
        for (std::size_t k = 0; k < SlopeViews::kStrips; ++k) {
          const SlopeViews::Seen seen = views_.At(node, azimuth, k);
          const float* radiance = &sent[seen.node * stride_];
          const float* kept = &through[seen.air * stride_];
          for (std::size_t band = 0; band < stride_; ++band) {
            into[band] +=
                weight * (over_horizon[band] + kept[band] * (radiance[band] - over_horizon[band]));
          }
        }
      }
    }
  });
}

Spectrum TerrainInterreflection::Irradiance(const glm::dvec3& point, const SurfaceSectors& surface,
                                            const Horizons& horizons) const {
  const Neighbours around(*this, point);
  Horizons scale = GroundShares(surface, horizons);
  Horizons weight{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < kHorizonAzimuths; ++i)
      weight[i] += around.share[k] * views_.Weight(around.node[k], i);
  }
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i)
    scale[i] *= static_cast<float>(kSector) / (weight[i] + 1e-9F);
  std::array<float, kMaxBands + 4> sum{};
  for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth) {
    if (scale[azimuth] <= 0.0F) continue;
    for (std::size_t block = 0; block < stride_; block += 4) {
      const std::size_t at = azimuth * stride_ + block;
      for (std::size_t band = 0; band < 4; ++band) {
        sum[block + band] += scale[azimuth] * (around.share[0] * around.light[0][at + band] +
                                               around.share[1] * around.light[1][at + band] +
                                               around.share[2] * around.light[2][at + band] +
                                               around.share[3] * around.light[3][at + band]);
      }
    }
  }
  Spectrum irradiance(bands_);
  std::copy_n(sum.begin(), bands_, irradiance.values().begin());
  return irradiance;
}

Spectrum TerrainInterreflection::Radiance(const glm::dvec3& point, const BetweenAzimuths& azimuth,
                                          double horizon, const Spectrum& beyond) const {
  const Neighbours around(*this, point);
  Spectrum radiance(bands_);
  float weight = 0.0F;
  const auto add = [&](std::size_t direction, float share) {
    for (std::size_t k = 0; k < 4; ++k) {
      const float of_node = share * around.share[k];
      weight += of_node * views_.Weight(around.node[k], direction);
      const float* light = around.light[k] + direction * stride_;
      for (std::size_t band = 0; band < bands_; ++band) radiance[band] += of_node * light[band];
    }
  };
  const auto along = static_cast<float>(azimuth.along);
  add(azimuth.before, 1.0F - along);
  add(azimuth.after, along);
  // A level surface has the weight h^2 / 2 of ground up to the sine h. A node that leans away has
  // less, but not less than a tenth of it. Ground below the sine 0.005, 3 m over a cell of the
  // coarse grid, is not resolved by the grid, which may see the unevenness of a sea there.
  constexpr double kLeastShare = 0.1, kUnknown = 0.005;
  const double known = std::max(horizon, 0.0) + kUnknown;
  const auto least = static_cast<float>(kLeastShare * 0.5 * known * known);
  const float missing = std::max(least - weight, 0.0F);
  return 1.0F / (weight + missing) * (radiance + missing * beyond);
}

}  // namespace alpenglow::renderer
