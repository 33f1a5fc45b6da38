// SPDX-License-Identifier: MIT
#include "renderer/media/local_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "renderer/media/classified_volume.h"
#include "renderer/scene/volume_file.h"

namespace alpenglow::renderer {
namespace {

MediumOptics OpticsOf(const Volume& volume, const std::vector<double>& wavelengths_nm) {
  const std::size_t bands = wavelengths_nm.size();
  MediumOptics optics =
      OpticsFromLists(volume.extinction_per_m, volume.albedo, volume.phase, bands);
  optics.emission_per_m = InBands(volume.emission_per_m, bands);
  if (!volume.temperature_k) return optics;
  // Kirchhoff's law: absorption implies emission.
  const SpectrumOf<double> albedo = InBands(volume.albedo, bands);
  for (std::size_t band = 0; band < bands; ++band) {
    optics.emission_per_m[band] += optics.extinction_per_m[band] * (1.0 - albedo[band]) *
                                   BlackBodyRadiance(wavelengths_nm[band], *volume.temperature_k);
  }
  return optics;
}

VolumePlacement PlacementOf(const Volume& volume, const SceneGround& ground) {
  VolumePlacement placement = PlacementAt(volume.place, volume.height, volume.heading_rad, ground);
  placement.size_m = {volume.size_m[0], volume.size_m[1], volume.size_m[2]};
  placement.shape = volume.shape;
  return placement;
}

std::shared_ptr<const VolumeGrid> GridOf(const Volume& volume) {
  if (volume.grid.empty()) return nullptr;
  const GridValues allowed = volume.transfer.empty() ? GridValues::kDensities : GridValues::kAny;
  return std::make_shared<const VolumeGrid>(
      volume.grid_size ? ReadRawGrid(volume.grid, *volume.grid_size, allowed)
                       : ReadNrrd(volume.grid, allowed));
}

/// Returns whether a volume neither attenuates nor emits.
bool IsVoid(const Volume& volume) {
  const auto is_zero = [](double value) { return value == 0.0; };
  return std::all_of(volume.extinction_per_m.begin(), volume.extinction_per_m.end(), is_zero) &&
         std::all_of(volume.emission_per_m.begin(), volume.emission_per_m.end(), is_zero);
}

/// Returns a volume; null if it neither attenuates nor emits. Cutting rays at it would only add
/// rounding errors.
std::shared_ptr<const LocalMedium> MadeOf(const Volume& volume, const SceneGround& ground,
                                          const std::vector<double>& wavelengths_nm) {
  const VolumePlacement placement = PlacementOf(volume, ground);
  auto grid = GridOf(volume);
  if (volume.transfer.empty()) {
    if (IsVoid(volume)) return nullptr;
    return std::make_shared<const LocalVolume>(placement, volume.scale_height_m, std::move(grid),
                                               OpticsOf(volume, wavelengths_nm), volume.orders);
  }
  auto made = std::make_shared<const ClassifiedVolume>(
      placement, std::move(grid),
      std::make_shared<const TransferFunction>(volume.transfer, wavelengths_nm), volume.phase,
      volume.orders);
  return made->IsVoid() ? nullptr : made;
}

}  // namespace

LocalVolume::LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
                         std::shared_ptr<const VolumeGrid> grid, MediumOptics optics,
                         ScatteringOrders orders)
    : LocalBody(placement, std::move(optics), orders),
      scale_height_m_(scale_height_m),
      grid_(std::move(grid)) {
  ALPENGLOW_ENSURE(int{scale_height_m.has_value()} + int{grid_ != nullptr}, <=, 1);
}

std::optional<std::array<int, 3>> LocalVolume::Samples() const {
  return grid_ ? std::optional(grid_->size()) : std::nullopt;
}

double LocalVolume::DensityIn(const glm::dvec3& unit) const {
  if (grid_) return grid_->At(unit);
  if (scale_height_m_) return std::exp(-unit.z * placement().size_m.z / *scale_height_m_);
  return 1.0;
}

double LocalVolume::DensityAt(const glm::dvec3& point) const {
  return Contains(point) ? DensityIn(UnitFromFrame(point)) : 0.0;
}

double LocalVolume::LargestBetween(const glm::dvec3& from, const glm::dvec3& to,
                                   double largest) const {
  return grid_ ? largest : std::max(DensityAt(from), DensityAt(to));
}

std::vector<DensePiece> LocalVolume::PiecesAlong(const glm::dvec3& origin,
                                                 const glm::dvec3& direction,
                                                 double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span) return {};
  const glm::dvec3 start = UnitFromFrame(origin), step = UnitsPerMetre(direction);
  if (grid_) return grid_->PiecesAlong(start, step, span->begin_m, span->end_m);
  const double most =
      std::max(DensityIn(start + span->begin_m * step), DensityIn(start + span->end_m * step));
  return {{span->begin_m, span->end_m, most}};
}

double LocalVolume::Column(const glm::dvec3& origin, const glm::dvec3& direction,
                           double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span) return 0.0;
  const glm::dvec3 start = UnitFromFrame(origin), step = UnitsPerMetre(direction);
  if (grid_) return grid_->Column(start, step, span->begin_m, span->end_m);
  const double length = span->end_m - span->begin_m;
  if (!scale_height_m_) return length;
  const double rise = step.z * length * placement().size_m.z / *scale_height_m_;
  return ExponentialColumn(length, DensityIn(start + span->begin_m * step),
                           DensityIn(start + span->end_m * step), rise);
}

MediaList VolumesOf(const Scene& scene, const SceneGround& ground, const Medium& medium) {
  MediaList volumes;
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    try {
      auto made = MadeOf(scene.volumes[i], ground, medium.wavelengths_nm);
      if (made) volumes.push_back(std::move(made));
    } catch (const InputError& error) {
      throw InputError(fmt::format("volume {}: {}", i + 1, error.what()));
    }
  }
  return volumes;
}

}  // namespace alpenglow::renderer
