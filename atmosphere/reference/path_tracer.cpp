// SPDX-License-Identifier: MIT
#include "atmosphere/reference/path_tracer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/column_table.h"
#include "atmosphere/reference/path_analyser.h"
#include "atmosphere/reference/path_sampling.h"
#include "atmosphere/reference/sun_lobe.h"

namespace alpenglow::atmosphere::reference {
namespace {

using Vector = glm::dvec3;

constexpr int kFirstStrata = 8;  // strata of each map along the first segment of a path
constexpr int kLaterStrata = 4;  // strata of each map along later segments
// Among other bodies a point costs a ray to the sun through them, and a path costs more than the
// points of its first segments.
constexpr int kFirstStrataAmongBodies = 3, kLaterStrataAmongBodies = 2;
// Segments among bodies of a smaller optical depth of air have one point, or none at random.
constexpr double kThinAir = 0.02;
// If the expected contribution of the next segment is below kRouletteShare times that of the first
// segment, the path undergoes Russian roulette; above kSplitShare times, it is split. Without
// splitting, the weights of the hundreds of orders in thick air would diverge (weight windows:
// Booth and Hendricks 1984, Nucl. Technol./Fusion 5, 90).
constexpr double kRouletteShare = 0.2;
constexpr double kSplitShare = 2.0;
constexpr double kMostCopies = 8.0;

// Phase function from which directions are sampled; depolarisation is included in the weight.
const PhaseFunction kMolecules{.kind = PhaseKind::kRayleigh};

double Mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Returns an estimate of the brightness of the twilight sky, 1 by day: it falls by a decade for
// 2.5 degrees of the sun's depression, and the dip of the horizon at a height compensates a part.
// It is used only for importance sampling.
double TwilightFactor(double altitude_m, double sine_of_sun, double planet_m) {
  constexpr double kFallPerRadian = 53.0;
  constexpr double kShareOfDip = 0.45;
  const double dip = std::sqrt(2.0 * std::max(altitude_m, 0.0) / planet_m);
  return std::exp(kFallPerRadian * std::clamp(sine_of_sun + kShareOfDip * dip, -0.35, 0.0));
}

/// A straight segment of a path. s is the distance [m] from the perigee of its line.
struct Piece {
  Vector origin, direction;
  double perigee_m = 0.0;  // radius of the perigee
  double s0_m = 0.0;
  double length_m = 0.0;
  bool ends_on_ground = false;

  [[nodiscard]] double Radius(double distance_m) const {
    const double s = s0_m + distance_m;
    return std::sqrt(perigee_m * perigee_m + s * s);
  }
};

double PerigeeRadius(double radius2, double s) { return std::sqrt(std::max(radius2 - s * s, 0.0)); }

/// Data precomputed from the medium, shared by all paths.
class Scene {
 public:
  Scene(const Medium& medium, const Vector& sun)
      : medium_(medium),
        sun_(sun),
        table_(medium),
        rayleigh_per_m_(Mean(medium.rayleigh_scattering_per_m)),
        mie_per_m_(Mean(medium.mie_extinction_per_m)),
        shadow_radius_m_(ShadowRadius()) {}

  [[nodiscard]] const Medium& medium() const { return medium_; }
  [[nodiscard]] const Vector& sun() const { return sun_; }
  [[nodiscard]] const ColumnTable& table() const { return table_; }
  [[nodiscard]] std::size_t bands() const { return medium_.wavelengths_nm.size(); }
  [[nodiscard]] double planet_m() const { return medium_.planet_radius_m; }
  [[nodiscard]] double top_m() const { return planet_m() + medium_.atmosphere_height_m; }
  [[nodiscard]] bool has_aerosol() const { return mie_per_m_ > 0.0; }

  /// Below altitude 0 air has the density of altitude 0.
  [[nodiscard]] double RayleighDensity(double radius_m) const {
    return MoleculeDensity(medium_, std::max(radius_m - planet_m(), 0.0));
  }
  [[nodiscard]] double MieDensity(double radius_m) const {
    return std::exp(-std::max(radius_m - planet_m(), 0.0) / medium_.mie_scale_height_m);
  }
  /// Returns the point, or the point of altitude 0 above it: light of air below altitude 0 is that
  /// of altitude 0.
  [[nodiscard]] Vector Raised(const Vector& point) const {
    const double radius = glm::length(point);
    return radius < planet_m() ? planet_m() / radius * point : point;
  }
  [[nodiscard]] double OpticalDepth(std::size_t band, const AirColumns& columns) const {
    return medium_.rayleigh_scattering_per_m[band] * columns.rayleigh +
           medium_.mie_extinction_per_m[band] * columns.mie +
           medium_.ozone_absorption_per_m[band] * columns.ozone;
  }

  /// Returns the segment from a point inside the shell to the ground or the top.
  [[nodiscard]] Piece PieceFrom(const Vector& origin, const Vector& direction) const;
  [[nodiscard]] DistanceMaps MapsOf(const Piece& piece, int strata) const;
  /// Returns an upper bound of the optical depth of scattering air along a segment, mean over the
  /// wavelengths.
  [[nodiscard]] double MostOpticalDepth(const Piece& piece) const;

  [[nodiscard]] bool Lit(double radius_m, double towards_sun_m) const {
    return towards_sun_m >= 0.0 ||
           radius_m * radius_m - towards_sun_m * towards_sun_m >= planet_m() * planet_m();
  }
  [[nodiscard]] AirColumns ColumnsToSun(double radius_m, double towards_sun_m) const {
    return table_.ToSpace(PerigeeRadius(radius_m * radius_m, towards_sun_m), towards_sun_m);
  }
  /// Returns the columns from the segment's origin to a distance.
  [[nodiscard]] AirColumns ColumnsAlong(const Piece& piece, double distance_m) const;

 private:
  [[nodiscard]] double ShadowRadius() const;
  [[nodiscard]] double FreePath(double radius_m) const;
  [[nodiscard]] double ClimbDistance(double perigee_m, double s_m) const;

  Medium medium_;
  Vector sun_;
  ColumnTable table_;
  double rayleigh_per_m_, mie_per_m_;  // extinction at the ground, mean over the wavelengths
  double shadow_radius_m_;
};

Piece Scene::PieceFrom(const Vector& origin, const Vector& direction) const {
  Piece piece{origin, direction};
  const double radius2 = glm::dot(origin, origin);
  piece.s0_m = glm::dot(origin, direction);
  piece.perigee_m = PerigeeRadius(radius2, piece.s0_m);
  piece.ends_on_ground = piece.s0_m < 0.0 && piece.perigee_m < planet_m();
  const double end = piece.ends_on_ground ? planet_m() : top_m();
  const double half = std::sqrt(std::max((end - piece.perigee_m) * (end + piece.perigee_m), 0.0));
  piece.length_m = std::max((piece.ends_on_ground ? -half : half) - piece.s0_m, 0.0);
  return piece;
}

// Returns the radius of the planet plus the lower air that hardly transmits sunbeams: grazing beams
// above it have an optical depth under 1 in at least one wavelength.
double Scene::ShadowRadius() const {
  double low = planet_m(), high = top_m();
  while (high - low > 10.0) {
    const double middle = 0.5 * (low + high);
    const AirColumns half = table_.ToSpace(middle, 0.0);
    double clearest = std::numeric_limits<double>::infinity();
    for (std::size_t band = 0; band < bands(); ++band)
      clearest = std::min(clearest, 2.0 * OpticalDepth(band, half));
    (clearest > 1.0 ? low : high) = middle;
  }
  return low;
}

double Scene::FreePath(double radius_m) const {
  const double extinction =
      rayleigh_per_m_ * RayleighDensity(radius_m) + mie_per_m_ * MieDensity(radius_m);
  return 1.0 / std::max(extinction, 1e-300);
}

AirColumns Scene::ColumnsAlong(const Piece& piece, double distance_m) const {
  const ColumnTable::Line line = table_.LineAt(piece.perigee_m);
  const double s1 = piece.s0_m + distance_m;
  const AirColumns at_perigee =
      piece.s0_m < 0.0 && s1 > 0.0 ? table_.Primitive(line, 0.0) : AirColumns{};
  return ColumnTable::Difference(piece.s0_m, table_.Primitive(line, piece.s0_m), s1,
                                 table_.Primitive(line, s1), at_perigee);
}

double Scene::MostOpticalDepth(const Piece& piece) const {
  const double nearest = std::clamp(-piece.s0_m, 0.0, piece.length_m);
  return piece.length_m / FreePath(piece.Radius(nearest));
}

// Returns the distance along the line from s outwards over which extinction falls by about a factor
// e.
double Scene::ClimbDistance(double perigee_m, double s_m) const {
  const double s = std::abs(s_m);
  const double r = std::sqrt(perigee_m * perigee_m + s * s);
  const double rayleigh = rayleigh_per_m_ * RayleighDensity(r) + 1e-300;
  const double mie = mie_per_m_ * MieDensity(r);
  const double height =
      (rayleigh * medium_.rayleigh_scale_height_m + mie * medium_.mie_scale_height_m) /
      (rayleigh + mie);
  return std::sqrt(s * s + height * (2.0 * r + height)) - s;
}

/// Interval of distances in which a line is in the planet's shadow; empty unless `end > begin`.
struct Shadow {
  double begin_m = 0.0, end_m = 0.0;
};

// Returns the shadow for importance sampling; lighting is tested point by point.
Shadow ShadowOn(const Piece& piece, const Vector& sun, double shadow_radius_m) {
  const double sun0 = glm::dot(piece.origin, sun);
  const double nu = glm::dot(piece.direction, sun);
  const double a = 1.0 - nu * nu;
  const double b = piece.s0_m - sun0 * nu;
  const double c =
      glm::dot(piece.origin, piece.origin) - sun0 * sun0 - shadow_radius_m * shadow_radius_m;
  const double discriminant = b * b - a * c;
  if (a < 1e-12 || discriminant <= 0.0) return {};
  Shadow shadow{(-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a};
  const double terminator = -sun0 / nu;
  if (nu > 0.0) shadow.end_m = std::min(shadow.end_m, terminator);
  if (nu < 0.0) shadow.begin_m = std::max(shadow.begin_m, terminator);
  if (nu == 0.0 && sun0 >= 0.0) return {};
  return {std::max(shadow.begin_m, 0.0), std::min(shadow.end_m, piece.length_m)};
}

DistanceMaps Scene::MapsOf(const Piece& piece, int strata) const {
  DistanceMaps maps;
  const double length = piece.length_m;
  const double near = FreePath(piece.Radius(0.0));
  if (piece.s0_m >= 0.0) {
    maps.Add(0.0, length, std::min(near, ClimbDistance(piece.perigee_m, piece.s0_m)), false,
             strata);
  } else {
    const double lowest = std::min(-piece.s0_m, length);
    const double scale = ClimbDistance(piece.perigee_m, piece.s0_m + lowest);
    maps.Add(0.0, length, near, false, strata);
    maps.Add(0.0, lowest, scale, true, strata);
    maps.Add(lowest, length, scale, false, strata);
  }
  const Shadow shadow = ShadowOn(piece, sun_, shadow_radius_m_);
  if (!(shadow.begin_m < shadow.end_m)) return maps;
  maps.Add(shadow.end_m, length, ClimbDistance(piece.perigee_m, piece.s0_m + shadow.end_m), false,
           strata);
  if (piece.s0_m + shadow.begin_m < 0.0) {
    maps.Add(0.0, shadow.begin_m, ClimbDistance(piece.perigee_m, piece.s0_m + shadow.begin_m), true,
             strata);
  }
  return maps;
}

/// A right-handed frame around an axis.
struct Frame {
  Vector x, y, z;

  [[nodiscard]] Vector Direction(double cosine, double azimuth) const {
    const double sine = std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0));
    return glm::normalize(sine * std::cos(azimuth) * x + sine * std::sin(azimuth) * y + cosine * z);
  }
};

Frame FrameAround(const Vector& z) {
  const Vector other = std::abs(z.x) < 0.7 ? Vector(1.0, 0.0, 0.0) : Vector(0.0, 1.0, 0.0);
  const Vector x = glm::normalize(glm::cross(other, z));
  return {x, glm::cross(z, x), z};
}

// Returns a frame with x towards the sun's azimuth and z up.
Frame LocalFrame(const Vector& point, const Vector& sun) {
  const Vector z = glm::normalize(point);
  const Vector across = glm::cross(z, sun);
  if (glm::dot(across, across) < 1e-12) return FrameAround(z);
  const Vector y = glm::normalize(across);
  return {glm::cross(y, z), y, z};
}

/// Distribution of directions for the glow of twilight: azimuths by a wrapped Cauchy distribution
/// around the sun's azimuth, elevations dense above the geometric horizon.
class Glow {
 public:
  Glow(const Vector& point, const Vector& sun, double planet_m)
      : frame_(LocalFrame(point, sun)),
        horizon_(-std::sqrt(
            std::max(1.0 - planet_m * planet_m / std::max(glm::dot(point, point), 1.0), 0.0))) {}

  [[nodiscard]] Vector Sample(double u, double v) const {
    const double azimuth =
        2.0 * std::atan((1.0 - kAzimuth) / (1.0 + kAzimuth) * std::tan(kPi * (u - 0.5)));
    const double y = v / (1.0 + kElevation * (1.0 - v));
    return frame_.Direction(horizon_ + (1.0 - horizon_) * y, azimuth);
  }
  [[nodiscard]] double Density(const Vector& direction) const {
    const double mu = glm::dot(direction, frame_.z);
    if (mu < horizon_) return 0.0;
    const double y = (mu - horizon_) / (1.0 - horizon_);
    const double fall = 1.0 + kElevation * y;
    const double sine = std::sqrt(std::max((1.0 - mu) * (1.0 + mu), 1e-30));
    const double cosine = std::clamp(glm::dot(direction, frame_.x) / sine, -1.0, 1.0);
    return (1.0 + kElevation) / (fall * fall * (1.0 - horizon_)) * (1.0 - kAzimuth * kAzimuth) /
           (2.0 * kPi * (1.0 + kAzimuth * kAzimuth - 2.0 * kAzimuth * cosine));
  }

 private:
  static constexpr double kAzimuth = 0.6;
  static constexpr double kElevation = 10.0;
  Frame frame_;
  double horizon_;
};

/// Light gathered by one path, at every wavelength; for polarised light in the order I, Q, U.
struct Gathered {
  std::vector<double> total, single;
};

/// Contribution of sunlight scattered into a segment, per scattering coefficient and unit
/// irradiance [1/sr], in the order of Gathered.
struct Responses {
  std::vector<double> molecules, aerosol;
};

/// The air and the bodies among which paths travel.
struct PathMatter {
  const Scene& scene;
  const PolarisedScattering* polarised = nullptr;  // null: scalar light
  const PathSurroundings* bodies = nullptr;        // null: the planet's sphere alone

  [[nodiscard]] std::vector<double> NoLight() const {
    return std::vector<double>((polarised == nullptr ? 1 : kStokes) * scene.bands(), 0.0);
  }
};

/// Light that is scattered into one direction, at the vertex of a path.
struct Turned {
  double density;             // with which the vertex draws this direction [1/sr]
  std::vector<double> value;  // by band; integrated over directions: scattered light per arriving
  /// Analyser before scattering, by band; empty if the vertex depolarises, or for scalar light.
  std::vector<Analyser> analyser = {};
  Vector reference{};
};

/// Follows paths, one at a time.
class Tracer {
 public:
  Tracer(const PathMatter& matter, int max_order)
      : scene_(matter.scene),
        polarised_(matter.polarised),
        bodies_(matter.bodies),
        max_order_(max_order) {
    weight_.resize(scene_.bands());
  }

  /// Adds `factor` times the light along the segment.
  void Follow(const Piece& first, double factor, PathRandom& random, Gathered& light);

 private:
  class AirTurn;
  class SurfaceTurn;
  class CloudTurn;

  struct Point {
    double distance_m, length_m;  // from the segment's origin; line represented by the point
    double rayleigh, mie;         // relative densities
    AirColumns view;
    double share = 0.0;  // expected scattered light, summed over wavelengths
  };
  /// A path that remains to be followed from a segment.
  struct Branch {
    Piece piece;
    int order;
    std::vector<double> weight;
    std::vector<Analyser> analyser;
    Vector reference{};
    double sun_share = 1.0;  // weight of the sun's light at a cloud at the end of the segment
  };
  struct Copies {
    int count;
    double factor;  // factor of their weights
  };
  static constexpr std::size_t kEnd = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::optional<PathMeeting> MeetingOn(const Piece& piece, PathRandom& random) const;
  [[nodiscard]] PathSurface PlanetAt(const Piece& piece) const;
  void SpreadAmongBodies(const Piece& piece, PathRandom& random);
  void Spread(const Piece& piece, int strata, double jitter);
  [[nodiscard]] Point PointAt(const Piece& piece, double distance_m, double length_m,
                              const AirColumns& view) const;
  void Gather(const Piece& piece, PathRandom& random, std::vector<double>& light);
  void GatherFromAir(const Piece& piece, const Point& point, const Responses& responses,
                     PathRandom& random, std::vector<double>& light) const;
  void GatherFromEnd(const Piece& piece, PathRandom& random, std::vector<double>& light);
  /// Adds sunlight that a body at the end of the segment sends into it.
  /// @param body  its albedo in a band. @param to_view  light it sends per light that arrives [1/sr].
  template <typename Albedo>
  void GatherFromBody(const Piece& piece, const Vector& point, const Albedo& body, double to_view,
                      PathRandom& random, std::vector<double>& light);
  [[nodiscard]] double SunTransmittance(const Vector& point, PathRandom& random) const {
    return bodies_ == nullptr ? 1.0 : bodies_->SunTransmittance(point, random);
  }
  [[nodiscard]] double ExpectedLight(const Piece& piece, double distance_m) const;
  [[nodiscard]] double SumOfShares() const;
  [[nodiscard]] double AureoleAlong(const Piece& piece) const;
  [[nodiscard]] static Copies CopiesOf(double promise, double aureole, double u);
  [[nodiscard]] Piece Continue(const Piece& piece, PathRandom& random, std::vector<double>& light);
  [[nodiscard]] std::size_t Draw(double u) const;
  /// Returns the next segment, from a vertex. @param lobe  see PathSurroundings::SunLobe.
  template <typename Turn>
  [[nodiscard]] Piece GoOn(const Vector& from, const Turn& turn, const PhaseFunction* lobe,
                           const std::array<double, 3>& drawn, PathRandom& random,
                           std::vector<double>& light);
  /// Adds a path in a direction around the sun.
  template <typename Turn>
  void AddSidePath(const Vector& from, const Turn& turn, const SunLobe& lobe, PathRandom& random);
  /// Adds sunlight from a cloud in a direction around the sun.
  template <typename Turn>
  void AddSideRay(const Vector& from, const Turn& turn, const SunLobe& lobe, PathRandom& random,
                  std::vector<double>& light) const;
  [[nodiscard]] Vector AroundSun(double to_sun, PathRandom& random) const {
    return FrameAround(scene_.sun()).Direction(to_sun, 2.0 * kPi * random.Next());
  }
  /// Goes on in a direction. @param lobe  null: no clouds.
  void Take(const Turned& turned, const Vector& direction, const SunLobe* lobe);
  [[nodiscard]] Branch FirstBranch(const Piece& first, double factor) const;
  [[nodiscard]] Responses ResponsesToSun(const Piece& piece) const;
  [[nodiscard]] ScatteringMatrix AerosolMatrix(std::size_t band, double mie_phase,
                                               double cosine) const;

  const Scene& scene_;
  const PolarisedScattering* polarised_;
  const PathSurroundings* bodies_;
  int max_order_;
  int order_ = 1;               // order of the current segment
  std::vector<double> weight_;  // weight of the path so far, for unpolarised light
  // Analyser of polarised light, by band; the first entry of the first row is 1, the other factors
  // are in the weight.
  std::vector<Analyser> analyser_;
  Vector reference_{};
  double sun_share_ = 1.0;
  std::vector<Branch> branches_;
  std::vector<Point> points_;
  std::optional<PathMeeting> end_;  // what the segment ends at; no value: it leaves the air
  bool end_sees_sun_ = false;       // in the sample of the transmittance to the sun
  AirColumns end_view_;
  double end_share_ = 0.0;
  double first_shares_ = 0.0;  // sum of the shares of the first segment
};

void Tracer::Follow(const Piece& first, double factor, PathRandom& random, Gathered& light) {
  branches_.push_back(FirstBranch(first, factor));
  while (!branches_.empty()) {
    Branch branch = std::move(branches_.back());
    branches_.pop_back();
    order_ = branch.order;
    weight_ = branch.weight;
    analyser_ = branch.analyser;
    reference_ = branch.reference;
    sun_share_ = branch.sun_share;
    end_ = MeetingOn(branch.piece, random);
    if (end_) branch.piece.length_m = end_->distance_m;
    if (bodies_ != nullptr) {
      SpreadAmongBodies(branch.piece, random);
    } else {
      Spread(branch.piece, order_ == 1 ? kFirstStrata : kLaterStrata, random.Next());
    }
    Gather(branch.piece, random, order_ == 1 ? light.single : light.total);
    if (order_ == 1) first_shares_ = SumOfShares();
    if (order_ == max_order_ || first_shares_ <= 0.0) continue;
    const Copies copies =
        CopiesOf(SumOfShares() / first_shares_, AureoleAlong(branch.piece), random.Next());
    for (int copy = 0; copy < copies.count; ++copy) {
      for (std::size_t band = 0; band < weight_.size(); ++band)
        weight_[band] = branch.weight[band] * copies.factor;
      analyser_ = branch.analyser;
      reference_ = branch.reference;
      const Piece next = Continue(branch.piece, random, light.total);
      branches_.push_back({next, branch.order + 1, weight_, analyser_, reference_, sun_share_});
    }
  }
}

// Returns the branch along the view. The reference direction is upwards in the vertical plane of
// the view; if the view is along +z or -z, it is the limit for a view tilted slightly towards +x. U
// has the opposite sign: see ViewDirection.
Tracer::Branch Tracer::FirstBranch(const Piece& first, double factor) const {
  Branch branch{first, 1, std::vector<double>(scene_.bands(), factor), {}};
  if (polarised_ == nullptr) return branch;
  const Vector& view = first.direction;
  const double across = std::hypot(view.x, view.y);
  const Vector ahead = across > 0.0 ? Vector(view.x, view.y, 0.0) / across : Vector(1.0, 0.0, 0.0);
  branch.reference = glm::normalize(Vector(0.0, 0.0, across) - view.z * ahead);
  Analyser analyser;
  analyser.row[0][0] = 1.0;
  analyser.row[1][1] = 1.0;
  analyser.row[2][2] = -1.0;
  branch.analyser.assign(scene_.bands(), analyser);
  return branch;
}

std::optional<PathMeeting> Tracer::MeetingOn(const Piece& piece, PathRandom& random) const {
  if (bodies_ != nullptr)
    return bodies_->Meet({piece.origin, piece.direction, piece.length_m, piece.ends_on_ground},
                         random);
  if (!piece.ends_on_ground) return std::nullopt;
  return PathMeeting{piece.length_m, PlanetAt(piece)};
}

PathSurface Tracer::PlanetAt(const Piece& piece) const {
  const Vector normal = glm::normalize(piece.origin + piece.length_m * piece.direction);
  return {scene_.planet_m() * normal, normal, scene_.medium().ground_albedo};
}

double Tracer::ExpectedLight(const Piece& piece, double distance_m) const {
  const double radius = piece.Radius(distance_m);
  const double towards_sun = glm::dot(piece.origin + distance_m * piece.direction, scene_.sun());
  return TwilightFactor(radius - scene_.planet_m(), towards_sun / radius, scene_.planet_m());
}

// Places points along the segment, with columns from its origin.
void Tracer::Spread(const Piece& piece, int strata, double jitter) {
  points_.clear();
  const ColumnTable& table = scene_.table();
  const ColumnTable::Line line = table.LineAt(piece.perigee_m);
  const double s1 = piece.s0_m + piece.length_m;
  const AirColumns at_origin = table.Primitive(line, piece.s0_m);
  const AirColumns at_perigee =
      piece.s0_m < 0.0 && s1 > 0.0 ? table.Primitive(line, 0.0) : AirColumns{};
  const auto columns_to = [&](double s) {
    return ColumnTable::Difference(piece.s0_m, at_origin, s, table.Primitive(line, s), at_perigee);
  };
  const DistanceMaps maps = scene_.MapsOf(piece, strata);
  for (const DistanceMap& map : maps) {
    for (int i = 0; i < map.strata; ++i) {
      const double distance = map.Distance((i + jitter) / map.strata);
      points_.push_back(
          PointAt(piece, distance, maps.Weight(distance), columns_to(piece.s0_m + distance)));
    }
  }
  if (end_) end_view_ = columns_to(s1);
}

Tracer::Point Tracer::PointAt(const Piece& piece, double distance_m, double length_m,
                              const AirColumns& view) const {
  const double radius = piece.Radius(distance_m);
  return {distance_m, length_m, scene_.RayleighDensity(radius), scene_.MieDensity(radius), view};
}

// Places points as Spread() does. Paths in clouds have many short segments, whose air matters little:
// most of them get no point.
void Tracer::SpreadAmongBodies(const Piece& piece, PathRandom& random) {
  const double jitter = random.Next();
  const double probability = scene_.MostOpticalDepth(piece) / kThinAir;
  if (probability >= 1.0) {
    Spread(piece, order_ == 1 ? kFirstStrataAmongBodies : kLaterStrataAmongBodies, jitter);
    return;
  }
  points_.clear();
  if (end_) end_view_ = scene_.ColumnsAlong(piece, piece.length_m);
  if (random.Next() >= probability) return;
  const double distance_m = jitter * piece.length_m;
  points_.push_back(PointAt(piece, distance_m, piece.length_m / probability,
                            scene_.ColumnsAlong(piece, distance_m)));
}

void Tracer::Gather(const Piece& piece, PathRandom& random, std::vector<double>& light) {
  const Medium& medium = scene_.medium();
  const Responses responses = points_.empty() ? Responses{} : ResponsesToSun(piece);
  for (Point& point : points_) {
    for (std::size_t band = 0; band < weight_.size(); ++band) {
      point.share += weight_[band] * point.length_m *
                     (medium.rayleigh_scattering_per_m[band] * point.rayleigh +
                      medium.mie_scattering_per_m[band] * point.mie) *
                     std::exp(-scene_.OpticalDepth(band, point.view));
    }
    point.share *= ExpectedLight(piece, point.distance_m);
    GatherFromAir(piece, point, responses, random, light);
  }
  end_share_ = 0.0;
  if (end_) GatherFromEnd(piece, random, light);
}

Responses Tracer::ResponsesToSun(const Piece& piece) const {
  const std::size_t bands = weight_.size();
  const double nu = std::clamp(glm::dot(piece.direction, scene_.sun()), -1.0, 1.0);
  std::vector<double> mie_phase = MiePhaseValues(scene_.medium(), nu);
  if (polarised_ == nullptr) {
    return {RayleighPhaseValues(scene_.medium(), nu), std::move(mie_phase)};
  }
  const PlaneTurn turn = TurnOf(piece.direction, reference_, scene_.sun());
  Responses responses{std::vector<double>(kStokes * bands), std::vector<double>(kStokes * bands)};
  for (std::size_t band = 0; band < bands; ++band) {
    const Analyser& after = analyser_[band];
    const Analyser molecules =
        Scattered(after, turn, RayleighMatrix(polarised_->depolarisation[band], nu));
    const Analyser aerosol = Scattered(after, turn, AerosolMatrix(band, mie_phase[band], nu));
    for (std::size_t k = 0; k < kStokes; ++k) {
      responses.molecules[k * bands + band] = molecules.row[k][0];
      responses.aerosol[k * bands + band] = aerosol.row[k][0];
    }
  }
  return responses;
}

ScatteringMatrix Tracer::AerosolMatrix(std::size_t band, double mie_phase, double cosine) const {
  const std::vector<SphereRatios>& spheres = polarised_->aerosol;
  if (spheres.empty()) return {.a1 = mie_phase};
  return SphereMatrix(spheres.size() == 1 ? spheres.front() : spheres[band], mie_phase, cosine);
}

// Adds sunlight scattered at one point.
void Tracer::GatherFromAir(const Piece& piece, const Point& point, const Responses& responses,
                           PathRandom& random, std::vector<double>& light) const {
  const Medium& medium = scene_.medium();
  const double radius = std::max(piece.Radius(point.distance_m), scene_.planet_m());
  const Vector place = scene_.Raised(piece.origin + point.distance_m * piece.direction);
  const double towards_sun = glm::dot(place, scene_.sun());
  if (!scene_.Lit(radius, towards_sun)) return;
  const double length_m = point.length_m * SunTransmittance(place, random);
  if (length_m == 0.0) return;
  const AirColumns sun = scene_.ColumnsToSun(radius, towards_sun);
  const AirColumns both{point.view.rayleigh + sun.rayleigh, point.view.mie + sun.mie,
                        point.view.ozone + sun.ozone};
  const std::size_t bands = weight_.size();
  for (std::size_t band = 0; band < bands; ++band) {
    const double transmittance = std::exp(-scene_.OpticalDepth(band, both));
    for (std::size_t k = band; k < light.size(); k += bands) {
      const double scattered =
          medium.rayleigh_scattering_per_m[band] * point.rayleigh * responses.molecules[k] +
          medium.mie_scattering_per_m[band] * point.mie * responses.aerosol[k];
      light[k] += weight_[band] * length_m * scattered * transmittance;
    }
  }
}

// Adds sunlight from the body at the end of the segment.
void Tracer::GatherFromEnd(const Piece& piece, PathRandom& random, std::vector<double>& light) {
  if (const auto* surface = std::get_if<PathSurface>(&end_->body)) {
    const double mu_s = std::clamp(glm::dot(surface->normal, scene_.sun()), 0.0, 1.0);
    GatherFromBody(
        piece, surface->point, [&](std::size_t band) { return surface->albedo[band]; }, mu_s / kPi,
        random, light);
    return;
  }
  const PathScatterer& cloud = std::get<PathScatterer>(end_->body);
  const double nu = glm::dot(piece.direction, scene_.sun());
  GatherFromBody(
      piece, scene_.Raised(piece.origin + piece.length_m * piece.direction),
      [&](std::size_t) { return cloud.albedo; }, sun_share_ * Phase(*cloud.phase, nu), random,
      light);
}

template <typename Albedo>
void Tracer::GatherFromBody(const Piece& piece, const Vector& point, const Albedo& body,
                            double to_view, PathRandom& random, std::vector<double>& light) {
  const double radius = glm::length(point), towards_sun = glm::dot(point, scene_.sun());
  const bool faces = to_view > 0.0 && scene_.Lit(radius, towards_sun);
  const double lit = faces ? to_view * SunTransmittance(point, random) : 0.0;
  end_sees_sun_ = lit > 0.0;
  const AirColumns sun = lit > 0.0 ? scene_.ColumnsToSun(radius, towards_sun) : AirColumns{};
  const double expected = ExpectedLight(piece, piece.length_m);
  for (std::size_t band = 0; band < weight_.size(); ++band) {
    const double sent =
        weight_[band] * body(band) * std::exp(-scene_.OpticalDepth(band, end_view_));
    end_share_ += sent * expected;
    if (!(lit > 0.0)) continue;
    const double radiance = sent * lit * std::exp(-scene_.OpticalDepth(band, sun));
    light[band] += radiance;
    for (std::size_t k = 1; k * weight_.size() < light.size(); ++k)
      light[k * weight_.size() + band] += radiance * analyser_[band].row[k][0];
  }
}

// Draws the point from which the path continues, with probabilities proportional to the shares.
std::size_t Tracer::Draw(double u) const {
  double left = u * SumOfShares() - end_share_;
  if (left < 0.0) return kEnd;
  std::size_t last = kEnd;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i].share <= 0.0) continue;
    last = i;
    left -= points_[i].share;
    if (left < 0.0) break;
  }
  return last;
}

double Tracer::SumOfShares() const {
  double sum = end_share_;
  for (const Point& point : points_) sum += point.share;
  return sum;
}

// Returns how many times as much light as from a mean direction the aerosol, or a cloud at the end in
// sight of the sun, scatters from the sun into the segment, at least 1.
double Tracer::AureoleAlong(const Piece& piece) const {
  const double nu = std::clamp(glm::dot(piece.direction, scene_.sun()), -1.0, 1.0);
  const std::vector<double> phase = MiePhaseValues(scene_.medium(), nu);
  double most = *std::max_element(phase.begin(), phase.end());
  const auto* cloud = end_ ? std::get_if<PathScatterer>(&end_->body) : nullptr;
  if (cloud != nullptr && end_sees_sun_) most = std::max(most, SunLobe(*cloud->phase).Mean(nu));
  return std::max(4.0 * kPi * most, 1.0);
}

// Applies Russian roulette and splitting. Paths towards the sun have small weights, because
// directions there are sampled often; roulette takes them for what they bring.
// @param promise  expected contribution of the segment, relative to that of the first segment, in
//   light of a mean direction.
// @param aureole  light of the segment's direction, relative to the mean.
Tracer::Copies Tracer::CopiesOf(double promise, double aureole, double u) {
  if (promise * aureole < kRouletteShare) {
    const double survival = promise * aureole / kRouletteShare;
    return u < survival ? Copies{1, 1.0 / survival} : Copies{0, 0.0};
  }
  const double count = std::clamp(std::floor(promise / kSplitShare), 1.0, kMostCopies);
  return {static_cast<int>(count), 1.0 / count};
}

/// Weights, in a mixture of directions, of the twilight glow and of the aerosol's lobe around the
/// sun. The result is unbiased for any weights below 1; these values keep the path weights even.
struct Guidance {
  double glow, aureole;
};

// Every guided turn increases the spread of the weights by a factor. At high orders
// (thick air has hundreds) directions are sampled from the phase function only, so that the product
// of all factors is bounded.
Guidance GuidanceAt(const Scene& scene, const Vector& from, int order) {
  constexpr double kGuidedOrders = 3.0;
  const double fade = std::min(kGuidedOrders * kGuidedOrders / std::max(order * order, 1), 1.0);
  const double mu_s = glm::dot(from, scene.sun()) / glm::length(from);
  const double glow = 0.6 * std::clamp((0.05 - mu_s) / 0.1, 0.0, 1.0);
  const double aureole =
      scene.has_aerosol() ? 0.25 * std::clamp((mu_s + 0.15) / 0.1, 0.0, 1.0) : 0.0;
  return {fade * glow, fade * aureole};
}

// Samples a cosine from the mean of the bands' phase functions, weighted by shares that need not be
// normalised.
// @param choice, v  uniform in [0, 1).
double SampleAerosol(const Medium& medium, const std::vector<double>& share, double choice,
                     double v) {
  if (medium.mie_phase.size() == 1) return SampleCosine(medium.mie_phase.front(), v);
  double left = choice * std::accumulate(share.begin(), share.end(), 0.0);
  std::size_t band = 0;
  while (band + 1 < share.size() && left >= share[band]) left -= share[band++];
  return SampleCosine(medium.mie_phase[band], v);
}

// Returns the mean of the values, weighted by the shares.
double MeanBy(const std::vector<double>& share, const std::vector<double>& value) {
  return std::inner_product(share.begin(), share.end(), value.begin(), 0.0) /
         std::accumulate(share.begin(), share.end(), 0.0);
}

/// Sampling of the directions to which paths are guided.
class Guide {
 public:
  /// @param share  of each band in the aerosol's scattering; must outlive the guide.
  Guide(const Scene& scene, const Vector& from, const Guidance& weight,
        const std::vector<double>& share)
      : scene_(scene), weight_(weight), share_(share), glow_(from, scene.sun(), scene.planet_m()) {}

  [[nodiscard]] double Unguided() const { return 1.0 - weight_.glow - weight_.aureole; }

  /// Returns a direction; nullopt for the share Unguided() of choices.
  [[nodiscard]] std::optional<Vector> Sample(double choice, double u, double v) const {
    if (choice < weight_.glow) return glow_.Sample(u, v);
    if (choice >= weight_.glow + weight_.aureole) return std::nullopt;
    const double rest = (choice - weight_.glow) / weight_.aureole;
    return FrameAround(scene_.sun())
        .Direction(SampleAerosol(scene_.medium(), share_, rest, v), 2.0 * kPi * u);
  }

  /// Returns the density of all directions. @param unguided  density of the others, times
  /// Unguided().
  [[nodiscard]] double Density(double unguided, const Vector& direction) const {
    double density = unguided;
    if (weight_.glow > 0.0) density += weight_.glow * glow_.Density(direction);
    if (weight_.aureole > 0.0) {
      const double to_sun = std::clamp(glm::dot(direction, scene_.sun()), -1.0, 1.0);
      density += weight_.aureole * MeanBy(share_, MiePhaseValues(scene_.medium(), to_sun));
    }
    return density;
  }

 private:
  const Scene& scene_;
  Guidance weight_;
  const std::vector<double>& share_;
  Glow glow_;
};

/// Scattering by the air at a point of a segment.
class Tracer::AirTurn {
 public:
  AirTurn(const Tracer& path, const Piece& piece, const Point& point, const Vector& from)
      : path_(path),
        direction_(piece.direction),
        point_(point),
        share_(SharesOf(path, point)),
        guidance_(GuidanceAt(path.scene_, from, path.order_)),
        guide_(path.scene_, from, guidance_, share_) {
    double by_molecules = 0.0, by_aerosol = 0.0;
    for (std::size_t band = 0; band < share_.size(); ++band) {
      by_molecules += path.weight_[band] * Molecules(band);
      by_aerosol += path.weight_[band] * Aerosol(band);
    }
    molecules_ = guide_.Unguided() * by_molecules / (by_molecules + by_aerosol);
    aerosol_ = guide_.Unguided() - molecules_;
  }
  AirTurn(const AirTurn&) = delete;  // the guide refers to share_
  AirTurn& operator=(const AirTurn&) = delete;

  [[nodiscard]] Vector Sample(const std::array<double, 3>& drawn) const {
    const auto [choice, u, v] = drawn;
    if (const std::optional<Vector> guided = guide_.Sample(choice, u, v)) return *guided;
    const double rest = choice - (guidance_.glow + guidance_.aureole + molecules_);
    const double cosine = rest < 0.0
                              ? SampleCosine(kMolecules, v)
                              : SampleAerosol(path_.scene_.medium(), share_, rest / aerosol_, v);
    return FrameAround(direction_).Direction(cosine, 2.0 * kPi * u);
  }

  [[nodiscard]] Turned At(const Vector& direction) const {
    const Medium& medium = path_.scene_.medium();
    const double cosine = std::clamp(glm::dot(direction, direction_), -1.0, 1.0);
    const std::vector<double> mie_phase = MiePhaseValues(medium, cosine);
    const double unguided =
        molecules_ * Phase(kMolecules, cosine) + aerosol_ * MeanBy(share_, mie_phase);
    Turned turned{guide_.Density(unguided, direction), std::vector<double>(share_.size())};
    if (path_.polarised_ != nullptr) {
      AddAnalysers(direction, cosine, mie_phase, turned);
      return turned;
    }
    const std::vector<double> rayleigh_phase = RayleighPhaseValues(medium, cosine);
    for (std::size_t band = 0; band < share_.size(); ++band)
      turned.value[band] = Molecules(band) * rayleigh_phase[band] + Aerosol(band) * mie_phase[band];
    return turned;
  }

 private:
  /// Returns the share of each band in the aerosol's scattering.
  static std::vector<double> SharesOf(const Tracer& path, const Point& point) {
    std::vector<double> share(path.weight_.size());
    double sum = 0.0;
    for (std::size_t band = 0; band < share.size(); ++band) {
      share[band] =
          path.weight_[band] * path.scene_.medium().mie_scattering_per_m[band] * point.mie;
      sum += share[band];
    }
    if (!(sum > 0.0)) std::fill(share.begin(), share.end(), 1.0);
    return share;
  }
  [[nodiscard]] double Molecules(std::size_t band) const {
    return path_.scene_.medium().rayleigh_scattering_per_m[band] * point_.rayleigh;
  }
  [[nodiscard]] double Aerosol(std::size_t band) const {
    return path_.scene_.medium().mie_scattering_per_m[band] * point_.mie;
  }

  // Adds the analysers before the turn; the value is their weight for unpolarised light.
  void AddAnalysers(const Vector& direction, double cosine, const std::vector<double>& mie_phase,
                    Turned& turned) const {
    const PlaneTurn turn = TurnOf(direction_, path_.reference_, direction);
    turned.reference = turn.reference;
    turned.analyser.resize(share_.size());
    for (std::size_t band = 0; band < share_.size(); ++band) {
      const Analyser& after = path_.analyser_[band];
      const Analyser by_molecules =
          Scattered(after, turn, RayleighMatrix(path_.polarised_->depolarisation[band], cosine));
      const Analyser by_aerosol =
          Scattered(after, turn, path_.AerosolMatrix(band, mie_phase[band], cosine));
      Analyser& sum = turned.analyser[band];
      for (std::size_t k = 0; k < kStokes; ++k) {
        for (std::size_t i = 0; i < 4; ++i)
          sum.row[k][i] =
              Molecules(band) * by_molecules.row[k][i] + Aerosol(band) * by_aerosol.row[k][i];
      }
      const double worth = sum.row[0][0];
      if (!(worth > 0.0)) continue;
      turned.value[band] = worth;
      for (auto& row : sum.row) {
        for (double& entry : row) entry /= worth;
      }
    }
  }

  const Tracer& path_;
  Vector direction_;
  const Point& point_;
  std::vector<double> share_;
  Guidance guidance_;
  Guide guide_;
  double molecules_, aerosol_;  // probabilities of unguided directions
};

/// A direction sampled for the irradiance of a plane, and its cosine divided by its probability
/// density.
struct PlaneDirection {
  Vector direction;
  double weight;
};

/// Sampling of the light that arrives at a plane: by the cosine law, the glow of twilight and the
/// aerosol's lobe around the sun. Without the lobe, few paths would find the light of a narrow
/// forward peak, and their mean and its standard error would both be too small.
class PlaneSampling {
 public:
  PlaneSampling(const Scene& scene, const Vector& from, const Vector& normal, int order)
      : normal_(normal),
        share_(scene.bands(), 1.0),
        guide_(scene, from,
               glm::dot(from, normal) > 0.0 ? GuidanceAt(scene, from, order) : Guidance{0.0, 0.0},
               share_) {}
  PlaneSampling(const PlaneSampling&) = delete;  // the guide refers to share_
  PlaneSampling& operator=(const PlaneSampling&) = delete;

  [[nodiscard]] Vector Sample(const std::array<double, 3>& drawn) const {
    const auto [choice, u, v] = drawn;
    return guide_.Sample(choice, u, v)
        .value_or(FrameAround(normal_).Direction(std::sqrt(v), 2.0 * kPi * u));
  }
  [[nodiscard]] double Cosine(const Vector& direction) const {
    return std::max(glm::dot(direction, normal_), 0.0);
  }
  [[nodiscard]] double Density(const Vector& direction) const {
    return guide_.Density(guide_.Unguided() * Cosine(direction) / kPi, direction);
  }
  [[nodiscard]] PlaneDirection Drawn(const std::array<double, 3>& drawn) const {
    const Vector direction = Sample(drawn);
    const double density = Density(direction);
    return {direction, density > 0.0 ? Cosine(direction) / density : 0.0};
  }

 private:
  Vector normal_;
  std::vector<double> share_;
  Guide guide_;
};

/// Reflection by a Lambertian surface.
class Tracer::SurfaceTurn {
 public:
  SurfaceTurn(const Tracer& path, const PathSurface& surface)
      : bands_(path.weight_.size()),
        sampling_(path.scene_, surface.point, surface.normal, path.order_) {}

  [[nodiscard]] Vector Sample(const std::array<double, 3>& drawn) const {
    return sampling_.Sample(drawn);
  }
  [[nodiscard]] Turned At(const Vector& direction) const {
    return {sampling_.Density(direction),
            std::vector<double>(bands_, sampling_.Cosine(direction) / kPi)};
  }

 private:
  std::size_t bands_;
  PlaneSampling sampling_;
};

/// Scattering by a cloud.
class Tracer::CloudTurn {
 public:
  CloudTurn(const Tracer& path, const Vector& direction, const PhaseFunction& phase)
      : bands_(path.weight_.size()), direction_(direction), phase_(phase) {}

  [[nodiscard]] Vector Sample(const std::array<double, 3>& drawn) const {
    return FrameAround(direction_).Direction(SampleCosine(phase_, drawn[2]), 2.0 * kPi * drawn[1]);
  }
  [[nodiscard]] Turned At(const Vector& direction) const {
    const double value = Phase(phase_, glm::dot(direction_, direction));
    return {value, std::vector<double>(bands_, value)};
  }

 private:
  std::size_t bands_;
  Vector direction_;
  const PhaseFunction& phase_;
};

// Returns the next segment: from a point drawn with probability proportional to the shares, in a
// sampled direction.
Piece Tracer::Continue(const Piece& piece, PathRandom& random, std::vector<double>& light) {
  const std::size_t drawn = Draw(random.Next());
  const double choice = random.Next();
  const double u = random.Next();
  const double v = random.Next();
  const std::array<double, 3> numbers{choice, u, v};
  const bool at_end = drawn == kEnd;
  const double probability = (at_end ? end_share_ : points_[drawn].share) / SumOfShares();
  const AirColumns& view = at_end ? end_view_ : points_[drawn].view;
  for (std::size_t band = 0; band < weight_.size(); ++band)
    weight_[band] *= std::exp(-scene_.OpticalDepth(band, view)) / probability;
  const double distance = at_end ? piece.length_m : points_[drawn].distance_m;
  const Vector from = scene_.Raised(piece.origin + distance * piece.direction);
  if (!at_end) {
    for (double& weight : weight_) weight *= points_[drawn].length_m;
    const PhaseFunction* lobe = bodies_ != nullptr ? bodies_->SunLobe(random) : nullptr;
    return GoOn(from, AirTurn(*this, piece, points_[drawn], from), lobe, numbers, random, light);
  }
  if (const auto* surface = std::get_if<PathSurface>(&end_->body)) {
    for (std::size_t band = 0; band < weight_.size(); ++band)
      weight_[band] *= surface->albedo[band];
    const PhaseFunction* lobe = bodies_ != nullptr ? bodies_->SunLobe(random) : nullptr;
    return GoOn(surface->point, SurfaceTurn(*this, *surface), lobe, numbers, random, light);
  }
  const PathScatterer& cloud = std::get<PathScatterer>(end_->body);
  for (double& weight : weight_) weight *= cloud.albedo;
  return GoOn(from, CloudTurn(*this, piece.direction, *cloud.phase), cloud.phase, numbers, random,
              light);
}

template <typename Turn>
Piece Tracer::GoOn(const Vector& from, const Turn& turn, const PhaseFunction* lobe,
                   const std::array<double, 3>& drawn, PathRandom& random,
                   std::vector<double>& light) {
  std::optional<SunLobe> around_sun;
  if (lobe != nullptr) {
    around_sun.emplace(*lobe);
    AddSideRay(from, turn, *around_sun, random, light);
    if (random.Next() < kSidePaths) AddSidePath(from, turn, *around_sun, random);
  }
  const Vector direction = turn.Sample(drawn);
  Take(turn.At(direction), direction, around_sun ? &*around_sun : nullptr);
  return scene_.PieceFrom(from, direction);
}

template <typename Turn>
void Tracer::AddSidePath(const Vector& from, const Turn& turn, const SunLobe& lobe,
                         PathRandom& random) {
  const double to_sun = lobe.DrawnFromMean(random.Next());
  const Vector direction = AroundSun(to_sun, random);
  const Turned turned = turn.At(direction);
  if (!(turned.density > 0.0)) return;
  const std::vector<double> weight = weight_;
  const std::vector<Analyser> analyser = analyser_;
  const Vector reference = reference_;
  Take(turned, direction, &lobe);
  branches_.push_back(
      {scene_.PieceFrom(from, direction), order_ + 1, weight_, analyser_, reference_, sun_share_});
  weight_ = weight;
  analyser_ = analyser;
  reference_ = reference;
}

// A path, its side path and its side ray share what lies in a direction by the balance heuristic.
void Tracer::Take(const Turned& turned, const Vector& direction, const SunLobe* lobe) {
  const double to_sun = glm::dot(direction, scene_.sun());
  const double density = turned.density + (lobe != nullptr ? lobe->OfSidePaths(to_sun) : 0.0);
  for (std::size_t band = 0; band < weight_.size(); ++band)
    weight_[band] *= turned.density > 0.0 ? turned.value[band] / density : 0.0;
  sun_share_ = lobe != nullptr && density > 0.0 ? density / (density + lobe->Peak(to_sun)) : 1.0;
  if (polarised_ == nullptr) return;
  if (!turned.analyser.empty()) {
    analyser_ = turned.analyser;
    reference_ = turned.reference;
    return;
  }
  for (Analyser& analyser : analyser_) {
    for (auto& row : analyser.row) row = {row[0]};  // the vertex depolarises
  }
  reference_ = FrameAround(direction).x;
}

// A side ray ends in the first cloud: see renderer/cloud_light/cloud_path_tracer.h.
template <typename Turn>
void Tracer::AddSideRay(const Vector& from, const Turn& turn, const SunLobe& lobe,
                        PathRandom& random, std::vector<double>& light) const {
  const double to_sun = lobe.DrawnFromPeak(random.Next());
  const Vector direction = AroundSun(to_sun, random);
  const Piece side = scene_.PieceFrom(from, direction);
  const std::optional<PathMeeting> meeting = MeetingOn(side, random);
  const auto* cloud = meeting ? std::get_if<PathScatterer>(&meeting->body) : nullptr;
  if (cloud == nullptr) return;
  const Vector point = scene_.Raised(from + meeting->distance_m * direction);
  const double radius = glm::length(point), towards_sun = glm::dot(point, scene_.sun());
  if (!scene_.Lit(radius, towards_sun)) return;
  const double visible = SunTransmittance(point, random);
  if (visible == 0.0) return;
  const Turned turned = turn.At(direction);
  const double density = turned.density + lobe.OfSidePaths(to_sun) + lobe.Peak(to_sun);
  const double sent = cloud->albedo * Phase(*cloud->phase, to_sun) * visible / density;
  const AirColumns view = scene_.ColumnsAlong(side, meeting->distance_m);
  const AirColumns sun = scene_.ColumnsToSun(radius, towards_sun);
  const std::size_t bands = weight_.size();
  for (std::size_t band = 0; band < bands; ++band) {
    const double radiance =
        weight_[band] * turned.value[band] * sent *
        std::exp(-scene_.OpticalDepth(band, view) - scene_.OpticalDepth(band, sun));
    light[band] += radiance;
    const std::vector<Analyser>& analyser = turned.analyser.empty() ? analyser_ : turned.analyser;
    for (std::size_t k = 1; k * bands < light.size(); ++k)
      light[k * bands + band] += radiance * analyser[band].row[k][0];
  }
}

/// Means over batches and their standard errors.
struct Estimate {  // in the order of Gathered
  std::vector<double> total, single, total_error, single_error;
  std::size_t paths = 0;
  bool converged = false;
};

struct Statistics {
  std::vector<double> mean, error;
};

Statistics StatisticsOf(const std::vector<Gathered>& batches,
                        std::vector<double> Gathered::*quantity) {
  const double count = static_cast<double>(batches.size());
  const std::size_t values = (batches.front().*quantity).size();
  Statistics result{std::vector<double>(values, 0.0), std::vector<double>(values, 0.0)};
  for (const Gathered& batch : batches) {
    for (std::size_t k = 0; k < values; ++k) result.mean[k] += (batch.*quantity)[k] / count;
  }
  for (const Gathered& batch : batches) {
    for (std::size_t k = 0; k < values; ++k) {
      const double difference = (batch.*quantity)[k] - result.mean[k];
      result.error[k] += difference * difference / (count * (count - 1.0));
    }
  }
  for (double& error : result.error) error = std::sqrt(error);
  return result;
}

Estimate EstimateOf(const std::vector<Gathered>& batches) {
  Statistics total = StatisticsOf(batches, &Gathered::total);
  Statistics single = StatisticsOf(batches, &Gathered::single);
  return {std::move(total.mean), std::move(single.mean), std::move(total.error),
          std::move(single.error), batches.size() * kPathsPerBatch};
}

// Returns the largest relative error of the radiance over all wavelengths with non-zero radiance.
double WorstError(const Estimate& estimate, std::size_t bands) {
  double worst = 0.0;
  for (std::size_t band = 0; band < bands; ++band) {
    if (estimate.total[band] > 0.0)
      worst = std::max(worst, estimate.total_error[band] / estimate.total[band]);
  }
  return worst;
}

// Follows batches of paths until the error is small enough. `follow` follows one path.
template <typename FollowPath>
Estimate Run(const PathMatter& matter, const PathOptions& options, const FollowPath& follow) {
  constexpr std::size_t kFirstBatches = 32;
  const std::size_t most =
      std::max((options.max_paths + kPathsPerBatch - 1) / kPathsPerBatch, kFirstBatches);
  const std::vector<double> zeros = matter.NoLight();
  std::vector<Gathered> batches;
  for (std::size_t wanted = kFirstBatches;;) {
    const std::size_t done = batches.size();
    batches.resize(wanted);
    tbb::parallel_for(done, wanted, [&](std::size_t batch) {
      if (options.stopped()) return;
      Tracer tracer(matter, options.max_order);
      Gathered sum{zeros, zeros};
      for (std::size_t path = 0; path < kPathsPerBatch; ++path) {
        PathRandom random(options.seed, batch, path);
        follow(tracer, random, sum);
      }
      for (std::size_t k = 0; k < zeros.size(); ++k) {
        sum.single[k] /= kPathsPerBatch;
        sum.total[k] = sum.total[k] / kPathsPerBatch + sum.single[k];
      }
      batches[batch] = std::move(sum);
    });
    if (options.stopped()) return {zeros, zeros, zeros, zeros, 0, false};
    Estimate estimate = EstimateOf(batches);
    const double worst = WorstError(estimate, matter.scene.bands());
    estimate.converged = worst <= options.relative_error;
    if (estimate.converged || wanted == most) return estimate;
    const double ratio = worst / std::max(options.relative_error, 1e-9);
    const double growth = std::clamp(1.1 * ratio * ratio, 1.25, 4.0);
    wanted =
        std::min(most, static_cast<std::size_t>(std::ceil(static_cast<double>(wanted) * growth)));
  }
}

void RequireValid(const PathOptions& options) {
  if (options.max_order < 1) {
    throw InputError(fmt::format("max_order is {}; it must be 1 or more", options.max_order));
  }
  if (!(options.relative_error >= 0.0)) {
    throw InputError(
        fmt::format("relative_error is {}; it must be 0 or more", options.relative_error));
  }
}

void RequireValid(const PolarisedScattering& scattering, std::size_t bands) {
  if (scattering.depolarisation.size() != bands) {
    throw InputError(fmt::format("depolarisation has {} values; {} wavelengths need one each",
                                 scattering.depolarisation.size(), bands));
  }
  for (const double value : scattering.depolarisation)
    RequireInRange(value, 0.0, kLargestDepolarisation, "depolarisation");
  const std::size_t aerosols = scattering.aerosol.size();
  if (aerosols > 1 && aerosols != bands) {
    throw InputError(
        fmt::format("aerosol has {} matrices; it must have none, one or {}", aerosols, bands));
  }
  for (const SphereRatios& ratios : scattering.aerosol) {
    const std::size_t angles = ratios.a3.size();
    if (angles < 2 || ratios.b1.size() != angles || ratios.b2.size() != angles)
      throw InputError("aerosol has a matrix with fewer than 2 angles, or not the same for all");
  }
}

Vector SunDirection(double mu_s) {
  return {std::sqrt(std::max((1.0 - mu_s) * (1.0 + mu_s), 0.0)), 0.0, mu_s};
}

// Returns the view direction from its zenith and scattering angles; the sun is in the plane of x
// and not to the left of the view.
Vector ViewDirection(const ViewRay& ray) {
  const double sine = std::sqrt(std::max((1.0 - ray.mu) * (1.0 + ray.mu), 0.0));
  const double sun_sine = std::sqrt(std::max((1.0 - ray.mu_s) * (1.0 + ray.mu_s), 0.0));
  const double product = sine * sun_sine;
  const double cosine =
      product > 0.0 ? std::clamp((ray.nu - ray.mu * ray.mu_s) / product, -1.0, 1.0) : 1.0;
  const double across = std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0));
  return {sine * cosine, sine * across, ray.mu};
}

// Returns the part of the view ray inside the shell.
Piece ViewPiece(const Medium& medium, const ViewRay& ray, const RayExtent& extent) {
  Piece piece;
  const double radius = medium.planet_radius_m + StartAltitude(ray, medium.planet_radius_m);
  piece.direction = ViewDirection(ray);
  piece.origin = Vector(0.0, 0.0, radius) + extent.begin_m * piece.direction;
  piece.perigee_m = radius * std::sqrt(std::max((1.0 - ray.mu) * (1.0 + ray.mu), 0.0));
  piece.s0_m = radius * ray.mu + extent.begin_m;
  piece.length_m = extent.end_m - extent.begin_m;
  piece.ends_on_ground = BringsLightOfGround(ray, extent);
  return piece;
}

}  // namespace

PolarisedScattering ScatteringOf(const Medium& medium) {
  PolarisedScattering scattering;
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band)
    scattering.depolarisation.push_back(Depolarisation(medium, band));
  return scattering;
}

PathTracedRadiance TraceRadiance(const Medium& medium, const ViewRay& ray,
                                 const PathOptions& options) {
  Validate(medium);
  if (medium.polarised) return TraceStokes(medium, ScatteringOf(medium), ray, options).i;
  RequireValid(options);
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const Scene scene(medium, SunDirection(ray.mu_s));
  const Piece piece = ViewPiece(medium, ray, extent);
  Estimate estimate =
      Run({scene}, options, [&](Tracer& tracer, PathRandom& random, Gathered& light) {
        tracer.Follow(piece, 1.0, random, light);
      });
  return {std::move(estimate.total),
          std::move(estimate.single),
          std::move(estimate.total_error),
          std::move(estimate.single_error),
          estimate.paths,
          estimate.converged};
}

PathTracedStokes TraceStokes(const Medium& medium, const PolarisedScattering& scattering,
                             const ViewRay& ray, const PathOptions& options) {
  Validate(medium);
  RequireValid(options);
  RequireValid(scattering, medium.wavelengths_nm.size());
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const Scene scene(medium, SunDirection(ray.mu_s));
  const Piece piece = ViewPiece(medium, ray, extent);
  const Estimate estimate =
      Run({scene, &scattering}, options, [&](Tracer& tracer, PathRandom& random, Gathered& light) {
        tracer.Follow(piece, 1.0, random, light);
      });
  const auto part = [&](std::size_t k) {
    const auto of = [&](const std::vector<double>& values) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(k * scene.bands());
      return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(scene.bands()));
    };
    return PathTracedRadiance{of(estimate.total),       of(estimate.single),
                              of(estimate.total_error), of(estimate.single_error),
                              estimate.paths,           estimate.converged};
  };
  return {part(0), part(1), part(2)};
}

PathTracedIrradiance TraceIrradiance(const Medium& medium, double altitude_m, double mu_s,
                                     PlaneSide side, const PathOptions& options) {
  Validate(medium);
  RequireValid(options);
  RequireInRange(altitude_m, 0.0, medium.atmosphere_height_m, "altitude_m");
  RequireInRange(mu_s, -1.0, 1.0, "mu_s (cosine of the sun zenith angle)");
  const Scene scene(medium, SunDirection(mu_s));
  const Vector from(0.0, 0.0, medium.planet_radius_m + altitude_m);
  const Vector normal(0.0, 0.0, side == PlaneSide::kFromAbove ? 1.0 : -1.0);
  const PolarisedScattering polarised = ScatteringOf(medium);
  Estimate estimate = Run(
      {scene, medium.polarised ? &polarised : nullptr}, options,
      [&](Tracer& tracer, PathRandom& random, Gathered& light) {
        const double choice = random.Next();
        const double u = random.Next();
        const double v = random.Next();
        const PlaneDirection drawn = PlaneSampling(scene, from, normal, 0).Drawn({choice, u, v});
        if (drawn.weight <= 0.0) return;
        tracer.Follow(scene.PieceFrom(from, drawn.direction), drawn.weight, random, light);
      });
  estimate.total.resize(scene.bands());  // Q and U are not defined for irradiance
  estimate.total_error.resize(scene.bands());
  return {std::move(estimate.total), std::move(estimate.total_error), estimate.paths,
          estimate.converged};
}

struct AirPathTracer::State {
  State(const Medium& medium, const Vector& to_sun, const PathSurroundings* surroundings)
      : scene(medium, to_sun), polarised(ScatteringOf(medium)), bodies(surroundings) {}

  [[nodiscard]] PathMatter matter() const {
    return {scene, scene.medium().polarised ? &polarised : nullptr, bodies};
  }
  /// Returns the part of a ray inside the shell from its origin on; no value for a ray outside.
  [[nodiscard]] std::optional<Piece> PieceOf(const Vector& origin, const Vector& direction) const {
    const double s = glm::dot(origin, direction), radius2 = glm::dot(origin, origin);
    const double top2 = scene.top_m() * scene.top_m();
    if (radius2 <= top2) return scene.PieceFrom(origin, direction);
    const double half2 = top2 - (radius2 - s * s);
    if (s >= 0.0 || half2 <= 0.0) return std::nullopt;
    return scene.PieceFrom(origin - (s + std::sqrt(half2)) * direction, direction);
  }

  Scene scene;
  PolarisedScattering polarised;
  const PathSurroundings* bodies;
};

AirPathTracer::AirPathTracer(const Medium& medium, const glm::dvec3& to_sun,
                             const PathSurroundings* surroundings) {
  Validate(medium);
  if (!(std::abs(glm::length(to_sun) - 1.0) <= 1e-6)) {
    throw InputError(
        fmt::format("the direction to the sun has the length {}; it must be a unit vector",
                    glm::length(to_sun)));
  }
  state_ = std::make_unique<const State>(medium, to_sun, surroundings);
}
AirPathTracer::~AirPathTracer() = default;

std::size_t AirPathTracer::bands() const { return state_->scene.bands(); }

std::vector<double> AirPathTracer::OnePath(const glm::dvec3& origin, const glm::dvec3& direction,
                                           PathRandom& random, int max_order) const {
  const PathMatter matter = state_->matter();
  Gathered light{matter.NoLight(), matter.NoLight()};
  if (const std::optional<Piece> piece = state_->PieceOf(origin, direction))
    Tracer(matter, max_order).Follow(*piece, 1.0, random, light);
  for (std::size_t band = 0; band < bands(); ++band) light.total[band] += light.single[band];
  light.total.resize(bands());  // I of the Stokes parameters
  return light.total;
}

PathTracedRadiance AirPathTracer::Radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                           const PathOptions& options) const {
  RequireValid(options);
  const std::optional<Piece> piece = state_->PieceOf(origin, direction);
  Estimate estimate =
      Run(state_->matter(), options, [&](Tracer& tracer, PathRandom& random, Gathered& light) {
        if (piece) tracer.Follow(*piece, 1.0, random, light);
      });
  for (auto* values :
       {&estimate.total, &estimate.single, &estimate.total_error, &estimate.single_error})
    values->resize(bands());  // I of the Stokes parameters
  return {std::move(estimate.total),
          std::move(estimate.single),
          std::move(estimate.total_error),
          std::move(estimate.single_error),
          estimate.paths,
          estimate.converged};
}

}  // namespace alpenglow::atmosphere::reference
