// SPDX-License-Identifier: MIT
#include "viewer/passes/painted_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "renderer/media/local_media.h"
#include "viewer/passes/picture_programs.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLong_s = 1e3;  // time after which all fades have ended

// Returns the ground for lamps, media and clouds, which must exist before the first picture. A
// landing light does not need it.
SceneGround LampGroundOf(const Scene& scene) {
  if (!scene.lights.empty() || !scene.layers.empty() || !scene.clouds.empty() || scene.town_zenith)
    return LoadGround(scene);
  Place foot = scene.place;
  foot.height_m = 0.0;
  return {LocalFrame(EllipsoidOf(scene.medium), foot), std::nullopt, 0.0, "", true};
}

Medium MediumAt(const Scene& scene) {
  return OnOsculatingSphere(scene.medium, scene.place.latitude_rad());
}

LandSize LandSizeOf(const PaintSizes& sizes) {
  LandSize size;
  size.detail = sizes.land_detail;
  size.most_growth = sizes.land_growth;
  return size;
}

GroundFollower::View GroundViewOf(const PaintedView& view, const LightsOfSky& lights) {
  GroundFollower::View seen{view.eye.place, view.now, lights.front()};
  if (lights.size() > 1) seen.other = lights.back();
  return seen;
}

LandView LandIn(const PaintedView& view, const Medium& medium, int samples = 1) {
  return {AxesOf(view), samples, -RefractivitySlopeAt(GentleAirOf(medium), 0.0)};
}

}  // namespace

FirstAir DraftOfAir(const Scene& scene) {
  return TabulateAir(MediumAt(scene), AirSolution::kDraft);
}

FixedScene::FixedScene(const Scene& scene, bool has_land)
    : place(scene.place),
      ellipsoid(EllipsoidOf(scene.medium)),
      lamp_ground(LampGroundOf(scene)),
      drape(DrapeOf(scene, lamp_ground)),
      material(scene.ground, drape.colours, scene.medium.wavelengths_nm),
      land_kind{has_land, scene.terrain.HasFineRelief()} {}

PaintedScene::PaintedScene(const Scene& scene, const LandSource& land, const PaintedView& first,
                           const PaintSizes& sizes, FirstAir first_air)
    : fixed_(scene, !land.IsEmpty()),
      sizes_(sizes),
      sunlit_place_(first.eye.place),
      sun_(SunlightOf(ApparentSunAt(sunlit_place_, first.now, GentleAirOf(MediumAt(scene))),
                      scene.medium)),
      air_(first_air ? std::move(first_air) : TabulateAir(MediumAt(scene)), sizes.air,
           sunlit_place_, sun_),
      land_(std::make_unique<Landscape>(land, LandSizeOf(sizes), fixed_.ellipsoid)),
      ground_(scene.ground, fixed_.drape.colours, {}),
      ground_textures_(air_.air()->multiple_scattering()),
      shade_(fixed_.ellipsoid),
      media_(LocalMedia(scene, fixed_.lamp_ground, MediumAt(scene)), sizes.layer_map, kMediaUnits),
      clouds_(scene, fixed_.lamp_ground),
      awaits_land_(!land.IsEmpty()) {
  if (!land.range_centre) land_->BeginReading(first.eye.place);
  shade_.SetSize(sizes.shade.size);
  if (fixed_.drape.colours) ground_textures_.SetDrape(TexelsOf(fixed_.drape));
}

void PaintedScene::Use(const PaintSizes& sizes) {
  sizes_ = sizes;
  media_.SetSize(sizes.layer_map);
  air_.SetQuality(sizes.air);
  shade_.SetSize(sizes.shade.size);
  land_->SetDetail(sizes.land_detail, sizes.land_growth);
}

void PaintedScene::Take(const LandSource& land) {
  auto other = std::make_unique<Landscape>(land, LandSizeOf(sizes_), fixed_.ellipsoid);
  leaving_.push_back(std::exchange(land_, std::move(other)));
  heights_version_ = -1;
  has_edges_ = false;
  awaits_land_ = !land.IsEmpty();
  ground_.ForgetLand();
  shade_.SetGround({});
}

void PaintedScene::UpdateHeights() {
  if (heights_version_ == land_->ground().version()) return;
  heights_version_ = land_->ground().version();
  const GroundSampler sampler = land_->ground().Sampler();
  ground_.SetGround(sampler);
  shade_.SetGround(sampler);
}

void PaintedScene::UpdateLight() {
  if (const std::shared_ptr<const LitGround>& lit = ground_.lit())
    land_->Use(TerrainHorizon{{lit->site().horizons(), &lit->site().horizons()->map()},
                              lit->site().ground().frame});
  if (std::optional<LightOfVertices> light = ground_.Light()) land_->Relight(std::move(*light));
  for (const LightSource source : {LightSource::kSun, LightSource::kMoon}) {
    const GlossMirror& mirror = ground_.gloss_mirror(source);
    if (mirror.waves.empty() && mirror.land.empty()) continue;
    glActiveTexture(GL_TEXTURE0 + kUploadUnit);
    ground_textures_.SetGlossMirror(source, mirror);
  }
}

void PaintedScene::TakeSkyByPixel() {
  if (!sizes_.sky_by_pixel && !fixed_.material.HasGloss()) return;
  glActiveTexture(GL_TEXTURE0 + kUploadUnit);
  for (const LightSource source : {LightSource::kSun, LightSource::kMoon}) {
    if (const auto sky = ground_.SkyOf(source)) {
      sky_by_pixel_.Use(source, *sky);
    } else {
      sky_by_pixel_.Forget(source);
    }
  }
}

void PaintedScene::KeepUpAir(const PaintedView& view, const LightsOfSky& lights, Pace pace,
                             double seconds) {
  const auto keep_up = [&](AirFollower& air, const Place& eye, const DistantLight& light) {
    pace == Pace::kFollow ? air.Follow(eye, light, seconds) : air.WaitUntilReady(eye, light);
  };
  const DistantLight* moon = OfSource(lights, LightSource::kMoon);
  if (const DistantLight* sun = OfSource(lights, LightSource::kSun)) {
    sunlit_place_ = view.eye.place;
    sun_ = *sun;
  }
  keep_up(air_, sunlit_place_, sun_);
  if (known_air_ != air_.air()) {
    known_air_ = air_.air();
    air_here_ =
        std::make_shared<const SolvedAir>(known_air_->OnSphereAt(view.eye.place.latitude_rad()));
    glActiveTexture(GL_TEXTURE0 + kUploadUnit);
    ground_textures_.SetAir(known_air_->multiple_scattering());
  }
  if (moon == nullptr) return;
  if (!moon_air_ || moon_air_of_ != air_.air()) {
    moon_air_.emplace(air_.tabulated(), sizes_.air, view.eye.place, *moon,
                      AirFollower::Drafts::kKept);
    moon_air_of_ = air_.air();
  }
  moon_air_->SetQuality(sizes_.air);
  keep_up(*moon_air_, view.eye.place, *moon);
}

void PaintedScene::KeepUpOpenSkies(const LightsOfSky& lights, Pace pace) {
  for (const DistantLight& light : lights) {
    OpenSkyFollower& follower = open_skies_[IndexOf(light.body)];
    const OpenSky sky{air_here_, ground_.open_altitude_m(), std::asin(light.direction.for_air.z)};
    pace == Pace::kFollow ? follower.Follow(sky) : follower.WaitUntilReady(sky);
  }
}

// The shadow edges of vertices follow the elevation of the disk, but not its azimuth. If the
// azimuth differs by 6 degrees, they are worse than those of the horizon map, whose azimuths are
// 22.5 degrees apart.
bool PaintedScene::HasEdgesNear(const Vector<Ecef>& to_light) const {
  constexpr double kNear_rad = 6.0 * kRadiansPerDegree;
  const EdgesOfVertices edges = land_->edges();
  const auto is_near = [&](const Vector<Ecef>& then) {
    return glm::dot(then.xyz, to_light.xyz) > std::cos(kNear_rad);
  };
  return edges.to && is_near(*edges.to) && (!edges.from || is_near(*edges.from));
}

void PaintedScene::KeepUpEdges(const PaintedView& view, const DistantLight& key, double seconds) {
  constexpr double kFades_s = 0.3;
  casts_ = key.body;
  const Vector<Ecef> to_light =
      LocalFrame(fixed_.ellipsoid, view.eye.place).EcefFromEnu(Vector<Enu>{key.direction.seen});
  has_edges_ = HasEdgesNear(to_light);
  momentary_edges_ = has_edges_ ? std::max(momentary_edges_ - seconds / kFades_s, 0.0) : 1.0;
  land_->Use(MomentaryEdges{momentary_edges_, to_light, key.radius_rad});
}

void PaintedScene::KeepUpMedia(const PaintedView& view, const LightsOfSky& lights, Pace pace) {
  for (const DistantLight& light : lights) {
    pace == Pace::kFollow ? media_.Follow(air_.air(), view.eye, light)
                          : media_.WaitUntilReady(air_.air(), view.eye, light);
  }
}

void PaintedScene::Update(const PaintedView& view, const FrameSky& sky, double seconds) {
  const LightsOfSky& lights = sky.lights;
  std::erase_if(leaving_, [](const auto& land) { return !land->IsWorking(); });
  KeepUpAir(view, lights, Pace::kFollow, seconds);
  land_->Update(view.eye.place, LandIn(view, air_.air()->medium()), seconds);
  awaits_land_ = awaits_land_ && !land_->HasCome();
  UpdateHeights();
  KeepUpEdges(view, lights.front(), seconds);
  if (ground_.Follow(air_.air(), GroundViewOf(view, lights), seconds)) UpdateLight();
  TakeSkyByPixel();
  KeepUpOpenSkies(lights, Pace::kFollow);
  if (sizes_.has_shafts)
    shade_.Follow(view.eye.place, lights.front(), MostShareOfKeyLight(sky), kShadeUnit);
  KeepUpMedia(view, lights, Pace::kFollow);
  clouds_.Follow(air_here_, view.eye.place, view.now, lights.front(), seconds);
}

void PaintedScene::WaitUntilReady(const PaintedView& view, const LightsOfSky& lights, int samples) {
  KeepUpAir(view, lights, Pace::kWait, 0.0);
  land_->WaitUntilReady(view.eye.place, LandIn(view, air_.air()->medium(), samples));
  UpdateHeights();
  if (ground_.WaitUntilReady(air_.air(), GroundViewOf(view, lights))) {
    UpdateLight();
    land_->WaitUntilReady(view.eye.place, LandIn(view, air_.air()->medium(), samples));
  }
  TakeSkyByPixel();
  KeepUpOpenSkies(lights, Pace::kWait);
  KeepUpEdges(view, lights.front(), kLong_s);
  if (sizes_.has_shafts) shade_.WaitUntilReady(view.eye.place, lights.front(), kShadeUnit);
  KeepUpMedia(view, lights, Pace::kWait);
  clouds_.WaitUntilReady(air_here_, view.eye.place, view.now, lights.front());
  awaits_land_ = false;
}

bool HasSkyByPixel(const PaintedScene& scene, const LightsOfSky& lights) {
  return scene.sizes().sky_by_pixel && scene.sky_by_pixel(lights.front().body) != nullptr;
}

}  // namespace alpenglow::viewer
