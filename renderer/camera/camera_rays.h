// SPDX-License-Identifier: MIT
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
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "renderer/camera/iris.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

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

}  // namespace alpenglow::renderer
