// SPDX-License-Identifier: MIT
// This header provides camera rays: the iris of a lens, the pixel filter, the sample sequence, and
// the rays of a still or moving camera.
//
// PixelFilter weights the samples of a pixel by w(x) w(y), a function of the distance to the
// pixel's centre.
//
// The weight is not a factor of the rays but their density: rays are distributed like the filter
// and all have equal weight (Ernst, Stamminger and Greiner 2006, "Filter importance sampling", IEEE
// Symposium on Interactive Ray Tracing). Pixels therefore exchange no data, and the filter must be
// positive everywhere; a positive filter does not ring at the edge of the sun.
//
//   box              1                                                     |x| < 1/2
//   gaussian         exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2)                 |x| < r
//   blackman-harris  sum a_k cos(k pi x / r), k = 0..3 (Harris 1978)       |x| < r
//
// On a zone plate, aliasing is measured at 1/2 to 3/2 cycles per pixel and kept power below 1/2:
//                    power that aliases   power kept   rise of an edge, 10 to 90 % [pixels]
//   box                     0.079            0.77          0.80
//   blackman-harris         0.019            0.63          1.08
//   gaussian                0.008            0.56          1.25
//
// PixelSamples generates the numbers in [0, 1) that choose a ray's position in the pixel, on the
// lens and on the sun's disk, and its time. They are identical on every machine and for any number
// of threads.
//
// Each of these choices uses its own pair of numbers: the first two dimensions of Sobol's sequence
// (1967), a (0,2)-sequence in base 2, with Owen's nested uniform scrambling (1995) by the hash of
// Laine and Karras (2011). The points are shuffled, so that the pairs of different choices are
// uncorrelated (padding; Burley 2020, "Practical hash-based Owen scrambling", JCGT 9(4)).
//
// Pixels take consecutive pieces of the sequence along Morton's curve: the points of a pixel form a
// net, and so do the points of an aligned square of 2, 4, ... pixels. The errors of neighbouring
// pixels therefore differ in sign (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of
// Monte Carlo sampling error via hierarchical ordering of pixels", ACM TOG 39(6)).
//
// CameraRays generates rays through the pixels of a camera, in the frame of the scene.
//
// A pinhole sends a ray along the direction d of a point of the picture. A thin lens of aperture
// A = f / N, focused at a distance s along the axis a, maps each point of the plane of focus to one
// point of the picture: the ray through any point of the iris goes to F = d s / (d a), like the ray
// through the centre of the iris. A point at depth z is blurred into the shape of the iris. In the
// plane one metre ahead, the blur has the radius
//
//   A / 2 |1 / z - 1 / s|,
//
// which on a sensor v = f s / (s - f) behind the lens is the circle of confusion of diameter
// A |z - s| / z f / (s - f). The field of view is that of the picture at v: a sensor of width
// 2 v tan(fov / 2). The brightness of the picture does not depend on the lens, because exposure is
// set in EV.
//
// A polariser before the lens is an ideal sheet that absorbs light along an axis b of its plane.
// For a ray d it transmits the component that vibrates along b x d; for oblique rays this is not
// the transmission axis seen in perspective (Korger et al. 2013, Opt. Express 21, 27032). No single
// sheet can cover a panorama, so there each direction has its own polariser, perpendicular to it.
//
// MovingCamera moves while its shutter is open, so that motion is blurred along its path.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/math/view_axes.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// The opening of a lens: a disk of radius 1, or a regular polygon inscribed in it.
class Iris {
 public:
  /// @param blades  0: round; otherwise at least 3.
  /// @param rotation_rad  of the first corner from the right, counterclockwise as seen from behind
  ///     the camera.
  explicit Iris(int blades = 0, double rotation_rad = 0.0);

  /// Returns a point of the opening, uniform in area when `unit` is uniform in the unit square.
  [[nodiscard]] glm::dvec2 Point(std::array<double, 2> unit) const;

  /// Returns the distance from the centre to the edge, along a vector that is not 0.
  [[nodiscard]] double EdgeTowards(const glm::dvec2& direction) const;

  [[nodiscard]] double area() const { return area_; }

 private:
  int blades_;
  double rotation_rad_;
  double area_;
};

class PixelFilter {
 public:
  enum class Kind { kBox, kGaussian, kBlackmanHarris };

  explicit PixelFilter(Kind kind);

  /// Returns the offset of a ray from the centre of its pixel along one axis [pixels]. It is
  /// distributed like the filter when `u` is uniform in [0, 1), and antisymmetric about 1/2.
  [[nodiscard]] double Offset(double u) const;

  /// Half-width of the filter [pixels].
  [[nodiscard]] double radius() const { return radius_; }

  /// Returns the filter at a distance from the centre [1/pixel]; its integral is 1.
  [[nodiscard]] double Weight(double x) const;

 private:
  [[nodiscard]] double Shape(double x) const;

  Kind kind_;
  double radius_;
  double integral_;              // of Shape
  std::vector<double> offsets_;  // at u = 1/2 + i / 2 (size - 1)
};

/// Throws InputError listing the valid names.
[[nodiscard]] PixelFilter::Kind PixelFilterFromName(std::string_view name);
[[nodiscard]] std::string NameOf(PixelFilter::Kind kind);
[[nodiscard]] std::vector<std::string> PixelFilterNames();

/// The choice that a pair of sample numbers makes.
enum class SampleOf : std::uint32_t { kPixel, kLens, kSunDisk, kTime };

class PixelSamples {
 public:
  /// Side of the square of pixels that shares one sequence.
  static constexpr int kTile = 256;
  static constexpr int kMostSamples = 1024;

  /// @param x, y  pixel coordinates, >= 0.
  /// @param samples_per_pixel  in [1, kMostSamples].
  PixelSamples(int x, int y, int samples_per_pixel);

  /// Returns two numbers in [0, 1). Of n = 2^k samples, exactly one lies in each of n equal
  /// intervals of either number, and in each of the n cells of every subdivision of the square into
  /// 2^j x 2^(k - j) rectangles.
  [[nodiscard]] std::array<double, 2> Point(int sample, SampleOf decision) const;

 private:
  std::uint32_t tile_;   // hash of the tile that the pixel lies in
  std::uint32_t first_;  // index of the pixel's first point
};

struct CameraRay {
  glm::dvec3 eye{0.0};        // centre of the lens
  glm::dvec3 origin{0.0};     // on the lens
  glm::dvec3 direction{0.0};  // unit
  glm::dvec3 through{0.0};    // unit, from the centre of the lens to the same point in focus
};

/// A ray that arrives from infinity, and the point of the picture that it lights.
struct ArrivingRay {
  CameraRay ray;
  double x, y;
};

/// Rays of a pinhole or thin lens (perspective), or of a panorama (latitude-longitude: the centre
/// looks along the heading, the left edge backwards).
class CameraRays {
 public:
  /// @param width, height  of the picture in pixels, >= 1. A panorama has no lens.
  /// @param from_eye  from east, north, up at the eye to the frame of the rays.
  CameraRays(const Camera& camera, int width, int height, const FrameTransform& from_eye = {});

  /// Returns the unit direction through a point of the picture and the centre of the lens: x in
  /// [0, width] to the right, y in [0, height] down.
  [[nodiscard]] glm::dvec3 Direction(double x, double y) const;

  /// Returns the ray from the eye along Direction(x, y).
  [[nodiscard]] CameraRay MiddleRay(double x, double y) const;

  /// Returns the ray through a point of the picture and a point of the lens.
  /// @param lens  uniform in the unit square; not used by a pinhole.
  [[nodiscard]] CameraRay Ray(double x, double y, std::array<double, 2> lens) const;

  /// Returns the point of the picture plane, possibly outside the picture, that a direction
  /// projects to; empty for directions behind a perspective camera.
  [[nodiscard]] std::optional<std::array<double, 2>> PlaceOf(const glm::dvec3& direction) const;

  /// Returns the ray from a direction through a point of the lens: the inverse of Ray, for a light
  /// at infinity. Empty for directions behind a perspective camera.
  [[nodiscard]] std::optional<ArrivingRay> RayFrom(const glm::dvec3& direction,
                                                   std::array<double, 2> lens) const;

  /// Returns the angles that a pixel around a point of the picture spans [rad].
  struct PixelExtent {
    double across_rad, down_rad;
  };
  [[nodiscard]] PixelExtent PixelExtentAt(double x, double y) const;

  /// Returns the solid angle of a pixel [sr].
  [[nodiscard]] double PixelSolidAngle(int column, int row) const;

  /// Returns the unit axes of the picture at a direction, which is their third.
  [[nodiscard]] ViewAxes AxesAt(const glm::dvec3& direction) const;

  /// Returns the unit vector along which light from a direction must vibrate to pass the polariser;
  /// empty without a polariser.
  [[nodiscard]] std::optional<glm::dvec3> PassedBy(const glm::dvec3& direction) const;

  /// Returns an angle around the viewing direction outside which no direction lights a point of the
  /// picture or up to `beyond` pixels beside it, through any point of the lens [rad]; pi: none.
  [[nodiscard]] double WidestAngle(double beyond) const;
  /// Returns the angle between the viewing directions of two cameras [rad].
  [[nodiscard]] double AngleTo(const CameraRays& other) const;
  /// Returns the angle between the viewing direction and a unit vector [rad].
  [[nodiscard]] double AngleTo(const glm::dvec3& direction) const;

  /// Angle between neighbouring pixels at the centre of the picture [rad].
  [[nodiscard]] double PixelAngle() const;

  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  [[nodiscard]] bool IsPanorama() const { return panorama_; }
  [[nodiscard]] bool HasLens() const { return lens_.has_value(); }
  [[nodiscard]] bool HasPolariser() const { return polariser_rad_.has_value(); }

  /// Returns the blur radius of a point in front of the lens, in the plane one metre ahead. It is 0
  /// for a pinhole and for points behind the lens.
  /// @param offset  of the point from the eye [m].
  [[nodiscard]] double BlurRadius(const glm::dvec3& offset) const;

  /// Position on the iris, and the spread of light from an out-of-focus point.
  struct Blur {
    glm::dvec3 on_lens;  // from the eye to the point of the lens that sees the point there
    double per_sr;       // fraction of the point's light; its integral over solid angle is 1
  };
  /// Returns the blur of a point, widened by `soft_radius` so that it never falls between pixels:
  /// (1 - t^2n)^2, where t is the relative distance from the centre, and n grows from 1 in focus as
  /// the edge becomes narrow compared with the blur. Empty outside the blur. Needs a lens.
  /// @param through  CameraRay::through.
  /// @param soft_radius  in the plane one metre ahead.
  [[nodiscard]] std::optional<Blur> BlurAt(const glm::dvec3& offset, const glm::dvec3& through,
                                           double soft_radius) const;

  /// Returns a camera between two cameras with the same picture and lens, `share` in [0, 1]. Their
  /// directions must be close, because they are interpolated linearly.
  friend CameraRays Between(const CameraRays& from, const CameraRays& to, double share);

 private:
  struct Lens {
    Iris iris;
    double radius_m;
    double focus_m;
  };

  int width_, height_;
  bool panorama_;
  double tangent_;  // tangent of half the horizontal field of view
  glm::dvec3 eye_;
  ViewAxes axes_;  // unit
  std::optional<Lens> lens_;
  std::optional<double> polariser_rad_;
};

class MovingCamera {
 public:
  /// A camera that does not move.
  MovingCamera(const CameraRays& camera) : steps_{camera} {}  // NOLINT: implicit on purpose
  /// @param steps  at least one: at equal time steps, the first when the shutter opens, the last
  ///     when it closes. Between them the camera moves linearly.
  explicit MovingCamera(std::vector<CameraRays> steps);

  [[nodiscard]] bool IsMoving() const { return steps_.size() > 1; }
  /// The camera halfway through the exposure.
  [[nodiscard]] const CameraRays& middle() const { return steps_[steps_.size() / 2]; }

  /// Returns the camera at a time during the exposure.
  /// @param time  in [0, 1): fraction of the time that the shutter is open.
  [[nodiscard]] CameraRays At(double time) const;

  /// Returns a ray as CameraRays::Ray does, at a time during the exposure.
  /// @param time  in [0, 1): fraction of the time that the shutter is open.
  [[nodiscard]] CameraRay Ray(double x, double y, std::array<double, 2> lens, double time) const;

  /// Returns false only if no direction within an angle of `direction` lights a point of the picture
  /// or up to `beyond` pixels beside it, at any time and through any point of the lens.
  [[nodiscard]] bool MaySee(const glm::dvec3& direction, double around_rad, double beyond) const;

 private:
  std::vector<CameraRays> steps_;
};

}  // namespace alpenglow::renderer
