// SPDX-License-Identifier: MIT
// A map of the light that a sun near the horizon leaves on its way through a periodic field.
//
// Beams of the sun (cloud_low_sun.h) are parabolas of one shape, because the sun is higher by s / R
// for points that are nearer to it by s. Upright planes stand across the beams, at equal distances d
// along the ground. The map holds the transmittance of the rest of each beam from every plane on, for
// beams side by side and above each other:
//
//   T(m, k, l) = exp(-(optical depth of beam (k, l) from plane m to the sun))
//
// The place of beam (k, l) along plane m is shifted with m, so that beams have the azimuth of the sun,
// and its altitude is l h + m d (a + m d / (2 R)). A beam is followed once, from where it leaves the
// layer backwards, and is never interpolated on its way. Where it is opaque, it ends.
//
// The field repeats but beams do not: after each period they are steeper by the period over R. Planes
// are therefore counted on, and a round is the planes of one period. A point finds its slope between
// those of two rounds on the plane ahead of it, 0.003 apart for a period of 20 km, a third of the
// disk of the sun; longer periods have several rounds with different slopes a each. Between rounds and
// between the four beams around a point values are linear: edges of shadows are blurred by a cell of
// 50 m. From clouds 5 km away the disk of the sun blurs them by 46 m. Rows of beams are closer in a
// thin layer, of which beams near the horizon see the edge; cells are wider in thin cloud.
//
// Transmittance() is linear in T, so that its mean is kept. OpticalDepth() is for points in clouds,
// whose light depends on the medium without forward peak, with less than half of the extinction: it
// is linear in the root of T. Both follow a beam in the field to the first plane that is 150 m away
// or more, in steps of 5 m times 1.15^n up to 40 m. TransmittanceAround(), for shafts far from the
// eye, is linear between the planes behind and ahead of a point instead. Periods below 100 m
// count as several: a round for each of them would be many alike.
//
// The map reaches around the place for 0.8 times the distance at which an eye on the ground can see
// the field. Beams of points further away, and those that enter the layer steeper than all these,
// are followed by CloudLowSun. Points from where the planet hides the sun have the light of a sun 1.7
// degrees below their horizon.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "renderer/cloud_light/cloud_low_sun.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

struct CloudLowSunMapOptions {
  double cell_m = 50.0;    // distance between beams, in [5, 1000]; up to twice as far in thin cloud
  double plane_m = 400.0;  // distance between planes, about, in [50, 2000]
};

/// Immutable; safe to use from many threads. The field must outlive it.
class CloudLowSunMap {
 public:
  /// Follows the beams with as many threads as are free; the result does not depend on their number.
  /// Throws InputError for options out of range.
  /// @param field  periodic, with the beams of `sun`.
  CloudLowSunMap(const CloudField& field, const CloudLowSun& sun,
                 const CloudLowSunMapOptions& options = {});

  /// Returns the memory that the map of a field takes [bytes], without making it. Throws InputError as
  /// the constructor does.
  [[nodiscard]] static double BytesFor(const CloudField& field, const CloudLowSun& sun,
                                       const CloudLowSunMapOptions& options = {});

  [[nodiscard]] const CloudLowSun& sun() const { return sun_; }

  /// Returns the optical depth from a point in a cloud to the sun, at most CloudLowSun::kDeepest. At
  /// points of cumulus the root mean square error of transmittances is below 0.03, and the mean of
  /// their roots is within 5 % of that of the beams.
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point) const {
    return OpticalDepth(point, sun_.SlopeAt(point));
  }
  /// Returns the transmittance from a point in clear air or on the ground to the sun. Its mean over a
  /// plane is within 1 % of that of the beams.
  [[nodiscard]] double Transmittance(const glm::dvec3& point) const {
    return Transmittance(point, sun_.SlopeAt(point));
  }
  /// Returns the same as a mean around a point; within 2 %.
  [[nodiscard]] double TransmittanceAround(const glm::dvec3& point) const;
  /// Return both as if the sun were as high as over the place, so that a periodic field has periodic
  /// light.
  [[nodiscard]] double OpticalDepthAsAtPlace(const glm::dvec3& point) const {
    return OpticalDepth(point, sun_.slope());
  }
  [[nodiscard]] double TransmittanceAsAtPlace(const glm::dvec3& point) const {
    return Transmittance(point, sun_.slope());
  }

  /// Returns the memory of the map [bytes].
  [[nodiscard]] std::size_t bytes() const {
    return slices_.size() * sizeof(Slice) + value_.size() * sizeof(std::uint16_t);
  }
  /// Returns a hash of the map (FNV-1a, 64 bits).
  [[nodiscard]] std::uint64_t hash() const;

 private:
  enum class Mean { kOfLight, kOfRoots };
  /// A plane in one round.
  struct Slice {
    double slope;      // of the beams
    double across_m;   // place of beams k = 0 along the plane
    double low_m;      // altitude of the lowest row of beams
    std::int64_t row;  // its l
  };
  struct Unmade {};
  /// Chooses the planes, beams and rounds of a map without their values.
  CloudLowSunMap(const CloudField& field, const CloudLowSun& sun,
                 const CloudLowSunMapOptions& options, Unmade);
  void ChooseRounds();
  void MakeSlices();
  [[nodiscard]] double LowestRow_m() const;
  /// Follows the beams of one slope a and some columns from the last slice to the first one.
  void Fill(int chain, std::size_t first, std::size_t end);
  /// Adds the optical depths from a slice to the next one to those of a row of beams.
  void AddArcs(std::size_t slice_number, std::size_t row, std::span<float> depth,
               std::size_t first) const;

  [[nodiscard]] bool Holds(double slope) const { return slope >= flattest_ && slope <= steepest_; }
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point, double slope) const;
  [[nodiscard]] double Transmittance(const glm::dvec3& point, double slope) const;
  [[nodiscard]] double DepthFrom(const glm::dvec3& point, double slope, Mean mean) const;
  [[nodiscard]] double DepthOf(const CloudBeam& beam, const CloudBeam::Part& part, Mean mean) const;
  [[nodiscard]] double NearDepth(const CloudBeam& beam, double end_m) const;
  /// Returns the number of planes between the origin of the field and a point.
  [[nodiscard]] double PlanesBefore(const glm::dvec3& point) const;
  /// Returns the transmittance of a beam from a plane on, which it crosses at a distance, or its root.
  [[nodiscard]] float RestFrom(const CloudBeam& beam, std::int64_t plane, double distance_m,
                               Mean mean) const;
  [[nodiscard]] float OnSlice(std::size_t number, const glm::dvec3& point, Mean mean) const;

  CloudField field_;
  CloudLowSun sun_;
  int along_ = 0, across_ = 1;  // the axis most nearly along the beams, and the other one
  int planes_ = 1;              // of a period
  int chains_ = 1;              // rounds by which a beam is steeper after a period
  double distance_m_ = 0.0;     // d
  double cell_m_ = 0.0, row_m_ = 0.0;
  std::size_t columns_ = 0, rows_ = 0;
  double flattest_ = 1.0, steepest_ = 0.0;  // slopes of points within reach: none in an open field
  double hidden_ = -1.0;                    // slope where the planet hides the sun
  double margin_m_ = 0.0;                   // of rows above and below the layer
  double entering_ = 0.0;                   // the steepest beam that enters the layer
  double round_ = 1.0;                      // difference of slopes of rounds
  int first_round_ = 0, rounds_ = 0;
  std::vector<Slice> slices_;         // rounds_ times planes_
  std::vector<std::uint16_t> value_;  // columns first, then rows and slices
};

}  // namespace alpenglow::renderer
