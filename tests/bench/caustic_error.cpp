// SPDX-License-Identifier: MIT
// studies caustic_error [MOST [G]]: errors and times of the caustic of a sphere of glass in fog by photon
// beams and points (renderer/specular), by radius and number of photons, relative to quadrature over
// cones. MOST limits the number of photons (1000000), G is the
// mean cosine of the fog (0).
//
// The picture and its errors are those of renderer/report/sphere_caustic.h; made pictures take one ray in
// each pixel, true ones the mean of 16. A path tracer from the eye has no row: its paths never find
// parallel light behind glass. Times are of the processor, of all threads.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "renderer/report/sphere_caustic.h"
#include "renderer/specular/beam_map.h"
#include "renderer/specular/photon_beams.h"
#include "renderer/specular/point_map.h"
#include "tests/bench/studies.h"

namespace alpenglow::tests {
namespace {

using namespace renderer;

// Maps of more beams take long, and their errors are those of the radius.
constexpr int kMostBeams = 100000;

double ProcessorTime_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// A method on one number of photons.
struct CausticCase {
  std::string name;
  int photons;
  double radius_pixels;
};

template <typename Map>
void PrintErrors(const CausticCase& of, const Map& map, double made_s, const CausticView& view,
                 const std::vector<double>& truth) {
  const double begin_s = ProcessorTime_s();
  const std::vector<double> picture = CausticPicture(view, 1, [&](const glm::dvec3& direction) {
    return map.Radiance(view.eye(), direction, view.kEnd_m)[0];
  });
  const double picture_s = ProcessorTime_s() - begin_s;
  const CausticErrors errors = CausticErrorsOf(picture, truth);
  fmt::print("{} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:+.2f} | {:.2f} | {:.2f}\n", of.name,
             of.photons, of.radius_pixels, 100.0 * errors.median, 100.0 * errors.rms,
             100.0 * errors.focus, 100.0 * errors.bias, made_s, picture_s);
}

}  // namespace

void CausticError(int count, char** arguments) {
  const double most = count > 1 ? ParseNumber(arguments[1]).value() : 1e6;
  const CausticView view;
  const ThinFog fog{.g = count > 2 ? ParseNumber(arguments[2]).value() : 0.0};
  const SphereCaustic cones(1.0, 1.5, 5, 3000, fog);
  double begin_s = ProcessorTime_s();
  const std::vector<double> truth = CausticPicture(view, 4, [&](const glm::dvec3& direction) {
    return cones.Radiance(view.eye(), direction, view.kEnd_m);
  });
  fmt::print(stderr, "quadrature over cones: {:.1f} s\n", ProcessorTime_s() - begin_s);
  fmt::print(
      "method | photons | radius, pixels | median % | rms % | focus % | bias % | map s | "
      "picture s\n");
  for (const int photons : {10000, 100000, 1000000}) {
    if (photons > most) break;
    const std::vector<PhotonBeam> beams = BeamsOfBall(photons);
    for (const double pixels : {4.0, 2.0, 1.0, 0.5, 0.25}) {
      const double radius_m = pixels * view.kPixel_m;
      begin_s = ProcessorTime_s();
      const PointMap points(beams, FogOf(fog), radius_m);
      PrintErrors({"points", photons, pixels}, points, ProcessorTime_s() - begin_s, view, truth);
      if (photons > kMostBeams) continue;
      begin_s = ProcessorTime_s();
      const BeamMap map(beams, FogOf(fog), radius_m);
      PrintErrors({"beams", photons, pixels}, map, ProcessorTime_s() - begin_s, view, truth);
    }
  }
}

}  // namespace alpenglow::tests
