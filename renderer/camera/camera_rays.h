// SPDX-License-Identifier: MIT
// The opening that lets light into a lens: round, or with straight blades.
//
// What a pixel sees of its surroundings: a weight w(x) w(y) over the distance to its middle.
//
// The weight is not multiplied onto rays but decides where they go: rays are distributed as the
// filter is, and count alike (Ernst, Stamminger and Greiner 2006, "Filter importance sampling",
// IEEE Symposium on Interactive Ray Tracing). That needs no exchange between pixels, and a filter
// that is positive everywhere: none of these rings at the edge of the sun.
//
//   box              1                                                     |x| < 1/2
//   gaussian         exp(-x^2 / 2 s^2) - exp(-r^2 / 2 s^2)                 |x| < r
//   blackman-harris  sum a_k cos(k pi x / r), k = 0..3 (Harris 1978)       |x| < r
//
// On a zone plate, of the frequencies from 1/2 to 3/2 cycles a pixel, and of those below 1/2:
//                    power that aliases   power kept   rise of an edge, 10 to 90 % [pixels]
//   box                     0.079            0.77          0.80
//   blackman-harris         0.019            0.63          1.08
//   gaussian                0.008            0.56          1.25
//
// Numbers in [0, 1) that decide a pixel's rays: where in the pixel, where on the lens, where on the
// sun's disk, when. The same on every machine and for any number of threads.
//
// Each decision has a pair of numbers of its own: the first two dimensions of Sobol's sequence
// (1967), a (0,2)-sequence in base 2, with Owen's nested uniform scrambling (1995) by the hash of
// Laine and Karras (2011), and its points in a shuffled order, so that the pairs are padded to each
// other without correlation (Burley 2020, "Practical hash-based Owen scrambling", JCGT 9(4)).
//
// Pixels take consecutive pieces of the sequence along Morton's curve: the points of a pixel are a
// net, and so are those of an aligned square of 2, 4, ... pixels, which makes the error of
// neighbours differ in sign (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte
// Carlo sampling error via hierarchical ordering of pixels", ACM TOG 39(6)).
//
// Rays through the pixels of a camera, in the frame of the scene.
//
// A pinhole sends a ray along the direction d of a point of the picture. A thin lens of aperture
// A = f / N in focus at a distance s along the axis a bends what comes from one point of the plane
// of focus to one point of the picture: the ray through a point of the iris goes to F = d s / (d a)
// as the one through its middle does. A point at depth z is spread over the shape of the iris, in
// the plane one metre ahead with the radius
//
//   A / 2 |1 / z - 1 / s|,
//
// which on a sensor v = f s / (s - f) behind the lens is the circle of confusion of diameter
// A |z - s| / z f / (s - f). The field of view is that of the picture at v: a sensor of width
// 2 v tan(fov / 2). How bright the picture is does not depend on the lens: exposure is set in EV.
//
// A polariser before the lens is an ideal sheet that absorbs light along an axis b of its plane. Of
// a ray d it passes what vibrates along b x d, which for oblique rays is not its transmission axis
// seen in perspective (Korger et al. 2013, Opt. Express 21, 27032). A panorama has none that could
// stand before all of it: there each direction is seen through its own, square to it.
//
// A camera while its shutter is open: what moves in that time is drawn along its way.
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

#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// A disk of radius 1, or a regular polygon inscribed in it.
class Iris {
 public:
  /// @param blades  0: round; else at least 3. @param rotation_rad  of the first corner from the
  ///     right, counterclockwise as seen from behind the camera.
  explicit Iris(int blades = 0, double rotation_rad = 0.0);

  /// A point of the opening, uniform in area when `unit` is uniform in the unit square.
  [[nodiscard]] glm::dvec2 Point(std::array<double, 2> unit) const;

  /// Distance of the edge from the middle, in the direction of a vector that is not 0.
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

  /// Distance of a ray from the middle of its pixel along one axis [pixels]: distributed as the
  /// filter when `u` is uniform in [0, 1), antisymmetric about 1/2.
  [[nodiscard]] double Offset(double u) const;

  /// Half its width [pixels].
  [[nodiscard]] double radius() const { return radius_; }

  /// Its value at a distance from the middle [1/pixel]; its integral is 1.
  [[nodiscard]] double Weight(double x) const;

 private:
  [[nodiscard]] double Shape(double x) const;

  Kind kind_;
  double radius_;
  double integral_;              // of Shape
  std::vector<double> offsets_;  // at u = 1/2 + i / 2 (size - 1)
};

/// Throws InputError listing the names.
[[nodiscard]] PixelFilter::Kind PixelFilterFromName(std::string_view name);
[[nodiscard]] std::string NameOf(PixelFilter::Kind kind);
[[nodiscard]] const std::vector<std::string>& PixelFilterNames();

/// What a pair of numbers decides.
enum class SampleOf : std::uint32_t { kPixel, kLens, kSunDisk, kTime };

class PixelSamples {
 public:
  /// Of a square of pixels with a sequence of its own.
  static constexpr int kTile = 256;
  static constexpr int kMostSamples = 1024;

  /// @param x, y  of the pixel, >= 0. @param samples_per_pixel  in [1, kMostSamples].
  PixelSamples(int x, int y, int samples_per_pixel);

  /// Both in [0, 1). Of n = 2^k samples, one lies in each of n equal parts of either number, and in
  /// each of the n parts of every subdivision of the square into 2^j x 2^(k - j) rectangles.
  [[nodiscard]] std::array<double, 2> Point(int sample, SampleOf decision) const;

 private:
  std::uint32_t tile_;   // hash of the tile that the pixel lies in
  std::uint32_t first_;  // index of the pixel's first point
};

struct CameraRay {
  glm::dvec3 eye{0.0};        // middle of the lens
  glm::dvec3 origin{0.0};     // on the lens
  glm::dvec3 direction{0.0};  // unit
  glm::dvec3 through{0.0};    // unit, from the middle of the lens to the same point in focus
};

/// Unit vectors across a direction of view, as seen in the picture there.
struct PictureAxes {
  glm::dvec3 up{0.0};
  glm::dvec3 right{0.0};
};

/// Where a camera stands in a frame. Columns of `frame_from_enu`: east, north and up there.
struct CameraStand {
  glm::dvec3 eye{0.0};
  glm::dmat3 frame_from_enu{1.0};
};

/// A pinhole or a thin lens (perspective), or a panorama
/// (latitude-longitude: centre = heading, left edge = behind).
class CameraRays {
 public:
  /// @param width, height  of the picture in pixels, >= 1. A panorama has no lens.
  CameraRays(const Camera& camera, int width, int height, const CameraStand& stand = {});

  /// Unit direction through a point of the picture and the middle of the lens: x in [0, width] to
  /// the right, y in [0, height] down.
  [[nodiscard]] glm::dvec3 Direction(double x, double y) const;

  /// The same, from the eye.
  [[nodiscard]] CameraRay MiddleRay(double x, double y) const;

  /// The ray through a point of the picture and a point of the lens.
  /// @param lens  uniform in the unit square; not used by a pinhole.
  [[nodiscard]] CameraRay Ray(double x, double y, std::array<double, 2> lens) const;

  /// The point of the picture, or of the plane that it is a piece of, through which one looks in a
  /// direction; nothing for directions behind a perspective.
  [[nodiscard]] std::optional<std::array<double, 2>> PlaceOf(const glm::dvec3& direction) const;

  /// The picture's vertical across a direction, and what is square to both.
  [[nodiscard]] PictureAxes AxesAt(const glm::dvec3& direction) const;

  /// Along what light vibrates that the polariser passes, unit, of a direction; nothing without
  /// one.
  [[nodiscard]] std::optional<glm::dvec3> PassedBy(const glm::dvec3& direction) const;

  /// Angle between neighbouring pixels at the centre of the picture [rad].
  [[nodiscard]] double PixelAngle() const;

  [[nodiscard]] const glm::dvec3& eye() const { return eye_; }
  [[nodiscard]] bool IsPanorama() const { return panorama_; }
  [[nodiscard]] bool HasLens() const { return lens_.has_value(); }
  [[nodiscard]] bool HasPolariser() const { return polariser_rad_.has_value(); }

  /// Radius of the blur of a point in front of a lens, in the plane one metre ahead; 0 of a pinhole
  /// and of points behind it. @param offset  of the point from the eye [m].
  [[nodiscard]] double BlurRadius(const glm::dvec3& offset) const;

  /// A point of the iris, and how the light of a far or near point spreads there.
  struct Blur {
    glm::dvec3 on_lens;  // from the eye to the point of the lens that sees the point there
    double per_sr;       // share of the point's light; its integral over solid angle is 1
  };
  /// The blur of a point, `soft_radius` wider than the lens makes it so that it is never lost
  /// between pixels: (1 - t^2n)^2 of the relative distance t from its middle, where n grows from 1
  /// in focus as the edge gets narrower in comparison. Nothing outside. Needs a lens.
  /// @param through  CameraRay::through. @param soft_radius  in the plane one metre ahead.
  [[nodiscard]] std::optional<Blur> BlurAt(const glm::dvec3& offset, const glm::dvec3& through,
                                           double soft_radius) const;

  /// A camera on its way from one to another of the same picture and lens, `share` in [0, 1]; their
  /// directions are so near to each other that the way between them is straight.
  friend CameraRays Between(const CameraRays& from, const CameraRays& to, double share);

 private:
  struct Lens {
    Iris iris;
    double radius_m;
    double focus_m;
  };

  int width_, height_;
  bool panorama_;
  double tangent_;  // of half the horizontal field of view
  glm::dvec3 eye_;
  glm::dvec3 forward_, right_, up_;
  std::optional<Lens> lens_;
  std::optional<double> polariser_rad_;
};

class MovingCamera {
 public:
  /// A camera that stands.
  MovingCamera(const CameraRays& camera) : steps_{camera} {}  // NOLINT: a camera is one that moves
  /// @param steps  at least one: at even steps of time, the first as the shutter opens, the last as
  ///     it closes. In between the camera goes straight.
  explicit MovingCamera(std::vector<CameraRays> steps);

  [[nodiscard]] bool IsMoving() const { return steps_.size() > 1; }
  /// At half of the time.
  [[nodiscard]] const CameraRays& middle() const { return steps_[steps_.size() / 2]; }

  /// @param time  in [0, 1): share of the time that the shutter is open. Else as CameraRays::Ray.
  [[nodiscard]] CameraRay Ray(double x, double y, std::array<double, 2> lens, double time) const;

 private:
  std::vector<CameraRays> steps_;
};

}  // namespace alpenglow::renderer
