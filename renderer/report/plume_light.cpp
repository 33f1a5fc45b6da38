// SPDX-License-Identifier: MIT
#include "renderer/report/plume_light.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/media/media_march.h"

namespace alpenglow::renderer {
namespace {

constexpr double kPlumeRay_m = 1e4;  // behind the plume
constexpr double kLeastPlumeDepth = 0.1;

}  // namespace

std::array<PlumeView, kPlumeViews> PlumeViewsOf(const glm::dvec3& to_sun) {
  const glm::dvec3 across = glm::normalize(glm::cross(to_sun, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dvec3 level(to_sun.x, to_sun.y, 0.0);
  return {{{"with the sun", glm::normalize(level + glm::dvec3(0.1, 0.2, 0.1))},
           {"to the sun", glm::normalize(glm::dvec3(0.2, 0.1, 0.05) - level)},
           {"across", glm::normalize(across + glm::dvec3(0.0, 0.1, 0.2))},
           {"across, other side", glm::normalize(glm::dvec3(0.1, 0.0, -0.1) - across)},
           {"down", glm::normalize(glm::dvec3(0.2, -0.1, 1.0))},
           {"up", glm::normalize(glm::dvec3(0.3, 0.4, -1.0))}}};
}

std::vector<CloudRay> PlumeRaster(const PlumeView& view, int side) {
  const glm::dvec3 right = glm::normalize(glm::cross(view.from, glm::dvec3(0.1, 0.2, 0.97)));
  const glm::dvec3 up = glm::cross(right, view.from);
  std::vector<CloudRay> rays;
  for (int i = 0; i < side * side; ++i) {
    const double x = 640.0 * ((i % side + 0.5) / side - 0.5);
    const double y = 640.0 * ((i / side + 0.5) / side - 0.5);
    rays.push_back(
        {glm::dvec3(0.0, 0.0, 320.0) + 2000.0 * view.from + x * right + y * up, -view.from});
  }
  return rays;
}

std::vector<PlumeRay> PlumeRaysOf(const Plume& plume, const glm::dvec3& to_sun, int side) {
  const CloudTracker tracker(plume.field, false);
  const std::array<PlumeView, kPlumeViews> views = PlumeViewsOf(to_sun);
  std::vector<PlumeRay> rays;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (const CloudRay& ray : PlumeRaster(views[view], side)) {
      if (tracker.OpticalDepth(ray, 5e3, 4.0) >= kLeastPlumeDepth) rays.push_back({view, ray, {}});
    }
  }
  return rays;
}

CloudPathTracer PlumeTracer(const Plume& plume, const glm::dvec3& to_sun) {
  return {plume.field,
          {.phases = CloudPhases(plume.phase)},
          {.to_sun = to_sun, .ground_altitude_m = -100.0}};
}

std::vector<PlumeRay> TracedPlume(const Plume& plume, const glm::dvec3& to_sun, std::size_t paths,
                                  int side) {
  const CloudPathTracer tracer = PlumeTracer(plume, to_sun);
  std::vector<PlumeRay> rays = PlumeRaysOf(plume, to_sun, side);
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i].traced = tracer.Radiance(rays[i].ray, {.seed = i + 1, .paths = paths});
  return rays;
}

PlumeOrders::PlumeOrders(const Plume& plume, const glm::dvec3& to_sun, double most_cells)
    : plume_(plume),
      to_sun_(to_sun),
      sky_(*plume.volume, Light(true), most_cells),
      ground_(*plume.volume, Light(false), most_cells),
      media_({plume.volume}, 1) {}

CloudRayLight PlumeOrders::Along(const CloudRay& ray) const {
  using Place = VolumeOrders::Place;
  using Look = VolumeOrders::Look;
  const auto sun = [this](const Place& place, const Look& look) {
    return static_cast<double>(sky_.At(place, look).sun[0]);
  };
  const auto sky = [this](const Place& place, const Look& look) {
    return static_cast<double>(sky_.At(place, look).sky[0]);
  };
  const auto ground = [this](const Place& place, const Look& look) {
    return static_cast<double>(ground_.At(place, look).sky[0]);
  };
  CloudRayLight light = Integrated(ray, sun);
  light.sky = Integrated(ray, sky).sun;
  light.ground = Integrated(ray, ground).sun;
  return light;
}

double PlumeOrders::WholeAlong(const CloudRay& ray) const {
  const auto whole = [&](const VolumeOrders::Place& place, const VolumeOrders::Look& look) {
    const VolumeOrders::Scattered of_sky = sky_.At(place, look);
    return WholeCloudLight({.sun = static_cast<double>(of_sky.sun[0]),
                            .sky = static_cast<double>(of_sky.sky[0]),
                            .ground = static_cast<double>(ground_.At(place, look).sky[0]),
                            .transmittance = 0.0,
                            .scaled_transmittance = 0.0},
                           ray);
  };
  return WholeCloudLight(Integrated(ray, whole), ray);
}

VolumeIllumination PlumeOrders::Light(bool is_sky) const {
  const auto half = [is_sky](const glm::dvec3& from) {
    Spectrum radiance(1);
    radiance[0] = (from.z >= 0.0) == is_sky ? 1.0F : 0.0F;
    return radiance;
  };
  return {.to_sun = to_sun_, .has_sun = is_sky, .sky = half, .lamps = nullptr, .emits = false};
}

double PlumeOrders::ColumnToSun(const glm::dvec3& point) const {
  return plume_.volume->Column(point, to_sun_, std::numeric_limits<double>::infinity());
}

CloudRayLight PlumeOrders::Integrated(const CloudRay& ray, const PlumeSource& scattered) const {
  const VolumeOrders::Look look = sky_.LookAlong(ray.origin, ray.direction);
  const auto source = [&](double, const glm::dvec3& point, std::span<const double> densities,
                          std::span<const double> columns_m) {
    const VolumeOrders::Place place{point, ColumnToSun(point), columns_m[0]};
    return Spectrum(
        1, static_cast<float>(densities[0] * sky_.extinction_per_m()[0] * scattered(place, look)));
  };
  const std::vector<SpectrumOf<double>> extinction{sky_.extinction_per_m()};
  const MarchedLight marched = MarchMedia(media_, ray.origin, ray.direction, kPlumeRay_m, source,
                                          kMarchTolerance, {}, extinction);
  return {.sun = static_cast<double>(marched.radiance[0]),
          .transmittance = static_cast<double>(marched.narrow_transmittance[0]),
          .scaled_transmittance = static_cast<double>(marched.transmittance[0])};
}

CloudRayLight FirstOrderOfPlume(const Plume& plume, const glm::dvec3& to_sun, const CloudRay& ray) {
  const MediumOptics& optics = plume.volume->optics();
  const LocalMedia media({plume.volume}, 1);
  const double phase = Phase(optics.phase, glm::dot(ray.direction, to_sun));
  const auto source = [&](double, const glm::dvec3& point, std::span<const double> densities,
                          std::span<const double>) {
    const double column = plume.volume->Column(point, to_sun, 1e5);
    return Spectrum(1, static_cast<float>(densities[0] * optics.scattering_per_m[0] * phase *
                                          std::exp(-optics.extinction_per_m[0] * column)));
  };
  const MarchedLight marched = MarchMedia(media, ray.origin, ray.direction, kPlumeRay_m, source);
  return {.sun = static_cast<double>(marched.radiance[0]),
          .transmittance = static_cast<double>(marched.transmittance[0]),
          .scaled_transmittance = static_cast<double>(marched.transmittance[0])};
}

PlumeErrors ErrorsOfPlume(const std::vector<PlumeRay>& traced,
                          const std::function<CloudRayLight(const CloudRay&)>& light) {
  std::array<double, kPlumeViews> sun{}, sky{}, whole{}, rays{};
  for (const PlumeRay& each : traced) {
    sun[each.view] += each.traced.sun.value;
    sky[each.view] += each.traced.sky.value;
    whole[each.view] += WholeCloudLight(each.traced).value;
    rays[each.view] += 1.0;
  }
  PlumeErrors errors;
  for (const PlumeRay& each : traced) {
    const CloudRayLight found = light(each.ray);
    const double count = rays[each.view];
    const double behind = each.ray.direction.z >= 0.0 ? found.scaled_transmittance : 0.0;
    errors.sun.Add(found.sun, each.traced.sun, sun[each.view] / count);
    errors.sky.Add(found.sky + behind, each.traced.sky, sky[each.view] / count);
    errors.whole.Add(WholeCloudLight(found, each.ray), WholeCloudLight(each.traced),
                     whole[each.view] / count);
  }
  return errors;
}

}  // namespace alpenglow::renderer
