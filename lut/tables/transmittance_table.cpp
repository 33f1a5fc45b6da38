// SPDX-License-Identifier: MIT
#include "lut/tables/transmittance_table.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/ray.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {
namespace {

std::size_t RequireSize(const Medium& medium, const TransmittanceTableSize& size) {
  Validate(medium);
  const std::uint64_t bytes =
      RequireTableSize("transmittance", {{"mu", size.mu, 2}, {"r", size.altitudes, 2}},
                       medium.wavelengths_nm.size(), medium);
  return static_cast<std::size_t>(bytes) / sizeof(float);
}

Spectrum Constant(std::size_t bands, float value) {
  Spectrum result(bands);
  std::fill_n(result.values().begin(), bands, value);
  return result;
}

}  // namespace

TransmittanceTable::TransmittanceTable(const Medium& medium, const TransmittanceTableSize& size)
    : medium_(medium),
      size_(size),
      radius_km_(medium.planet_radius_m / kMetresPerKilometre),
      top_km_(medium.atmosphere_height_m / kMetresPerKilometre),
      texels_(RequireSize(medium, size)) {
  const SingleScattering<double> air(medium_);
  const std::size_t bands = air.bands();
  tbb::parallel_for(std::size_t{0}, size_.altitudes, [&](std::size_t row) {
    for (std::size_t column = 0; column < size_.mu; ++column) {
      const Point point = PointOfTexel(column, row);
      const std::array<double, 3> columns_m = air.ColumnsToSpace(point.altitude_m, point.mu);
      for (std::size_t band = 0; band < bands; ++band) {
        const double tau = OpticalDepthOf(ExtinctionAt<double>(medium_, band),
                                          {columns_m[0], columns_m[1], columns_m[2]});
        texels_[(row * size_.mu + column) * bands + band] = static_cast<float>(std::exp(-tau));
      }
    }
  });
}

TransmittanceTable::TransmittanceTable(const Medium& medium, const TransmittanceTableSize& size,
                                       std::vector<float> texels)
    : medium_(medium),
      size_(size),
      radius_km_(medium.planet_radius_m / kMetresPerKilometre),
      top_km_(medium.atmosphere_height_m / kMetresPerKilometre),
      texels_(std::move(texels)) {
  if (const std::size_t expected = RequireSize(medium, size); texels_.size() != expected) {
    throw InputError(
        fmt::format("transmittance table: {} values; its size needs {}", texels_.size(), expected));
  }
  for (const float value : texels_) RequireInRange(value, 0.0, 1.0, "transmittance texel");
}

TransmittanceTable::Point TransmittanceTable::PointOfTexel(std::size_t mu,
                                                           std::size_t altitude) const {
  const double h =
      shared::AltitudeFromUnit<double>(UnitOf(altitude, size_.altitudes), top_km_, radius_km_);
  const double cosine =
      shared::SkyCosineFromUnit<double>(UnitOf(mu, size_.mu), h, top_km_, radius_km_);
  return {h * kMetresPerKilometre, std::max(cosine, shared::HorizonCosine<double>(h, radius_km_))};
}

Spectrum TransmittanceTable::Interpolate(double altitude_km, double mu) const {
  const auto row = AxisPosition::FromUnit(
      shared::UnitFromAltitude<double>(altitude_km, top_km_, radius_km_), size_.altitudes);
  const auto column = AxisPosition::FromUnit(
      shared::UnitFromSkyCosine<double>(altitude_km, mu, top_km_, radius_km_), size_.mu);
  const std::size_t bands = medium_.wavelengths_nm.size();
  const float* low = &texels_[(row.low * size_.mu + column.low) * bands];
  const float* high = low + size_.mu * bands;
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  Spectrum result(bands);
  for (std::size_t band = 0; band < bands; ++band) {
    result[band] = mix(mix(low[band], low[bands + band], column.fraction),
                       mix(high[band], high[bands + band], column.fraction), row.fraction);
  }
  return result;
}

Spectrum TransmittanceTable::Lookup(double altitude_m, double mu) const {
  const std::size_t bands = medium_.wavelengths_nm.size();
  const RayExtent extent =
      ExtentOf({altitude_m, mu}, medium_.planet_radius_m, medium_.atmosphere_height_m);
  if (extent.end == RayEnd::kGround) return Constant(bands, 0.0F);
  if (extent.begin_m == extent.end_m) return Constant(bands, 1.0F);
  const double h = std::max(altitude_m, 0.0) / kMetresPerKilometre;
  if (extent.begin_m == 0.0) return Interpolate(h, mu);
  const double d = extent.begin_m / kMetresPerKilometre;
  return Interpolate(top_km_, shared::ZenithCosineAlongRay<double>(h, mu, d, top_km_, radius_km_));
}

Spectrum TransmittanceTable::LookupAlong(const ViewRay& ray) const {
  const std::size_t bands = medium_.wavelengths_nm.size();
  const RayExtent extent = ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
  if (extent.begin_m == extent.end_m) return Constant(bands, 1.0F);
  if (extent.end == RayEnd::kSpace) return Lookup(ray.altitude_m, ray.mu);
  // Divides the transmittance from one end to space by that from the other end. For rays that go
  // down, the reversed direction is used, so that neither path passes through the ground.
  const double h = std::max(ray.altitude_m, 0.0) / kMetresPerKilometre;
  const auto at = [&](double distance_m, double sign) {
    const double d = distance_m / kMetresPerKilometre;
    const double z =
        std::clamp(shared::AltitudeAlongRay<double>(h, ray.mu, d, radius_km_), 0.0, top_km_);
    return Interpolate(z, sign * shared::ZenithCosineAlongRay<double>(h, ray.mu, d, z, radius_km_));
  };
  ViewRay whole = ray;
  whole.length_m = std::numeric_limits<double>::infinity();
  const bool down =
      ExtentOf(whole, medium_.planet_radius_m, medium_.atmosphere_height_m).end == RayEnd::kGround;
  const Spectrum begin = at(extent.begin_m, down ? -1.0 : 1.0);
  const Spectrum end = at(extent.end_m, down ? -1.0 : 1.0);
  Spectrum result(bands);
  for (std::size_t band = 0; band < bands; ++band) {
    const float whole_way = down ? end[band] : begin[band];
    const float beyond = down ? begin[band] : end[band];
    result[band] = beyond > 0.0F ? std::min(whole_way / beyond, 1.0F) : 0.0F;
  }
  return result;
}

}  // namespace alpenglow::lut
