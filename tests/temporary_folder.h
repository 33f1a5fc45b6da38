// SPDX-License-Identifier: MIT
// A fixture whose tests have an empty folder of their own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace alpenglow {

inline std::string ContentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// How a program ended, and what it printed.
struct Outcome {
  int status;  // -1: by a signal
  std::string out, error;
};

class TemporaryFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "alpenglow_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::size_t FileCount() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_),
                                                  std::filesystem::directory_iterator()));
  }

  /// Runs a program in the folder. @param command as typed into a shell. What it prints leaves no
  /// files behind.
  [[nodiscard]] Outcome RunCommand(const std::string& command) const {
    const int status = std::system(
        ("cd '" + folder_.string() + "' && " + command + " >.out 2>.error </dev/null").c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, ContentOf(folder_ / ".out"),
                    ContentOf(folder_ / ".error")};
    std::filesystem::remove(folder_ / ".out");
    std::filesystem::remove(folder_ / ".error");
    return outcome;
  }

  std::filesystem::path folder_;
};

}  // namespace alpenglow
