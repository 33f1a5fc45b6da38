// SPDX-License-Identifier: MIT
// Sampling for the path tracer: random numbers, distances along segments of a path, columns of air
// along straight lines, and the polarisation state of a path.
//
// A random number is a function of (seed, batch, path, number of earlier draws), so that results do
// not depend on threads. The paths of a batch are the points of a Korobov lattice with a random
// shift (Cranley and Patterson 1976, SIAM J. Numer. Anal. 13, 904), which distributes the first
// dimensions evenly. Batches are independent, and their scatter is the standard error. Later
// dimensions are independent numbers of the generator SplitMix64 (Steele, Lea, Flood 2014, OOPSLA,
// 453).
//
// Distances along a straight segment of a path are sampled with rational maps
//
//   t = begin + length y,   y = v / (1 + k (1 - v)),   v in [0, 1]
//
// Each map is dense at one of its ends (k = length / scale); the maps are combined by the balance
// heuristic.
//
// Columns of air along straight lines are computed thousands of times faster than in
// reference_solution.cpp, and also without the shared sources and closed forms.
//
// A line is described by the distance p of its perigee from the planet's centre; s is the distance
// along the line, counted from the perigee, and mu = s / r its zenith cosine. In the variable
// y = r (w^2 - mu^2) / 2, the climb from radius r, the integrand has no singularity at the perigee,
// and an exponential layer's column outwards is
//
//   exp(-h / H) F(r, mu),   F = integral over w >= mu of
//                               exp(-y / H) (r + y) / sqrt(1 + ((w^2 - mu^2) / 2w)^2) dw
//
// F is smooth and nearly independent of altitude: it is a table of Gauss-Legendre integrals, read
// by cubic interpolation. The ozone tent is linear in r, so that its column is elementary: integral
// of sqrt(s^2 + p^2) ds = (s r + p^2 ln((s + r) / p)) / 2. The smooth ozone layer, a polynomial of
// degree 12 in h, is integrated by 14 Gauss nodes.
//
// The analyser represents the observer's polariser at a point of a path that is followed backwards:
// one row of weights over the Stokes parameters (I, Q, U, V) of the light at this point, for each
// of I, Q, U that the observer measures (the adjoint of polarised transfer).
//
// Stokes parameters of light that is seen in direction d (it propagates along -d) refer to a unit
// vector r perpendicular to d: with s = d x r, Q = <E_r^2> - <E_s^2>, U = 2 <E_r E_s>.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase.h"

namespace alpenglow::atmosphere::reference {

inline constexpr std::size_t kPathsPerBatch = 251;

class PathRandom {
 public:
  PathRandom(std::uint64_t seed, std::uint64_t batch, std::uint64_t path)
      : batch_key_(Mixed(Mixed(seed + kStep) ^ (batch * kStep))),
        state_(Mixed(batch_key_ ^ (path + 1) * 0xD1B54A32D192ED03U)),
        path_(path) {}

  /// Returns a number that is uniform in [0, 1).
  double Next() {
    state_ += kStep;
    const double independent = Fraction(Mixed(state_));
    if (drawn_ >= kLatticeDimensions) return independent;
    const double shift = Fraction(Mixed(batch_key_ + ++drawn_ * kStep));
    const double point = static_cast<double>(path_ * generator_ % kPathsPerBatch) /
                         static_cast<double>(kPathsPerBatch);
    generator_ = generator_ * kGenerator % kPathsPerBatch;
    return point + shift < 1.0 ? point + shift : point + shift - 1.0;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  static constexpr std::uint64_t kGenerator = 33;
  static constexpr std::uint64_t kLatticeDimensions = 12;

  static std::uint64_t Mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  static double Fraction(std::uint64_t z) { return static_cast<double>(z >> 11) * 0x1p-53; }

  std::uint64_t batch_key_;
  std::uint64_t state_;
  std::uint64_t path_;
  std::uint64_t generator_ = 1;
  std::uint64_t drawn_ = 0;
};

struct DistanceMap {
  double begin_m = 0.0;
  double length_m = 0.0;
  double k = 0.0;
  bool dense_at_end = false;
  int strata = 0;

  [[nodiscard]] double Distance(double v) const {
    const double y = v / (1.0 + k * (1.0 - v));
    return begin_m + length_m * (dense_at_end ? 1.0 - y : y);
  }
  /// Returns the expected number of points per metre at a distance.
  [[nodiscard]] double Density(double distance_m) const {
    const double from_begin = (distance_m - begin_m) / length_m;
    if (from_begin < 0.0 || from_begin > 1.0) return 0.0;
    const double y = dense_at_end ? 1.0 - from_begin : from_begin;
    const double fall = 1.0 + k * y;
    return strata * (1.0 + k) / (fall * fall * length_m);
  }
};

/// The maps of one segment.
class DistanceMaps {
 public:
  static constexpr std::size_t kMost = 5;

  /// Adds a map; segments without length are ignored.
  /// @param scale_m  > 0; distance from the dense end over which the density of points decreases.
  void Add(double begin_m, double end_m, double scale_m, bool dense_at_end, int strata) {
    const double length = end_m - begin_m;
    if (!(length > 0.0)) return;
    maps_[count_++] = {begin_m, length, length / std::max(scale_m, 1e-9 * length), dense_at_end,
                       strata};
  }
  [[nodiscard]] const DistanceMap* begin() const { return maps_.data(); }
  [[nodiscard]] const DistanceMap* end() const { return maps_.data() + count_; }

  /// Returns the length of line that a point at this distance represents.
  [[nodiscard]] double Weight(double distance_m) const {
    double density = 0.0;
    for (const DistanceMap& map : *this) density += map.Density(distance_m);
    return 1.0 / density;
  }

 private:
  std::array<DistanceMap, kMost> maps_{};
  std::size_t count_ = 0;
};

/// Column at relative density 1 [m].
struct AirColumns {
  double rayleigh = 0.0, mie = 0.0, ozone = 0.0;
};

/// Computes columns along any line; below altitude 0 air has the density of altitude 0. The
/// relative error of an optical depth to space is below 1e-6 (asserted).
class ColumnTable {
 public:
  explicit ColumnTable(const Medium& medium);

  /// A line with its perigee at `perigee_radius_m` from the centre, and the points at which the
  /// ozone profile has a kink on it.
  struct Line {
    double perigee_radius_m = 0.0;
    std::array<double, 3> ozone_edge_m{};    // s of the layer's bottom, peak, top
    std::array<double, 2> ozone_offset_m{};  // antiderivatives at the lower edges of both sides
    double ozone_below_peak_m = 0.0;         // column of the whole lower side
  };
  [[nodiscard]] Line LineAt(double perigee_radius_m) const;

  /// Returns, for exponential layers of infinite extent, the column beyond |s| on one side; for
  /// ozone, the column between the perigee and s (with the sign of s).
  [[nodiscard]] AirColumns Primitive(const Line& line, double s_m) const;

  /// Returns the column between s0 and s1 >= s0, given their primitives. A line from s0 < 0 to
  /// s1 > 0 needs the primitive at its perigee.
  [[nodiscard]] static AirColumns Difference(double s0_m, const AirColumns& at_s0, double s1_m,
                                             const AirColumns& at_s1, const AirColumns& at_perigee);

  /// Returns the column between s0 and the top of the atmosphere.
  [[nodiscard]] AirColumns ToSpace(double perigee_radius_m, double s0_m) const;

 private:
  static constexpr int kRadii = 12;
  static constexpr int kSlants = 96;

  struct Layer {
    double scale_height_m = 0.0;
    std::vector<double> table;  // F / sqrt(H r) (1 + t), t = mu sqrt(r / 2H); radius-major order
  };
  [[nodiscard]] Layer Tabulate(double scale_height_m) const;

  /// First of four nodes, and their weights.
  struct Cubic {
    std::size_t first;
    double w0, w1, w2, w3;
  };
  [[nodiscard]] static Cubic CubicAt(double x, int count);

  /// A point on a line, and its interpolation between the radii of the tables.
  struct Place {
    double radius_m, s_m, height_m;
    Cubic across;
  };
  [[nodiscard]] Place PlaceAt(double radius_m, double s_m) const;
  [[nodiscard]] static double Beyond(const Layer& layer, const Place& place);
  [[nodiscard]] double MoleculesBeyond(const Place& place) const;
  [[nodiscard]] double SmoothOzoneUpTo(const Line& line, double s_m) const;
  [[nodiscard]] double OzoneSide(const Line& line, std::size_t side, double s_m) const;

  double planet_radius_m_;
  double top_radius_m_;
  OzoneLayer ozone_;
  bool has_ozone_;
  double deficit_share_;
  Layer rayleigh_;
  Layer mie_;
  Layer deficit_;  // empty if the medium has no deficit
};

inline constexpr std::size_t kStokes = 3;  // number of parameters that an observer measures

struct Analyser {
  std::array<std::array<double, 4>, kStokes> row{};
};

/// Rotation of the reference direction at a scattering event: the scattering plane, relative to the
/// reference before it.
struct PlaneTurn {
  double cos_twice = 1.0, sin_twice = 0.0;  // of the angle from reference to scattering plane
  glm::dvec3 reference{};                   // new reference, in the scattering plane
};

/// @param reference  perpendicular to `direction`, of unit length. @param next  the direction after
/// scattering.
[[nodiscard]] inline PlaneTurn TurnOf(const glm::dvec3& direction, const glm::dvec3& reference,
                                      const glm::dvec3& next) {
  glm::dvec3 normal = glm::cross(direction, next);
  // For exact forward and backward scattering every plane is a scattering plane.
  if (glm::dot(normal, normal) < 1e-24) normal = glm::cross(direction, reference);
  normal = glm::normalize(normal);
  const glm::dvec3 in_plane = glm::cross(normal, direction);
  const double cosine = glm::dot(reference, in_plane);
  const double sine = glm::dot(reference, normal);
  const double square = cosine * cosine + sine * sine;  // 1 except for rounding
  return {(cosine - sine) * (cosine + sine) / square, 2.0 * cosine * sine / square,
          glm::normalize(glm::cross(normal, next))};
}

/// Returns the analyser for light before it was scattered by the turn.
[[nodiscard]] inline Analyser Scattered(const Analyser& after, const PlaneTurn& turn,
                                        const ScatteringMatrix& m) {
  Analyser before;
  for (std::size_t k = 0; k < kStokes; ++k) {
    const auto& [i, q, u, v] = after.row[k];
    const double in_q = q * turn.cos_twice - u * turn.sin_twice;
    const double in_u = q * turn.sin_twice + u * turn.cos_twice;
    before.row[k] = {i * m.a1 + in_q * m.b1, i * m.b1 + in_q * m.a2, in_u * m.a3 - v * m.b2,
                     in_u * m.b2 + v * m.a4};
  }
  return before;
}

}  // namespace alpenglow::atmosphere::reference
