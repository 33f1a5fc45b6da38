// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "renderer/picture/pixel_shader.h"

namespace alpenglow::renderer {
namespace {

constexpr float kSameLight = 2e-3F;  // relative to SeenThrough(); absolute for transmittance
constexpr double kSameReach = 4e-3;  // bound of |r - 1| (1 - T)

/// Returns a lower bound of the radiance seen through the air: for sky, the light of the air
/// itself; for ground, the radiance that air of infinite depth would send, at most four times the
/// light of the air.
float SeenThrough(const AirAlongRay& air, HitKind kind, std::size_t band) {
  const float light = air.inscatter[band];
  if (kind == HitKind::kSky) return light;
  return std::min(light / std::max(1.0F - air.transmittance[band], 1e-6F), 4.0F * light);
}

bool Agree(const AirAlongRay& a, const AirAlongRay& b, HitKind kind) {
  for (std::size_t band = 0; band < a.inscatter.size(); ++band) {
    const float same = kSameLight * SeenThrough(a, kind, band);
    if (!(std::abs(a.inscatter[band] - b.inscatter[band]) <= same) ||
        !(std::abs(a.transmittance[band] - b.transmittance[band]) <= kSameLight)) {
      return false;
    }
    if (a.polarised && !(std::abs(a.polarised->q[band] - b.polarised->q[band]) <= same &&
                         std::abs(a.polarised->u[band] - b.polarised->u[band]) <= same)) {
      return false;
    }
  }
  return true;
}

/// Returns the air for a distance multiplied by `ratio`; no value where the distance changes too
/// much to extrapolate from the mean of the air.
std::optional<AirAlongRay> Reaching(AirAlongRay air, double ratio) {
  for (std::size_t band = 0; band < air.inscatter.size(); ++band) {
    const float left = air.transmittance[band];
    if (!(std::abs(ratio - 1.0) * static_cast<double>(1.0F - left) <= kSameReach))
      return std::nullopt;
    // T^r = T e^x with x = (r - 1) ln T. kSameReach keeps |x| below a hundredth where T > 0.2: the
    // quadratic series is then exact to 2e-7 of T.
    const float x = static_cast<float>(ratio - 1.0) * std::log(std::max(left, 1e-30F));
    const float then = left * (std::abs(x) < 0.01F ? 1.0F + x * (1.0F + 0.5F * x) : std::exp(x));
    const float hidden = 1.0F - left;
    const float grown = hidden > 1e-4F ? (1.0F - then) / hidden : static_cast<float>(ratio);
    air.inscatter[band] *= grown;
    if (air.polarised) {
      air.polarised->q[band] *= grown;
      air.polarised->u[band] *= grown;
    }
    air.transmittance[band] = then;
  }
  return air;
}

/// Returns an empty tile, for pictures without lamps.
const LampTile& DarkTile() {
  static const LampTile kDark;
  return kDark;
}

CameraRay RayOf(const PixelSamples& samples, int sample, const glm::dvec2& at,
                const FrameContext& frame) {
  std::array<double, 2> lens{};
  double time = 0.0;
  if (frame.camera().HasLens()) lens = samples.Point(sample, SampleOf::kLens);
  if (frame.moving().IsMoving()) time = samples.Point(sample, SampleOf::kTime)[0];
  return frame.moving().Ray(at.x, at.y, lens, time);
}

}  // namespace

AirInterpolationGrid::AirInterpolationGrid(const PixelShader& shader, int x0, int y0, int x1,
                                           int y1)
    : shader_(&shader),
      frame_(&shader.frame()),
      x0_(x0),
      y0_(y0),
      columns_((x1 - x0 + kCell - 1) / kCell),
      rows_((y1 - y0 + kCell - 1) / kCell),
      corners_(static_cast<std::size_t>((columns_ + 1) * (rows_ + 1))),
      cells_(static_cast<std::size_t>(columns_ * rows_), Cell::kUnknown) {}

AirInterpolationGrid::Corner AirInterpolationGrid::Computed(double x, double y) const {
  const CameraRay ray = frame_->camera().MiddleRay(x, y);
  const Hit hit = shader_->Trace(ray);
  SharedSegmentAir air = SharedSegmentAir::Of(hit, ray.through, *frame_);
  AddAir(*frame_, air);
  return {hit.kind, hit.distance_m, air.air};
}

const AirInterpolationGrid::Corner& AirInterpolationGrid::At(int column, int row) {
  std::optional<Corner>& corner = corners_[static_cast<std::size_t>(row * (columns_ + 1) + column)];
  if (!corner) corner = Computed(x0_ + kCell * column, y0_ + kCell * row);
  return *corner;
}

std::optional<AirAlongRay> AirInterpolationGrid::Between(int column, int row, double x, double y,
                                                         HitKind kind, double distance_m) {
  const double u = (x - x0_) / kCell - column, v = (y - y0_) / kCell - row;
  const std::array<double, 4> share{(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v};
  const std::size_t bands = frame_->scene().medium().wavelengths_nm.size();
  const auto add = [](float weight, const Spectrum& light, Spectrum& to) {
    for (std::size_t band = 0; band < to.size(); ++band) to[band] += weight * light[band];
  };
  AirAlongRay sum{Spectrum(bands), Spectrum(bands)};
  if (frame_->IsPolarised()) sum.polarised = {Spectrum(bands), Spectrum(bands)};
  double corners_m = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Corner& corner = At(column + i % 2, row + i / 2);
    if (corner.kind != kind) return std::nullopt;
    const auto weight = static_cast<float>(share.at(static_cast<std::size_t>(i)));
    add(weight, corner.air.inscatter, sum.inscatter);
    add(weight, corner.air.transmittance, sum.transmittance);
    if (sum.polarised) {
      add(weight, corner.air.polarised->q, sum.polarised->q);
      add(weight, corner.air.polarised->u, sum.polarised->u);
    }
    corners_m += share.at(static_cast<std::size_t>(i)) * corner.distance_m;
  }
  return kind == HitKind::kSky ? sum : Reaching(sum, distance_m / corners_m);
}

bool AirInterpolationGrid::IsShared(int column, int row) {
  Cell& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
  if (cell != Cell::kUnknown) return cell == Cell::kShared;
  cell = Cell::kRough;
  const HitKind kind = At(column, row).kind;
  for (int i = 1; i < 4; ++i) {
    if (At(column + i % 2, row + i / 2).kind != kind) return false;
  }
  const double x = x0_ + kCell * (column + 0.5), y = y0_ + kCell * (row + 0.5);
  const Corner middle = Computed(x, y);
  if (middle.kind != kind) return false;
  const auto told = Between(column, row, x, y, kind, middle.distance_m);
  if (told && Agree(middle.air, *told, kind)) cell = Cell::kShared;
  return cell == Cell::kShared;
}

std::optional<AirAlongRay> AirInterpolationGrid::Before(const SharedSegmentAir& rays) {
  const bool has_media = frame_->media() != nullptr || frame_->lights().front().clouds != nullptr;
  if (rays.kind == HitKind::kPlanet || has_media) return std::nullopt;
  const auto place = frame_->camera().PlaceOf(rays.direction_sum);
  if (!place) return std::nullopt;
  const auto [x, y] = *place;
  // Pixels around the rectangle use the cells at its edge.
  const auto cell = [](double along, int count) {
    return std::clamp(static_cast<int>(std::floor(along)), 0, count - 1);
  };
  const double across = (x - x0_) / kCell, down = (y - y0_) / kCell;
  if (across < -1.0 || down < -1.0 || across > columns_ + 1.0 || down > rows_ + 1.0)
    return std::nullopt;
  const int column = cell(across, columns_), row = cell(down, rows_);
  if (!IsShared(column, row)) return std::nullopt;
  return Between(column, row, x, y, rays.kind, rays.length_m());
}

PixelLight::PixelLight(const PixelShader& shader, int x, int y, int most_rays,
                       AirInterpolationGrid* around, double expected_m)
    : shader_(&shader),
      frame_(&shader.frame()),
      x_(x),
      y_(y),
      through_middle_(most_rays == 1),
      around_(around),
      last_m_(expected_m),
      samples_(x, y, most_rays),
      glow_(frame_->scene().medium().wavelengths_nm.size()) {}

PixelLight::Ray PixelLight::Traced(int sample) {
  glm::dvec2 offset(0.0);
  if (!through_middle_) {
    const auto [u, v] = samples_.Point(sample, SampleOf::kPixel);
    offset = {frame_->filter().Offset(u), frame_->filter().Offset(v)};
  }
  const CameraRay ray = RayOf(samples_, sample, glm::dvec2(x_ + 0.5, y_ + 0.5) + offset, *frame_);
  const Hit hit = shader_->Trace(ray, last_m_);
  if (hit.kind != HitKind::kSky) last_m_ = hit.distance_m;
  return {ray, hit, AirFor(hit, ray.through, *frame_, airs_), offset};
}

void PixelLight::AddNewAir(std::size_t known) {
  // The filter is symmetric, so the direction of the pixel's centre is the exact mean over all
  // rays. The mean over some of them is less accurate.
  if (airs_.size() == 1 && known == 0 && !frame_->moving().IsMoving()) {
    const glm::dvec3 middle = frame_->camera().Direction(x_ + 0.5, y_ + 0.5);
    if (airs_.front().MayLookAlong(middle, *frame_)) airs_.front().direction_sum = middle;
  }
  for (std::size_t i = known; i < airs_.size(); ++i) {
    const auto shared = around_ != nullptr ? around_->Before(airs_[i]) : std::nullopt;
    if (shared) {
      airs_[i].air = *shared;
      airs_[i].media = airs_[i].cloud_light = Spectrum(shared->inscatter.size());
    } else {
      AddAir(*frame_, airs_[i]);
    }
    AddLamps(*frame_, x_, y_, airs_[i]);
  }
}

void PixelLight::TakeUpTo(int rays) {
  if (rays <= sum_.rays) return;
  const std::size_t known = airs_.size();
  thread_local std::vector<Ray> more;  // buffer reused by all pixels of a thread
  more.clear();
  for (int sample = sum_.rays; sample < rays; ++sample) more.push_back(Traced(sample));
  AddNewAir(known);
  new_rays_.reserve(new_rays_.size() + more.size());
  for (const Ray& seen : more) Add(seen);
}

void PixelLight::TakeUnoccludedSky() {
  const CameraRay ray = frame_->camera().MiddleRay(x_ + 0.5, y_ + 0.5);
  const Ray seen{ray, {}, AirFor({}, ray.through, *frame_, airs_), glm::dvec2(0.0)};
  AddNewAir(0);
  Add(seen);
}

std::optional<Spectrum> PixelLight::LightOfPaths(const CameraRay& ray) {
  using atmosphere::reference::kPathsPerBatch;
  constexpr std::uint64_t kSeed = 1;
  const RenderSettings& settings = frame_->settings();
  if (!settings.paths) return std::nullopt;
  const int rays = settings.samples_per_pixel;
  const auto paths = static_cast<std::uint64_t>((*settings.paths + rays - 1) / rays);
  const auto pixel = static_cast<std::uint64_t>(y_) * 16384 + static_cast<std::uint64_t>(x_);
  Spectrum sum(glow_.size());
  for (std::uint64_t i = 0; i < paths; ++i) {
    const std::uint64_t path = static_cast<std::uint64_t>(sum_.rays) * paths + i;
    atmosphere::reference::PathRandom random(kSeed, pixel + (path / kPathsPerBatch << 32U),
                                             path % kPathsPerBatch);
    const Spectrum light = shader_->OnePath(ray, random);
    sum_.paths.Add(frame_->scene().colour().Xyz(light)[1]);
    sum = sum + light;
  }
  return (1.0F / static_cast<float>(paths)) * sum;
}

void PixelLight::Add(const Ray& seen) {
  const LampTile& near = frame_->plan().tiles.empty() ? DarkTile() : frame_->plan().At(x_, y_);
  const std::optional<Spectrum> traced = LightOfPaths(seen.ray);
  const Shaded shaded =
      shader_->Shade(seen.hit, airs_[seen.air], seen.ray, near,
                     samples_.Point(sum_.rays, SampleOf::kSunDisk), traced ? &*traced : nullptr);
  spread_.Add(frame_->scene().colour().LinearSrgb(shaded.radiance));
  const Spectrum glow = shaded.lamps + shaded.volumes + shaded.clouds;
  const bool sees_sky = seen.hit.kind == HitKind::kSky && !airs_[seen.air].is_alone;
  if (sees_sky && !sky_) sky_ = shaded.inscatter;
  Spectrum shared = shaded.radiance + -1.0F * glow;
  if (sees_sky) shared = shared + -1.0F * *sky_;
  new_rays_.push_back({seen.offset.x, seen.offset.y, shared, sees_sky});
  glow_ = glow_ + glow;
  sum_.Add(shaded, !frame_->settings().layers.empty());
}

}  // namespace alpenglow::renderer
