// SPDX-License-Identifier: MIT
#include "lut/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <sys/utsname.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <functional>
#include <sstream>

#include "lut/program.h"
#include "lut/report_measure.h"
#include "lut/version.h"

namespace alpenglow {
namespace {

/// Value of the first line of /proc/cpuinfo with this key; "unknown" where there is none.
std::string ProcessorText(const std::string& key) {
  std::ifstream text("/proc/cpuinfo");
  for (std::string line; std::getline(text, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind(key, 0) == 0 && colon != std::string::npos && colon + 2 <= line.size())
      return line.substr(colon + 2);
  }
  return "unknown";
}

/// The widest of the vector instructions that the processor has.
std::string VectorInstructions() {
  std::istringstream flags(ProcessorText("flags"));
  std::string widest = "unknown";
  for (std::string flag; flags >> flag;) {
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

/// The line of --version that says which SIMD the program uses.
std::string SimdLine() {
  std::istringstream text(VersionText("skylut"));
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("SIMD: ", 0) == 0) return line.substr(6);
  }
  return "unknown";
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

}  // namespace

Report MeasureReport(const ReportOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  const ReportEffort effort = options.quick ? ReportEffort::Quick() : ReportEffort{};
  Report report{.maker = Maker(), .quick = options.quick};
  using Measure = std::function<ReportTopic(const Medium&, const ReportEffort&)>;
  const std::vector<Measure> topics{MeasureTransmittance, MeasureSingleScattering, MeasureAllOrders,
                                    MeasurePanoramas};
  Progress progress("report", topics.size() * options.mediums.size(), options.progress);
  for (const Measure& measure : topics) {
    for (const Medium& medium : options.mediums) {
      report.topics.push_back(measure(medium, effort));
      progress.Advance();
    }
  }
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  return report;
}

}  // namespace alpenglow
