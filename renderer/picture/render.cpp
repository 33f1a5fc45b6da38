// SPDX-License-Identifier: MIT
// Renders pictures, row by row or tile by tile, with the effects that a scene needs: runs the
// preview of effect_choice.h with the scene's own pixels.
#include "renderer/picture/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "lut/api/conversions.h"
#include "lut/cli/program.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/path_tracing/traceable_scene.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/pixel_light.h"
#include "renderer/picture/pixel_shader.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/picture/unoccluded_sky_pixels.h"

namespace alpenglow::renderer {
namespace {

/// A square of pixels within a picture, processed by one thread.
struct Tile {
  static constexpr int kSide = 64;
  int x0, y0, x1, y1;

  [[nodiscard]] bool Has(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>((y - y0) * (x1 - x0) + x - x0);
  }
  [[nodiscard]] std::size_t Size() const { return Index(x0, y1); }

  /// Calls visit(x, y) row by row.
  template <typename See>
  void Visit(const See& visit) const {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) visit(x, y);
    }
  }
  /// Calls visit(index) for each of up to eight neighbours.
  template <typename See>
  void VisitNeighbours(int x, int y, const See& visit) const {
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if ((u != x || v != y) && Has(u, v)) visit(Index(u, v));
      }
    }
  }
};

/// Returns the mean of the relative variances of a pixel's neighbours; its own if it has no
/// neighbours.
double VarianceAround(const std::vector<double>& variances, const Tile& tile, int x, int y) {
  double sum = 0.0;
  int neighbours = 0;
  tile.VisitNeighbours(x, y, [&](std::size_t at) {
    sum += variances[at];
    ++neighbours;
  });
  return neighbours > 0 ? sum / neighbours : variances[tile.Index(x, y)];
}

/// Returns the relative variance over the rays of all neighbours of a pixel, pooled as if they
/// belonged to one pixel.
double VarianceAmong(const std::vector<RaySpread>& spreads, const Tile& tile, int x, int y,
                     double floor) {
  RaySpread all;
  tile.VisitNeighbours(x, y, [&](std::size_t at) { all.Add(spreads[at]); });
  return all.RelativeVariance(floor);
}

/// Adds the light of stars and small disks at the pixel, which rays do not meet.
PixelSum WithStars(const FrameContext& frame, int x, int y, PixelSum rays) {
  const auto add = [&](const auto& lights) {
    const Spectrum* light = lights ? lights->At(x, y) : nullptr;
    if (light != nullptr) rays.radiance = rays.radiance + static_cast<float>(rays.rays) * *light;
  };
  add(frame.sky_lights().stars);
  add(frame.sky_lights().small_sun);
  add(frame.sky_lights().small_moon);
  return rays;
}

/// Renders the pixels of a picture in parallel, row by row or, with a bound on the noise, tile by
/// tile.
/// Refers to the frame. The bytes of its pictures do not depend on the number of threads.
class TileRenderer {
 public:
  explicit TileRenderer(const FrameContext& frame) : shader_(frame), frame_(frame) {}

  /// Throws RenderingStopped when the settings request it; stops early when Interrupted().
  [[nodiscard]] CountedPicture Picture() const;
  /// Returns single pixels as an image of one row, with a fixed number of rays per pixel and
  /// without layers.
  [[nodiscard]] HdrImage Pixels(const std::vector<PixelPlace>& places) const;

 private:
  /// Adds the rows of a picture with a fixed number of rays per pixel.
  void AddRows(PixelWriter& writer) const;
  /// Adds the tiles of a picture whose pixels take as many rays as their noise requires.
  void AddTiles(PixelWriter& writer) const;
  void AddTile(double floor, int x0, int y0, const UnoccludedSkyPixels& open_sky,
               PixelWriter& writer) const;
  void Write(int x, int y, const PixelLight& pixel, PixelWriter& writer) const;
  /// Returns the luminance floor of the relative noise: darker pixels count as if they had this
  /// luminance (effect_choice.h) [cd/m^2].
  [[nodiscard]] double NoiseFloor() const;

  PixelShader shader_;
  const FrameContext& frame_;
};

HdrImage TileRenderer::Pixels(const std::vector<PixelPlace>& places) const {
  const int count = static_cast<int>(places.size());
  const int rays = frame_.settings().samples_per_pixel;
  PixelWriter writer(frame_.scene().colour(), count, 1, {});
  tbb::parallel_for(0, count, [&](int i) {
    const PixelPlace& at = places[static_cast<std::size_t>(i)];
    if (Interrupted()) return;
    PixelLight pixel(shader_, at.x, at.y, rays);
    pixel.TakeUpTo(rays);
    writer.Write(i, 0, WithStars(frame_, at.x, at.y, pixel.sum()));
  });
  ThrowIfInterrupted();
  return writer.Take();
}

CountedPicture TileRenderer::Picture() const {
  PixelWriter writer(frame_.scene().colour(), frame_.settings().width, frame_.settings().height,
                     frame_.settings().layers);
  ThrowIfInterrupted();
  if (frame_.settings().noise) {
    AddTiles(writer);
  } else {
    AddRows(writer);
  }
  ThrowIfInterrupted();
  if (frame_.settings().stop.stop_requested()) throw RenderingStopped();
  return {writer.Take(), writer.rays()};
}

void TileRenderer::AddRows(PixelWriter& writer) const {
  const int rays = frame_.settings().samples_per_pixel;
  std::atomic<int> rows{0};
  const auto row_done =
      PartDone(frame_.settings().pixels_done, static_cast<std::size_t>(frame_.settings().height));
  tbb::parallel_for(0, frame_.settings().height, [&](int y) {
    for (int x = 0; x < frame_.settings().width; ++x) {
      if (Interrupted() || frame_.settings().stop.stop_requested()) return;
      PixelLight pixel(shader_, x, y, rays);
      pixel.TakeUpTo(rays);
      Write(x, y, pixel, writer);
    }
    if (frame_.settings().progress != nullptr)
      frame_.settings().progress->Part(static_cast<double>(++rows) / frame_.settings().height);
    row_done();
  });
}

double TileRenderer::NoiseFloor() const {
  constexpr int kPixels = 400;
  return ChangeFloor(
      Pixels(PreviewGrid(frame_.settings().width, frame_.settings().height, kPixels)));
}

void TileRenderer::AddTiles(PixelWriter& writer) const {
  const RenderSettings& settings = frame_.settings();
  const int columns = (settings.width + Tile::kSide - 1) / Tile::kSide;
  const int tiles = columns * ((settings.height + Tile::kSide - 1) / Tile::kSide);
  const double floor = NoiseFloor();
  const UnoccludedSkyPixels open_sky(shader_);
  std::atomic<int> done{0};
  const auto tile_done = PartDone(settings.pixels_done, static_cast<std::size_t>(tiles));
  tbb::parallel_for(0, tiles, [&](int i) {
    const int x0 = i % columns * Tile::kSide, y0 = i / columns * Tile::kSide;
    AddTile(floor, x0, y0, open_sky, writer);
    if (settings.progress != nullptr) settings.progress->Part(static_cast<double>(++done) / tiles);
    tile_done();
  });
}

// Traces first rays of the tile and of a border of pixels around it. Border pixels belong to other
// tiles; they only provide the noise estimate and their rays.
void TileRenderer::AddTile(double floor, int x0, int y0, const UnoccludedSkyPixels& open_sky,
                           PixelWriter& writer) const {
  const RenderSettings& settings = frame_.settings();
  const int first = settings.samples_per_pixel, most = std::max(kMostRaysForNoise, first);
  const int fewest = std::min(first, kFewestRaysForNoise);
  const Tile tile{x0, y0, std::min(x0 + Tile::kSide, settings.width),
                  std::min(y0 + Tile::kSide, settings.height)};
  const Tile asked{std::max(x0 - 1, 0), std::max(y0 - 1, 0), std::min(tile.x1 + 1, settings.width),
                   std::min(tile.y1 + 1, settings.height)};
  const auto stopped = [&] { return Interrupted() || settings.stop.stop_requested(); };
  AirInterpolationGrid air(shader_, x0, y0, tile.x1, tile.y1);
  AirInterpolationGrid* const lattice =
      settings.share_air && settings.share_air_of_pixels ? &air : nullptr;
  std::vector<PixelLight> pixels;
  std::vector<RaySpread> spreads;
  std::vector<bool> is_done;
  pixels.reserve(asked.Size());
  asked.Visit([&](int x, int y) {
    if (stopped()) return;
    const double expected_m = pixels.empty() ? 0.0 : pixels.back().last_m();
    PixelLight& pixel = pixels.emplace_back(shader_, x, y, most, lattice, expected_m);
    is_done.push_back(open_sky.Has(x, y));
    if (is_done.back()) {
      pixel.TakeUnoccludedSky();
    } else {
      pixel.TakeUpTo(fewest);
    }
    spreads.push_back(pixel.spread());
  });
  if (stopped()) return;
  asked.Visit([&](int x, int y) {
    if (stopped() || is_done[asked.Index(x, y)]) return;
    const double among = VarianceAmong(spreads, asked, x, y, floor);
    if (RaysForNoise(among, *settings.noise, fewest, first) > fewest)
      pixels[asked.Index(x, y)].TakeUpTo(first);
  });
  if (stopped()) return;
  std::vector<double> variances;
  for (const PixelLight& pixel : pixels)
    variances.push_back(pixel.spread().RelativeVariance(floor));
  std::vector<int> wanted;
  asked.Visit([&](int x, int y) {
    const int begun = pixels[asked.Index(x, y)].sum().rays;
    const bool may_take_more = tile.Has(x, y) && !is_done[asked.Index(x, y)];
    wanted.push_back(may_take_more ? RaysForNoise(VarianceAround(variances, asked, x, y),
                                                  *settings.noise, begun, most)
                                   : begun);
  });
  SharedSampleFilter shared(frame_.filter(), asked.x1 - asked.x0, asked.y1 - asked.y0,
                            frame_.scene().medium().wavelengths_nm.size());
  asked.Visit(
      [&](int x, int y) { shared.Expect(x - asked.x0, y - asked.y0, wanted[asked.Index(x, y)]); });
  asked.Visit([&](int x, int y) {
    if (stopped()) return;
    PixelLight& pixel = pixels[asked.Index(x, y)];
    const auto share = [&] {
      for (const SeenRay& ray : pixel.NewRays()) shared.Add(x - asked.x0, y - asked.y0, ray);
    };
    share();
    pixel.TakeUpTo(wanted[asked.Index(x, y)]);
    share();
    if (pixel.sky()) shared.SetSky(x - asked.x0, y - asked.y0, *pixel.sky());
  });
  if (stopped()) return;
  tile.Visit([&](int x, int y) {
    PixelLight& pixel = pixels[asked.Index(x, y)];
    pixel.SetMeanRadiance(shared.Light(x - asked.x0, y - asked.y0));
    Write(x, y, pixel, writer);
  });
}

void TileRenderer::Write(int x, int y, const PixelLight& pixel, PixelWriter& writer) const {
  writer.Write(x, y, WithStars(frame_, x, y, pixel.sum()));
  if (!writer.AsksForMiddle()) return;
  writer.WriteMiddle(x, y, shader_.Trace(frame_.camera().MiddleRay(x + 0.5, y + 0.5)));
}

/// Returns the effects that can change this picture.
EffectSet Present(const FrameContext& frame) {
  const auto without = [](EffectSet effects, bool is_there, EffectSet those) {
    if (is_there) return effects;
    for (const Effect effect : those.List()) effects = effects.Without(effect);
    return effects;
  };
  EffectSet present = EffectSet::All();
  const PreparedScene& scene = frame.scene();
  const auto any_light = [&](const auto& holds) {
    return std::any_of(frame.lights().begin(), frame.lights().end(), holds);
  };
  const bool is_broken = any_light([](const FrameLight& of) { return of.shadows->IsBroken(); });
  present = without(present, is_broken, {Effect::kShafts});
  present = without(present, !scene.lamps().All().empty(), {Effect::kLights, Effect::kBeams});
  present =
      without(present, scene.ground().terrain.has_value(), {Effect::kShadows, Effect::kRelief});
  const bool is_terrain_lit =
      any_light([](const FrameLight& of) { return of.light.on_terrain != nullptr; });
  present = without(present, is_terrain_lit, {Effect::kHorizons, Effect::kBounce});
  present = without(present, scene.media().HasBodies(), {Effect::kVolumes});
  present = without(present, scene.media().HasLayers(), {Effect::kLayerGlow});
  present = without(present, !scene.scene().clouds.empty(),
                    {Effect::kClouds, Effect::kCloudShadows, Effect::kCloudGlow});
  present = without(present, frame.lights().size() > 1, {Effect::kMoonlight});
  present = without(present, frame.sky_lights().night != nullptr, {Effect::kNightSky});
  present = without(present, frame.sky_lights().stars != nullptr, {Effect::kStars});
  present = without(present, frame.bent() != nullptr, {Effect::kRefraction});
  return without(present, &scene.OnFewBands() != &scene, {Effect::kFineSpectrum});
}

/// Returns the scene with the pattern of the ground at the middle pose.
const PreparedScene& PatternedScene(const PreparedScene& scene, const CameraSample& camera_sample) {
  const auto pose = camera_sample.middle();
  return pose ? scene.WithPatternAt(pose->place) : scene;
}

}  // namespace

void ValidateSettings(const RenderSettings& settings) {
  RequireInRange(settings.width, 1, 16384, "picture width");
  RequireInRange(settings.height, 1, 16384, "picture height");
  RequireInRange(settings.samples_per_pixel, 1, PixelSamples::kMostSamples, "samples per pixel");
  if (settings.noise) {
    RequireInRange(*settings.noise, 1e-8, 1.0, "noise");
    RequireInRange(settings.samples_per_pixel, 2, PixelSamples::kMostSamples,
                   "samples per pixel, with noise,");
  }
  RequireInRange(settings.air_nodes, 2, 32, "air nodes");
  if (!settings.paths) return;
  RequireInRange(*settings.paths, 1, kMostPaths, "paths per pixel");
  if (settings.noise)
    throw InputError("paths need a fixed number of rays per pixel, without noise");
  if (std::ranges::any_of(settings.layers, IsOfPolarisation))
    throw InputError("paths have no layers of polarised light");
}

SceneRenderer::SceneRenderer(const Scene& scene, Progress* progress)
    : scene_(std::make_unique<PreparedScene>(scene, progress)) {}
SceneRenderer::SceneRenderer(const Scene& scene, std::shared_ptr<const SceneGround> ground)
    : scene_(std::make_unique<PreparedScene>(scene, std::move(ground))) {}
SceneRenderer::~SceneRenderer() = default;

const Medium& SceneRenderer::medium() const { return scene_->medium(); }
double SceneRenderer::eye_height_m() const { return scene_->ground().eye_height_m; }
double SceneRenderer::GroundHeightAt(const Place& place) const {
  return GroundHeightUnder(scene_->ground(), place);
}
const std::string& SceneRenderer::terrain_message() const { return scene_->terrain_message(); }

SunInSky SceneRenderer::ApparentSun(const CameraSample& camera_sample) const {
  return ObserverOf(*scene_, camera_sample).bodies.ApparentSun(GentleAirOf(scene_->medium()));
}

SkyBodies SceneRenderer::BodiesOver(const CameraSample& camera_sample) const {
  return ObserverOf(*scene_, camera_sample).bodies;
}

double SceneRenderer::Illuminance(const CameraSample& camera_sample) const {
  const Observer observer = ObserverOf(*scene_, camera_sample);
  return renderer::Illuminance(*scene_, observer.from_eye.origin_m(),
                               LightingAt(*scene_, observer));
}

HdrImage SceneRenderer::Render(const CameraSample& camera_sample,
                               const RenderSettings& settings) const {
  return RenderCounted(camera_sample, settings).image;
}

CountedPicture SceneRenderer::RenderCounted(const CameraSample& camera_sample,
                                            const RenderSettings& settings) const {
  ValidateSettings(settings);
  if (settings.paths) RequireTraceable(scene_->scene());
  const PreparedScene& scene = PatternedScene(*scene_, camera_sample);
  return TileRenderer({scene.For(settings.effects), camera_sample, settings}).Picture();
}

ChosenPicture SceneRenderer::RenderWithin(const CameraSample& camera_sample,
                                          const RenderSettings& settings,
                                          const EffectBudget& budget) const {
  ValidateSettings(settings);
  if (settings.paths) throw InputError("paths trace all effects, and leave no choice of effects");
  const PreparedScene& patterned = PatternedScene(*scene_, camera_sample);
  const FrameContext frame(patterned.For(settings.effects), camera_sample, settings);
  std::optional<FrameContext> on_few_bands;
  const auto with = [&](EffectSet effects) {
    const PreparedScene& scene = patterned.For(effects);
    if (&scene == &frame.scene()) return frame.Reduced(effects);
    if (!on_few_bands) on_few_bands.emplace(scene, camera_sample, settings);
    return on_few_bands->Reduced(effects);
  };
  EffectPreview preview;
  std::vector<glm::dvec3> points = frame.lamps().Directions();
  if (const MediaLight* media = frame.media()) {
    for (const glm::dvec3& place : media->PlacesThatGlow())
      if (place != frame.camera().eye())
        points.push_back(glm::normalize(place - frame.camera().eye()));
  }
  if (const auto& known = frame.sky_lights().stars) {
    const auto& stars = known->directions();
    points.insert(points.end(), stars.begin(), stars.end());
  }
  preview.groups = PreviewPixels(frame.camera(), settings.width, settings.height,
                                 frame.light().source.direction.seen, points);
  std::vector<PixelPlace> places;
  for (const auto& group : preview.groups) places.insert(places.end(), group.begin(), group.end());
  const auto timed = [&](const FrameContext& of) {
    const Stopwatch watch;
    HdrImage image = TileRenderer(of).Pixels(places);
    return PreviewPicture{std::move(image), watch.seconds()};
  };
  preview.render = [&](EffectSet effects) { return timed(with(effects)); };
  preview.pixels_of_picture = static_cast<double>(settings.width) * settings.height;
  preview.preparation_s = [&](Effect effect) { return frame.PreparationSeconds(effect); };
  Prepare(settings.progress, "choice of effects");
  preview.present = Present(frame);
  const auto refine = [&](const char* name, const auto& change) {
    preview.refinements.push_back({name, [&, change] {
                                     RenderSettings finer = frame.settings();
                                     change(finer);
                                     return timed(frame.Sampled(finer));
                                   }});
  };
  refine("16 air nodes", [](RenderSettings& finer) { finer.air_nodes = 16; });
  refine("air of each ray", [](RenderSettings& finer) { finer.share_air = false; });
  const std::unique_ptr<PreparedScene> more_bands =
      budget.explain ? frame.scene().OnOtherBands(16) : nullptr;
  if (more_bands && frame.over_ground().air.bands() < 16) {
    preview.refinements.push_back({"16 bands", [&] {
                                     return timed({*more_bands, camera_sample, settings});
                                   }});
  }
  EffectChoice choice = ChooseEffects(preview, settings.effects, budget);
  CountedPicture picture = TileRenderer(with(choice.effects)).Picture();
  return {std::move(picture.image), picture.rays, std::move(choice)};
}

}  // namespace alpenglow::renderer
