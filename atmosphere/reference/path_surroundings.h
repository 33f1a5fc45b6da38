// SPDX-License-Identifier: MIT
// Bodies in the air that paths of the path tracer meet: clouds and mountains.
//
// Points are metres from the planet's centre, directions are unit vectors. A body is a Lambertian
// surface, or a cloud: it scatters all wavelengths alike and depolarises. Clouds are met at random,
// so that the mean over meetings is their transmittance: the air in front of a meeting then needs no
// transmittance of clouds.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "atmosphere/medium/phase.h"
#include "atmosphere/reference/path_sampling.h"

namespace alpenglow::atmosphere::reference {

/// A straight segment of a path.
struct PathSegment {
  glm::dvec3 origin, direction;
  double length_m;      // to the planet's sphere or to the top of the air
  bool ends_on_planet;  // on its sphere
};

/// A point of a Lambertian surface.
struct PathSurface {
  glm::dvec3 point;   // outside the body, where paths go on
  glm::dvec3 normal;  // unit
  std::vector<double> albedo;
};

/// A collision with a droplet or a crystal.
struct PathScatterer {
  const PhaseFunction* phase;
  double albedo;
};

/// The first body that a path meets on a segment.
struct PathMeeting {
  double distance_m;
  std::variant<PathSurface, PathScatterer> body;
};

/// Called from many threads.
class PathSurroundings {
 public:
  PathSurroundings() = default;
  PathSurroundings(const PathSurroundings&) = delete;
  PathSurroundings& operator=(const PathSurroundings&) = delete;
  virtual ~PathSurroundings() = default;

  /// Returns what a path meets on a segment; no value if it leaves the air. A segment that ends on
  /// the planet meets a surface there at the latest.
  [[nodiscard]] virtual std::optional<PathMeeting> Meet(const PathSegment& segment,
                                                        PathRandom& random) const = 0;
  /// Returns an unbiased estimate of the transmittance of bodies from a point to the sun.
  [[nodiscard]] virtual double SunTransmittance(const glm::dvec3& point,
                                                PathRandom& random) const = 0;
  /// Returns a phase function of clouds, in whose lobe around the sun further rays look for clouds;
  /// null: none.
  [[nodiscard]] virtual const PhaseFunction* SunLobe(PathRandom& random) const = 0;
};

}  // namespace alpenglow::atmosphere::reference
