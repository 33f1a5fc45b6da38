// SPDX-License-Identifier: MIT
#include "renderer/report/report_caustics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/report/cloud_views.h"
#include "renderer/report/error_pictures.h"
#include "renderer/report/glass_paths.h"
#include "renderer/report/sphere_caustic.h"
#include "renderer/report/traced_light.h"
#include "renderer/specular/beam_map.h"
#include "renderer/specular/photon_beams.h"
#include "renderer/specular/point_map.h"

namespace alpenglow::renderer {
namespace {

/// The fog and the light of a column.
struct CausticKind {
  ThinFog fog;
  double light_radius_rad;
};
constexpr std::size_t kCausticKinds = 3;
constexpr std::array<ReportRegime, kCausticKinds> kCaustics{
    {{"isotropic", "Isotropic fog, parallel light", {}},
     {"forward", "Fog of g = 0.7, parallel light", {}},
     {"wide", "Isotropic fog, light of 10° radius", {}}}};
constexpr std::array<CausticKind, kCausticKinds> kCausticKindOf{
    {{{.g = 0.0}, 0.0}, {{.g = 0.7}, 0.0}, {{.g = 0.0}, 0.17453292519943295}}};
constexpr std::size_t kCausticPictureKind = 0;
constexpr int kOrders = 5;  // of paths through the sphere, by the reference

/// Numbers of photons and radii of a kind of map.
struct CausticMapSizes {
  std::vector<int> photons;
  std::vector<double> radii_pixels;
  double pictured_pixels;  // radius of the maps with pictures
};

/// Sizes of the topic.
struct CausticStudySize {
  int stride;               // between measured pixels, along both axes
  int side;                 // rays of the reference along a side of a pixel, even
  int rings, wide_rings;    // of the reference, for parallel and for wide light
  std::size_t wide_points;  // of the disk of wide light, for each ray
  int picture_stride;       // between pixels of the pictures
  CausticMapSizes beams, points;
  std::vector<std::size_t> paths;
};
CausticStudySize CausticSizeOf(bool quick) {
  if (quick) {
    return {.stride = 6,
            .side = 2,
            .rings = 600,
            .wide_rings = 100,
            .wide_points = 8,
            .picture_stride = 4,
            .beams = {{1000, 10000}, {1.0}, 1.0},
            .points = {{10000, 100000}, {2.0}, 2.0},
            .paths = {1004}};
  }
  return {.stride = 3,
          .side = 4,
          .rings = 3000,
          .wide_rings = 200,
          .wide_points = 64,
          .picture_stride = 1,
          .beams = {{10000, 100000}, {2.0, 1.0, 0.5}, 0.5},
          .points = {{100000, 1000000}, {4.0, 2.0, 1.0}, 1.0},
          .paths = {1004, 10040, 100400}};
}

/// The eye's ray through a pixel, and the pixel's place.
struct CausticPixel {
  double column, row;

  [[nodiscard]] CausticRay Ray(double x = 0.5, double y = 0.5) const {
    const CausticView view;
    return {view.eye(), view.Direction(column + x, row + y), view.kEnd_m};
  }
};
using CausticStudy = ErrorStudy<CausticPixel>;

/// Returns every n-th pixel of the view along both axes that does not show the sphere.
std::vector<CausticPixel> CausticPixelsOf(int stride) {
  const CausticView view;
  std::vector<CausticPixel> pixels;
  for (int row = stride / 2; row < view.rows; row += stride) {
    for (int column = stride / 2; column < view.columns; column += stride) {
      if (view.IsBehindSphere(column))
        pixels.push_back({static_cast<double>(column), static_cast<double>(row)});
    }
  }
  return pixels;
}

/// The reference: means over rays of a pixel, with a standard error from the difference of its two
/// halves in the manner of a chessboard.
class ConesReference {
 public:
  ConesReference(const CausticKind& kind, const CausticStudySize& size)
      : kind_(kind),
        size_(size),
        cones_(1.0, 1.5, kOrders, kind.light_radius_rad > 0.0 ? size.wide_rings : size.rings,
               kind.fog) {}

  [[nodiscard]] CloudEstimate Of(const CausticPixel& pixel) const {
    std::array<double, 2> halves{};
    const int side = size_.side;
    for (int i = 0; i < side * side; ++i) {
      const int x = i % side, y = i / side;
      const CausticRay ray = pixel.Ray((x + 0.5) / side, (y + 0.5) / side);
      halves[static_cast<std::size_t>((x + y) % 2)] +=
          2.0 / (side * side) * LightAlong(ray, static_cast<std::size_t>(i));
    }
    return {0.5 * (halves[0] + halves[1]), 0.5 * std::abs(halves[0] - halves[1])};
  }

 private:
  [[nodiscard]] double LightAlong(const CausticRay& ray, std::size_t number) const {
    if (kind_.light_radius_rad == 0.0) return cones_.Radiance(ray.eye, ray.direction, ray.length_m);
    return LightOfCones(cones_, ray,
                        {kind_.light_radius_rad, number * size_.wide_points, size_.wide_points});
  }

  CausticKind kind_;
  CausticStudySize size_;
  SphereCaustic cones_;
};

/// Solves the light of pixels, in parallel.
std::vector<CloudEstimate> SolvedPixels(const ConesReference& reference,
                                        const std::vector<CausticPixel>& pixels) {
  std::vector<CloudEstimate> solved(pixels.size());
  ForEachCase(pixels.size(), [&](std::size_t i) { solved[i] = reference.Of(pixels[i]); });
  return solved;
}

/// Adds the pixels with more than a fraction of the largest light to the study.
void SolveCaustics(CausticStudy& study, const CausticStudySize& size) {
  const std::vector<CausticPixel> pixels = CausticPixelsOf(size.stride);
  const Stopwatch watch;
  std::vector<std::vector<CloudEstimate>> solved;
  std::vector<double> largest;
  for (const CausticKind& kind : kCausticKindOf) {
    solved.push_back(SolvedPixels(ConesReference(kind, size), pixels));
    largest.push_back(BrightestOf(solved.back()));
  }
  const double taken_s = watch.Seconds();
  study.SolveCases(pixels.size(), [&](std::size_t r, std::size_t i) {
    const auto& [value, error] = solved[r][i];
    std::optional<CausticStudy::Solved> lit;
    if (value > kDarkestCaustic * largest[r])
      lit = CausticStudy::Solved{pixels[i], {{value}, {error}, {value}}};
    return lit;
  });
  study.topic().reference.time_s = taken_s / static_cast<double>(kCausticKinds * pixels.size());
}

/// A method that is ready for one column.
struct ReadyCaustic {
  std::function<CloudEstimate(const CausticPixel&)> light;  // standard errors of paths; otherwise 0
  std::size_t bytes = 0;
  double map_s = 0.0;
  bool has_noise = false;  // whether it has standard errors
};

struct CausticMethod {
  std::string key;  // in names of files; empty: no picture
  std::string series, parameter;
  MethodOrigin origin;
  std::function<ReadyCaustic(std::size_t kind)> ready;
};

/// Photons of all kinds of light, followed once.
class FollowedPhotons {
 public:
  explicit FollowedPhotons(const ReportEffort& effort) : effort_(effort) {}

  struct Beams {
    std::vector<PhotonBeam> all;
    double seconds;
  };
  const Beams& Of(int photons, double light_radius_rad) {
    auto& beams = followed_[{photons, light_radius_rad}];
    if (!beams) {
      auto [all, seconds] = Built(effort_, [&] { return BeamsOfBall(photons, light_radius_rad); });
      beams = std::make_unique<Beams>(Beams{std::move(all), seconds});
    }
    return *beams;
  }
  [[nodiscard]] const ReportEffort& effort() const { return effort_; }

 private:
  ReportEffort effort_;
  std::map<std::pair<int, double>, std::unique_ptr<Beams>> followed_;
};

template <typename Map>
ReadyCaustic ReadyMap(FollowedPhotons& photons, int count, double radius_pixels, std::size_t kind) {
  const auto& [fog, light_radius_rad] = kCausticKindOf[kind];
  const FollowedPhotons::Beams& beams = photons.Of(count, light_radius_rad);
  const auto [map, seconds] = Built(photons.effort(), [&, &fog = fog] {
    return std::make_shared<const Map>(beams.all, FogOf(fog),
                                       radius_pixels * CausticView::kPixel_m);
  });
  return {[map = map](const CausticPixel& pixel) {
            const CausticRay ray = pixel.Ray();
            return CloudEstimate{map->Radiance(ray.eye, ray.direction, ray.length_m)[0], 0.0};
          },
          map->bytes(), beams.seconds + seconds};
}

ReadyCaustic ReadyGlassPaths(std::size_t paths, std::size_t kind) {
  return {[paths, of = kCausticKindOf[kind]](const CausticPixel& pixel) {
            const CausticRay ray = pixel.Ray();
            return LightOfGlassPaths(of.fog, of.light_radius_rad, ray, paths,
                                     SeedOf({ray.eye, ray.direction}));
          },
          0, 0.0, true};
}

/// Returns "1e5" for powers of ten.
std::string PowerText(int count) {
  const double exponent = std::round(std::log10(count));
  return std::pow(10.0, exponent) == count ? fmt::format("1e{:.0f}", exponent)
                                           : fmt::format("{}", count);
}

/// Adds a method for every number of photons and every radius.
/// @param words  of the methods; numbers are added to its texts.
template <typename Map>
void AddMaps(std::vector<CausticMethod>& methods, FollowedPhotons& photons,
             const CausticMethod& words, const CausticMapSizes& sizes) {
  for (const int count : sizes.photons) {
    for (const double radius : sizes.radii_pixels) {
      CausticMethod method = words;
      method.key =
          radius == sizes.pictured_pixels ? fmt::format("{}{}", words.key, PowerText(count)) : "";
      method.series = fmt::format("{}, {} photons", words.series, PowerText(count));
      method.parameter = fmt::format("radius {}", radius);
      method.ready = [&photons, count, radius](std::size_t kind) {
        return ReadyMap<Map>(photons, count, radius, kind);
      };
      methods.push_back(std::move(method));
    }
  }
}

/// Returns the methods, in the order of the tables. They refer to the photons.
std::vector<CausticMethod> CausticMethodsOf(const CausticStudySize& size,
                                            FollowedPhotons& photons) {
  std::vector<CausticMethod> methods;
  AddMaps<BeamMap>(methods, photons, {"beams", "beams", "", MethodOrigin::kOurs, nullptr},
                   size.beams);
  AddMaps<PointMap>(
      methods, photons,
      {"points", "points (Jarosz et al. 2008)", "", MethodOrigin::kLiterature, nullptr},
      size.points);
  for (const std::size_t paths : size.paths) {
    methods.push_back({"", "paths from the eye: find wide light only",
                       fmt::format("{} paths", paths), MethodOrigin::kLiterature,
                       [paths](std::size_t kind) { return ReadyGlassPaths(paths, kind); }});
  }
  return methods;
}

/// Returns the table of a column, without lines.
ReportTable EmptyCausticTable(const ReportRegime& kind) {
  return {.key = kind.key,
          .title = fmt::format("Caustics, {}: errors of the picture", kind.name),
          .columns = {{"memory", ReportUnit::kBytes},
                      {"photons and map", ReportUnit::kSeconds},
                      {"time of a ray", ReportUnit::kSeconds},
                      {"median", ReportUnit::kError},
                      {"rms", ReportUnit::kError},
                      {"focus", ReportUnit::kError},
                      {"bias", ReportUnit::kBias},
                      {"standard error", ReportUnit::kError}},
          .lines = {}};
}

/// Measures a method under one light. Returns its numbers, in the order of the columns.
std::vector<std::optional<double>> MeasureCausticIn(CausticStudy& study, std::size_t r,
                                                    const ReadyCaustic& ready,
                                                    RegimeResult& result) {
  const std::vector<CausticPixel>& cases = study.cases(r);
  std::vector<double> made(cases.size()), truth(cases.size()), deviations(cases.size());
  ForEachCase(cases.size(), [&](std::size_t i) {
    const CloudEstimate light = ready.light(cases[i]);
    truth[i] = study.references(r)[i].value[0];
    made[i] = light.value;
    deviations[i] = light.standard_error / truth[i];
  });
  std::vector<std::vector<double>> answers;
  for (const double light : made) answers.push_back({light});
  study.Judge(r, answers, result);
  const std::size_t step = study.effort().time_every;
  const auto pass = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < cases.size(); i += step) sum += ready.light(cases[i]).value;
    return static_cast<float>(sum);
  };
  TimePasses((cases.size() + step - 1) / step, study.effort(), pass, result);
  ThrowIfInterrupted();
  const CausticErrors errors = CausticErrorsOf(made, truth);
  return {static_cast<double>(ready.bytes),
          ready.map_s,
          result.time_s,
          errors.median,
          errors.rms,
          errors.focus,
          errors.bias,
          ready.has_noise ? std::optional(RmsOf(deviations)) : std::nullopt};
}

/// The view in one light, by the reference and by methods.
class CausticPictures {
 public:
  explicit CausticPictures(const CausticStudySize& size)
      : pixels_(CausticPixelsOf(size.picture_stride)), pictures_(Solved(size)) {}

  void Add(const CausticMethod& method, const std::string& name, const ReadyCaustic& ready) {
    std::vector<double> found(pixels_.size());
    ForEachCase(pixels_.size(), [&](std::size_t i) { found[i] = ready.light(pixels_[i]).value; });
    pictures_.Add(method.key, name, found);
  }

  [[nodiscard]] std::vector<ReportPicture> Finished() && { return std::move(pictures_).Finished(); }

 private:
  [[nodiscard]] ErrorPictures Solved(const CausticStudySize& size) const {
    const ConesReference reference(kCausticKindOf[kCausticPictureKind], size);
    std::vector<CloudEstimate> solved = SolvedPixels(reference, pixels_);
    const auto columns =
        std::count_if(pixels_.begin(), pixels_.end(),
                      [&](const CausticPixel& one) { return one.row == pixels_.front().row; });
    const CloudRaster raster{static_cast<int>(columns),
                             static_cast<int>(pixels_.size()) / static_cast<int>(columns)};
    // The focus is many times brighter than the rest, which is to be seen.
    const double white = 0.2 * BrightestOf(solved);
    return {raster,
            std::move(solved),
            {"cones", fmt::format("Quadrature over cones: {} rays a pixel", size.side * size.side)},
            white};
  }

  std::vector<CausticPixel> pixels_;
  ErrorPictures pictures_;
};

void AddCausticMethod(CausticStudy& study, const CausticMethod& method, CausticPictures& pictures) {
  ReportRow row{.series = method.series,
                .parameter = method.parameter,
                .origin = method.origin,
                .in_summary = true};
  row.at.resize(study.regimes());
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    const ReadyCaustic ready = method.ready(r);
    row.memory_bytes = std::max<std::uint64_t>(row.memory_bytes, ready.bytes);
    row.build_s = std::max(row.build_s, ready.map_s);
    study.topic().tables[r].lines.push_back(
        {row.Name(), row.origin, MeasureCausticIn(study, r, ready, row.at[r])});
    if (r == kCausticPictureKind && !method.key.empty()) pictures.Add(method, row.Name(), ready);
  }
  study.AddMeasured(std::move(row));
}

ReportTopic WordsOfCaustics(const CausticStudySize& size) {
  ReportTopic topic{
      .key = "caustics",
      .title = "Caustics: light of a glass sphere in fog",
      .what = fmt::format(
          "A sphere of glass (radius 1 m, index 1.5) in fog of 0.05 per metre sends light into the "
          "fog behind it. The methods compute the light of the fog, scattered once, in pixels of "
          "0.05 m, every {} of them along both axes, with one ray through the middle of a pixel. "
          "Pixels with less than 2 % of the largest light do not count. The light is parallel, or "
          "a "
          "disk of 10° radius.",
          size.stride),
      .error_unit = "fractions of the pixel's light",
      .notes =
          "Beams and points follow the same photons. The radius [pixels] is that of a beam, or "
          "that "
          "within which a ray finds points (Jarosz, Zwicker and Jensen 2008). Wide radii blur the "
          "focus, "
          "whatever the number of photons; narrow ones leave noise. Paths from the eye are "
          "scattered "
          "in the fog and pass the sphere; they find the light only if they leave towards its "
          "disk: "
          "never, if the light is parallel, so that their error is 100 %. The further tables have "
          "the median and the root mean square of errors relative to each pixel, the root of the "
          "mean square error by the mean light (\"focus\", which the brightest pixels dominate), "
          "the "
          "bias of the mean light, and the standard error of paths. build and \"photons and map\" "
          "are the time of all threads together.",
      .wanted = 0.05,
      .answer = "ray",
      .everywhere = "in every fog and light",
      .scene = "glass sphere in fog",
      .regimes = {kCaustics.begin(), kCaustics.end()}};
  topic.medium.name.clear();  // there is no air
  topic.medium.wavelengths_nm = {550.0};
  topic.reference.text = fmt::format(
      "quadrature over cones, mean of {} rays a pixel, each with {} rings; with {} rings for each "
      "of "
      "{} points of the wide light",
      size.side * size.side, size.rings, size.wide_rings, size.wide_points);
  return topic;
}

}  // namespace

ReportTopic MeasureCaustics(const ReportEffort& effort) {
  const CausticStudySize size = CausticSizeOf(effort.quick);
  ReportEffort fewer = effort;
  fewer.passes = std::min<std::size_t>(effort.passes, 2);
  fewer.time_every = 8;
  CausticStudy study(WordsOfCaustics(size), fewer);
  SolveCaustics(study, size);
  for (const ReportRegime& kind : kCaustics)
    study.topic().tables.push_back(EmptyCausticTable(kind));
  CausticPictures pictures(size);
  FollowedPhotons photons(fewer);
  for (const CausticMethod& method : CausticMethodsOf(size, photons))
    AddCausticMethod(study, method, pictures);
  study.topic().pictures = std::move(pictures).Finished();
  return std::move(study).Finished();
}

}  // namespace alpenglow::renderer
