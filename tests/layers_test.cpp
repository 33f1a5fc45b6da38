// SPDX-License-Identifier: MIT
// The house: viewer -> renderer -> lut -> atmosphere, never back, never sideways; and inside each
// folder the order of rooms that its README lists, lower ones first.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fixtures/places.h"

namespace {

namespace fs = std::filesystem;

/// Lower ones first; what tests have, nobody includes.
const std::vector<std::string> kFolders = {"atmosphere", "lut", "renderer", "viewer", "tests"};

/// The rooms of each folder, lower ones first.
using Rooms = std::map<std::string, std::vector<std::string>>;

constexpr const char* kWordCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

/// Rows "| `room/` | ..." of a README.
std::vector<std::string> RoomsOf(std::istream& readme) {
  constexpr std::string_view kBefore = "| `", kAfter = "/` |";
  std::vector<std::string> rooms;
  for (std::string line; std::getline(readme, line);) {
    const std::size_t end = line.find(kAfter);
    if (!line.starts_with(kBefore) || end == std::string::npos) continue;
    const std::string room = line.substr(kBefore.size(), end - kBefore.size());
    if (room.find_first_not_of(kWordCharacters) == std::string::npos) rooms.push_back(room);
  }
  return rooms;
}

const Rooms& RoomsOfTheHouse() {
  static const Rooms rooms = [] {
    Rooms read;
    for (const std::string& folder : kFolders) {
      if (folder == "tests") continue;
      std::ifstream readme(fs::path(alpenglow::tests::kSourceFolder) / folder / "README.md");
      read[folder] = RoomsOf(readme);
    }
    return read;
  }();
  return rooms;
}

/// Where a file stands; files at the top of a folder stand above all of its rooms.
struct Place {
  std::size_t folder, room;
};

/// "lut/sky/panorama.h" by the order of rooms; nothing for what is no file of the house. What the
/// build writes (embedded_text.h, version.h) knows of no room and stands under all of them; a room
/// that is not listed stands above all.
std::optional<Place> PlaceOf(const std::string& path, const Rooms& rooms) {
  const std::size_t after_folder = path.find('/'), before_file = path.rfind('/');
  if (after_folder == std::string::npos) return std::nullopt;
  const auto folder = std::find(kFolders.begin(), kFolders.end(), path.substr(0, after_folder));
  if (folder == kFolders.end()) return std::nullopt;
  const auto place = static_cast<std::size_t>(folder - kFolders.begin());
  const std::string file = path.substr(before_file + 1);
  if (file == "embedded_text.h" || file == "version.h") return Place{place, 0};
  const auto listed = rooms.find(*folder);
  const std::vector<std::string> order =
      listed == rooms.end() ? std::vector<std::string>{} : listed->second;
  if (before_file == after_folder) return Place{place, order.size()};
  const std::string room_name = path.substr(after_folder + 1, before_file - after_folder - 1);
  const auto room = std::find(order.begin(), order.end(), room_name);
  if (room == order.end()) return Place{place, order.size() + 1};
  return Place{place, static_cast<std::size_t>(room - order.begin())};
}

/// The path that a line includes, without "alpenglow/"; nothing for other lines.
std::optional<std::string> IncludedPath(const std::string& line) {
  constexpr const char* kSpaces = " \t";
  std::size_t at = line.find_first_not_of(kSpaces);
  if (at == std::string::npos || line[at] != '#') return std::nullopt;
  at = line.find_first_not_of(kSpaces, at + 1);
  constexpr std::string_view kInclude = "include", kPrefix = "alpenglow/";
  if (at == std::string::npos || line.compare(at, kInclude.size(), kInclude) != 0)
    return std::nullopt;
  const std::size_t begin = line.find_first_of("\"<", at), end = line.find_last_of("\">");
  if (begin == std::string::npos || end <= begin) return std::nullopt;
  const std::string path = line.substr(begin + 1, end - begin - 1);
  return path.starts_with(kPrefix) ? path.substr(kPrefix.size()) : path;
}

std::vector<std::string> IncludesThatRunUp(const std::string& file, std::istream& text,
                                           const Rooms& rooms) {
  const Place here = PlaceOf(file, rooms).value();
  std::vector<std::string> found;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    const std::optional<std::string> included = IncludedPath(line);
    if (!included) continue;
    const std::optional<Place> there = PlaceOf(*included, rooms);
    if (!there || there->folder < here.folder) continue;
    if (there->folder > here.folder || there->room > here.room)
      found.push_back(file + ":" + std::to_string(number) + ": " + line);
  }
  return found;
}

TEST(Layers, NoFileIncludesAFolderOrARoomAboveItsOwn) {
  int files = 0;
  for (const auto& [folder, unused] : RoomsOfTheHouse()) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(alpenglow::tests::kSourceFolder) / folder)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".glsl") continue;
      std::ifstream text(entry.path());
      const std::string name = fs::relative(entry.path(), alpenglow::tests::kSourceFolder);
      EXPECT_EQ(IncludesThatRunUp(name, text, RoomsOfTheHouse()), std::vector<std::string>{});
      ++files;
    }
  }
  EXPECT_GT(files, 100) << "the test must have looked at the sources";
}

TEST(Layers, ReadmesListEveryRoomThatThereIs) {
  for (const auto& [folder, listed] : RoomsOfTheHouse()) {
    std::set<std::string> found;
    for (const auto& entry :
         fs::directory_iterator(fs::path(alpenglow::tests::kSourceFolder) / folder)) {
      if (entry.is_directory() && entry.path().filename() != "data")
        found.insert(entry.path().filename());
    }
    EXPECT_EQ(std::set<std::string>(listed.begin(), listed.end()), found) << folder;
  }
}

TEST(Layers, AnIncludeThatRunsUpIsFound) {
  const Rooms rooms{{"atmosphere", {"text", "air"}},
                    {"lut", {"picture", "sky"}},
                    {"renderer", {"terrain"}},
                    {"viewer", {}}};
  const auto found = [&](const char* file, const char* include) {
    std::istringstream text("#include <vector>\n#include \"" + std::string(include) + "\"\n");
    return IncludesThatRunUp(file, text, rooms).size();
  };
  EXPECT_EQ(found("lut/sky/panorama.h", "renderer/terrain/mesh.h"), 1U) << "a higher folder";
  EXPECT_EQ(found("lut/picture/image.h", "lut/sky/panorama.h"), 1U) << "a higher room";
  EXPECT_EQ(found("lut/picture/image.h", "lut/sky_command.h"), 1U) << "the top";
  EXPECT_EQ(found("lut/picture/image.h", "lut/cellar/wine.h"), 1U) << "a room that is not listed";
  EXPECT_EQ(found("lut/picture/image.h", "tests/fixtures/stored_cases.h"), 1U);
  EXPECT_EQ(found("lut/sky/panorama.h", "lut/picture/image.h"), 0U);
  EXPECT_EQ(found("lut/sky/panorama.h", "lut/embedded_text.h"), 0U);
  EXPECT_EQ(found("lut/sky_command.cpp", "lut/sky/panorama.h"), 0U);
  EXPECT_EQ(found("lut/picture/image.h", "atmosphere/air/medium.h"), 0U);
  EXPECT_EQ(found("lut/picture/image.h", "alpenglow/renderer/terrain/mesh.h"), 1U);
}

TEST(Layers, TheTopLevelIsClosed) {
  const std::set<std::string> known = {"CMakeLists.txt",
                                       "CMakePresets.json",
                                       "LICENSE",
                                       "README.md",
                                       "atmosphere",
                                       "build",
                                       "lut",
                                       "out",
                                       "quickstart.sh",
                                       "renderer",
                                       "tests",
                                       "viewer"};
  for (const auto& entry : fs::directory_iterator(alpenglow::tests::kSourceFolder)) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name.front() == '.' || known.count(name) == 1) << name;
  }
}

}  // namespace
