// SPDX-License-Identifier: MIT
#include "renderer/report/report_clouds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_sun_map.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/report/cloud_views.h"
#include "renderer/report/error_pictures.h"
#include "renderer/report/reference_methods.h"
#include "renderer/report/traced_light.h"

namespace alpenglow::renderer {
namespace {

constexpr std::array<ReportRegime, 2> kCloudSuns{
    {{"35", "Sun at 35°", SunRange{35.0, 35.0}}, {"12", "Sun at 12°", SunRange{12.0, 12.0}}}};
constexpr double kCloudSunAzimuth_deg = 20.0, kCloudG = 0.85;
constexpr std::size_t kReferenceBatches = 16;
// The view of the pictures, from an aeroplane over the tops, and its sun.
constexpr std::size_t kPictureView = 3, kPictureSun = 0;

/// Sizes of the topic.
struct CloudStudySize {
  double period_m;
  CloudRaster raster;           // of each view
  std::size_t paths_per_batch;  // of the reference
  CloudRaster picture;
  std::size_t picture_paths;  // per batch
};
CloudStudySize CloudSizeOf(bool quick) {
  if (quick) return {kPeriodStep_m, {8, 5}, 32, {32, 18}, 8};
  return {2.0 * kPeriodStep_m, {12, 7}, 125, {80, 45}, 31};
}

/// A field under one sun.
struct CloudUnderSun {
  const CloudField* field;
  CloudScatterers scatterers;
  CloudSurroundings surroundings;
};

/// A method that is ready for one sun.
struct ReadyCloudMethod {
  std::function<CloudRayLight(const CloudRay&)> light;
  std::size_t bytes = 0;
};

ReadyCloudMethod ReadyOctaves(const CloudUnderSun& under, int count) {
  const auto map = std::make_shared<const CloudSunMap>(*under.field, under.surroundings.to_sun);
  return {[field = under.field, map, count](const CloudRay& ray) {
            const OctaveLight found = OctaveSunlight(*field, *map, kCloudG, ray, {.count = count});
            return CloudRayLight{.sun = found.sun,
                                 .transmittance = found.transmittance,
                                 .scaled_transmittance = found.transmittance};
          },
          map->bytes()};
}

ReadyCloudMethod ReadyMoments(const CloudUnderSun& under, const CloudLightOptions& options) {
  const CloudLight light(*under.field, under.scatterers, under.surroundings, options);
  return {[light](const CloudRay& ray) { return light.Radiance(ray); }, light.bytes()};
}

CloudPathTracer TracerUnder(const CloudUnderSun& under) {
  return {*under.field, under.scatterers, under.surroundings};
}

/// Returns a method of `paths` paths for each ray. Sky and ground behind clouds are part of its light.
ReadyCloudMethod ReadyPaths(const CloudPathTracer& tracer, std::size_t paths) {
  return {[tracer, paths](const CloudRay& ray) {
            const CloudRadiance light = TracedLight(tracer, ray, SeedOf(ray), 1, paths);
            return CloudRayLight{.sun = light.sun.value,
                                 .sky = light.sky.value,
                                 .ground = light.ground.value,
                                 .scaled_transmittance = 0.0};
          },
          0};
}

struct CloudMethod {
  const char* key;  // in names of files
  const char* series;
  const char* parameter;
  MethodOrigin origin;
  ReadyCloudMethod (*ready)(const CloudUnderSun& under);

  [[nodiscard]] std::string Name() const {
    return ReportRow{.series = series, .parameter = parameter}.Name();
  }
};

/// The methods, in the order of the tables. A new line is a new method.
constexpr std::array<CloudMethod, 8> kCloudMethods{
    {{"single", "single scattering", "", MethodOrigin::kLiterature,
      [](const CloudUnderSun& under) { return ReadyOctaves(under, 1); }},
     {"octaves", "octaves (Wrenninge et al. 2013)", "8", MethodOrigin::kLiterature,
      [](const CloudUnderSun& under) { return ReadyOctaves(under, 8); }},
     {"moments", "moments on cells", "without factor", MethodOrigin::kOurs,
      [](const CloudUnderSun& under) { return ReadyMoments(under, {.factor = {.rays = 0}}); }},
     {"fitted", "moments on cells", "fitted factor", MethodOrigin::kOurs,
      [](const CloudUnderSun& under) { return ReadyMoments(under, {}); }},
     {"hybrid", "paths that end in moments", "2 collisions, 64 paths", MethodOrigin::kOurs,
      [](const CloudUnderSun& under) {
        return ReadyMoments(under, {.method = CloudLightMethod::kHybrid});
      }},
     {"similarity", "paths by similarity", "8 collisions, 251 paths", MethodOrigin::kOurs,
      [](const CloudUnderSun& under) {
        return ReadyPaths(TracerUnder(under).WithSimilarity(8), 251);
      }},
     {"paths16", "path tracing", "16 paths", MethodOrigin::kOurs,
      [](const CloudUnderSun& under) { return ReadyPaths(TracerUnder(under), 16); }},
     {"paths251", "path tracing", "251 paths", MethodOrigin::kOurs,
      [](const CloudUnderSun& under) { return ReadyPaths(TracerUnder(under), 251); }}}};

/// A pixel with its light by the reference.
struct CloudCase {
  CloudPixel pixel;
  CloudRadiance traced;
};
using CloudStudy = ErrorStudy<CloudCase>;

CloudOptions StudiedCumulus(double period_m) {
  CloudOptions options = DefaultCloudOptions(CloudGenus::kCumulus);
  options.period_m = period_m;
  return options;
}

/// The field, its suns and its views.
struct CloudScene {
  explicit CloudScene(const CloudStudySize& size)
      : field(MakeCloudField(StudiedCumulus(size.period_m))),
        views(CloudViewsOf(field, kCloudSunAzimuth_deg)) {
    for (const ReportRegime& sun : kCloudSuns) {
      suns.push_back({&field,
                      {CloudPhases({.kind = PhaseKind::kHenyeyGreenstein, .g = kCloudG})},
                      {TowardsAzimuth(kCloudSunAzimuth_deg, sun.sun->lowest_deg)}});
    }
  }
  CloudScene(const CloudScene&) = delete;
  CloudScene& operator=(const CloudScene&) = delete;

  CloudField field;
  std::vector<CloudView> views;
  std::vector<CloudUnderSun> suns;  // refer to the field
};

/// Returns the means over the pixels of each view.
template <typename Value>
std::vector<double> MeansByView(const std::vector<CloudCase>& cases, std::size_t views,
                                const Value& value) {
  std::vector<double> sum(views, 0.0), count(views, 0.0);
  for (const CloudCase& one : cases) {
    sum[one.pixel.view] += value(one.traced);
    count[one.pixel.view] += 1.0;
  }
  for (std::size_t view = 0; view < views; ++view) sum[view] /= std::max(count[view], 1.0);
  return sum;
}

double SunOf(const CloudRadiance& light) { return light.sun.value; }
double WholeOf(const CloudRadiance& light) { return WholeCloudLight(light).value; }

/// Solves the sunlight of all pixels. Errors are relative to it, at least to a part of the mean of
/// the view.
void SolveCloudPixels(CloudStudy& study, const CloudScene& scene, const CloudStudySize& size) {
  const std::vector<CloudPixel> pixels = CloudPixelsOf(scene.field, scene.views, size.raster);
  std::vector<CloudPathTracer> tracers;
  for (std::size_t sun = 0; sun < scene.suns.size(); ++sun)
    tracers.push_back(TracerUnder(scene.suns[sun]));
  study.SolveCases(pixels.size(), [&](std::size_t r, std::size_t i) {
    const CloudRadiance traced =
        TracedLight(tracers[r], pixels[i].ray, i + 1, kReferenceBatches, size.paths_per_batch);
    return std::optional(CloudStudy::Solved{{pixels[i], traced},
                                            {{traced.sun.value}, {traced.sun.standard_error}, {}}});
  });
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    const std::vector<double> mean = MeansByView(study.cases(r), scene.views.size(), SunOf);
    for (std::size_t i = 0; i < study.cases(r).size(); ++i) {
      const CloudCase& one = study.cases(r)[i];
      study.references(r)[i].scale = {
          std::max(one.traced.sun.value, kDarkestCloud * mean[one.pixel.view])};
    }
    study.topic().reference.noise[r] = NoiseOf(study.references(r));
  }
}

/// Returns the table of a sun, without lines.
ReportTable EmptyCloudTable(const ReportRegime& sun, const std::vector<CloudView>& views) {
  ReportTable table{.key = fmt::format("sun{}", sun.key),
                    .title = fmt::format("Clouds, {}: bias, and the whole light", sun.name),
                    .columns = {{"memory", ReportUnit::kBytes},
                                {"solve", ReportUnit::kSeconds},
                                {"time of a ray", ReportUnit::kSeconds},
                                {"sun: rms", ReportUnit::kError},
                                {"sun: bias", ReportUnit::kBias},
                                {"whole: rms", ReportUnit::kError},
                                {"whole: bias", ReportUnit::kBias}},
                    .lines = {}};
  for (const CloudView& view : views)
    table.columns.push_back({fmt::format("sun: bias, {}", view.name), ReportUnit::kBias});
  return table;
}

/// The cost of a method under one sun, and its light in all pixels.
struct CloudMeasured {
  double bytes = 0.0, solve_s = 0.0;
  std::vector<CloudRayLight> light;
};

/// Returns the numbers of a method under one sun, in the order of the columns.
std::vector<std::optional<double>> CloudNumbers(const std::vector<CloudCase>& cases,
                                                std::size_t views, const CloudMeasured& measured,
                                                double time_s) {
  const std::vector<double> sun_mean = MeansByView(cases, views, SunOf);
  const std::vector<double> whole_mean = MeansByView(cases, views, WholeOf);
  CloudErrors sun, whole;
  std::vector<CloudErrors> of_view(views);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::size_t view = cases[i].pixel.view;
    const CloudEstimate& truth = cases[i].traced.sun;
    sun.Add(measured.light[i].sun, truth, sun_mean[view]);
    of_view[view].Add(measured.light[i].sun, truth, sun_mean[view]);
    whole.Add(WholeCloudLight(measured.light[i], cases[i].pixel.ray),
              WholeCloudLight(cases[i].traced), whole_mean[view]);
  }
  std::vector<std::optional<double>> numbers{
      measured.bytes, measured.solve_s, time_s, sun.Rms(), sun.Bias(), whole.Rms(), whole.Bias()};
  for (const CloudErrors& errors : of_view)
    numbers.push_back(errors.count() > 0 ? std::optional(errors.Bias()) : std::nullopt);
  return numbers;
}

/// One view of the field in whole light, by the reference and by every method.
class CloudPictures {
 public:
  CloudPictures(const CloudScene& scene, const CloudStudySize& size)
      : rays_(RaysOf(scene, size.picture)), pictures_(Traced(scene, size)) {}

  void Add(const CloudMethod& method, const ReadyCloudMethod& ready) {
    std::vector<double> found(rays_.size());
    ForEachCase(rays_.size(), [&](std::size_t i) {
      found[i] = WholeCloudLight(ready.light(rays_[i]), rays_[i]);
    });
    pictures_.Add(method.key, method.Name(), found);
  }

  [[nodiscard]] std::vector<ReportPicture> Finished() && { return std::move(pictures_).Finished(); }

 private:
  [[nodiscard]] static std::vector<CloudRay> RaysOf(const CloudScene& scene,
                                                    const CloudRaster& raster) {
    std::vector<CloudRay> rays;
    for (int i = 0; i < raster.columns * raster.lines; ++i)
      rays.push_back(scene.views[kPictureView].Ray(i, raster));
    return rays;
  }
  [[nodiscard]] ErrorPictures Traced(const CloudScene& scene, const CloudStudySize& size) const {
    const CloudPathTracer tracer = TracerUnder(scene.suns[kPictureSun]);
    std::vector<CloudEstimate> traced(rays_.size());
    ForEachCase(rays_.size(), [&](std::size_t i) {
      traced[i] = WholeCloudLight(
          TracedLight(tracer, rays_[i], i + 1, kReferenceBatches, size.picture_paths));
    });
    const double white = BrightestOf(traced);
    return {
        size.picture,
        std::move(traced),
        {"traced", fmt::format("Traced paths: {} a pixel", kReferenceBatches * size.picture_paths)},
        white};
  }

  std::vector<CloudRay> rays_;
  ErrorPictures pictures_;
};

void AddCloudMethod(CloudStudy& study, const CloudScene& scene, const CloudMethod& method,
                    CloudPictures& pictures) {
  std::vector<CloudMeasured> measured(study.regimes());
  const auto prepare = [&](std::size_t r, ReportRow& row) {
    auto [ready, seconds] = Built(study.effort(), [&] { return method.ready(scene.suns[r]); });
    measured[r].bytes = static_cast<double>(ready.bytes);
    measured[r].solve_s = ready.bytes > 0 ? seconds : 0.0;
    row.memory_bytes = std::max<std::uint64_t>(row.memory_bytes, ready.bytes);
    row.build_s = std::max(row.build_s, measured[r].solve_s);
    const std::vector<CloudCase>& cases = study.cases(r);
    measured[r].light.resize(cases.size());
    ForEachCase(cases.size(),
                [&](std::size_t i) { measured[r].light[i] = ready.light(cases[i].pixel.ray); });
    if (r == kPictureSun) pictures.Add(method, ready);
    return [light = ready.light](const CloudCase& one) { return light(one.pixel.ray).sun; };
  };
  study.AddPrepared({.series = method.series,
                     .parameter = method.parameter,
                     .origin = method.origin,
                     .in_summary = true},
                    prepare);
  for (std::size_t r = 0; r < study.regimes(); ++r) {
    study.topic().tables[r].lines.push_back(
        {method.Name(), method.origin,
         CloudNumbers(study.cases(r), scene.views.size(), measured[r],
                      study.topic().rows.back().at[r].time_s)});
  }
}

ReportTopic WordsOfClouds(const CloudStudySize& size) {
  ReportTopic topic{
      .key = "clouds",
      .title = "Clouds: light of all orders in cumulus",
      .what =
          "Cumulus of cover 0.3 over black ground, in six views: from the ground towards the sun "
          "and away from it, to the zenith, from an aeroplane over the tops, from above, and level "
          "between clouds. The methods compute the radiance of sunlight along rays that clouds dim "
          "by a tenth or more. Droplets absorb nothing and scatter by Henyey and Greenstein "
          "(g = 0.85).",
      .error_unit =
          "fractions of the radiance; a radiance below a twentieth of the mean of its view counts "
          "as if it were that bright",
      .notes =
          "Single scattering and octaves take their optical depths to the sun from this library's "
          "map. Octaves are those of Wrenninge, Kulla and Lundqvist (2013) with a = b = c = 0.5, "
          "as "
          "engines of games use them. Both have sunlight alone; the whole light of the further "
          "tables, sun + 0.036 sky + 0.012 ground, lacks that of sky and ground in clouds. The "
          "factor of \"moments on cells\" is fitted to traced paths of the same field. "
          "Errors "
          "of path tracing are its noise; its bias is within its noise, too. build and solve are "
          "the time of all threads together.",
      .wanted = 0.1,
      .answer = "ray",
      .everywhere = "under both suns",
      .scene = fmt::format("cumulus {:.2f} km", 1e-3 * size.period_m),
      .regimes = {kCloudSuns.begin(), kCloudSuns.end()}};
  topic.medium.name.clear();  // there is no air
  topic.medium.wavelengths_nm = {550.0};
  return topic;
}

}  // namespace

ReportTopic MeasureClouds(const ReportEffort& effort) {
  const CloudStudySize size = CloudSizeOf(effort.quick);
  const CloudScene scene(size);
  ReportEffort fewer = effort;
  fewer.passes = std::min<std::size_t>(effort.passes, 3);
  fewer.time_every = 4;
  CloudStudy study(WordsOfClouds(size), fewer);
  study.topic().reference.text =
      fmt::format("{} traced paths per ray", kReferenceBatches * size.paths_per_batch);
  SolveCloudPixels(study, scene, size);
  for (const ReportRegime& sun : kCloudSuns)
    study.topic().tables.push_back(EmptyCloudTable(sun, scene.views));
  CloudPictures pictures(scene, size);
  for (const CloudMethod& method : kCloudMethods) AddCloudMethod(study, scene, method, pictures);
  study.topic().pictures = std::move(pictures).Finished();
  return std::move(study).Finished();
}

}  // namespace alpenglow::renderer
