// SPDX-License-Identifier: MIT
// This file measures a topic of the report: the whole sphere around an observer under one sun.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "lut/evaluate/eval.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_measure.h"
#include "lut/sky/panorama.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::lut {
namespace {

// Styles of the lines of the plot.
enum PanoramaStyle { kSkyViewRows = 0, kLatitudes = 1, kDirect = 2, kSkyView = 6 };

constexpr std::size_t kSuns = 3;
constexpr std::array<std::array<double, kSuns>, kReportRegimes> kElevations_deg{
    {{60.0, 25.0, 8.0},
     {4.0, 1.5, 0.2},
     {-1.0, -3.5, -6.0},
     {-7.0, -8.5, -10.0},
     {50.0, 10.0, -8.0}}};

double AltitudeOf(std::size_t regime) {
  return kRegimes[regime].from_space ? kSpaceAltitude_m : 2.0;
}

double MuS(std::size_t regime, std::size_t sun) {
  return std::sin(kElevations_deg[regime][sun] * kRadiansPerDegree);
}

/// A direction and the index of the sun.
struct Direction {
  std::size_t sun;
  double zenith_rad, azimuth_rad;

  [[nodiscard]] ViewRay Ray(double mu_s, double altitude_m) const {
    const double mu = std::cos(zenith_rad);
    const double nu =
        mu * mu_s + std::sin(zenith_rad) * std::sqrt(1.0 - mu_s * mu_s) * std::cos(azimuth_rad);
    return {altitude_m, mu, mu_s, std::clamp(nu, -1.0, 1.0)};
  }
};

/// Returns directions uniform over the sphere; every second one lies within 10 degrees of the
/// horizontal instead.
std::vector<Direction> Directions(int count) {
  std::vector<Direction> directions;
  constexpr double kGolden = 0.6180339887498949, kPlastic = 0.7548776662466927;
  for (int i = 0; i < count; ++i) {
    const double u = std::fmod(0.5 + i * kGolden, 1.0), v = std::fmod(0.5 + i * kPlastic, 1.0);
    const double zenith =
        i % 2 == 0 ? std::acos(1.0 - 2.0 * u) : (80.0 + 20.0 * u) * kRadiansPerDegree;
    directions.push_back({static_cast<std::size_t>(i / 2) % kSuns, zenith, kPi * v});
  }
  return directions;
}

/// The light of a direction by direct evaluation: sky of all orders, and the lit ground behind the
/// air.
template <typename Real>
class DirectSky {
 public:
  DirectSky(const Medium& medium, const MultipleScattering& multiple_scattering, int nodes,
            bool split_ozone)
      : air_(medium),
        quick_(medium),
        multiple_scattering_(multiple_scattering),
        nodes_(nodes),
        split_(split_ozone) {}

  [[nodiscard]] Bands<Real> Radiance(const ViewRay& ray) const {
    Bands<Real> light = air_.Inscatter(
        air_.Scatter(air_.Sample(ray, {.nodes = nodes_, .split_ozone = split_})), ray.nu);
    const Bands<float> rest = multiple_scattering_.InscatterAlong(
        quick_.Sample(ray, {.nodes = nodes_, .dark_samples = true}), ray.nu);
    for (std::size_t band = 0; band < light.count; ++band) light[band] += Real{rest[band]};
    if (const auto mu_s = SunOnGround(air_.medium(), ray)) AddGround(ray, *mu_s, light);
    return light;
  }

 private:
  void AddGround(const ViewRay& ray, double mu_s, Bands<Real>& light) const {
    const Bands<Real> through = air_.TransmittanceAlong(ray);
    const Bands<Real> sun = air_.TransmittanceToSpace(0.0, mu_s);
    const Bands<float> sky = multiple_scattering_.SkyIrradiance(0.0, mu_s);
    const Real cosine = static_cast<Real>(std::max(mu_s, 0.0));
    for (std::size_t band = 0; band < light.count; ++band) {
      const Real reflected = static_cast<Real>(air_.medium().ground_albedo[band] / kPi);
      light[band] += through[band] * reflected * (Real{sky[band]} + cosine * sun[band]);
    }
  }

  SingleScattering<Real> air_;
  SingleScattering<float> quick_;
  const MultipleScattering& multiple_scattering_;
  int nodes_;
  bool split_;
};

/// A table of radiance over longitude (linear) and latitude (square root, dense at the horizontal),
/// bilinear: the sky-view table of Hillaire (2020), section 5.3, filled by direct evaluation.
class LatitudeTable {
 public:
  LatitudeTable(const DirectSky<float>& direct, double altitude_m, double mu_s, std::size_t bands,
                int width, int height)
      : bands_(bands), width_(width), height_(height), texels_(Count(width, height, bands)) {
    tbb::parallel_for(0, height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        const double v = 2.0 * y / (height - 1.0) - 1.0;
        const Direction direction{0, 0.5 * kPi * (1.0 + std::copysign(v * v, v)),
                                  2.0 * kPi * x / width};
        const Bands<float> light = direct.Radiance(direction.Ray(mu_s, altitude_m));
        std::copy_n(light.value.begin(), bands_,
                    texels_.begin() + static_cast<std::ptrdiff_t>(Count(width_, y, bands_) +
                                                                  Count(x, 1, bands_)));
      }
    });
  }

  [[nodiscard]] Bands<float> Radiance(double zenith_rad, double azimuth_rad) const {
    const double latitude = zenith_rad / (0.5 * kPi) - 1.0;
    const double y =
        0.5 * (1.0 + std::copysign(std::sqrt(std::abs(latitude)), latitude)) * (height_ - 1.0);
    const double x = azimuth_rad / (2.0 * kPi) * width_;
    const int row = std::clamp(static_cast<int>(y), 0, height_ - 2);
    const int column = static_cast<int>(x) % width_;
    const auto fx = static_cast<float>(x - std::floor(x)), fy = static_cast<float>(y - row);
    const float* left = &texels_[Count(width_, row, bands_) + Count(column, 1, bands_)];
    const float* right =
        &texels_[Count(width_, row, bands_) + Count((column + 1) % width_, 1, bands_)];
    const std::size_t below = Count(width_, 1, bands_);
    Bands<float> light(bands_);
    for (std::size_t band = 0; band < bands_; ++band) {
      light[band] = (left[band] * (1.0F - fx) + right[band] * fx) * (1.0F - fy) +
                    (left[below + band] * (1.0F - fx) + right[below + band] * fx) * fy;
    }
    return light;
  }

  [[nodiscard]] std::uint64_t bytes() const { return texels_.size() * sizeof(float); }

 private:
  static std::size_t Count(int a, int b, std::size_t c) {
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b) * c;
  }

  std::size_t bands_;
  int width_, height_;
  std::vector<float> texels_;
};

class PanoramaTopic {
 public:
  PanoramaTopic(const Medium& medium, const ReportEffort& effort)
      : medium_(medium),
        effort_(effort),
        air_(medium),
        multiple_scattering_(medium),
        direct_(medium, multiple_scattering_, 12, false),
        directions_(Directions(effort.rays)) {
    reference_rays_.reference.text =
        "direct evaluation in double with 32 Gauss nodes a panel, cut at ozone; "
        "light of higher orders is the same for all methods";
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t r = 0; r < kReportRegimes; ++r) SolveReference(r);
    reference_rays_.reference.time_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
        static_cast<double>(kReportRegimes * directions_.size());
  }

  void AddDirect() {
    ReportRow row{.series = "direct evaluation",
                  .parameter = "12 nodes",
                  .style = kDirect,
                  .in_summary = true};
    Measure(row, [&](std::size_t r) {
      return [&, r](const Direction& one) { return direct_.Radiance(RayIn(r, one)); };
    });
  }

  /// @param size  nullopt: chosen by SkyViewSizeFor.
  void AddSkyView(const std::optional<SkyViewSize>& size) {
    ReportRow row{.series = "sky view, one by one",
                  .parameter = size ? fmt::format("({} + {}) x {}", size->sky_rows,
                                                  size->ground_rows, size->azimuths)
                                    : "size chosen",
                  .style = kSkyView,
                  .in_summary = !size.has_value()};
    const auto view = [&](std::size_t r, std::size_t sun) {
      return size ? SkyView(air_, multiple_scattering_, AltitudeOf(r), MuS(r, sun), *size)
                  : SkyView(air_, multiple_scattering_, AltitudeOf(r), MuS(r, sun));
    };
    AddTables(row, view);
    row = rows_.back();
    row.series = "sky view, in rows";
    row.style = kSkyViewRows;
    for (std::size_t r = 0; r < kReportRegimes; ++r) TimeRows(view(r, 1), row.at[r]);
    rows_.push_back(std::move(row));
  }

  void AddLatitudes(int width, int height, bool published) {
    ReportRow row{.series = "latitude table (Hillaire 2020)",
                  .parameter = fmt::format("{} x {}", width, height),
                  .origin = MethodOrigin::kLiterature,
                  .style = kLatitudes,
                  .in_summary = published};
    AddTables(row, [&](std::size_t r, std::size_t sun) {
      return LatitudeTable(direct_, AltitudeOf(r), MuS(r, sun), air_.bands(), width, height);
    });
  }

  /// Returns the wall time [s] of a whole image, all threads, with the sun at 25 degrees.
  [[nodiscard]] double PictureSeconds(int width) const {
    PanoramaSettings settings;
    settings.width = width;
    settings.height = width / 2;
    settings.sun.elevation_rad = 25.0 * kRadiansPerDegree;
    return Built([&] { return RenderPanorama(air_, multiple_scattering_, settings); }).second;
  }

  [[nodiscard]] ReportTopic Finished(ReportTopic words) && {
    words.medium = medium_;
    words.rays = directions_.size();
    words.reference = reference_rays_.reference;
    words.rows = std::move(rows_);
    return words;
  }

 private:
  static ViewRay RayIn(std::size_t r, const Direction& one) {
    return one.Ray(MuS(r, one.sun), AltitudeOf(r));
  }

  void SolveReference(std::size_t r) {
    const DirectSky<double> exact(medium_, multiple_scattering_, 32, true);
    std::vector<ReferenceRay>& rays = reference_rays_.rays[r];
    rays.resize(directions_.size());
    tbb::parallel_for(std::size_t{0}, directions_.size(), [&](std::size_t i) {
      const ViewRay ray = RayIn(r, directions_[i]);
      rays[i] = {ray, ValuesOf(exact.Radiance(ray)), {}, {}};
    });
    for (std::size_t sun = 0; sun < kSuns; ++sun) {
      std::vector<double> floor = kRegimes[r].from_space
                                      ? MeanOf(r, sun)
                                      : ValuesOf(exact.Radiance(RayIn(r, {sun, 0.0, 0.0})));
      for (double& value : floor) value *= kDarkestPart;
      for (std::size_t i = 0; i < rays.size(); ++i)
        if (directions_[i].sun == sun) rays[i].floor = floor;
    }
  }

  /// Returns the mean over the directions of a sun. It replaces the zenith, which is black from
  /// space.
  [[nodiscard]] std::vector<double> MeanOf(std::size_t r, std::size_t sun) const {
    std::vector<double> mean(air_.bands(), 0.0);
    double count = 0.0;
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      if (directions_[i].sun != sun) continue;
      for (std::size_t band = 0; band < mean.size(); ++band)
        mean[band] += reference_rays_.rays[r][i].truth[band];
      ++count;
    }
    for (double& value : mean) value /= count;
    return mean;
  }

  /// Times look-ups row by row, as panoramas do them.
  void TimeRows(const SkyView& view, RegimeResult& result) const {
    constexpr std::size_t kRows = 32, kColumns = 256;
    std::vector<double> azimuth_rad;
    for (std::size_t i = 0; i < kColumns; ++i)
      azimuth_rad.push_back(2.0 * kPi * static_cast<double>(i) / kColumns);
    const SkyAzimuths azimuths(view, azimuth_rad);
    std::vector<float> radiance(kColumns * view.stride());
    const auto pass = [&] {
      for (std::size_t row = 0; row < kRows; ++row)
        view.FillRow(kPi * (static_cast<double>(row) + 0.5) / kRows, azimuths, radiance);
      return radiance.front();
    };
    TimePasses(kRows * kColumns, effort_, pass, result);
  }

  /// @param make  makes the table of a sun of a regime.
  template <typename Make>
  void AddTables(ReportRow row, const Make& make) {
    const auto [first, seconds] = Built([&] { return make(0, 1); });
    row.build_s = seconds;
    row.memory_bytes = first.bytes();
    Measure(std::move(row), [&](std::size_t r) {
      std::vector<decltype(make(0, 0))> tables;
      for (std::size_t sun = 0; sun < kSuns; ++sun) tables.push_back(make(r, sun));
      return [tables = std::move(tables)](const Direction& one) {
        return tables[one.sun].Radiance(one.zenith_rad, one.azimuth_rad);
      };
    });
  }

  /// @param answers  returns the function that evaluates directions in a regime.
  template <typename Answers>
  void Measure(ReportRow row, const Answers& answers) {
    for (std::size_t r = 0; r < kReportRegimes; ++r) {
      const auto answer = answers(r);
      std::vector<std::vector<double>> values;
      for (const Direction& one : directions_) values.push_back(ValuesOf(answer(one)));
      row.at[r].error = StatisticsOf(reference_rays_.rays[r], reference_rays_.kind, values);
      const auto pass = [&] {
        float sum = 0.0F;
        for (const Direction& one : directions_) sum += answer(one)[0];
        return sum;
      };
      TimePasses(directions_.size(), effort_, pass, row.at[r]);
      ThrowIfInterrupted();
    }
    rows_.push_back(std::move(row));
  }

  const Medium& medium_;
  const ReportEffort& effort_;
  SingleScattering<float> air_;
  MultipleScattering multiple_scattering_;
  DirectSky<float> direct_;
  std::vector<Direction> directions_;
  ReferenceRays reference_rays_;
  std::vector<ReportRow> rows_;
};

}  // namespace

ReportTopic MeasurePanoramas(const Medium& medium, const ReportEffort& effort) {
  PanoramaTopic topic(medium, effort);
  topic.AddDirect();
  topic.AddSkyView(SkyViewSize{.sky_rows = 20, .ground_rows = 12, .azimuths = 9});
  topic.AddSkyView({});
  if (!effort.quick)
    topic.AddSkyView(SkyViewSize{.sky_rows = 80, .ground_rows = 48, .azimuths = 33});
  topic.AddLatitudes(96, 54, false);
  if (!effort.quick) topic.AddLatitudes(192, 108, true);
  const int width = effort.quick ? 128 : 2048;
  const std::string notes = fmt::format(
      "Three suns a column, seen from 2 m and from 400 km; half of the directions anywhere on the "
      "sphere, "
      "half within 10° of the horizontal. The table over latitudes is the sky-view table of "
      "Hillaire (2020), 192 x 108, filled here by direct evaluation: its errors are those of "
      "interpolation alone. A whole panorama of {} x {} pixels, sky view, colours and all, took "
      "{} on all threads.",
      width, width / 2, QuantityText(topic.PictureSeconds(width), PlotUnit::kSeconds));
  return std::move(topic).Finished(
      {.key = "panoramas",
       .title = "Panoramas: the whole sphere under one sun",
       .what = "One observer, one sun, any direction: the radiance of sky and lit ground, light of "
               "all orders.",
       .error_unit = "parts of the radiance",
       .notes = notes,
       .wanted = 0.01,
       .cost = CostAxis::kTimeOfAnswer});
}

}  // namespace alpenglow::lut
