// SPDX-License-Identifier: MIT
#include "renderer/open_sky.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/constants.h"
#include "lut/sky_view.h"

namespace alpenglow {
namespace {

constexpr float kSector = 2.0F * static_cast<float>(kPi) / static_cast<float>(kHorizonAzimuths);

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

/// Antiderivative of sqrt(1 - s^2) over [-1, 1], linear between even steps of the elevation's
/// neighbourhood: steps in s, small where it bends.
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

/// Between nodes of the sine.
struct NodeTap {
  std::size_t node;
  float share;
};

template <std::size_t kNodes>
NodeTap TapOf(float sine) {
  constexpr float kScale = static_cast<float>(kNodes - 1) / (1.0F - HorizonMap::kLowest);
  const float at =
      std::clamp((sine - HorizonMap::kLowest) * kScale, 0.0F, static_cast<float>(kNodes - 1));
  const std::size_t node = std::min(static_cast<std::size_t>(at), kNodes - 2);
  return {node, at - static_cast<float>(node)};
}

}  // namespace

SurfaceSectors SectorsOf(const glm::dvec3& normal) {
  const Directions& direction = SectorDirections();
  SurfaceSectors sectors;
  sectors.up = static_cast<float>(normal.z);
  const auto x = static_cast<float>(normal.x), y = static_cast<float>(normal.y);
  const float up = std::abs(sectors.up);
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    sectors.along[i] = direction.x[i] * x + direction.y[i] * y;
    // Where the surface's plane cuts the azimuth.
    const float plane =
        sectors.along[i] / std::sqrt(up * up + sectors.along[i] * sectors.along[i] + 1e-12F);
    sectors.lowest[i] = sectors.up >= 0.0F ? -plane : -1.0F;
    sectors.highest[i] = sectors.up >= 0.0F ? 1.0F : plane;
  }
  return sectors;
}

float SectorIntegral(float up, float along, float low, float high) {
  return 0.5F * up * (high * high - low * low) + along * (Area().At(high) - Area().At(low));
}

OpenSky::OpenSky(const AirIntegrator<float>& air, const DiffuseLight& diffuse,
                 const glm::dvec3& to_sun, double lowest_m, double highest_m)
    : diffuse_(diffuse),
      bands_(air.bands()),
      stride_((air.bands() + 3) / 4 * 4),
      lowest_m_(std::max(lowest_m, 0.0)),
      highest_m_(std::max(highest_m, lowest_m_ + 1.0)),
      integral_(kLevels * level_floats()) {
  // Three skies; between them the levels are linear.
  const double middle_m = 0.5 * (lowest_m_ + highest_m_);
  const std::array<std::vector<float>, 3> table{TableAt(air, lowest_m_, to_sun),
                                                TableAt(air, middle_m, to_sun),
                                                TableAt(air, highest_m_, to_sun)};
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

std::vector<float> OpenSky::TableAt(const AirIntegrator<float>& air, double altitude_m,
                                    const glm::dvec3& to_sun) const {
  constexpr std::size_t kParts = 6;  // of a sector
  constexpr std::array<double, 2> kGauss{0.2113248654051871, 0.7886751345948129};
  const double mu_s = std::clamp(to_sun.z, -1.0, 1.0);
  const SkyView view(air, diffuse_, altitude_m, mu_s);
  const double sun_azimuth = std::atan2(to_sun.y, to_sun.x);
  std::vector<double> azimuths;
  for (std::size_t i = 0; i < kHorizonAzimuths; ++i) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const double within = (static_cast<double>(part) + 0.5) / kParts - 0.5;
      azimuths.push_back(HorizonAzimuth(i) + within * static_cast<double>(kSector) - sun_azimuth);
    }
  }
  const SkyAzimuths row_azimuths(view, azimuths);
  std::vector<float> row(azimuths.size() * view.stride());
  std::vector<float> table(level_floats(), 0.0F);
  const double step = (1.0 - static_cast<double>(HorizonMap::kLowest)) / (kNodes - 1);
  const Bands<float> level_plane = diffuse_.SkyIrradiance(altitude_m, mu_s);
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

std::size_t OpenSky::Level(double altitude_m) const {
  const double at =
      (altitude_m - lowest_m_) / (highest_m_ - lowest_m_) * static_cast<double>(kLevels - 1);
  return static_cast<std::size_t>(
      std::lround(std::clamp(at, 0.0, static_cast<double>(kLevels - 1))));
}

Bands<float> OpenSky::Irradiance(double altitude_m, double mu_s, const SurfaceSectors& surface,
                                 const Horizons& horizons) const {
  const float* table = &integral_[Level(altitude_m) * level_floats()];
  std::array<float, kMaxBands> sum{};
  // The part between two sines is the difference of what lies over them.
  const auto add = [&](std::size_t azimuth, float sine, float scale) {
    const NodeTap tap = TapOf<kNodes>(sine);
    const float* low = &table[(azimuth * kNodes + tap.node) * 2 * stride_];
    const float* high = low + 2 * stride_;
    const float up_low = scale * surface.up * (1.0F - tap.share);
    const float up_high = scale * surface.up * tap.share;
    const float along_low = scale * surface.along[azimuth] * (1.0F - tap.share);
    const float along_high = scale * surface.along[azimuth] * tap.share;
    for (std::size_t block = 0; block < stride_; block += 4) {
      for (std::size_t k = block; k < block + 4; ++k) {
        sum[k] += up_low * low[k] + up_high * high[k] + along_low * low[stride_ + k] +
                  along_high * high[stride_ + k];
      }
    }
  };
  for (std::size_t azimuth = 0; azimuth < kHorizonAzimuths; ++azimuth) {
    const float from = std::max(horizons[azimuth], surface.lowest[azimuth]);
    const float to = surface.highest[azimuth];
    if (from >= to) continue;
    add(azimuth, from, 1.0F);
    if (to < 1.0F) add(azimuth, to, -1.0F);
  }
  Bands<float> irradiance = diffuse_.SkyIrradiance(altitude_m, mu_s);
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] *= kSector * std::max(sum[band], 0.0F);
  return irradiance;
}

// The difference of A between two nodes is the radiance between them; low down that of B, which
// does not vanish at the horizontal.
void OpenSky::KeepRadiances() {
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
  }
}

Bands<float> OpenSky::Radiance(double altitude_m, double mu_s, const glm::dvec3& direction) const {
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
  Bands<float> radiance = diffuse_.SkyIrradiance(altitude_m, mu_s);
  for (std::size_t band = 0; band < bands_; ++band) {
    const float a = here[band] + up * (here[stride_ + band] - here[band]);
    const float b = there[band] + up * (there[stride_ + band] - there[band]);
    radiance[band] *= std::max(a + along * (b - a), 0.0F);
  }
  return radiance;
}

}  // namespace alpenglow
