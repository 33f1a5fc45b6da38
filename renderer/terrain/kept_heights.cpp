// SPDX-License-Identifier: MIT
#include "renderer/terrain/kept_heights.h"

#include <fmt/core.h>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <system_error>

#include "atmosphere/number/fnv1a.h"
#include "atmosphere/text/error.h"
#include "lut/program/atomic_file.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

fs::path FileOf(const fs::path& folder, const WantedHeights& wanted) {
  return folder / fmt::format("{}-{:016x}.f32", wanted.name, wanted.fingerprint);
}

bool IsWanted(const std::vector<float>& height_m, const WantedHeights& wanted) {
  return height_m.size() == wanted.count && FingerprintOf(height_m) == wanted.fingerprint;
}

// Nothing where the file is missing or is not what is wanted.
std::optional<std::vector<float>> Read(const fs::path& file, const WantedHeights& wanted) {
  std::error_code error;
  if (fs::file_size(file, error) != wanted.count * sizeof(float) || error) return std::nullopt;
  std::vector<float> height_m(wanted.count);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(height_m.data()),
              static_cast<std::streamsize>(height_m.size() * sizeof(float)));
  if (!stream || !IsWanted(height_m, wanted)) return std::nullopt;
  return height_m;
}

void RemoveOlder(const fs::path& file, const std::string& name) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(file.parent_path(), error)) {
    const std::string other = entry.path().filename().string();
    const bool is_alike = other.starts_with(name + "-") && other.ends_with(".f32");
    if (is_alike && entry.path() != file) fs::remove(entry.path(), error);
  }
}

void Keep(const fs::path& file, const WantedHeights& wanted, const std::vector<float>& height_m) {
  try {
    fs::create_directories(file.parent_path());
    WriteTextAtomically(
        file, {reinterpret_cast<const char*>(height_m.data()), height_m.size() * sizeof(float)});
    RemoveOlder(file, wanted.name);
  } catch (const OutputError&) {
  } catch (const fs::filesystem_error&) {
    // The next run makes them again.
  }
}

}  // namespace

std::uint64_t FingerprintOf(const std::vector<float>& height_m) {
  Fnv1a hash;
  for (std::size_t i = 0; i + 1 < height_m.size(); i += 2) {
    const std::uint64_t low = std::bit_cast<std::uint32_t>(height_m[i]);
    const std::uint64_t high = std::bit_cast<std::uint32_t>(height_m[i + 1]);
    hash.Add(low | (high << 32));
  }
  return hash.hash();
}

std::optional<fs::path> CacheFolder() {
  if (const char* const own = std::getenv("ALPENGLOW_CACHE"))
    return *own == '\0' ? std::nullopt : std::optional<fs::path>(own);
  const char* const caches = std::getenv("XDG_CACHE_HOME");
  if (caches != nullptr && *caches == '/') return fs::path(caches) / "alpenglow";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home == '/') return fs::path(home) / ".cache" / "alpenglow";
  return std::nullopt;
}

std::vector<float> KeptHeights(const WantedHeights& wanted,
                               const std::function<std::vector<float>()>& make) {
  const std::optional<fs::path> folder = CacheFolder();
  if (!folder) return make();
  const fs::path file = FileOf(*folder, wanted);
  if (std::optional<std::vector<float>> kept = Read(file, wanted)) return std::move(*kept);
  std::vector<float> made = make();
  if (IsWanted(made, wanted)) Keep(file, wanted, made);
  return made;
}

}  // namespace alpenglow::renderer
