// SPDX-License-Identifier: MIT
// The house: viewer -> renderer -> lut -> atmosphere, never back, never sideways; and inside each
// folder the order of rooms that its README lists, lower ones first.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/fixtures/places.h"

namespace {

namespace fs = std::filesystem;

/// Lower ones first; what tests have, nobody includes.
const std::vector<std::string> kFolders = {"atmosphere", "lut", "renderer", "viewer", "tests"};

/// The rooms of each folder, lower ones first.
using Rooms = std::map<std::string, std::vector<std::string>>;

/// Rows "| `room/` | ..." of a README.
std::vector<std::string> RoomsOf(std::istream& readme) {
  static const std::regex row(R"re(^\| `(\w+)/` \|.*)re");
  std::vector<std::string> rooms;
  std::string line;
  while (std::getline(readme, line)) {
    std::smatch match;
    if (std::regex_match(line, match, row)) rooms.push_back(match[1]);
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
  static const std::regex parts(R"re((\w+)/(?:([\w/]+)/)?([\w.]+))re");
  std::smatch match;
  if (!std::regex_match(path, match, parts)) return std::nullopt;
  const auto folder = std::find(kFolders.begin(), kFolders.end(), match[1]);
  if (folder == kFolders.end()) return std::nullopt;
  const auto place = static_cast<std::size_t>(folder - kFolders.begin());
  if (match[3] == "embedded_text.h" || match[3] == "version.h") return Place{place, 0};
  const auto listed = rooms.find(*folder);
  const std::vector<std::string> order =
      listed == rooms.end() ? std::vector<std::string>{} : listed->second;
  if (match[2].length() == 0) return Place{place, order.size()};
  const auto room = std::find(order.begin(), order.end(), match[2]);
  if (room == order.end()) return Place{place, order.size() + 1};
  return Place{place, static_cast<std::size_t>(room - order.begin())};
}

std::vector<std::string> IncludesThatRunUp(const std::string& file, std::istream& text,
                                           const Rooms& rooms) {
  static const std::regex include(R"re(^\s*#\s*include\s*["<](?:alpenglow/)?([\w./]+)[">].*)re");
  const Place here = PlaceOf(file, rooms).value();
  std::vector<std::string> found;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (!std::regex_match(line, match, include)) continue;
    const std::optional<Place> there = PlaceOf(match[1], rooms);
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
