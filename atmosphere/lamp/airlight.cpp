// SPDX-License-Identifier: MIT
#include "atmosphere/lamp/airlight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kSmallestApproach_m = 1e-12;

/// A vector of limited capacity with storage on the stack.
template <typename Element, std::size_t kCapacity>
class Few {
 public:
  [[nodiscard]] bool full() const { return count_ == kCapacity; }
  [[nodiscard]] std::size_t size() const { return count_; }
  void push_back(const Element& element) {
    ALPENGLOW_ENSURE(count_, <, kCapacity);
    elements_[count_++] = element;
  }
  void insert(std::size_t at, const Element& element) {
    push_back(element);
    for (std::size_t i = count_ - 1; i > at; --i) std::swap(elements_[i], elements_[i - 1]);
  }
  Element& operator[](std::size_t i) { return elements_[i]; }
  const Element& operator[](std::size_t i) const { return elements_[i]; }
  Element* begin() { return elements_.data(); }
  Element* end() { return elements_.data() + count_; }
  [[nodiscard]] const Element* begin() const { return elements_.data(); }
  [[nodiscard]] const Element* end() const { return elements_.data() + count_; }

 private:
  std::array<Element, kCapacity> elements_;
  std::size_t count_ = 0;
};

/// The integrand along a ray, with the distance to the lamp parameterised by x.
class LampRay {
 public:
  LampRay(const LampAir& air, const Lamp& lamp, const LampSegment& segment)
      : air_(air), lamp_(lamp) {
    ALPENGLOW_ENSURE(air.layers.size(), <=, kMostLampLayers);
    const glm::dvec3 to_lamp = lamp.position_m - segment.origin_m;
    nearest_m_ = glm::dot(to_lamp, segment.direction);
    const glm::dvec3 off = nearest_m_ * segment.direction - to_lamp;
    const double distance = glm::length(off);
    approach_m_ = std::max({distance, lamp.radius_m, kSmallestApproach_m});
    SetPlane(segment.direction, distance > 1e-14 * glm::length(to_lamp)
                                    ? off / distance
                                    : AnyAcross(segment.direction));
    slope_ = glm::dot(air.up, segment.direction);
    z_eye_ = air.AltitudeOf(segment.origin_m);
    z_lamp_ = air.AltitudeOf(lamp.position_m);
    for (std::size_t k = 0; k < air.layers.size(); ++k) {
      eye_[k] = DensityOf(k, z_eye_);
      at_lamp_[k] = DensityOf(k, z_lamp_);
    }
    reference_ = air.bands() / 2;
    const double end = std::isinf(segment.end_m) ? HomogeneousEnd() : segment.end_m;
    x_begin_ = XOf(segment.begin_m);
    x_end_ = XOf(end);
    ChooseLayers(z_eye_ + slope_ * segment.begin_m, z_eye_ + slope_ * end);
  }

  [[nodiscard]] double x_begin() const { return x_begin_; }
  [[nodiscard]] double x_end() const { return x_end_; }

  // Adds the points at which the ray enters and leaves the cone of half angle alpha about the
  // lamp's axis. In the plane of ray and lamp the cosine to the axis is a cos(theta - phi).
  template <typename Add>
  void AddCone(double cosine, const Add& add) const {
    const double a = std::hypot(across_.x, along_.x);
    const double phi = std::atan2(along_.x, across_.x);
    if (!(std::abs(cosine) < a)) return;
    const double half = std::acos(cosine / a);
    for (const double theta :
         {phi - half, phi + half, phi + half - 2.0 * kPi, phi - half + 2.0 * kPi}) {
      if (std::abs(theta) < 0.5 * kPi) add(std::asinh(std::tan(theta)));
    }
  }
  // Adds the point at which the ray is nearest to the lamp's axis.
  template <typename Add>
  void AddAxis(const Add& add) const {
    const double phi = std::atan2(along_.x, across_.x);
    if (std::abs(phi) < 0.5 * kPi) add(std::asinh(std::tan(phi)));
  }

  [[nodiscard]] bool IsLit(double x) const {
    return Profile(std::tanh(x), 1.0 / std::cosh(x)) > 0.0;
  }

  // Returns the integrand in x, in the middle band, for the significant layers only.
  [[nodiscard]] double Reference(double x) const {
    double value = 0.0;
    At(x, great_layers_, reference_, reference_ + 1,
       [&](std::size_t, double found) { value = found; });
    return value;
  }

  void Accumulate(double x, double weight, SpectrumOf<double>& sum) const {
    At(x, all_layers_, 0, sum.size(),
       [&](std::size_t band, double found) { sum[band] += weight * found; });
  }

 private:
  static glm::dvec3 AnyAcross(const glm::dvec3& direction) {
    const glm::dvec3 other =
        std::abs(direction.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    return glm::normalize(glm::cross(direction, other));
  }

  // Sets the cosines between the lamp's axes and the ray, and between the lamp's axes and the
  // direction from the lamp to the nearest point.
  void SetPlane(const glm::dvec3& ray, const glm::dvec3& off) {
    const glm::dvec3 third = glm::cross(lamp_.side, lamp_.axis);
    along_ = {glm::dot(ray, lamp_.axis), glm::dot(ray, lamp_.side), glm::dot(ray, third)};
    across_ = {glm::dot(off, lamp_.axis), glm::dot(off, lamp_.side), glm::dot(off, third)};
  }

  [[nodiscard]] double XOf(double t) const { return std::asinh((t - nearest_m_) / approach_m_); }

  // The tail beyond this end has less than 1e-9 of the light: d has increased by the inverse
  // factor, or the optical depth is 45.
  [[nodiscard]] double HomogeneousEnd() const {
    double extinction = 0.0;
    for (const LampLayer& layer : air_.layers) {
      ALPENGLOW_ENSURE(layer.scale_height_m, ==, std::numeric_limits<double>::infinity());
      extinction += layer.extinction_per_m[reference_];
    }
    const double far = 1e9 * (approach_m_ + std::abs(nearest_m_));
    return nearest_m_ + std::min(far, 45.0 / extinction + std::abs(nearest_m_));
  }

  [[nodiscard]] double Profile(double sine, double cosine) const {
    if (lamp_.profile.kind == LampProfile::Kind::kIsotropic) return 1.0;
    return RelativeIntensity(lamp_.profile, sine * along_ + cosine * across_);
  }

  // Selects the layers that scatter at least a fiftieth as much as the densest one, at some height
  // on the ray. They are used for scouting, which needs only the shape of the integrand. Above
  // dense layers, the clear air is selected.
  void ChooseLayers(double begin_z, double end_z) {
    constexpr int kPoints = 4;
    std::array<bool, kMostLampLayers> is_great{};
    for (int i = 0; i < kPoints; ++i) {
      const double z = begin_z + (end_z - begin_z) * i / (kPoints - 1.0);
      std::array<double, kMostLampLayers> here{};
      for (std::size_t k = 0; k < air_.layers.size(); ++k)
        here[k] = air_.layers[k].scattering_per_m[reference_] * air_.layers[k].Density(z);
      const double greatest = *std::max_element(here.begin(), here.end());
      for (std::size_t k = 0; k < air_.layers.size(); ++k)
        is_great[k] = is_great[k] || here[k] >= 0.02 * greatest;
    }
    for (std::size_t k = 0; k < air_.layers.size(); ++k) {
      all_layers_.push_back(k);
      if (is_great[k]) great_layers_.push_back(k);
    }
  }

  /// A layer's density relative to its base, and its logarithm.
  struct Density {
    double log = 0.0, value = 1.0;
  };
  [[nodiscard]] Density DensityOf(std::size_t layer, double z) const {
    const double log = air_.layers[layer].LogDensity(z);
    return {log, log == 0.0 ? 1.0 : std::exp(log)};
  }
  static double Column(double length_m, const Density& from, const Density& to) {
    return ExponentialColumn(length_m, from.value, to.value, from.log - to.log);
  }

  using Layers = Few<std::size_t, kMostLampLayers>;

  template <typename Take>
  void At(double x, const Layers& layers, std::size_t first_band, std::size_t end_band,
          const Take& take) const {
    const double e = std::exp(x);
    const double cosh = 0.5 * (e + 1.0 / e);
    const double sinh = 0.5 * (e - 1.0 / e);
    const double sech = 1.0 / cosh;
    const double t = nearest_m_ + approach_m_ * sinh;
    const double distance = approach_m_ * cosh;
    const double z = z_eye_ + slope_ * t;
    const double scale = sech / approach_m_ * Profile(sinh * sech, sech);
    std::array<double, kMostLampLayers> column{}, scattered{};
    for (const std::size_t k : layers) {
      const Density here = DensityOf(k, z);
      column[k] = Column(t, eye_[k], here) + Column(distance, at_lamp_[k], here);
      scattered[k] = here.value * scale * Phase(air_.layers[k].phase, -sinh * sech);
    }
    for (std::size_t band = first_band; band < end_band; ++band) {
      double tau = 0.0;
      double source = 0.0;
      for (const std::size_t k : layers) {
        tau += air_.layers[k].extinction_per_m[band] * column[k];
        source += air_.layers[k].scattering_per_m[band] * scattered[k];
      }
      take(band, source * std::exp(-tau));
    }
  }

  const LampAir& air_;
  const Lamp& lamp_;
  double nearest_m_, approach_m_;
  glm::dvec3 along_{0.0}, across_{0.0};
  double slope_, z_eye_, z_lamp_;
  std::array<Density, kMostLampLayers> eye_{}, at_lamp_{};
  Layers all_layers_, great_layers_;
  std::size_t reference_ = 0;
  double x_begin_ = 0.0, x_end_ = 0.0;
};

/// A segment of the ray with one maximum, and the parameters of its map.
struct Panel {
  double low, high;
  double mode, scale;
  double content;  // estimate of its integral
  int nodes = 0;
};
inline constexpr std::size_t kMostPanels = 48;
using Panels = Few<Panel, kMostPanels>;

/// The integrand at ascending points of one lit segment.
class Scout {
 public:
  Scout(const LampRay& ray, double low, double high) : ray_(ray) {
    constexpr double kSpacing = 1.0;
    const int steps = std::clamp(static_cast<int>(std::ceil((high - low) / kSpacing)), 3, 24);
    for (int i = 0; i <= steps; ++i) {
      const double x = i == steps ? high : low + (high - low) * i / steps;
      points_.push_back({x, ray.Reference(x)});
    }
    ray.AddAxis([&](double x) {
      if (x > low && x < high) InsertAt(x);
    });
    LookBeside(low, high);
    Refine();
  }

  [[nodiscard]] std::size_t evaluations() const { return points_.size(); }

  // Appends no panels if there is no light (no air, or an optical depth of 700).
  void AppendPanels(Panels& panels) const {
    const std::size_t last = points_.size() - 1;
    if (!(Content(0, last) > 0.0)) return;
    std::size_t low = 0;
    while (low < last) {
      const std::size_t climbed = Climb(low);
      const std::size_t high = HasRoom(panels) ? Descend(climbed) : last;
      const std::size_t mode = high < last ? climbed : HighestIn(low, last);
      AppendMaximum(low, mode, high, panels);
      low = high;
    }
  }

 private:
  struct Point {
    double x, value;
  };
  static constexpr double kThin = 0.35;
  static constexpr double kLeastStep = 1e-6;

  // Profiles may have any number of maxima: once many are found, the rest of the ray becomes one
  // panel.
  static bool HasRoom(const Panels& panels) { return panels.size() + 16 < kMostPanels; }

  void InsertAt(double x) {
    if (points_.full()) return;
    std::size_t at = 0;
    while (at < points_.size() && points_[at].x < x) ++at;
    // A panel must have a non-zero width.
    const bool is_there = (at < points_.size() && points_[at].x - x < kLeastStep) ||
                          (at > 0 && x - points_[at - 1].x < kLeastStep);
    if (!is_there) points_.insert(at, {x, ray_.Reference(x)});
  }

  // A maximum at an end may be the slope of a higher maximum just inside.
  void LookBeside(double low, double high) {
    const std::size_t last = points_.size() - 1;
    const double step = 0.25 * (points_[1].x - points_[0].x);
    const bool at_high = points_[last].value > points_[last - 1].value;
    if (points_[0].value > points_[1].value) InsertAt(low + step);
    if (at_high) InsertAt(high - step);
  }

  // Halves the steps next to maxima that fall by more than a factor e to the next point, because of
  // layers thinner than the spacing. Maxima with a negligible fraction of the light are not
  // refined.
  void Refine() {
    constexpr double kFall = 2.7;
    constexpr double kWorth = 3e-3;
    const double whole = Content(0, points_.size() - 1);
    for (std::size_t i = 0; i < points_.size() && !points_.full();) {
      const double here = points_[i].value;
      const bool from_left = i > 0 && here >= points_[i - 1].value;
      const bool from_right = i + 1 < points_.size() && here >= points_[i + 1].value;
      const bool left = from_left && points_[i].x - points_[i - 1].x > 3.0 * kLeastStep &&
                        here > kFall * points_[i - 1].value &&
                        here * (points_[i].x - points_[i - 1].x) > kWorth * whole &&
                        (i + 1 == points_.size() || from_right);
      const bool right = from_right && points_[i + 1].x - points_[i].x > 3.0 * kLeastStep &&
                         here > kFall * points_[i + 1].value &&
                         here * (points_[i + 1].x - points_[i].x) > kWorth * whole &&
                         (i == 0 || from_left);
      if (left) {
        InsertAt(0.5 * (points_[i - 1].x + points_[i].x));
      } else if (right) {
        InsertAt(0.5 * (points_[i].x + points_[i + 1].x));
      }
      i = left || right ? (i > 1 ? i - 2 : 0) : i + 1;
    }
  }

  [[nodiscard]] std::size_t HighestIn(std::size_t low, std::size_t high) const {
    std::size_t best = low;
    for (std::size_t i = low; i <= high; ++i) {
      if (points_[i].value > points_[best].value) best = i;
    }
    return best;
  }

  // Returns the highest point before the integrand has fallen by a third from it.
  [[nodiscard]] std::size_t Climb(std::size_t low) const {
    std::size_t best = low;
    for (std::size_t i = low + 1; i < points_.size(); ++i) {
      if (points_[i].value >= points_[best].value) best = i;
      if (points_[i].value < 0.7 * points_[best].value) break;
    }
    return best;
  }

  // Returns the lowest point between a maximum and the next one that needs its own panel.
  [[nodiscard]] std::size_t Descend(std::size_t mode) const {
    std::size_t lowest = mode;
    for (std::size_t i = mode + 1; i < points_.size(); ++i) {
      if (points_[i].value <= points_[lowest].value) lowest = i;
      if (points_[i].value > 1.3 * points_[lowest].value && lowest > mode) return lowest;
    }
    return points_.size() - 1;
  }

  [[nodiscard]] double Depth(std::size_t mode, std::size_t i) const {
    constexpr double kNothing = 745.0;  // the smallest double is e^-745
    return points_[i].value > 0.0 ? std::log(points_[mode].value / points_[i].value) : kNothing;
  }

  // Returns the distance from a maximum, towards `end`, at which the integrand has fallen by
  // e^fall. If it does not fall this far, the distance is extrapolated.
  [[nodiscard]] double FallWidth(std::size_t mode, std::size_t end, double fall) const {
    double depth = 0.0;
    std::size_t i = mode;
    while (i != end) {
      const std::size_t next = end > i ? i + 1 : i - 1;
      const double step = std::abs(points_[next].x - points_[i].x);
      const double next_depth = Depth(mode, next);
      const double here = std::abs(points_[i].x - points_[mode].x);
      // An abrupt fall to zero is the edge of a beam, which follows a power and not an exponential.
      if (next == end && next_depth > depth + 6.0) break;
      if (next_depth >= fall) return here + step * (fall - depth) / (next_depth - depth);
      depth = next_depth;
      i = next;
    }
    const double width = std::abs(points_[i].x - points_[mode].x);
    const double all = std::abs(points_[end].x - points_[mode].x);
    return depth > 0.1 ? std::min(width * fall / depth, 0.75 * fall * all) : 20.0 * all;
  }

  // Returns the scale s of exp(-|x - mode| / s) on one side. A sech falls by e^2 at 2.7 of its
  // scales, an exponential at 2. Far from the lamp every integrand falls as exp(-|x|): if the scale
  // is a whole number, the ends in v are smooth.
  [[nodiscard]] double Scale(std::size_t mode, std::size_t end) const {
    const double near = FallWidth(mode, end, 2.0) / 2.4;
    const double far = FallWidth(mode, end, 9.0) / 9.6;
    if (near < kThin && far > 4.0 * near) return near;
    const double scale = std::max(near, far);
    const bool is_deep = Depth(mode, end) > 9.0;
    if (scale < (is_deep ? kThin : 1.0)) return scale;
    return std::clamp(std::round(scale), 1.0, 3.0);
  }

  [[nodiscard]] double Content(std::size_t low, std::size_t high) const {
    double sum = 0.0;
    for (std::size_t i = low; i < high; ++i) {
      sum += 0.5 * (points_[i + 1].x - points_[i].x) * (points_[i].value + points_[i + 1].value);
    }
    return sum;
  }

  // Returns the point at which the integrand, away from a maximum, begins to fall much more slowly
  // than the map assumes, if there is enough light beyond for a panel.
  [[nodiscard]] std::size_t Knee(std::size_t mode, std::size_t end, double scale) const {
    constexpr double kWorth = 3e-4;
    const double whole = Content(std::min(mode, end), std::max(mode, end));
    std::size_t i = mode;
    while (i != end) {
      const std::size_t next = end > i ? i + 1 : i - 1;
      const double slope =
          (Depth(mode, next) - Depth(mode, i)) / std::abs(points_[next].x - points_[i].x);
      if (i != mode && Depth(mode, i) > 1.0 && slope < 0.55 / scale) {
        const bool worth = Content(std::min(i, end), std::max(i, end)) > kWorth * whole;
        return worth ? i : end;
      }
      i = next;
    }
    return end;
  }

  void AppendPanel(std::size_t a, std::size_t b, double mode, double scale, Panels& panels) const {
    const std::size_t low = std::min(a, b), high = std::max(a, b);
    panels.push_back({points_[low].x, points_[high].x, mode, scale, Content(low, high)});
  }

  // Appends the panels from a maximum down to one side.
  void AppendSide(std::size_t mode, std::size_t end, Panels& panels) const {
    while (mode != end) {
      const double scale = Scale(mode, end);
      const std::size_t knee = HasRoom(panels) ? Knee(mode, end, scale) : end;
      AppendPanel(mode, knee, points_[mode].x, scale, panels);
      mode = knee;
    }
  }

  void AppendMaximum(std::size_t low, std::size_t mode, std::size_t high, Panels& panels) const {
    if (mode != low && mode != high) {
      const double left = Scale(mode, low);
      const double right = Scale(mode, high);
      const bool thick = left >= kThin && right >= kThin;
      const bool alike = left < 3.0 * right && right < 3.0 * left;
      if (thick || alike) {
        const double scale = std::max(left, right);
        const std::size_t from = Knee(mode, low, scale), to = Knee(mode, high, scale);
        AppendPanel(from, to, points_[mode].x, scale, panels);
        AppendSide(from, low, panels);
        AppendSide(to, high, panels);
        return;
      }
    }
    AppendSide(mode, low, panels);
    AppendSide(mode, high, panels);
  }

  const LampRay& ray_;
  Few<Point, 64> points_;
};

// The points at which the lamp's profile is not smooth, ends included, ascending.
using Cuts = Few<double, 16>;
Cuts CutsOf(const LampRay& ray, const LampProfile& profile) {
  Cuts cuts;
  cuts.push_back(ray.x_begin());
  const auto add = [&](double x) {
    if (x > ray.x_begin() && x < ray.x_end()) cuts.push_back(x);
  };
  switch (profile.kind) {
    case LampProfile::Kind::kIsotropic:
      break;
    case LampProfile::Kind::kCosinePower:
      ray.AddCone(0.0, add);
      break;
    case LampProfile::Kind::kCone:
      ray.AddCone(std::cos(profile.inner_rad), add);
      ray.AddCone(std::cos(profile.outer_rad), add);
      break;
    case LampProfile::Kind::kTable:
      ray.AddCone(std::cos(profile.table.gamma_rad.front()), add);
      ray.AddCone(std::cos(profile.table.gamma_rad.back()), add);
      break;
  }
  cuts.push_back(ray.x_end());
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// The limits of a panel in the variable v.
struct MappedPanel {
  double low, high;
  explicit MappedPanel(const Panel& panel)
      : low(std::tanh(0.5 * (panel.low - panel.mode) / panel.scale)),
        high(std::tanh(0.5 * (panel.high - panel.mode) / panel.scale)) {}
};

// The error of Gauss quadrature in a panel falls by the square of the sum of the semi-axes of the
// ellipse around [low, high] that reaches the nearest singularity (Trefethen 2008, SIAM Review 50,
// 67, theorem 4.5). The singularities of the integrand are those of sech and of the phase function,
// at a distance of pi / 2 from the real x. Each node is assigned to the panel with the largest
// remaining error.
void ShareNodes(int nodes, Panels& panels) {
  std::array<double, kMostPanels> log_error{}, gain{};
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const MappedPanel mapped(panels[i]);
    const double half = 0.5 * (mapped.high - mapped.low);
    const double singular = std::tan(0.25 * kPi / std::clamp(panels[i].scale, 1.0, 3.0)) *
                            (panels[i].scale < 1.0 ? 0.7 : 1.0);
    gain[i] = 2.0 * std::asinh(singular / std::max(half, 1e-6));
    log_error[i] = std::log(std::max(panels[i].content, 1e-300)) - gain[i];
    panels[i].nodes = 1;
  }
  for (int given = static_cast<int>(panels.size()); given < nodes; ++given) {
    const auto worst = static_cast<std::size_t>(
        std::max_element(log_error.begin(),
                         log_error.begin() + static_cast<std::ptrdiff_t>(panels.size())) -
        log_error.begin());
    panels[worst].nodes += 1;
    log_error[worst] -= gain[worst];
  }
}

struct FoundPanels {
  Panels panels;  // panels with their numbers of nodes
  std::size_t scouted = 0;
};
FoundPanels FindPanels(const LampRay& ray, const Lamp& lamp, int nodes) {
  ALPENGLOW_ENSURE(nodes, >=, kFewestLampNodes);
  ALPENGLOW_ENSURE(nodes, <=, kMostLampNodes);
  const Cuts cuts = CutsOf(ray, lamp.profile);
  FoundPanels found;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    constexpr double kNothing = 1e-12;  // width of a negligible segment, whose light is as small
    if (cuts[i + 1] - cuts[i] > kNothing && ray.IsLit(0.5 * (cuts[i] + cuts[i + 1]))) {
      const Scout scout(ray, cuts[i], cuts[i + 1]);
      scout.AppendPanels(found.panels);
      found.scouted += scout.evaluations();
    }
  }
  if (found.panels.size() > 0) ShareNodes(nodes, found.panels);
  return found;
}

void Integrate(const LampRay& ray, const Panel& panel, SpectrumOf<double>& sum) {
  const GaussRule& rule = GaussLegendre(panel.nodes);
  const auto [low, high] = MappedPanel(panel);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double v = low + (high - low) * rule.node[i];
    const double x = panel.mode + panel.scale * std::log((1.0 + v) / (1.0 - v));
    const double slope = 2.0 * panel.scale / ((1.0 - v) * (1.0 + v));
    ray.Accumulate(x, rule.weight[i] * (high - low) * slope, sum);
  }
}

}  // namespace

SpectrumOf<double> Airlight(const LampAir& air, const Lamp& lamp, const LampSegment& segment,
                            int nodes) {
  SpectrumOf<double> sum(air.bands());
  if (!(segment.end_m > segment.begin_m)) return sum;
  const LampRay ray(air, lamp, segment);
  for (const Panel& panel : FindPanels(ray, lamp, nodes).panels) Integrate(ray, panel, sum);
  return sum;
}

AirlightEffort EffortOfAirlight(const LampAir& air, const Lamp& lamp, const LampSegment& segment,
                                int nodes) {
  if (!(segment.end_m > segment.begin_m)) return {};
  const FoundPanels found = FindPanels(LampRay(air, lamp, segment), lamp, nodes);
  AirlightEffort effort{static_cast<int>(found.scouted), 0};
  for (const Panel& panel : found.panels) effort.integrated += panel.nodes;
  return effort;
}

}  // namespace alpenglow::atmosphere
