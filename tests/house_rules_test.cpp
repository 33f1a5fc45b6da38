// SPDX-License-Identifier: MIT
// Rules of the house that no compiler knows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fixtures/places.h"

namespace {

namespace fs = std::filesystem;

/// Every file of the repository, in the folders that git keeps.
std::vector<fs::path> Files() {
  std::vector<fs::path> files;
  fs::recursive_directory_iterator entry(alpenglow::tests::kSourceFolder);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    const std::string name = entry->path().filename().string();
    if (entry.depth() == 0 && (name == "build" || name == ".git"))
      entry.disable_recursion_pending();
    if (entry->is_regular_file()) files.push_back(entry->path());
  }
  return files;
}

TEST(HouseRules, EveryFileThatBeginsWithAnInterpreterCanBeRun) {
  int scripts = 0;
  for (const fs::path& file : Files()) {
    std::string first(2, ' ');
    std::ifstream(file, std::ios::binary).read(first.data(), 2);
    if (first != "#!") continue;
    ++scripts;
    EXPECT_NE(fs::status(file).permissions() & fs::perms::owner_exec, fs::perms::none) << file;
  }
  EXPECT_GT(scripts, 3) << "the test must have looked at the scripts";
}

// fmt::print throws where standard error takes nothing, which would end the work.
TEST(HouseRules, ProgramsSpeakThroughMessagesAlone) {
  constexpr const char* kSpeech[] = {"fmt::print", "std::cerr", "std::cout <<", "printf("};
  int files = 0;
  for (const char* folder : {"atmosphere", "lut", "renderer", "viewer"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(alpenglow::tests::kSourceFolder) / folder)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      std::ifstream stream(entry.path());
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      for (const char* speech : kSpeech)
        EXPECT_EQ(text.find(speech), std::string::npos) << entry.path() << ": " << speech;
    }
  }
  EXPECT_GT(files, 100) << "the test must have looked at the sources";
}

}  // namespace
