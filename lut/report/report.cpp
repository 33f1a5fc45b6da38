// SPDX-License-Identifier: MIT
#include "lut/report/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <functional>
#include <utility>

#include "atmosphere/base/parsing.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/cli/program.h"
#include "lut/report/report_panoramas.h"
#include "lut/report/report_refraction.h"
#include "lut/report/report_scattering.h"
#include "lut/report/report_transmittance.h"
#include "lut/version.h"

namespace alpenglow::lut {
namespace {

/// Returns the value of the first line of /proc/cpuinfo with this key; "unknown" if there is none.
std::string ProcessorText(const std::string& key) {
  std::ifstream text("/proc/cpuinfo");
  for (std::string line; std::getline(text, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind(key, 0) == 0 && colon != std::string::npos && colon + 2 <= line.size())
      return line.substr(colon + 2);
  }
  return "unknown";
}

/// Returns the widest vector instruction set of the processor.
std::string VectorInstructions() {
  const std::string flags = ProcessorText("flags");
  std::string widest = "unknown";
  for (const std::string_view flag : WordsOf(flags)) {
    if (flag == "avx512f") return "AVX-512";
    if (flag == "avx2") widest = "AVX2";
    if (flag == "sse2" && widest == "unknown") widest = "SSE2";
  }
  return widest;
}

std::string SystemText() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return fmt::format("{} {} ({})", name.sysname, name.release, name.machine);
}

/// Returns the SIMD line of --version, which names the instruction set that the program uses.
std::string SimdLine() {
  const std::string text = VersionText("skylut");
  const std::size_t begin = text.find("SIMD: ");
  if (begin == std::string::npos) return "unknown";
  return text.substr(begin + 6, text.find('\n', begin) - begin - 6);
}

ReportMaker Maker() {
  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return {.machine = fmt::format("{}, {} thread{}, {}", ProcessorText("model name"), threads,
                                 threads == 1 ? "" : "s", VectorInstructions()),
          .system = SystemText(),
          .program = fmt::format("{}, SIMD in use: {}", ProducerText(), SimdLine()),
          .compiler = fmt::format("{} {}, {}, {}", version::kCompiler, version::kCompilerVersion,
                                  version::kBuildType, version::kFlags),
          .date = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))};
}

ReportWords Words() {
  return {
      .title = "Alpenglow: speed and accuracy",
      .lead =
          "All methods of this library, and the methods of the literature for the same quantities, "
          "are evaluated on the same rays in one run. This page shows their errors and their "
          "costs.",
      .minute =
          "For each topic, this section names the fastest method whose errors are not visible by "
          "day, at sunset and in twilight. An error of 1 % in radiance is about the smallest step "
          "between adjacent areas that an observer sees.",
      .reading =
          "Rays are points of Halton's sequence. Sun: the elevation is uniform over the range of "
          "the column. Observer: 2 m, 1.5 km or 10 km above the ground. View: half of the rays "
          "are anywhere in the sky (uniform in solid angle), a quarter within 10° above the "
          "horizontal, a quarter down to the ground; the azimuth is uniform. Beams to the sun "
          "(transmittance) start in the lower half of the air, most of them near the ground; in "
          "twilight their lowest points are distributed in this way. Errors of radiance are "
          "relative to the radiance. Values below a hundredth of the singly scattered light of "
          "the zenith, at the same place under the same sun, count as if they were that bright, "
          "except in the column \"strict\", whose errors are relative to the radiance itself. From "
          "space (400 km), half of the views end on the ground and half pass it at up to 100 km; "
          "the elevation is that of the sun at the ray's lowest point. Molecules polarise light if "
          "the atmosphere says so, the sun is a point, and rays are straight."};
}

}  // namespace

Report MeasureTopics(ReportWords words, bool quick, ProgressStyle style,
                     const std::vector<MeasureTopic>& topics) {
  const Stopwatch watch;
  const std::clock_t cpu_start = std::clock();
  Report report{.words = std::move(words), .maker = Maker(), .quick = quick};
  Progress progress("report", topics.size(), style);
  for (const MeasureTopic& measure : topics) {
    report.topics.push_back(measure());
    progress.Advance();
  }
  report.wall_s = watch.Seconds();
  report.cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  return report;
}

std::vector<Medium> MediumsOfReport(const std::optional<std::string>& atmosphere_file, bool quick) {
  if (atmosphere_file) return {MediumFromChoice(*atmosphere_file, kForPictures)};
  std::vector<Medium> mediums{MediumPreset("earth")};
  if (!quick) mediums.push_back(MediumPreset("hazy"));
  return mediums;
}

Report MeasureReport(const ReportOptions& options) {
  const ReportEffort effort = options.quick ? ReportEffort::Quick() : ReportEffort{};
  std::vector<MeasureTopic> topics;
  const auto add = [&](const auto& measure, const std::vector<Medium>& mediums) {
    for (const Medium& medium : mediums)
      topics.emplace_back([measure, &medium, &effort] { return measure(medium, effort); });
  };
  for (const auto measure : {MeasureTransmittance, MeasureSingleScattering, MeasureAllOrders})
    add(measure, options.mediums);
  add(MeasureHardAir, options.hard_mediums);
  add(MeasurePanoramas, options.mediums);
  // Refraction is measured for the first medium only: all media that refract gently give similar
  // results.
  if (const Medium& first = options.mediums.front(); GentleAirOf(first).refractivity > 0.0)
    topics.emplace_back([&] { return MeasureRefraction(first, effort); });
  return MeasureTopics(Words(), options.quick, options.progress, topics);
}

}  // namespace alpenglow::lut
