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
#include "renderer/media/lit_volume.h"
#include "renderer/scene/volume_file.h"

namespace alpenglow::renderer {
namespace {

/// A line in the coordinates of the unit cube.
struct UnitLine {
  glm::dvec3 origin, direction;
};

UnitLine InUnits(const LocalVolume& volume, const glm::dvec3& origin, const glm::dvec3& direction) {
  const VolumePlacement& p = volume.placement();
  return {volume.UnitFromFrame(origin),
          glm::dvec3(glm::dot(direction, p.across), glm::dot(direction, p.ahead),
                     glm::dot(direction, p.up)) /
              p.size_m};
}

std::optional<LineSpan> InUnitCube(const UnitLine& line, double length_m) {
  double begin = 0.0, end = length_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (line.direction[axis] == 0.0) {
      if (!(line.origin[axis] >= 0.0 && line.origin[axis] <= 1.0)) return std::nullopt;
      continue;
    }
    const double a = -line.origin[axis] / line.direction[axis];
    const double b = (1.0 - line.origin[axis]) / line.direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  if (!(begin < end)) return std::nullopt;
  return LineSpan{begin, end};
}

// Returns the part of a line in the sphere of radius 1/2 in the middle of the cube.
std::optional<LineSpan> InUnitBall(const UnitLine& line, double length_m) {
  const glm::dvec3 from = line.origin - 0.5;
  const double a = glm::dot(line.direction, line.direction);
  const double nearest = -glm::dot(from, line.direction) / a;
  // Square the distance vector from the middle: b^2 - 4 a c would lose digits to cancellation.
  const glm::dvec3 off = from + nearest * line.direction;
  const double left = 0.25 - glm::dot(off, off);
  if (left <= 0.0) return std::nullopt;
  const double half = std::sqrt(left / a);
  const LineSpan span{std::max(nearest - half, 0.0), std::min(nearest + half, length_m)};
  if (!(span.begin_m < span.end_m)) return std::nullopt;
  return span;
}

// Returns the value of a band from a list with one value, or one per band.
double ValueAt(const std::vector<double>& values, std::size_t band) {
  return values.size() == 1 ? values.front() : values[band];
}

MediumOptics OpticsOf(const Volume& volume, const std::vector<double>& wavelengths_nm) {
  const std::size_t bands = wavelengths_nm.size();
  MediumOptics optics{SpectrumOf<double>(bands), SpectrumOf<double>(bands),
                      SpectrumOf<double>(bands), volume.phase};
  for (std::size_t band = 0; band < bands; ++band) {
    const double extinction = ValueAt(volume.extinction_per_m, band);
    const double albedo = ValueAt(volume.albedo, band);
    optics.extinction_per_m[band] = extinction;
    optics.scattering_per_m[band] = extinction * albedo;
    optics.emission_per_m[band] = ValueAt(volume.emission_per_m, band);
    // Kirchhoff's law: absorption implies emission.
    if (volume.temperature_k) {
      optics.emission_per_m[band] += extinction * (1.0 - albedo) *
                                     BlackBodyRadiance(wavelengths_nm[band], *volume.temperature_k);
    }
  }
  return optics;
}

VolumePlacement PlacementOf(const Volume& volume, const SceneGround& ground) {
  Place place = volume.place;
  if (!volume.height.above_ground) place.height_m = volume.height.value_m;
  VolumePlacement placement;
  placement.bottom = ground.frame.EnuFromGeodetic(place).xyz;
  place.height_m += 1000.0;
  placement.up = (ground.frame.EnuFromGeodetic(place).xyz - placement.bottom) / 1000.0;
  if (volume.height.above_ground) {
    placement.bottom.z =
        TerrainTop(ground, placement.bottom.x, placement.bottom.y).value_or(placement.bottom.z);
    placement.bottom += volume.height.value_m * placement.up;
  }
  const glm::dvec3 ahead(std::sin(volume.heading_rad), std::cos(volume.heading_rad), 0.0);
  placement.up = glm::normalize(placement.up);
  placement.ahead = glm::normalize(ahead - glm::dot(ahead, placement.up) * placement.up);
  placement.across = glm::cross(placement.ahead, placement.up);
  placement.size_m = {volume.size_m[0], volume.size_m[1], volume.size_m[2]};
  placement.shape = volume.shape;
  return placement;
}

std::shared_ptr<const VolumeGrid> GridOf(const Volume& volume) {
  if (volume.grid.empty()) return nullptr;
  return std::make_shared<const VolumeGrid>(
      volume.grid_size ? ReadRawGrid(volume.grid, *volume.grid_size) : ReadNrrd(volume.grid));
}

/// Returns whether a volume neither attenuates nor emits. Cutting rays at it would only add
/// rounding errors.
bool IsVoid(const Volume& volume) {
  const auto is_zero = [](double value) { return value == 0.0; };
  return std::all_of(volume.extinction_per_m.begin(), volume.extinction_per_m.end(), is_zero) &&
         std::all_of(volume.emission_per_m.begin(), volume.emission_per_m.end(), is_zero);
}

}  // namespace

LocalVolume::LocalVolume(const VolumePlacement& placement, std::optional<double> scale_height_m,
                         std::shared_ptr<const VolumeGrid> grid, MediumOptics optics)
    : LocalMedium(std::move(optics)),
      placement_(placement),
      scale_height_m_(scale_height_m),
      grid_(std::move(grid)) {
  for (int axis = 0; axis < 3; ++axis) ALPENGLOW_ENSURE(placement.size_m[axis], >, 0.0);
  ALPENGLOW_ENSURE(int{scale_height_m.has_value()} + int{grid_ != nullptr}, <=, 1);
}

glm::dvec3 LocalVolume::Middle() const { return FrameFromUnit(glm::dvec3(0.5)); }

glm::dvec3 LocalVolume::UnitFromFrame(const glm::dvec3& point) const {
  const glm::dvec3 off = point - placement_.bottom;
  return glm::dvec3(glm::dot(off, placement_.across) / placement_.size_m.x + 0.5,
                    glm::dot(off, placement_.ahead) / placement_.size_m.y + 0.5,
                    glm::dot(off, placement_.up) / placement_.size_m.z);
}

glm::dvec3 LocalVolume::FrameFromUnit(const glm::dvec3& unit) const {
  return placement_.bottom + (unit.x - 0.5) * placement_.size_m.x * placement_.across +
         (unit.y - 0.5) * placement_.size_m.y * placement_.ahead +
         unit.z * placement_.size_m.z * placement_.up;
}

double LocalVolume::DensityIn(const glm::dvec3& unit) const {
  if (grid_) return grid_->At(unit);
  if (scale_height_m_) return std::exp(-unit.z * placement_.size_m.z / *scale_height_m_);
  return 1.0;
}

double LocalVolume::DensityAt(const glm::dvec3& point) const {
  const glm::dvec3 unit = UnitFromFrame(point);
  const glm::dvec3 off = unit - 0.5;
  const bool inside = placement_.shape == VolumePlacement::Shape::kBox
                          ? std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) <= 0.5
                          : glm::dot(off, off) <= 0.25;
  return inside ? DensityIn(unit) : 0.0;
}

std::optional<LineSpan> LocalVolume::SpanAlong(const glm::dvec3& origin,
                                               const glm::dvec3& direction, double length_m) const {
  const UnitLine line = InUnits(*this, origin, direction);
  return placement_.shape == VolumePlacement::Shape::kBox ? InUnitCube(line, length_m)
                                                          : InUnitBall(line, length_m);
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
  const UnitLine line = InUnits(*this, origin, direction);
  if (!grid_) {
    const double most = std::max(DensityIn(line.origin + span->begin_m * line.direction),
                                 DensityIn(line.origin + span->end_m * line.direction));
    return {{span->begin_m, span->end_m, most}};
  }
  std::vector<DensePiece> pieces;
  for (const auto& [begin, end, most] :
       grid_->PiecesAlong(line.origin, line.direction, span->begin_m, span->end_m)) {
    pieces.push_back({begin, end, most});
  }
  return pieces;
}

double LocalVolume::Column(const glm::dvec3& origin, const glm::dvec3& direction,
                           double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span) return 0.0;
  const UnitLine line = InUnits(*this, origin, direction);
  if (grid_) return grid_->Column(line.origin, line.direction, span->begin_m, span->end_m);
  const double length = span->end_m - span->begin_m;
  if (!scale_height_m_) return length;
  const double rise = line.direction.z * length * placement_.size_m.z / *scale_height_m_;
  return ExponentialColumn(length, DensityIn(line.origin + span->begin_m * line.direction),
                           DensityIn(line.origin + span->end_m * line.direction), rise);
}

std::unique_ptr<const LitMedium> LocalVolume::LitBy(const MediaSources& sources) const {
  return std::make_unique<LitVolume>(*this, sources);
}

MediaList VolumesOf(const Scene& scene, const SceneGround& ground, const Medium& medium) {
  MediaList volumes;
  for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
    const Volume& volume = scene.volumes[i];
    try {
      auto made = std::make_shared<const LocalVolume>(PlacementOf(volume, ground),
                                                      volume.scale_height_m, GridOf(volume),
                                                      OpticsOf(volume, medium.wavelengths_nm));
      if (!IsVoid(volume)) volumes.push_back(std::move(made));
    } catch (const InputError& error) {
      throw InputError(fmt::format("volume {}: {}", i + 1, error.what()));
    }
  }
  return volumes;
}

}  // namespace alpenglow::renderer
