// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

glm::dvec2 OnCircle(double angle) { return {std::cos(angle), std::sin(angle)}; }

constexpr double kGaussianRadius = 1.5;
constexpr double kGaussianSigma = 0.5;
constexpr double kBlackmanHarrisRadius = 1.5;
// Four terms, side lobes below -92 dB: Harris (1978), Proc. IEEE 66, 51, table I.
constexpr std::array<double, 4> kBlackmanHarris{0.35875, 0.48829, 0.14128, 0.01168};

double RadiusOf(PixelFilter::Kind kind) {
  switch (kind) {
    case PixelFilter::Kind::kBox:
      return 0.5;
    case PixelFilter::Kind::kGaussian:
      return kGaussianRadius;
    case PixelFilter::Kind::kBlackmanHarris:
      return kBlackmanHarrisRadius;
  }
  throw InternalError("unknown kind of filter");
}

constexpr int kKnots = 513;       // of the inverse distribution, linear in between
constexpr int kFilterSteps = 16;  // of the midpoint rule between two points of the distribution

constexpr EnumNames kPixelFilters{{std::pair{PixelFilter::Kind::kBox, "box"},
                                   {PixelFilter::Kind::kGaussian, "gaussian"},
                                   {PixelFilter::Kind::kBlackmanHarris, "blackman-harris"}}};

/// The finaliser of MurmurHash3 (Appleby): every bit of the result depends on every bit.
std::uint32_t Mixed(std::uint32_t h) {
  h = (h ^ (h >> 16U)) * 0x85EBCA6BU;
  h = (h ^ (h >> 13U)) * 0xC2B2AE35U;
  return h ^ (h >> 16U);
}

std::uint32_t Mirrored(std::uint32_t bits) {
  bits = ((bits & 0x55555555U) << 1U) | ((bits >> 1U) & 0x55555555U);
  bits = ((bits & 0x33333333U) << 2U) | ((bits >> 2U) & 0x33333333U);
  bits = ((bits & 0x0F0F0F0FU) << 4U) | ((bits >> 4U) & 0x0F0F0F0FU);
  bits = ((bits & 0x00FF00FFU) << 8U) | ((bits >> 8U) & 0x00FF00FFU);
  return (bits << 16U) | (bits >> 16U);
}

/// Flips each bit by a hash of the lower bits. The factors are those of Laine and Karras (2011),
/// section 3.1; all are even, so that no information passes from high bits to low ones.
std::uint32_t ScrambledUpwards(std::uint32_t bits, std::uint32_t seed) {
  bits += seed;
  for (const std::uint32_t factor : {0x6C50B47CU, 0xB82F1E52U, 0xC7AFE638U, 0x8D22F6E6U}) {
    bits ^= bits * factor;
  }
  return bits;
}

/// Applies nested uniform scrambling: flips each bit by a hash of the higher bits.
std::uint32_t Scrambled(std::uint32_t bits, std::uint32_t seed) {
  return Mirrored(ScrambledUpwards(Mirrored(bits), seed));
}

/// Returns dimension 1 of Sobol's sequence, bit-reversed (dimension 0, bit-reversed, is the index
/// itself). Its direction numbers are the rows of Pascal's triangle modulo 2, in which C(j, i) is
/// odd if the bits of i are a subset of those of j (Lucas). Bit i is therefore the sum of all bits
/// j of the index whose j contains the bits of i; each line handles one of the five bits of i and
/// j.
std::uint32_t MirroredSobolSecond(std::uint32_t index) {
  index ^= (index >> 1U) & 0x55555555U;
  index ^= (index >> 2U) & 0x33333333U;
  index ^= (index >> 4U) & 0x0F0F0F0FU;
  index ^= (index >> 8U) & 0x00FF00FFU;
  return index ^ (index >> 16U);
}

/// Moves the bits of x to even positions: half of a Morton code.
std::uint32_t SpreadBits(std::uint32_t x) {
  x = (x | (x << 4U)) & 0x0F0FU;
  x = (x | (x << 2U)) & 0x3333U;
  return (x | (x << 1U)) & 0x5555U;
}

double InUnit(std::uint32_t bits) { return static_cast<double>(bits) / 4294967296.0; }

}  // namespace

Iris::Iris(int blades, double rotation_rad)
    : blades_(blades),
      rotation_rad_(rotation_rad),
      area_(blades == 0 ? kPi : 0.5 * blades * std::sin(2.0 * kPi / blades)) {}

// A disk is sampled in polar coordinates. A polygon is sampled as triangles around the centre: the
// first number selects a triangle and a position along its outer side.
glm::dvec2 Iris::Point(std::array<double, 2> unit) const {
  const double r = std::sqrt(unit[1]);
  if (blades_ == 0) return r * OnCircle(2.0 * kPi * unit[0]);
  const double side = unit[0] * blades_;
  const double corner = std::min(std::floor(side), blades_ - 1.0);
  const double step = 2.0 * kPi / blades_;
  const double share = side - corner;
  return r * ((1.0 - share) * OnCircle(rotation_rad_ + corner * step) +
              share * OnCircle(rotation_rad_ + (corner + 1.0) * step));
}

double Iris::EdgeTowards(const glm::dvec2& direction) const {
  if (blades_ == 0) return 1.0;
  const double half = kPi / blades_;
  const double turn = std::atan2(direction.y, direction.x) - rotation_rad_ - half;
  return std::cos(half) / std::cos(std::remainder(turn, 2.0 * half));
}

double PixelFilter::Shape(double x) const {
  if (!(std::abs(x) < radius_)) return 0.0;
  switch (kind_) {
    case Kind::kBox:
      return 1.0;
    case Kind::kGaussian: {
      constexpr double kTwice = 2.0 * kGaussianSigma * kGaussianSigma;
      return std::exp(-x * x / kTwice) - std::exp(-radius_ * radius_ / kTwice);
    }
    case Kind::kBlackmanHarris: {
      double sum = 0.0;
      for (std::size_t k = 0; k < kBlackmanHarris.size(); ++k) {
        sum += kBlackmanHarris[k] * std::cos(static_cast<double>(k) * kPi * x / radius_);
      }
      return sum;
    }
  }
  throw InternalError("unknown kind of filter");
}

PixelFilter::PixelFilter(Kind kind) : kind_(kind), radius_(RadiusOf(kind)), integral_(1.0) {
  // Tabulate the distribution over positive x, then invert it.
  std::vector<double> below{0.0};
  const double step = radius_ / (kKnots - 1);
  for (int i = 1; i < kKnots; ++i) {
    double area = 0.0;
    for (int k = 0; k < kFilterSteps; ++k) area += Shape(step * (i - 1 + (k + 0.5) / kFilterSteps));
    below.push_back(below.back() + area * step / kFilterSteps);
  }
  const double half = below.back();
  integral_ = 2.0 * half;
  for (int i = 0; i < kKnots; ++i) {
    const double wanted = half * i / (kKnots - 1);
    const auto above = std::clamp(std::upper_bound(below.begin(), below.end(), wanted),
                                  below.begin() + 1, below.end() - 1);
    const double low = *(above - 1), high = *above;
    const double share = high > low ? std::clamp((wanted - low) / (high - low), 0.0, 1.0) : 0.0;
    offsets_.push_back(step * (static_cast<double>(above - 1 - below.begin()) + share));
  }
}

double PixelFilter::Offset(double u) const {
  const double at = std::abs(2.0 * u - 1.0) * (kKnots - 1);
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kKnots - 2));
  const double share = at - static_cast<double>(i);
  const double offset = (1.0 - share) * offsets_[i] + share * offsets_[i + 1];
  return u < 0.5 ? -offset : offset;
}

double PixelFilter::Weight(double x) const { return Shape(x) / integral_; }

std::vector<std::string> PixelFilterNames() { return kPixelFilters.All(); }

PixelFilter::Kind PixelFilterFromName(std::string_view name) {
  return kPixelFilters.Named(name, "filter \"{}\" is not one of {}");
}

std::string NameOf(PixelFilter::Kind kind) { return kPixelFilters.Of(kind); }

PixelSamples::PixelSamples(int x, int y, int samples_per_pixel) {
  ALPENGLOW_ENSURE(samples_per_pixel, <=, kMostSamples);
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  constexpr auto kSide = static_cast<std::uint32_t>(kTile);
  tile_ = Mixed(Mixed(column / kSide) + 0x9E3779B9U * (row / kSide) + 1U);
  const std::uint32_t place = SpreadBits(column % kSide) | (SpreadBits(row % kSide) << 1U);
  first_ = place * std::bit_ceil(static_cast<std::uint32_t>(samples_per_pixel));
}

std::array<double, 2> PixelSamples::Point(int sample, SampleOf decision) const {
  const std::uint32_t seed = Mixed(tile_ + 0x85EBCA77U * static_cast<std::uint32_t>(decision));
  const std::uint32_t index = Scrambled(first_ + static_cast<std::uint32_t>(sample), seed);
  return {InUnit(Mirrored(ScrambledUpwards(index, Mixed(seed + 1U)))),
          InUnit(Mirrored(ScrambledUpwards(MirroredSobolSecond(index), Mixed(seed + 2U))))};
}

CameraRays::CameraRays(const Camera& camera, int width, int height, const FrameTransform& from_eye)
    : width_(width),
      height_(height),
      panorama_(camera.IsPanorama()),
      tangent_(std::tan(0.5 * camera.fov_rad)),
      eye_(from_eye.origin_m()),
      polariser_rad_(camera.polariser_rad) {
  const ViewAxes axes = AxesFromAngles(camera.heading_rad, camera.pitch_rad, camera.roll_rad);
  axes_ = {from_eye.Along(axes.right), from_eye.Along(axes.up), from_eye.Along(axes.forward)};
  if (camera.lens && !panorama_) {
    const ThinLens& lens = *camera.lens;
    lens_ = Lens{Iris(lens.blades, lens.blade_rotation_rad),
                 0.5 * lens.focal_length_m / lens.f_number, lens.focus_m};
  }
}

glm::dvec3 CameraRays::Direction(double x, double y) const {
  if (panorama_) {
    const double azimuth = (x / width_ - 0.5) * 2.0 * kPi;
    const double elevation = (0.5 - y / height_) * kPi;
    return std::cos(elevation) *
               (std::cos(azimuth) * axes_.forward + std::sin(azimuth) * axes_.right) +
           std::sin(elevation) * axes_.up;
  }
  const double scale = 2.0 * tangent_ / width_;
  return glm::normalize(axes_.forward + (x - 0.5 * width_) * scale * axes_.right +
                        (0.5 * height_ - y) * scale * axes_.up);
}

CameraRay CameraRays::MiddleRay(double x, double y) const {
  const glm::dvec3 direction = Direction(x, y);
  return {eye_, eye_, direction, direction};
}

CameraRay CameraRays::Ray(double x, double y, std::array<double, 2> lens) const {
  if (!lens_) return MiddleRay(x, y);
  const glm::dvec3 through = Direction(x, y);
  const glm::dvec2 point = lens_->radius_m * lens_->iris.Point(lens);
  const glm::dvec3 offset = point.x * axes_.right + point.y * axes_.up;
  const glm::dvec3 in_focus = lens_->focus_m / glm::dot(through, axes_.forward) * through;
  return {eye_, eye_ + offset, glm::normalize(in_focus - offset), through};
}

std::optional<std::array<double, 2>> CameraRays::PlaceOf(const glm::dvec3& direction) const {
  const double ahead = glm::dot(direction, axes_.forward);
  const double right = glm::dot(direction, axes_.right), up = glm::dot(direction, axes_.up);
  if (panorama_) {
    const double elevation = std::asin(std::clamp(up / glm::length(direction), -1.0, 1.0));
    return std::array{width_ * (0.5 + std::atan2(right, ahead) / (2.0 * kPi)),
                      height_ * (0.5 - elevation / kPi)};
  }
  if (ahead <= 0.0) return std::nullopt;
  const double scale = 2.0 * tangent_ / width_;
  return std::array{0.5 * width_ + right / (ahead * scale), 0.5 * height_ - up / (ahead * scale)};
}

std::optional<ArrivingRay> CameraRays::RayFrom(const glm::dvec3& direction,
                                               std::array<double, 2> lens) const {
  glm::dvec3 offset(0.0), through = direction;
  if (lens_) {
    const double ahead = glm::dot(direction, axes_.forward);
    if (ahead <= 0.0) return std::nullopt;
    const glm::dvec2 point = lens_->radius_m * lens_->iris.Point(lens);
    offset = point.x * axes_.right + point.y * axes_.up;
    through = glm::normalize(offset + lens_->focus_m / ahead * direction);
  }
  const auto place = PlaceOf(through);
  if (!place) return std::nullopt;
  return ArrivingRay{{eye_, eye_ + offset, direction, through}, (*place)[0], (*place)[1]};
}

// An eighth of the pixel is measured, because the two sides of a pixel that holds a whole panorama
// are one direction.
CameraRays::PixelExtent CameraRays::PixelExtentAt(double x, double y) const {
  constexpr double kHalf = 0.0625, kPixels = 1.0 / (2.0 * kHalf);
  return {kPixels * glm::length(Direction(x + kHalf, y) - Direction(x - kHalf, y)),
          kPixels * glm::length(Direction(x, y + kHalf) - Direction(x, y - kHalf))};
}

// A rectangle of the plane one unit ahead, from the foot of the eye to (x, y), has the solid angle
// atan(x y / sqrt(1 + x^2 + y^2)).
double CameraRays::PixelSolidAngle(int column, int row) const {
  if (panorama_) {
    const double top = (0.5 - static_cast<double>(row) / height_) * kPi;
    return 2.0 * kPi / width_ * (std::sin(top) - std::sin(top - kPi / height_));
  }
  const double scale = 2.0 * tangent_ / width_;
  const double left = (column - 0.5 * width_) * scale, upper = (row - 0.5 * height_) * scale;
  const auto from_foot = [](double x, double y) {
    return std::atan(x * y / std::sqrt(1.0 + x * x + y * y));
  };
  return from_foot(left + scale, upper + scale) - from_foot(left, upper + scale) -
         from_foot(left + scale, upper) + from_foot(left, upper);
}

ViewAxes CameraRays::AxesAt(const glm::dvec3& direction) const {
  const glm::dvec3 level = panorama_ ? glm::cross(direction, axes_.up) : axes_.right;
  const glm::dvec3 up = glm::normalize(glm::cross(level, direction));
  return {glm::cross(direction, up), up, direction};
}

std::optional<glm::dvec3> CameraRays::PassedBy(const glm::dvec3& direction) const {
  if (!polariser_rad_) return std::nullopt;
  const double cosine = std::cos(*polariser_rad_), sine = std::sin(*polariser_rad_);
  if (panorama_) {
    const ViewAxes axes = AxesAt(direction);
    return cosine * axes.up + sine * axes.right;
  }
  return glm::normalize(glm::cross(cosine * axes_.right - sine * axes_.up, direction));
}

// A ray from infinity meets the plane of the picture, one unit ahead, as far from the foot of its
// direction as the point of the lens divided by the distance in focus.
double CameraRays::WidestAngle(double beyond) const {
  if (panorama_) return kPi;
  const double scale = 2.0 * tangent_ / width_;
  const double corner = scale * std::hypot(0.5 * width_ + beyond, 0.5 * height_ + beyond);
  return std::atan(corner + (lens_ ? lens_->radius_m / lens_->focus_m : 0.0));
}

double CameraRays::AngleTo(const CameraRays& other) const { return AngleTo(other.axes_.forward); }

double CameraRays::AngleTo(const glm::dvec3& direction) const {
  return std::atan2(glm::length(glm::cross(axes_.forward, direction)),
                    glm::dot(axes_.forward, direction));
}

double CameraRays::PixelAngle() const {
  return panorama_ ? 2.0 * kPi / width_ : 2.0 * tangent_ / width_;
}

double CameraRays::BlurRadius(const glm::dvec3& offset) const {
  const double depth_m = glm::dot(offset, axes_.forward);
  if (!lens_ || !(depth_m > 0.0)) return 0.0;
  return lens_->radius_m * std::abs(1.0 / depth_m - 1.0 / lens_->focus_m);
}

std::optional<CameraRays::Blur> CameraRays::BlurAt(const glm::dvec3& offset,
                                                   const glm::dvec3& through,
                                                   double soft_radius) const {
  const double depth_m = glm::dot(offset, axes_.forward);
  const double ahead = glm::dot(through, axes_.forward);
  if (!(depth_m > 0.0) || !(ahead > 0.0)) return std::nullopt;
  const glm::dvec2 point(glm::dot(offset, axes_.right) / depth_m,
                         glm::dot(offset, axes_.up) / depth_m);
  const glm::dvec2 seen(glm::dot(through, axes_.right) / ahead,
                        glm::dot(through, axes_.up) / ahead);
  const double unsharpness = 1.0 / depth_m - 1.0 / lens_->focus_m;  // signed
  const double blur = lens_->radius_m * std::abs(unsharpness);
  // The line from the point in focus to this one meets the lens at (point - seen) / (1/z - 1/s).
  const glm::dvec2 apart = (unsharpness > 0.0 ? 1.0 : -1.0) * (point - seen);
  const double edge = lens_->iris.EdgeTowards(apart);
  const double outer = blur + soft_radius;
  const double t = glm::length(apart) / (outer * edge);
  if (t >= 1.0) return std::nullopt;
  // The profile has half of its height at the geometric edge of the blur when the blur is much
  // wider than the softening.
  const double n = 1.0 + 0.614 * blur / soft_radius;
  // Convert an area in the plane one metre ahead to solid angle.
  const double area = lens_->iris.area() * outer * outer * ahead * ahead * ahead;
  const double mean = 1.0 - 2.0 / (n + 1.0) + 1.0 / (2.0 * n + 1.0);
  const double falloff = 1.0 - std::pow(t, 2.0 * n);
  const double reach = lens_->radius_m / outer;  // lens radius per unit of blur
  const glm::dvec2 on_lens = reach * apart;
  return Blur{on_lens.x * axes_.right + on_lens.y * axes_.up, falloff * falloff / (area * mean)};
}

CameraRays Between(const CameraRays& from, const CameraRays& to, double share) {
  CameraRays between = from;
  const auto mixed = [&](const auto& a, const auto& b) { return (1.0 - share) * a + share * b; };
  between.eye_ = mixed(from.eye_, to.eye_);
  between.tangent_ = mixed(from.tangent_, to.tangent_);
  between.axes_.forward = glm::normalize(mixed(from.axes_.forward, to.axes_.forward));
  between.axes_.right =
      glm::normalize(glm::cross(between.axes_.forward, mixed(from.axes_.up, to.axes_.up)));
  between.axes_.up = glm::cross(between.axes_.right, between.axes_.forward);
  return between;
}

MovingCamera::MovingCamera(std::vector<CameraRays> steps) : steps_(std::move(steps)) {
  ALPENGLOW_ENSURE(steps_.size(), >=, std::size_t{1});
}

CameraRays MovingCamera::At(double time) const {
  if (!IsMoving()) return steps_.front();
  const double at = time * static_cast<double>(steps_.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), steps_.size() - 2);
  return Between(steps_[i], steps_[i + 1], at - static_cast<double>(i));
}

CameraRay MovingCamera::Ray(double x, double y, std::array<double, 2> lens, double time) const {
  return IsMoving() ? At(time).Ray(x, y, lens) : steps_.front().Ray(x, y, lens);
}

// Between two steps the viewing direction stays on the arc between theirs, and the field of view
// between theirs.
bool MovingCamera::MaySee(const glm::dvec3& direction, double around_rad, double beyond) const {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const CameraRays& next = steps_[std::min(i + 1, steps_.size() - 1)];
    const double widest = std::max(steps_[i].WidestAngle(beyond), next.WidestAngle(beyond));
    if (steps_[i].AngleTo(direction) - steps_[i].AngleTo(next) <= widest + around_rad) return true;
  }
  return false;
}

}  // namespace alpenglow::renderer
