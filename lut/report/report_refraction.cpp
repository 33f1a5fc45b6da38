// SPDX-License-Identifier: MIT
// A topic of the report: where a line of sight leads, bent by the air.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "atmosphere/judge/ray_equation.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/number/halton.h"
#include "atmosphere/ray/bent_view.h"
#include "lut/report/report_measure.h"

namespace alpenglow::lut {
namespace {

// Lines of the plot.
enum RefractionStyle { kTables = 0, kQuadrature = 1, kStraight = 5, kBennett = 6 };

constexpr double kSunDiameter_rad = 32.0 / 60.0 * kRadiansPerDegree;

/// Where eyes stand and how far up they look [degrees over the horizon of the ground].
struct Sight {
  ReportRegime regime;
  double lowest_m, highest_m, lowest_deg, highest_deg;
};
constexpr std::array<Sight, 3> kSights{
    {{{"low", "From the ground, 0° to 5° up", {}}, 0.0, 2.0, 0.0, 5.0},
     {{"high", "From the ground, 5° to 90° up", {}}, 0.0, 2.0, 5.0, 90.0},
     {{"aloft", "From 1 to 12 km, 0° to 5° over the horizon", {}}, 1e3, 12e3, 0.0, 5.0}}};
// Eyes of a regime: a table is of one height.
constexpr std::size_t kEyes = 4;

/// Bennett (1982), J. Navigation 35, 255, of an apparent elevation, as almanacs give it: from sea
/// level, at 10 C and 1010 hPa.
double BennettRefraction(double apparent_rad) {
  const double h_deg = apparent_rad / kRadiansPerDegree;
  return kRadiansPerDegree / 60.0 / std::tan((h_deg + 7.31 / (h_deg + 4.4)) * kRadiansPerDegree);
}

class RefractionTopic {
 public:
  RefractionTopic(const Medium& medium, const ReportEffort& effort)
      : medium_(medium), effort_(effort) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t r = 0; r < kSights.size(); ++r) Judge(r);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    judge_time_s_ = taken.count() / static_cast<double>(kSights.size() * Count());
  }

  void AddTables() {
    ReportRow row = Row("tables of one height", kTables);
    std::vector<BentView> views;
    const auto [one, seconds] = Built([&] { return BentView(medium_, 0.0); });
    row.build_s = seconds;
    row.memory_bytes = one.bytes();
    for (std::size_t r = 0; r < kSights.size(); ++r)
      for (std::size_t eye = 0; eye < kEyes; ++eye) views.emplace_back(medium_, EyeHeight(r, eye));
    Measure(row, [&](std::size_t r, const Line& line) {
      return line.apparent_rad - views[r * kEyes + line.eye].TrueElevation(line.apparent_rad);
    });
  }

  void AddQuadrature() {
    const BendingAir air = GentleAirOf(medium_);
    Measure(Row("quadrature over elevation (Auer, Standish 2000)", kQuadrature),
            [&](std::size_t, const Line& line) {
              return RefractionSeenAt(air, line.apparent_rad, line.height_m);
            });
  }

  void AddBennett() {
    ReportRow row = Row("Bennett 1982, the air of almanacs", kBennett);
    row.origin = MethodOrigin::kLiterature;
    Measure(std::move(row),
            [](std::size_t, const Line& line) { return BennettRefraction(line.apparent_rad); });
  }

  void AddStraight() {
    ReportRow row = Row("straight rays", kStraight);
    row.origin = MethodOrigin::kLiterature;
    Measure(std::move(row), [](std::size_t, const Line&) { return 0.0; });
  }

  [[nodiscard]] ReportTopic Finished() && {
    topic_.key = "refraction";
    topic_.title = "Refraction: where a line of sight leads";
    topic_.what =
        "Lines of sight from the ground and from the air; the question is by how much what stands "
        "behind the air, sun, moon or star, is lifted (550 nm).";
    topic_.error_unit = "parts of the sun's diameter, 32'";
    topic_.notes =
        "Rays are bent in the density that the atmosphere's molecules have. Bennett's formula is "
        "of "
        "the air of almanacs, and of an eye at sea level: what it is off by is mostly the other "
        "air. "
        "A table is made once for an eye's height; quadrature serves any.";
    topic_.wanted = 0.01;
    topic_.answer = "line of sight";
    topic_.everywhere = "from every height";
    topic_.regimes.clear();
    for (const Sight& sight : kSights) topic_.regimes.push_back(sight.regime);
    topic_.medium = medium_;
    topic_.rays = Count();
    topic_.judge = {.text =
                        "the ray equation, by Runge and Kutta's fourth order, with Peck and "
                        "Reeder's refractivity",
                    .time_s = judge_time_s_};
    return std::move(topic_);
  }

 private:
  struct Line {
    std::size_t eye;
    double height_m, apparent_rad, refraction_rad;
  };

  [[nodiscard]] std::size_t Count() const { return static_cast<std::size_t>(effort_.rays) / 2; }
  static double EyeHeight(std::size_t r, std::size_t eye) {
    const Sight& sight = kSights[r];
    return sight.lowest_m +
           (sight.highest_m - sight.lowest_m) * static_cast<double>(eye) / (kEyes - 1.0);
  }
  static ReportRow Row(std::string series, RefractionStyle style) {
    return {.series = std::move(series),
            .parameter = "",
            .style = style,
            .in_summary = true,
            .at = std::vector<RegimeResult>(kSights.size())};
  }

  void Judge(std::size_t r) {
    const judge::RayEquation equation(medium_, judge::PeckAndReeder(kHorizonWavelength_nm));
    const Sight& sight = kSights[r];
    for (std::size_t i = 0; i < Count(); ++i) {
      Line line{i % kEyes, EyeHeight(r, i % kEyes), 0.0, 0.0};
      const double over_deg = sight.lowest_deg + (sight.highest_deg - sight.lowest_deg) *
                                                     Halton(static_cast<int>(i) + 1, 2);
      line.apparent_rad =
          GrazingElevation(GentleAirOf(medium_), line.height_m) + over_deg * kRadiansPerDegree;
      line.refraction_rad = equation.Follow(line.apparent_rad, line.height_m).refraction_rad;
      lines_[r].push_back(line);
    }
    ThrowIfInterrupted();
  }

  /// @param refraction  function from regime and line to what it is lifted by [rad].
  template <typename Refraction>
  void Measure(ReportRow row, const Refraction& refraction) {
    for (std::size_t r = 0; r < kSights.size(); ++r) {
      std::vector<double> errors;
      for (const Line& line : lines_[r])
        errors.push_back(std::abs(refraction(r, line) - line.refraction_rad) / kSunDiameter_rad);
      row.at[r].error = StatisticsOfErrors(std::move(errors), 0.0);
      const auto pass = [&] {
        float sum = 0.0F;
        for (const Line& line : lines_[r]) sum += static_cast<float>(refraction(r, line));
        return sum;
      };
      TimePasses(lines_[r].size(), effort_, pass, row.at[r]);
      ThrowIfInterrupted();
    }
    topic_.rows.push_back(std::move(row));
  }

  const Medium& medium_;
  const ReportEffort& effort_;
  std::array<std::vector<Line>, kSights.size()> lines_;
  double judge_time_s_ = 0.0;
  ReportTopic topic_;
};

}  // namespace

ReportTopic MeasureRefraction(const Medium& medium, const ReportEffort& effort) {
  RefractionTopic topic(medium, effort);
  topic.AddTables();
  topic.AddQuadrature();
  topic.AddBennett();
  topic.AddStraight();
  return std::move(topic).Finished();
}

}  // namespace alpenglow::lut
