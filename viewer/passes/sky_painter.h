// SPDX-License-Identifier: MIT
// Drawing of sky and land on the GPU. The renderer's quantities are computed on worker threads as
// tables, maps and vertex lighting, and the GPU interpolates them.
//
// The passes of a frame: the visible land (Landscape), the light that shadows remove along rays
// (ShaftPass), the glow of lamps (LampPainter), the linear picture in the light of sun, moon and
// night sky (PicturePrograms), disks that are too small for the rays (SmallDiskPainter), then the
// lamps and stars (StarPainter). ToneMapPass displays the result. Its difference from SceneRenderer
// is reported in tests/bench/README.md, and for one view by `skyview --explain`.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "lut/image/image.h"
#include "renderer/scene/scene.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/gl/render_target.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/land/land_pass.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/frame.h"
#include "viewer/passes/frame_sky.h"
#include "viewer/passes/night_sky_map.h"
#include "viewer/passes/painted_scene.h"
#include "viewer/passes/painted_view.h"
#include "viewer/passes/picture_programs.h"
#include "viewer/passes/refracted_disk.h"
#include "viewer/passes/small_disk_painter.h"
#include "viewer/passes/star_painter.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

class SkyPainter {
 public:
  /// An OpenGL context must be current, now and in all calls. Throws as PaintedScene and SceneLamps
  /// do.
  SkyPainter(const Scene& scene, const LandSource& land, const PaintedView& first,
             const PaintSizes& sizes, FirstAir first_air = {});

  void Use(const PaintSizes& sizes) { scene_.Use(sizes); }
  /// Changes the medium. The new one is shown when it is solved.
  void Replace(const Medium& medium) { scene_.Replace(medium); }

  /// See PaintedScene.
  void AwaitLand() { scene_.AwaitLand(); }
  [[nodiscard]] bool AwaitsLand() const { return scene_.AwaitsLand(); }
  /// Changes the land to other land of the same kind.
  void Replace(const LandSource& land) { scene_.Replace(land); }
  /// Changes the clouds. The new ones fade in when they are made.
  void Replace(const std::vector<SceneCloud>& clouds) { scene_.Replace(clouds); }

  /// Sets a lamp that moves with the eye; empty: none.
  void SetLandingLight(const std::optional<LandingLight>& light) { lamps_.SetLandingLight(light); }

  /// Collects finished work and requests missing parts. It waits only where PaintedScene::Update
  /// does, and for the first map of the night sky.
  /// @param seconds  time since the last call.
  void Update(const PaintedView& view, double seconds);
  /// Waits until everything that the view needs is complete.
  /// @param samples  number of rays per pixel to be drawn.
  void WaitUntilReady(const PaintedView& view, int samples = 1);

  /// Selects the celestial bodies in a picture: the disks of sun and moon, and stars.
  enum class Bodies { kAll, kStars, kNone };
  /// Draws the linear picture of the view of the last Update or WaitUntilReady.
  /// @param samples       rays per pixel, spread over the pixel.
  /// @param after_sample  called after each ray with the number of rays so far; may be empty.
  void Paint(const PaintedView& view, int samples = 1, Bodies bodies = Bodies::kAll,
             const std::function<void(int)>& after_sample = {});
  /// Shows another picture of the view instead: linear, of any size.
  void Show(const HdrImage& image);

  /// The linear picture. Its fourth component is the inverse depth of land
  /// (shaders/gbuffer/inverse_depth.glsl) if one ray per pixel was drawn.
  [[nodiscard]] const RenderTarget& picture() const { return *picture_; }
  /// Draws the depth of the land in that picture.
  void PaintOutline(const DepthPrepass& outline);
  /// Returns the pixels that celestial bodies may cover in a picture of any size of the view that
  /// was drawn last.
  [[nodiscard]] std::vector<PixelBox> BodiesSeen(const PaintedView& view);
  /// Adds the celestial bodies to such a picture with one ray per pixel, where an outline of its
  /// size has no land, and the light of disks with a radius of less than 2.5 pixels.
  void PaintBodiesOver(const RenderTarget& target, const DepthPrepass& outline,
                       const PaintedView& view);
  /// Sets the timer that receives the times of the passes; null: none.
  void SetTimer(PassTimer* timer) { timer_ = timer; }

  [[nodiscard]] const Landscape& land() const { return scene_.land(); }
  [[nodiscard]] Landscape& land() { return scene_.land(); }
  [[nodiscard]] const PaintedScene& scene() const { return scene_; }
  /// Returns the sky of an eye in the current medium. All calls of a frame return the same object.
  [[nodiscard]] const std::shared_ptr<const FrameSky>& SkyAt(const Place& eye, const UtcTime& now) {
    return sky_.At(eye, now, scene_.air().air());
  }

 private:
  /// True positions of disks that refraction changes, with that refraction. Null: a disk is drawn
  /// at its apparent position.
  struct DisksInAir {
    SunInSky sun;
    MoonDisk moon;
    const RefractedDisk *refracted_sun, *refracted_moon;
  };
  [[nodiscard]] Frame FrameOf(const PaintedView& view);
  void PrepareLamps(const Frame& frame);
  [[nodiscard]] DisksInAir InAir(const Frame& frame);
  void DescribeDisks(const DisksInAir& seen, const glm::dvec2& shares);
  [[nodiscard]] PictureStage StageOfDisks() const;
  [[nodiscard]] int RowsUnderHorizon(const Frame& frame) const;
  void PaintSample(const Frame& frame, Bodies bodies, const PixelRay& ray);
  [[nodiscard]] static LandLook LookOfLand(const Frame& frame);
  void PaintLand(const Frame& frame);
  /// Returns whether terrain shadows the air from the key light, and that effect is drawn.
  [[nodiscard]] bool HasShade(const Frame& frame) const;
  void PaintShafts(const Frame& frame);
  void PaintClouds(const Frame& frame);
  void PaintLamps(const Frame& frame);
  [[nodiscard]] LightsOfView LightsOf(const Frame& frame);
  void BindLights(const Frame& frame, const PixelRay& ray);
  void BindMaps(const Frame& frame);
  [[nodiscard]] GroundReach ReachOf(const PaintedView& view) const;
  [[nodiscard]] PictureStage StageOf(const Frame& frame);
  void PaintPicture(const Frame& frame, double share);
  void MakeOneReady(const Frame& frame, const PictureStage& stage);
  void PaintSky(const Frame& frame, const PictureStage& stage);
  [[nodiscard]] bool HasLamps() const { return !scene_.AwaitsLand() && !lamp_painter_.IsDark(); }
  [[nodiscard]] int RowsOfGround(const Frame& frame) const;
  void UploadDisks(const Frame& frame, const DisksInAir& seen, const PixelRay& ray);
  void PaintDisks(const Frame& frame, const PixelRay& ray);
  void PaintAlone(const SkyDisk& disk, double drawn_rad, const Frame& alone);
  void PaintSmallDisks(const Frame& frame, const RenderTarget& target);
  void PaintLampsOver(const Frame& frame);
  [[nodiscard]] bool HasNightSkyMap() const;
  void PaintStars(const Frame& frame);
  void Begin(const char* pass) const {
    if (timer_ != nullptr) timer_->Begin(pass);
  }

  PaintedScene scene_;
  SceneLamps lamps_;
  LampPainter lamp_painter_;
  ShaftPass shaft_pass_;
  CloudPass cloud_pass_;
  SmallDiskPainter small_disk_painter_;
  StarPainter stars_;
  NightSkyMapFollower night_sky_map_;
  bool has_towns_;
  PicturePrograms programs_;  // uses all members above
  PictureBlocks blocks_;
  RefractedDiskFollower refracted_sun_, refracted_moon_;
  std::optional<GBuffer> surface_;
  std::optional<RenderTarget> picture_;
  FrameSkyFollower sky_;
  std::optional<Frame> painted_;  // by the last Paint
  bool continues_ = false;        // the next picture continues those of earlier updates
  PassTimer* timer_ = nullptr;
};

}  // namespace alpenglow::viewer
