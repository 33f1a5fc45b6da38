// SPDX-License-Identifier: MIT
#include "renderer/scene/cloud_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "renderer/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

template <typename Number>
std::string CloudBytes(Number number) {
  std::string bytes(sizeof(Number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(Number));
  return bytes;
}

std::string CloudBytes(const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) bytes += CloudBytes(value);
  return bytes;
}

using VdbFloats = openvdb::FloatGrid;

/// Returns a grid "density" of 8^3 values in steps of 50 units of its file.
/// @param value_at  a function of the indices.
template <typename ValueAt>
VdbFloats::Ptr VdbCube(const ValueAt& value_at) {
  openvdb::initialize();
  VdbFloats::Ptr grid = VdbFloats::create();
  grid->setName("density");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(50.0));
  for (int z = 0; z < 8; ++z) {
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x)
        grid->getAccessor().setValue({x, y, z}, static_cast<float>(value_at(x, y, z)));
    }
  }
  return grid;
}

VdbFloats::Ptr VdbOfEvenDensity() {
  return VdbCube([](int, int, int) { return 0.5; });
}

VdbFloats::Ptr VdbOfNumbers() {
  return VdbCube([](int x, int y, int z) { return 64 * x + 8 * y + z; });
}

openvdb::GridBase::Ptr VdbOfVelocities() {
  const openvdb::Vec3SGrid::Ptr grid = openvdb::Vec3SGrid::create();
  grid->setName("vel");
  grid->getAccessor().setValue({1, 1, 1}, openvdb::Vec3s(1.0F));
  return grid;
}

class CloudFile : public TemporaryFolder {
 protected:
  [[nodiscard]] std::filesystem::path Written(const std::string& name,
                                              const std::string& bytes) const {
    WriteText(folder_ / name, bytes);
    return folder_ / name;
  }
  void ExpectRefused(const std::filesystem::path& file, const CloudFileOptions& options,
                     const std::string& reason) const {
    tests::ExpectNames(tests::FaultOf([&] { return ReadCloudField(file, options); }), file, reason);
  }
  [[nodiscard]] std::filesystem::path WrittenVdb(
      const openvdb::GridPtrVec& grids,
      std::uint32_t compression = openvdb::io::COMPRESS_ACTIVE_MASK) const {
    openvdb::io::File file((folder_ / "x.vdb").string());
    file.setCompression(compression);
    file.write(grids);
    return folder_ / "x.vdb";
  }
};

const CloudFileOptions kEvery100m{.spacing_m = glm::dvec3(100.0), .extinction_per_m = 0.1};

TEST_F(CloudFile, VdbOfAnyCompressionHasItsValues) {
  using namespace openvdb::io;  // NOLINT: names of compressions
  const std::vector<std::uint32_t> compressions{COMPRESS_NONE, COMPRESS_ZIP | COMPRESS_ACTIVE_MASK,
                                                COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK};
  for (const std::uint32_t compression : compressions) {
    for (const bool is_half : {false, true}) {
      const VdbFloats::Ptr grid = VdbOfNumbers();
      grid->setSaveFloatAsHalf(is_half);
      const CloudField field = ReadCloudField(WrittenVdb({grid}, compression));
      EXPECT_EQ(field.lattice().voxel_m, glm::dvec3(50.0));
      // One voxel of background surrounds the box.
      EXPECT_EQ(field.lattice().origin_m, glm::dvec3(-50.0));
      EXPECT_NEAR(field.Extinction_per_m({50.0, 100.0, 150.0}), 64 + 2 * 8 + 3, 1e-4) << "floats";
      EXPECT_EQ(field.Extinction_per_m({-50.0, 0.0, 0.0}), 0.0);
    }
  }
}

TEST_F(CloudFile, VdbIsAtThePlaceOfItsTransform) {
  const VdbFloats::Ptr grid = VdbOfNumbers();
  grid->transform().postScale(openvdb::Vec3d(1.0, 2.0, 0.5));
  grid->transform().postTranslate(openvdb::Vec3d(1000.0, 2000.0, 500.0));
  const CloudField field =
      ReadCloudField(WrittenVdb({grid}), {.origin_m = {0.0, 0.0, 10.0}, .extinction_per_m = 0.01});
  EXPECT_EQ(field.lattice().voxel_m, glm::dvec3(50.0, 100.0, 25.0));
  EXPECT_NEAR(field.Extinction_per_m({1050.0, 2200.0, 510.0 + 75.0}), 0.01 * (64 + 16 + 3), 1e-6)
      << "floats";
}

TEST_F(CloudFile, TilesOfAVdbAreFilled) {
  const VdbFloats::Ptr grid = VdbFloats::create();
  grid->fill({{0, 0, 0}, {63, 63, 63}}, 0.25F);
  const CloudField field = ReadCloudField(WrittenVdb({grid}));
  EXPECT_NEAR(field.Extinction_per_m({31.0, 40.0, 50.0}), 0.25, 1e-6);
  EXPECT_EQ(field.lattice().voxels, (std::array<int, 3>{65, 65, 65}));
}

TEST_F(CloudFile, VdbWithYUpIsTurned) {
  const CloudField field = ReadCloudField(WrittenVdb({VdbOfNumbers()}), {.is_y_up = true});
  // Index (1, 2, 3): y is the altitude, and z runs to the south.
  EXPECT_NEAR(field.Extinction_per_m({50.0, -150.0, 100.0}), 64 + 2 * 8 + 3, 1e-4) << "floats";
}

TEST_F(CloudFile, NrrdAndRawHaveTheSameValues) {
  std::vector<float> values;
  for (int i = 0; i < 24; ++i) values.push_back(static_cast<float>(i));
  const std::string bytes = CloudBytes(values);
  const auto nrrd = Written("x.nrrd",
                            "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n"
                            "endian: little\n\n" +
                                bytes);
  CloudFileOptions raw = kEvery100m;
  raw.samples = {2, 3, 4};
  for (const CloudField& field :
       {ReadCloudField(nrrd, kEvery100m), ReadCloudField(Written("x.raw", bytes), raw)}) {
    EXPECT_EQ(field.lattice().size_m(), glm::dvec3(100.0, 200.0, 300.0));
    EXPECT_NEAR(field.Extinction_per_m({0.0, 100.0, 200.0}), 0.1 * (2 * (1 + 3 * 2)), 1e-6)
        << "floats";
    EXPECT_NEAR(field.Extinction_per_m({50.0, 100.0, 200.0}), 0.1 * (0.5 + 2 * (1 + 3 * 2)), 1e-6);
    EXPECT_FALSE(field.period_m());
  }
  CloudFileOptions periodic = kEvery100m;
  periodic.is_periodic = true;
  EXPECT_EQ(ReadCloudField(nrrd, periodic).period_m(), glm::dvec2(200.0, 300.0));
}

TEST_F(CloudFile, TextIsThatOfOtherRadiativeTransferCodes) {
  const auto file = Written("x.txt", "2 2 2\n0.1 0.1\n1.0 1.1\n1 1 1 40 8\n");
  const CloudField field = ReadCloudField(file, {.origin_m = {10.0, 20.0, 0.0}});
  EXPECT_NEAR(field.Extinction_per_m({10.0, 20.0, 1000.0}), 0.04, 1e-8) << "floats";
  ExpectRefused(file, kEvery100m, "text has the spacing and the altitudes");
}

TEST_F(CloudFile, RefusesUnknownEndingsAndMissingOptions) {
  ExpectRefused(Written("x.bin", "abc"), {}, "must be .txt, .dat, .vdb, .nrrd, .nhdr or .raw");
  ExpectRefused(folder_ / "none.vdb", {}, "cannot be read");
  ExpectRefused(Written("x.raw", "abcd"), {}, "need the numbers and the spacing");
  ExpectRefused(Written("x.nrrd", ""), {}, "need the spacing");
  EXPECT_THAT(tests::FaultOf([&] {
                return ReadCloudField(WrittenVdb({VdbOfEvenDensity()}), {.extinction_per_m = -1.0});
              }),
              testing::HasSubstr("the extinction of the density 1 [1/m] is -1"));
}

TEST_F(CloudFile, RefusesSizesThatDoNotMatch) {
  CloudFileOptions options = kEvery100m;
  options.samples = {2, 2, 3};
  ExpectRefused(Written("x.raw", std::string(32, '\0')), options,
                "32 bytes of data; 2 x 2 x 3 floats are 48");
  options.samples = {1000, 1000, 1000};
  ExpectRefused(Written("x.raw", std::string(32, '\0')), options,
                "1000 x 1000 x 1000 samples; there may be 200000000 at most");
  ExpectRefused(Written("x.nrrd",
                        "NRRD0004\ntype: float\ndimension: 3\nsizes: 900 900 900\n"
                        "encoding: raw\nendian: little\n\n"),
                kEvery100m, "900 x 900 x 900 samples; there may be 200000000 at most");
}

TEST_F(CloudFile, RefusesDensitiesThatAreNone) {
  for (const float wrong : {-0.5F, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    const VdbFloats::Ptr grid = VdbOfEvenDensity();
    grid->getAccessor().setValue({0, 1, 0}, wrong);
    ExpectRefused(WrittenVdb({grid}), {}, "densities must be finite and not negative");
    CloudFileOptions options = kEvery100m;
    options.samples = {2, 2, 2};
    std::vector<float> values(8, 1.0F);
    values[5] = wrong;
    ExpectRefused(Written("x.raw", CloudBytes(values)), options, "value 5 of the grid is ");
  }
}

TEST_F(CloudFile, RefusesVdbWithoutAGridOfFloats) {
  ExpectRefused(WrittenVdb({VdbOfVelocities()}), {},
                "there is no grid of floats; the file has \"vel\" (vec3s)");
  const auto both = WrittenVdb({VdbOfVelocities(), VdbOfEvenDensity()});
  EXPECT_EQ(tests::FaultOf([&] { return ReadCloudField(both); }), "no fault");
  ExpectRefused(both, {.grid = "vel"}, "there is no grid \"vel\" of floats");
  ExpectRefused(both, {.grid = "smoke"}, "there is no grid \"smoke\" of floats");
  ExpectRefused(WrittenVdb({VdbFloats::create()}), {}, "the grid has no active values");
}

TEST_F(CloudFile, RefusesVdbOfOtherForms) {
  ExpectRefused(Written("x.vdb", "NanoVDB0abcdefgh"), {}, "OpenVDB cannot read it: ");
  const VdbFloats::Ptr turned = VdbOfEvenDensity();
  turned->transform().postRotate(0.1, openvdb::math::X_AXIS);
  ExpectRefused(WrittenVdb({turned}), {}, "the transform turns or shears the grid");
  const VdbFloats::Ptr wide = VdbOfEvenDensity();
  wide->getAccessor().setValue({900, 900, 900}, 1.0F);
  ExpectRefused(WrittenVdb({wide}), {},
                "a box of 901 x 901 x 901 values; there may be 200000000 at most");
}

TEST_F(CloudFile, RefusesATruncatedVdb) {
  const std::string whole = ContentOf(WrittenVdb({VdbOfNumbers()}));
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    const auto file = Written("x.vdb", whole.substr(0, length));
    tests::ExpectNames(tests::FaultOf([&] { return ReadCloudField(file); }), file, "");
  }
}

}  // namespace
}  // namespace alpenglow::renderer
