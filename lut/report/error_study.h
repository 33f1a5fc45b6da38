// SPDX-License-Identifier: MIT
// This header provides the study of a topic of a report: cases with reference values, and the
// errors and times of methods on them.
//
// Every regime of the topic has its own cases, of any type: rays, directions, lamps, pixels. A
// method is a function from a case to its values: bands, or one number. Its row of the report holds
// for each regime statistics of the errors of all values, the time of one answer, and the mean
// number of points of the air at which the method looks.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "atmosphere/math/error_statistics.h"
#include "atmosphere/ray/ray.h"
#include "lut/cli/program.h"
#include "lut/report/report.h"

namespace alpenglow::lut {

/// Fraction of the sun's light below which strict errors are not counted.
inline constexpr double kDarkestValue = 1e-12;

struct ReferenceValue {
  std::vector<double> value;  // by wavelength
  std::vector<double> sigma;  // one standard error; empty if the reference has none
  std::vector<double> scale;  // value to which errors are relative; empty: 1
};

/// Rule by which the error of a value follows from the true value and the scale of the reference.
struct ErrorRule {
  double (*error)(double value, double truth, double scale);
  /// If true, errors relative to each value are computed, too. Otherwise the strict errors are the
  /// same.
  bool has_strict;
};
inline constexpr ErrorRule kRelativeToScale{
    [](double value, double truth, double scale) { return std::abs(value - truth) / scale; }, true};
inline constexpr ErrorRule kRelativeToTruth{
    [](double value, double truth, double) { return std::abs(value / truth - 1.0); }, false};

/// Returns the errors of a method's values, by wavelength, for the cases of a regime.
[[nodiscard]] ErrorStatistics ErrorsOf(const std::vector<ReferenceValue>& references,
                                       const std::vector<std::vector<double>>& answers,
                                       const ErrorRule& rule = kRelativeToScale);

/// Returns the errors relative to each true value above kDarkestValue.
[[nodiscard]] ErrorStatistics StrictErrorsOf(const std::vector<ReferenceValue>& references,
                                             const std::vector<std::vector<double>>& answers);

/// Returns the rms of the reference's standard errors over cases and wavelengths, relative to their
/// scales; 0 if there are none.
[[nodiscard]] double NoiseOf(const std::vector<ReferenceValue>& references);

/// Numbers of rays, paths and passes of a report.
struct ReportEffort {
  bool quick = false;
  int rays = 400;              // per regime, for references without noise
  int traced_rays = 36;        // per regime, for the path tracer
  std::size_t paths = 30000;   // per traced ray
  std::size_t passes = 7;      // minimum over the cases of a regime
  double seconds = 0.02;       // and minimum duration [s]
  std::size_t time_every = 1;  // every n-th case is timed

  [[nodiscard]] static ReportEffort Quick() {
    return {.quick = true,
            .rays = 40,
            .traced_rays = 6,
            .paths = 2000,
            .passes = 1,
            .seconds = 0.0,
            .time_every = 4};
  }
};

/// Measures wall time.
class Stopwatch {
 public:
  [[nodiscard]] double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns the result of `make` and the time that it takes. Short work is done up to three times,
/// unless the report is quick; the shortest time counts.
template <typename Make>
[[nodiscard]] auto Built(const ReportEffort& effort, const Make& make) {
  double shortest = 0.0, all = 0.0;
  for (int i = 0;; ++i) {
    const Stopwatch watch;
    auto made = make();
    const double taken = watch.Seconds();
    shortest = i == 0 ? taken : std::min(shortest, taken);
    all += taken;
    if (effort.quick || i == 2 || all > 0.4) return std::pair{std::move(made), shortest};
  }
}

/// Times `pass`, which computes `answers` values and returns a sum of them, on this thread, after
/// one pass to warm up.
template <typename Pass>
void TimePasses(std::size_t answers, const ReportEffort& effort, const Pass& pass,
                RegimeResult& result) {
  std::vector<double> passes;
  float sum = pass();
  for (double all = 0.0; passes.size() < effort.passes || all < effort.seconds;) {
    const Stopwatch watch;
    sum += pass();
    passes.push_back(watch.Seconds());
    all += passes.back();
  }
  [[maybe_unused]] static volatile float kept;  // keeps the compiler from removing the work
  kept = sum;
  std::sort(passes.begin(), passes.end());
  result.time_s = passes.front() / static_cast<double>(answers);
  result.time_spread = passes[passes.size() / 2] / passes.front() - 1.0;
}

/// Calls `work` with every number below `count`, on all threads. Throws if the program is
/// interrupted.
void ForEachCase(std::size_t count, const std::function<void(std::size_t)>& work);

/// Return all values of an answer, and the first one.
template <typename Real>
[[nodiscard]] std::vector<double> ValuesOf(const SpectrumOf<Real>& bands) {
  std::vector<double> values(bands.size());
  for (std::size_t band = 0; band < bands.size(); ++band) values[band] = bands[band];
  return values;
}
[[nodiscard]] inline std::vector<double> ValuesOf(double value) { return {value}; }
template <typename Real>
[[nodiscard]] float FirstOf(const SpectrumOf<Real>& bands) {
  return static_cast<float>(bands[0]);
}
[[nodiscard]] inline float FirstOf(double value) { return static_cast<float>(value); }

template <typename Case>
class ErrorStudy {
 public:
  /// @param topic  with its texts and regimes; the study adds numbers and rows.
  ErrorStudy(ReportTopic topic, const ReportEffort& effort,
             const ErrorRule& rule = kRelativeToScale)
      : topic_(std::move(topic)),
        effort_(effort),
        rule_(rule),
        cases_(topic_.regimes.size()),
        references_(topic_.regimes.size()) {}

  struct Solved {
    Case input;
    ReferenceValue reference;
  };

  /// Computes the cases and their reference values, in parallel, and records the time of one.
  /// @param count  number of cases of a regime.
  /// @param solve  function from the numbers of regime and case to std::optional<Solved>; nullopt
  ///   leaves the case out.
  template <typename Solve>
  void SolveCases(std::size_t count, const Solve& solve) {
    const Stopwatch watch;
    topic_.reference.noise.assign(regimes(), 0.0);
    for (std::size_t r = 0; r < regimes(); ++r) {
      std::vector<std::optional<Solved>> all(count);
      ForEachCase(count, [&](std::size_t i) { all[i] = solve(r, i); });
      for (std::optional<Solved>& one : all) {
        if (!one) continue;
        cases_[r].push_back(std::move(one->input));
        references_[r].push_back(std::move(one->reference));
      }
      topic_.reference.noise[r] = NoiseOf(references_[r]);
    }
    topic_.reference.time_s = watch.Seconds() / static_cast<double>(regimes() * count);
    topic_.rays = count;
  }

  /// Measures a method on the cases of regime `r`.
  /// @param answer  function from a case to a spectrum or a number. It is called on all threads at once.
  /// @param samples  number of points of the air of an answer, or a function from a case to it.
  template <typename Answer, typename Samples = int>
  void Measure(std::size_t r, RegimeResult& result, const Answer& answer,
               const Samples& samples = {}) const {
    const std::vector<Case>& cases = cases_[r];
    std::vector<std::vector<double>> answers(cases.size());
    ForEachCase(cases.size(), [&](std::size_t i) { answers[i] = ValuesOf(answer(cases[i])); });
    Judge(r, answers, result);
    if constexpr (std::is_arithmetic_v<Samples>) {
      result.samples = samples;
    } else {
      double points = 0.0;
      for (const Case& one : cases) points += static_cast<double>(samples(one));
      result.samples = points / static_cast<double>(cases.size());
    }
    const std::size_t step = effort_.time_every;
    const auto pass = [&] {
      float sum = 0.0F;
      for (std::size_t i = 0; i < cases.size(); i += step) sum += FirstOf(answer(cases[i]));
      return sum;
    };
    TimePasses((cases.size() + step - 1) / step, effort_, pass, result);
    ThrowIfInterrupted();
  }

  /// Measures a method that is prepared for every regime, and adds its row.
  /// @param prepare  function from the number of a regime and the row, in which it may change
  ///   memory and build time, to the answer of Measure.
  template <typename Prepare, typename Samples = int>
  void AddPrepared(ReportRow row, const Prepare& prepare, const Samples& samples = {}) {
    row.at.resize(regimes());
    for (std::size_t r = 0; r < regimes(); ++r) {
      const auto& answer = prepare(r, row);
      Measure(r, row.at[r], answer, samples);
    }
    topic_.rows.push_back(std::move(row));
  }

  /// Measures a method that is the same in all regimes, and adds its row.
  template <typename Answer, typename Samples = int>
  void Add(ReportRow row, const Answer& answer, const Samples& samples = {}) {
    const auto same = [&](std::size_t, ReportRow&) -> const Answer& { return answer; };
    AddPrepared(std::move(row), same, samples);
  }

  /// Adds a row that was measured elsewhere.
  void AddMeasured(ReportRow row) { topic_.rows.push_back(std::move(row)); }

  /// Sets the errors of a method on the cases of regime `r`.
  void Judge(std::size_t r, const std::vector<std::vector<double>>& answers,
             RegimeResult& result) const {
    result.error = ErrorsOf(references_[r], answers, rule_);
    result.strict = rule_.has_strict ? StrictErrorsOf(references_[r], answers) : result.error;
  }

  [[nodiscard]] std::size_t regimes() const { return topic_.regimes.size(); }
  [[nodiscard]] const std::vector<Case>& cases(std::size_t r) const { return cases_[r]; }
  [[nodiscard]] std::vector<ReferenceValue>& references(std::size_t r) { return references_[r]; }
  [[nodiscard]] const ReportEffort& effort() const { return effort_; }
  [[nodiscard]] ReportTopic& topic() { return topic_; }
  [[nodiscard]] ReportTopic Finished() && { return std::move(topic_); }

 private:
  ReportTopic topic_;
  ReportEffort effort_;
  ErrorRule rule_;
  std::vector<std::vector<Case>> cases_;                 // by regime
  std::vector<std::vector<ReferenceValue>> references_;  // by regime
};

}  // namespace alpenglow::lut
