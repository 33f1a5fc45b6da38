// SPDX-License-Identifier: MIT
#include "renderer/series/frame_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {
namespace {

[[noreturn]] void Refuse(const std::string& pattern, const std::string& fault) {
  throw OptionError(fmt::format("--out is \"{}\"; {}", pattern, fault));
}

struct Conversion {
  int width = 0;
  std::size_t length = 0;  // number of characters after the per cent sign
};

Conversion ConversionAt(const std::string& pattern, std::size_t at) {
  constexpr int kMostDigits = 19;
  Conversion conversion;
  std::size_t i = at;
  for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9'; ++i) {
    conversion.width = 10 * conversion.width + (pattern[i] - '0');
    if (conversion.width > kMostDigits) Refuse(pattern, "the frame number is too wide");
  }
  if (i >= pattern.size() || pattern[i] != 'd') {
    Refuse(pattern, "the frame number is written %d or %04d, a per cent sign %%");
  }
  conversion.length = i + 1 - at;
  return conversion;
}

struct Range {
  int first, last;
};

int NumberIn(std::string_view text, std::string_view ranges) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) {
    throw InputError(fmt::format("frames \"{}\": \"{}\" is no frame; write A-B,C", ranges, text));
  }
  return number;
}

std::vector<Range> RangesFromText(std::string_view ranges) {
  std::vector<Range> found;
  for (std::size_t begin = 0; begin <= ranges.size();) {
    const std::size_t end = std::min(ranges.find(',', begin), ranges.size());
    const std::string_view part = ranges.substr(begin, end - begin);
    const std::size_t dash = part.find('-');
    const int first = NumberIn(part.substr(0, dash), ranges);
    const int last =
        dash == std::string_view::npos ? first : NumberIn(part.substr(dash + 1), ranges);
    if (last < first) {
      throw InputError(fmt::format("frames \"{}\": {} ends before it begins", ranges, part));
    }
    found.push_back({first, last});
    begin = end + 1;
  }
  return found;
}

double Positive(double value, const std::string& name) {
  if (!(value > 0.0 && std::isfinite(value))) {
    throw InputError(fmt::format("{} is {}; it must be positive", name, value));
  }
  return value;
}

}  // namespace

FrameName::FrameName(const std::string& pattern, std::string_view extension) {
  if (!HasExtension(pattern, extension))
    Refuse(pattern, fmt::format("it must end in {}", extension));
  std::string* part = &before_;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') {
      *part += pattern[i];
    } else if (i + 1 < pattern.size() && pattern[i + 1] == '%') {
      *part += pattern[++i];
    } else {
      if (has_number_) Refuse(pattern, "it must have one frame number, not more");
      const Conversion conversion = ConversionAt(pattern, i + 1);
      has_number_ = true;
      width_ = conversion.width;
      part = &after_;
      i += conversion.length;
    }
  }
  if (has_number_ && after_.find('/') != std::string::npos) {
    Refuse(pattern, "the frame number must be in the name of the file, not of a folder");
  }
}

std::filesystem::path FrameName::Picture(int number) const {
  if (!has_number_) return before_;
  return before_ + fmt::format("{:0{}}", number, width_) + after_;
}

std::filesystem::path FrameName::Png(int number) const {
  return Picture(number).replace_extension(".png");
}

std::filesystem::path FrameName::Manifest() const {
  const std::filesystem::path first(has_number_ ? before_ : before_ + after_);
  std::string stem = has_number_ ? first.filename().string() : first.stem().string();
  while (!stem.empty() && (stem.back() == '.' || stem.back() == '_' || stem.back() == '-')) {
    stem.pop_back();
  }
  return first.parent_path() / (stem.empty() ? "manifest.csv" : stem + ".manifest.csv");
}

std::filesystem::path FrameName::JsonManifest() const {
  return Manifest().replace_extension(".json");
}

std::filesystem::path FrameName::Folder() const {
  return std::filesystem::path(before_).parent_path();
}

std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day) {
  std::vector<Frame> frames;
  for (const UtcTime& instant : InstantsFromTimes(times, day)) {
    frames.push_back({static_cast<int>(frames.size()), instant});
  }
  return frames;
}

std::vector<Frame> SelectFrames(const std::vector<Frame>& frames, std::string_view ranges) {
  std::vector<Frame> selected;
  const std::vector<Range> wanted = RangesFromText(ranges);
  ALPENGLOW_ENSURE(frames.size(), >, 0U);
  for (const Range& range : wanted) {
    if (range.last > frames.back().number) {
      throw InputError(
          fmt::format("frames \"{}\": the series has 0 to {}", ranges, frames.back().number));
    }
  }
  for (const Frame& frame : frames) {
    const auto holds = [&](const Range& range) {
      return range.first <= frame.number && frame.number <= range.last;
    };
    if (std::any_of(wanted.begin(), wanted.end(), holds)) selected.push_back(frame);
  }
  return selected;
}

double FrameInterval(const CameraPath& path, const PathRate& rate) {
  if (rate.every) return Positive(ParseDuration(*rate.every), "--every");
  if (!rate.count) return 1.0 / Positive(rate.per_second, "--fps");
  RequireInRange(*rate.count, 1, kMostFrames, "--count");
  return (path.end_s() - path.begin_s()) / std::max(*rate.count - 1, 1);
}

std::vector<Frame> FramesAlong(const CameraPath& path, const PathRate& rate, const UtcTime& start) {
  const double interval_s = FrameInterval(path, rate);
  const double length_s = path.end_s() - path.begin_s();
  // A last frame that rounding places after the end of the path still belongs to it.
  constexpr double kRounding = 1e-9;
  const double count =
      rate.count ? *rate.count : std::floor(length_s / interval_s * (1.0 + kRounding)) + 1.0;
  if (!(count <= kMostFrames)) {
    throw InputError(fmt::format(
        "the path has {:.0f} frames; there may be {}: give a longer --every or a lower --fps",
        count, kMostFrames));
  }
  std::vector<Frame> frames;
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double along_s = i * interval_s;
    const double path_s = path.begin_s() + along_s;
    frames.push_back({i, path.UtcAt(path_s).value_or(AddSeconds(start, along_s)), path_s});
  }
  return frames;
}

CameraSample CameraSampleOf(const Frame& frame, const CameraPath& path, double shutter_s) {
  // Straight segments between 16 steps miss a curve by less than a hundredth of its length.
  constexpr int kSteps = 17;
  CameraSample camera_sample(frame.instant);
  camera_sample.poses = path.PosesBetween(
      frame.path_s - 0.5 * shutter_s, frame.path_s + 0.5 * shutter_s, shutter_s > 0.0 ? kSteps : 1);
  return camera_sample;
}

}  // namespace alpenglow::renderer
