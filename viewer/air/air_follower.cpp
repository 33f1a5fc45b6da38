// SPDX-License-Identifier: MIT
#include "viewer/air/air_follower.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <utility>

#include "atmosphere/math/constants.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

enum Table : std::size_t { kSky, kThrough, kExtinction, kSingle, kDiffuse, kPhase, kToSun };

struct Slot {
  const char* sampler;
  GLenum target;
};
constexpr std::array<Slot, AirTextures::kUnits> kSlots{{{"air_sky", GL_TEXTURE_2D},
                                                        {"air_through", GL_TEXTURE_1D},
                                                        {"air_extinction", GL_TEXTURE_2D},
                                                        {"air_single", GL_TEXTURE_3D},
                                                        {"air_diffuse", GL_TEXTURE_3D},
                                                        {"air_phase", GL_TEXTURE_2D},
                                                        {"air_to_sun", GL_TEXTURE_2D}}};

void UploadTexels(const GlTexture& texture, GLenum target, const AirTexels& texels) {
  UploadTexture(target, texture,
                {GL_RGBA32F, texels.width, texels.height, texels.depth, GL_RGBA, GL_FLOAT,
                 texels.texel.data()});
  glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

/// Texture coordinates of an axis: centre of its first texel and distance to its last. The axis has
/// n of `all` nodes, from node `first`.
struct Axis {
  Axis(int first, int n, int all)
      : begin((static_cast<float>(first) + 0.5F) / static_cast<float>(all)),
        width(static_cast<float>(n - 1) / static_cast<float>(all)) {}
  float begin, width;
};

glm::vec4 RowsOf(int sky, int ground) {
  const Axis up(0, sky, sky + ground);
  const Axis down(sky, ground, sky + ground);
  return {up.begin, up.width, down.begin, down.width};
}

glm::vec4 AxesOf(int one, int other) {
  const Axis a(0, one, one);
  const Axis b(0, other, other);
  return {a.begin, a.width, b.begin, b.width};
}

}  // namespace

std::vector<ShaderPiece> AirTableTexts() {
  return WithViewerPieces({}, {"viewer/shaders/view/lights.glsl", "lut/camera_tables/air_map.glsl",
                               "viewer/shaders/air/tables.glsl"});
}

AirTextures::AirTextures() = default;

void AirTextures::Upload(const MediumTables& tables) {
  UploadTexels(texture_[kToSun], kSlots[kToSun].target, tables.to_sun);
  CheckGl("AirTextures::Upload");
}

void AirTextures::Upload(const AirTables& tables) {
  const auto upload = [&](Table table, const AirTexels& texels) {
    UploadTexels(texture_[table], kSlots[table].target, texels);
  };
  upload(kSky, tables.sky);
  upload(kPhase, tables.phase);
  upload(kThrough, tables.to_space);
  upload(kExtinction, tables.extinction);
  upload(kSingle, tables.single);
  upload(kDiffuse, tables.multiple_scattering);
  const Axis phase(0, tables.phase.width, tables.phase.width);
  values_.phase_nodes = {phase.begin, phase.width, 0.0F, 0.0F};
  is_of_set_sun_ = tables.has_set;
  const AirMap& map = tables.map;
  const AirTablesSize& size = tables.size;
  values_.shell = {map.altitude, map.ceiling, map.top, map.radius};
  const auto half_tangent = [](double angle) { return std::tan(0.5 * angle); };
  values_.ranges = {half_tangent(map.sky_range), half_tangent(map.air_sky_range),
                    half_tangent(map.ground_range), map.altitude > map.top ? 1.0 : 0.0};
  values_.crowding = {map.sky_crowding, map.ground_crowding, map.twilight_fall,
                      map.twilight_reference};
  values_.columns = AxesOf(size.sky_columns, size.columns);
  values_.sky_rows = RowsOf(size.sky_rows, size.sky_ground_rows);
  values_.through_rows = RowsOf(size.through_rows, size.through_ground_rows);
  values_.way_rows = RowsOf(size.rows, size.ground_rows);
  values_.extinction_rows = RowsOf(size.extinction_rows, size.extinction_ground_rows);
  values_.distances = AxesOf(size.distances, size.extinction_distances);
  values_.sky_mix = tables.sky_mix;
  values_.single_mix = tables.single_mix;
  values_.extinction_below = tables.extinction_below;
  CheckGl("AirTextures::Upload");
}

void AirTextures::SetView(double altitude_m, const LightDirection& light) {
  const double h = std::max(altitude_m, 0.0) / 1000.0;
  const auto radius = static_cast<double>(values_.shell.w);
  const double horizon = shared::HorizonCosine<double>(h, radius);
  const double flat = std::hypot(light.for_air.x, light.for_air.y);
  const glm::dvec2 azimuth = flat > 1e-9 ? glm::dvec2(light.for_air) / flat : glm::dvec2(0.0, 1.0);
  values_.sun = {light.for_air, 0.0};
  values_.sun_seen = {light.seen, 0.0};
  values_.frame = {azimuth, -horizon, std::sqrt((1.0 - horizon) * (1.0 + horizon))};
}

void AirTextures::Prepare(const ShaderProgram& program, int first_unit, GLuint binding) {
  for (std::size_t i = 0; i < kSlots.size(); ++i)
    program.BindSampler(kSlots[i].sampler, first_unit + static_cast<int>(i));
  program.BindBlock("AirTables", binding);
}

void AirTextures::PrepareOther(const ShaderProgram& program, int first_unit, GLuint binding) {
  for (std::size_t i = 0; i < kSlots.size(); ++i) {
    program.BindSampler((std::string("other_") + kSlots[i].sampler).c_str(),
                        first_unit + static_cast<int>(i));
  }
  program.BindBlock("OtherAirTables", binding);
}

void AirTextures::Bind(int first_unit, GLuint binding) const {
  for (std::size_t i = 0; i < kSlots.size(); ++i) {
    BindTexture(first_unit + static_cast<int>(i), kSlots[i].target, texture_[i]);
  }
  UploadBlock(block_, binding, values_);
}

namespace {

constexpr double kMostChange = 1e-3;   // change that is accepted while eye or sun move
constexpr double kGreatChange = 5e-3;  // change that starts new tables without a rest
constexpr double kJump = 0.1;          // change at which small tables are computed at once instead
constexpr double kRest = 2.0;  // rest, in units of the last computation time: drawing needs the CPU

}  // namespace

double AirChange(const EyeUnderLight& made, const EyeUnderLight& now) {
  const double elevation = std::asin(std::clamp(now.mu_s(), -1.0, 1.0)) / kRadiansPerDegree;
  const double turned =
      std::abs(std::asin(std::clamp(made.mu_s(), -1.0, 1.0)) / kRadiansPerDegree - elevation);
  // The coefficients were measured by the test of this function.
  const double per_degree = elevation < 0.0 ? 0.6 : 0.8 / (1.0 + elevation);
  const double rise = std::abs(now.altitude_m - made.altitude_m);
  const double layer =
      std::max(std::min(2400.0 + 1.2 * std::abs(now.altitude_m), 12000.0), 0.5 * now.altitude_m);
  return turned * per_degree + rise / layer;
}

AirTables AirFollower::TablesOf(const Request& request) {
  return MakeAirTables(request.air->air.OnSphereAt(request.latitude_rad), request.air->tables,
                       request.eye, AirTablesSizeOf(request.quality, request.eye.altitude_m));
}

AirFollower::AirFollower(std::shared_ptr<const TabulatedAir> air, AirQuality quality,
                         const Place& eye, const DistantLight& light, Drafts drafts)
    : air_(std::move(air)),
      shown_(air_),
      quality_(quality),
      drafts_(drafts),
      last_(Wanted(eye, light)),
      solver_([](const Solve& solve) { return TabulateAir(solve.medium, solve.solution); }),
      maker_(
          [](const Request& request) {
            return Made{request, TablesOf(request)};
          },
          std::equal_to<Request>()) {
  textures_.Upload(air_->tables);
  ShowSmall(last_);
  textures_.SetView(last_.eye.altitude_m, last_.eye.light);
}

void AirFollower::Replace(const Medium& medium) {
  Validate(medium);
  RequireFourBands(medium);
  solver_.Request({medium, AirSolution::kDraft});
  replaced_at_ = Clock::now();
}

void AirFollower::SetQuality(AirQuality quality) { quality_ = quality; }

void AirFollower::Show(const Made& made) {
  if (shown_ != made.request.air) {
    shown_ = made.request.air;
    textures_.Upload(shown_->tables);
  }
  textures_.Upload(made.tables);
  eye_ = made.tables.eye;
  maker_.RestFor(kRest * maker_.making_s());
}

void AirFollower::PollFinished() {
  if (auto solved = solver_.Poll()) air_ = std::move(*solved);
  if (const auto made = maker_.Poll()) Show(*made);
}

// Wait before refining: while a slider moves, the medium changes every frame.
void AirFollower::RefineDraft() {
  constexpr auto kPause = std::chrono::milliseconds(200);
  if (drafts_ == Drafts::kKept || air_->air.solution() == AirSolution::kFull || solver_.IsBusy())
    return;
  if (Clock::now() > replaced_at_ + kPause)
    solver_.Request({air_->air.medium(), AirSolution::kFull});
}

AirFollower::Request AirFollower::Wanted(const Place& eye, const DistantLight& light) const {
  const bool draft = air_->air.solution() == AirSolution::kDraft;
  return {air_,
          {std::max(eye.height_m, 0.0), light.direction, light.radius_rad},
          eye.latitude_rad(),
          draft ? std::min(quality_, AirQuality::kLow) : quality_};
}

// Returns whether tables for `wanted` should be computed now. A new medium or size starts at once.
// While eye or sun move, tables are computed when the change is large enough; when both are at
// rest, exact tables are computed.
bool AirFollower::IsDue(const Request& wanted) const {
  const std::optional<Request>& last = maker_.requested();
  if (!last || last->air != wanted.air || last->quality != wanted.quality) return true;
  if (maker_.IsBusy()) return false;
  const double change = AirChange(last->eye, wanted.eye);
  if (maker_.IsResting() && change < kGreatChange) return false;
  const bool stands = wanted.eye == last_.eye && wanted.latitude_rad == last_.latitude_rad;
  return stands || change > kMostChange;
}

void AirFollower::Follow(const Place& eye, const DistantLight& light, double seconds) {
  if (seconds > 0.0) maker_.GiveWay();
  PollFinished();
  RefineDraft();
  const Request now = Wanted(eye, light);
  const Request wanted = Ahead(now, seconds);
  if (IsDue(wanted)) maker_.RequestIfNeeded(wanted);
  last_ = now;
  if (AirChange(eye_, now.eye) > kJump) ShowSmall(now);
  textures_.SetView(now.eye.altitude_m, now.eye.light);
}

// Returns the request with the sun extrapolated to the middle of the period in which tables
// requested now will be displayed.
AirFollower::Request AirFollower::Ahead(const Request& wanted, double seconds) const {
  constexpr double kLongestFrame_s = 0.2, kShown = 1.2;
  const LightDirection& before = last_.eye.light;
  const LightDirection& now = wanted.eye.light;
  const bool runs = seconds > 0.0 && seconds < kLongestFrame_s && now != before;
  if (!runs || AirChange(last_.eye, wanted.eye) > kJump) return wanted;
  Request ahead = wanted;
  ahead.eye.light = MovedOn(kShown * (making_s() + seconds) / seconds, before, now);
  return ahead;
}

void AirFollower::ShowSmall(Request wanted) {
  wanted.air = shown_;
  wanted.quality = AirQuality::kFirst;
  const AirTables tables = TablesOf(wanted);
  textures_.Upload(tables);
  eye_ = tables.eye;
}

void AirFollower::WaitUntilReady(const Place& eye, const DistantLight& light) {
  solver_.Wait();
  PollFinished();
  if (air_->air.solution() == AirSolution::kDraft) {
    solver_.Request({air_->air.medium(), AirSolution::kFull});
    solver_.Wait();
    PollFinished();
  }
  maker_.WaitUntilReady(Wanted(eye, light));
  Follow(eye, light);
}

}  // namespace alpenglow::viewer
