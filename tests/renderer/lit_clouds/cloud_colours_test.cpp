// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/cloud_colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/cloud_phase/ice_phase.h"
#include "tests/fixtures/directions.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sphere_clouds.h"

namespace alpenglow::renderer {
namespace {

using tests::DirectionAt;

constexpr double kBlue_nm = 450.0, kRed_nm = 650.0;
constexpr double kSun_deg = 35.0;

/// Returns the phase function of crystals of 40 um, whose halo is sharp, at all radii.
CloudPhases LargeCrystals(double wavelength_nm) {
  return CloudPhases(IcePhases(wavelength_nm).Drawn(40.0, 0.5));
}

/// A field with colours, and paths at each wavelength.
class ColouredField {
 public:
  template <typename Phases>
  ColouredField(CloudField field, const Phases& phases)
      : field_(std::move(field)),
        to_sun_(DirectionAt(kSun_deg, 90.0)),
        light_(field_, {phases(550.0)}, {.to_sun = to_sun_}, Options()),
        colours_(light_, {phases(kBlue_nm), phases(kRed_nm)}),
        traced_{Tracer(phases(kBlue_nm)), Tracer(phases(kRed_nm))} {}

  [[nodiscard]] const CloudLight& light() const { return light_; }

  /// Light of one band, or the ratio of two.
  struct Estimate {
    double value, standard_error;
  };
  /// Returns the sunlight of the red band relative to that of the blue one.
  [[nodiscard]] double RedOverBlue(const CloudRay& ray, CloudLightMethod method) const {
    const CloudRayLights lights = light_.WithMethod(method).RadianceByBoth(ray, 1e5);
    const Spectrum relative = colours_.Of(lights.fast.sun, lights.chosen.once);
    return static_cast<double>(relative[1] / relative[0]);
  }
  [[nodiscard]] Estimate TracedRedOverBlue(const CloudRay& ray) const {
    const CloudPathOptions options{.paths = tests::ScaledDown<std::size_t>(40000, 320)};
    const CloudEstimate blue = traced_[0].Radiance(ray, options).sun;
    const CloudEstimate red = traced_[1].Radiance(ray, options).sun;
    const double ratio = red.value / blue.value;
    return {ratio,
            ratio * std::hypot(red.standard_error / red.value, blue.standard_error / blue.value)};
  }

 private:
  static CloudLightOptions Options() {
    CloudLightOptions options;
    options.factor.rays = 0;
    return options;
  }
  [[nodiscard]] CloudPathTracer Tracer(const CloudPhases& phases) const {
    return {field_, {phases}, {.to_sun = to_sun_}};
  }

  CloudField field_;
  glm::dvec3 to_sun_;
  CloudLight light_;
  CloudColours colours_;
  std::vector<CloudPathTracer> traced_;
};

/// Expects the colour of rays to be that of paths of each wavelength.
/// @param share  of the ratio that the approximation may be wrong. @param which  name of the case.
void ExpectColoursOfPaths(const ColouredField& field, const std::vector<CloudRay>& rays,
                          double share, const std::string& which) {
  double least = 10.0, most = 0.0, worst = 0.0;
  for (const CloudRay& ray : rays) {
    const double found = field.RedOverBlue(ray, CloudLightMethod::kFast);
    const ColouredField::Estimate traced = field.TracedRedOverBlue(ray);
    EXPECT_NEAR(found, traced.value, 3.0 * traced.standard_error + share * traced.value);
    EXPECT_LT(traced.standard_error, tests::ScaledDown(0.03, 1.0))
        << "the test must be able to fail";
    worst = std::max(worst, std::abs(found / traced.value - 1.0));
    least = std::min(least, found);
    most = std::max(most, found);
  }
  testing::Test::RecordProperty("worst_" + which, std::to_string(worst));
  EXPECT_GT(most, 1.15 * least) << "rays have different colours";
}

// Rays pass the inner edge of the halo, which is red, its middle and its outside.
TEST(CloudColours, HaloOfAThinLayerHasTheColoursOfPaths) {
  const ColouredField field(tests::PlaneLayer(0.5), LargeCrystals);
  std::vector<CloudRay> rays;
  for (const double away_deg : {18.0, 21.25, 21.75, 22.5, 25.0})
    rays.push_back({{0.0, 0.0, 0.0}, DirectionAt(kSun_deg + away_deg, 90.0)});
  ExpectColoursOfPaths(field, rays, 0.03, "halo");
}

// The direction away from the sun is 35 degrees below the horizon. Rays meet the centre and the red ring of
// the glory, and the middle and the red edge of the bow.
TEST(CloudColours, FogBowAndGloryOfALayerHaveTheColoursOfPaths) {
  for (const double depth : {0.5, 1.5}) {
    const ColouredField field(tests::PlaneLayer(depth), DropletPhases);
    std::vector<CloudRay> rays;
    for (const double away_deg : {1.0, 2.5, 38.0, 46.0})
      rays.push_back({{0.0, 0.0, 3000.0}, DirectionAt(-kSun_deg - away_deg, 270.0)});
    ExpectColoursOfPaths(field, rays, 0.03, std::to_string(depth));
  }
}

TEST(CloudColours, CoronaOfALayerHasTheColoursOfPaths) {
  const ColouredField field(tests::PlaneLayer(2.0), DropletPhases);
  std::vector<CloudRay> rays;
  for (const double away_deg : {1.5, 3.0, 5.0, 8.0})
    rays.push_back({{0.0, 0.0, 0.0}, DirectionAt(kSun_deg + away_deg, 90.0)});
  ExpectColoursOfPaths(field, rays, 0.03, "corona");
}

TEST(CloudColours, SingleCloudsHaveTheColoursOfPaths) {
  const ColouredField field(tests::SphereClouds(0.005), DropletPhases);
  std::vector<CloudRay> rays;
  for (const double away_deg : {1.0, 2.5, 38.0, 46.0}) {
    const glm::dvec3 direction = DirectionAt(-kSun_deg - away_deg, 270.0);
    // Through the middle of the largest sphere.
    rays.push_back({glm::dvec3(800.0, 1010.0, 1240.0) - 1500.0 * direction, direction});
  }
  ExpectColoursOfPaths(field, rays, 0.03, "spheres");
}

TEST(CloudColours, AllMethodsHaveTheSameColours) {
  const ColouredField field(tests::SphereClouds(0.02), DropletPhases);
  const glm::dvec3 direction = DirectionAt(-kSun_deg - 41.0, 270.0);
  const CloudRay ray{glm::dvec3(800.0, 1010.0, 1240.0) - 1500.0 * direction, direction};
  const double fast = field.RedOverBlue(ray, CloudLightMethod::kFast);
  EXPECT_EQ(field.RedOverBlue(ray, CloudLightMethod::kHybrid), fast);
  EXPECT_EQ(field.RedOverBlue(ray, CloudLightMethod::kTraced), fast);
}

TEST(CloudColours, DarkRaysHaveNoColour) {
  const CloudField field = tests::SphereClouds(0.02);
  const CloudLight light =
      CloudLight::Unlit(field, {DropletPhases(550.0)}, {.to_sun = DirectionAt(35.0, 90.0)});
  const CloudColours colours(light, {DropletPhases(kBlue_nm), DropletPhases(kRed_nm)});
  const CloudRayLight dark = light.Radiance({{800.0, 1010.0, 3000.0}, DirectionAt(-90.0, 0.0)});
  EXPECT_EQ(dark.sun, 0.0);
  for (const float band : colours.Of(dark.sun, dark.once).values()) EXPECT_EQ(band, 1.0F);
}

}  // namespace
}  // namespace alpenglow::renderer
