// SPDX-License-Identifier: MIT
// Pictures of sky and land on the graphics card: what the renderer computes is made beside drawing
// as tables, maps and light of vertices, and the card interpolates.
//
// The passes of a frame: what the eye sees of the land (Landscape), what shade takes from rays
// (ShaftPass), the glow of lamps (LampPainter), the linear picture, the lamps over it. Developer
// shows it. How far it is from SceneRenderer's: tests/bench/README.md, and `skyview --explain` of a
// view.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "atmosphere/sun/moon_disk.h"
#include "lut/picture/image.h"
#include "renderer/scene/scene.h"
#include "viewer/air/air_follower.h"
#include "viewer/flight/flight.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"
#include "viewer/ground/drape_texels.h"
#include "viewer/ground/ground_block.h"
#include "viewer/ground/ground_follower.h"
#include "viewer/lamps/fog_follower.h"
#include "viewer/lamps/fog_painter.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/land/landscape.h"
#include "viewer/land/surface_map.h"
#include "viewer/paint/developer.h"
#include "viewer/paint/exposure_meter.h"
#include "viewer/paint/paint_sizes.h"
#include "viewer/shade/shade_follower.h"
#include "viewer/shade/shaft_pass.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow {

/// When and from where a picture is painted.
struct PaintedView {
  Eye eye;
  UtcInstant now;
  int width, height;                    // of what is painted
  glm::dvec4 part{0.0, 0.0, 1.0, 1.0};  // of the whole view that it is: ViewOfTile
};

/// One of the picture's programs.
struct PictureStage {
  enum class Pass { kLand, kSky, kDisks };
  Pass pass;
  bool has_shade = false, has_lamps = false;

  auto operator<=>(const PictureStage&) const = default;
};
/// What the texts of a picture depend on.
struct PictureKind {
  const GroundMaterial& material;
  const LampPainter* lamps;      // null: none
  std::optional<PhaseKind> fog;  // its phase function
};
/// The texts that a stage of the picture is made of, but for picture.frag.glsl itself.
[[nodiscard]] std::vector<ShaderPiece> PictureTexts(const PictureKind& kind,
                                                    const PictureStage& stage);

class SkyPainter {
 public:
  /// An OpenGL context must be current, now and in all calls. The air is solved here; land is read
  /// beside drawing. Throws InputError for a medium of more than four wavelengths and for land that
  /// is named and cannot be read.
  SkyPainter(const Scene& scene, const LandSource& land, const PaintedView& first,
             const PaintSizes& sizes);

  void Use(const PaintSizes& sizes);
  /// Other air; shown when it is solved.
  void Replace(const Medium& medium) { air_.Replace(medium); }

  /// A lamp that moves with the eye; nothing: none.
  void SetLandingLight(const std::optional<LandingLight>& light) { lamps_.SetLandingLight(light); }

  /// Takes over what has become ready and asks for what is missing. Never waits.
  /// @param seconds  since the last call.
  void Update(const PaintedView& view, double seconds);
  /// Waits until all is there that the view needs.
  /// @param samples  that will be painted.
  void Settle(const PaintedView& view, int samples = 1);

  /// Paints the linear picture of the view that was updated or settled last.
  /// @param samples  rays a pixel, spread over it.
  void Paint(const PaintedView& view, int samples = 1);
  /// Shows another picture of the view instead: linear, of any size.
  void Show(const Image& image);

  [[nodiscard]] const RenderTarget& picture() const { return *picture_; }
  /// A pass of others in the same frame.
  void Time(const char* pass) const { Begin(pass); }
  void EndTime() const {
    if (timer_ != nullptr) timer_->End();
  }
  /// Times of its passes are told to it; null: none.
  void SetTimer(PassTimer* timer) { timer_ = timer; }

  [[nodiscard]] const Landscape& land() const { return land_; }
  [[nodiscard]] Landscape& land() { return land_; }
  [[nodiscard]] const AirFollower& air() const { return air_; }
  [[nodiscard]] const GroundFollower& ground() const { return ground_; }
  [[nodiscard]] const ShadeFollower& shade() const { return shade_; }

 private:
  struct Blocks {
    GlBuffer air, view, ground, ground_light, ground_surface;
  };
  [[nodiscard]] const SunPosition& SunOf(const PaintedView& view) const;
  void TakeHeights();
  void UploadAir(const PaintedView& view);
  void UploadView(const PaintedView& view, const glm::dvec2& shift) const;
  void UploadGround(const PaintedView& view) const;
  void TakeLight();
  [[nodiscard]] const ShaderProgram& ProgramOf(const PictureStage& stage);
  void PrepareLamps(const PaintedView& view);
  void FollowFog(const PaintedView& view, const SunPosition& sun, bool waits);
  void PaintLand(const PaintedView& view);
  void PaintShafts(const PaintedView& view);
  void PaintLamps(const PaintedView& view);
  void PaintPicture(const PaintedView& view, double share);
  void PaintStage(const PictureStage& stage, GLenum land);
  bool MakeReady(const PictureStage& stage, GLenum land);
  void PaintDisk(const glm::dvec3& direction, double radius_rad, const PaintedView& view);
  void UploadMoon(const ShaderProgram& program) const;
  void Begin(const char* pass) const {
    if (timer_ != nullptr) timer_->Begin(pass);
  }

  /// The scene's picture of colours, if it names one.
  struct Drape {
    std::shared_ptr<const ColourDrape> colours;
    FlatRectangle place{};  // around the terrain, then what of it is draped
  };
  [[nodiscard]] static Drape DrapeOf(const Scene& scene, const SceneGround& lamp_ground);
  void UploadDrape();

  Scene scene_;
  Ellipsoid ellipsoid_;
  PaintSizes sizes_;
  SceneGround lamp_ground_;  // that lamps and fog stand on
  Drape drape_;
  GroundMaterial material_;
  AirFollower air_;
  Landscape land_;
  GroundFollower ground_;
  ShadeFollower shade_;
  ShaftPass shaft_pass_;
  SceneLamps lamps_;
  struct Fog {
    Fog(LocalMedia of, const FogUnits& units)
        : media(std::make_shared<const LocalMedia>(std::move(of))), painter(units) {}

    std::shared_ptr<const LocalMedia> media;
    FogPainter painter;
    std::shared_ptr<const SolvedAir> air;  // that the map is made in
    std::optional<FogFollower> follower;
  };
  std::optional<Fog> fog_;
  std::optional<LampPainter> lamp_painter_;         // of sizes_
  std::map<PictureStage, ShaderProgram> programs_;  // of sizes_, made when first drawn with
  std::set<PictureStage> ready_;                    // those that have been drawn with
  GroundTextures ground_textures_;
  Blocks blocks_;
  GlVertexArray no_vertices_;
  std::optional<SurfaceMap> surface_;
  std::optional<RenderTarget> picture_;
  // Of the air that was drawn last: colours of its bands take milliseconds.
  std::pair<std::shared_ptr<const SolvedAir>, AirBlock> air_block_;
  mutable std::optional<std::pair<PaintedView, SunPosition>> sun_;  // of the view asked for last
  MoonDisk moon_{};
  double ray_angle_rad_ = 0.0;  // between the rays of all pictures that are summed
  int heights_version_ = -1;
  PassTimer* timer_ = nullptr;
};

/// The land of a scene: its elevation model, its mesh or the built-in range.
[[nodiscard]] LandSource LandSourceOf(const Scene& scene);

}  // namespace alpenglow
