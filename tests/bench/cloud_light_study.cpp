// SPDX-License-Identifier: MIT
// Measures the methods of light in clouds (renderer/cloud_light/cloud_light.h) relative to traced
// paths, for six views of one field:
//   cloud_light_study [GENUS [SEED [SUN_DEG [PERIOD_KM [PATHS [DROPLETS [CELLS_M...]]]]]]]
// with DROPLETS 0 for the phase function of Henyey and Greenstein (g = 0.85) or 1 for droplets.
// The views, the errors and the whole light are those of renderer/report/cloud_views.h. Times are of
// the processor, for all threads together. Without paths (0) only times count.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_light_fluxes.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/report/cloud_views.h"
#include "renderer/report/traced_light.h"
#include "tests/bench/processor_time.h"

namespace alpenglow::renderer {
namespace {

constexpr CloudRaster kRaster{16, 9};
// Rays are followed again to measure their time.
constexpr int kRepeats = 50;
// True collisions and paths of rays; without collisions all are true ones.
constexpr std::array<CloudHybridOptions, 5> kPaths{
    {{2, 16}, {2, 64}, {2, 128}, {8, 128}, {std::nullopt, 64}}};

// True collisions of paths that then are in the medium of similarity, and their number for a ray.
constexpr std::array<int, 4> kSimilarAfter{2, 4, 8, 16};
constexpr std::size_t kSimilarPaths = 2008;

using LightOfRay = std::function<CloudRayLight(const CloudRay&)>;

struct StudyPixel {
  std::size_t view;
  CloudRay ray;
  CloudRadiance traced;
};

struct Stopwatch {
  std::clock_t begin = std::clock();
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();

  [[nodiscard]] double processor_s() const { return tests::ProcessorSecondsSince(begin); }
  [[nodiscard]] double wall_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  }
};

std::vector<StudyPixel> TracedPixels(const CloudField& field, const CloudPathTracer& tracer,
                                     const std::vector<CloudView>& views, std::size_t paths) {
  std::vector<StudyPixel> pixels;
  for (const CloudPixel& pixel : CloudPixelsOf(field, views, kRaster)) {
    pixels.push_back({pixel.view, pixel.ray, {}});
    if (paths > 0) {
      pixels.back().traced = tracer.Radiance(pixel.ray, {.seed = pixels.size(), .paths = paths});
    }
  }
  return pixels;
}

/// Returns the noise of the whole light, relative as in CloudErrors, from rays a millimetre above:
/// they have other random numbers.
double NoiseOf(const LightOfRay& light, const std::vector<StudyPixel>& pixels,
               const std::vector<CloudRayLight>& found, const std::vector<double>& mean_whole) {
  double squares = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto& [view, ray, traced] = pixels[i];
    const CloudRayLight again = light({ray.origin + glm::dvec3(0.0, 0.0, 1e-3), ray.direction});
    const double scale = std::max(WholeCloudLight(traced).value, kDarkestCloud * mean_whole[view]);
    const double change = WholeCloudLight(found[i], ray) - WholeCloudLight(again, ray);
    squares += 0.5 * std::pow(change / scale, 2);
  }
  return std::sqrt(squares / static_cast<double>(pixels.size()));
}

LightOfRay RadianceOf(const CloudLight& light) {
  return [&light](const CloudRay& ray) { return light.Radiance(ray); };
}

/// @param repeats  for the time.
void PrintErrors(const LightOfRay& light, const std::vector<CloudView>& views,
                 const std::vector<StudyPixel>& pixels, int repeats) {
  const Stopwatch time;
  std::vector<CloudRayLight> found;
  for (int i = 0; i < repeats; ++i) {
    found.clear();
    for (const StudyPixel& pixel : pixels) found.push_back(light(pixel.ray));
  }
  const double us = 1e6 * time.processor_s() / static_cast<double>(pixels.size()) / repeats;
  std::vector<double> mean(views.size()), mean_whole(views.size()), count(views.size());
  for (const StudyPixel& pixel : pixels) {
    mean[pixel.view] += pixel.traced.sun.value;
    mean_whole[pixel.view] += WholeCloudLight(pixel.traced).value;
    count[pixel.view] += 1.0;
  }
  for (std::size_t view = 0; view < views.size(); ++view) mean_whole[view] /= count[view];
  CloudErrors sun, whole, sky;
  std::string by_view;
  for (std::size_t view = 0; view < views.size(); ++view) {
    CloudErrors of_sun, of_whole;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (pixels[i].view != view) continue;
      const CloudEstimate truth = WholeCloudLight(pixels[i].traced);
      for (CloudErrors* errors : {&sun, &of_sun}) {
        errors->Add(found[i].sun, pixels[i].traced.sun, mean[view] / count[view]);
      }
      for (CloudErrors* errors : {&whole, &of_whole}) {
        errors->Add(WholeCloudLight(found[i], pixels[i].ray), truth, mean_whole[view]);
      }
      const bool is_upward = pixels[i].ray.direction.z >= 0.0;
      sky.Add(found[i].sky + (is_upward ? found[i].scaled_transmittance : 0.0),
              pixels[i].traced.sky, 0.0);
    }
    by_view += fmt::format(" {:.1f} {:+.1f} / {:.1f} {:+.1f} |", 100 * of_sun.Rms(),
                           100 * of_sun.Bias(), 100 * of_whole.Rms(), 100 * of_whole.Bias());
  }
  fmt::print(" {:.1f} | {:.1f} {:+.1f} | {:.1f} ({:.1f}) {:+.1f} | {:.1f} {:+.1f} |{}\n", us,
             100 * sun.Rms(), 100 * sun.Bias(), 100 * whole.Rms(),
             100 * NoiseOf(light, pixels, found, mean_whole), 100 * whole.Bias(), 100 * sky.Rms(),
             100 * sky.Bias(), by_view);
}

/// Prints a row for each choice of paths.
void PrintPaths(const CloudField& field, const CloudScatterers& scatterers,
                const CloudSurroundings& surroundings, CloudLightOptions options,
                const std::vector<CloudView>& views, const std::vector<StudyPixel>& pixels) {
  for (const CloudHybridOptions& paths : kPaths) {
    options.paths = paths;
    options.method = paths.collisions ? CloudLightMethod::kHybrid : CloudLightMethod::kTraced;
    const Stopwatch time;
    const CloudLight light(field, scatterers, surroundings, options);
    fmt::print("| {} m, {}, {} collisions, {} paths | {:.2f}, {:.2f} | | |",
               *options.moments.cell_m, NameOf(options.method),
               paths.collisions ? std::to_string(*paths.collisions) : "all", paths.paths,
               time.processor_s(), time.wall_s());
    PrintErrors(RadianceOf(light), views, pixels, 1);
  }
}

/// Prints a row for each number of true collisions. Paths need no solution.
void PrintSimilarity(const CloudPathTracer& tracer, const std::vector<CloudView>& views,
                     const std::vector<StudyPixel>& pixels) {
  for (const int collisions : kSimilarAfter) {
    const Stopwatch time;
    const CloudPathTracer similar = tracer.WithSimilarity(collisions);
    fmt::print("| similarity after {} collisions, {} paths | {:.2f}, {:.2f} | | 0 |", collisions,
               kSimilarPaths, time.processor_s(), time.wall_s());
    const auto light = [&](const CloudRay& ray) {
      const CloudRadiance found =
          similar.Radiance(ray, {.seed = SeedOf(ray), .paths = kSimilarPaths});
      return CloudRayLight{.sun = found.sun.value,
                           .sky = found.sky.value,
                           .ground = found.ground.value,
                           .scaled_transmittance = 0.0};
    };
    PrintErrors(light, views, pixels, 1);
  }
}

struct StudyCase {
  std::string genus = "cumulus";
  std::uint32_t seed = 1;
  double sun_deg = 35.0, period_km = 20.48;
  std::size_t paths = 1004;
  std::vector<double> cells_m{80.0};
  bool has_droplets = false;
};

void RunStudy(const StudyCase& study) {
  CloudOptions options = DefaultCloudOptions(CloudGenusNamed(study.genus));
  options.seed = study.seed;
  options.period_m = 1000.0 * study.period_km;
  const CloudField field = MakeCloudField(options);
  const CloudScatterers scatterers{
      study.has_droplets ? DropletPhases(550.0)
                         : CloudPhases({.kind = PhaseKind::kHenyeyGreenstein, .g = 0.85})};
  const CloudSurroundings surroundings{TowardsAzimuth(20.0, study.sun_deg)};
  const CloudPathTracer tracer(field, scatterers, surroundings);
  const std::vector<CloudView> views = CloudViewsOf(field, 20.0);
  const Stopwatch tracing;
  const std::vector<StudyPixel> pixels = TracedPixels(field, tracer, views, study.paths);
  const std::size_t paths = std::max<std::size_t>(pixels.front().traced.paths, 1);
  fmt::print(
      "{}, seed {}, sun at {} degrees, period {} km, {}: {} pixels, {} paths each, {:.1f} us "
      "a path\n",
      study.genus, study.seed, study.sun_deg, study.period_km,
      study.has_droplets ? "droplets" : "Henyey-Greenstein 0.85", pixels.size(), paths,
      1e6 * tracing.processor_s() / static_cast<double>(pixels.size() * paths));
  const CloudFluxes fluxes = tracer.Fluxes(CloudSource::kSun, {.paths = {.paths = 200000}});
  fmt::print("fluxes by paths: up {:.4f} +- {:.4f}, down {:.4f} +- {:.4f}, direct {:.4f}\n",
             fluxes.mean.up_at_top.value, fluxes.mean.up_at_top.standard_error,
             fluxes.mean.down_at_base.value, fluxes.mean.down_at_base.standard_error,
             fluxes.mean.direct_at_base.value);
  fmt::print(
      "| cell, factor | processor s, wall s | sweeps of sun, sky | MB | us a ray | sun: rms, "
      "bias % | whole: rms (noise), bias % | sky |");
  for (const CloudView& view : views) fmt::print(" {}: sun / whole |", view.name);
  fmt::print("\n");
  PrintSimilarity(tracer, views, pixels);
  for (const double cell_m : study.cells_m) {
    for (const bool is_fitted : {false, true}) {
      CloudLightOptions with;
      with.moments.cell_m = cell_m;
      if (!is_fitted) with.factor.rays = 0;
      const Stopwatch time;
      const CloudLight light(field, scatterers, surroundings, with);
      fmt::print("| {} m, {} | {:.2f}, {:.2f} | {}, {} | {:.0f} |", cell_m,
                 is_fitted ? "fitted" : "1", time.processor_s(), time.wall_s(),
                 light.sun_moments().sweeps, light.sky_moments().sweeps,
                 static_cast<double>(light.bytes()) / 1e6);
      PrintErrors(RadianceOf(light), views, pixels, kRepeats);
      if (!is_fitted) {
        const double mu_s = surroundings.to_sun.z;
        fmt::print("  fluxes: up {:.4f}, down {:.4f}, direct {:.4f}\n",
                   light.sun_moments().up_at_top / mu_s, light.sun_moments().down_at_base / mu_s,
                   light.ground_irradiance().direct / mu_s);
      } else {
        const CloudLightFluxes gathered = GatheredFluxes(light, {.rays_per_column = 40000}).front();
        fmt::print("  gathered fluxes: up {:.4f}, down {:.4f}, direct {:.4f}; factors:",
                   gathered.up_at_top, gathered.down_at_base, gathered.direct_at_base);
        for (const double each : light.factor().node) fmt::print(" {:.3f}", each);
        fmt::print("\n");
        PrintPaths(field, scatterers, surroundings, with, views, pixels);
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer

int main(int count, char** arguments) {
  using alpenglow::atmosphere::ParseNumber;
  alpenglow::renderer::StudyCase study;
  const auto number = [&](int i, double otherwise) {
    return i < count ? ParseNumber(arguments[i]).value_or(otherwise) : otherwise;
  };
  if (count > 1) study.genus = arguments[1];
  study.seed = static_cast<std::uint32_t>(number(2, 1.0));
  study.sun_deg = number(3, study.sun_deg);
  study.period_km = number(4, study.period_km);
  study.paths = static_cast<std::size_t>(number(5, 1004.0));
  study.has_droplets = number(6, 0.0) > 0.0;
  if (count > 7) study.cells_m.clear();
  for (int i = 7; i < count; ++i) study.cells_m.push_back(number(i, 80.0));
  alpenglow::renderer::RunStudy(study);
}
