// SPDX-License-Identifier: MIT
// Meshes of Wavefront OBJ files, and the triangles of their polygons.
#include "renderer/elevation/obj_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "renderer/elevation/polygon_triangles.h"
#include "renderer/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using Corners = std::vector<glm::dvec3>;

double AreaOf(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 corner = ToDouble(mesh.positions[a]);
    sum += 0.5 * glm::length(glm::cross(ToDouble(mesh.positions[b]) - corner,
                                        ToDouble(mesh.positions[c]) - corner));
  }
  return sum;
}

class ObjFile : public TemporaryFolder {
 protected:
  [[nodiscard]] fs::path File() const { return folder_ / "mesh.obj"; }
  [[nodiscard]] MeshModel ReadAll(const std::string& text, UpAxis up = UpAxis::kZ) const {
    WriteText(File(), text);
    return ReadObj(File(), up);
  }
  /// Reads a file that gives no cause for a message.
  [[nodiscard]] TriangleMesh Read(const std::string& text) const {
    MeshModel read = ReadAll(text);
    EXPECT_EQ(read.message, "") << text;
    return std::move(read.mesh);
  }
  void ExpectRefused(const std::string& text, const std::string& fault) const {
    SCOPED_TRACE(text);
    tests::ExpectNames(tests::FaultOf([&] { return ReadAll(text); }), File(), fault);
  }
  void ExpectSquare(const std::string& text) const {
    const TriangleMesh mesh = Read(text);
    EXPECT_EQ(mesh.triangles.size(), 2U) << text;
    EXPECT_NEAR(AreaOf(mesh), 400.0, 1e-4) << text;
  }
};

const std::string kCorners = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 10 10 5\n";
const std::string kRoof = "v 0 0 5\nv 10 0 5\nv 10 -5 0\nv 0 -5 0\nv 10 5 0\nv 0 5 0\n";
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

TEST_F(ObjFile, EveryUsualWayToWriteASquareIsRead) {
  const std::string face = "f 1 2 3 4\n", rest = "v 10 -10 0\nv 10 10 0\nv -10 10 0\n" + face;
  for (const std::string& text : std::vector<std::string>{
           // A statement may continue in the next line.
           kSquare + "f 1 2 \\\n3 4\n", kSquare + "f 1 2 \\\r\n\t3 4\r\n",
           kSquare + "f 1 2\\\n3\\\n4\n", kSquare + "f 1 2 \\  \n  3 4", "v -10 \\\n-10 0\n" + rest,
           kSquare + "usemtl C:\\stone\\\n" + face,
           // Numbers may have a plus and exponents.
           "v -10 -10 0\nv +10 -10 0\nv +10 +10 0\nv -10 +10 0\n" + face,
           "v -1e1 -1E+1 0\nv +1.0e+01 -10 1e-400\nv 10. 10 -0\nv -10 10 .0\nf +1 2 3 4\n",
           // Comments may follow anything.
           kSquare + "f 1 2 3 4  # a face\n",
           "v -10 -10 0#x\nv 10 -10 0 # \\\nv 10 10 0\nv -10 10 0\n#\\\nf 1 2 3 4# 5\n",
           kSquare + "s off # flat\n" + face,
           // Byte order marks, tabs and the end of DOS files are read.
           "\xef\xbb\xbf" + kSquare + face, "\xef\xbb\xbf# made by hand\n" + kSquare + face,
           "\tv\t-10\t-10\t0\n v 10 -10 0\nv 10 10 0\nv -10 10 0\n\tf\t1 2\t3 4\t\n\x1a",
           // A face may precede its vertices.
           face + kSquare,
           // Statements that make no surface are skipped.
           "mtllib a b.mtl\no square\ng first second\nusemtl stone\n" + kSquare +
               "vt 0 0\nvt 1 0 0\nvp 0.3 0.2\np 1 2\nl 1 2 3\nf 1/1 2/2 3/1 4/2\n",
           "v -10 -10 0 1.0\nv 10 -10 0 0.5 0.5 0.5\nv 10 10 0 255 0 0 1\nv -10 10 0\n"
           "f 1// 2/ 3 4//\n"})
    ExpectSquare(text);
}

TEST_F(ObjFile, IgnoredStatementsAndCrossingEdgesAreReported) {
  EXPECT_THAT(ReadAll(kSquare + "f 1 2 3 4\ncstype bezier\ndeg 3\n").message,
              HasSubstr("2 statements not read (the first, \"cstype\", in line 6)"));
  EXPECT_THAT(ReadAll(kSquare + "f 1 3 2 4\n").message, HasSubstr("1 face whose edges cross"));
}

TEST_F(ObjFile, PolygonsOfAnyFormHaveTheirArea) {
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
  const TriangleMesh mesh =
      Read(kRoof + "vn 0 -1 1\nvn 0 1 1\nf 1//1 4//1 3//1 2//1\nf 2//2 5//2 6//2 1//2\n");
  ASSERT_EQ(mesh.positions.size(), 8U) << "the ridge has two vertices at each end";
  ASSERT_EQ(mesh.normals.size(), 8U);
  for (const auto& triangle : mesh.triangles) {
    const float side = mesh.normals[triangle[0]][1];
    EXPECT_NEAR(std::abs(side), std::sqrt(0.5F), 1e-6F);
    for (const std::uint32_t corner : triangle) EXPECT_EQ(mesh.normals[corner][1], side);
  }
}

TEST_F(ObjFile, SmoothingGroupsAreApplied) {
  const std::string south = "f 1 4 3 2\n", north = "f 2 5 6 1\n";
  const auto up_of_ridge = [&](const std::string& text) { return Read(text).normals[0][2]; };
  const float flat = std::sqrt(0.5F);
  EXPECT_GT(up_of_ridge(kRoof + south + north), 0.9F) << "without s: one surface";
  EXPECT_GT(up_of_ridge(kRoof + "s 1\n" + south + north), 0.9F);
  EXPECT_GT(up_of_ridge(kRoof + "s on\n" + south + north), 0.9F);
  EXPECT_NEAR(up_of_ridge(kRoof + "s 1\n" + south + "s 2\n" + north), flat, 1e-6F);
  EXPECT_NEAR(up_of_ridge(kRoof + "s off\n" + south + north), flat, 1e-6F);
  EXPECT_NEAR(up_of_ridge(kRoof + "s 0\n" + south + north), flat, 1e-6F);
  EXPECT_EQ(Read(kRoof + "s off\n" + south + north).positions.size(), 8U);
}

TEST_F(ObjFile, TrianglesFaceTheSideOfTheirNormals) {
  const TriangleMesh mesh = Read(kSquare + "vn 0 0 1\nf 4//1 3//1 2//1 1//1\n");
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 corner = ToDouble(mesh.positions[a]);
    EXPECT_GT(
        glm::cross(ToDouble(mesh.positions[b]) - corner, ToDouble(mesh.positions[c]) - corner).z,
        0.0);
  }
}

TEST_F(ObjFile, NormalsWithoutDirectionAreCountedAndReplaced) {
  const MeshModel read = ReadAll(kSquare + "vn 0 0 0\nvn nan 0 1\nf 1//1 2//2 3//1 4//1\n");
  EXPECT_THAT(read.message, HasSubstr("2 normals without direction"));
  for (const auto& normal : read.mesh.normals)
    EXPECT_EQ(normal, (std::array<float, 3>{0.0F, 0.0F, 1.0F}));
}

TEST_F(ObjFile, FacesWithoutAreaAreLeftOutAndCounted) {
  const MeshModel read = ReadAll(kSquare + "f 1 2 3 4\nf 1 1 2\nf 1 3 1\n");
  EXPECT_EQ(read.mesh.triangles.size(), 2U);
  EXPECT_EQ(read.message,
            File().string() + ": 2 faces without area left out (the first in line 6)");
}

TEST_F(ObjFile, TheYAxisPointsUpIfAskedFor) {
  const MeshModel read =
      ReadAll("v 1 2 3\nv 11 2 3\nv 1 2 -7\nvn 0 1 0\nf 1//1 2//1 3//1\n", UpAxis::kY);
  EXPECT_EQ(read.message, "");
  EXPECT_EQ(read.mesh.positions[0], (std::array<float, 3>{1.0F, -3.0F, 2.0F})) << "z is south";
  EXPECT_EQ(read.mesh.normals[0], (std::array<float, 3>{0.0F, 0.0F, 1.0F}));
  const glm::dvec3 a = ToDouble(read.mesh.positions[0]);
  EXPECT_GT(
      glm::cross(ToDouble(read.mesh.positions[1]) - a, ToDouble(read.mesh.positions[2]) - a).z, 0.0)
      << "a turn keeps the side that faces the sky";
}

TEST_F(ObjFile, CoordinatesOfAMapAreReportedAsFarAway) {
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

TEST_F(ObjFile, BadFilesAreRefusedByLine) {
  std::string huge = kCorners + "f";
  for (int i = 0; i < 10001; ++i) huge += " 1";
  const std::string face = kCorners + "f 1 2 3\n";
  for (const auto& [text, fault] : std::vector<std::pair<std::string, const char*>>{
           {"", "no triangles"},
           {kCorners, "no triangles"},
           {kCorners + "F 1 2 3\n",
            "no triangles; 1 statement not read (the first, \"F\", in line 5)"},
           {"v 0 0 nan\n" + face, ":1: coordinate 'nan'"},
           {kCorners + "v inf 0 0\nf 1 2 3\n", ":5: coordinate 'inf'"},
           {"v 0 0 1e30\n" + face, ":1: coordinate '1e30'"},
           {"v 0 0 1e999\n" + face, ":1: coordinate '1e999'"},
           {"v 0 0 x\n" + face, ":1: coordinate 'x'"},
           {"v 0 0 +-1\n" + face, ":1: coordinate '+-1'"},
           {"v 0,5 0 1\n" + face, ":1: coordinate '0,5'"},
           {"v 0 0\n" + face, ":1: a vertex of fewer"},
           {"vn 0 0\n" + face, ":1: a normal of fewer"},
           {"vn 0 0 up\n" + face, ":1: coordinate 'up'"},
           {kCorners + "f 1 2 9\n", ":5: vertex 9; there are 4"},
           {kCorners + "f 1 2 \\\n9\n", ":5: vertex 9; there are 4"},
           {kCorners + "f 0 1 2\n", ":5: vertex 0"},
           {kCorners + "f -9 1 2\n", ":5: vertex -9"},
           {kCorners + "f 1//1 2//1 3//1\n", ":5: normal 1; there are 0"},
           {kCorners + "f 1/1/1/1 2 3\n", ":5: corner '1/1/1/1'"},
           {kCorners + "f 1 2 99999999999999999999\n", ":5: corner"},
           {kCorners + "f 1 2\n", ":5: a face of fewer"},
           {kCorners + "f a b c\n", ":5: corner 'a'"},
           {huge, ":5: a face of 10001 corners; at most 10000"},
           {"\xff\xfev", "UTF-16"},
           {kCorners + "f 1 2 2\n", "has no triangles; no face has an area"},
           {"v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "no face has an area"},
           {kRoof + "s smooth\nf 1 4 3 2\n", ":7: smoothing group 'smooth'"}})
    ExpectRefused(text, fault);
  EXPECT_NE(tests::FaultOf([&] { return ReadObj(folder_ / "none.obj"); }), "no fault");
}

TEST_F(ObjFile, IsRecognisedByItsExtensionAndReadWithAnyOther) {
  for (const char* name : {"square.obj", "SQUARE.OBJ", "square.txt", "square"}) {
    WriteText(folder_ / name, kSquare + "f 1 2 3 4\nl 1 2\ncurv 0 1\n");
    const MeshModel model = ReadMesh(folder_ / name, UpAxis::kY);
    const MeshModel same = ReadObj(folder_ / name, UpAxis::kY);
    EXPECT_EQ(model.mesh.positions, same.mesh.positions) << name;
    EXPECT_EQ(model.mesh.triangles.size(), 2U) << name;
    EXPECT_EQ(model.message, same.message) << name;
    EXPECT_THAT(model.message, HasSubstr("curv")) << name;
  }
}

TEST_F(ObjFile, MeshesOfOtherFormatsAreNamed) {
  using namespace std::string_view_literals;
  std::string binary_stl(80, '\0');
  binary_stl += "\1\0\0\0"sv;
  binary_stl.resize(84 + 50);
  for (const auto& [name, bytes, format] :
       {std::tuple{"a.stl", std::string_view(binary_stl), "this is STL"},
        {"b.stl", "solid hill\n  facet normal 0 0 1\n"sv, "this is STL"},
        {"a.obj", "solid hill\n  facet normal 0 0 1\n"sv, "this is STL"},
        {"a.ply", "ply\nformat ascii 1.0\n"sv, "this is PLY"},
        {"a.glb", "glTF\2\0\0\0"sv, "this is binary glTF"},
        {"a.gltf", "{\n \"asset\": {\"version\": \"2.0\"}}"sv, "this is glTF"},
        {"a.fbx", "Kaydara FBX Binary  \0"sv, "this is FBX"},
        {"b.fbx", "; FBX 7.4.0 project file\n"sv, "this is FBX"},
        {"a.dae", "<?xml version=\"1.0\"?>\n<COLLADA>"sv, "this is COLLADA"},
        {"a.usdz", "PK\x03\x04"sv, "this is a zip archive"},
        {"a.off", "OFF\n3 1 0\n"sv, "this is OFF"}}) {
    WriteText(folder_ / name, std::string(bytes));
    EXPECT_THAT(tests::FaultOf([&] { return ReadMesh(folder_ / name, UpAxis::kZ); }),
                AllOf(HasSubstr(std::string(name) + ": " + format),
                      HasSubstr("meshes are read as Wavefront OBJ")));
  }
}

/// Returns the area of a polygon in any plane: half the length of the sum of cross products
/// (shoelace formula).
double ShoelaceArea(const Corners& corners) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return 0.5 * glm::length(sum);
}

double AreaOfTriangles(const Corners& corners, const PolygonTriangles& cut) {
  double sum = 0.0;
  for (const auto& [a, b, c] : cut.triangles)
    sum += 0.5 * glm::length(glm::cross(corners[b] - corners[a], corners[c] - corners[a]));
  return sum;
}

/// Returns the area of triangles; those wound against the polygon count negative.
double SignedArea(const Corners& corners, const PolygonTriangles& cut, const glm::dvec3& normal) {
  double sum = 0.0;
  for (const auto& [a, b, c] : cut.triangles)
    sum += 0.5 * glm::dot(glm::cross(corners[b] - corners[a], corners[c] - corners[a]), normal);
  return sum;
}

glm::dvec3 InSinglePrecision(const glm::dvec3& v) { return glm::dvec3(glm::vec3(v)); }

void ExpectItsArea(const Corners& corners, const std::string& what) {
  const PolygonTriangles cut = TrianglesOfPolygon(corners);
  const double area = ShoelaceArea(corners);
  EXPECT_FALSE(cut.crosses_itself) << what;
  EXPECT_NEAR(AreaOfTriangles(corners, cut), area, 1e-6 * area) << what;
}

/// Returns a star around a point from which every corner is seen, so that no edges cross.
/// @param across, up  unit, span its plane.
Corners Star(std::mt19937& random, int rays, const glm::dvec3& across, const glm::dvec3& up) {
  std::uniform_real_distribution<double> radius(0.05, 10.0);
  Corners corners;
  for (int ray = 0; ray < rays; ++ray) {
    const double angle = 2.0 * kPi * ray / rays;
    const glm::dvec3 way = std::cos(angle) * across + std::sin(angle) * up;
    corners.push_back(InSinglePrecision(glm::dvec3(40.0, -70.0, 20.0) + radius(random) * way));
  }
  return corners;
}

TEST(PolygonTriangles, AConcaveQuadHasItsShoelaceArea) {
  const Corners dart{{-3, -8, 20}, {0, -2, 20}, {3, -8, 20}, {0, 10, 20}};
  EXPECT_DOUBLE_EQ(AreaOfTriangles(dart, TrianglesOfPolygon(dart)), 36.0);
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Corners turned = dart;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(turn), turned.end());
    ExpectItsArea(turned, "begun at corner " + std::to_string(turn));
    std::reverse(turned.begin(), turned.end());
    ExpectItsArea(turned, "wound the other way");
  }
}

TEST(PolygonTriangles, ConcaveStarsHaveTheirAreaInAnyPlane) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const glm::dvec3 normal =
        glm::normalize(glm::dvec3(along(random), along(random), along(random)));
    const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.5, 0.7)));
    const Corners star = Star(random, 4 + trial % 40, across, glm::cross(normal, across));
    ExpectItsArea(star, "trial " + std::to_string(trial));
    const double area = ShoelaceArea(star);
    EXPECT_NEAR(SignedArea(star, TrianglesOfPolygon(star), normal), area, 1e-6 * area)
        << "triangles are wound as the polygon is";
  }
}

TEST(PolygonTriangles, CollinearAndRepeatedCornersChangeNothing) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Corners star = Star(random, 5 + trial % 20, {1, 0, 0}, {0, 1, 0});
    Corners more;
    for (std::size_t i = 0; i < star.size(); ++i) {
      more.push_back(star[i]);
      if (i % 3 == 0) more.push_back(star[i]);
      if (i % 2 == 0)
        more.push_back(InSinglePrecision(0.5 * (star[i] + star[(i + 1) % star.size()])));
    }
    more.push_back(star.front());
    ExpectItsArea(more, "trial " + std::to_string(trial));
  }
  ExpectItsArea({{0, 0, 5}, {1, 0, 5}, {2, 0, 5}, {2, 2, 5}, {1, 2, 5}, {0, 2, 5}, {0, 1, 5}},
                "corners amid the edges of a square");
}

TEST(PolygonTriangles, APolygonMayTouchItself) {
  // The square of 10 m has a hole of 4 m, which a slit joins to the rim.
  const Corners frame{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0},
                      {3, 3, 0}, {3, 7, 0},  {7, 7, 0},   {7, 3, 0},  {3, 3, 0}};
  EXPECT_NEAR(AreaOfTriangles(frame, TrianglesOfPolygon(frame)), 84.0, 1e-9);
  const Corners touching{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}};
  ExpectItsArea(touching, "a corner on an edge");
}

TEST(PolygonTriangles, ARefractedPolygonIsCoveredOnce) {
  const Corners bent{{0, 0, 0}, {10, 0, 3}, {6, 4, -1}, {10, 10, 0}, {4, 6, 2}, {0, 10, 1}};
  const PolygonTriangles cut = TrianglesOfPolygon(bent);
  EXPECT_EQ(cut.triangles.size(), 4U);
  double seen_from_above = 0.0;
  for (const auto& [a, b, c] : cut.triangles) {
    const double twice = glm::cross(bent[b] - bent[a], bent[c] - bent[a]).z;
    EXPECT_GT(twice, 0.0);
    seen_from_above += 0.5 * twice;
  }
  Corners level = bent;
  for (glm::dvec3& corner : level) corner.z = 0.0;
  EXPECT_NEAR(seen_from_above, ShoelaceArea(level), 1e-9);
}

TEST(PolygonTriangles, CrossingEdgesAreReported) {
  EXPECT_TRUE(TrianglesOfPolygon({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}}).crosses_itself);
  EXPECT_TRUE(
      TrianglesOfPolygon({{0, 0, 0}, {10, 0, 0}, {2, 6, 0}, {5, -4, 0}, {8, 6, 0}}).crosses_itself);
}

TEST(PolygonTriangles, APolygonWithoutAreaHasNoTriangles) {
  EXPECT_TRUE(TrianglesOfPolygon({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}).triangles.empty());
  EXPECT_TRUE(TrianglesOfPolygon({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).triangles.empty());
  EXPECT_TRUE(TrianglesOfPolygon({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).triangles.empty());
  const PolygonTriangles spike = TrianglesOfPolygon({{0, 0, 0}, {5, 0, 0}, {0, 0, 0}, {2, 0, 0}});
  EXPECT_TRUE(spike.triangles.empty());
  EXPECT_FALSE(spike.crosses_itself);
}

TEST(PolygonTriangles, ASpiralOfManyCornersHasItsArea) {
  constexpr int kHalf = 600;
  Corners spiral;
  for (int i = 0; i < 2 * kHalf; ++i) {
    const bool is_way_back = i >= kHalf;
    const double along = is_way_back ? 2 * kHalf - 1 - i : i;
    const double angle = along / kHalf * 20.0 * kPi;
    const double radius = 10.0 + 0.2 * along + (is_way_back ? 3.0 : 0.0);
    spiral.push_back(InSinglePrecision({radius * std::cos(angle), radius * std::sin(angle), 0.0}));
  }
  ExpectItsArea(spiral, "a spiral");
}

}  // namespace
}  // namespace alpenglow::renderer
