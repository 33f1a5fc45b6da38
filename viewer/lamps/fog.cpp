// SPDX-License-Identifier: MIT
#include "viewer/lamps/fog.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"
#include "renderer/media/fog_light.h"
#include "renderer/surface/scene_geometry.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/lamps/scene_lamps.h"
#include "viewer/shaders/full_screen.h"

namespace alpenglow::viewer {
namespace {

enum Quantity { kDirect, kBroad, kGlow, kSkyLight, kQuantities };

glm::vec4 InFloats(const BandLight& light) {
  glm::vec4 values(0.0F);
  for (std::size_t band = 0; band < light.count; ++band) {
    values[static_cast<glm::length_t>(band)] = light[band];
  }
  return values;
}

/// The four quantities, summed from the eye on.
using Sums = std::array<glm::vec4, kQuantities>;

class FogMarch {
 public:
  FogMarch(const LocalMedium& fog, double bottom_m, const SunlitAir& air, const FogView& view)
      : fog_(fog),
        layer_(*fog.fog()),
        air_(air),
        view_(view),
        radius_m_(air.air.medium().planet_radius_m),
        eye_(0.0, 0.0, std::max(view.altitude_m, 0.0)),
        light_(fog, air.multiple_scattering,
               {view.to_sun, view.to_sun_for_air, SunInAir(Head(bottom_m))}, bottom_m) {}

  [[nodiscard]] const FogLight& light() const { return light_; }

  /// Returns the sums at fractions i / (depths - 1) of the light that the fog removes along the
  /// whole ray.
  [[nodiscard]] std::vector<Sums> Along(const glm::dvec3& direction, int depths) const {
    const std::vector<Step> steps = StepsOf(direction);
    std::vector<Sums> nodes(static_cast<std::size_t>(depths), Sums{});
    if (steps.empty()) return nodes;
    const double whole = steps.back().taken;
    Sums sum{}, before{};
    double taken = 0.0;
    std::size_t node = 1;
    const FogLight::Look look = light_.LookAlong(direction);
    for (const Step& step : steps) {
      before = sum;
      const Sums here = SourceAt(step, direction, look);
      for (std::size_t q = 0; q < sum.size(); ++q) {
        sum[q] += static_cast<float>(step.taken - taken) * here[q];
      }
      if (taken == 0.0) nodes[0] = here;
      const auto at = [&](std::size_t i) {
        return whole * static_cast<double>(i) / (depths - 1.0);
      };
      for (; node < nodes.size() && at(node) <= step.taken * (1.0 + 1e-9); ++node) {
        const auto share = static_cast<float>((at(node) - taken) / (step.taken - taken));
        for (std::size_t q = 0; q < sum.size(); ++q) {
          nodes[node][q] =
              (before[q] + share * (sum[q] - before[q])) / static_cast<float>(at(node));
        }
      }
      taken = step.taken;
    }
    return nodes;
  }

 private:
  struct Step {
    double middle_m;
    double taken;  // fraction of light that the fog removes up to the end of this step
  };

  [[nodiscard]] glm::dvec3 Head(double bottom_m) const {
    const double scale = layer_.scale_height_m();
    return {0.0, 0.0, bottom_m + (std::isinf(scale) ? 0.0 : scale)};
  }

  [[nodiscard]] BandLight SunInAir(const glm::dvec3& point) const {
    const double altitude = std::max(AltitudeOverSphere(point, radius_m_), 0.0);
    const glm::dvec3 up = glm::normalize(point + glm::dvec3(0.0, 0.0, radius_m_));
    const double mu_s = std::clamp(glm::dot(up, view_.to_sun), -1.0, 1.0);
    const VisibleDisk disk =
        DiskOverHorizon(mu_s, shared::HorizonCosine(altitude, radius_m_), view_.sun_radius_rad);
    if (disk.fraction <= 0.0) return BandLight(air_.air.bands());
    return static_cast<float>(disk.fraction) * air_.BeamLeft(altitude, disk.mu_s_effective);
  }

  [[nodiscard]] double EndOf(const glm::dvec3& direction) const {
    if (shared::GroundClearance(eye_.z, direction.z, radius_m_) <= 0.0) {
      return std::numeric_limits<double>::infinity();
    }
    return shared::DistanceDownTo(eye_.z, direction.z, 0.0, radius_m_);
  }

  // Returns steps up to the distance at which the fog is opaque, so short that neither the light in
  // the fog nor its density changes much within one.
  [[nodiscard]] std::vector<Step> StepsOf(const glm::dvec3& direction) const {
    constexpr double kDepth = 0.1, kFall = 0.25, kOpaque = 12.0;
    constexpr double kShortest_m = 0.01;
    const double extinction = fog_.optics.extinction_per_m[0];
    std::vector<Step> steps;
    double tau = 0.0;
    for (const DensePiece& piece : layer_.PiecesAlong(eye_, direction, EndOf(direction))) {
      for (double t = piece.begin_m; t < piece.end_m && tau < kOpaque;) {
        const glm::dvec3 point = eye_ + t * direction;
        const double rise =
            glm::dot(direction, glm::normalize(point + glm::dvec3(0, 0, radius_m_)));
        const double per_m = extinction * layer_.DensityAt(point);
        const double h = layer_.scale_height_m();
        const double by_fall =
            std::isinf(h) ? piece.end_m : kFall * h / std::max(std::abs(rise), 1e-3);
        double step =
            std::clamp(std::min({kDepth / per_m, by_fall, 0.05 * (piece.end_m - piece.begin_m)}),
                       kShortest_m, piece.end_m - t);
        const double middle = t + 0.5 * step;
        tau += step * extinction *
               (layer_.DensityAt(point) + 4.0 * layer_.DensityAt(eye_ + middle * direction) +
                layer_.DensityAt(eye_ + (t + step) * direction)) /
               6.0;
        steps.push_back({middle, -std::expm1(-tau)});
        t += step;
        if (piece.end_m - t < kShortest_m) break;
      }
    }
    return steps;
  }

  // Returns the light scattered at this step, attenuated by the air in front of it.
  [[nodiscard]] Sums SourceAt(const Step& step, const glm::dvec3& direction,
                              const FogLight::Look& look) const {
    const glm::dvec3 point = eye_ + step.middle_m * direction;
    const double altitude = AltitudeOverSphere(point, radius_m_);
    const double slant =
        fog_.optics.extinction_per_m[0] * layer_.ColumnToSpace(point, view_.to_sun);
    const BandLight sun = SunInAir(point);
    BandLight all(sun.count), none(sun.count);
    std::fill_n(all.value.begin(), all.count, 1.0F);
    const FogLight::Scattered glow = light_.At(look, altitude, none, all, slant);
    const auto direct = static_cast<float>(std::exp(-slant));
    const auto scattered =
        static_cast<float>(fog_.optics.scattering_per_m[0] / fog_.optics.extinction_per_m[0]);
    ViewRay ray{eye_.z, direction.z, 0.0, 0.0};
    ray.length_m = step.middle_m;
    const BandLight left = scattered * air_.air.TransmittanceAlong(ray);
    return {InFloats(direct * (left * sun)),
            InFloats((light_.BeamLeft(slant) - direct) * (left * sun)),
            InFloats(left * glow.of_sun), InFloats(left * glow.of_sky)};
  }

  const LocalMedium& fog_;
  const FogLayer& layer_;
  SunlitAir air_;
  FogView view_;
  double radius_m_;
  glm::dvec3 eye_;
  FogLight light_;
};

// Returns the sine of the elevation for a position in [0, 1] on the axis, which is dense at the
// horizontal.
double FogElevationSine(double unit) {
  const double root = 2.0 * unit - 1.0;
  return root * std::abs(root);
}

void AddRays(const FogMarch& march, FogMap& map) {
  const FogMapSize& size = map.size;
  const double sun_azimuth = std::atan2(map.view.to_sun.y, map.view.to_sun.x);
  const auto at = [&](int quantity, int depth, int azimuth, int elevation) {
    return static_cast<std::size_t>(
        ((quantity * size.depths + depth) * size.azimuths + azimuth) * size.elevations + elevation);
  };
  map.light.resize(at(kQuantities, 0, 0, 0));
  for (int azimuth = 0; azimuth < size.azimuths; ++azimuth) {
    const double turn = sun_azimuth + kPi * azimuth / (size.azimuths - 1.0);
    for (int elevation = 0; elevation < size.elevations; ++elevation) {
      const double sine = FogElevationSine(elevation / (size.elevations - 1.0));
      const double cosine = std::sqrt(std::max(1.0 - sine * sine, 0.0));
      const std::vector<Sums> nodes =
          march.Along({cosine * std::cos(turn), cosine * std::sin(turn), sine}, size.depths);
      for (int depth = 0; depth < size.depths; ++depth) {
        for (int q = 0; q < kQuantities; ++q) {
          map.light[at(q, depth, azimuth, elevation)] =
              nodes[static_cast<std::size_t>(depth)][static_cast<std::size_t>(q)];
        }
      }
    }
  }
}

void AddSurfaces(const FogMarch& march, const FogLayer& layer, FogMap& map) {
  map.on_surface.resize(2 * std::size_t{FogMap::kHeights});
  for (int i = 0; i < FogMap::kHeights; ++i) {
    const double share = std::pow(std::max(i / (FogMap::kHeights - 1.0), 1e-3), 4.0);
    const double column = share * map.depth / map.extinction_per_m;
    const double altitude =
        std::isinf(layer.scale_height_m())
            ? map.top_m - column
            : map.base_m - layer.scale_height_m() * std::log(column / layer.scale_height_m());
    const glm::vec4 level = InFloats(march.light().OnSurface(altitude, 1.0));
    map.on_surface[static_cast<std::size_t>(i)] = level;
    map.on_surface[static_cast<std::size_t>(FogMap::kHeights + i)] =
        InFloats(march.light().OnSurface(altitude, 0.0)) - level;
  }
}

}  // namespace

FogMap MakeFogMap(const LocalMedium& fog, double bottom_m, const SunlitAir& air,
                  const FogView& view, const FogMapSize& size) {
  ALPENGLOW_ENSURE(air.air.bands(), <=, std::size_t{4});
  const FogLayer& layer = *fog.fog();
  const FogMarch march(fog, bottom_m, air, view);
  const std::vector<double> chi = LegendreCoefficients(fog.optics.phase, 2);
  FogMap map;
  map.view = view;
  map.size = size;
  map.extinction_per_m = fog.optics.extinction_per_m[0];
  map.scale_height_m = layer.scale_height_m();
  map.base_m = layer.base_m();
  map.top_m = air.air.medium().atmosphere_height_m;
  map.radius_m = air.air.medium().planet_radius_m;
  map.depth = map.extinction_per_m * layer.ColumnAbove(bottom_m);
  map.peak_scale = -std::log(static_cast<double>(march.light().BeamLeft(1.0)));
  map.phase = fog.optics.phase;
  map.broad_g = std::clamp(chi[1], -0.99, 0.99);
  AddRays(march, map);
  AddSurfaces(march, layer, map);
  return map;
}

bool Serves(const FogView& made, const FogView& wanted, double scale_height_m) {
  constexpr double kSun_rad = 0.1 * 3.14159265358979 / 180.0;
  const double step_m = 0.1 * std::min(scale_height_m, 1000.0);
  return std::abs(made.altitude_m - wanted.altitude_m) <= step_m &&
         glm::length(made.to_sun - wanted.to_sun) <= kSun_rad;
}

namespace {

constexpr double kMetres = 1000.0;

void Activate(int unit) { glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit)); }

// @param now  current eye and sun, which may differ from those of the map.
FogBlock FogBlockOf(const FogMap& map, const FogView& now) {
  FogBlock block{};
  const double height_km = std::isinf(map.scale_height_m) ? 0.0 : map.scale_height_m / kMetres;
  block.layer = {map.extinction_per_m * kMetres, height_km, map.base_m / kMetres,
                 map.top_m / kMetres};
  block.eye = {std::max(now.altitude_m, 0.0) / kMetres, map.radius_m / kMetres, map.depth,
               map.peak_scale};
  block.sun = {glm::vec3(now.to_sun), map.broad_g};
  block.phase = ParametersOf(map.phase);
  block.map_size = {map.size.elevations, map.size.azimuths, map.size.depths, 0.0};
  return block;
}

}  // namespace

std::vector<ShaderPiece> FogTexts(PhaseKind kind) {
  return {{"fog constants", fmt::format("#define FOG_PHASE(c, p) {}\n", PhaseExpression(kind))},
          ViewerPiece("viewer/shaders/fog_light.glsl")};
}

std::vector<ShaderPiece> NoFogTexts() { return {ViewerPiece("viewer/shaders/no_fog.glsl")}; }

void FogPainter::Connect(const ShaderProgram& program) const {
  program.Use();
  program.BindBlock("Fog", units_.block);
  program.BindSampler("fog_light_map", units_.first);
  program.BindSampler("fog_surface_map", units_.first + 1);
}

void FogPainter::Upload(const FogMap& map) {
  Activate(units_.first);
  glBindTexture(GL_TEXTURE_3D, light_.id());
  glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, map.size.elevations, map.size.azimuths,
               4 * map.size.depths, 0, GL_RGBA, GL_FLOAT, map.light.data());
  ClampAndFilter(GL_TEXTURE_3D, true);
  Activate(units_.first + 1);
  glBindTexture(GL_TEXTURE_2D, surface_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, FogMap::kHeights, 2, 0, GL_RGBA, GL_FLOAT,
               map.on_surface.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
  CheckGl("FogPainter::Upload");
}

void FogPainter::Bind(const FogMap& map, const FogView& now) const {
  const FogBlock block = FogBlockOf(map, now);
  glBindBufferBase(GL_UNIFORM_BUFFER, units_.block, block_.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
  Activate(units_.first);
  glBindTexture(GL_TEXTURE_3D, light_.id());
  Activate(units_.first + 1);
  glBindTexture(GL_TEXTURE_2D, surface_.id());
}

namespace {

FogView FogViewOf(const Eye& eye, const SunPosition& sun) {
  const auto towards = [](const SunPosition& at) {
    return DirectionFromAngles(at.elevation_rad, at.azimuth_rad).xyz;
  };
  return {eye.place.height_m, towards(sun), towards(SunForAir(sun)), sun.angular_radius_rad};
}

}  // namespace

SceneFog::SceneFog(LocalMedia media, const FogMapSize& size, const FogUnits& units)
    : media_(std::make_shared<const LocalMedia>(std::move(media))), size_(size), painter_(units) {}

void SceneFog::SetSize(const FogMapSize& size) {
  if (size == size_) return;
  size_ = size;
  air_ = nullptr;
}

// Uses one thread, so that drawing keeps the others.
void SceneFog::BeginIn(const std::shared_ptr<const SolvedAir>& air, double latitude_rad) {
  air_ = air;
  const auto make = [air, media = media_, size = size_, latitude_rad](const FogView& wanted) {
    tbb::task_arena alone(1);
    return alone.execute([&] {
      const SingleScattering<float> single_scattering(
          OnOsculatingSphere(air->medium, latitude_rad));
      return MakeFogMap(*media->fog(), media->fog_bottom_m(),
                        {single_scattering, air->beam, air->multiple_scattering}, wanted, size);
    });
  };
  const double scale_height_m = media_->fog()->fog()->scale_height_m();
  maps_.emplace(make, [scale_height_m](const FogView& made, const FogView& wanted) {
    return Serves(made, wanted, scale_height_m);
  });
}

void SceneFog::Follow(const std::shared_ptr<const SolvedAir>& air, const Eye& eye,
                      const SunPosition& sun) {
  if (air_ != air) return Settle(air, eye, sun);
  if (maps_->Update()) painter_.Upload(*maps_->value());
  maps_->RequestWhenIdle(FogViewOf(eye, sun));
}

void SceneFog::Settle(const std::shared_ptr<const SolvedAir>& air, const Eye& eye,
                      const SunPosition& sun) {
  if (air_ != air) BeginIn(air, eye.place.latitude_rad);
  maps_->WaitUntilReady(FogViewOf(eye, sun));
  maps_->Update();
  painter_.Upload(*maps_->value());
}

double SceneFog::ExtinctionAt(double altitude_m) const {
  const LocalMedium& fog = *media_->fog();
  return fog.optics.extinction_per_m[0] * fog.fog()->DensityAtAltitude(altitude_m);
}

void SceneFog::Bind(const Eye& eye, const SunPosition& sun) const {
  painter_.Bind(*maps_->value(), FogViewOf(eye, sun));
}

}  // namespace alpenglow::viewer
