// SPDX-License-Identifier: MIT
#include "renderer/lit_ground/ground_follower.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/time_place/geodesy.h"

namespace alpenglow::renderer {
namespace {

// Distance of the eye from the centre at which other land is requested, as a fraction of the half
// width.
constexpr double kNearMiddle = 0.4;
// Motion of the sun after which light is computed again [radii of its disk]: the shadow of a ridge
// 5 km away moves by 5 m over level ground.
constexpr double kSunMoves = 0.2;

// Pause after a computation, in units of its duration; it keeps the CPU free for drawing.
constexpr double kRest = 4.0;
// Light is displayed from the end of its computation until the next light is complete. It is
// computed for the middle of that period, in units of the computation time after the request.
constexpr double kShown = 1.0 + 0.5 * (1.0 + kRest);

// A site that was made for a higher eye is kept until the eye is lower by this factor.
constexpr double kLower = 1.25;

// Returns whether eyes at both heights need the same site, whether it is kept or made anew.
bool AreAlikeWide(const GroundExtent& extent, double a_m, double b_m) {
  return extent.HalfWidthUnder(a_m) == extent.HalfWidthUnder(b_m) &&
         extent.HalfWidthUnder(kLower * a_m) == extent.HalfWidthUnder(kLower * b_m);
}

double DistanceOn(const Ellipsoid& ellipsoid, const Place& a, const Place& b) {
  Place foot_a = a, foot_b = b;
  foot_a.height_m = foot_b.height_m = 0.0;
  return DistanceBetween(LocalFrame(ellipsoid, foot_a), LocalFrame(ellipsoid, foot_b));
}

double AngleBetweenDisks(const DistantLight& a, const DistantLight& b) {
  return AngleBetween(a.direction.seen, b.direction.seen);
}

bool IsNear(const DistantLight& asked, const DistantLight& wanted) {
  return AngleBetweenDisks(asked, wanted) < kSunMoves * wanted.radius_rad;
}

// Returns whether time has jumped. At 1000 times real time the sun moves by a tenth of this limit
// per frame.
bool IsAJump(const GroundFollower::View& before, const GroundFollower::View& now) {
  constexpr double kLargestStep_rad = 1.0 * kRadiansPerDegree;
  return before.by.body != now.by.body || AngleBetweenDisks(before.by, now.by) > kLargestStep_rad;
}

double OpenAltitude_m(const GroundSite& site) {
  const OccludedSkyIrradiance::Extent& extent = site.horizons()->extent();
  return std::max(0.5 * (extent.lowest_m + extent.highest_m), 0.0);
}

SkyIrradianceGradient UnoccludedSkyUnder(const GroundSite& site, const DistantLight& light) {
  return {site.air().single_scattering(), site.air().multiple_scattering(), OpenAltitude_m(site),
          light.direction.for_air.z};
}

std::array<float, 4> Over(const std::array<float, 4>& sky, const std::array<float, 4>& open) {
  std::array<float, 4> over{};
  for (std::size_t band = 0; band < over.size(); ++band)
    over[band] = open[band] > 0.0F ? sky[band] / open[band] : 1.0F;
  return over;
}

// Ratios of the light at a vertex to the light of the open sky on its slope: for sky and slopes
// together, and for the sky alone. Shaders multiply them by the current light of the open sky
// (GroundLightBlock), which follows the light source.
struct SharesOfUnoccludedSky {
  std::array<float, 4> all, sky;
};
SharesOfUnoccludedSky SharesAt(const GroundVertex& vertex, const GroundSky& sky,
                               const SkyIrradianceGradient& open) {
  const glm::dvec3 normal = ToDouble(vertex.normal),
                   to_light = sky.lighting().source.direction.seen;
  const glm::dvec3 up = sky.site().geometry().UpAt(ToDouble(vertex.position_m));
  const double flat = std::max(std::hypot(to_light.x, to_light.y), 1e-9);
  const double towards = (normal.x * to_light.x + normal.y * to_light.y) / flat;
  const std::array<float, 4> on_slope = open.On(glm::dot(normal, up), towards);
  const TerrainIrradiance::OnSlope on = sky.On(vertex);
  return {Over(InFourBands(on.sky + on.slopes), on_slope), Over(InFourBands(on.sky), on_slope)};
}

}  // namespace

double GroundExtent::HalfWidthUnder(double height_m) const {
  constexpr double kHeights = 7.0;
  double width_m = half_width_m;
  for (int doubled = 0; doubled < 2 && width_m < kHeights * height_m; ++doubled) width_m *= 2.0;
  return width_m;
}

/// Computes light on the land and keeps the site while the sun moves.
class GroundFollower::Maker {
 public:
  Maker(GroundCover cover, std::shared_ptr<const ColourDrape> drape, const GroundExtent& extent)
      : cover_(std::move(cover)), drape_(std::move(drape)), extent_(extent) {}

  Made Make(const Request& request) {
    const std::shared_ptr<const GroundSite> site = SiteFor(request);
    const auto begin = std::chrono::steady_clock::now();
    const View& view = request.view;
    Made made;
    made.casts = view.by.body;
    made.land = request.land;
    if (site) {
      made.lit = std::make_shared<const LitGround>(site, LightingBy(view.by, view, *site));
      made.open_altitude_m = OpenAltitude_m(*site);
      made.open = UnoccludedSkyUnder(*site, view.by);
      if (view.other) {
        made.other = std::make_shared<const GroundSky>(site, LightingBy(*view.other, view, *site));
        made.other_open = UnoccludedSkyUnder(*site, *view.other);
      }
    }
    AddMirrors(request, made);
    made.making_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return made;
  }

 private:
  [[nodiscard]] static Lighting LightingBy(const DistantLight& from_eye, const View& view,
                                           const GroundSite& site) {
    const LocalFrame here(site.ground().frame.ellipsoid(), view.eye);
    Lighting light =
        LightingOf(from_eye, view.now, view.eye, site.medium(), site.material().cover().wetness);
    LightDirection& direction = light.source.direction;
    for (glm::dvec3* to_light : {&direction.seen, &direction.for_air})
      *to_light = site.ground().frame.EnuFromEcef(here.EcefFromEnu(Vector<Enu>{*to_light})).xyz;
    return light;
  }

  void AddMirrors(const Request& request, Made& made) const {
    const View& view = request.view;
    const GroundSky* const sky = made.lit ? &made.lit->sky() : nullptr;
    made.gloss_mirrors[IndexOf(view.by.body)] = MirrorFor(request, view.by, sky);
    if (view.other)
      made.gloss_mirrors[IndexOf(view.other->body)] =
          MirrorFor(request, *view.other, made.other.get());
  }

  // The mirror is also computed without land, because the sea mirrors the sky there too.
  // @param over_land  sky of this source over the land, or null.
  [[nodiscard]] GlossMirror MirrorFor(const Request& request, const DistantLight& light,
                                      const GroundSky* over_land) const {
    const GroundMaterial material(cover_, drape_, request.air->medium().wavelengths_nm);
    if (!material.HasGloss()) return {};
    const GlossMirror::Surfaces surfaces{
        material.HasWater() ? &material.water() : nullptr,
        cover_.kind == GroundCover::Kind::kBlinnPhong ? &material.glossy() : nullptr};
    const MultipleScattering& multiple_scattering = request.air->multiple_scattering();
    if (over_land != nullptr) {
      const OccludedSkyIrradiance::Extent& extent = over_land->site().horizons()->extent();
      const double lowest_m = std::max(extent.lowest_m, 0.0);
      const double highest_m =
          std::clamp(surfaces.land == nullptr ? material.WaterLine_m().value_or(extent.highest_m)
                                              : extent.highest_m,
                     lowest_m, std::max(extent.highest_m, lowest_m));
      return GlossMirror::Of(over_land->lighting().on_terrain->sky(), multiple_scattering, surfaces,
                             over_land->lighting().source.direction.for_air, lowest_m, highest_m);
    }
    const SolvedAir here = request.air->OnSphereAt(request.view.eye.latitude_rad());
    const glm::dvec3& to_light = light.direction.for_air;
    const OccludedSkyIrradiance sky(here.single_scattering(), multiple_scattering, to_light,
                                    OccludedSkyIrradiance::Extent{0.0, 1.0, 5e5});
    return GlossMirror::Of(sky, multiple_scattering, surfaces, to_light, 0.0, 0.0);
  }

  std::shared_ptr<const GroundSite> SiteFor(const Request& request) {
    if (!request.ground || !*request.ground) return nullptr;
    if (site_ && air_ == request.air && ground_ == request.ground &&
        DistanceOn(site_->ground().frame.ellipsoid(), site_->ground().frame.origin(),
                   request.view.eye) < 2.0 * kNearMiddle * half_width_m_ &&
        IsNearMiddle(request.view.eye) && IsAsWide(request.view.eye.height_m)) {
      return site_;
    }
    half_width_m_ = extent_.HalfWidthUnder(request.view.eye.height_m);
    const std::optional<ElevationGrid> grid =
        (*request.ground)(request.view.eye, half_width_m_, extent_.samples);
    if (!grid) return nullptr;
    Place foot = request.view.eye;
    foot.height_m = 0.0;
    SolvedAir air = request.air->OnSphereAt(foot.latitude_rad());
    SceneGround ground = GroundOf(*grid, LocalFrame(EllipsoidOf(air.medium()), foot));
    if (ground.terrain->mesh().triangles.empty()) return nullptr;  // no land is loaded there yet
    auto drape = drape_ ? drape_->In(ground.frame) : nullptr;
    site_ = std::make_shared<const GroundSite>(std::move(ground), cover_, std::move(drape),
                                               std::move(air));
    air_ = request.air;
    ground_ = request.ground;
    middle_ = foot;
    return site_;
  }

  [[nodiscard]] bool IsNearMiddle(const Place& eye) const {
    return DistanceOn(site_->ground().frame.ellipsoid(), middle_, eye) <
           kNearMiddle * half_width_m_;
  }

  [[nodiscard]] bool IsAsWide(double height_m) const {
    return half_width_m_ >= extent_.HalfWidthUnder(height_m) &&
           half_width_m_ <= extent_.HalfWidthUnder(kLower * height_m);
  }

  GroundCover cover_;
  std::shared_ptr<const ColourDrape> drape_;
  GroundExtent extent_;
  double half_width_m_ = 0.0;  // half width of the site
  std::shared_ptr<const GroundSite> site_;
  std::shared_ptr<const SolvedAir> air_;
  std::shared_ptr<const GroundSampler> ground_;
  Place middle_;
};

GroundFollower::GroundFollower(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                               const GroundExtent& extent)
    : maker_([maker = std::make_shared<Maker>(cover, std::move(drape), extent)](
                 const Request& request) { return maker->Make(request); },
             [extent](const Request& requested, const Request& wanted) {
               return Suits(extent, requested, wanted);
             }) {}

void GroundFollower::ForgetLand() {
  ++land_;
  ground_ = nullptr;
  made_ = {};
  maker_.Forget();
}

void GroundFollower::SetGround(GroundSampler sampler) {
  ground_ = std::make_shared<const GroundSampler>(std::move(sampler));
}

bool GroundFollower::Suits(const GroundExtent& extent, const Request& requested,
                           const Request& wanted) {
  if (requested.air != wanted.air || requested.ground != wanted.ground) return false;
  const View &before = requested.view, &now = wanted.view;
  if (before.by.body != now.by.body || before.other.has_value() != now.other.has_value())
    return false;
  const double width_m = extent.HalfWidthUnder(now.eye.height_m);
  return IsNear(before.by, now.by) && (!now.other || IsNear(*before.other, *now.other)) &&
         AreAlikeWide(extent, before.eye.height_m, now.eye.height_m) &&
         DistanceOn(kWgs84, before.eye, now.eye) < kNearMiddle * width_m;
}

bool GroundFollower::Poll() {
  std::optional<Made> made = maker_.Poll();
  if (!made || made->land != land_) return false;
  made_ = std::move(*made);
  maker_.RestFor(made_.lit ? kRest * made_.making_s : 0.0);
  return true;
}

GroundFollower::View Ahead(const GroundFollower::View& before, const GroundFollower::View& now,
                           double steps) {
  constexpr double kFarthest_rad = 10.0 * kRadiansPerDegree;
  const double step_rad = AngleBetweenDisks(before.by, now.by);
  if (step_rad == 0.0 || IsAJump(before, now)) return now;
  const double taken = std::min(steps, kFarthest_rad / step_rad);
  GroundFollower::View ahead = now;
  ahead.by.direction = MovedOn(taken, before.by.direction, now.by.direction);
  if (now.other && before.other)
    ahead.other->direction = MovedOn(taken, before.other->direction, now.other->direction);
  return ahead;
}

GroundFollower::View GroundFollower::WhenShown(const View& view, double seconds) const {
  constexpr double kLongestFrame_s = 0.2;
  const bool runs = last_view_ && seconds > 0.0 && seconds < kLongestFrame_s;
  return runs ? Ahead(*last_view_, view, kShown * made_.making_s / seconds) : view;
}

bool GroundFollower::Follow(const std::shared_ptr<const SolvedAir>& air, const View& view,
                            double seconds) {
  const bool is_new = Poll();
  if (last_view_ && IsAJump(*last_view_, view)) maker_.RestFor(0.0);
  maker_.RequestWhenIdle({air, ground_, WhenShown(view, seconds), land_});
  last_view_ = view;
  return is_new;
}

bool GroundFollower::WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const View& view) {
  maker_.WaitUntilReady({air, ground_, view, land_});
  return Poll();
}

std::optional<GroundFollower::SkyOfSource> GroundFollower::SkyOf(LightSource source) const {
  if (!made_.lit) return std::nullopt;
  if (source == made_.casts) return SkyOfSource{{made_.lit, &made_.lit->sky()}, made_.open.value()};
  if (!made_.other) return std::nullopt;
  return SkyOfSource{made_.other, made_.other_open.value()};
}

std::optional<LightOfVertices> GroundFollower::Light() const {
  if (!made_.lit) return std::nullopt;
  const Vector<Ecef> to_disk = made_.lit->site().ground().frame.EcefFromEnu(
      Vector<Enu>{made_.lit->lighting().source.direction.seen});
  const auto at = [made = made_](const LocalFrame& anchor, std::span<const LandVertex> vertices) {
    std::vector<VertexLight> light;
    light.reserve(vertices.size());
    for (const GroundVertex& vertex : VerticesIn(made.lit->site(), anchor, vertices)) {
      const SharesOfUnoccludedSky by = SharesAt(vertex, made.lit->sky(), *made.open);
      // A source that is not yet significant gets the ratios that it has when it becomes
      // significant: it is low and does not light slopes.
      const std::array<float, 4> other =
          made.other ? SharesAt(vertex, *made.other, *made.other_open).all : by.sky;
      const bool sun_casts = made.casts == LightSource::kSun;
      light.push_back(
          {sun_casts ? by.all : other, sun_casts ? other : by.all, made.lit->EdgeOver(vertex)});
    }
    return light;
  };
  return LightOfVertices{at, to_disk};
}

}  // namespace alpenglow::renderer
