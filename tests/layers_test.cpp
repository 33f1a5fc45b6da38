// SPDX-License-Identifier: MIT
// The layers of the house: viewer -> renderer -> lut -> atmosphere. Never back, never sideways.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"atmosphere", {"atmosphere"}},
    {"lut", {"atmosphere", "lut"}},
    {"renderer", {"atmosphere", "lut", "renderer"}},
    {"viewer", {"atmosphere", "lut", "renderer", "viewer"}},
};

std::vector<std::string> IncludesThatRunUp(const std::string& folder, std::istream& text,
                                           const std::string& name) {
  static const std::regex include(
      R"re(^\s*#\s*include\s*["<](atmosphere|lut|renderer|viewer|tests)/)re");
  std::vector<std::string> found;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    std::smatch match;
    if (std::regex_search(line, match, include) && kMayInclude.at(folder).count(match[1]) == 0) {
      found.push_back(name + ":" + std::to_string(number) + ": " + line);
    }
  }
  return found;
}

TEST(Layers, NoFileIncludesAFolderAboveItsOwn) {
  int files = 0;
  for (const auto& [folder, unused] : kMayInclude) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(ALPENGLOW_SOURCE_DIR) / folder)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp" && extension != ".glsl") continue;
      std::ifstream text(entry.path());
      EXPECT_EQ(IncludesThatRunUp(folder, text, entry.path()), std::vector<std::string>{});
      ++files;
    }
  }
  EXPECT_GT(files, 10) << "the test must have looked at the sources";
}

TEST(Layers, AnIncludeThatRunsUpIsFound) {
  std::istringstream text("#include <vector>\n#include \"renderer/terrain/mesh.h\"\n");
  EXPECT_EQ(IncludesThatRunUp("lut", text, "x.h").size(), 1U);
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
  for (const auto& entry : fs::directory_iterator(ALPENGLOW_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(name.front() == '.' || known.count(name) == 1) << name;
  }
}

}  // namespace
