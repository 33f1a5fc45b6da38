// SPDX-License-Identifier: MIT
#include "lut/report/report_panoramas.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "atmosphere/math/constants.h"
#include "lut/evaluate/eval.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_rays.h"
#include "lut/report/svg_plot.h"
#include "lut/sky/panorama.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::lut {
namespace {

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

  [[nodiscard]] SpectrumOf<Real> Radiance(const ViewRay& ray) const {
    SpectrumOf<Real> light = air_.Inscatter(
        air_.Scatter(air_.Sample(ray, {.nodes = nodes_, .split_ozone = split_})), ray.nu);
    const Spectrum rest = multiple_scattering_.InscatterAlong(
        quick_.Sample(ray, {.nodes = nodes_, .dark_samples = true}), ray.nu);
    for (std::size_t band = 0; band < light.size(); ++band) light[band] += Real{rest[band]};
    if (const auto mu_s = SunOnGround(air_.medium(), ray)) AddGround(ray, *mu_s, light);
    return light;
  }

 private:
  void AddGround(const ViewRay& ray, double mu_s, SpectrumOf<Real>& light) const {
    const SpectrumOf<Real> through = air_.TransmittanceAlong(ray);
    const SpectrumOf<Real> sun = air_.TransmittanceToSpace(0.0, mu_s);
    const Spectrum sky = multiple_scattering_.SkyIrradiance(0.0, mu_s);
    const Real cosine = static_cast<Real>(std::max(mu_s, 0.0));
    for (std::size_t band = 0; band < light.size(); ++band) {
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
        const Spectrum light = direct.Radiance(direction.Ray(mu_s, altitude_m));
        std::copy_n(light.values().begin(), bands_,
                    texels_.begin() + static_cast<std::ptrdiff_t>(Count(width_, y, bands_) +
                                                                  Count(x, 1, bands_)));
      }
    });
  }

  [[nodiscard]] Spectrum Radiance(double zenith_rad, double azimuth_rad) const {
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
    Spectrum light(bands_);
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

ViewRay RayIn(std::size_t r, const Direction& one) {
  return one.Ray(MuS(r, one.sun), AltitudeOf(r));
}

/// Objects that the methods of this topic share.
struct PanoramaAir {
  SingleScattering<float> air;
  MultipleScattering multiple_scattering;
  DirectSky<float> direct;

  explicit PanoramaAir(const Medium& medium)
      : air(medium), multiple_scattering(medium), direct(medium, multiple_scattering, 12, false) {}
};
using PanoramaStudy = ErrorStudy<Direction>;

/// Returns the mean over the directions of a sun. It replaces the zenith, which is black from
/// space.
std::vector<double> MeanOf(PanoramaStudy& study, std::size_t r, std::size_t sun) {
  std::vector<double> mean(study.references(r).front().value.size(), 0.0);
  double count = 0.0;
  for (std::size_t i = 0; i < study.cases(r).size(); ++i) {
    if (study.cases(r)[i].sun != sun) continue;
    for (std::size_t band = 0; band < mean.size(); ++band)
      mean[band] += study.references(r)[i].value[band];
    ++count;
  }
  for (double& value : mean) value /= count;
  return mean;
}

void SolveDirections(PanoramaStudy& study, const Medium& medium,
                     const MultipleScattering& multiple_scattering) {
  const std::vector<Direction> directions = Directions(study.effort().rays);
  const DirectSky<double> exact(medium, multiple_scattering, 32, true);
  study.SolveCases(directions.size(), [&](std::size_t r, std::size_t i) {
    return std::optional(PanoramaStudy::Solved{
        directions[i], {ValuesOf(exact.Radiance(RayIn(r, directions[i]))), {}, {}}});
  });
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    for (std::size_t sun = 0; sun < kSuns; ++sun) {
      std::vector<double> floor = kRegimes[r].from_space
                                      ? MeanOf(study, r, sun)
                                      : ValuesOf(exact.Radiance(RayIn(r, {sun, 0.0, 0.0})));
      for (double& value : floor) value *= kDarkestPart;
      for (std::size_t i = 0; i < directions.size(); ++i) {
        ReferenceValue& one = study.references(r)[i];
        if (directions[i].sun == sun) one = RadianceReference(std::move(one.value), {}, floor);
      }
    }
  }
}

/// Adds a method with one table for each sun. @param make  makes the table of a sun of a regime.
template <typename Make>
void AddTables(PanoramaStudy& study, ReportRow row, const Make& make) {
  const auto [first, seconds] = Built(study.effort(), [&] { return make(0, 1); });
  row.build_s = seconds;
  row.memory_bytes = first.bytes();
  study.AddPrepared(std::move(row), [&](std::size_t r, ReportRow&) {
    std::vector<decltype(make(0, 0))> tables;
    for (std::size_t sun = 0; sun < kSuns; ++sun) tables.push_back(make(r, sun));
    return [tables = std::move(tables)](const Direction& one) {
      return tables[one.sun].Radiance(one.zenith_rad, one.azimuth_rad);
    };
  });
}

/// Times look-ups row by row, as panoramas do them.
void TimeRows(const SkyView& view, const ReportEffort& effort, RegimeResult& result) {
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
  TimePasses(kRows * kColumns, effort, pass, result);
}

/// Adds sky views, evaluated one by one and in rows. @param size  nullopt: chosen by
/// SkyViewSizeFor.
void AddSkyView(PanoramaStudy& study, const PanoramaAir& shared,
                const std::optional<SkyViewSize>& size) {
  const auto view = [&](std::size_t r, std::size_t sun) {
    return size ? SkyView(shared.air, shared.multiple_scattering, AltitudeOf(r), MuS(r, sun), *size)
                : SkyView(shared.air, shared.multiple_scattering, AltitudeOf(r), MuS(r, sun));
  };
  AddTables(study,
            {.series = "sky view, one by one",
             .parameter = size ? fmt::format("({} + {}) x {}", size->sky_rows, size->ground_rows,
                                             size->azimuths)
                               : "size chosen",
             .in_summary = !size.has_value()},
            view);
  ReportRow row = study.topic().rows.back();
  row.series = "sky view, in rows";
  for (std::size_t r = 0; r < kReportRegimes; ++r) TimeRows(view(r, 1), study.effort(), row.at[r]);
  study.AddMeasured(std::move(row));
}

void AddLatitudes(PanoramaStudy& study, const PanoramaAir& shared, int width, int height) {
  AddTables(study,
            {.series = "latitude table (Hillaire 2020)",
             .parameter = fmt::format("{} x {}", width, height),
             .origin = MethodOrigin::kLiterature,
             .in_summary = width == 192},  // the published size
            [&](std::size_t r, std::size_t sun) {
              return LatitudeTable(shared.direct, AltitudeOf(r), MuS(r, sun), shared.air.bands(),
                                   width, height);
            });
}

/// Returns the wall time of a whole image on all threads, with the sun at 25 degrees, in words.
std::string PictureTimeText(const PanoramaAir& shared, const ReportEffort& effort) {
  const int width = effort.quick ? 128 : 2048;
  PanoramaOptions options;
  options.width = width;
  options.height = width / 2;
  options.sun.elevation_deg = 25.0;
  const double seconds = Built(effort, [&] {
                           return RenderPanorama(shared.air, shared.multiple_scattering, options);
                         }).second;
  return fmt::format(
      "A whole panorama of {} x {} pixels by the sky view, including colours, takes {} on all "
      "threads.",
      width, width / 2, QuantityText(seconds, PlotUnit::kSeconds));
}

}  // namespace

ReportTopic MeasurePanoramas(const Medium& medium, const ReportEffort& effort) {
  PanoramaStudy study(
      {.key = "panoramas",
       .title = "Panoramas: the whole sphere under one sun",
       .what = "One observer, one sun, any direction. The methods compute the radiance of sky and "
               "lit ground, with light of all orders.",
       .error_unit = "fractions of the radiance",
       .notes = "Each column has three suns, seen from 2 m and from 400 km. Half of the directions "
                "are anywhere on the sphere, half within 10° of the horizontal. The table over "
                "latitudes is the sky-view table of Hillaire (2020), 192 x 108, filled here by "
                "direct evaluation: its errors are due to interpolation only. ",
       .medium = medium,
       .reference = {.text =
                         "direct evaluation in double with 32 Gauss nodes a panel, cut at ozone; "
                         "light of higher orders is the same for all methods"}},
      effort);
  const PanoramaAir shared(medium);
  SolveDirections(study, medium, shared.multiple_scattering);
  study.AddPrepared({.series = "direct evaluation", .parameter = "12 nodes", .in_summary = true},
                    [&](std::size_t r, ReportRow&) {
                      return [&, r](const Direction& one) {
                        return shared.direct.Radiance(RayIn(r, one));
                      };
                    });
  AddSkyView(study, shared, SkyViewSize{.sky_rows = 20, .ground_rows = 12, .azimuths = 9});
  AddSkyView(study, shared, {});
  if (!effort.quick)
    AddSkyView(study, shared, SkyViewSize{.sky_rows = 80, .ground_rows = 48, .azimuths = 33});
  AddLatitudes(study, shared, 96, 54);
  if (!effort.quick) AddLatitudes(study, shared, 192, 108);
  study.topic().notes += PictureTimeText(shared, effort);
  return std::move(study).Finished();
}

}  // namespace alpenglow::lut
