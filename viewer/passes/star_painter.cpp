// SPDX-License-Identifier: MIT
#include "viewer/passes/star_painter.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/night_sky.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/star_pixels.h"
#include "viewer/gl/gl_context.h"
#include "viewer/passes/picture_programs.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

glm::vec4 FirstFour(const StarBell& bell) { return {bell[0], bell[1], bell[2], bell[3]}; }

// Returns the direction with the same azimuth that is raised by an angle.
glm::dvec3 Raised(const glm::dvec3& direction, double lift_rad) {
  const double sine = direction.z, cosine = std::sqrt(std::max(1.0 - sine * sine, 0.0));
  if (cosine == 0.0) return direction;  // nothing is raised in the zenith
  const double turn_sine = std::sin(lift_rad), turn_cosine = std::cos(lift_rad);
  const double level = turn_cosine - turn_sine * sine / cosine;
  return {level * direction.x, level * direction.y, sine * turn_cosine + cosine * turn_sine};
}

// Returns the angle by which one direction is higher than another.
double RiseFrom(const glm::dvec3& before, const glm::dvec3& now) {
  const auto cosine = [](double sine) { return std::sqrt(std::max(1.0 - sine * sine, 0.0)); };
  return std::asin(now.z * cosine(before.z) - before.z * cosine(now.z));
}

// The parabola goes through the refraction of the star's elevation and those 0.1 degrees above and
// below.
RefractedStar Refracted(const glm::dvec3& seen, const RefractedView& bent) {
  constexpr double kStep_rad = 0.1 * kRadiansPerDegree;
  const double elevation_rad = std::asin(std::clamp(seen.z, -1.0, 1.0));
  const auto lift = [&](double at_rad) { return at_rad - bent.TrueElevation(at_rad); };
  const double here = lift(elevation_rad);
  const double below = lift(elevation_rad - kStep_rad), above = lift(elevation_rad + kStep_rad);
  // Changes of the true elevation to the other two.
  const double fall = kStep_rad + below - here, rise = kStep_rad - above + here;
  const double slope_below = (here - below) / fall, slope_above = (above - here) / rise;
  const double curvature = (slope_above - slope_below) / (fall + rise);
  return {Raised(seen, -here), here, slope_below + curvature * fall, curvature};
}

/// The place of a star in a picture.
struct StarPlace {
  glm::dvec2 pixel;
  glm::dvec2 tangent;  // coordinates in the plane at distance 1 before the eye
  double along;        // cosine of the angle to the axis of the view
};

/// Pixels of a view in the plane at distance 1 before the eye.
class StarPlane {
 public:
  explicit StarPlane(const PaintedView& view)
      : axes_(AxesOf(view)),
        half_(glm::length(axes_.right), glm::length(axes_.up)),
        sides_(view.width, view.height),
        middle_(view.part.x * view.part.z, view.part.y * view.part.w),
        pixel_width_(2.0 * half_ / sides_),
        pixel_angle_(PixelAngle(view)) {}

  [[nodiscard]] const glm::dvec3& forward() const { return axes_.forward; }
  [[nodiscard]] double pixel_angle() const { return pixel_angle_; }

  /// Returns the place of a direction in the picture or within `margin` pixels of it.
  [[nodiscard]] std::optional<StarPlace> PlaceOf(const glm::dvec3& towards, double margin) const {
    const double along = glm::dot(towards, axes_.forward);
    if (along <= 1e-3) return std::nullopt;
    const glm::dvec2 tangent =
        glm::dvec2(glm::dot(towards, axes_.right), glm::dot(towards, axes_.up)) / (along * half_);
    const glm::dvec2 pixel = 0.5 * sides_ * (1.0 + tangent / half_ - middle_);
    const bool is_in = pixel.x > -margin && pixel.x < sides_.x + margin && pixel.y > -margin &&
                       pixel.y < sides_.y + margin;
    return is_in ? std::optional(StarPlace{pixel, tangent, along}) : std::nullopt;
  }

  /// Returns the cosine of the angle from the axis to the farthest place within `margin` pixels.
  [[nodiscard]] double LeastCosine(double margin) const {
    const glm::dvec2 corner = (glm::abs(middle_) + 1.0 + 2.0 * margin / sides_) * half_;
    return 1.0 / std::sqrt(1.0 + glm::dot(corner, corner));
  }

  /// Returns the weights of the pixels around a place, relative to the solid angle of each: it is
  /// proportional to the third power of the cosine to the axis of the view.
  [[nodiscard]] StarBell BellPerPixel(const StarPlace& at, glm::length_t axis) const {
    const double place = at.pixel[axis], tangent = at.tangent[axis];
    StarBell bell = StarBellAround(place);
    const double first = std::floor(place) - kStarReach + 0.5;
    for (std::size_t i = 0; i < bell.size(); ++i) {
      const double there = tangent + (first + static_cast<double>(i) - place) * pixel_width_[axis];
      const double change = at.along * at.along * (there * there - tangent * tangent);
      bell[i] *= (1.0 + change) * std::sqrt(1.0 + change);
    }
    return bell;
  }

  /// Returns the solid angle of a pixel. Pixels are squares on a plane at distance 1; off the axis
  /// they are oblique and farther away, which gives the factor along^3.
  [[nodiscard]] double PixelSolidAngle(double along) const {
    return pixel_angle_ * pixel_angle_ * along * along * along;
  }

 private:
  ViewAxes axes_;
  glm::dvec2 half_, sides_, middle_, pixel_width_;  // half_: of the picture's extent
  double pixel_angle_;
};

StarPoint PointOf(const StarLight& light, const glm::dvec3& towards, const StarPlace& at,
                  const StarPlane& plane) {
  const StarBell across = plane.BellPerPixel(at, 0), up = plane.BellPerPixel(at, 1);
  glm::vec4 radiance(0.0F);
  const auto per_sr = static_cast<float>(1.0 / plane.PixelSolidAngle(at.along));
  for (std::size_t band = 0; band < light.irradiance.size(); ++band)
    radiance[static_cast<glm::length_t>(band)] = per_sr * light.irradiance[band];
  const glm::dvec2 centre = glm::floor(at.pixel);
  return {{centre.x - kStarReach, centre.y - kStarReach, centre.x, centre.y},
          {glm::vec3(towards), 0.0F},
          radiance,
          FirstFour(across),
          FirstFour(up),
          {across[4], up[4], 0.0F, 0.0F}};
}

}  // namespace

StarList::StarList(std::vector<StarLight> lights, const RefractedView* bent)
    : lights_(std::move(lights)) {
  std::stable_sort(lights_.begin(), lights_.end(),
                   [](const StarLight& a, const StarLight& b) { return a.lux > b.lux; });
  directions_.reserve(lights_.size());
  refracted_.reserve(lights_.size());
  for (const StarLight& light : lights_) {
    directions_.push_back(light.direction);
    refracted_.push_back(bent == nullptr ? RefractedStar{light.direction, 0.0, 0.0, 0.0}
                                         : Refracted(light.direction, *bent));
  }
}

std::size_t StarList::CountDownTo(double faintest_lux) const {
  const auto end = std::partition_point(
      lights_.begin(), lights_.end(),
      [faintest_lux](const StarLight& light) { return light.lux >= faintest_lux; });
  return static_cast<std::size_t>(end - lights_.begin());
}

glm::dvec3 StarList::Towards(std::size_t star, const glm::dmat3& turn) const {
  const RefractedStar& before = refracted_[star];
  const glm::dvec3 truly = turn * before.truly;
  const double rise = RiseFrom(before.truly, truly);
  return Raised(truly, before.lift_rad + rise * (before.per_rise + rise * before.per_rise_squared));
}

std::vector<StarPoint> StarPointsIn(const PaintedView& view, const StarrySky& sky) {
  const StarPlane plane(view);
  // Stars just outside the picture may be raised into it by refraction.
  constexpr double kMostLift_rad = 0.1 * kRadiansPerDegree;
  const double reach = kStarReach + 2.0 * kMostLift_rad / plane.pixel_angle();
  const double least_cosine = plane.LeastCosine(reach);  // most stars are farther from the axis
  const glm::dvec3 forward_then = plane.forward() * sky.turn;  // turned back
  std::vector<StarPoint> points;
  const std::size_t count = sky.stars.CountDownTo(sky.faintest_lux);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3& before = sky.stars.directions()[i];
    if (glm::dot(before, forward_then) < least_cosine) continue;
    if (!plane.PlaceOf(sky.turn * before, reach)) continue;
    const StarLight& light = sky.stars.lights()[i];
    const glm::dvec3 towards = sky.stars.Towards(i, sky.turn);
    const auto at = plane.PlaceOf(towards, kStarReach);
    if (!at || glm::length(towards - sky.to_moon) < sky.moon_radius_rad) continue;
    points.push_back(PointOf(light, towards, *at, plane));
  }
  return points;
}

// Returns Rodrigues' rotation about the celestial pole, westwards.
glm::dmat3 TurnOfSky(double latitude_rad, double seconds) {
  constexpr double kSiderealDay_s = 86164.0905;
  const double angle = -2.0 * kPi * seconds / kSiderealDay_s;
  const glm::dvec3 pole(0.0, std::cos(latitude_rad), std::sin(latitude_rad));
  glm::dmat3 turn(1.0);
  for (const glm::length_t axis : {0, 1, 2}) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1.0;
    turn[axis] = std::cos(angle) * unit + std::sin(angle) * glm::cross(pole, unit) +
                 (1.0 - std::cos(angle)) * glm::dot(pole, unit) * pole;
  }
  return turn;
}

namespace {

// Limits for reusing a list: until then the sky rotates rigidly, with the refraction of the list.
constexpr double kMostTurn_s = 30.0, kMostWay_rad = 2e-4, kMostRise_m = 200.0;

const std::vector<VertexAttribute> kAttributes{{0, "star_corner"}, {1, "star_towards"},
                                               {2, "star_light"},  {3, "star_across"},
                                               {4, "star_up"},     {5, "star_last"}};

}  // namespace

StarPainter::StarPainter()
    : maker_(
          [](const Request& request) {
            constexpr double kAll = std::numeric_limits<double>::infinity();
            const RefractedView bent(request.air->medium(), request.place.height_m);
            return Made{
                request,
                {StarLightsOver(request.place, request.now, bent, *request.colour, kAll), &bent}};
          },
          Suits) {}

bool StarPainter::IsNight(const FrameSky& sky, const std::shared_ptr<const SolvedAir>& air) {
  constexpr double kNightSky_lux = 1e-3;
  sky_lux_ = 0.0;
  if (!air->medium().follows_wgs84) return false;  // stars are known for the Earth only
  const double lux = kNightSky_lux + sky.level_lux;
  if (lux > kDaylight_lux) return false;
  sky_lux_ = lux;
  if (!colour_ || colour_->wavelengths_nm() != air->medium().wavelengths_nm)
    colour_ = std::make_shared<const BandColour>(air->medium().wavelengths_nm);
  return true;
}

bool StarPainter::Suits(const Request& requested, const Request& wanted) {
  return requested.colour == wanted.colour &&
         std::abs(SecondsBetween(requested.now, wanted.now)) < kMostTurn_s &&
         std::abs(requested.place.latitude_rad() - wanted.place.latitude_rad()) < kMostWay_rad &&
         std::abs(requested.place.longitude_rad() - wanted.place.longitude_rad()) < kMostWay_rad &&
         std::abs(requested.place.height_m - wanted.place.height_m) < kMostRise_m;
}

void StarPainter::Follow(const PaintedView& view, const FrameSky& sky,
                         const std::shared_ptr<const SolvedAir>& air) {
  if (!IsNight(sky, air)) return;
  maker_.Update();
  maker_.RequestWhenIdle({view.eye.place, view.now, colour_, air});
}

void StarPainter::WaitUntilReady(const PaintedView& view, const FrameSky& sky,
                                 const std::shared_ptr<const SolvedAir>& air) {
  if (!IsNight(sky, air)) return;
  maker_.Forget();
  maker_.WaitUntilReady({view.eye.place, view.now, colour_, air});
  maker_.Update();
}

void StarPainter::Connect(const SceneMedia& media) {
  if (program_) return;
  std::vector<ShaderPiece> texts = AirTexts();
  for (ShaderPiece& piece : MediaTexts(media.kind())) texts.push_back(std::move(piece));
  program_.emplace(WithViewerPieces(std::move(texts), {"viewer/shaders/air/block.glsl",
                                                       "viewer/shaders/stars/star.vert.glsl"}),
                   WithViewerPieces({}, {"viewer/shaders/stars/star.frag.glsl"}), kAttributes);
  program_->BindBlock("Air", kAirBinding);
  program_->BindBlock("View", kViewBinding);
  program_->BindSampler("surface_map", kSurfaceUnit);
  AirTextures::Prepare(*program_, kAirUnit, kTablesBinding);
  media.Connect(*program_);
}

// A star is one point of 5 x 5 pixels. The viewport is larger than the picture by the reach of stars,
// since OpenGL omits points whose centres are outside.
void StarPainter::Draw(const std::vector<StarPoint>& points, const PaintedView& view,
                       Land land) const {
  glBindVertexArray(vertices_.id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(sizeof(StarPoint) * points.size()),
               points.data(), GL_DYNAMIC_DRAW);
  for (const VertexAttribute& attribute : kAttributes) {
    glEnableVertexAttribArray(attribute.location);
    glVertexAttribPointer(attribute.location, 4, GL_FLOAT, GL_FALSE, sizeof(StarPoint),
                          reinterpret_cast<const void*>(attribute.location * sizeof(glm::vec4)));
  }
  program_->Use();
  constexpr int kMargin = kStarReach + 1;
  const int width = view.width + 2 * kMargin, height = view.height + 2 * kMargin;
  glUniform3f(program_->Uniform("viewport"), static_cast<float>(width), static_cast<float>(height),
              static_cast<float>(kMargin));
  glUniform1i(program_->Uniform("surface_hides"), land == Land::kBySurface ? 1 : 0);
  glDepthFunc(GL_EQUAL);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glPointSize(static_cast<float>(2 * kStarReach + 1));
  glViewport(-kMargin, -kMargin, width, height);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points.size()));
  glViewport(0, 0, view.width, view.height);
  glDisable(GL_BLEND);
}

// The draw uses a star without light and size.
void StarPainter::MakeReady(const PaintedView& view, const SceneMedia& media) {
  if (program_) return;
  Connect(media);
  Draw({StarPoint{}}, view, Land::kBySurface);
}

std::vector<StarPoint> StarPainter::PointsIn(const PaintedView& view, const FrameSky& sky) const {
  if (!HasAny()) return {};
  const double faintest_lux = IlluminanceOf(FaintestStar(sky_lux_, PixelAngle(view)));
  const Made& made = maker_.value().value();
  const glm::dmat3 turn =
      TurnOfSky(view.eye.place.latitude_rad(), SecondsBetween(made.request.now, view.now));
  const MoonDisk moon = sky.moon.value_or(MoonDisk{});
  return StarPointsIn(view, {made.stars, turn, faintest_lux, moon.direction.seen, moon.radius_rad});
}

std::vector<PixelBox> StarPainter::Seen(const PaintedView& view, const FrameSky& sky) const {
  constexpr int kSide = 2 * kStarReach + 1;
  std::vector<PixelBox> boxes;
  for (const StarPoint& point : PointsIn(view, sky))
    boxes.push_back(
        {static_cast<int>(point.corner.x), static_cast<int>(point.corner.y), kSide, kSide});
  return boxes;
}

void StarPainter::Paint(const PaintedView& view, const FrameSky& sky, Land land,
                        const SceneMedia& media) {
  const std::vector<StarPoint> points = PointsIn(view, sky);
  if (points.empty()) return;
  Connect(media);
  Draw(points, view, land);
  CheckGl("StarPainter::Paint");
}

}  // namespace alpenglow::viewer
