// SPDX-License-Identifier: MIT
// Pictures of sky and land on the graphics card: what the renderer computes is made beside drawing
// as tables, maps and light of vertices, and the card interpolates.
//
// The passes of a frame: what the eye sees of the land (Landscape), what shade takes from rays
// (ShaftPass), the glow of lamps (LampPainter), the linear picture, by night the sky's own light
// (NightFloorFollower), the lamps and the stars (StarPainter) over it. Developer shows it. How far it is from SceneRenderer's: tests/bench/README.md, and `skyview --explain` of a
// view.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "atmosphere/sun/moon.h"
#include "lut/picture/image.h"
#include "renderer/scene/scene.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/gl/render_target.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/land/land_pass.h"
#include "viewer/paint/auto_quality.h"
#include "viewer/paint/key_light.h"
#include "viewer/paint/night_floor.h"
#include "viewer/paint/painted_scene.h"
#include "viewer/paint/painted_view.h"
#include "viewer/paint/picture_programs.h"
#include "viewer/paint/star_painter.h"
#include "viewer/shade/shafts.h"

namespace alpenglow::viewer {

class SkyPainter {
 public:
  /// An OpenGL context must be current, now and in all calls. Throws what PaintedScene does, and
  /// what SceneLamps does.
  SkyPainter(const Scene& scene, const LandSource& land, const PaintedView& first,
             const PaintSizes& sizes, FirstAir first_air = {});

  void Use(const PaintSizes& sizes) { scene_.Use(sizes); }
  /// Other air; shown when it is solved.
  void Replace(const Medium& medium) { scene_.Replace(medium); }

  /// See PaintedScene.
  void AwaitLand() { scene_.AwaitLand(); }
  [[nodiscard]] bool AwaitsLand() const { return scene_.AwaitsLand(); }
  /// Other land of the same kind.
  void Replace(const LandSource& land) { scene_.Replace(land); }

  /// A lamp that moves with the eye; nothing: none.
  void SetLandingLight(const std::optional<LandingLight>& light) { lamps_.SetLandingLight(light); }

  /// Takes over what has become ready and asks for what is missing. Never waits.
  /// @param seconds  since the last call.
  void Update(const PaintedView& view, double seconds);
  /// Waits until all is there that the view needs.
  /// @param samples  that will be painted.
  void Settle(const PaintedView& view, int samples = 1);

  /// What a picture has of the sky's bodies: the disks of sun and moon, and stars.
  enum class Bodies { kAll, kStars, kNone };
  /// Paints the linear picture of the view that was updated or settled last.
  /// @param samples  rays a pixel, spread over it.
  /// @param after_sample  called after each of them with their number so far; empty: nothing is.
  void Paint(const PaintedView& view, int samples = 1, Bodies bodies = Bodies::kAll,
             const std::function<void(int)>& after_sample = {});
  /// Shows another picture of the view instead: linear, of any size.
  void Show(const Image& image);

  /// Its fourth component is the nearness of land (shaders/nearness.glsl), if one ray a pixel was
  /// painted.
  [[nodiscard]] const RenderTarget& picture() const { return *picture_; }
  /// Where the land of that picture stands.
  void PaintOutline(const LandOutline& outline);
  /// Pixels that the sky's bodies may reach in a picture of the view that was painted last, of any size.
  [[nodiscard]] std::vector<PixelBox> BodiesSeen(const PaintedView& view);
  /// Adds them to such a picture, of one ray a pixel, beside the land of an outline of its size.
  void PaintBodiesOver(const RenderTarget& target, const LandOutline& outline,
                       const PaintedView& view);
  /// A pass of others in the same frame.
  void Time(const char* pass) const { Begin(pass); }
  void EndTime() const {
    if (timer_ != nullptr) timer_->End();
  }
  /// Times of its passes are told to it; null: none.
  void SetTimer(PassTimer* timer) { timer_ = timer; }

  [[nodiscard]] const Landscape& land() const { return scene_.land(); }
  [[nodiscard]] Landscape& land() { return scene_.land(); }
  [[nodiscard]] const AirFollower& air() const { return scene_.air(); }
  /// Null: none.
  [[nodiscard]] const SceneFog* fog() const { return scene_.fog(); }
  [[nodiscard]] const GroundFollower& ground() const { return scene_.ground(); }
  [[nodiscard]] const ShadeFollower& shade() const { return scene_.shade(); }

 private:
  struct SkyDisks {
    SunPosition sun;
    MoonDisk moon;
  };
  /// Disks where they truly stand, and what the air does to them; null: they are drawn where they
  /// seem to be.
  struct DisksInAir {
    SkyDisks disks;
    const BentDisk *sun, *moon;
  };
  /// What shines on a view.
  struct Shining {
    PaintedView view;
    SunPosition sun;
    std::shared_ptr<const SolvedAir> air;
    LightsOfSky lights;
  };
  [[nodiscard]] const Shining& LightsOf(const PaintedView& view);
  [[nodiscard]] SkyDisks DisksOf(const PaintedView& view);
  [[nodiscard]] std::vector<PixelBox> DisksSeen(const PaintedView& view);
  void PrepareLamps(const PaintedView& view);
  [[nodiscard]] DisksInAir InAir(const SkyDisks& disks, const PaintedView& view);
  void DescribeDisks(const DisksInAir& seen);
  [[nodiscard]] int RowsUnderHorizon(const PaintedView& view) const;
  void PaintSample(const PaintedView& view, Bodies bodies, const PixelRay& ray);
  void PaintLand(const PaintedView& view);
  void PaintShafts(const PaintedView& view);
  void PaintLamps(const PaintedView& view);
  /// What a picture is painted with.
  struct Lit {
    LightSource source;
    bool has_shade, has_lamps;
  };
  void BindLight(const PaintedView& view, const KeyLight& light, const PixelRay& ray);
  void BindMaps(const PaintedView& view, const KeyLight& light);
  void PaintPicture(const PaintedView& view, double share);
  void PaintOtherLight(const PaintedView& view, const PixelRay& ray);
  void MakeOneReady(const PaintedView& view, bool has_shade, bool has_lamps);
  void PaintSky(const PaintedView& view, const Lit& lit);
  [[nodiscard]] bool HasLamps() const { return !scene_.AwaitsLand() && !lamp_painter_.IsDark(); }
  [[nodiscard]] int RowsOfGround(const PaintedView& view) const;
  void PaintLandAndSky(const PaintedView& view, const Lit& lit);
  void PaintDisks(const PaintedView& view, const PixelRay& ray);
  void PaintLampsOver(const PaintedView& view);
  [[nodiscard]] bool HasNightFloor() const;
  void PaintNightFloor(const PaintedView& view, double share);
  void PaintStars(const PaintedView& view, const MoonDisk& moon);
  void Begin(const char* pass) const {
    if (timer_ != nullptr) timer_->Begin(pass);
  }

  PaintedScene scene_;
  SceneLamps lamps_;
  LampPainter lamp_painter_;
  ShaftPass shaft_pass_;
  StarPainter stars_;
  NightFloorFollower night_floor_;
  bool has_towns_;
  PicturePrograms programs_;  // of all above
  PictureBlocks blocks_;
  BentDiskFollower bent_sun_, bent_moon_;
  std::optional<SurfaceMap> surface_;
  std::optional<RenderTarget> picture_;
  std::optional<Shining> shining_;  // on the view asked for last
  PassTimer* timer_ = nullptr;
};

}  // namespace alpenglow::viewer
