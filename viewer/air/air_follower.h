// SPDX-License-Identifier: MIT
// Provides AirTextures, the tables of air_tables.h on the GPU for air/tables.glsl, and AirFollower,
// which updates them for a moving eye and a moving sun.
//
// AirFollower computes tables on a thread beside drawing. It requests new tables when the error of
// the current ones would exceed the accepted error of a shortcut, and displays them as soon as they
// are complete. Until then the previous tables are used with the current horizon and the current
// sun.
#pragma once

#include <array>
#include <chrono>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/async_value.h"
#include "lut/camera_tables/air_tables.h"
#include "renderer/illumination/distant_light.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Mirrors the uniform block `AirTables` of air/tables.glsl.
struct AirTablesBlock {
  glm::vec4 sun, sun_seen, frame, shell, ranges, crowding, columns;
  glm::vec4 sky_rows, through_rows, way_rows, extinction_rows, distances, phase_nodes;
  std::array<glm::vec4, 3> sky_mix;
  std::array<glm::vec4, 2> single_mix;
  glm::vec4 extinction_below;
};
static_assert(sizeof(AirTablesBlock) == 19 * sizeof(glm::vec4));

/// Returns the pieces of a shader that calls the functions of air/tables.glsl; they follow
/// SharedTexts().
[[nodiscard]] std::vector<ShaderPiece> AirTableTexts();

/// Textures of the air's tables. They belong to the context that is current at their construction.
class AirTextures {
 public:
  static constexpr int kUnits = 7;

  AirTextures();

  void Upload(const MediumTables& tables);
  void Upload(const AirTables& tables);

  /// Adapts the uploaded tables to an eye that has since moved by less than a request for new
  /// tables requires: rows start at the current horizon, azimuths at the current sun.
  void SetView(double altitude_m, const LightDirection& light);

  /// Returns whether the uploaded tables are of a sun that has set (AirTables::has_set), so that `single`
  /// is 0.
  [[nodiscard]] bool IsOfSetSun() const { return is_of_set_sun_; }

  /// Call once for each program: its samplers read from kUnits units, beginning with first_unit,
  /// its block from `binding`.
  static void Prepare(const ShaderProgram& program, int first_unit, GLuint binding);
  /// Prepares the samplers and the block of the second light of a program with TWO_LIGHTS.
  static void PrepareOther(const ShaderProgram& program, int first_unit, GLuint binding);

  /// Binds the textures and the block for draw calls of prepared programs.
  void Bind(int first_unit, GLuint binding) const;

 private:
  std::array<GlTexture, kUnits> texture_;
  GlBuffer block_;
  AirTablesBlock values_{};
  bool is_of_set_sun_ = false;
};

/// Returns an estimate of the error, relative to the light, of tables that were made for one eye
/// and are used for another.
[[nodiscard]] double AirChange(const EyeUnderLight& made, const EyeUnderLight& now);

/// Computes and displays the tables of the air. It must be used on the thread of the context that
/// is current at its construction.
class AirFollower {
 public:
  /// kRefined: this follower solves a draft of the atmosphere again in full; kKept: it uses the
  /// draft, because another follower solves it.
  enum class Drafts { kRefined, kKept };
  /// Computes small tables for the first frame before it returns, which takes some milliseconds.
  /// @param eye, light  of the first frame, as in Follow.
  AirFollower(std::shared_ptr<const TabulatedAir> air, AirQuality quality, const Place& eye,
              const DistantLight& light, Drafts drafts = Drafts::kRefined);

  /// Replaces the medium, which is solved beside drawing and displayed when it is ready: first as a
  /// draft, then in full if no other medium was requested meanwhile. Throws InputError at once for
  /// a medium that Validate rejects or that has more than four bands.
  void Replace(const Medium& medium);
  void SetQuality(AirQuality quality);

  /// Displays completed tables and requests missing ones. Call it once a frame, before drawing. It
  /// does not wait for the requests. After a jump in time or place with an AirChange above one
  /// tenth it computes small tables, which takes some milliseconds. While the sun moves, tables are
  /// computed for the position of the sun when they will be displayed.
  /// @param light  in the frame east, north, up of the eye.
  /// @param seconds  since the last call; 0: the clock is stopped.
  void Follow(const Place& eye, const DistantLight& light, double seconds = 0.0);
  /// Waits until the final tables of Follow are displayed. It is used for pictures that are written
  /// to files.
  void WaitUntilReady(const Place& eye, const DistantLight& light);

  /// Returns the displayed textures.
  [[nodiscard]] const AirTextures& textures() const { return textures_; }
  /// Returns the air of the displayed textures.
  [[nodiscard]] const std::shared_ptr<const TabulatedAir>& tabulated() const { return shown_; }
  [[nodiscard]] std::shared_ptr<const SolvedAir> air() const { return {shown_, &shown_->air}; }
  [[nodiscard]] const EyeUnderLight& eye() const { return eye_; }
  /// Returns the computation time of the displayed tables; 0 until the first tables from the other
  /// thread.
  [[nodiscard]] double making_s() const { return maker_.making_s(); }

 private:
  struct Request {
    std::shared_ptr<const TabulatedAir> air;
    EyeUnderLight eye;
    double latitude_rad;  // of the eye; its sphere osculates the ellipsoid there
    AirQuality quality;
    bool operator==(const Request&) const = default;
  };
  struct Made {
    Request request;
    AirTables tables;
  };
  using Clock = std::chrono::steady_clock;

  struct Solve {
    Medium medium;
    AirSolution solution;
  };

  [[nodiscard]] static AirTables TablesOf(const Request& request);
  void Show(const Made& made);
  void ShowSmall(Request wanted);
  [[nodiscard]] Request Ahead(const Request& wanted, double seconds) const;
  void PollFinished();
  void RefineDraft();
  [[nodiscard]] Request Wanted(const Place& eye, const DistantLight& light) const;
  [[nodiscard]] bool IsDue(const Request& wanted) const;

  std::shared_ptr<const TabulatedAir> air_;  // displayed next
  std::shared_ptr<const TabulatedAir> shown_;
  AirQuality quality_;
  Drafts drafts_;
  AirTextures textures_;
  EyeUnderLight eye_;  // of the displayed tables
  Request last_;       // of the last call
  Clock::time_point replaced_at_{};
  AsyncValue<Solve, std::shared_ptr<const TabulatedAir>> solver_;
  AsyncValue<Request, Made> maker_;
};

}  // namespace alpenglow::viewer
