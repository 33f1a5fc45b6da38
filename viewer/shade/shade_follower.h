// SPDX-License-Identifier: MIT
// Keeps the map of shade up with an eye that moves and a sun that does: made on a thread beside
// drawing, sent to the card some lines a frame.
//
// A map is asked for anew when the sun has moved by a fifth of its radius, when the eye has come a
// fifth of the map's half width, and when there is other ground. Until it is there the one before
// serves. At sixty times the pace of time that is five maps a second, each a third of a second late
// at most: shade lags by a third of the disk's radius, less than its edges are soft, and goes on in
// steps of a fifth. At a thousand times it lags by five disks and goes in steps of three.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/sun.h"
#include "viewer/job/latest_job.h"
#include "viewer/land/ground_sampler.h"
#include "viewer/shade/shade_map.h"
#include "viewer/shade/shade_texture.h"

namespace alpenglow::viewer {

struct ShadeSize {
  double half_width_m = 30e3;  // of the ground whose shade counts, around the eye
  int samples = 1024;          // of it a side at most
  int nodes_a_sample = 2;      // that they are read at: more keep crests that run between nodes
  int cells = 1024;            // of the map a side at most
  bool operator==(const ShadeSize&) const = default;
};

/// To be used on the thread of the context that is current when it is made.
class ShadeFollower {
 public:
  explicit ShadeFollower(const Ellipsoid& ellipsoid);

  /// Other ground, or more of it. An empty function: none.
  void SetGround(GroundSampler sampler);
  void SetSize(const ShadeSize& size);

  /// Once a frame, before drawing: takes over what is ready, by way of a texture unit, and asks for
  /// what is missing. Never waits.
  /// @param sun  apparent, seen from the eye.
  void Follow(const GeodeticPosition& eye, const SunPosition& sun, int unit);
  /// The same, but what Follow would show in the end is there when it returns: for pictures that
  /// are kept.
  void Settle(const GeodeticPosition& eye, const SunPosition& sun, int unit);

  /// What is shown.
  [[nodiscard]] const ShadeTexture& shade() const { return texture_; }
  /// Whether that is the shade of a sun or moon within three degrees of one: after a jump in time it is
  /// of another for some frames.
  [[nodiscard]] bool IsOf(const GeodeticPosition& eye, const SunPosition& sun) const;
  /// From metres in the frame (east, north, up) at an eye to those of the map's. Only where
  /// shade().Shades().
  [[nodiscard]] glm::dmat4 MapFromEye(const GeodeticPosition& eye) const;
  /// Time that the map shown took to make; 0 before the first.
  [[nodiscard]] double making_s() const { return used_ ? used_->making_s : 0.0; }

 private:
  struct Request {
    std::shared_ptr<const GroundSampler> ground;
    ShadeSize size;
    LocalFrame frame;
    glm::dvec3 to_sun;  // in the frame
    double sun_radius_rad;
  };
  struct Made {
    LocalFrame frame;
    glm::dvec3 to_sun;  // in the frame
    ShadeMap map;
    double making_s;
  };
  /// Makes maps; keeps heights between maps of the same ground.
  class Maker;

  [[nodiscard]] Request RequestFor(const GeodeticPosition& eye, const SunPosition& sun) const;
  [[nodiscard]] bool Suits(const Request& asked, const Request& wanted) const;
  void Ask(const GeodeticPosition& eye, const SunPosition& sun);
  void TakeFinished();
  void Upload(int lines, int unit);

  Ellipsoid ellipsoid_;
  std::shared_ptr<const GroundSampler> ground_;
  ShadeSize size_;
  ShadeTexture texture_;
  std::optional<Request> asked_;
  std::shared_ptr<const Made> used_, coming_;
  LatestJob<Request, std::shared_ptr<const Made>> maker_;
};

}  // namespace alpenglow::viewer
