// SPDX-License-Identifier: MIT
// The tables of the air as shaders read them, against their reading on the processor.
#include "viewer/air/air_follower.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "atmosphere/math/numerics.h"
#include "tests/fixtures/solved_media.h"
#include "tests/lut/camera_tables/air_reading.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

using AirTexturesOnGpu = tests::Headless;

constexpr int kFirstUnit = 3;
constexpr GLuint kBinding = 5;

/// An eye whose sun stands in the south west.
EyeUnderLight EyeUnderSouthWest(double altitude_m, double mu_s) {
  const double sine = std::sqrt((1.0 - mu_s) * (1.0 + mu_s));
  return {altitude_m, Unrefracted({-0.6 * sine, -0.8 * sine, mu_s})};
}

/// Tables on both processors for such an eye.
struct BothTables {
  BothTables(double altitude_m, double mu_s)
      : medium(MakeMediumTables(tests::Earth())),
        tables(MakeAirTables(tests::Earth(), medium, EyeUnderSouthWest(altitude_m, mu_s),
                             AirTablesSizeOf(AirQuality::kLow, altitude_m))),
        reading(tables) {
    textures.Upload(medium);
    textures.Upload(tables);
    textures.SetView(altitude_m, tables.eye.light);
  }

  /// Unit vector, by the angle over the horizon and the azimuth from the sun's.
  [[nodiscard]] glm::dvec3 Direction(double angle, double azimuth) const {
    const double elevation = angle - tables.map.horizon_dip;
    const double c = std::cos(azimuth), s = std::sin(azimuth);
    return {std::cos(elevation) * (-0.6 * c + 0.8 * s), std::cos(elevation) * (-0.8 * c - 0.6 * s),
            std::sin(elevation)};
  }

  [[nodiscard]] std::vector<float> OnGpu(const std::string& expression,
                                         const std::vector<tests::Arguments<float>>& points) const {
    const auto prepare = [&](const ShaderProgram& program) {
      AirTextures::Prepare(program, kFirstUnit, kBinding);
      textures.Bind(kFirstUnit, kBinding);
      program.Use();
    };
    return tests::EvaluateWithTexts(AirTableTexts(), expression, points, prepare);
  }

  MediumTables medium;
  AirTables tables;
  tests::AirReading reading;
  AirTextures textures;
};

struct ViewOfAir {
  double angle, azimuth, distance_km;
};

/// All over the sphere, every other one near the horizon.
std::vector<ViewOfAir> Looks(const AirMap& map, double sky_range) {
  std::vector<ViewOfAir> looks;
  for (int i = 1; i <= 400; ++i) {
    const double u = 2.0 * Halton(i, 2) - 1.001;  // not the horizon itself, where two sides meet
    const double v = i % 2 == 0 ? u : u * u * u;
    const double angle = v * (v > 0.0 ? sky_range : map.ground_range) * 0.998;
    const double entry = shared::AirEntry<double>(map.altitude, std::sin(angle - map.horizon_dip),
                                                  map.ceiling, map.radius);
    looks.push_back({angle, kPi * Halton(i, 3), entry + 200.0 * Halton(i, 5) * Halton(i, 7)});
  }
  return looks;
}

std::vector<tests::Arguments<float>> ArgumentsOf(const BothTables& both,
                                                 const std::vector<ViewOfAir>& looks) {
  std::vector<tests::Arguments<float>> points;
  for (const ViewOfAir& look : looks) {
    const glm::vec3 d(both.Direction(look.angle, look.azimuth));
    points.push_back({d.x, d.y, d.z, static_cast<float>(look.distance_km)});
  }
  return points;
}

// --- what the driver reads ---

TEST_F(AirTexturesOnGpu, UniformBlockHasTheOffsetsOfTheDriver) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  for (ShaderPiece& piece : AirTableTexts()) pieces.push_back(std::move(piece));
  pieces.push_back({"main", "void main() { gl_Position = SkyRadiance(vec3(1.0)); }\n"});
  const ShaderProgram program = ShaderProgram::ForTransformFeedback(pieces, {"gl_Position"});
  const GLuint block = glGetUniformBlockIndex(program.id(), "AirTables");
  GLint size = 0;
  glGetActiveUniformBlockiv(program.id(), block, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
  EXPECT_EQ(size, static_cast<GLint>(sizeof(AirTablesBlock)));
  const std::vector<std::pair<const char*, std::size_t>> members{
      {"air_tables.towards", offsetof(AirTablesBlock, sun)},
      {"air_tables.sun_seen", offsetof(AirTablesBlock, sun_seen)},
      {"air_tables.frame", offsetof(AirTablesBlock, frame)},
      {"air_tables.shell", offsetof(AirTablesBlock, shell)},
      {"air_tables.ranges", offsetof(AirTablesBlock, ranges)},
      {"air_tables.crowding", offsetof(AirTablesBlock, crowding)},
      {"air_tables.columns", offsetof(AirTablesBlock, columns)},
      {"air_tables.sky_rows", offsetof(AirTablesBlock, sky_rows)},
      {"air_tables.through_rows", offsetof(AirTablesBlock, through_rows)},
      {"air_tables.way_rows", offsetof(AirTablesBlock, way_rows)},
      {"air_tables.extinction_rows", offsetof(AirTablesBlock, extinction_rows)},
      {"air_tables.distances", offsetof(AirTablesBlock, distances)},
      {"air_tables.phase_nodes", offsetof(AirTablesBlock, phase_nodes)},
      {"air_tables.sky_of_molecules", offsetof(AirTablesBlock, sky_mix)},
      {"air_tables.single_of_molecules", offsetof(AirTablesBlock, single_mix)},
      {"air_tables.extinction_below", offsetof(AirTablesBlock, extinction_below)}};
  for (const auto& [name, expected] : members) {
    GLuint index = GL_INVALID_INDEX;
    glGetUniformIndices(program.id(), 1, &name, &index);
    ASSERT_NE(index, GL_INVALID_INDEX) << name;
    GLint offset = -1;
    glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_OFFSET, &offset);
    EXPECT_EQ(offset, static_cast<GLint>(expected)) << name;
  }
}

// --- what it interpolates ---

void ExpectSkyOfCpu(double altitude_m, double mu_s, double tolerance) {
  SCOPED_TRACE(fmt::format("{} m, sun {}", altitude_m, mu_s));
  const BothTables both(altitude_m, mu_s);
  const std::vector<ViewOfAir> looks = Looks(both.tables.map, both.tables.map.sky_range);
  const auto points = ArgumentsOf(both, looks);
  const auto sky = both.OnGpu("SkyRadiance(vec3(a[0], a[1], a[2])).y", points);
  const auto through = both.OnGpu("TransmittanceToSpace(vec3(a[0], a[1], a[2])).y", points);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double exact = both.reading.Sky(looks[i].angle, looks[i].azimuth)[1];
    EXPECT_NEAR(sky[i], exact, tolerance * exact + 1e-12)
        << "angle " << looks[i].angle << ", azimuth " << looks[i].azimuth;
    EXPECT_NEAR(through[i], both.reading.ToSpace(looks[i].angle)[1], tolerance);
  }
}

void ExpectWaysOfCpu(double altitude_m, double mu_s, double tolerance) {
  SCOPED_TRACE(fmt::format("{} m, sun {}", altitude_m, mu_s));
  const BothTables both(altitude_m, mu_s);
  const std::vector<ViewOfAir> looks = Looks(both.tables.map, both.tables.map.air_sky_range);
  const auto points = ArgumentsOf(both, looks);
  const auto value = [&](const char* member) {
    return both.OnGpu(fmt::format("AirToPoint(vec3(a[0], a[1], a[2]), a[3]).{}.y", member), points);
  };
  const auto single = value("single"), multiple_scattering = value("diffuse"),
             left = value("transmittance");
  const auto single_to = both.OnGpu("SingleTo(vec3(a[0], a[1], a[2]), a[3]).y", points);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const tests::AirToPoint exact =
        both.reading.To(looks[i].angle, looks[i].azimuth, looks[i].distance_km);
    // On short ways 1 - T cancels in float: allowed are 3e-6 of an endless way's light.
    const double light = exact.single[1] + exact.multiple_scattering[1];
    const double error = tolerance * light + 3e-6 * light / (1.0 - exact.transmittance[1]) + 1e-15;
    EXPECT_NEAR(single[i], exact.single[1], error)
        << "angle " << looks[i].angle << ", azimuth " << looks[i].azimuth << ", "
        << looks[i].distance_km << " km";
    EXPECT_NEAR(multiple_scattering[i], exact.multiple_scattering[1], error);
    EXPECT_NEAR(left[i], exact.transmittance[1], tolerance);
    EXPECT_EQ(single_to[i], single[i]);
  }
}

TEST_F(AirTexturesOnGpu, SkyEqualsThatOnTheCpu) {
  ExpectSkyOfCpu(0.0, 0.5, 2e-3);
  ExpectSkyOfCpu(1500.0, 0.02, 2e-3);
  ExpectSkyOfCpu(9000.0, -0.08, 2e-3);
  ExpectSkyOfCpu(400e3, 0.4, 2e-3);
}

TEST_F(AirTexturesOnGpu, AirToPointsEqualsThatOnTheCpu) {
  ExpectWaysOfCpu(2.0, 0.5, 2e-3);
  ExpectWaysOfCpu(1500.0, 0.02, 2e-3);
  ExpectWaysOfCpu(9000.0, -0.08, 2e-3);
  ExpectWaysOfCpu(400e3, 0.4, 2e-3);
}

TEST_F(AirTexturesOnGpu, AMovedEyeUsesItsOwnHorizonAndSun) {
  BothTables both(1500.0, 0.1);
  const EyeUnderLight moved = EyeUnderSouthWest(1600.0, 0.08);
  both.textures.SetView(moved.altitude_m, moved.light);
  const tests::AirReading reading(both.tables, moved);
  const AirMap map(tests::Earth().medium(), moved.altitude_m, both.tables.map.twilight_fall);
  std::vector<tests::Arguments<float>> points;
  const std::vector<ViewOfAir> looks = Looks(map, map.sky_range);
  for (const ViewOfAir& look : looks) {
    const glm::vec3 d(
        both.Direction(look.angle - map.horizon_dip + both.tables.map.horizon_dip, look.azimuth));
    points.push_back({d.x, d.y, d.z, static_cast<float>(look.distance_km)});
  }
  const auto sky = both.OnGpu("SkyRadiance(vec3(a[0], a[1], a[2])).y", points);
  const auto multiple_scattering =
      both.OnGpu("AirToPoint(vec3(a[0], a[1], a[2]), a[3]).diffuse.y", points);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double seen = reading.Sky(looks[i].angle, looks[i].azimuth)[1];
    EXPECT_NEAR(sky[i], seen, 2e-3 * seen) << looks[i].angle << ", " << looks[i].azimuth;
    const double light =
        reading.To(looks[i].angle, looks[i].azimuth, looks[i].distance_km).multiple_scattering[1];
    EXPECT_NEAR(multiple_scattering[i], light, 2e-3 * light + 1e-7) << looks[i].angle;
  }
}

/// Altitudes [km] up to 9 km and zenith cosines from the horizon up, most of them near it.
std::vector<tests::Arguments<float>> PlacesUnderTheSun(double radius_km) {
  std::vector<tests::Arguments<float>> points;
  for (int i = 1; i <= 300; ++i) {
    const double h = 9.0 * Halton(i, 2);
    const double least = shared::HorizonCosine<double>(h, radius_km);
    points.push_back({static_cast<float>(h),
                      static_cast<float>(least + (1.0 - least) * std::pow(Halton(i, 3), 3.0))});
  }
  return points;
}

TEST_F(AirTexturesOnGpu, TransmittanceToTheSunEqualsThatOfTheIntegrator) {
  const BothTables both(0.0, 0.5);
  const auto points = PlacesUnderTheSun(both.tables.map.radius);
  const auto on_gpu = both.OnGpu("TransmittanceToSun(a[0], a[1]).y", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Spectrum exact = tests::Earth().single_scattering().TransmittanceToSpace(
        1000.0 * static_cast<double>(points[i][0]), static_cast<double>(points[i][1]));
    EXPECT_NEAR(on_gpu[i], exact[1], 2e-3) << points[i][0] << " km, " << points[i][1];
  }
}

TEST_F(AirTexturesOnGpu, BeamOfTheSunEqualsThatOfRefractedBeam) {
  const BothTables both(0.0, 0.5);
  const auto points = PlacesUnderTheSun(both.tables.map.radius);
  const auto on_gpu = both.OnGpu("BeamOfSun(a[0], a[1]).y", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& earth = tests::Earth();
    const Spectrum exact =
        earth.beam().Left(earth.single_scattering(), 1000.0 * static_cast<double>(points[i][0]),
                          static_cast<double>(points[i][1]));
    EXPECT_NEAR(on_gpu[i], exact[1], 2e-3) << points[i][0] << " km, " << points[i][1];
  }
}

}  // namespace
}  // namespace alpenglow::viewer
