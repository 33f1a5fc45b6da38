// SPDX-License-Identifier: MIT
#include "renderer/terrain/obj_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

double AreaOf(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 corner = ToDouble(mesh.positions[a]);
    sum += 0.5 * glm::length(glm::cross(ToDouble(mesh.positions[b]) - corner,
                                        ToDouble(mesh.positions[c]) - corner));
  }
  return sum;
}

class ObjFile : public ::testing::Test {
 protected:
  ~ObjFile() override { fs::remove(file_); }

  ObjMesh ReadAll(const std::string& text, UpAxis up = UpAxis::kZ) const {
    std::ofstream(file_, std::ios::binary) << text;
    return ReadObj(file_, up);
  }
  /// Reads a file that gives no cause for a message.
  TriangleMesh Read(const std::string& text) const {
    ObjMesh read = ReadAll(text);
    EXPECT_EQ(read.message, "") << text;
    return std::move(read.mesh);
  }
  void ExpectRefused(const std::string& text, const std::string& fault) const {
    try {
      static_cast<void>(ReadAll(text));
      ADD_FAILURE() << "was read: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
      EXPECT_THAT(error.what(), HasSubstr(fault));
      EXPECT_THAT(error.what(), Not(HasSubstr("\n"))) << "a message is one line";
    }
  }
  void ExpectSquare(const std::string& text) const {
    const TriangleMesh mesh = Read(text);
    EXPECT_EQ(mesh.triangles.size(), 2U) << text;
    EXPECT_NEAR(AreaOf(mesh), 400.0, 1e-4) << text;
  }

  fs::path file_ =
      fs::path(::testing::TempDir()) /
      (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".obj");
};

const std::string kCorners = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 5\n";
const std::string kSquare = "v -10 -10 0\nv 10 -10 0\nv 10 10 0\nv -10 10 0\n";

TEST_F(ObjFile, TrianglesAndPolygonsAreRead) {
  const TriangleMesh mesh = Read(kCorners + "f 1 2 3\nf 2/1 4/2 3/3\n");
  ASSERT_EQ(mesh.positions.size(), 4U);
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_GT(mesh.normals[0][2], 0.99F) << "counter-clockwise seen from above faces the sky";
  EXPECT_EQ(Read(kCorners + "f 1 2 4 3\n").triangles.size(), 2U);
}

TEST_F(ObjFile, LineEndsCommentsAndRelativeIndicesAreAsUsual) {
  EXPECT_EQ(Read("# hill\r\nv 0 0 0\r\nv 10 0 0\r\nv 0 10 0\r\nf 1 2 3\r\n").triangles.size(), 1U);
  EXPECT_EQ(Read("v 0 0 0\rv 10 0 0\rv 0 10 0\rf 1 2 3\r").triangles.size(), 1U);
  EXPECT_EQ(Read(kCorners + "f 1 2 3").triangles.size(), 1U) << "no final newline";
  EXPECT_EQ(Read(kCorners + "f -4 -3 -2\n").triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(Read("v 1e2 -1.5e+1 .5\n" + kCorners + "f 2 3 4\n").positions[0],
            (std::array<float, 3>{100.0F, -15.0F, 0.5F}));
}

TEST_F(ObjFile, AStatementMayGoOnInTheNextLine) {
  ExpectSquare(kSquare + "f 1 2 \\\n3 4\n");
  ExpectSquare(kSquare + "f 1 2 \\\r\n\t3 4\r\n");
  ExpectSquare(kSquare + "f 1 2\\\n3\\\n4\n");
  ExpectSquare(kSquare + "f 1 2 \\  \n  3 4");
  ExpectSquare("v -10 \\\n-10 0\nv 10 -10 0\nv 10 10 0\nv -10 10 0\nf 1 2 3 4\n");
  ExpectSquare(kSquare + "usemtl C:\\stone\\\nf 1 2 3 4\n");
}

TEST_F(ObjFile, NumbersMayHaveAPlusAndExponents) {
  ExpectSquare("v -10 -10 0\nv +10 -10 0\nv +10 +10 0\nv -10 +10 0\nf 1 2 3 4\n");
  ExpectSquare("v -1e1 -1E+1 0\nv +1.0e+01 -10 1e-400\nv 10. 10 -0\nv -10 10 .0\nf +1 2 3 4\n");
}

TEST_F(ObjFile, CommentsMayFollowAnything) {
  ExpectSquare(kSquare + "f 1 2 3 4  # a face\n");
  ExpectSquare("v -10 -10 0#x\nv 10 -10 0 # \\\nv 10 10 0\nv -10 10 0\n#\\\nf 1 2 3 4# 5\n");
  ExpectSquare(kSquare + "s off # flat\nf 1 2 3 4\n");
}

TEST_F(ObjFile, AByteOrderMarkTabsAndTheEndOfDosFilesAreRead) {
  ExpectSquare("\xef\xbb\xbf" + kSquare + "f 1 2 3 4\n");
  ExpectSquare("\xef\xbb\xbf# made by hand\n" + kSquare + "f 1 2 3 4\n");
  ExpectSquare("\tv\t-10\t-10\t0\n v 10 -10 0\nv 10 10 0\nv -10 10 0\n\tf\t1 2\t3 4\t\n\x1a");
  ExpectRefused("\xff\xfev", "UTF-16");
}

TEST_F(ObjFile, WhatMakesNoSurfaceIsPassedOver) {
  ExpectSquare("mtllib a b.mtl\no square\ng first second\nusemtl stone\n" + kSquare +
               "vt 0 0\nvt 1 0 0\nvp 0.3 0.2\np 1 2\nl 1 2 3\nf 1/1 2/2 3/1 4/2\n");
  ExpectSquare(
      "v -10 -10 0 1.0\nv 10 -10 0 0.5 0.5 0.5\nv 10 10 0 255 0 0 1\nv -10 10 0\n"
      "f 1// 2/ 3 4//\n");
  const std::string message = ReadAll(kSquare + "f 1 2 3 4\ncstype bezier\ndeg 3\n").message;
  EXPECT_THAT(message, HasSubstr("2 statements not read (the first, \"cstype\", in line 6)"));
}

TEST_F(ObjFile, AFaceMayComeBeforeItsVertices) { ExpectSquare("f 1 2 3 4\n" + kSquare); }

TEST_F(ObjFile, APolygonHasItsAreaWhateverItsForm) {
  EXPECT_NEAR(AreaOf(Read("v -3 -8 20\nv 0 -2 20\nv 3 -8 20\nv 0 10 20\nf 1 2 3 4\n")), 36.0, 1e-4);
  EXPECT_NEAR(AreaOf(Read("v 0 0 0\nv 0 4 0\nv 0 4 4\nv 0 2 1\nv 0 0 4\nf 1 2 3 4 5\n")), 10.0,
              1e-4)
      << "on a wall";
}

TEST_F(ObjFile, NormalsOfTheFileAreKept) {
  const std::string wall = "v 0 0 0\nv 10 0 0\nv 10 0 10\nv 0 0 10\n";
  const TriangleMesh mesh =
      Read(wall + "vn 0 -2 0\nvn 0 -3e-200 4e-200\nf 1//1 2//2 3/7/1 4//-2\n");
  EXPECT_EQ(mesh.normals[0], (std::array<float, 3>{0.0F, -1.0F, 0.0F}));
  EXPECT_NEAR(mesh.normals[1][1], -0.6F, 1e-6F) << "of any length";
  EXPECT_NEAR(mesh.normals[1][2], 0.8F, 1e-6F);
  EXPECT_EQ(mesh.positions.size(), 4U);
}

TEST_F(ObjFile, AnEdgeWithTwoNormalsStaysSharp) {
  const std::string roof = "v 0 0 5\nv 10 0 5\nv 10 -5 0\nv 0 -5 0\nv 10 5 0\nv 0 5 0\n";
  const TriangleMesh mesh =
      Read(roof + "vn 0 -1 1\nvn 0 1 1\nf 1//1 4//1 3//1 2//1\nf 2//2 5//2 6//2 1//2\n");
  ASSERT_EQ(mesh.positions.size(), 8U) << "the ridge has two vertices at each end";
  ASSERT_EQ(mesh.normals.size(), 8U);
  for (const auto& triangle : mesh.triangles) {
    const float side = mesh.normals[triangle[0]][1];
    EXPECT_NEAR(std::abs(side), std::sqrt(0.5F), 1e-6F);
    for (const std::uint32_t corner : triangle) EXPECT_EQ(mesh.normals[corner][1], side);
  }
}

TEST_F(ObjFile, SmoothingGroupsAndSOffAreHonoured) {
  const std::string roof = "v 0 0 5\nv 10 0 5\nv 10 -5 0\nv 0 -5 0\nv 10 5 0\nv 0 5 0\n";
  const std::string south = "f 1 4 3 2\n", north = "f 2 5 6 1\n";
  const auto up_of_ridge = [&](const std::string& text) { return Read(text).normals[0][2]; };
  const float flat = std::sqrt(0.5F);
  EXPECT_GT(up_of_ridge(roof + south + north), 0.9F) << "without s: one surface";
  EXPECT_GT(up_of_ridge(roof + "s 1\n" + south + north), 0.9F);
  EXPECT_GT(up_of_ridge(roof + "s on\n" + south + north), 0.9F);
  EXPECT_NEAR(up_of_ridge(roof + "s 1\n" + south + "s 2\n" + north), flat, 1e-6F);
  EXPECT_NEAR(up_of_ridge(roof + "s off\n" + south + north), flat, 1e-6F);
  EXPECT_NEAR(up_of_ridge(roof + "s 0\n" + south + north), flat, 1e-6F);
  EXPECT_EQ(Read(roof + "s off\n" + south + north).positions.size(), 8U);
  ExpectRefused(roof + "s smooth\n" + south, ":7: smoothing group 'smooth'");
}

TEST_F(ObjFile, ATriangleIsTurnedToTheSideOfItsNormals) {
  const TriangleMesh mesh = Read(kSquare + "vn 0 0 1\nf 4//1 3//1 2//1 1//1\n");
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 corner = ToDouble(mesh.positions[a]);
    EXPECT_GT(
        glm::cross(ToDouble(mesh.positions[b]) - corner, ToDouble(mesh.positions[c]) - corner).z,
        0.0);
  }
}

TEST_F(ObjFile, NormalsWithoutDirectionAreCountedAndReplaced) {
  const ObjMesh read = ReadAll(kSquare + "vn 0 0 0\nvn nan 0 1\nf 1//1 2//2 3//1 4//1\n");
  EXPECT_THAT(read.message, HasSubstr("2 normals without direction"));
  for (const auto& normal : read.mesh.normals)
    EXPECT_EQ(normal, (std::array<float, 3>{0.0F, 0.0F, 1.0F}));
}

TEST_F(ObjFile, FacesWithoutAreaAreLeftOutAndCounted) {
  const ObjMesh read = ReadAll(kSquare + "f 1 2 3 4\nf 1 1 2\nf 1 3 1\n");
  EXPECT_EQ(read.mesh.triangles.size(), 2U);
  EXPECT_EQ(read.message, file_.string() + ": 2 faces without area left out (the first in line 6)");
  ExpectRefused(kCorners + "f 1 2 2\n", "has no triangles; no face has an area");
  ExpectRefused("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "no face has an area");
}

TEST_F(ObjFile, APolygonThatCrossesItselfIsCounted) {
  EXPECT_THAT(ReadAll(kSquare + "f 1 3 2 4\n").message, HasSubstr("1 face whose edges cross"));
}

TEST_F(ObjFile, WithYUpTheYAxisPointsUp) {
  const ObjMesh read =
      ReadAll("v 1 2 3\nv 11 2 3\nv 1 2 -7\nvn 0 1 0\nf 1//1 2//1 3//1\n", UpAxis::kY);
  EXPECT_EQ(read.message, "");
  EXPECT_EQ(read.mesh.positions[0], (std::array<float, 3>{1.0F, -3.0F, 2.0F})) << "z is south";
  EXPECT_EQ(read.mesh.normals[0], (std::array<float, 3>{0.0F, 0.0F, 1.0F}));
  const glm::dvec3 a = ToDouble(read.mesh.positions[0]);
  EXPECT_GT(
      glm::cross(ToDouble(read.mesh.positions[1]) - a, ToDouble(read.mesh.positions[2]) - a).z, 0.0)
      << "a turn keeps the side that faces the sky";
}

TEST_F(ObjFile, CoordinatesOfAMapAreSaidToBeFarFromThePlace) {
  const auto square_at = [](double east, double north, double width) {
    std::string text;
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
      text += "v " + std::to_string(east + x * width) + " " + std::to_string(north + y * width) +
              " 500\n";
    }
    return text + "f 1 2 3 4\n";
  };
  const std::string message = ReadAll(square_at(446000.0, 5150000.0, 20.0)).message;
  EXPECT_THAT(message, HasSubstr("446000 to 446020 m east"));
  EXPECT_THAT(message, HasSubstr("5150000 to 5150020 m north"));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
  EXPECT_NE(ReadAll(square_at(500000.0, 0.0, 20000.0)).message, "")
      << "an offset to the east alone";
  EXPECT_NE(ReadAll(square_at(40000.0, 60000.0, 200.0)).message, "") << "a grid of a site";
  for (const double km : {0.0, 5.0, 33.0, 72.0, 150.0})
    EXPECT_EQ(ReadAll(square_at(1e3 * km, 0.0, 20000.0)).message, "") << "mountains at " << km;
  EXPECT_EQ(ReadAll(square_at(5000.0, 5000.0, 20.0)).message, "") << "a house";
  EXPECT_EQ(ReadAll(square_at(-300e3, -300e3, 600e3)).message, "") << "around the place";
}

TEST_F(ObjFile, AFanKeepsTheNormalsOfAllItsFaces) {
  constexpr int kFaces = 6000;
  std::string text = "v 0 0 10\n";
  for (int i = 0; i < kFaces; ++i) {
    const double angle = 2.0 * 3.14159265 * i / kFaces;
    text += "v " + std::to_string(1000.0 * std::cos(angle)) + " " +
            std::to_string(1000.0 * std::sin(angle)) + " 0\nvn " + std::to_string(std::cos(angle)) +
            " " + std::to_string(std::sin(angle)) + " 1\n";
  }
  for (int i = 1; i <= kFaces; ++i) {
    const std::string n = "//" + std::to_string(i) + " ";
    text += "f 1" + n + std::to_string(i + 1) + n + std::to_string(i % kFaces + 2) + n + "\n";
  }
  const TriangleMesh mesh = Read(text);
  EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(kFaces));
  EXPECT_EQ(mesh.positions.size(), static_cast<std::size_t>(3 * kFaces));
}

TEST_F(ObjFile, BadOnesAreRefusedByLine) {
  ExpectRefused("", "no triangles");
  ExpectRefused(kCorners, "no triangles");
  ExpectRefused("v 0 0 nan\n" + kCorners + "f 1 2 3\n", ":1: coordinate 'nan'");
  ExpectRefused(kCorners + "v inf 0 0\nf 1 2 3\n", ":5: coordinate 'inf'");
  ExpectRefused("v 0 0 1e30\n" + kCorners + "f 1 2 3\n", ":1: coordinate '1e30'");
  ExpectRefused("v 0 0 1e999\n" + kCorners + "f 1 2 3\n", ":1: coordinate '1e999'");
  ExpectRefused("v 0 0 x\n" + kCorners + "f 1 2 3\n", ":1: coordinate 'x'");
  ExpectRefused("v 0 0 +-1\n" + kCorners + "f 1 2 3\n", ":1: coordinate '+-1'");
  ExpectRefused("v 0,5 0 1\n" + kCorners + "f 1 2 3\n", ":1: coordinate '0,5'");
  ExpectRefused("v 0 0\n" + kCorners + "f 1 2 3\n", ":1: a vertex of fewer");
  ExpectRefused("vn 0 0\n" + kCorners + "f 1 2 3\n", ":1: a normal of fewer");
  ExpectRefused("vn 0 0 up\n" + kCorners + "f 1 2 3\n", ":1: coordinate 'up'");
  ExpectRefused(kCorners + "f 1 2 9\n", ":5: vertex 9; there are 4");
  ExpectRefused(kCorners + "f 1 2 \\\n9\n", ":5: vertex 9; there are 4");
  ExpectRefused(kCorners + "f 0 1 2\n", ":5: vertex 0");
  ExpectRefused(kCorners + "f -9 1 2\n", ":5: vertex -9");
  ExpectRefused(kCorners + "f 1//1 2//1 3//1\n", ":5: normal 1; there are 0");
  ExpectRefused(kCorners + "f 1/1/1/1 2 3\n", ":5: corner '1/1/1/1'");
  ExpectRefused(kCorners + "f 1 2 99999999999999999999\n", ":5: corner");
  ExpectRefused(kCorners + "f 1 2\n", ":5: a face of fewer");
  ExpectRefused(kCorners + "f a b c\n", ":5: corner 'a'");
  std::string huge = kCorners + "f";
  for (int i = 0; i < 10001; ++i) huge += " 1";
  ExpectRefused(huge, ":5: a face of 10001 corners; at most 10000");
}

TEST_F(ObjFile, AMissingFileIsNamed) {
  EXPECT_THROW(static_cast<void>(ReadObj(file_)), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
