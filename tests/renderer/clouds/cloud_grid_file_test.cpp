// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_grid_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using tests::FaultOf;

class CloudGridFile : public TemporaryFolder {
 protected:
  [[nodiscard]] std::filesystem::path Written(const std::string& text) const {
    const std::filesystem::path file = folder_ / "field.txt";
    WriteText(file, text);
    return file;
  }
  /// Expects that a text is refused with "FILE:LINE: reason".
  void ExpectRefused(const std::string& text, const std::string& reason) const {
    const std::filesystem::path file = Written(text);
    tests::ExpectNames(FaultOf([&] { return ReadCloudGrid(file, true); }), file, reason);
  }
};

const char kHeader[] = "3 4 3   ! points\n0.1 0.05 # km\n1.0 1.02\n1.06\n";

TEST_F(CloudGridFile, PointsHaveTheirValues) {
  const CloudField field =
      ReadCloudGrid(Written(std::string(kHeader) + "2 3 1 50.0 8.0\n2 3 2 70.0 12.0\n"), false);
  // Point (2, 3) lies at 0.1 km and 2 * 0.05 km. Values are floats.
  EXPECT_NEAR(field.Extinction_per_m({100.0, 100.0, 1000.0}), 0.05, 1e-8);
  EXPECT_NEAR(field.Extinction_per_m({100.0, 100.0, 1020.0}), 0.07, 1e-8);
  EXPECT_NEAR(field.EffectiveRadius_um({100.0, 100.0, 1010.0}), 10.0, 1e-5) << "between 8 and 12";
  // The level of 1040 m is between 1020 m and 1060 m, where there is none.
  EXPECT_NEAR(field.Extinction_per_m({100.0, 100.0, 1040.0}), 0.035, 1e-8);
  EXPECT_EQ(field.Extinction_per_m({0.0, 0.0, 1000.0}), 0.0);
  EXPECT_FALSE(field.period_m());
  EXPECT_EQ(field.lattice().size_m(), glm::dvec3(200.0, 150.0, 60.0));
}

TEST_F(CloudGridFile, PeriodicFieldRepeatsAfterAllPoints) {
  const CloudField field = ReadCloudGrid(Written(std::string(kHeader) + "1 1 2 40\n"), true);
  EXPECT_EQ(field.period_m(), glm::dvec2(300.0, 200.0));
  EXPECT_NEAR(field.Extinction_per_m({300.0, -200.0, 1020.0}), 0.04, 1e-8) << "floats";
  EXPECT_NEAR(field.Extinction_per_m({250.0, 0.0, 1020.0}), 0.02, 1e-8) << "half a voxel before";
}

TEST_F(CloudGridFile, RefusesDamagedHeaders) {
  ExpectRefused("", ":0: the file ends before nx");
  ExpectRefused("3 4", ":1: the file ends before nz");
  ExpectRefused("3 x 3", ":1: ny is \"x\"; it must be a number in [2, 8192]");
  ExpectRefused("3.5 4 3", ":1: nx is 3.5; it must be a whole number");
  ExpectRefused("8000 8000 8000", "8000 x 8000 x 8000 points; there may be 200000000 at most");
  ExpectRefused("3 4 3\n-0.1 0.1 1 2 3", ":2: dx is \"-0.1\"; it must be a number in [1e-06, 100]");
  ExpectRefused("3 4 3\n0.1 0.1 1 2 2", ":2: the altitudes do not ascend");
  ExpectRefused("3 4 3\n0.1 0.1 1 2 3 4", ":2: more numbers than nz altitudes");
}

TEST_F(CloudGridFile, RefusesDamagedPoints) {
  const std::string header = kHeader;
  ExpectRefused(header + "1 1 1", ":5: 3 numbers; a line has i, j, k");
  ExpectRefused(header + "1 5 1 2.0", ":5: j is \"5\"; it must be a number in [1, 4]");
  ExpectRefused(header + "1 1 1 -2.0", ":5: extinction is \"-2.0\"; it must be a number in [0, ");
  ExpectRefused(header + "1 1 1 nan", ":5: extinction is \"nan\"");
  ExpectRefused(header + "1 1 1 2 0", ":5: effective radius is \"0\"");
  ExpectRefused(header + "1 1 1 2\n1 1 1 3", ":6: this point has a line already");
}

TEST_F(CloudGridFile, RefusesFilesThatCannotBeRead) {
  const std::filesystem::path file = folder_ / "missing.txt";
  tests::ExpectNames(FaultOf([&] { return ReadCloudGrid(file, true); }), file, "cannot be read");
  tests::ExpectNames(FaultOf([&] { return ReadCloudGrid(folder_, true); }), folder_,
                     "cannot be read");
}

}  // namespace
}  // namespace alpenglow::renderer
