// SPDX-License-Identifier: MIT
#include "renderer/media/media_march.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kNodes = 7;

/// Kronrod's seven nodes on [0, 1], the weights of both rules, and for each node the integrals from
/// 0 to it of the polynomials that are 1 at one node and 0 at the others.
struct KronrodRule {
  std::array<double, kNodes> node{}, weight{}, gauss_weight{};
  std::array<std::array<double, kNodes>, kNodes> upto{};  // [node][polynomial]
};

KronrodRule MakeRule() {
  constexpr std::array<double, 4> kAbscissa{0.960491268708020283, 0.774596669241483377,
                                            0.434243749346802558, 0.0};
  constexpr std::array<double, 4> kWeight{0.104656226026467265, 0.268488089868333441,
                                          0.401397414775962223, 0.450916538658474142};
  constexpr std::array<double, 4> kGaussWeight{0.0, 5.0 / 9.0, 0.0, 8.0 / 9.0};
  KronrodRule rule;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const std::size_t k = std::min(i, kNodes - 1 - i);
    rule.node[i] = 0.5 * (i < 3 ? 1.0 - kAbscissa[k] : 1.0 + kAbscissa[k]);
    rule.weight[i] = 0.5 * kWeight[k];
    rule.gauss_weight[i] = 0.5 * kGaussWeight[k];
  }
  const GaussRule& exact = GaussLegendre(4);
  const auto basis = [&](std::size_t of, double x) {
    double product = 1.0;
    for (std::size_t k = 0; k < kNodes; ++k) {
      if (k != of) product *= (x - rule.node[k]) / (rule.node[of] - rule.node[k]);
    }
    return product;
  };
  for (std::size_t i = 0; i < kNodes; ++i) {
    for (std::size_t of = 0; of < kNodes; ++of) {
      for (std::size_t q = 0; q < exact.node.size(); ++q) {
        rule.upto[i][of] +=
            exact.weight[q] * rule.node[i] * basis(of, rule.node[i] * exact.node[q]);
      }
    }
  }
  return rule;
}

const KronrodRule& Rule() {
  static const KronrodRule kRule = MakeRule();
  return kRule;
}

/// Optical depths of all media, and of the bodies among them.
struct MediaDepth {
  SpectrumOf<double> all, bodies;
};

/// Contribution of a panel, as if it began at the eye.
struct MarchPanel {
  double begin_m = 0.0, end_m = 0.0;
  SpectrumOf<double> light, mean, mean_past_bodies;
  MediaDepth depth;
  std::vector<double> columns_m;  // of each medium
  double light_error = 0.0;       // of the worst band, absolute
  double depth_error = 0.0;
  double most_light = 0.0, most_depth = 0.0;
};

class March {
 public:
  March(const LocalMedia& media, const glm::dvec3& origin, const glm::dvec3& direction,
        double length_m, const MediaSource& source, double tolerance,
        std::span<const double> cuts_m, std::span<const SpectrumOf<double>> extinction_per_m)
      : media_(media),
        origin_(origin),
        direction_(direction),
        source_(source),
        tolerance_(tolerance),
        bands_(media.bands()),
        passed_(bands_),
        passed_bodies_(bands_),
        light_(bands_) {
    for (std::size_t m = 0; m < media.all().size(); ++m) {
      const auto& medium = media.all()[m];
      extinction_per_m_.push_back(extinction_per_m.empty() ? medium->optics().extinction_per_m
                                                           : extinction_per_m[m]);
      pieces_.push_back(medium->PiecesAlong(origin, direction, length_m));
      double thickest = 0.0;
      for (std::size_t band = 0; band < bands_; ++band) {
        thickest = std::max(thickest, extinction_per_m_[m][band]);
      }
      thickest_per_m_.push_back(thickest);
      is_body_.push_back(!medium->IsLayer());
      for (const DensePiece& piece : pieces_.back()) {
        cuts_.push_back(piece.begin_m);
        cuts_.push_back(piece.end_m);
      }
    }
    largest_.assign(pieces_.size(), 0.0);
    passed_columns_m_.assign(pieces_.size(), 0.0);
    if (cuts_.empty()) return;
    const auto [first, last] = std::minmax_element(cuts_.begin(), cuts_.end());
    const double begin_m = *first, end_m = *last;
    whole_m_ = end_m - begin_m;
    for (const double cut : cuts_m) {
      if (begin_m < cut && cut < end_m) cuts_.push_back(cut);
    }
    std::sort(cuts_.begin(), cuts_.end());
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
  }

  [[nodiscard]] MarchedLight Run() {
    for (std::size_t i = 0; i + 1 < cuts_.size() && !IsOpaque(); ++i) {
      bool anything = false;
      for (std::size_t m = 0; m < pieces_.size(); ++m) {
        largest_[m] = LargestOn(pieces_[m], 0.5 * (cuts_[i] + cuts_[i + 1]));
        anything = anything || largest_[m] > 0.0;
      }
      if (anything) Take(cuts_[i], cuts_[i + 1], 0);
    }
    return Result();
  }

 private:
  static constexpr double kMostDepth = 2.0;
  static constexpr double kOpaque = 13.9;  // -ln 1e-6
  static constexpr int kMostHalvings = 30;
  static constexpr std::size_t kMostNodes = 20000;

  static double LargestOn(const std::vector<DensePiece>& pieces, double at_m) {
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), at_m,
                         [](double at, const DensePiece& piece) { return at < piece.end_m; });
    return after != pieces.end() && after->begin_m <= at_m ? after->largest : 0.0;
  }

  [[nodiscard]] bool IsOpaque() const {
    return std::all_of(passed_.values().begin(), passed_.values().end(),
                       [](double depth) { return depth > kOpaque; });
  }

  void Take(double begin_m, double end_m, int halvings) {
    if (IsOpaque()) return;
    const double middle = 0.5 * (begin_m + end_m);
    const bool may_halve =
        halvings < kMostHalvings && nodes_ < kMostNodes && begin_m < middle && middle < end_m;
    if (!may_halve || MostPerMetre(begin_m, end_m) * (end_m - begin_m) <= kMostDepth) {
      const MarchPanel panel = Evaluate(begin_m, end_m);
      if (!may_halve || IsGood(panel)) {
        Add(panel);
        return;
      }
    }
    Take(begin_m, middle, halvings + 1);
    Take(middle, end_m, halvings + 1);
  }

  // Returns an upper bound of the extinction in the thickest band.
  [[nodiscard]] double MostPerMetre(double begin_m, double end_m) const {
    const double inside = 1e-6 * (end_m - begin_m);
    double sum = 0.0;
    for (std::size_t m = 0; m < largest_.size(); ++m) {
      if (largest_[m] == 0.0) continue;
      const double most =
          media_.all()[m]->LargestBetween(origin_ + (begin_m + inside) * direction_,
                                          origin_ + (end_m - inside) * direction_, largest_[m]);
      sum += most * thickest_per_m_[m];
    }
    return sum;
  }

  // The error of a panel may be the tolerance times its own contribution, or times its share by
  // length of the sum so far.
  [[nodiscard]] bool IsGood(const MarchPanel& panel) const {
    const double share = (panel.end_m - panel.begin_m) / whole_m_;
    const double most = std::max(panel.most_light, share * most_light_);
    return panel.light_error <= tolerance_ * most &&
           panel.depth_error <= tolerance_ * std::max(panel.most_depth, share);
  }

  [[nodiscard]] MarchPanel Evaluate(double begin_m, double end_m) {
    const KronrodRule& rule = Rule();
    const std::size_t count = media_.all().size();
    const double length = end_m - begin_m;
    std::array<glm::dvec3, kNodes> point{};
    densities_.assign(kNodes * count, 0.0);
    for (std::size_t i = 0; i < kNodes; ++i) {
      point[i] = origin_ + (begin_m + length * rule.node[i]) * direction_;
      for (std::size_t m = 0; m < count; ++m) {
        if (largest_[m] > 0.0) densities_[i * count + m] = media_.all()[m]->DensityAt(point[i]);
      }
    }
    MarchPanel panel;
    panel.begin_m = begin_m;
    panel.end_m = end_m;
    panel.light = panel.mean = panel.mean_past_bodies = SpectrumOf<double>(bands_);
    SpectrumOf<double> gauss_light(bands_);
    std::vector<double> columns_m(count);
    for (std::size_t i = 0; i < kNodes; ++i) {
      const MediaDepth depth = DepthUpto(rule.upto[i], length, count);
      for (std::size_t m = 0; m < count; ++m)
        columns_m[m] = passed_columns_m_[m] + ColumnUpto(rule.upto[i], length, m);
      const Spectrum source = source_(begin_m + length * rule.node[i], point[i],
                                      std::span(densities_).subspan(i * count, count), columns_m);
      ++nodes_;
      for (std::size_t band = 0; band < bands_; ++band) {
        const double left = std::exp(-depth.all[band] - passed_[band]);
        const double light = length * left * static_cast<double>(source[band]);
        panel.light[band] += rule.weight[i] * light;
        gauss_light[band] += rule.gauss_weight[i] * light;
        panel.mean[band] += rule.weight[i] * left;
        panel.mean_past_bodies[band] +=
            rule.weight[i] * std::exp(-depth.bodies[band] - passed_bodies_[band]);
      }
    }
    panel.depth = DepthUpto(rule.weight, length, count);
    for (std::size_t m = 0; m < count; ++m)
      panel.columns_m.push_back(ColumnUpto(rule.weight, length, m));
    const MediaDepth gauss_depth = DepthUpto(rule.gauss_weight, length, count);
    for (std::size_t band = 0; band < bands_; ++band) {
      panel.light_error =
          std::max(panel.light_error, std::abs(panel.light[band] - gauss_light[band]));
      panel.depth_error =
          std::max(panel.depth_error, std::abs(panel.depth.all[band] - gauss_depth.all[band]));
      panel.most_light = std::max(panel.most_light, panel.light[band]);
      panel.most_depth = std::max(panel.most_depth, panel.depth.all[band]);
    }
    return panel;
  }

  // Returns the column of a medium with the weights of an integral over densities_ [m].
  [[nodiscard]] double ColumnUpto(const std::array<double, kNodes>& weights, double length,
                                  std::size_t m) const {
    if (largest_[m] == 0.0) return 0.0;
    double column = 0.0;
    for (std::size_t j = 0; j < kNodes; ++j)
      column += weights[j] * densities_[j * largest_.size() + m];
    return length * column;
  }

  // Returns the optical depths with these weights.
  [[nodiscard]] MediaDepth DepthUpto(const std::array<double, kNodes>& weights, double length,
                                     std::size_t count) const {
    MediaDepth depth{SpectrumOf<double>(bands_), SpectrumOf<double>(bands_)};
    for (std::size_t m = 0; m < count; ++m) {
      const double column_m = ColumnUpto(weights, length, m);
      if (column_m == 0.0) continue;
      for (std::size_t band = 0; band < bands_; ++band) {
        const double of_this = column_m * extinction_per_m_[m][band];
        depth.all[band] += of_this;
        if (is_body_[m]) depth.bodies[band] += of_this;
      }
    }
    return depth;
  }

  void Add(const MarchPanel& panel) {
    for (std::size_t m = 0; m < passed_columns_m_.size(); ++m)
      passed_columns_m_[m] += panel.columns_m[m];
    MarchedPiece piece{panel.begin_m,    panel.end_m,      Spectrum(bands_),
                       Spectrum(bands_), Spectrum(bands_), Spectrum(bands_)};
    for (std::size_t band = 0; band < bands_; ++band) {
      light_[band] += panel.light[band];
      passed_[band] += panel.depth.all[band];
      passed_bodies_[band] += panel.depth.bodies[band];
      piece.transmittance[band] = static_cast<float>(std::exp(-passed_[band]));
      piece.past_bodies[band] = static_cast<float>(std::exp(-passed_bodies_[band]));
      piece.mean_transmittance[band] = static_cast<float>(panel.mean[band]);
      piece.mean_past_bodies[band] = static_cast<float>(panel.mean_past_bodies[band]);
      most_light_ = std::max(most_light_, light_[band]);
    }
    error_ += panel.light_error;
    done_.push_back(piece);
  }

  [[nodiscard]] MarchedLight Result() {
    MarchedLight result;
    result.radiance = result.transmittance = result.narrow_transmittance = Spectrum(bands_);
    for (std::size_t band = 0; band < bands_; ++band) {
      result.radiance[band] = static_cast<float>(light_[band]);
      result.transmittance[band] = static_cast<float>(std::exp(-passed_[band]));
      double narrow_depth = 0.0;
      for (std::size_t m = 0; m < passed_columns_m_.size(); ++m)
        narrow_depth += passed_columns_m_[m] * media_.all()[m]->optics().extinction_per_m[band];
      result.narrow_transmittance[band] = static_cast<float>(std::exp(-narrow_depth));
    }
    result.error = most_light_ > 0.0 ? error_ / most_light_ : 0.0;
    result.nodes = nodes_;
    result.pieces = std::move(done_);
    return result;
  }

  const LocalMedia& media_;
  glm::dvec3 origin_, direction_;
  const MediaSource& source_;
  double tolerance_;
  std::size_t bands_;
  std::vector<std::vector<DensePiece>> pieces_;       // of each medium
  std::vector<SpectrumOf<double>> extinction_per_m_;  // of each medium, for wide sources
  std::vector<double> thickest_per_m_;
  std::vector<bool> is_body_;
  std::vector<double> cuts_;
  std::vector<double> largest_;    // densities of the current piece; 0: not present
  std::vector<double> densities_;  // [node][medium]
  std::vector<double> passed_columns_m_;
  SpectrumOf<double> passed_, passed_bodies_, light_;
  double whole_m_ = 0.0, most_light_ = 0.0, error_ = 0.0;
  std::size_t nodes_ = 0;
  std::vector<MarchedPiece> done_;
};

/// A stretch of media within which light is assumed to increase linearly.
struct Stretch {
  double begin_m, end_m;
  Spectrum first, last, weighted;  // transmittance at the ends; its integral
};

void Extend(const MarchedPiece& piece, Behind behind, std::vector<Stretch>& stretches) {
  constexpr float kMostFall = 0.15F;
  const bool without_layers = behind == Behind::kBodies;
  const Spectrum& after = without_layers ? piece.past_bodies : piece.transmittance;
  const Spectrum& mean = without_layers ? piece.mean_past_bodies : piece.mean_transmittance;
  const auto length = static_cast<float>(piece.end_m - piece.begin_m);
  if (!stretches.empty()) {
    Stretch& open = stretches.back();
    const double gap = piece.begin_m - open.end_m;
    if (gap <= 0.1 * (open.end_m - open.begin_m)) {
      float fall = 0.0F;
      for (std::size_t band = 0; band < after.size(); ++band) {
        fall = std::max(fall, open.first[band] - after[band]);
      }
      if (fall <= kMostFall) {
        open.weighted = open.weighted + static_cast<float>(gap) * open.last + length * mean;
        open.last = after;
        open.end_m = piece.end_m;
        return;
      }
    }
  }
  Spectrum first(after.size());
  std::ranges::fill(first.values(), 1.0F);
  if (!stretches.empty()) first = stretches.back().last;
  stretches.push_back({piece.begin_m, piece.end_m, first, after, length * mean});
}

}  // namespace

MarchedLight MarchMedia(const LocalMedia& media, const glm::dvec3& origin,
                        const glm::dvec3& direction, double length_m, const MediaSource& source,
                        double tolerance, std::span<const double> cuts_m,
                        std::span<const SpectrumOf<double>> extinction_per_m) {
  return March(media, origin, direction, length_m, source, tolerance, cuts_m, extinction_per_m)
      .Run();
}

Spectrum DimmedByMedia(const std::vector<MarchedPiece>& pieces,
                       const std::function<Spectrum(double)>& upto, const Spectrum& whole,
                       Behind behind) {
  std::vector<Stretch> stretches;
  for (const MarchedPiece& piece : pieces) Extend(piece, behind, stretches);
  if (stretches.empty()) return whole;
  Spectrum sum(whole.size()), before(whole.size());
  const auto add = [&](const Spectrum& factor, const Spectrum& reached) {
    for (std::size_t band = 0; band < sum.size(); ++band) {
      sum[band] += factor[band] * std::max(reached[band] - before[band], 0.0F);
      before[band] = std::max(before[band], reached[band]);
    }
  };
  for (const Stretch& stretch : stretches) {
    if (stretch.begin_m > 0.0) add(stretch.first, upto(stretch.begin_m));
    const auto length = static_cast<float>(stretch.end_m - stretch.begin_m);
    add((1.0F / length) * stretch.weighted, upto(stretch.end_m));
  }
  add(stretches.back().last, whole);
  return sum;
}

Spectrum LeftByBodies(const std::vector<MarchedPiece>& pieces, double distance_m,
                      std::size_t bands) {
  Spectrum left(bands);
  std::fill_n(left.values().begin(), bands, 1.0F);
  for (const MarchedPiece& piece : pieces) {
    if (piece.begin_m >= distance_m) break;
    left = piece.past_bodies;
  }
  return left;
}

}  // namespace alpenglow::renderer
