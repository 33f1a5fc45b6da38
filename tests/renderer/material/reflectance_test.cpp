// SPDX-License-Identifier: MIT
#include "renderer/material/reflectance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

const std::vector<double> kWavelengths_nm{450.0, 500.0, 550.0, 600.0, 650.0};

Spectrum Flat(float albedo) {
  Spectrum bands(kWavelengths_nm.size());
  for (std::size_t band = 0; band < bands.size(); ++band) bands[band] = albedo;
  return bands;
}

/// A model of reflection in one band.
struct Model {
  const char* name;
  std::function<double(const ReflectionAngles&)> brdf;
};

double Band0(const Spectrum& bands) { return static_cast<double>(bands[0]); }

std::vector<Model> Models() {
  std::vector<Model> models;
  for (const double roughness : {0.0, 0.4, 1.0}) {
    models.push_back({"rough diffuse", [=](const ReflectionAngles& at) {
                        return Band0(RoughDiffuse(roughness).Brdf(Flat(1.0F), at));
                      }});
  }
  for (const double roughness : {0.3, 0.6, 1.0}) {
    for (const double f0 : {0.04, 0.5}) {
      models.push_back({"glossy", [=](const ReflectionAngles& at) {
                          return Band0(Glossy(roughness, f0).Brdf(Flat(1.0F), at));
                        }});
    }
  }
  for (const double wind : {0.0, 5.0, 15.0}) {
    models.push_back({"water", [=](const ReflectionAngles& at) {
                        return Band0(Water(wind, kWavelengths_nm).Brdf(at));
                      }});
  }
  for (const double grain_m : {2e-4, 2e-3}) {
    models.push_back({"snow", [=](const ReflectionAngles& at) {
                        return Band0(Snow(grain_m, kWavelengths_nm).Brdf(at));
                      }});
  }
  return models;
}

/// Returns the share of evenly bright light from everywhere that a surface sends to an eye. It uses
/// midpoints in azimuth and in t, mu = sin^2(pi t / 2), dense at the horizon and at the zenith.
double AlbedoByQuadrature(const std::function<double(const ReflectionAngles&)>& brdf,
                          double mu_eye) {
  constexpr int kZeniths = 200, kAzimuths = 400;
  double sum = 0.0;
  for (int i = 0; i < kZeniths; ++i) {
    const double t = kPi * (i + 0.5) / kZeniths;
    const double mu = 0.5 * (1.0 - std::cos(t));
    const double sines = std::sqrt((1.0 - mu * mu) * (1.0 - mu_eye * mu_eye));
    for (int k = 0; k < kAzimuths; ++k) {
      const double azimuth = kPi * (k + 0.5) / kAzimuths;
      const double between = std::clamp(mu * mu_eye + sines * std::cos(azimuth), -1.0, 1.0);
      sum += brdf({mu, mu_eye, between}) * mu * 0.5 * kPi * std::sin(t);
    }
  }
  return sum * 2.0 * kPi / (kZeniths * kAzimuths);
}

TEST(Reflectance, IsReciprocal) {
  for (const Model& model : Models()) {
    for (int i = 1; i <= 50; ++i) {
      const double a = Halton(i, 2), b = Halton(i, 3);
      const double sines = std::sqrt((1.0 - a * a) * (1.0 - b * b));
      const double between = a * b + sines * std::cos(kPi * Halton(i, 5));
      const double there = model.brdf({a, b, between});
      EXPECT_NEAR(model.brdf({b, a, between}), there, 2e-6 * there) << model.name;
      EXPECT_GE(there, 0.0) << model.name;
    }
  }
}

TEST(Reflectance, ConservesEnergy) {
  for (const Model& model : Models()) {
    for (const double mu : {1.0, 0.7, 0.4, 0.15, 0.05}) {
      EXPECT_LE(AlbedoByQuadrature(model.brdf, mu), 1.0 + 2e-3)
          << model.name << ", eye at cosine " << mu << "; midpoints are right to 2e-3";
    }
  }
}

TEST(RoughDiffuse, WithoutRoughnessIsLambertian) {
  const Spectrum albedo = Flat(0.3F);
  const RoughDiffuse smooth(0.0);
  for (const double mu : {0.05, 0.5, 1.0}) {
    EXPECT_FLOAT_EQ(smooth.Brdf(albedo, {mu, 0.3, 0.1})[2], 0.3F / static_cast<float>(kPi));
    EXPECT_FLOAT_EQ(smooth.Albedo(albedo, mu)[2], 0.3F);
  }
  const ReflectionAngles at = AnglesBetween({0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}, {0.0, 0.28, 0.96});
  const float lambert = smooth.Brdf(Flat(0.5F), at)[0];
  for (const double roughness : {5e-324, 1e-300, 1e-30, 1e-12})
    EXPECT_EQ(RoughDiffuse(roughness).Brdf(Flat(0.5F), at)[0], lambert) << roughness;
}

TEST(RoughDiffuse, AlbedoIsTheIntegralAndOneReflectsAllLight) {
  struct Case {
    double roughness;
    float albedo;
  };
  for (const auto& [roughness, albedo] : {Case{0.3, 1.0F}, {1.0, 1.0F}, {0.7, 0.35F}}) {
    const RoughDiffuse surface(roughness);
    for (const double mu : {1.0, 0.5, 0.1}) {
      const double integral = AlbedoByQuadrature(
          [&, &albedo = albedo](const ReflectionAngles& at) {
            return Band0(surface.Brdf(Flat(albedo), at));
          },
          mu);
      if (albedo == 1.0F) {
        EXPECT_NEAR(integral, 1.0, 1e-3) << "roughness " << roughness << ", cosine " << mu;
      } else {
        EXPECT_NEAR(Band0(surface.Albedo(Flat(albedo), mu)), integral, 1e-3 * integral);
      }
    }
  }
}

TEST(RoughDiffuse, IsBrighterTowardsTheLightThanAwayFromIt) {
  const RoughDiffuse surface(1.0);
  const double sine2 = 1.0 - 0.25;
  const float back = surface.Brdf(Flat(0.2F), {0.5, 0.5, 0.25 + sine2})[0];
  const float forward = surface.Brdf(Flat(0.2F), {0.5, 0.5, 0.25 - sine2})[0];
  EXPECT_GT(back, 1.5F * forward) << "facets that face the light face the eye: the full moon";
}

TEST(Glossy, AMirrorAtNormalIncidenceReflectsAllLight) {
  for (const double roughness : {0.3, 0.5, 1.0}) {
    const Glossy mirror(roughness, 1.0);
    EXPECT_NEAR(
        AlbedoByQuadrature([&](const ReflectionAngles& at) { return mirror.Coat(at); }, 1.0), 1.0,
        4e-3)
        << "Giesen's normalisation; midpoints, exponent " << mirror.exponent();
  }
}

TEST(Glossy, ANarrowLobeLiesAroundTheMirroredDirection) {
  const Glossy coat(0.1, 0.04);
  const double mu = 0.6, sine2 = 1.0 - mu * mu;
  const double peak = coat.Coat({mu, mu, mu * mu - sine2});
  EXPECT_LT(coat.Coat({mu, mu, mu * mu - sine2 * std::cos(0.2)}), 1e-3 * peak)
      << "11 degrees aside of the mirror";
}

TEST(Glossy, WeightsOfMirroredRaysSumToTheAlbedo) {
  for (const auto& [roughness, tolerance] : {std::pair{0.3, 0.03}, {0.5, 0.03}, {1.0, 0.15}}) {
    const Glossy coat(roughness, 0.04);
    for (const double mu : {1.0, 0.5, 0.1}) {
      const double albedo =
          AlbedoByQuadrature([&](const ReflectionAngles& at) { return coat.Coat(at); }, mu);
      const glm::dvec3 to_eye(std::sqrt(1.0 - mu * mu), 0.0, mu);
      EXPECT_NEAR(coat.Mirrored({0.0, 0.0, 1.0}, to_eye).TotalWeight(), albedo, tolerance * albedo)
          << "roughness " << roughness << ", cosine " << mu;
    }
  }
}

TEST(Fresnel, ReflectanceHasItsKnownValues) {
  EXPECT_NEAR(FresnelReflectance(1.0, 1.34), 0.02111, 1e-5) << "(0.34 / 2.34)^2";
  EXPECT_NEAR(FresnelReflectance(0.0, 1.34), 1.0, 1e-12);
  const double brewster = std::cos(std::atan(1.34));
  const double across = std::pow((1.34 * 1.34 - 1.0) / (1.34 * 1.34 + 1.0), 2);
  EXPECT_NEAR(FresnelReflectance(brewster, 1.34), 0.5 * across, 1e-9)
      << "no light of one polarisation is reflected at Brewster's angle";
  EXPECT_NEAR(FresnelPolarisation(brewster, 1.34), 1.0, 1e-12);
  EXPECT_NEAR(FresnelPolarisation(1.0, 1.34), 0.0, 1e-12);
  EXPECT_NEAR(FresnelPolarisation(0.0, 1.34), 0.0, 1e-12);
  EXPECT_NEAR(SchlickReflectance(0.5, 0.02111), 0.0517, 1e-4) << "f0 + (1 - f0) / 32";
}

TEST(Water, SlopesAreThoseOfCoxAndMunk) {
  EXPECT_DOUBLE_EQ(Water(10.0, kWavelengths_nm).slope_variance(), 0.0542);
}

TEST(Water, GlitterFromStraightAboveIsFresnelReflectance) {
  for (const double wind : {0.0, 5.0, 15.0}) {
    const Water water(wind, kWavelengths_nm);
    EXPECT_NEAR(
        AlbedoByQuadrature(
            [&](const ReflectionAngles& at) { return Water::Glitter(at, water.slope_variance()); },
            1.0),
        0.0211, 2e-4)
        << "waves turn, they do not absorb";
  }
}

// Returns the mean over visible faces, weighed by their projection, in fine steps of slope.
double MeanFaceReflectance(const Water& water, double mu) {
  const double width = std::sqrt(water.slope_variance());
  const double sine = std::sqrt(1.0 - mu * mu);
  double sum = 0.0, total = 0.0;
  for (double x = -4.0; x <= 4.0; x += 0.02) {
    for (double y = -4.0; y <= 4.0; y += 0.1) {
      const double seen = mu + width * x * sine;
      if (seen <= 0.0) continue;
      const double weight = seen * std::exp(-x * x - y * y);
      const double cosine = seen / std::sqrt(1.0 + width * width * (x * x + y * y));
      sum += weight * FresnelReflectance(std::min(cosine, 1.0), Water::kRefractiveIndex);
      total += weight;
    }
  }
  return sum / total;
}

TEST(Water, MirrorsTheSkyByTheMeanReflectanceOfVisibleFaces) {
  for (const double wind : {0.0, 5.0, 15.0}) {
    const Water water(wind, kWavelengths_nm);
    for (const double mu : {1.0, 0.5, 0.2, 0.05}) {
      const double mean = MeanFaceReflectance(water, mu);
      const MirroredRays rays =
          water.Mirrored({0.0, 0.0, 1.0}, {std::sqrt(1.0 - mu * mu), 0.0, mu});
      EXPECT_NEAR(rays.TotalWeight(), mean, 0.05 * mean) << "wind " << wind << ", cosine " << mu;
      for (const MirroredRay& ray : rays.All()) EXPECT_GE(ray.direction.z, -1e-12);
    }
  }
}

TEST(Water, AClearSeaIsBlue) {
  const Spectrum under = Water(5.0, kWavelengths_nm).BodyAlbedo(1.0);
  EXPECT_GT(under[0], 0.01F) << "a few percent in blue: Morel, Prieur (1977)";
  EXPECT_LT(under[0], 0.06F);
  EXPECT_LT(under[4], 0.1F * under[0]) << "water absorbs red";
}

TEST(Snow, WithoutAbsorptionReflectsAllLight) {
  // At 400 nm ice takes less than 0.4 % of the light that snow of fine grains scatters.
  const std::vector<double> violet{400.0};
  const Snow snow(5e-5, violet);
  for (const double mu : {1.0, 0.6, 0.3, 0.1, 0.05}) {
    const double albedo = AlbedoByQuadrature(
        [&](const ReflectionAngles& at) { return static_cast<double>(snow.Brdf(at)[0]); }, mu);
    EXPECT_NEAR(albedo, 1.0, 4e-3) << "cosine " << mu;
  }
}

TEST(Snow, AlbedoIsTheIntegralOfTheDistribution) {
  const Snow snow(1e-3, kWavelengths_nm);
  for (const double mu : {1.0, 0.5, 0.2, 0.05}) {
    for (const std::size_t band : {std::size_t{0}, std::size_t{4}}) {
      const double integral = AlbedoByQuadrature(
          [&](const ReflectionAngles& at) { return static_cast<double>(snow.Brdf(at)[band]); }, mu);
      EXPECT_NEAR(static_cast<double>(snow.Albedo(mu)[band]), integral, 0.01)
          << "the theory's own difference";
    }
  }
}

TEST(Snow, IsAsBrightAsMeasured) {
  // Grenfell, Warren, Mullen (1994), J. Geophys. Res. 99, 18669: 0.96 to 0.98 and more from 450 to
  // 600 nm at the South Pole, grains of 0.1 mm radius.
  const Spectrum fresh = Snow(2e-4, kWavelengths_nm).SphericalAlbedo();
  EXPECT_GT(fresh[0], 0.96F);
  EXPECT_GT(fresh[3], 0.96F);
  const Spectrum old = Snow(2e-3, kWavelengths_nm).SphericalAlbedo();
  for (std::size_t band = 0; band < old.size(); ++band) EXPECT_LT(old[band], fresh[band]);
  EXPECT_LT(old[4], 0.92F) << "coarse grains absorb red";
}

// Returns the mean reflectance of diffuse light, which meets the surface in proportion to the
// cosine.
double MeanFresnel(double index) {
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    sum += 2.0 * mu * FresnelReflectance(mu, index) / kSteps;
  }
  return sum;
}

float WetGrey(double dry, double wetness) {
  Spectrum albedo(1);
  albedo[0] = static_cast<float>(dry);
  return Wetted(albedo, wetness)[0];
}

// The test follows light through the film from facet to surface and back.
TEST(WetGround, IsTheSumOfReflectionsBetweenFacetsAndFilm) {
  constexpr double kWater = 1.33, kStone = 1.5;
  const double back = 1.0 - (1.0 - MeanFresnel(kWater)) / (kWater * kWater);
  const double more = (1.0 - MeanFresnel(kStone / kWater)) / (1.0 - MeanFresnel(kStone));
  for (const double dry : {0.0, 0.02, 0.1, 0.2, 0.5, 0.9, 1.0}) {
    const double a = (1.0 - dry) * (dry * more + 1.0 - dry);
    double inside = 1.0 - MeanFresnel(kWater), out = 0.0;
    for (int times = 0; times < 60; ++times) {
      out += inside * (1.0 - a) * (1.0 - back);
      inside *= (1.0 - a) * back;
    }
    EXPECT_NEAR(static_cast<double>(WetGrey(dry, 1.0)), out, 1e-4) << dry << ": constants' digits";
  }
}

TEST(WetGround, IsAsDarkAsMeasured) {
  // Angstrom (1925), Geografiska Annaler 7, 323, quoted by Lekner, Dorf (1988): grey sand 0.18 dry
  // and 0.09 wet, black mould 0.14 and 0.08.
  EXPECT_NEAR(WetGrey(0.18, 1.0), 0.09, 0.02) << "0.02 is the sheen of the film";
  EXPECT_NEAR(WetGrey(0.14, 1.0), 0.08, 0.02);
}

TEST(WetGround, DriesEvenlyAndIsNeverLighter) {
  for (const double dry : {0.02, 0.1, 0.3, 0.7}) {
    EXPECT_EQ(WetGrey(dry, 0.0), static_cast<float>(dry));
    EXPECT_NEAR(WetGrey(dry, 0.5), 0.5 * (dry + static_cast<double>(WetGrey(dry, 1.0))), 1e-6);
    EXPECT_LT(WetGrey(dry, 1.0), dry);
  }
}

TEST(Reflectance, ImpossibleSurfacesAreRefused) {
  EXPECT_THROW(RoughDiffuse(1.5), InputError);
  EXPECT_THROW(Glossy(0.05, 0.04), InputError);
  EXPECT_THROW(Glossy(0.5, -0.1), InputError);
  EXPECT_THROW(Water(-1.0, kWavelengths_nm), InputError);
  EXPECT_THROW(Snow(0.1, kWavelengths_nm), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
