// SPDX-License-Identifier: MIT
#include "renderer/illumination/occluded_sky.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::renderer {
namespace {

constexpr float kSkySector = 2.0F * static_cast<float>(kPi) / static_cast<float>(kHorizonAzimuths);

struct Directions {
  Horizons x, y;
};

const Directions& SectorDirections() {
  static const Directions directions = [] {
    Directions d;
    for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
      d.x[i] = static_cast<float>(std::cos(HorizonAzimuth(i)));
      d.y[i] = static_cast<float>(std::sin(HorizonAzimuth(i)));
    }
    return d;
  }();
  return directions;
}

/// Antiderivative of sqrt(1 - s^2) over [-1, 1], tabulated at even steps of s and interpolated
/// linearly; the steps are small enough near the ends, where it bends.
class HalfDiskArea {
 public:
  HalfDiskArea() {
    for (std::size_t i = 0; i < kSteps + 1; ++i) {
      const double s = 2.0 * static_cast<double>(i) / kSteps - 1.0;
      area_[i] = static_cast<float>(0.5 * (std::asin(s) + s * std::sqrt(1.0 - s * s)));
    }
  }
  [[nodiscard]] float At(float s) const {
    const float at = std::clamp(0.5F * (s + 1.0F), 0.0F, 1.0F) * static_cast<float>(kSteps);
    const std::size_t step = std::min(static_cast<std::size_t>(at), kSteps - 1);
    return area_[step] + (at - static_cast<float>(step)) * (area_[step + 1] - area_[step]);
  }

 private:
  static constexpr std::size_t kSteps = 512;
  std::array<float, kSteps + 1> area_;
};

const HalfDiskArea& Area() {
  static const HalfDiskArea area;
  return area;
}

/// Interpolation position between nodes of the sine.
struct NodeTap {
  std::size_t node;
  float share;
};

}  // namespace

SurfaceSectors SectorsOf(const glm::dvec3& normal) {
  const Directions& direction = SectorDirections();
  SurfaceSectors sectors;
  sectors.up = static_cast<float>(normal.z);
  const auto x = static_cast<float>(normal.x), y = static_cast<float>(normal.y);
  const float up2 = sectors.up * sectors.up + 1e-12F;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const float along = direction.x[i] * x + direction.y[i] * y;
    sectors.along[i] = along;
    // The surface's plane intersects the azimuth at this elevation.
    sectors.lowest[i] = -along / std::sqrt(up2 + along * along);
    sectors.highest[i] = 1.0F;
  }
  if (sectors.up >= 0.0F) return sectors;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    sectors.highest[i] = -sectors.lowest[i];
    sectors.lowest[i] = -1.0F;
  }
  return sectors;
}

float SectorIntegral(float up, float along, float low, float high) {
  return 0.5F * up * (high * high - low * low) + along * (Area().At(high) - Area().At(low));
}

Horizons GroundShares(const SurfaceSectors& surface, const Horizons& horizons) {
  const HalfDiskArea& area = Area();
  Horizons shares;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const float low = surface.lowest[i];
    const float high = std::max(std::min(horizons[i], surface.highest[i]), low);
    const float along = high > low ? area.At(high) - area.At(low) : 0.0F;
    shares[i] =
        std::max(0.5F * surface.up * (high * high - low * low) + surface.along[i] * along, 0.0F);
  }
  return shares;
}

OccludedSkyIrradiance::OccludedSkyIrradiance(const SingleScattering<float>& air,
                                             const MultipleScattering& multiple_scattering,
                                             const glm::dvec3& to_light, const Extent& extent)
    : bands_(air.bands()),
      stride_((air.bands() + 3) / 4 * 4),
      lowest_m_(std::max(extent.lowest_m, 0.0)),
      highest_m_(std::max(extent.highest_m, lowest_m_ + 1.0)),
      level_irradiance_(kLevels * kSuns * stride_, 0.0F),
      integral_(kLevels * level_floats()) {
  const double half = 1e-4 + extent.radius_m / air.medium().planet_radius_m;
  first_mu_s_ = to_light.z - half;
  mu_s_step_ = 2.0 * half / static_cast<double>(kSuns - 1);
  for (std::size_t i = 0; i < kLevels * kSuns; ++i) {
    const double level = static_cast<double>(i / kSuns) / static_cast<double>(kLevels - 1);
    const auto irradiance = multiple_scattering.SkyIrradiance(
        lowest_m_ + level * (highest_m_ - lowest_m_),
        std::clamp(first_mu_s_ + static_cast<double>(i % kSuns) * mu_s_step_, -1.0, 1.0));
    std::copy_n(irradiance.values().begin(), bands_, &level_irradiance_[i * stride_]);
  }
  // Compute three skies; the levels between them are interpolated linearly.
  const double middle_m = 0.5 * (lowest_m_ + highest_m_);
  const std::array<std::vector<float>, 3> table{
      TableAt(air, multiple_scattering, lowest_m_, to_light),
      TableAt(air, multiple_scattering, middle_m, to_light),
      TableAt(air, multiple_scattering, highest_m_, to_light)};
  for (std::size_t level = 0; level < kLevels; ++level) {
    const float at = 2.0F * static_cast<float>(level) / static_cast<float>(kLevels - 1);
    const std::size_t first = at < 1.0F ? 0 : 1;
    const float share = at - static_cast<float>(first);
    float* into = &integral_[level * level_floats()];
    for (std::size_t i = 0; i < level_floats(); ++i)
      into[i] = table[first][i] + share * (table[first + 1][i] - table[first][i]);
  }
  KeepRadiances();
}

std::vector<float> OccludedSkyIrradiance::TableAt(const SingleScattering<float>& air,
                                                  const MultipleScattering& multiple_scattering,
                                                  double altitude_m,
                                                  const glm::dvec3& to_light) const {
  constexpr std::size_t kParts = 6;  // per sector
  constexpr std::array<double, 2> kGauss{0.2113248654051871, 0.7886751345948129};
  const double mu_s = std::clamp(to_light.z, -1.0, 1.0);
  const SkyView view(air, multiple_scattering, altitude_m, mu_s);
  const double sun_azimuth = std::atan2(to_light.y, to_light.x);
  std::vector<double> azimuths;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const double within = (static_cast<double>(part) + 0.5) / kParts - 0.5;
      azimuths.push_back(HorizonAzimuth(i) + within * static_cast<double>(kSkySector) -
                         sun_azimuth);
    }
  }
  const SkyAzimuths row_azimuths(view, azimuths);
  std::vector<float> row(azimuths.size() * view.stride());
  std::vector<float> table(level_floats(), 0.0F);
  const double step = (1.0 - static_cast<double>(HorizonMap::kLowest)) / (kNodes - 1);
  const Spectrum level_plane = multiple_scattering.SkyIrradiance(altitude_m, mu_s);
  for (std::size_t node = kNodes - 1; node-- > 0;) {
    for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth) {
      const float* above = &table[(azimuth * kNodes + node + 1) * 2 * stride_];
      std::copy_n(above, 2 * stride_, &table[(azimuth * kNodes + node) * 2 * stride_]);
    }
    for (const double part : kGauss) {
      const double sine =
          static_cast<double>(HorizonMap::kLowest) + (static_cast<double>(node) + part) * step;
      view.FillRow(std::acos(sine), row_azimuths, row);
      const auto a = static_cast<float>(0.5 * step * sine / kParts);
      const auto b = static_cast<float>(0.5 * step * std::sqrt(1.0 - sine * sine) / kParts);
      for (std::size_t i = 0; i < azimuths.size(); ++i) {
        float* into = &table[(i / kParts * kNodes + node) * 2 * stride_];
        const float* radiance = &row[i * view.stride()];
        for (std::size_t band = 0; band < bands_; ++band) {
          into[band] += a * radiance[band];
          into[stride_ + band] += b * radiance[band];
        }
      }
    }
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::size_t band = i % stride_;
    if (band < bands_) table[i] /= std::max(level_plane[band], 1e-30F);
  }
  return table;
}

std::size_t OccludedSkyIrradiance::Level(double altitude_m) const {
  const double at =
      (altitude_m - lowest_m_) / (highest_m_ - lowest_m_) * static_cast<double>(kLevels - 1);
  return static_cast<std::size_t>(
      std::lround(std::clamp(at, 0.0, static_cast<double>(kLevels - 1))));
}

Spectrum OccludedSkyIrradiance::LevelIrradiance(double altitude_m, double mu_s) const {
  const auto tap = [](double at, std::size_t nodes) {
    const double clamped = std::clamp(at, 0.0, static_cast<double>(nodes - 1));
    const std::size_t node = std::min(static_cast<std::size_t>(clamped), nodes - 2);
    return NodeTap{node, static_cast<float>(clamped - static_cast<double>(node))};
  };
  const NodeTap level =
      tap((altitude_m - lowest_m_) / (highest_m_ - lowest_m_) * static_cast<double>(kLevels - 1),
          kLevels);
  const NodeTap sun = tap((mu_s - first_mu_s_) / mu_s_step_, kSuns);
  const float* low = &level_irradiance_[(level.node * kSuns + sun.node) * stride_];
  const float* high = low + kSuns * stride_;
  Spectrum irradiance(bands_);
  for (std::size_t band = 0; band < bands_; ++band) {
    const float a = low[band] + sun.share * (low[stride_ + band] - low[band]);
    const float b = high[band] + sun.share * (high[stride_ + band] - high[band]);
    irradiance[band] = a + level.share * (b - a);
  }
  return irradiance;
}

// The integral between two sines is the difference of the integrals above them. The weights of all
// sectors are computed first, then four bands at a time, so that both loops vectorise.
Spectrum OccludedSkyIrradiance::Irradiance(double altitude_m, double mu_s,
                                           const SurfaceSectors& surface,
                                           const Horizons& horizons) const {
  constexpr float kScale = static_cast<float>(kNodes - 1) / (1.0F - HorizonMap::kLowest);
  constexpr float kLast = static_cast<float>(kNodes - 1);
  std::array<float, kHorizonAzimuths> at, open;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    const float from = std::max(horizons[i], surface.lowest[i]);
    at[i] = std::clamp((from - HorizonMap::kLowest) * kScale, 0.0F, kLast);
    open[i] = from < surface.highest[i] ? kSkySector : 0.0F;
  }
  const float* table = &integral_[Level(altitude_m) * level_floats()];
  std::array<float, kMaxBands + 4> sum{};
  const auto add = [&](std::size_t azimuth, float place, float scale) {
    const auto node = static_cast<std::size_t>(place);  // the last node has no sky above it
    const float share = place - static_cast<float>(node);
    const float* low = &table[(azimuth * kNodes + node) * 2 * stride_];
    const float* high = low + (node + 1 < kNodes ? 2 * stride_ : 0);
    const float up_low = scale * surface.up * (1.0F - share), up_high = scale * surface.up * share;
    const float along_low = scale * surface.along[azimuth] * (1.0F - share);
    const float along_high = scale * surface.along[azimuth] * share;
    for (std::size_t block = 0; block < stride_; block += 4) {
      for (std::size_t k = 0; k < 4; ++k) {
        sum[block + k] += up_low * low[block + k] + up_high * high[block + k] +
                          along_low * low[stride_ + block + k] +
                          along_high * high[stride_ + block + k];
      }
    }
  };
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    if (open[i] <= 0.0F) continue;
    add(i, at[i], open[i]);
    if (surface.highest[i] < 1.0F) {
      const float to = (surface.highest[i] - HorizonMap::kLowest) * kScale;
      add(i, std::clamp(to, 0.0F, kLast), -open[i]);
    }
  }
  Spectrum irradiance = LevelIrradiance(altitude_m, mu_s);
  for (std::size_t band = 0; band < bands_; ++band) irradiance[band] *= std::max(sum[band], 0.0F);
  return irradiance;
}

// Radiance between two nodes is the difference of A over that of its weight; at low elevations B is
// used, which does not vanish at the horizontal.
void OccludedSkyIrradiance::KeepRadiances() {
  constexpr float kStep = (1.0F - HorizonMap::kLowest) / static_cast<float>(kNodes - 1);
  radiance_.assign(kLevels * kHorizonAzimuths * kNodes * stride_, 0.0F);
  for (std::size_t row = 0; row < kLevels * kHorizonAzimuths; ++row) {
    for (std::size_t node = 0; node + 1 < kNodes; ++node) {
      const float low = HorizonMap::kLowest + static_cast<float>(node) * kStep;
      const float high = low + kStep;
      const bool steep = low > 0.5F;
      const float area =
          steep ? 0.5F * (high * high - low * low) : Area().At(high) - Area().At(low);
      const float* from = &integral_[((row * kNodes + node) * 2 + (steep ? 0 : 1)) * stride_];
      float* into = &radiance_[(row * kNodes + node) * stride_];
      for (std::size_t band = 0; band < bands_; ++band)
        into[band] = (from[band] - from[2 * stride_ + band]) / area;
    }
    // Directions below the first step above the horizontal have the radiance of this step.
    const auto first = static_cast<std::size_t>(std::ceil(-HorizonMap::kLowest / kStep));
    float* of_row = &radiance_[row * kNodes * stride_];
    for (std::size_t node = 0; node < first; ++node)
      std::copy_n(of_row + first * stride_, stride_, of_row + node * stride_);
  }
}

Spectrum OccludedSkyIrradiance::Radiance(double altitude_m, double mu_s,
                                         const glm::dvec3& direction) const {
  constexpr float kScale = static_cast<float>(kNodes - 1) / (1.0F - HorizonMap::kLowest);
  const float cell =
      std::clamp((static_cast<float>(direction.z) - HorizonMap::kLowest) * kScale - 0.5F, 0.0F,
                 static_cast<float>(kNodes - 2) - 1e-3F);
  const auto node = static_cast<std::size_t>(cell);
  const float up = cell - static_cast<float>(node);
  const double turn = std::atan2(direction.y, direction.x) / (2.0 * kPi);
  const double at = (turn - std::floor(turn)) * static_cast<double>(kHorizonAzimuths);
  const auto along = static_cast<float>(at - std::floor(at));
  const std::size_t sector = static_cast<std::size_t>(at) % kHorizonAzimuths;
  const std::size_t next = (sector + 1) % kHorizonAzimuths;
  const std::size_t level = Level(altitude_m) * kHorizonAzimuths;
  const float* here = &radiance_[((level + sector) * kNodes + node) * stride_];
  const float* there = &radiance_[((level + next) * kNodes + node) * stride_];
  Spectrum radiance = LevelIrradiance(altitude_m, mu_s);
  for (std::size_t band = 0; band < bands_; ++band) {
    const float a = here[band] + up * (here[stride_ + band] - here[band]);
    const float b = there[band] + up * (there[stride_ + band] - there[band]);
    radiance[band] *= std::max(a + along * (b - a), 0.0F);
  }
  return radiance;
}

}  // namespace alpenglow::renderer
