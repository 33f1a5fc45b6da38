// SPDX-License-Identifier: MIT
// The tables of air_tables.h on the graphics card, for air_tables.glsl.
//
// Keeps the tables of the air up with an eye that moves and a sun that does: made on a thread beside
// drawing, asked for anew when they would be wrong by more than a shortcut may be, shown as soon as
// they are there. Meanwhile the last ones serve, from the eye's own horizon and under its own sun.
#pragma once

#include <array>
#include <chrono>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "viewer/air/air_tables.h"
#include "viewer/air/solved_air.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/job/latest_job.h"

namespace alpenglow::viewer {

/// Where a sun stands, as unit vectors in the frame of the eye, east, north, up, and where its straight
/// rays light the air from (SunForAir of sun.h).
struct SkySun {
  glm::dvec3 seen, for_air;
  bool operator==(const SkySun&) const = default;
};

/// `block AirTables` of air_tables.glsl.
struct AirTablesBlock {
  glm::vec4 sun, sun_seen, frame, shell, ranges, crowding, columns;
  glm::vec4 sky_rows, through_rows, way_rows, extinction_rows, distances, phase_nodes;
  std::array<glm::vec4, 3> sky_mix;
  std::array<glm::vec4, 2> single_mix;
};
static_assert(sizeof(AirTablesBlock) == 18 * sizeof(glm::vec4));

/// Pieces of a shader that calls the functions of air_tables.glsl, after SharedTexts().
[[nodiscard]] std::vector<ShaderPiece> AirTableTexts();

/// Belongs to the context that is current when it is made.
class AirTextures {
 public:
  static constexpr int kUnits = 7;

  AirTextures();

  void Upload(const MediumTables& tables);
  void Upload(const AirTables& tables);

  /// What is uploaded as an eye sees it that has moved since, by less than what asks for new tables:
  /// rows count from its own horizon, azimuths from its own sun.
  void SetView(double altitude_m, const SkySun& sun);

  /// Once a program: its samplers read from units first_unit to first_unit + kUnits - 1, its block
  /// from `binding`.
  static void Prepare(const ShaderProgram& program, int first_unit, GLuint binding);

  /// For draws of prepared programs.
  void Bind(int first_unit, GLuint binding) const;

 private:
  std::array<GlTexture, kUnits> texture_;
  std::optional<AirTablesSize> size_;  // of what is uploaded
  GlBuffer block_;
  AirTablesBlock values_{};
};

/// What a frame sees of the air.
struct AirView {
  double altitude_m;    // of the eye over the sphere that osculates the ellipsoid below it
  double latitude_rad;  // of the eye
  SkySun sun;
  double ceiling_m = AirEye{}.ceiling_m;  // no land is higher
  bool operator==(const AirView&) const = default;
};

/// How wrong tables made for one eye are for another, roughly and relative to the light.
[[nodiscard]] double AirChange(const AirEye& made, const AirEye& now);

/// To be used on the thread of the context that is current when it is made.
class AirFollower {
 public:
  /// A draft of the air is solved anew by this follower, or kept because another one solves it.
  enum class Drafts { kRefined, kKept };
  /// Makes small tables for the first frame before it returns, some milliseconds later.
  AirFollower(std::shared_ptr<const SolvedAir> air, AirQuality quality, const AirView& first,
              Drafts drafts = Drafts::kRefined);

  /// Another medium, solved beside drawing; shown when it is ready: a draft first, and what it
  /// lacks when no other medium has been asked for meanwhile. Throws InputError at once for
  /// one that Validate refuses or of more than four bands.
  void Replace(const Medium& medium);
  void SetQuality(AirQuality quality);

  /// Once a frame, before drawing: shows what is ready and asks for what is missing. Does not wait for
  /// that; after a jump in time or place, of which AirChange says over a tenth, it makes small tables in
  /// some milliseconds. While a sun runs, tables are made for where it will stand when they are shown.
  /// @param seconds  since the last call; 0: nothing runs.
  void Follow(const AirView& view, double seconds = 0.0);
  /// The same, but what Follow would show in the end is there when it returns: for pictures that
  /// are kept.
  void Settle(const AirView& view);

  /// What is shown.
  [[nodiscard]] const AirTextures& textures() const { return textures_; }
  [[nodiscard]] const std::shared_ptr<const SolvedAir>& air() const { return shown_; }
  [[nodiscard]] const AirEye& eye() const { return eye_; }
  /// Time that the tables shown took to make; 0 before the first that were made beside drawing.
  [[nodiscard]] double making_s() const { return making_s_; }

 private:
  struct Request {
    std::shared_ptr<const SolvedAir> air;
    AirView view;
    AirQuality quality;
    bool operator==(const Request&) const = default;
  };
  struct Made {
    Request request;
    AirTables tables;
    double making_s;
  };
  using Clock = std::chrono::steady_clock;

  struct Solve {
    Medium medium;
    AirSolution solution;
  };

  [[nodiscard]] static Made Make(const Request& request);
  void Show(const Made& made);
  void ShowSmall(const AirView& view);
  [[nodiscard]] AirView Ahead(const AirView& view, double seconds) const;
  void TakeFinished();
  void RefineDraft();
  [[nodiscard]] Request Wanted(const AirView& view) const;
  [[nodiscard]] bool Asks(const Request& wanted) const;

  std::shared_ptr<const SolvedAir> air_;  // to be shown next
  std::shared_ptr<const SolvedAir> shown_;
  AirQuality quality_;
  Drafts drafts_;
  AirTextures textures_;
  AirEye eye_;
  std::optional<Request> asked_;  // last
  AirView last_view_;
  double making_s_ = 0.0;
  Clock::time_point rests_until_{}, replaced_at_{};
  LatestJob<Solve, std::shared_ptr<const SolvedAir>> solver_;
  LatestJob<Request, Made> maker_;
};

}  // namespace alpenglow::viewer
