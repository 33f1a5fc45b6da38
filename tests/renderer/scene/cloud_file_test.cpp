// SPDX-License-Identifier: MIT
#include "renderer/scene/cloud_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "renderer/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

std::filesystem::path StoredCloud(const std::string& name) {
  return std::filesystem::path(tests::kSourceFolder) / "tests" / "data" / "clouds" / name;
}

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

std::string VdbText(const std::string& text) {
  return CloudBytes(static_cast<std::uint32_t>(text.size())) + text;
}

std::string VdbVector(double value) {
  return CloudBytes(value) + CloudBytes(value) + CloudBytes(value);
}

/// A file with one leaf at the indices 0 to 7, all of whose values are active.
struct VdbSample {
  std::uint32_t version = 224;
  std::string type = "Tree_float_5_4_3";
  std::string transform = VdbText("UniformScaleMap") + VdbVector(50.0) + VdbVector(50.0) +
                          VdbVector(0.02) + VdbVector(0.0004) + VdbVector(0.01);
  std::uint32_t compression = 2;
  float background = 0.0F;
  std::vector<float> values = std::vector<float>(512, 0.5F);  // z fastest

  [[nodiscard]] std::string Bytes() const {
    const std::string none(4, '\0');
    std::string bytes = std::string(" BDV\0\0\0\0", 8) + CloudBytes(version) +
                        CloudBytes(std::uint64_t{0}) + '\1' + std::string(36, '-') + none +
                        CloudBytes(std::int32_t{1}) + VdbText("density") + VdbText(type) +
                        VdbText("");
    const std::string grid = CloudBytes(compression) + none + transform + Tree();
    const auto place = static_cast<std::int64_t>(bytes.size() + 24);
    const auto end = place + static_cast<std::int64_t>(grid.size());
    return bytes + CloudBytes(place) + CloudBytes(place) + CloudBytes(end) + grid;
  }

 private:
  [[nodiscard]] std::string Tree() const {
    const auto node = [](std::size_t mask_bytes) {
      // The first child, no active value, and no inactive value but the background.
      return '\1' + std::string(2 * mask_bytes - 1, '\0') + '\0';
    };
    return CloudBytes(std::int32_t{1}) + CloudBytes(background) + CloudBytes(std::uint32_t{0}) +
           CloudBytes(std::uint32_t{1}) + std::string(12, '\0') + node(4096) + node(512) +
           std::string(128, '\xFF') + '\0' + CloudBytes(values);
  }
};

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
  void ExpectVdbRefused(const VdbSample& sample, const std::string& reason,
                        const CloudFileOptions& options = {}) const {
    ExpectRefused(Written("x.vdb", sample.Bytes()), options, reason);
  }
};

const CloudFileOptions kEvery100m{.spacing_m = glm::dvec3(100.0), .extinction_per_m = 0.1};

// The files of tests/data/clouds were written by OpenVDB 10.0.1.
TEST_F(CloudFile, VdbOfOpenVdbHasItsValues) {
  for (const char* name : {"blosc", "zip", "half"}) {
    const CloudField field =
        ReadCloudField(StoredCloud("" + std::string(name) + ".vdb"),
                       {.origin_m = {0.0, 0.0, 10.0}, .extinction_per_m = 0.01});
    int inside = 0;
    for (int z = -6; z <= 6; ++z) {
      for (int y = -6; y <= 6; ++y) {
        for (int x = -6; x <= 6; ++x) {
          const glm::dvec3 place =
              glm::dvec3(100.0, 200.0, 1010.0) + 25.0 * glm::dvec3(20 + x, 21 + y, 22 + z);
          const bool is_inside = x * x + y * y + z * z <= 25;
          const double density = is_inside ? 0.0625 * (1 + (x + 2 * y + 3 * z + 64) % 16) : 0.0;
          inside += is_inside ? 1 : 0;
          ASSERT_NEAR(field.Extinction_per_m(place), 0.01 * density, 1e-8)
              << name << " " << x << " " << y << " " << z << ": values are floats";
        }
      }
    }
    EXPECT_EQ(inside, 515);
  }
}

TEST_F(CloudFile, VdbWithoutCompressionHasItsValues) {
  VdbSample sample;
  for (std::size_t i = 0; i < 512; ++i) sample.values[i] = static_cast<float>(i);
  const CloudField field = ReadCloudField(Written("x.vdb", sample.Bytes()));
  EXPECT_EQ(field.lattice().voxel_m, glm::dvec3(50.0));
  // One voxel of background surrounds the box.
  EXPECT_EQ(field.lattice().origin_m, glm::dvec3(-50.0));
  EXPECT_NEAR(field.Extinction_per_m({50.0, 100.0, 150.0}), 64 + 2 * 8 + 3, 1e-4) << "floats";
  EXPECT_EQ(field.Extinction_per_m({-50.0, 0.0, 0.0}), 0.0);
}

TEST_F(CloudFile, VdbWithYUpIsTurned) {
  VdbSample sample;
  for (std::size_t i = 0; i < 512; ++i) sample.values[i] = static_cast<float>(i);
  const CloudField field = ReadCloudField(Written("x.vdb", sample.Bytes()), {.is_y_up = true});
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
                return ReadCloudField(Written("x.vdb", VdbSample{}.Bytes()),
                                      {.extinction_per_m = -1.0});
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
    VdbSample sample;
    sample.values[8] = wrong;
    ExpectVdbRefused(sample, "densities must be finite and not negative");
    CloudFileOptions options = kEvery100m;
    options.samples = {2, 2, 2};
    std::vector<float> values(8, 1.0F);
    values[5] = wrong;
    ExpectRefused(Written("x.raw", CloudBytes(values)), options, "value 5 of the grid is ");
  }
}

TEST_F(CloudFile, RefusesVdbWithoutAGridOfFloats) {
  ExpectRefused(StoredCloud("vec.vdb"), {},
                "there is no grid of floats; the file has \"vel\" (Tree_vec3s_5_4_3)");
  ExpectRefused(StoredCloud("blosc.vdb"), {.grid = "vel"},
                "grid \"vel\" is Tree_vec3s_5_4_3; it must be Tree_float_5_4_3");
  ExpectRefused(StoredCloud("blosc.vdb"), {.grid = "smoke"},
                "there is no grid \"smoke\" of floats");
  ExpectVdbRefused({.type = "Tree_float_5_5_3"}, "the file has \"density\" (Tree_float_5_5_3)");
}

TEST_F(CloudFile, RefusesVdbOfOtherForms) {
  ExpectRefused(Written("x.vdb", "NanoVDB0abcdefgh"), {}, "this is not an OpenVDB file");
  ExpectVdbRefused({.version = 221}, "version 221 are not read; it must be in [222, 224]");
  ExpectVdbRefused({.compression = 8}, "the compression 8 is not read");
  ExpectVdbRefused({.transform = VdbText("NonlinearFrustumMap")},
                   "the transform \"NonlinearFrustumMap\" is not read");
  ExpectVdbRefused({.transform = VdbText("AffineMap") + std::string(16 * 8, '\x3F')},
                   "the transform turns or shears the grid");
  ExpectVdbRefused({.transform = VdbText("ScaleMap") + std::string(15 * 8, '\0')},
                   "the transform has the scale 0");
}

TEST_F(CloudFile, RefusesEveryTruncationOfAVdb) {
  for (const std::string& whole : {VdbSample{}.Bytes(), ContentOf(StoredCloud("blosc.vdb")),
                                   ContentOf(StoredCloud("zip.vdb"))}) {
    for (std::size_t length = 0; length < whole.size(); length += length < 400 ? 1 : 97) {
      const auto file = Written("x.vdb", whole.substr(0, length));
      tests::ExpectNames(tests::FaultOf([&] { return ReadCloudField(file); }), file, "");
    }
  }
}

TEST_F(CloudFile, DamagedVdbIsReadOrRefused) {
  // Any byte may be wrong; no other error than InputError may leave the reader.
  const std::string whole = ContentOf(StoredCloud("blosc.vdb"));
  int refused = 0;
  for (std::size_t at = 8; at < whole.size(); at += 61) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ '\x5A');
    const auto file = Written("x.vdb", damaged);
    refused += tests::FaultOf([&] { return ReadCloudField(file); }) != "no fault" ? 1 : 0;
  }
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace alpenglow::renderer
