// SPDX-License-Identifier: MIT
#include "renderer/scene/volume_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/media/exponential_layer.h"
#include "renderer/media/local_volume.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/comma_locale.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using tests::FaultOf;
using Shape = VolumePlacement::Shape;

VolumePlacement Turned(Shape shape, double heading_deg) {
  const double a = heading_deg * kRadiansPerDegree;
  VolumePlacement placement;
  placement.shape = shape;
  placement.bottom = {100.0, -50.0, 20.0};
  placement.ahead = {std::sin(a), std::cos(a), 0.0};
  placement.across = {std::cos(a), -std::sin(a), 0.0};
  placement.size_m = {60.0, 90.0, 40.0};
  return placement;
}

/// Returns a turbulent grid with empty parts, made of the built-in noise.
VolumeGrid NoiseGrid(const std::array<int, 3>& size) {
  std::vector<float> values;
  for (int z = 0; z < size[2]; ++z) {
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) {
        const double n = GradientNoise(0.31 * x + 0.17 * z, 0.29 * y, 3U) +
                         GradientNoise(0.11 * x, 0.23 * y + 0.19 * z, 5U);
        values.push_back(static_cast<float>(std::max(n, 0.0)));
      }
    }
  }
  return {size, std::move(values)};
}

double MidpointColumn(const LocalMedium& volume, const glm::dvec3& origin,
                      const glm::dvec3& direction, double length_m, int steps) {
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    sum += volume.DensityAt(origin + length_m * (i + 0.5) / steps * direction);
  }
  return sum * length_m / steps;
}

std::vector<glm::dvec3> Directions() {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 40; ++i) {
    const double z = 2.0 * (i + 0.5) / 40 - 1.0, phi = 2.4 * i;
    directions.push_back(
        {std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z});
  }
  return directions;
}

TEST(VolumeGrid, ColumnIsTheIntegralOfItsDensity) {
  const LocalVolume volume(Turned(Shape::kBox, 30.0), std::nullopt,
                           std::make_shared<VolumeGrid>(NoiseGrid({21, 17, 34})));
  for (const glm::dvec3& direction : Directions()) {
    const glm::dvec3 from = volume.Middle() - 60.0 * direction;
    const double column = volume.Column(from, direction, 130.0);
    EXPECT_NEAR(column, MidpointColumn(volume, from, direction, 130.0, 40000), 2e-3)
        << "midpoint sums miss the ends of the box by half a step of 3 mm, density up to 1.3";
  }
}

TEST(VolumeGrid, ColumnAddsUpFromItsParts) {
  const VolumeGrid grid = NoiseGrid({16, 16, 16});
  for (const glm::dvec3& direction : Directions()) {
    const glm::dvec3 origin = glm::dvec3(0.5) - 0.2 * direction;
    const double whole = grid.Column(origin, direction, 0.0, 0.4);
    const double parts =
        grid.Column(origin, direction, 0.0, 0.137) + grid.Column(origin, direction, 0.137, 0.4);
    EXPECT_NEAR(parts, whole, 1e-12 * (whole + 1e-3)) << "two Gauss points are exact for a cubic";
  }
}

TEST(VolumeGrid, ConstantDensityIsAHomogeneousVolume) {
  const auto grid =
      std::make_shared<VolumeGrid>(std::array<int, 3>{5, 9, 30}, std::vector<float>(1350, 0.75F));
  for (const auto shape : {Shape::kBox, Shape::kEllipsoid}) {
    const LocalVolume with_grid(Turned(shape, 50.0), std::nullopt, grid);
    const LocalVolume without(Turned(shape, 50.0), std::nullopt, nullptr);
    for (const glm::dvec3& direction : Directions()) {
      const glm::dvec3 from = with_grid.Middle() - 80.0 * direction + glm::dvec3(3.0, 5.0, 2.0);
      const double homogeneous = without.Column(from, direction, 200.0);
      EXPECT_NEAR(with_grid.Column(from, direction, 200.0), 0.75 * homogeneous,
                  1e-10 * homogeneous);
    }
  }
}

TEST(VolumeGrid, PiecesContainAllDensityAndBoundIt) {
  const LocalVolume volume(Turned(Shape::kBox, 10.0), std::nullopt,
                           std::make_shared<VolumeGrid>(NoiseGrid({40, 33, 20})));
  for (const glm::dvec3& direction : Directions()) {
    const glm::dvec3 from = volume.Middle() - 70.0 * direction;
    const auto pieces = volume.PiecesAlong(from, direction, 140.0);
    for (int i = 0; i < 2000; ++i) {
      const double t = 140.0 * (i + 0.5) / 2000;
      double bound = 0.0;
      for (const DensePiece& piece : pieces) {
        if (piece.begin_m <= t && t <= piece.end_m) bound = std::max(bound, piece.largest);
      }
      EXPECT_LE(volume.DensityAt(from + t * direction), bound + 1e-12);
    }
  }
}

TEST(VolumeGrid, CubicsAreTheValuesAlongALine) {
  std::vector<float> values = NoiseGrid({9, 7, 12}).values();
  for (float& value : values) value -= 0.4F;
  const VolumeGrid grid({9, 7, 12}, std::move(values), GridValues::kAny);
  for (const glm::dvec3& direction : Directions()) {
    const glm::dvec3 origin = glm::dvec3(0.5) - 0.3 * direction;
    double end = 0.0;
    for (const CubicPiece& piece : grid.CubicsAlong(origin, direction, 0.0, 0.6)) {
      EXPECT_EQ(piece.begin, end) << "without gaps";
      end = piece.end;
      const auto [least, largest] =
          std::minmax_element(piece.coefficients.begin(), piece.coefficients.end());
      for (const double s : {0.0, 0.11, 0.5, 0.83, 1.0}) {
        const double value = grid.At(origin + (piece.begin + s * (end - piece.begin)) * direction);
        EXPECT_NEAR(piece.At(s), value, 1e-12);
        EXPECT_TRUE(value > *least - 1e-12 && value < *largest + 1e-12);
      }
    }
    EXPECT_EQ(end, 0.6);
    for (const ValuePiece& block : grid.BlocksAlong(origin, direction, 0.0, 0.6)) {
      for (const double s : {0.1, 0.5, 0.9}) {
        const double value =
            grid.At(origin + (block.begin + s * (block.end - block.begin)) * direction);
        EXPECT_TRUE(value > block.least - 1e-12 && value < block.largest + 1e-12);
      }
    }
  }
}

TEST(VolumeGrid, OnlyGridsOfAnyQuantityHaveNegativeValues) {
  const std::vector<float> negative(8, -300.0F);
  EXPECT_THAT(FaultOf([&] {
                (void)VolumeGrid({2, 2, 2}, negative);
              }),
              HasSubstr("value 0 of the grid is -300; densities must be finite and not negative"));
  EXPECT_EQ(VolumeGrid({2, 2, 2}, negative, GridValues::kAny).At(glm::dvec3(0.5)), -300.0);
  std::vector<float> broken(8, 1.0F);
  broken[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(FaultOf([&] {
                (void)VolumeGrid({2, 2, 2}, broken, GridValues::kAny);
              }),
              HasSubstr("value 3 of the grid is nan; values must be finite"));
}

TEST(LocalVolume, ChordsOfASphereAreThoseOfGeometry) {
  VolumePlacement placement;
  placement.shape = Shape::kEllipsoid;
  placement.bottom = {0.0, 0.0, -50.0};
  placement.size_m = glm::dvec3(100.0);
  const LocalVolume sphere(placement, std::nullopt, nullptr);
  for (const double off : {0.0, 10.0, 30.0, 49.0, 49.999}) {
    EXPECT_NEAR(sphere.Column({-1e4, off, 0.0}, {1.0, 0.0, 0.0}, 1e6),
                2.0 * std::sqrt(2500.0 - off * off), 1e-7);
  }
  EXPECT_EQ(sphere.Column({-1e4, 50.001, 0.0}, {1.0, 0.0, 0.0}, 1e6), 0.0);
  EXPECT_NEAR(sphere.Column({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 1e6), 50.0, 1e-9) << "from inside";
  EXPECT_NEAR(sphere.Column({-100.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 75.0), 25.0, 1e-9)
      << "a ray that ends inside";
  const LocalVolume turned(Turned(Shape::kBox, 33.0), std::nullopt, nullptr);
  for (const glm::dvec3& unit : Directions())
    EXPECT_LT(glm::length(turned.UnitFromFrame(turned.FrameFromUnit(unit)) - unit), 1e-12);
}

TEST(LocalVolume, ExponentialColumnIsTheIntegralOfItsDensity) {
  const LocalVolume volume(Turned(Shape::kEllipsoid, 75.0), 12.0, nullptr);
  for (const glm::dvec3& direction : Directions()) {
    const glm::dvec3 from = volume.Middle() - 60.0 * direction + glm::dvec3(4.0, -7.0, 3.0);
    EXPECT_NEAR(volume.Column(from, direction, 130.0),
                MidpointColumn(volume, from, direction, 130.0, 100000), 2e-3)
        << "midpoint sums miss the ends by half a step of 1.3 mm";
  }
}

TEST(ExponentialLayer, ColumnToSpaceIsTheIntegralOfItsDensity) {
  for (const double scale_height : {25.0, 400.0}) {
    const ExponentialLayer fog({300.0, scale_height, 6371e3, 120e3, std::nullopt});
    for (const double mu : {1.0, 0.3, 0.02, 0.0, -0.002}) {
      const glm::dvec3 from(0.0, 0.0, 330.0), direction(std::sqrt(1.0 - mu * mu), 0.0, mu);
      double sum = 0.0;
      constexpr int kSteps = 300000;
      const double reach = std::min(600e3, 24.0 * scale_height / std::max(mu, 1e-9));
      for (int i = 0; i < kSteps; ++i) {
        sum += fog.DensityAt(from + reach * (i + 0.5) / kSteps * direction) * reach / kSteps;
      }
      EXPECT_NEAR(fog.ColumnToSpace(from, direction) / sum, 1.0, 1e-6) << scale_height << " " << mu;
    }
  }
}

TEST(ExponentialLayer, ColumnOfALineIsTheIntegralOfItsDensity) {
  const double endless = std::numeric_limits<double>::infinity();
  for (const double scale_height : {25.0, 400.0, endless}) {
    const ExponentialLayer layer({300.0, scale_height, 6371e3, 120e3, std::nullopt});
    for (const double mu : {1.0, 0.3, 0.0, -0.002, -0.05, -1.0}) {
      const glm::dvec3 from(0.0, 0.0, 330.0), direction(std::sqrt(1.0 - mu * mu), 0.0, mu);
      for (const double length : {5.0, 300.0, 40e3}) {
        if (length * -mu > 330.0) continue;  // below the sphere
        EXPECT_NEAR(layer.Column(from, direction, length) /
                        MidpointColumn(layer, from, direction, length, 100000),
                    1.0, 1e-4)
            << scale_height << " " << mu << " " << length;
      }
    }
  }
}

TEST(ExponentialLayer, WithoutScaleHeightReachesTheTopOfTheAir) {
  const ExponentialLayer fog(
      {0.0, std::numeric_limits<double>::infinity(), 6371e3, 100e3, std::nullopt});
  EXPECT_NEAR(fog.ColumnToSpace({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}), 100e3, 1e-3);
  EXPECT_NEAR(fog.ColumnToSpace({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}),
              std::sqrt(100e3 * (2.0 * 6371e3 + 100e3)), 1e-3);
}

TEST(BlackBody, RadiatesByTheLawOfStefanAndBoltzmann) {
  double sum = 0.0;
  for (double nm = 100.0; nm < 200000.0; nm *= 1.001) sum += BlackBodyRadiance(nm, 3000.0) * nm;
  EXPECT_NEAR(sum * std::log(1.001) * kPi / (5.670374419e-8 * std::pow(3000.0, 4.0)), 1.0, 1e-3)
      << "the tail beyond 0.2 mm is 1e-5, the sum's own error below it";
}

TEST(VolumeGrid, InvalidDensitiesAreRefused) {
  using Size = std::array<int, 3>;
  const auto grid = [](const Size& size, std::vector<float> values) {
    return FaultOf([&] { VolumeGrid(size, std::move(values)); });
  };
  EXPECT_EQ(grid({2, 2, 2}, std::vector<float>(7)), "7 values for a grid of 2 x 2 x 2 samples");
  EXPECT_EQ(grid({1, 2, 2}, std::vector<float>(4)),
            "a grid of 1 x 2 x 2 samples; each side must have 2 to 1024");
  for (const float wrong : {-1.0F, std::nanf(""), INFINITY}) {
    std::vector<float> values(8, 1.0F);
    values[5] = wrong;
    EXPECT_NE(grid({2, 2, 2}, values).find("value 5 of the grid"), std::string::npos);
  }
}

class Nrrd : public TemporaryFolder {
 protected:
  [[nodiscard]] VolumeGrid Read(const std::string& text, const char* name = "x.nrrd") const {
    WriteText(folder_ / name, text);
    return ReadNrrd(folder_ / name);
  }
  [[nodiscard]] std::string Fault(const std::string& text) const {
    return FaultOf([&] { return Read(text); });
  }
};

std::string LittleEndian(const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) {
      bytes.push_back(static_cast<char>(bits >> shift & 0xFFU));
    }
  }
  return bytes;
}

const std::vector<float> kEight{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.5F};
const std::string kFloats = "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 2 2\n";

TEST_F(Nrrd, ReadsFloatsAndBytes) {
  EXPECT_EQ(Read(kFloats +
                 "# made by hand\nspacings: 1 1 1\nencoding: raw\nendian: little\n"
                 "author:=nobody\n\n" +
                 LittleEndian(kEight))
                .values(),
            kEight);
  EXPECT_EQ(
      Read(std::string("NRRD0001\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n") +
           std::string(7, '\0') + '\xFF')
          .largest(),
      1.0);
}

TEST_F(Nrrd, RefusesEveryTruncationOfAValidFile) {
  const std::string whole =
      kFloats + "encoding: raw\nendian: little\n\n" + LittleEndian(std::vector<float>(8, 1.0F));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(Fault(whole.substr(0, length)), "no fault") << length;
}

TEST_F(Nrrd, UnsupportedFieldsAreRefusedByName) {
  const auto fault = [&](const std::string& line) {
    return Fault("NRRD0004\n" + line +
                 "\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n" +
                 std::string(8, 'a'));
  };
  for (const char* line :
       {"content: smoke: dense", "Spacings: 1 1 2", "SPACE: RAS", "labels: \"x\" \"y\" \"z\"",
        "space origin: (1,2,3)", "centers: cell cell cell", "kinds: space domain ???", "number: 8",
        "endian: big", "my field:=a: b", "axis mins: 0 nan 0", "space units: \"m\" \"m\" \"m\""}) {
    EXPECT_EQ(fault(line), "no fault") << line;
  }
  for (const auto& [line, named] : std::vector<std::pair<const char*, const char*>>{
           {"type: double", ":2: type is \"double\"; it must be \"float\" or \"uint8\""},
           {"encoding: bzip2", ":2: encoding is \"bzip2\"; it must be \"raw\" or \"gzip\""},
           {"dimension: 4", ":2: dimension is 4; it must be 3"},
           {"centers: cell node cell", "centers are \"cell node cell\""},
           {"kinds: vector domain domain", "kinds are \"vector domain domain\""},
           {"old min: 3", "\"old min\" is not read"},
           {"colour: red", "\"colour\" is not read"},
           {"endian: middle", "endian is \"middle\""},
           {"encoding: raw", "\"encoding\" stands twice"},
           {"spacings: 1 -1 1", "axis 2 runs backwards"},
           {"axis mins: 0 0 3\naxis maxs: 1 1 1", "axis 3 runs backwards"},
           {"space: scanner-xyz", "space is \"scanner-xyz\""},
           {"space: 3D-left-handed", "space is \"3D-left-handed\""},
           {"space dimension: 4", "space dimension is 4"},
           {"space directions: (1,0,0) (0,1,0) none", "must be three vectors"},
           {"space directions: (1,1,0) (0,1,0) (0,0,1)", "are oblique"},
           {"space directions: (1,0,0) (2,0,0) (0,0,1)", "are oblique"},
           {"space directions: (1,0,0) (0,0,0) (0,0,1)", "are oblique"},
           {"data file: LIST", "it must be the name of one file"},
           {"data file: z%03d.raw 1 2 1", "it must be the name of one file"},
           {"byte skip: -2", "byte skip is \"-2\""},
           {"byte skip: 4", "4 bytes of data; 2 x 2 x 2 bytes are 8"},
           {"line skip: 1", "has 0 lines; line skip is 1"}}) {
    EXPECT_THAT(fault(line), HasSubstr(named)) << line;
  }
  EXPECT_EQ(FaultOf([&] { return ReadNrrd(folder_ / "none.nrrd"); }),
            (folder_ / "none.nrrd").string() + ": cannot be read");
}

// Returns a file of 4 x 3 x 2 samples 0, 1, 2 ... in 255ths, as bytes.
std::string Counting(const std::string& fields) {
  std::string text =
      "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n" + fields + "\n";
  for (char i = 0; i < 24; ++i) text += i;
  return text;
}

TEST_F(Nrrd, SpaceDirectionsTurnTheSamples) {
  // Returns the value at the right, ahead and up of the box, in 255ths, and the sizes.
  const auto first = [&](const std::string& fields) {
    const VolumeGrid grid = Read(Counting(fields));
    EXPECT_EQ(grid.values().size(), 24U);
    return fmt::format("{:.0f} of {} {} {}", 255.0 * grid.At({1.0, 1.0, 1.0}), grid.size()[0],
                       grid.size()[1], grid.size()[2]);
  };
  EXPECT_EQ(first("space dimension: 3\nspace directions: (2,0,0) (0,3,0) (0,0,1)\n"),
            "23 of 4 3 2");
  EXPECT_EQ(first("space directions: (-1,0,0) (0,1,0) (0,0,1)\n"), "20 of 4 3 2");
  EXPECT_EQ(first("space directions: (1,0,0) (0,1,0) (0,0,-1)\n"), "11 of 4 3 2");
  EXPECT_EQ(first("space directions: (0,0,1) (1,0,0) (0,-1,0)\n"), "11 of 3 2 4");
  EXPECT_EQ(first("space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"),
            "12 of 4 3 2");
  EXPECT_EQ(first("space: RAS\nspace directions: ( -1 , 0 , 0 ) (0,1e-9,0) (0,0,1)\n"),
            "20 of 4 3 2");
}

TEST_F(Nrrd, DataMayBeInAFileOfTheirOwn) {
  const std::string raw = kFloats + "encoding: raw\n";
  WriteText(folder_ / "det data.raw", LittleEndian(kEight));
  WriteText(folder_ / "skip.raw", "P7\n# two lines\n12345" + LittleEndian(kEight));
  for (const char* fields : {"endian: little\ndata file: det data.raw",
                             "line skip: 2\nbyte skip: 5\ndatafile: skip.raw\n",
                             "byte skip: -1\ndata file: ./skip.raw\n\n"})
    EXPECT_EQ(Read(raw + fields, "det.nhdr").values(), kEight) << fields;
  std::string big = LittleEndian(kEight);
  for (auto at = big.begin(); at != big.end(); at += 4) std::reverse(at, at + 4);
  EXPECT_EQ(Read(raw + "endian: big\n\n" + big).values(), kEight);
  EXPECT_EQ(Fault(raw + "data file: none.raw\n"),
            (folder_ / "none.raw").string() + ": cannot be read");
}

TEST_F(Nrrd, ItsDataFileIsAnInput) {
  WriteText(folder_ / "det.nhdr",
            "NRRD0004\ntype: uint8\nsizes: 2 2 2\nencoding: raw\ndata file: a.raw");
  Scene scene;
  scene.volumes.emplace_back().grid = folder_ / "det.nhdr";
  const std::vector<NamedFile> files = FilesOf(scene);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[1].file, folder_ / "a.raw");
}

// Returns data compressed by gzip.
std::string Packed(std::string data) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, static_cast<uLong>(data.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(data.data());
  stream.avail_in = static_cast<uInt>(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST_F(Nrrd, GzipIsUnpackedAndItsDamageIsReported) {
  const std::string fields = kFloats + "encoding: GZ\n", bytes = LittleEndian(kEight);
  const std::string packed = Packed(bytes);
  EXPECT_EQ(Read(fields + "\n" + packed).values(), kEight);
  EXPECT_EQ(Read(fields + "byte skip: 3\n\n" + Packed("abc" + bytes)).values(), kEight)
      << "skipped bytes are packed too";
  EXPECT_EQ(Read(fields + "\n" + Packed(bytes.substr(0, 9)) + Packed(bytes.substr(9))).values(),
            kEight)
      << "files of gzip may be joined";
  EXPECT_THAT(Fault(fields + "\n"), HasSubstr("0 bytes of data; 2 x 2 x 2 floats are 32"));
  for (std::size_t length = 1; length < packed.size(); ++length) {
    EXPECT_THAT(Fault(fields + "\n" + packed.substr(0, length)),
                HasSubstr(fmt::format("the gzip data are cut off at byte {}", length)));
  }
  std::string damaged = packed;
  damaged[packed.size() / 2] = static_cast<char>(~damaged[packed.size() / 2]);
  EXPECT_NE(Fault(fields + "\n" + damaged), "no fault");
  EXPECT_THAT(Fault(fields + "\n" + bytes), HasSubstr("are damaged at"));
  EXPECT_THAT(Fault(fields + "\n" + Packed(bytes + "x")), HasSubstr("33 bytes of data"));
  EXPECT_THAT(Fault(fields + "byte skip: -1\n\n" + packed), HasSubstr("byte skip is -1"));
}

TEST_F(Nrrd, RawGridsOfAnotherLengthAreRefused) {
  const auto file = folder_ / "g.raw";
  WriteText(file, LittleEndian(std::vector<float>(12, 0.5F)));
  EXPECT_EQ(ReadRawGrid(file, {2, 3, 2}).largest(), 0.5);
  EXPECT_EQ(FaultOf([&] {
              (void)ReadRawGrid(file, {2, 3, 3});
            }),
            file.string() + ": 48 bytes of data; 2 x 3 x 3 floats are 72");
}

TEST_F(Nrrd, FilesOfOtherFormatsAreNamed) {
  using namespace std::string_view_literals;
  for (const auto& [name, bytes, format] :
       {std::tuple{"a.vdb", " BDV\0\0\0\0\xE0\0\0\0"sv, "this is OpenVDB"},
        {"a.npy", "\x93NUMPY\x01\0"sv, "this is a NumPy array"},
        {"a.nrrd.gz", "\x1F\x8B\x08\0"sv, "this is gzip-compressed"},
        {"a.mhd", "ObjectType = Image\n"sv, "this is MetaImage"},
        {"a.vti", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">"sv, "this is VTK"},
        {"a.h5", "\x89HDF\r\n\x1A\n"sv, "this is HDF5"}}) {
    WriteText(folder_ / name, std::string(bytes));
    const auto expected = AllOf(HasSubstr(std::string(name) + ": " + format),
                                HasSubstr("grids of volumes are read as NRRD or raw floats"));
    EXPECT_THAT(FaultOf([&] { return ReadNrrd(folder_ / name); }), expected);
    EXPECT_THAT(FaultOf([&] { return ReadRawGrid(folder_ / name, {2, 2, 2}); }), expected);
  }
  // Samples may begin like another format: their number decides.
  WriteText(folder_ / "g.raw", "BZh" + std::string(29, '\0'));
  EXPECT_EQ(FaultOf([&] { return ReadRawGrid(folder_ / "g.raw", {2, 2, 2}); }), "no fault");
}

TEST_F(Nrrd, NumbersDoNotFollowTheLocale) {
  const std::string text = Counting(
      "space directions: (0.5,0,0) (0,-1.5,0) (0,0,+2e-1)\n"
      "spacings: 1.5 +2.5 0.5\n");
  const VolumeGrid plain = Read(text);
  const tests::CommaLocale locale(folder_);
  EXPECT_EQ(Read(text).values(), plain.values());
  EXPECT_THAT(Fault(Counting("spacings: 1,5 1 1\n")), HasSubstr("they must be numbers"));
}

}  // namespace
}  // namespace alpenglow::renderer
