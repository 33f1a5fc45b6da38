// SPDX-License-Identifier: MIT
#include "viewer/air/air_follower.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/number/constants.h"

namespace alpenglow::viewer {
namespace {

constexpr double kMostChange = 1e-3;   // that is left alone while eye or sun move
constexpr double kGreatChange = 5e-3;  // that does not wait
constexpr double kJump = 0.1;          // that is not shown: small tables are made at once
constexpr double kRest = 2.0;  // times what the last tables took: drawing needs the processor

AirEye EyeOf(const AirView& view) {
  const auto elevation = [](const glm::dvec3& to) {
    return std::asin(std::clamp(to.z, -1.0, 1.0));
  };
  return {view.altitude_m, view.sun.for_air.z, view.ceiling_m,
          elevation(view.sun.seen) - elevation(view.sun.for_air)};
}

AirTables TablesOf(const SolvedAir& air, const AirView& view, AirQuality quality) {
  const AirIntegrator<float> here(OnOsculatingSphere(air.medium, view.latitude_rad));
  return MakeAirTables(here, air.diffuse, air.tables, EyeOf(view),
                       AirTablesSizeOf(quality, view.altitude_m));
}

}  // namespace

double AirChange(const AirEye& made, const AirEye& now) {
  const double elevation = std::asin(std::clamp(now.mu_s, -1.0, 1.0)) / kRadiansPerDegree;
  const double turned =
      std::abs(std::asin(std::clamp(made.mu_s, -1.0, 1.0)) / kRadiansPerDegree - elevation);
  // As measured by the test of this function.
  const double per_degree = elevation < 0.0 ? 0.6 : 0.8 / (1.0 + elevation);
  const double rise = std::abs(now.altitude_m - made.altitude_m);
  const double layer =
      std::max(std::min(2400.0 + 1.2 * std::abs(now.altitude_m), 12000.0), 0.5 * now.altitude_m);
  return turned * per_degree + rise / layer;
}

AirFollower::Made AirFollower::Make(const Request& request) {
  const auto start = Clock::now();
  AirTables tables = TablesOf(*request.air, request.view, request.quality);
  return {request, std::move(tables), std::chrono::duration<double>(Clock::now() - start).count()};
}

AirFollower::AirFollower(std::shared_ptr<const SolvedAir> air, AirQuality quality,
                         const AirView& first, Drafts drafts)
    : air_(std::move(air)),
      quality_(quality),
      drafts_(drafts),
      eye_(EyeOf(first)),
      last_view_(first),
      solver_([](const Solve& solve) { return SolveAir(solve.medium, solve.solution); }),
      maker_(Make) {
  textures_.Upload(air_->tables);
  shown_ = air_;
  ShowSmall(first);
  textures_.SetView(first.altitude_m, first.sun);
}

void AirFollower::Replace(const Medium& medium) {
  Validate(medium);
  RequireFourBands(medium);
  solver_.Ask({medium, AirSolution::kDraft});
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
  making_s_ = made.making_s;
  rests_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                    std::chrono::duration<double>(kRest * making_s_));
}

void AirFollower::TakeFinished() {
  if (auto solved = solver_.Take()) air_ = std::move(*solved);
  if (const auto made = maker_.Take()) Show(*made);
}

// Not at once: who moves a slider asks for other air in the next frame.
void AirFollower::RefineDraft() {
  constexpr auto kPause = std::chrono::milliseconds(200);
  if (drafts_ == Drafts::kKept || air_->solution == AirSolution::kFull || solver_.Busy()) return;
  if (Clock::now() > replaced_at_ + kPause) solver_.Ask({air_->medium, AirSolution::kFull});
}

AirFollower::Request AirFollower::Wanted(const AirView& view) const {
  const bool draft = air_->solution == AirSolution::kDraft;
  return {air_, view, draft ? std::min(quality_, AirQuality::kLow) : quality_};
}

// Whether tables as wanted should be made now: at once for another medium or size, when they are
// due while something moves, and exact ones when all stands still.
bool AirFollower::Asks(const Request& wanted) const {
  if (asked_ == wanted) return false;
  if (!asked_ || asked_->air != wanted.air || asked_->quality != wanted.quality) return true;
  if (maker_.Busy()) return false;
  const double change = AirChange(EyeOf(asked_->view), EyeOf(wanted.view));
  if (Clock::now() < rests_until_ && change < kGreatChange) return false;
  return wanted.view == last_view_ || change > kMostChange;
}

void AirFollower::Follow(const AirView& view, double seconds) {
  TakeFinished();
  RefineDraft();
  const Request wanted = Wanted(Ahead(view, seconds));
  if (Asks(wanted)) {
    asked_ = wanted;
    maker_.Ask(wanted);
  }
  last_view_ = view;
  if (AirChange(eye_, EyeOf(view)) > kJump) ShowSmall(view);
  textures_.SetView(view.altitude_m, view.sun);
}

// The view under the sun of the moment in the middle of the time for which tables that are asked for now will be
// shown.
AirView AirFollower::Ahead(const AirView& view, double seconds) const {
  constexpr double kLongestFrame_s = 0.2, kShown = 1.2;
  const bool runs = seconds > 0.0 && seconds < kLongestFrame_s && view.sun != last_view_.sun;
  if (!runs || AirChange(EyeOf(last_view_), EyeOf(view)) > kJump) return view;
  AirView ahead = view;
  const double frames = kShown * (making_s_ + seconds) / seconds;
  const auto gone_on = [&](glm::dvec3 SkySun::*to) {
    return glm::normalize(view.sun.*to + frames * (view.sun.*to - last_view_.sun.*to));
  };
  ahead.sun = {gone_on(&SkySun::seen), gone_on(&SkySun::for_air)};
  return ahead;
}

void AirFollower::ShowSmall(const AirView& view) {
  const AirTables tables = TablesOf(*shown_, view, AirQuality::kFirst);
  textures_.Upload(tables);
  eye_ = tables.eye;
}

void AirFollower::Settle(const AirView& view) {
  solver_.Wait();
  TakeFinished();
  if (air_->solution == AirSolution::kDraft) {
    solver_.Ask({air_->medium, AirSolution::kFull});
    solver_.Wait();
    TakeFinished();
  }
  const Request wanted = Wanted(view);
  if (asked_ != wanted) {
    asked_ = wanted;
    maker_.Ask(wanted);
  }
  maker_.Wait();
  Follow(view);
}

}  // namespace alpenglow::viewer
