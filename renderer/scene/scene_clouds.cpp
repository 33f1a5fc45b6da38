// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_clouds.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/clouds/cloud_generator.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSecondsPerDay = 86400.0;
// Times begin kDaysBefore the day of the scene and return after kDaysOfTime; those of a series go on
// for kDaysMore.
constexpr int kDaysBefore = 50, kDaysOfTime = 100, kDaysMore = 15;

/// A usual sky.
struct CloudPreset {
  const char* name;
  CloudGenus genus;
  double cover;
};
constexpr CloudPreset kPresets[] = {{"fair", CloudGenus::kCumulus, 0.25},
                                    {"broken", CloudGenus::kStratocumulus, 0.75},
                                    {"high", CloudGenus::kCirrus, 0.5},
                                    {"overcast", CloudGenus::kStratus, 1.0}};
constexpr char kNoClouds[] = "none";

/// Returns the words with which a layer of --clouds begins.
std::vector<std::string> CloudWords() {
  std::vector<std::string> words{kNoClouds};
  for (const CloudPreset& preset : kPresets) words.emplace_back(preset.name);
  for (const std::string& genus : kCloudGenusNames.All()) words.push_back(genus);
  return words;
}

[[noreturn]] void RefuseWord(std::string_view word) {
  const std::vector<std::string> words = CloudWords();
  const auto nearest = NearestName(word, words);
  throw InputError(fmt::format("\"{}\" is no genus or preset of clouds; {}", Printable(word),
                               nearest ? fmt::format("did you mean {}?", *nearest)
                                       : fmt::format("known: {}", fmt::join(words, ", "))));
}

/// Returns the layer that a preset or the name of a genus stands for.
CloudOptions NamedLayer(std::string_view word) {
  for (const CloudPreset& preset : kPresets) {
    if (word != preset.name) continue;
    CloudOptions options = DefaultCloudOptions(preset.genus);
    options.cover = preset.cover;
    return options;
  }
  if (word == kNoClouds) throw InputError("none stands alone, without other layers");
  const std::optional<CloudGenus> genus = kCloudGenusNames.Find(word);
  if (!genus) RefuseWord(word);
  return DefaultCloudOptions(*genus);
}

/// Returns the cover that follows the name of a genus.
double CoverFrom(std::string_view word, CloudGenus genus) {
  const auto [least, most] = CoversOf(genus);
  const std::optional<double> cover = ParseNumber(word);
  if (cover && *cover >= least && *cover <= most) return *cover;
  throw InputError(fmt::format(
      "the cover of {} is \"{}\"; it must be {}", kCloudGenusNames.Of(genus), Printable(word),
      least == most ? fmt::format("{}", most) : fmt::format("a number in [{}, {}]", least, most)));
}

/// Reads one layer of --clouds.
CloudOptions LayerFromText(std::string_view text) {
  const std::vector<std::string_view> words = WordsOf(text);
  if (words.empty()) throw InputError("a layer of clouds is empty; give a genus and its cover");
  CloudOptions options = NamedLayer(words.front());
  const bool is_genus = kCloudGenusNames.Find(words.front()).has_value();
  if (words.size() > (is_genus ? 2U : 1U)) {
    throw InputError(
        fmt::format("the layer \"{}\" has {} words; it may have a genus and its "
                    "cover, or one of the presets",
                    Printable(text), words.size()));
  }
  if (words.size() == 2) options.cover = CoverFrom(words[1], options.genus);
  return options;
}

/// Calls `read` and prefixes the message of its InputError with the layer and a key.
template <typename Read>
auto OfLayer(const SceneCloud& cloud, const char* key, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}.{}: {}", cloud.name, key, error.what()));
  }
}

/// Returns the place of a grid's middle, east and north of the scene's place [m].
glm::dvec2 MiddleOf(const SceneCloud& cloud, const Scene& scene) {
  if (!cloud.middle) return glm::dvec2(0.0);
  const Medium& medium = scene.medium;
  const Ellipsoid planet = medium.follows_wgs84 ? kWgs84 : Ellipsoid{medium.planet_radius_m, 0.0};
  return {LocalFrame(planet, scene.place).EnuFromGeodetic(*cloud.middle).xyz};
}

/// Returns the field of a file, around its middle.
CloudField GridField(const SceneCloud& cloud, const Scene& scene) {
  CloudFileOptions options = cloud.file;
  options.origin_m = {0.0, 0.0, cloud.options.base_altitude_m};
  const CloudField field =
      OfLayer(cloud, "grid", [&] { return ReadCloudField(cloud.grid, options); });
  const CloudLattice& lattice = field.lattice();
  const glm::dvec2 own_middle(lattice.origin_m + 0.5 * lattice.size_m());
  return field.Moved(MiddleOf(cloud, scene) - own_middle);
}

/// Returns a periodic field with its corner in the first period, so that coordinates in it stay small
/// after days of wind; any other field as it is.
CloudField WithinAPeriod(const CloudField& field) {
  const std::optional<glm::dvec2> period = field.period_m();
  if (!period) return field;
  return field.Moved(-*period * glm::floor(glm::dvec2(field.lattice().origin_m) / *period));
}

/// Returns the time at which grids are at their own places.
double RestingTime_s(const Scene& scene) {
  return CloudTime_s(scene, scene.time.value_or(UtcTime(CloudDayOf(scene), 0.0)));
}

CloudField FieldOf(const SceneCloud& cloud, const Scene& scene, double time_s) {
  if (cloud.grid.empty()) {
    return WithinAPeriod(
        OfLayer(cloud, "genus", [&] { return MakeCloudField(cloud.options, time_s); }));
  }
  const double moving_s = time_s - RestingTime_s(scene);
  return WithinAPeriod(GridField(cloud, scene).Moved(moving_s * cloud.options.wind_m_per_s));
}

}  // namespace

std::vector<SceneCloudField> CloudFieldsOf(const Scene& scene, double time_s) {
  RequireCloudsFit(scene.clouds, MemoryOfMachine());
  std::vector<SceneCloudField> fields;
  for (const SceneCloud& cloud : scene.clouds)
    fields.push_back(
        {FieldOf(cloud, scene, time_s), IsOfIce(cloud.options.genus), cloud.options.wind_m_per_s});
  std::stable_sort(fields.begin(), fields.end(),
                   [](const SceneCloudField& a, const SceneCloudField& b) {
                     return a.field.base_altitude_m() < b.field.base_altitude_m();
                   });
  return fields;
}

int CloudDayOf(const Scene& scene) {
  constexpr int kDefaultDay = 61212;  // 2026-06-21
  if (scene.cloud_day) return *scene.cloud_day;
  return scene.time ? scene.time->modified_julian_day : kDefaultDay;
}

int CloudDayNear(const Scene& scene, const UtcTime& begin) {
  const int day = CloudDayOf(scene);
  const double turns = (begin.modified_julian_day - day + kDaysBefore) / double{kDaysOfTime};
  return day + kDaysOfTime * static_cast<int>(std::floor(turns));
}

double CloudTime_s(const Scene& scene, const UtcTime& instant) {
  const double longest_s = (kDaysOfTime + (scene.cloud_day ? kDaysMore : 0)) * kSecondsPerDay;
  constexpr double kAll_s = kDaysOfTime * kSecondsPerDay;
  const UtcTime begin(CloudDayOf(scene) - kDaysBefore, 0.0);
  const double time_s = SecondsBetween(begin, instant);
  if (time_s >= 0.0 && time_s < longest_s) return time_s;
  return time_s - kAll_s * std::floor(time_s / kAll_s);
}

std::vector<SceneCloud> CloudsFromText(std::string_view text) {
  if (WordsOf(text) == std::vector<std::string_view>{kNoClouds}) return {};
  std::vector<SceneCloud> clouds;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    SceneCloud cloud;
    cloud.options = LayerFromText(text.substr(at, comma - at));
    cloud.options.seed = static_cast<std::uint32_t>(clouds.size()) + 1U;
    cloud.is_over_ground = FollowsGround(cloud.options.genus);
    cloud.name = fmt::format("--clouds[{}]", clouds.size());
    clouds.push_back(std::move(cloud));
    at = comma + 1;
  }
  return clouds;
}

void RequireCloudsFit(const std::vector<SceneCloud>& clouds, double memory) {
  double needed = 0.0;
  for (const SceneCloud& cloud : clouds) {
    if (!cloud.grid.empty()) continue;  // the reader of the file has its own limit
    needed += CloudField::MostBytes(LatticeOf(cloud.options));
    if (needed <= memory) continue;
    throw InputError(fmt::format(
        "{}.period_m is {} and its depth_m {}: the clouds up to this layer may need {:.1f} GB, and "
        "this machine has {:.1f} GB",
        cloud.name, cloud.options.period_m, cloud.options.depth_m, 1e-9 * needed, 1e-9 * memory));
  }
}

double MemoryOfMachine() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::vector<SceneCloud> OverEllipsoid(std::vector<SceneCloud> clouds, double ground_m) {
  for (SceneCloud& cloud : clouds) {
    if (cloud.is_over_ground) cloud.options.base_altitude_m += std::max(ground_m, 0.0);
    cloud.is_over_ground = false;
  }
  return clouds;
}

void RequireCloudsOverGround(const std::vector<SceneCloud>& clouds, double lowest_m) {
  for (const SceneCloud& cloud : clouds) {
    if (!cloud.grid.empty() || cloud.is_over_ground || cloud.options.base_altitude_m >= lowest_m)
      continue;
    throw InputError(fmt::format(
        "{}.base_height_m is {}; the lowest ground of the scene is at {:.1f} m (base_height_m of "
        "[[cloud]] sets another base)",
        cloud.name, cloud.options.base_altitude_m, lowest_m));
  }
}

}  // namespace alpenglow::renderer
