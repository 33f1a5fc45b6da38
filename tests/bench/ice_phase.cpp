// SPDX-License-Identifier: MIT
// Computes the phase functions of ice crystals in renderer/data:
//
//   ice_phase > renderer/data/ice_phase.csv
//
// Half of the light that crystals much larger than the wavelength scatter is diffracted, and half is
// reflected and refracted. The second half is traced by geometric optics through hexagonal prisms in
// random orientation (Wendling, Wendling and Weickmann 1979, Appl. Opt. 18, 2663), with Fresnel's
// formulas for unpolarised light at every facet. Facets of rough crystals are tilted at random at
// every facet that a ray meets, by slopes of Gaussian distribution with the variance s^2 / 2 (Yang
// and Liou 1998, Contr. Atmos. Phys. 71, 223); s = 0.5 are the severely rough crystals of Yang et al.
// (2013), J. Atmos. Sci. 70, 330. The mixture is 30 % smooth crystals by extinction, columns and
// plates, and 70 % severely rough ones. Forster and Mayer (2022), Atmos. Chem. Phys. 22, 15179, find
// the 22-degree halo with such fractions.
//
// Diffraction is that of discs with the areas of the crystals' shadows, whose sizes have the gamma
// distribution of variance 1/4. The refracted rays are spread by diffraction at the facets, by a
// Gaussian with the standard deviation 0.41 wavelength / width, which is that of the central lobe of
// a slit; small crystals have a softer halo for this reason (Mishchenko and Macke 1999, Appl. Opt. 38,
// 1626). Refractive indices: Warren and Brandt (2008), J. Geophys. Res. 113, D14220.
#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <random>
#include <vector>

#include "atmosphere/math/constants.h"

namespace {

using namespace alpenglow::atmosphere;

struct Band {
  double wavelength_nm, index;
};
constexpr std::array kBands{Band{400.0, 1.3194}, Band{450.0, 1.3157}, Band{500.0, 1.3130},
                            Band{550.0, 1.3110}, Band{600.0, 1.3094}, Band{700.0, 1.3069}};
constexpr std::array kRadii_um{10.0, 20.0, 40.0, 80.0};
constexpr std::size_t kColumns = kBands.size() * kRadii_um.size();

/// Crystals of one form.
struct Habit {
  double length_over_width;  // of the prism; the width is that across two corners
  double roughness;          // s
  double fraction;           // of the extinction
};
// No surface is smooth to better than 0.1 degrees here, so that rays through parallel facets do not
// all leave in exactly the direction in which they came.
constexpr double kSmooth = 0.002, kRough = 0.5;
constexpr std::array kHabits{Habit{2.5, kSmooth, 0.2}, Habit{0.2, kSmooth, 0.1},
                             Habit{1.0, kRough, 0.35}, Habit{2.5, kRough, 0.2},
                             Habit{0.3, kRough, 0.15}};
constexpr std::size_t kChunks = 256, kRaysPerChunk = 12000;

/// Returns the angles of the table: dense in the forward peak and at the halos.
std::vector<double> Angles_deg() {
  std::vector<double> angles;
  constexpr int kForward = 110;
  for (int i = 0; i < kForward; ++i) angles.push_back(18.0 * std::pow(double(i) / kForward, 3));
  for (int i = 0; i < 64; ++i) angles.push_back(18.0 + 0.125 * i);
  for (int i = 0; i < 36; ++i) angles.push_back(26.0 + 0.5 * i);
  for (int i = 0; i < 24; ++i) angles.push_back(44.0 + 0.25 * i);
  for (int i = 50; i < 176; ++i) angles.push_back(i);
  for (int i = 0; i <= 8; ++i) angles.push_back(176.0 + 0.5 * i);
  return angles;
}

/// A plane of a crystal: normal . p <= distance inside.
struct Facet {
  glm::dvec3 normal;
  double distance;
};

/// A hexagonal prism of width 2.
class Prism {
 public:
  explicit Prism(double length_over_width) : half_length_(length_over_width) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double turn = (static_cast<double>(i) + 0.5) * kPi / 3.0;
      facets_[i] = {{std::cos(turn), std::sin(turn), 0.0}, 0.5 * std::sqrt(3.0)};
    }
    facets_[6] = {{0.0, 0.0, 1.0}, half_length_};
    facets_[7] = {{0.0, 0.0, -1.0}, half_length_};
  }

  [[nodiscard]] double BoundingRadius() const { return std::hypot(1.0, half_length_); }
  [[nodiscard]] double Volume() const { return 1.5 * std::sqrt(3.0) * 2.0 * half_length_; }
  /// Returns the mean area of the shadow, a quarter of the surface (Cauchy's theorem).
  [[nodiscard]] double ShadowArea() const {
    return 0.25 * (3.0 * std::sqrt(3.0) + 12.0 * half_length_);
  }
  [[nodiscard]] double EffectiveRadius() const { return 0.75 * Volume() / ShadowArea(); }
  /// Returns the width of the narrower of facets and caps.
  [[nodiscard]] double FacetWidth() const { return std::min(1.0, 2.0 * half_length_); }

  struct Hit {
    double distance;
    const Facet* facet;
  };
  /// Returns where a line from outside enters; nothing if it misses.
  [[nodiscard]] std::optional<Hit> Entry(const glm::dvec3& from, const glm::dvec3& along) const {
    Hit entry{-1e9, nullptr};
    double exit = 1e9;
    for (const Facet& facet : facets_) {
      const double speed = glm::dot(facet.normal, along);
      const double distance = (facet.distance - glm::dot(facet.normal, from)) / speed;
      if (speed > 0.0) {
        exit = std::min(exit, distance);
      } else if (distance > entry.distance) {
        entry = {distance, &facet};
      }
    }
    if (!entry.facet || entry.distance >= exit) return std::nullopt;
    return entry;
  }
  /// Returns where a line from inside leaves.
  [[nodiscard]] Hit Exit(const glm::dvec3& from, const glm::dvec3& along) const {
    Hit exit{1e9, &facets_[0]};
    for (const Facet& facet : facets_) {
      const double speed = glm::dot(facet.normal, along);
      if (speed <= 1e-12) continue;
      const double distance = (facet.distance - glm::dot(facet.normal, from)) / speed;
      if (distance < exit.distance) exit = {distance, &facet};
    }
    return {std::max(exit.distance, 0.0), exit.facet};
  }

 private:
  double half_length_;
  std::array<Facet, 8> facets_;
};

/// A direction after a facet.
struct Refraction {
  double reflectance;
  glm::dvec3 refracted;  // meaningless if all light is reflected
};
/// @param normal  against the incident direction. @param ratio  index before over index behind.
Refraction RefractionAt(const glm::dvec3& along, const glm::dvec3& normal, double ratio) {
  const double before = -glm::dot(along, normal);
  const double square = 1.0 - ratio * ratio * (1.0 - before * before);
  if (square <= 0.0) return {1.0, along};
  const double behind = std::sqrt(square);
  const double across = (ratio * before - behind) / (ratio * before + behind);
  const double inplane = (before - ratio * behind) / (before + ratio * behind);
  return {0.5 * (across * across + inplane * inplane),
          glm::normalize(ratio * along + (ratio * before - behind) * normal)};
}

using Random = std::mt19937_64;

glm::dvec3 RandomDirection(Random& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double z = uniform(random), turn = kPi * uniform(random);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

/// Two unit vectors across a direction.
struct Across {
  glm::dvec3 u, v;
};
Across AcrossOf(const glm::dvec3& along) {
  const glm::dvec3 other = std::abs(along.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(along, other));
  return {u, glm::cross(along, u)};
}

/// Returns a tilt across a direction, by two slopes of standard deviation 1.
glm::dvec3 TiltAcross(const glm::dvec3& along, Random& random) {
  std::normal_distribution<double> slope;
  const Across across = AcrossOf(along);
  const double a = slope(random), b = slope(random);
  return a * across.u + b * across.v;
}

/// Returns a normal tilted by roughness, still against the incident direction.
glm::dvec3 RoughNormal(const glm::dvec3& normal, const glm::dvec3& along, double roughness,
                       Random& random) {
  for (int attempt = 0; attempt < 30; ++attempt) {
    const glm::dvec3 tilted =
        glm::normalize(normal + roughness / std::sqrt(2.0) * TiltAcross(normal, random));
    if (glm::dot(tilted, along) < -1e-3) return tilted;
  }
  return normal;
}

/// Light by scattering angle, shared between neighbouring angles of the table.
class AngleSums {
 public:
  explicit AngleSums(const std::vector<double>& angles_deg) : angles_(&angles_deg) {
    sums_.resize(angles_deg.size());
  }
  void Add(double cosine, double light) {
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / kRadiansPerDegree;
    const auto next = std::upper_bound(angles_->begin() + 1, angles_->end() - 1, angle);
    const auto i = static_cast<std::size_t>(next - angles_->begin());
    const double share =
        std::clamp((angle - (*angles_)[i - 1]) / ((*angles_)[i] - (*angles_)[i - 1]), 0.0, 1.0);
    sums_[i - 1] += (1.0 - share) * light;
    sums_[i] += share * light;
  }
  void Add(const AngleSums& other) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
  }
  /// Returns the light per solid angle, for unit light in all. The solid angle of a node is that of
  /// its two neighbours' intervals, weighted by its share of them.
  [[nodiscard]] std::vector<double> PerSteradian() const {
    double all = 0.0;
    for (const double sum : sums_) all += sum;
    std::vector<double> solid(sums_.size(), 0.0);
    for (std::size_t i = 1; i < sums_.size(); ++i) {
      const double low = (*angles_)[i - 1] * kRadiansPerDegree,
                   high = (*angles_)[i] * kRadiansPerDegree;
      constexpr int kParts = 16;
      for (int part = 0; part < kParts; ++part) {
        const double share = (part + 0.5) / kParts;
        const double piece =
            2.0 * kPi * (high - low) / kParts * std::sin(low + share * (high - low));
        solid[i - 1] += (1.0 - share) * piece;
        solid[i] += share * piece;
      }
    }
    std::vector<double> values;
    for (std::size_t i = 0; i < sums_.size(); ++i) values.push_back(sums_[i] / all / solid[i]);
    return values;
  }

 private:
  const std::vector<double>* angles_;
  std::vector<double> sums_;
};

/// Follows one ray through a crystal and adds all light that leaves it.
template <typename Leave>
void FollowRay(const Prism& prism, double index, double roughness, const glm::dvec3& from,
               const glm::dvec3& along, Random& random, const Leave& leave) {
  const auto entry = prism.Entry(from, along);
  if (!entry) return;
  const glm::dvec3 outer = RoughNormal(entry->facet->normal, along, roughness, random);
  Refraction at = RefractionAt(along, outer, 1.0 / index);
  const glm::dvec3 mirrored = along - 2.0 * glm::dot(along, outer) * outer;
  leave(mirrored, at.reflectance);
  double light = 1.0 - at.reflectance;
  glm::dvec3 point = from + entry->distance * along, direction = at.refracted;
  if (glm::dot(direction, entry->facet->normal) > -1e-6) return;
  for (int bounce = 0; bounce < 60 && light > 1e-3; ++bounce) {
    const Prism::Hit exit = prism.Exit(point, direction);
    point += exit.distance * direction;
    const glm::dvec3 inner = RoughNormal(-exit.facet->normal, direction, roughness, random);
    at = RefractionAt(direction, inner, index);
    const bool leaves = at.reflectance < 1.0 && glm::dot(at.refracted, exit.facet->normal) > 0.0;
    const double reflectance = leaves ? at.reflectance : 1.0;
    if (leaves) leave(at.refracted, light * (1.0 - reflectance));
    light *= reflectance;
    direction -= 2.0 * glm::dot(direction, inner) * inner;
    // A tilted facet may mirror a ray outwards; the untilted facet holds it inside.
    if (glm::dot(direction, exit.facet->normal) > -1e-6) {
      direction -= 2.0 * glm::dot(direction, exit.facet->normal) * exit.facet->normal;
      direction = glm::normalize(direction - 1e-6 * exit.facet->normal);
    }
  }
}

/// Adds the light of a chunk of rays to the sums of all columns.
void TraceChunk(const Habit& habit, std::size_t chunk, std::vector<AngleSums>& sums) {
  const Prism prism(habit.length_over_width);
  const double bound = prism.BoundingRadius();
  for (std::size_t ray = 0; ray < kRaysPerChunk; ++ray) {
    const std::size_t number = chunk * kRaysPerChunk + ray;
    for (std::size_t band = 0; band < kBands.size(); ++band) {
      Random random(number + 1);  // the same rays in every band
      const glm::dvec3 along = RandomDirection(random);
      const Across across = AcrossOf(along);
      std::uniform_real_distribution<double> uniform(-bound, bound);
      const double x = uniform(random), y = uniform(random);
      const glm::dvec3 from = x * across.u + y * across.v - 2.0 * bound * along;
      Random spread(number + 77777777);
      FollowRay(prism, kBands[band].index, habit.roughness, from, along, random,
                [&](const glm::dvec3& out, double light) {
                  const glm::dvec3 tilt = TiltAcross(out, spread);
                  for (std::size_t size = 0; size < kRadii_um.size(); ++size) {
                    const double width_um =
                        kRadii_um[size] * prism.FacetWidth() / prism.EffectiveRadius();
                    const double blur = 0.41 * kBands[band].wavelength_nm / 1000.0 / width_um;
                    sums[size * kBands.size() + band].Add(
                        glm::dot(glm::normalize(out + blur * tilt), along), light);
                  }
                });
    }
  }
}

/// Returns the phase functions of rays by column.
std::vector<std::vector<double>> TracedRays(const Habit& habit, const std::vector<double>& angles) {
  std::vector<std::vector<AngleSums>> chunks(kChunks,
                                             std::vector<AngleSums>(kColumns, AngleSums(angles)));
  tbb::parallel_for(std::size_t{0}, kChunks,
                    [&](std::size_t chunk) { TraceChunk(habit, chunk, chunks[chunk]); });
  std::vector<std::vector<double>> values;
  for (std::size_t column = 0; column < kColumns; ++column) {
    AngleSums all(angles);
    for (const auto& sums : chunks) all.Add(sums[column]);
    values.push_back(all.PerSteradian());
  }
  return values;
}

/// Returns the phase function of diffraction at discs with gamma-distributed radii.
std::vector<double> Diffraction(double mean_radius_um, double wavelength_nm,
                                const std::vector<double>& angles_deg) {
  constexpr double kVariance = 0.25;
  constexpr int kSizes = 400;
  std::vector<double> values(angles_deg.size(), 0.0);
  double all = 0.0;
  for (int i = 0; i < kSizes; ++i) {
    const double q = 4.0 * (i + 0.5) / kSizes;  // radius over effective radius
    const double weight =
        std::pow(q, (1.0 - 3.0 * kVariance) / kVariance) * std::exp(-q / kVariance);
    const double area = q * q * weight;
    const double size = 2000.0 * kPi * q * mean_radius_um / wavelength_nm;
    all += area;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double theta = angles_deg[k] * kRadiansPerDegree;
      const double z = size * std::sin(std::min(theta, kPi / 2.0));
      const double lobe = z < 1e-6 ? 1.0 : 2.0 * j1(z) / z;
      const double obliquity = 0.5 * (1.0 + std::cos(theta));
      values[k] += area * size * size / (4.0 * kPi) * lobe * lobe * obliquity * obliquity;
    }
  }
  for (double& value : values) value /= all;
  return values;
}

}  // namespace

int main() {
  const std::vector<double> angles = Angles_deg();
  std::vector<std::vector<double>> columns(kColumns, std::vector<double>(angles.size(), 0.0));
  for (const Habit& habit : kHabits) {
    const Prism prism(habit.length_over_width);
    const double disc_over_effective =
        std::sqrt(prism.ShadowArea() / kPi) / prism.EffectiveRadius();
    const auto rays = TracedRays(habit, angles);
    for (std::size_t column = 0; column < kColumns; ++column) {
      const auto diffraction = Diffraction(disc_over_effective * kRadii_um[column / kBands.size()],
                                           kBands[column % kBands.size()].wavelength_nm, angles);
      for (std::size_t k = 0; k < angles.size(); ++k) {
        columns[column][k] += 0.5 * habit.fraction * (rays[column][k] + diffraction[k]);
      }
    }
  }
  fmt::print(
      "# Phase functions of ice crystals [1/sr] by scattering angle; the names of the other "
      "columns "
      "are effective radii [um] and wavelengths [nm]. Computed by tests/bench/ice_phase.cpp, which "
      "names the sources.\nangle_deg");
  for (std::size_t column = 0; column < kColumns; ++column) {
    fmt::print(",{:.0f}um_{:.0f}nm", kRadii_um[column / kBands.size()],
               kBands[column % kBands.size()].wavelength_nm);
  }
  fmt::print("\n");
  for (std::size_t k = 0; k < angles.size(); ++k) {
    fmt::print("{:.5g}", angles[k]);
    for (const auto& column : columns) fmt::print(",{:.3g}", column[k]);
    fmt::print("\n");
  }
}
