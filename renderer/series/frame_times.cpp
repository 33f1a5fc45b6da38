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
  throw InputError(fmt::format("--out is \"{}\"; {}", pattern, fault));
}

struct Conversion {
  int width = 0;
  std::size_t length = 0;  // number of characters after the per cent sign
};

Conversion ConversionAt(const std::string& pattern, std::size_t at) {
  constexpr int kWidest = 19;
  Conversion conversion;
  std::size_t i = at;
  for (; i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9'; ++i) {
    conversion.width = 10 * conversion.width + (pattern[i] - '0');
    if (conversion.width > kWidest) Refuse(pattern, "the frame number is too wide");
  }
  if (i >= pattern.size() || pattern[i] != 'd') {
    Refuse(pattern, "the frame number is written %d or %04d, a per cent sign %%");
  }
  conversion.length = i + 1 - at;
  return conversion;
}

}  // namespace

FrameName::FrameName(const std::string& pattern) {
  if (!HasExtension(pattern, ".exr")) Refuse(pattern, "it must end in .exr");
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

std::filesystem::path FrameName::Exr(int number) const {
  if (!has_number_) return before_;
  return before_ + fmt::format("{:0{}}", number, width_) + after_;
}

std::filesystem::path FrameName::Png(int number) const {
  return Exr(number).replace_extension(".png");
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

namespace {

/// An instant at one end determines the day of the event at the other end.
EventDay DayOfFrom(const TimesText& times, const EventDay& day) {
  EventDay of_from = day;
  if (!day.around && !IsDailyEvent(*times.to) && !IsDayText(*times.to)) {
    of_from.around = InstantFromText(*times.to, day);
  }
  return of_from;
}

UtcInstant EndOf(const TimesText& times, const EventDay& day, const UtcInstant& from) {
  const UtcInstant to = InstantFromText(*times.to, day);
  const bool comes_daily = IsDailyEvent(*times.to) || IsClockTime(*times.to);
  if (SecondsBetween(from, to) > 0.0 || !comes_daily) return to;
  EventDay next = day;
  // Step from noon, because a clock change can lie before the next noon.
  next.around = AddSeconds(DayFromText(DateAt(*day.around, day), day), kSecondsPerDay);
  return InstantFromText(*times.to, next);
}

/// The time between frames.
struct Step {
  std::string text;
  double seconds;
  bool is_whole_days;

  /// Throws InputError for a text that is no positive duration.
  explicit Step(const std::string& every)
      : text(every),
        seconds(ParseDuration(every)),
        is_whole_days(std::fmod(seconds, kSecondsPerDay) == 0.0) {
    if (!(seconds > 0.0))
      throw InputError(fmt::format("--every is {}; it must be longer than nothing", every));
  }

  /// Returns the seconds from the first frame to frame i.
  [[nodiscard]] double After(int i) const { return i * seconds; }
};

/// Returns the number of steps that fit into a span.
int StepsIn(double span_s, const Step& every) {
  constexpr double kRounding_s = 1e-6;  // rounding of the event search and of sums of durations
  const double steps = std::floor((span_s + kRounding_s) / every.seconds);
  if (steps >= kMostFrames) {
    throw InputError(fmt::format("--every {} gives {:.0f} frames; there may be {}", every.text,
                                 steps + 1.0, kMostFrames));
  }
  return static_cast<int>(steps);
}

std::vector<UtcInstant> EverySeconds(const UtcInstant& from, double span_s, const Step& every) {
  std::vector<UtcInstant> instants;
  const int steps = StepsIn(span_s, every);
  for (int i = 0; i <= steps; ++i) instants.push_back(AddSeconds(from, every.After(i)));
  return instants;
}

/// Returns the instant of a clock time on a day in the zone. A clock time that is skipped or
/// repeated by a clock change uses the offset before the change.
UtcInstant ClockTimeOn(const std::string& date_and_clock, const std::string& zone,
                       const UtcInstant& before) {
  constexpr std::size_t kOffsetAt = 19;  // position of the offset in "2026-06-21T13:00:00+09:00"
  try {
    return ParseInstant(date_and_clock, zone);
  } catch (const InputError&) {
    return ParseInstant(date_and_clock + FormatInZone(before, zone).substr(kOffsetAt));
  }
}

/// Returns whether `every` counts whole calendar days of a zone, so that clocks show the same time
/// at every frame.
bool IsOfCalendarDays(const Step& every, const EventDay& day) {
  return day.zone && every.text.ends_with('d') && every.is_whole_days;
}

std::vector<UtcInstant> EveryDays(const UtcInstant& from, double span_s, const Step& every,
                                  const EventDay& day) {
  constexpr double kRounding_s = 1e-6;
  const double fraction_s = from.second_of_day - std::floor(from.second_of_day);
  const UtcInstant whole = AddSeconds(from, -fraction_s);
  const std::string clock = FormatInZone(whole, *day.zone).substr(10, 9);  // "T13:00:00"
  const UtcInstant noon = DayFromText(DateAt(from, day), day);
  std::vector<UtcInstant> instants{from};
  // A span of whole days is an hour longer or shorter if it contains a clock change.
  const int most = StepsIn(span_s + 0.5 * kSecondsPerDay, every);
  for (int i = 1; i <= most; ++i) {
    const std::string date = DateAt(AddSeconds(noon, every.After(i)), day);
    const UtcInstant next =
        AddSeconds(ClockTimeOn(date + clock, *day.zone, instants.back()), fraction_s);
    if (SecondsBetween(from, next) > span_s + kRounding_s) break;
    instants.push_back(next);
  }
  return instants;
}

/// Returns whether a text is an event, after a day or not.
bool IsEvent(const std::string& text) { return IsDailyEvent(TimeOfDayFromText(text, {}).text); }

/// Returns the event of `from` on its day and on the following days, up to the day of `to`.
std::vector<UtcInstant> EventOfEachDay(const TimesText& times, const Step& every,
                                       const EventDay& day) {
  const auto [event, first] = TimeOfDayFromText(*times.from, DayOfFrom(times, day));
  if (!first.around) throw InputError("an event of each day needs a first day: give --date");
  const UtcInstant last =
      IsDayText(*times.to) ? DayFromText(*times.to, day) : InstantFromText(*times.to, first);
  const auto midnight = [&](const UtcInstant& of) {
    return MeanSolarMidnight(WrappedLongitude(day.place.longitude_rad), of);
  };
  const double span_s = SecondsBetween(midnight(*first.around), midnight(last));
  if (span_s < 0.0) {
    throw InputError(fmt::format("--to {} is before the day of --from", *times.to));
  }
  std::vector<UtcInstant> instants;
  const int steps = StepsIn(span_s, every);
  for (int i = 0; i <= steps; ++i) {
    EventDay of_frame = first;
    of_frame.around = AddSeconds(*first.around, every.After(i));
    if (const auto instant = FindDailyEvent(event, of_frame)) instants.push_back(*instant);
  }
  if (instants.empty()) {
    throw InputError(
        fmt::format("there is no {} on any of the days up to --to {}", event, *times.to));
  }
  return instants;
}

std::vector<UtcInstant> CountBetween(const UtcInstant& from, double span_s, int count) {
  if (count < 1 || count > kMostFrames) {
    throw InputError(fmt::format("--count is {}; it must lie in [1, {}]", count, kMostFrames));
  }
  std::vector<UtcInstant> instants;
  for (int i = 0; i < count; ++i) {
    instants.push_back(AddSeconds(from, count == 1 ? 0.0 : span_s * i / (count - 1)));
  }
  return instants;
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

/// Returns the instants of the frames.
std::vector<UtcInstant> InstantsOf(const TimesText& times, const EventDay& day) {
  if (!times.at.empty()) {
    std::vector<UtcInstant> instants;
    for (const std::string& text : times.at) instants.push_back(InstantFromText(text, day));
    return instants;
  }
  if (!times.from || !times.to) {
    throw InputError("no time is given: give --at, or --from and --to, or [time] in the scene");
  }
  const std::optional<Step> every = times.every ? std::optional<Step>(*times.every) : std::nullopt;
  if (every && every->is_whole_days && IsEvent(*times.from))
    return EventOfEachDay(times, *every, day);
  const EventDay day_of_from = DayOfFrom(times, day);
  const UtcInstant from = InstantFromText(*times.from, day_of_from);
  EventDay day_of_to = day_of_from;
  if (!IsDailyEvent(*times.from)) day_of_to.around = from;
  const double span_s = SecondsBetween(from, EndOf(times, day_of_to, from));
  if (span_s < 0.0) {
    throw InputError(fmt::format("--to {} is before --from {}", *times.to, *times.from));
  }
  if (every && IsOfCalendarDays(*every, day)) return EveryDays(from, span_s, *every, day);
  if (every) return EverySeconds(from, span_s, *every);
  if (times.count) return CountBetween(from, span_s, *times.count);
  throw InputError("--from and --to need --every or --count");
}

}  // namespace

std::vector<Frame> FramesFromTimes(const TimesText& times, const EventDay& day) {
  std::vector<Frame> frames;
  for (const UtcInstant& instant : InstantsOf(times, day)) {
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

namespace {

double Positive(double value, const std::string& name) {
  if (!(value > 0.0 && std::isfinite(value))) {
    throw InputError(fmt::format("{} is {}; it must be positive", name, value));
  }
  return value;
}

}  // namespace

double FrameInterval(const CameraPath& path, const PathRate& rate) {
  if (rate.every) return Positive(ParseDuration(*rate.every), "--every");
  if (!rate.count) return 1.0 / Positive(rate.per_second, "--fps");
  RequireInRange(*rate.count, 1, kMostFrames, "--count");
  return (path.end_s() - path.begin_s()) / std::max(*rate.count - 1, 1);
}

std::vector<Frame> FramesAlong(const CameraPath& path, const PathRate& rate,
                               const UtcInstant& start) {
  const double interval_s = FrameInterval(path, rate);
  const double length_s = path.end_s() - path.begin_s();
  // A last frame that rounding places after the end of the path still belongs to it.
  constexpr double kRounding = 1e-9;
  const double count =
      rate.count ? *rate.count : std::floor(length_s / interval_s * (1.0 + kRounding)) + 1.0;
  if (!(count <= kMostFrames)) {
    throw InputError(fmt::format("the path has {:.0f} frames; at most {}", count, kMostFrames));
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
