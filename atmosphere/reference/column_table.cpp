// SPDX-License-Identifier: MIT
#include "atmosphere/reference/column_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere::reference {
namespace {

bool AnyAbove(const std::vector<double>& values, double limit) {
  return std::any_of(values.begin(), values.end(), [&](double value) { return value > limit; });
}

// Returns F / sqrt(H r) for slant t = mu sqrt(r / 2H). With w = mu + q sqrt(2H / r) the exponential
// is exp(-q^2 - 2 t q); 45 e-foldings reach below rounding.
double SlantIntegral(double radius_m, double t, double scale_height_m) {
  const GaussRule& rule = GaussLegendre(kMaxGaussNodes);
  const double last = 45.0 / (t + std::sqrt(t * t + 45.0));
  const double step = std::sqrt(2.0 * scale_height_m / radius_m);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double q = last * rule.node[i];
    const double climb = q * (2.0 * t + q);
    const double slope = 0.5 * step * climb / (t + q);  // climb of the line divided by its distance
    sum += rule.weight[i] * last * std::exp(-climb) * (1.0 + climb * scale_height_m / radius_m) /
           std::sqrt(1.0 + slope * slope);
  }
  return sum * std::numbers::sqrt2;
}

}  // namespace

ColumnTable::ColumnTable(const Medium& medium)
    : planet_radius_m_(medium.planet_radius_m),
      top_radius_m_(medium.planet_radius_m + medium.atmosphere_height_m),
      ozone_(medium.ozone),
      has_ozone_(AnyAbove(medium.ozone_absorption_per_m, 0.0)),
      deficit_share_(medium.rayleigh_deficit.share),
      rayleigh_(Tabulate(medium.rayleigh_scale_height_m)),
      mie_(Tabulate(medium.mie_scale_height_m)) {
  if (deficit_share_ > 0.0) deficit_ = Tabulate(medium.rayleigh_deficit.scale_height_m);
}

// Tabulates F. Radii are uniform in h / r, slants in t / (1 + t).
ColumnTable::Layer ColumnTable::Tabulate(double scale_height_m) const {
  Layer layer{scale_height_m, {}};
  for (int i = 0; i < kRadii; ++i) {
    const double y = static_cast<double>(i) / (kRadii - 1);
    const double h_over_r = y * (top_radius_m_ - planet_radius_m_) / top_radius_m_;
    const double radius = planet_radius_m_ / (1.0 - h_over_r);
    for (int j = 0; j < kSlants; ++j) {
      const double x = static_cast<double>(j) / (kSlants - 1);
      // The largest possible slant is vertical. The table extends beyond it to provide nodes for
      // cubic interpolation.
      const double t = x / std::max(1.0 - x, 1e-9);
      layer.table.push_back(SlantIntegral(radius, t, scale_height_m) * (1.0 + t));
    }
  }
  return layer;
}

// Returns the weights of Lagrange's cubic interpolation through the four nodes around x, out of
// nodes 0, 1, ... count - 1.
inline ColumnTable::Cubic ColumnTable::CubicAt(double x, int count) {
  const int first = std::clamp(static_cast<int>(x) - 1, 0, count - 4);
  const double t = x - first;
  return {static_cast<std::size_t>(first), -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
          t * (t - 2.0) * (t - 3.0) / 2.0, -t * (t - 1.0) * (t - 3.0) / 2.0,
          t * (t - 1.0) * (t - 2.0) / 6.0};
}

ColumnTable::LinePoint ColumnTable::PlaceAt(double radius_m, double s_m) const {
  const double h = radius_m - planet_radius_m_;
  const double y = h / radius_m * top_radius_m_ / (top_radius_m_ - planet_radius_m_);
  return {radius_m, s_m, h, CubicAt(y * (kRadii - 1), kRadii)};
}

double ColumnTable::MoleculesBeyond(const LinePoint& place) const {
  const double column = Beyond(rayleigh_, place);
  if (deficit_share_ == 0.0) return column;
  return (1.0 + deficit_share_) * column - deficit_share_ * Beyond(deficit_, place);
}

double ColumnTable::Beyond(const Layer& layer, const LinePoint& place) {
  const double root = std::sqrt(place.radius_m * layer.scale_height_m);
  const double t = place.s_m / (root * std::numbers::sqrt2);
  const Cubic& across = place.across;
  const Cubic along = CubicAt(t / (1.0 + t) * (kSlants - 1), kSlants);
  const double* row = &layer.table[across.first * kSlants + along.first];
  const auto in_row = [&](const double* at) {
    return along.w0 * at[0] + along.w1 * at[1] + along.w2 * at[2] + along.w3 * at[3];
  };
  double sum = 0.0;
  sum += across.w0 * in_row(row);
  sum += across.w1 * in_row(row + kSlants);
  sum += across.w2 * in_row(row + 2 * kSlants);
  sum += across.w3 * in_row(row + 3 * kSlants);
  return std::exp(-place.height_m / layer.scale_height_m) * sum / (1.0 + t) * root;
}

// Returns an antiderivative of one side of the ozone tent (0: lower, rising; 1: upper, falling) at
// s in the span of that side.
double ColumnTable::OzoneSide(const Line& line, std::size_t side, double s_m) const {
  const double p = std::max(line.perigee_radius_m, 1.0);
  const double r = std::sqrt(p * p + s_m * s_m);
  const double of_radius = 0.5 * (s_m * r + p * p * std::log((s_m + r) / p));
  if (side == 0) {
    return (of_radius - (planet_radius_m_ + ozone_.bottom_m) * s_m) /
           (ozone_.peak_m - ozone_.bottom_m);
  }
  return ((planet_radius_m_ + ozone_.top_m) * s_m - of_radius) / (ozone_.top_m - ozone_.peak_m);
}

// Returns the column of the smooth ozone layer from its bottom, or from a perigee above the bottom,
// to s.
double ColumnTable::SmoothOzoneUpTo(const Line& line, double s_m) const {
  const GaussRule& rule = GaussLegendre(14);
  const double p = line.perigee_radius_m;
  const double first = line.ozone_edge_m[0];
  const double span = std::min(s_m, line.ozone_edge_m[2]) - first;
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double s = first + span * rule.node[i];
    const double y = (std::sqrt(p * p + s * s) - planet_radius_m_) / ozone_.top_m;
    const double root = 6.75 * y * (1.0 - y) * (1.0 - y);
    sum += rule.weight[i] * root * root * root * root;
  }
  return sum * std::max(span, 0.0);
}

ColumnTable::Line ColumnTable::LineAt(double perigee_radius_m) const {
  Line line;
  line.perigee_radius_m = perigee_radius_m;
  if (!has_ozone_) return line;
  const std::array<double, 3> edge{ozone_.bottom_m, ozone_.peak_m, ozone_.top_m};
  for (std::size_t i = 0; i < 3; ++i) {
    const double above = planet_radius_m_ + edge[i] - perigee_radius_m;
    line.ozone_edge_m[i] = above > 0.0 ? std::sqrt(above * (above + 2.0 * perigee_radius_m)) : 0.0;
  }
  if (ozone_.shape == OzoneShape::kSmooth) return line;
  if (line.ozone_edge_m[1] > line.ozone_edge_m[0]) {
    line.ozone_offset_m[0] = OzoneSide(line, 0, line.ozone_edge_m[0]);
    line.ozone_below_peak_m = OzoneSide(line, 0, line.ozone_edge_m[1]) - line.ozone_offset_m[0];
  }
  if (line.ozone_edge_m[2] > line.ozone_edge_m[1])
    line.ozone_offset_m[1] = OzoneSide(line, 1, line.ozone_edge_m[1]);
  return line;
}

AirColumns ColumnTable::Primitive(const Line& line, double s_m) const {
  const double p = line.perigee_radius_m;
  const double s = std::abs(s_m);
  // Below altitude 0 air has the density of altitude 0.
  const double s_ground = std::sqrt(std::max((planet_radius_m_ - p) * (planet_radius_m_ + p), 0.0));
  const double below = std::max(s_ground - s, 0.0), s_above = s + below;
  const LinePoint place = PlaceAt(std::sqrt(p * p + s_above * s_above), s_above);
  AirColumns columns{MoleculesBeyond(place) + below, Beyond(mie_, place) + below, 0.0};
  if (!has_ozone_ || s <= line.ozone_edge_m[0]) return columns;
  if (ozone_.shape == OzoneShape::kSmooth) {
    columns.ozone = SmoothOzoneUpTo(line, s);
  } else if (s < line.ozone_edge_m[1]) {
    columns.ozone = OzoneSide(line, 0, s) - line.ozone_offset_m[0];
  } else {
    columns.ozone = line.ozone_below_peak_m;
    const double inside = std::min(s, line.ozone_edge_m[2]);
    if (inside > line.ozone_edge_m[1])
      columns.ozone += OzoneSide(line, 1, inside) - line.ozone_offset_m[1];
  }
  columns.ozone = std::copysign(columns.ozone, s_m);
  return columns;
}

AirColumns ColumnTable::Difference(double s0_m, const AirColumns& at_s0, double s1_m,
                                   const AirColumns& at_s1, const AirColumns& at_perigee) {
  const double ozone = at_s1.ozone - at_s0.ozone;
  if (s0_m >= 0.0) return {at_s0.rayleigh - at_s1.rayleigh, at_s0.mie - at_s1.mie, ozone};
  if (s1_m <= 0.0) return {at_s1.rayleigh - at_s0.rayleigh, at_s1.mie - at_s0.mie, ozone};
  return {2.0 * at_perigee.rayleigh - at_s0.rayleigh - at_s1.rayleigh,
          2.0 * at_perigee.mie - at_s0.mie - at_s1.mie, ozone};
}

AirColumns ColumnTable::ToSpace(double perigee_radius_m, double s0_m) const {
  const Line line = LineAt(perigee_radius_m);
  const double above = std::max(top_radius_m_ - perigee_radius_m, 0.0);
  const double s1 = std::max(std::sqrt(above * (top_radius_m_ + perigee_radius_m)), s0_m);
  const AirColumns at_perigee = s0_m < 0.0 ? Primitive(line, 0.0) : AirColumns{};
  return Difference(s0_m, Primitive(line, s0_m), s1, Primitive(line, s1), at_perigee);
}

}  // namespace alpenglow::atmosphere::reference
