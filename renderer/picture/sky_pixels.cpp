// SPDX-License-Identifier: MIT
#include "renderer/picture/sky_pixels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/layer.h"
#include "renderer/picture/pixel_shader.h"

namespace alpenglow::renderer {
namespace {

constexpr double kQuarter = 0.5 * kPi;

glm::dvec3 East(const glm::dvec3& up) {
  return glm::normalize(glm::dvec3(1.0, 0.0, 0.0) - up.x * up);
}

}  // namespace

Skyline::Skyline(const glm::dvec3& up, const Arc& arc, double step_rad, const SeesSky& sees_sky)
    : up_(up),
      east_(East(up)),
      north_(glm::cross(up_, east_)),
      first_rad_(arc.first_rad),
      step_rad_(step_rad),
      is_whole_turn_(arc.width_rad >= 2.0 * kPi - step_rad) {
  constexpr int kNeighbours = 64;  // found in sequence, each starting from the previous elevation
  if (is_whole_turn_) step_rad_ = 2.0 * kPi / std::ceil(2.0 * kPi / step_rad);
  const int count = is_whole_turn_ ? static_cast<int>(std::lround(2.0 * kPi / step_rad_))
                                   : static_cast<int>(std::ceil(arc.width_rad / step_rad_)) + 1;
  elevation_rad_.resize(static_cast<std::size_t>(count));
  tbb::parallel_for(0, (count + kNeighbours - 1) / kNeighbours, [&](int some) {
    double near_rad = 0.0;
    for (int i = some * kNeighbours; i < std::min((some + 1) * kNeighbours, count); ++i) {
      near_rad = Found(first_rad_ + i * step_rad_, near_rad, sees_sky);
      elevation_rad_[static_cast<std::size_t>(i)] = static_cast<float>(near_rad);
    }
  });
  highest_rad_ =
      static_cast<double>(*std::max_element(elevation_rad_.begin(), elevation_rad_.end()));
}

double Skyline::AzimuthOf(const glm::dvec3& direction, const glm::dvec3& up) {
  const glm::dvec3 east = East(up);
  return std::atan2(glm::dot(direction, glm::cross(up, east)), glm::dot(direction, east));
}

glm::dvec3 Skyline::DirectionAt(double azimuth_rad, double elevation_rad) const {
  return std::cos(elevation_rad) *
             (std::cos(azimuth_rad) * east_ + std::sin(azimuth_rad) * north_) +
         std::sin(elevation_rad) * up_;
}

double Skyline::Found(double azimuth_rad, double near_rad, const SeesSky& sees_sky) const {
  const auto is_sky = [&](double elevation) {
    return sees_sky(DirectionAt(azimuth_rad, elevation));
  };
  double ground = near_rad - step_rad_, sky = near_rad + step_rad_;
  for (double way = 2.0 * step_rad_; ground > -kQuarter && is_sky(ground); way *= 2.0) {
    sky = ground;
    ground = std::max(ground - way, -kQuarter);
  }
  for (double way = 2.0 * step_rad_; sky < kQuarter && !is_sky(sky); way *= 2.0) {
    ground = sky;
    sky = std::min(sky + way, kQuarter);
  }
  while (sky - ground > step_rad_) {
    const double middle = 0.5 * (ground + sky);
    (is_sky(middle) ? sky : ground) = middle;
  }
  return sky;
}

bool Skyline::IsBelow(const glm::dvec3& direction, double around_rad) const {
  const double lowest_rad = std::asin(std::clamp(glm::dot(direction, up_), -1.0, 1.0)) - around_rad;
  if (is_whole_turn_ && lowest_rad > highest_rad_) return true;
  const double x = glm::dot(direction, east_), y = glm::dot(direction, north_);
  const double across = std::hypot(x, y);
  const auto count = static_cast<int>(elevation_rad_.size());
  // Azimuth range of the circle around the direction: its sine is the sine of the angle over the
  // cosine of the elevation.
  if (!(std::sin(around_rad) < across)) return false;
  const double half = std::asin(std::sin(around_rad) / across) / step_rad_ + 1.0;
  const double from_first = std::remainder(std::atan2(y, x) - first_rad_ - kPi, 2.0 * kPi) + kPi;
  const double middle = from_first / step_rad_;
  const int first = static_cast<int>(std::floor(middle - half));
  const int last = static_cast<int>(std::ceil(middle + half));
  if (is_whole_turn_ ? last - first >= count : first < 0 || last >= count) return false;
  for (int i = first; i <= last; ++i) {
    const auto at = static_cast<std::size_t>((i + count) % count);
    if (lowest_rad <= static_cast<double>(elevation_rad_[at])) return false;
  }
  return true;
}

namespace {

/// Returns the pixel of a closed panorama; columns and rows may lie beyond its edges.
std::array<int, 2> InPanorama(int column, int row, int width, int height) {
  while (row < 0 || row >= height) {
    row = row < 0 ? -1 - row : 2 * height - 1 - row;
    column += width / 2;
  }
  return {((column % width) + width) % width, row};
}

}  // namespace

void SpreadLight::Add(const CameraRays& camera, int column, int row, const BandLight& irradiance) {
  if (camera.IsPanorama()) {
    const auto pixel = InPanorama(column, row, width_, height_);
    column = pixel[0];
    row = pixel[1];
  }
  if (row < 0 || row >= height_ || column < 0 || column >= width_) return;
  auto at = pixels_.find(row * width_ + column);
  if (at == pixels_.end()) {
    const double per_sr = 1.0 / camera.PixelSolidAngle(column, row);
    at =
        pixels_.emplace(row * width_ + column, LitPixel{per_sr, BandLight(irradiance.count)}).first;
  }
  LitPixel& pixel = at->second;
  pixel.radiance = pixel.radiance + static_cast<float>(pixel.per_sr) * irradiance;
}

const BandLight* SpreadLight::At(int x, int y) const {
  const auto found = pixels_.find(y * width_ + x);
  return found == pixels_.end() ? nullptr : &found->second.radiance;
}

// A bell over the distance i - f from the place, where f in [-1/2, 1/2] is the place in its pixel,
//
//   exp(-(i - f)^2 / 2 s^2) = exp(-i^2 / 2 s^2) (exp(f / s^2))^i exp(-f^2 / 2 s^2),
//
// needs one exponential, since the last factor is common to all pixels.
StarBell StarBellAround(double place) {
  constexpr double kDeviation = 0.5, kPerVariance = 1.0 / (kDeviation * kDeviation);
  static const StarBell kAtCentre = [] {
    StarBell bell{};
    for (int i = -kStarReach; i <= kStarReach; ++i)
      bell.at(static_cast<std::size_t>(i + kStarReach)) = std::exp(-0.5 * kPerVariance * i * i);
    return bell;
  }();
  const double along = std::exp(kPerVariance * (place - std::floor(place) - 0.5));
  StarBell weights = kAtCentre;
  double after = 1.0, before = 1.0, sum = kAtCentre[kStarReach];
  for (std::size_t i = 1; i <= kStarReach; ++i) {
    sum += weights[kStarReach + i] *= after *= along;
    sum += weights[kStarReach - i] *= before /= along;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

StarPixels::StarPixels(const CameraRays& camera, int width, int height,
                       const std::vector<StarLight>& lights, const Left& left, const Hidden& hidden)
    : width_(width), height_(height), spread_(width, height) {
  for (const StarLight& light : lights) {
    if (light.way.empty()) {
      AddPoint(camera, light, left);
    } else {
      AddTrail(camera, light, left, hidden);
    }
  }
}

bool StarPixels::IsNear(const PicturePoint& place) const {
  return place.x > -kStarReach && place.x < width_ + kStarReach && place.y > -kStarReach &&
         place.y < height_ + kStarReach;
}

void StarPixels::AddPoint(const CameraRays& camera, const StarLight& light, const Left& left) {
  const auto at = camera.PlaceOf(light.direction);
  if (!at) return;
  const PicturePoint place{(*at)[0], (*at)[1]};
  if (!IsNear(place)) return;
  const std::optional<BandLight> through = left(place.x, place.y);
  if (!through) return;
  directions_.push_back(light.direction);
  Spread(camera, place, *through * light.irradiance);
}

void StarPixels::AddTrail(const CameraRays& camera, const StarLight& light, const Left& left,
                          const Hidden& hidden) {
  const std::size_t known = spread_.size();
  const auto steps = static_cast<float>(light.way.size() - 1);
  for (std::size_t i = 0; i + 1 < light.way.size(); ++i) {
    const auto from = camera.PlaceOf(light.way[i]), to = camera.PlaceOf(light.way[i + 1]);
    if (!from || !to) continue;
    const double right = (*to)[0] - (*from)[0];  // the shorter way, across the seam of a panorama
    const double to_x =
        (*from)[0] + (camera.IsPanorama() ? std::remainder(right, 1.0 * width_) : right);
    AddStep(camera, {(*from)[0], (*from)[1]}, {to_x, (*to)[1]}, (1.0F / steps) * light.irradiance,
            left, hidden);
  }
  if (spread_.size() > known) directions_.push_back(light.direction);
}

// Transmittance changes little from end to end of a step. If ground hides one end, it is evaluated
// at every point.
void StarPixels::AddStep(const CameraRays& camera, const PicturePoint& from, const PicturePoint& to,
                         const BandLight& irradiance, const Left& left, const Hidden& hidden) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const int count = std::max(static_cast<int>(std::ceil(2.0 * length)), 1);
  const auto place = [&](int i) {
    const double share = (i + 0.5) / count;
    return PicturePoint{std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)};
  };
  std::optional<BandLight> first, last;
  bool is_asked = false;
  for (int i = 0; i < count; ++i) {
    const PicturePoint at = place(i);
    if (!IsNear(at)) continue;
    if (!is_asked) {
      first = left(from.x, from.y);
      last = left(to.x, to.y);
      is_asked = true;
    }
    std::optional<BandLight> through;
    if (!first || !last) {
      through = left(at.x, at.y);
    } else if (!hidden(at.x, at.y)) {
      const auto share = static_cast<float>((i + 0.5) / count);
      through = (1.0F - share) * *first + share * *last;
    }
    if (through) Spread(camera, at, (1.0F / static_cast<float>(count)) * (*through * irradiance));
  }
}

void StarPixels::Spread(const CameraRays& camera, const PicturePoint& place,
                        const BandLight& irradiance) {
  const auto [x, y] = place;
  const StarBell across = StarBellAround(x), down = StarBellAround(y);
  for (int j = 0; j < 2 * kStarReach + 1; ++j) {
    for (int i = 0; i < 2 * kStarReach + 1; ++i) {
      const double share =
          across.at(static_cast<std::size_t>(i)) * down.at(static_cast<std::size_t>(j));
      spread_.Add(camera, static_cast<int>(std::floor(x)) + i - kStarReach,
                  static_cast<int>(std::floor(y)) + j - kStarReach,
                  static_cast<float>(share) * irradiance);
    }
  }
}

namespace {

/// Rotates a direction by Rodrigues' formula. @param axis  unit.
glm::dvec3 TurnedAbout(const glm::dvec3& axis, double angle_rad, const glm::dvec3& direction) {
  return std::cos(angle_rad) * direction + std::sin(angle_rad) * glm::cross(axis, direction) +
         (1.0 - std::cos(angle_rad)) * glm::dot(axis, direction) * axis;
}

}  // namespace

/// The cells that cover a disk and its motion, in angles around the axis of the motion and towards
/// it. The area of a disk of half the width of a grid at rest is right within 1 %.
class SmallDisk::Grid {
 public:
  explicit Grid(const DiskInSky& disk) : to_disk_(disk.to_disk) {
    constexpr int kSide = 48;
    const double turn_rad = glm::length(disk.turn);
    const glm::dvec3 other =
        std::abs(to_disk_.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 beside = glm::normalize(glm::cross(to_disk_, other));
    axis_ = turn_rad > 0.0 ? disk.turn / turn_rad : beside;
    const glm::dvec3 towards = axis_ - glm::dot(axis_, to_disk_) * to_disk_;
    const double sine = glm::length(towards);  // > 0: sun and moon do not stand at a celestial pole
    towards_axis_ = towards / sine;
    down_rad_ = 2.0 * disk.around_rad / kSide;
    across_rad_ = down_rad_ / sine;
    rows_ = kSide;
    columns_ = kSide + static_cast<int>(std::ceil(turn_rad / across_rad_));
  }

  [[nodiscard]] int size() const { return columns_ * rows_; }
  /// Angle around the middle of the disk that contains all cells [rad].
  [[nodiscard]] double around_rad() const {
    return std::hypot(0.5 * columns_ * across_rad_, 0.5 * rows_ * down_rad_);
  }
  /// Width of a cell [rad].
  [[nodiscard]] double width_rad() const { return down_rad_; }
  /// Returns the direction of a point of a cell, in [0, 1) x [0, 1).
  [[nodiscard]] glm::dvec3 DirectionIn(int cell, const std::array<double, 2>& point) const {
    const double across = (cell % columns_ + point[0] - 0.5 * columns_) * across_rad_;
    const double towards = TowardsAxis(cell, point[1]);
    return TurnedAbout(axis_, across,
                       std::cos(towards) * to_disk_ + std::sin(towards) * towards_axis_);
  }
  /// Returns the solid angle of a cell [sr].
  [[nodiscard]] double SolidAngleOf(int cell) const {
    const double towards = TowardsAxis(cell, 0.5);
    const glm::dvec3 in_row = std::cos(towards) * to_disk_ + std::sin(towards) * towards_axis_;
    return across_rad_ * down_rad_ * glm::length(glm::cross(axis_, in_row));
  }
  /// Returns the samples of the picture, of the lens and of the time that belong to a cell.
  [[nodiscard]] PixelSamples SamplesOf(int cell, int count) const {
    return {cell % columns_, cell / columns_, count};
  }

 private:
  [[nodiscard]] double TowardsAxis(int cell, double point) const {
    return (cell / columns_ + point - 0.5 * rows_) * down_rad_;
  }

  glm::dvec3 to_disk_, axis_{0.0}, towards_axis_{0.0};
  double across_rad_ = 0.0, down_rad_ = 0.0;  // of a cell; across: around the axis
  int columns_ = 0, rows_ = 0;
};

SmallDisk::SmallDisk(const MovingCamera& camera, const PixelFilter& filter, int width, int height,
                     const DiskInSky& disk)
    : width_(width), height_(height), spread_(width, height) {
  const Grid grid(disk);
  if (!camera.MaySee(disk.to_disk, grid.around_rad(), filter.radius())) return;
  for (int cell = 0; cell < grid.size(); ++cell) AddCell(camera, filter, disk, grid, cell);
}

namespace {

/// Returns the number of samples of a cell around a point of the picture, a power of 2: each covers
/// half a pixel at most, and blurred cells share the places of the blur among them.
int SamplesOfCell(const MovingCamera& camera, const ArrivingRay& middle, double width_rad) {
  constexpr double kPerPixel = 2.0;
  constexpr unsigned kBlurred = 64;
  const auto [across_rad, down_rad] = camera.middle().PixelExtentAt(middle.x, middle.y);
  const double pixel_rad = std::max(std::min(across_rad, down_rad), 1e-9);
  const double side = std::clamp(std::ceil(kPerPixel * width_rad / pixel_rad), 1.0, 32.0);
  const auto fine = static_cast<unsigned>(side * side);
  const bool is_blurred = camera.IsMoving() || camera.middle().HasLens();
  return static_cast<int>(std::bit_ceil(is_blurred ? std::max(fine, kBlurred) : fine));
}

bool IsDark(const BandLight& light) {
  return std::all_of(light.value.begin(), light.value.begin() + static_cast<int>(light.count),
                     [](float band) { return band <= 0.0F; });
}

}  // namespace

void SmallDisk::AddCell(const MovingCamera& camera, const PixelFilter& filter,
                        const DiskInSky& disk, const Grid& grid, int cell) {
  constexpr std::array kMiddle{0.5, 0.5};
  const glm::dvec3 middle = grid.DirectionIn(cell, kMiddle);
  const auto seen = camera.middle().RayFrom(middle, kMiddle);
  if (!seen && !camera.IsMoving()) return;
  const int count =
      seen ? SamplesOfCell(camera, *seen, grid.width_rad()) : PixelSamples::kMostSamples;
  const PixelSamples samples = grid.SamplesOf(cell, count);
  std::optional<BandLight> share;  // of a sample, known when the first of them is seen
  for (int i = 0; i < count; ++i) {
    const auto of = [&](SampleOf decision) {
      return count == 1 ? kMiddle : samples.Point(i, decision);
    };
    const CameraRays& then =
        camera.IsMoving() ? camera.At(of(SampleOf::kTime)[0]) : camera.middle();
    const auto ray =
        then.RayFrom(grid.DirectionIn(cell, of(SampleOf::kPixel)), of(SampleOf::kLens));
    const double reach = filter.radius();
    if (!ray || ray->x < -reach || ray->x > width_ + reach || ray->y < -reach ||
        ray->y > height_ + reach || !disk.is_open(ray->ray))
      continue;
    if (!share) share = static_cast<float>(grid.SolidAngleOf(cell) / count) * disk.radiance(middle);
    if (IsDark(*share)) return;
    Spread(camera.middle(), filter, *ray, *share);
  }
}

// The weights of the pixels around a point are scaled so that they sum to one: the illuminance in
// the picture is that of the disk.
void SmallDisk::Spread(const CameraRays& camera, const PixelFilter& filter, const ArrivingRay& at,
                       const BandLight& irradiance) {
  constexpr int kReach = 2;
  using Weights = std::array<double, 2 * kReach + 1>;
  const auto weights_around = [&](double place) {
    Weights weights{};
    double sum = 0.0;
    for (int i = -kReach; i <= kReach; ++i) {
      const double off = place - std::floor(place) - i - 0.5;
      if (std::abs(off) > filter.radius()) continue;
      sum += weights.at(static_cast<std::size_t>(i + kReach)) = filter.Weight(off);
    }
    for (double& weight : weights) weight /= sum;
    return weights;
  };
  const Weights across = weights_around(at.x), down = weights_around(at.y);
  for (int j = -kReach; j <= kReach; ++j) {
    for (int i = -kReach; i <= kReach; ++i) {
      const double weight = across.at(static_cast<std::size_t>(i + kReach)) *
                            down.at(static_cast<std::size_t>(j + kReach));
      if (weight == 0.0) continue;
      spread_.Add(camera, static_cast<int>(std::floor(at.x)) + i,
                  static_cast<int>(std::floor(at.y)) + j, static_cast<float>(weight) * irradiance);
    }
  }
}

namespace {

// Returns the angular radius around a pixel that must be free of ground and disks: a ray counts for
// pixels up to a filter's width away, and two pixels cover features between the azimuths of the
// skyline.
double AroundPixel(const FrameContext& frame) {
  return (4.0 * frame.filter().radius() + 2.0) * frame.camera().PixelAngle();
}

}  // namespace

UnoccludedSkyPixels::UnoccludedSkyPixels(const PixelShader& shader)
    : frame_(shader.frame()), around_rad_(AroundPixel(frame_)) {
  const CameraRays& camera = frame_.camera();
  const PreparedScene& scene = frame_.scene();
  const bool is_solid = scene.ground().is_solid || !scene.geometry().HasTerrain();
  if (!frame_.settings().skips_open_sky || !is_solid || camera.HasLens() ||
      frame_.moving().IsMoving())
    return;
  const glm::dvec3 up = scene.geometry().UpAt(camera.eye());
  const auto sees_sky = [&](const glm::dvec3& direction) {
    return shader.Trace({camera.eye(), camera.eye(), direction, direction}).kind == HitKind::kSky;
  };
  skyline_.emplace(up, ArcAround(up), 0.5 * camera.PixelAngle(), sees_sky);
}

Skyline::Arc UnoccludedSkyPixels::ArcAround(const glm::dvec3& up) const {
  const CameraRays& camera = frame_.camera();
  const int width = frame_.settings().width, height = frame_.settings().height;
  const Skyline::Arc whole{0.0, 2.0 * kPi};
  const auto shows = [&](const glm::dvec3& direction) {
    const auto at = camera.PlaceOf(direction);
    return at && (*at)[0] >= 0.0 && (*at)[0] <= width && (*at)[1] >= 0.0 && (*at)[1] <= height;
  };
  if (camera.IsPanorama() || shows(up) || shows(-up)) return whole;
  const glm::dvec3 middle = camera.Direction(0.5 * width, 0.5 * height);
  const glm::dvec3 ahead = middle - glm::dot(middle, up) * up, side = glm::cross(up, ahead);
  double first = 0.0, last = 0.0;
  constexpr int kPlaces = 64;
  constexpr double kAndSteps = 1.1;  // margin for the azimuth steps of the skyline
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = static_cast<double>(i) / kPlaces * width;
    const double y = static_cast<double>(i) / kPlaces * height;
    for (const glm::dvec3& direction : {camera.Direction(x, 0.0), camera.Direction(x, height),
                                        camera.Direction(0.0, y), camera.Direction(width, y)}) {
      const double azimuth = std::atan2(glm::dot(direction, side), glm::dot(direction, ahead));
      const double across = glm::length(direction - glm::dot(direction, up) * up);
      const double beside = std::asin(std::min(std::sin(kAndSteps * around_rad_) / across, 1.0));
      first = std::min(first, azimuth - beside);
      last = std::max(last, azimuth + beside);
    }
  }
  // If the zenith or nadir is just outside the picture, the azimuth can turn by more than half a
  // circle between two places of the border.
  if (last - first > kPi) return whole;
  return {Skyline::AzimuthOf(ahead, up) + first, last - first};
}

bool UnoccludedSkyPixels::Has(int x, int y) const {
  if (!skyline_) return false;
  const glm::dvec3 middle = frame_.camera().Direction(x + 0.5, y + 0.5);
  if (frame_.limb().IsSteepAt(middle)) return false;
  const auto is_near = [&](const glm::dvec3& to_disk, double radius_rad) {
    return glm::length(middle - to_disk) < 2.0 * radius_rad + around_rad_;
  };
  const Lighting& light = frame_.light();
  if (is_near(light.source.direction.seen, light.source.radius_rad)) return false;
  if (light.moon &&
      is_near(light.moon->direction.seen, light.moon->radius_rad + glm::length(light.moon_turn)))
    return false;
  return skyline_->IsBelow(middle, around_rad_);
}

}  // namespace alpenglow::renderer
