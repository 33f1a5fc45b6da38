// SPDX-License-Identifier: MIT
#include "renderer/terrain/land.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

// An environment variable that is what it was when the test ends.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    value == nullptr ? unsetenv(name) : setenv(name, value, 1);
  }
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

class HeightCacheTest : public TemporaryFolder {
 protected:
  // Asks for the heights; whether they had to be made.
  [[nodiscard]] bool HadToMake() {
    bool made = false;
    const std::vector<float> height_m = HeightCache(wanted_, [&] {
      made = true;
      return height_m_;
    });
    EXPECT_EQ(height_m, height_m_);
    return made;
  }
  [[nodiscard]] fs::path OnlyFile() const { return fs::directory_iterator(folder_)->path(); }

  std::vector<float> height_m_{1.0F, -2.5F, 3e3F, 0.0F};
  WantedHeights wanted_{"range", FingerprintOf(height_m_), height_m_.size()};
};

TEST_F(HeightCacheTest, AreMadeOnceAndThenRead) {
  const Variable cache("ALPENGLOW_CACHE", folder_.c_str());
  EXPECT_TRUE(HadToMake());
  EXPECT_FALSE(HadToMake());
  EXPECT_EQ(fs::file_size(OnlyFile()), 4 * sizeof(float));
}

TEST_F(HeightCacheTest, AreNotKeptWhereTheVariableIsEmpty) {
  const Variable cache("ALPENGLOW_CACHE", "");
  EXPECT_TRUE(HadToMake());
  EXPECT_TRUE(HadToMake());
  EXPECT_EQ(CacheFolder(), std::nullopt);
}

TEST_F(HeightCacheTest, ThatAreDamagedOrCutAreMadeAgain) {
  const Variable cache("ALPENGLOW_CACHE", folder_.c_str());
  EXPECT_TRUE(HadToMake());
  for (const char* damage : {"sixteen letters.", "short", ""}) {
    WriteText(OnlyFile(), damage);
    EXPECT_TRUE(HadToMake()) << damage;
    EXPECT_FALSE(HadToMake()) << "and are whole again";
  }
}

TEST_F(HeightCacheTest, OfAnotherVersionMakeRoom) {
  const Variable cache("ALPENGLOW_CACHE", folder_.c_str());
  EXPECT_TRUE(HadToMake());
  height_m_[1] = 7.0F;
  EXPECT_EQ(HeightCache(wanted_, [&] { return std::vector<float>{1.0F}; }).size(), 4U);
  wanted_.fingerprint = FingerprintOf(height_m_);
  EXPECT_TRUE(HadToMake());
  EXPECT_EQ(FileCount(), 1U);
}

TEST_F(HeightCacheTest, ThatAreNotWhatIsWantedAreNeverWritten) {
  const Variable cache("ALPENGLOW_CACHE", folder_.c_str());
  wanted_.fingerprint += 1;  // as on a machine whose arithmetic is another
  EXPECT_TRUE(HadToMake());
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(HeightCacheTest, DoNotNeedAFolderThatCanBeWritten) {
  const fs::path file = folder_ / "file";
  WriteText(file, "no folder");
  const Variable cache("ALPENGLOW_CACHE", (file / "cache").c_str());
  EXPECT_TRUE(HadToMake());
}

TEST_F(HeightCacheTest, LieWhereTheDesktopKeepsSuchThings) {
  const Variable none("ALPENGLOW_CACHE", nullptr);
  const Variable home("HOME", "/home/someone");
  {
    const Variable caches("XDG_CACHE_HOME", "/caches");
    EXPECT_EQ(CacheFolder(), fs::path("/caches/alpenglow"));
  }
  const Variable caches("XDG_CACHE_HOME", nullptr);
  EXPECT_EQ(CacheFolder(), fs::path("/home/someone/.cache/alpenglow"));
}

}  // namespace
}  // namespace alpenglow::renderer
