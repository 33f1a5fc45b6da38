// SPDX-License-Identifier: MIT
// Set-up of direct integration (direct_scattering.h): a medium prepared for it, and the panels of a
// ray with the lanes that they use.
//
// The medium has the constants of DirectColumnShape for each layer, and the columns of smooth
// ozone as polynomials.
//
//   (|mu| + k) column(h, mu) = sum over a, q of  c_qa Y^a U^q,   a <= 12, q <= 5
//   Y = 2 min(h, top) / top - 1,   U = 2 (1 + k) |mu| / (|mu| + k) - 1,   k = 0.12
//
// Lengths are in km. Extinctions contain a factor log2(e), because kernels use powers of two.
//
// A ray is cut at its perigee and at the edges of the planet's shadow. Each panel has the map
// DirectDistance (ray_map.glsl) with the slope
//
//   s = min(kappa half / L, 1)
//
// at its low end, where `half` is the distance to 10 km above that end (12 km behind the edge of a
// shadow), or 14 optical depths if less, and kappa = 2, or 3 where sunbeams graze the low end. A
// panel has 7 nodes; a hard one, with more than 4 optical depths in `half` or in L, has 14.
#pragma once

#include <array>
#include <cstddef>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"

namespace alpenglow::atmosphere {

/// An exponential layer of scale height H over a planet of radius R.
struct DirectLayer {
  float per_height;     // -log2(e) / H
  float root;           // sqrt(1 / 2H)
  float delta;          // 5/8 H/R
  float up_scale;       // share H (1 + H/R) root
  float perigee_scale;  // share sqrt(pi) H (1 + 3/8 H/R) root
  float beyond_scale;   // up_scale exp(-top/H) sqrt(R + top): column above the top
  float beyond_root;    // root sqrt(R + top)
};

inline constexpr std::size_t kOzoneHeights = 13;  // powers of Y
inline constexpr std::size_t kOzoneCosines = 6;   // powers of U
inline constexpr float kOzoneCosine = 0.12F;      // k

/// The polynomials of a smooth layer of ozone [km].
struct OzoneFit {
  std::array<std::array<float, kOzoneHeights>, kOzoneCosines> up;  // [q][a]
  std::array<float, kOzoneHeights> perigee;                        // column along mu = 0
};

struct DirectAir {
  double radius, top;
  DirectLayer rayleigh, deficit, mie;
  float deficit_share;  // d of MoleculeDeficit
  bool has_deficit, has_ozone, smooth_ozone;
  bool reaches_top;  // the columns above the top are not negligible
  /// The air is so tall, relative to the radius, that ClimbSeries is not valid: altitudes need a
  /// square root.
  bool is_tall;
  float ozone_bottom, ozone_peak, ozone_top;
  OzoneFit ozone_fit;
  float largest_extinction;  // of molecules and aerosol at altitude 0 [1/km]
  std::size_t bands;
  std::array<float, kMaxBands> rayleigh_extinction, mie_extinction, ozone_extinction;  // log2(e)/km
  std::array<float, kMaxBands> rayleigh_scattering, mie_scattering;                    // 1/km
};

/// Prepares a medium; takes 0.1 ms for a smooth layer of ozone.
[[nodiscard]] DirectAir DirectAirOf(const Medium& medium);

/// A fast ray has 7 nodes per panel, or fewer (DirectRay::few_nodes), and 14 in hard panels; a
/// normal ray has 14 in all panels.
enum class DirectMode { kFast, kNormal };

inline constexpr std::size_t kMostFewNodes = 7;
inline constexpr std::size_t kManyNodes = 14;
inline constexpr std::size_t kDirectLanes = 16;

/// A segment of a ray on which the altitude is monotone, described from its low end [km].
struct DirectPanel {
  float altitude, radius;
  float inverse_radius;
  float from_perigee;  // distance of the low end from the perigee of the line
  float length;
  float mu_s;       // at the low end
  float nu;         // cosine between the sun and the direction upwards along the panel
  float slope;      // s of the map
  float entry;      // position of the ray's entry, upwards along the panel from the low end
  float perigee;    // position of the ray's perigee, likewise
  float begin;      // distance of the low end from the entry
  float direction;  // 1: the panel rises; -1: it falls
  float lit;        // 1 in sunlight, 0 in the shadow of the planet
  float dense;      // approximate extinction at the low end, largest of any band [1/km]
  bool hard;

  /// Returns the altitude at a position, without cancellation [km].
  [[nodiscard]] float AltitudeAt(float position) const;
};

/// Assignment of nodes to lanes: two panels of 7 in lanes 0 to 6 and 8 to 14, or one panel of 14 in
/// both. Lane 7 is a weightless node at the entry, lane 15 one at the perigee.
struct DirectGroup {
  std::size_t first, second;  // indices of panels

  [[nodiscard]] bool HasTwo() const { return first != second; }
};

struct DirectRay {
  static constexpr std::size_t kMostPanels = 4;
  std::array<DirectPanel, kMostPanels> panel;
  std::array<DirectGroup, kMostPanels> group;
  std::size_t panels = 0;
  std::size_t groups = 0;
  std::size_t few_nodes = kMostFewNodes;  // of a panel in half of its group, in [1, 7]
  bool narrow = false;                    // one panel of few nodes: lanes 0 to 7 only
  bool falls = false;                     // the ray has a perigee behind its entry
  RayExtent extent;

  [[nodiscard]] std::size_t NodesOf(const DirectGroup& of_group) const {
    return narrow || of_group.HasTwo() ? few_nodes : kManyNodes;
  }
};

/// A factor of the sunlight at every lane of a ray's groups.
struct LaneLight {
  alignas(64) std::array<float, DirectRay::kMostPanels * kDirectLanes> factor;
};

/// Positions of the nodes of a panel among the samples of its ray: node j in [0, count), in order
/// from the low end up, is sample first + j, or first + j + 1 from the eighth node on.
struct PanelNodes {
  std::size_t panel, count, first;

  [[nodiscard]] std::size_t SampleOf(std::size_t node) const {
    return first + node + node / kMostFewNodes;
  }
};

/// Calls visit(PanelNodes) for each panel.
template <typename Visit>
void VisitPanels(const DirectRay& ray, const Visit& visit) {
  for (std::size_t i = 0; i < ray.groups; ++i) {
    const DirectGroup& group = ray.group[i];
    const std::size_t count = ray.NodesOf(group), first = i * kDirectLanes;
    visit(PanelNodes{group.first, count, first});
    if (group.HasTwo()) visit(PanelNodes{group.second, count, first + kDirectLanes / 2});
  }
}

/// Places the panels of a ray.
/// @param dark  also keeps the panels in the planet's shadow.
[[nodiscard]] DirectRay DirectRayOf(const DirectAir& air, const ViewRay& ray, DirectMode mode,
                                    bool dark);

}  // namespace alpenglow::atmosphere
