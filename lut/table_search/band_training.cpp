// SPDX-License-Identifier: MIT
#include "lut/table_search/band_training.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::lut {
namespace {

using TrainedTriple = std::array<double, 3>;
using Rows = std::array<std::vector<double>, 3>;

constexpr TrainedTriple kWhite{1.0, 1.0, 1.0};
constexpr double kLuminance = 0.4;  // luminance of a colour, relative to white

double Dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Derives rows over FineWavelengths() from the sums of BandColour, which are exact for the sun.
Rows DeriveExactRows() {
  const std::vector<double> fine = FineWavelengths();
  const BandColour colour(fine);
  Rows rows;
  TrainedTriple sun{};
  for (std::size_t i = 0; i < fine.size(); ++i) {
    std::vector<double> one(fine.size(), 0.0);
    one[i] = SolarIrradiance(fine[i]);
    const TrainedTriple xyz = colour.Xyz(one);
    for (std::size_t c = 0; c < 3; ++c) {
      rows[c].push_back(xyz[c]);
      sun[c] += xyz[c];
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    for (double& share : rows[c]) share /= sun[c];
  }
  return rows;
}

const Rows& ExactRows() {
  static const Rows rows = DeriveExactRows();
  return rows;
}

// Returns the shares of light that is linear between the bands and constant beyond them: the start
// of a fit.
Rows BrokenLineShares(const std::vector<std::size_t>& set) {
  Rows rows;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<double>& exact = ExactRows()[c];
    rows[c].assign(set.size(), 0.0);
    for (std::size_t j = 0; j < exact.size(); ++j) {
      const auto above = std::upper_bound(set.begin(), set.end(), j);
      const auto i = static_cast<std::size_t>(above - set.begin());
      if (i == 0 || i == set.size()) {
        rows[c][i == 0 ? 0 : i - 1] += exact[j];
        continue;
      }
      const double share =
          static_cast<double>(j - set[i - 1]) / static_cast<double>(set[i] - set[i - 1]);
      rows[c][i - 1] += (1.0 - share) * exact[j];
      rows[c][i] += share * exact[j];
    }
  }
  return rows;
}

TrainedTriple Exposed(TrainedTriple xyz, double exposure) {
  for (double& value : xyz) value *= exposure;
  return xyz;
}

double SquaredDifference(const TrainedTriple& xyz, double step_a, std::size_t a, double step_b,
                         std::size_t b) {
  TrainedTriple moved = xyz;
  moved[a] += step_a;
  moved[b] += step_b;
  const double difference = Ciede2000(xyz, moved, kWhite);
  return difference * difference;
}

// Returns CIEDE2000 squared as a quadratic form around a colour.
std::array<TrainedTriple, 3> MetricAt(const TrainedTriple& xyz) {
  constexpr double kStep = 1e-4;
  constexpr double kScale = 1.0 / (8.0 * kStep * kStep);
  std::array<TrainedTriple, 3> metric{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      metric[a][b] = kScale * (SquaredDifference(xyz, kStep, a, kStep, b) +
                               SquaredDifference(xyz, -kStep, a, -kStep, b) -
                               SquaredDifference(xyz, kStep, a, -kStep, b) -
                               SquaredDifference(xyz, -kStep, a, kStep, b));
    }
  }
  return metric;
}

double WeightOf(SkyRegime regime) { return regime == SkyRegime::kDirectSun ? 0.5 : 1.0; }

std::size_t CountOf(SkyRegime regime, std::span<const SkySpectrum> spectra) {
  return static_cast<std::size_t>(
      std::count_if(spectra.begin(), spectra.end(),
                    [=](const SkySpectrum& spectrum) { return spectrum.regime == regime; }));
}

std::size_t FineIndex(double wavelength_nm) {
  const std::vector<double> fine = FineWavelengths();
  const auto found = std::find(fine.begin(), fine.end(), wavelength_nm);
  ALPENGLOW_ENSURE(found != fine.end(), ==, true);
  return static_cast<std::size_t>(found - fine.begin());
}

// Draws `count` different multiples of `step` below `steps` times `step`, ascending.
std::vector<std::size_t> DrawSet(std::size_t count, std::size_t steps, std::size_t step,
                                 std::mt19937_64& engine) {
  std::set<std::size_t> drawn;
  while (drawn.size() < count) drawn.insert(engine() % steps * step);
  return {drawn.begin(), drawn.end()};
}

}  // namespace

TrainedTriple RelativeXyz(const BandShares& shares, std::span<const double> relative_to_sun) {
  TrainedTriple xyz{};
  for (std::size_t i = 0; i < shares.wavelengths_nm.size(); ++i) {
    const double light = relative_to_sun[FineIndex(shares.wavelengths_nm[i])];
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += shares.share[c][i] * light;
  }
  return xyz;
}

TrainedTriple RelativeXyz(std::span<const double> relative_to_sun) {
  const Rows& rows = ExactRows();
  return {Dot(rows[0], relative_to_sun), Dot(rows[1], relative_to_sun),
          Dot(rows[2], relative_to_sun)};
}

ColourErrors ErrorsOf(std::span<const TrainedTriple> relative_xyz,
                      std::span<const SkySpectrum> spectra) {
  ALPENGLOW_ENSURE(relative_xyz.size(), ==, spectra.size());
  ALPENGLOW_ENSURE(spectra.size(), >, std::size_t{0});
  std::vector<double> errors;
  ColourErrors result;
  for (std::size_t i = 0; i < spectra.size(); ++i) {
    const TrainedTriple exact = RelativeXyz(spectra[i].relative_to_sun);
    const double exposure = kLuminance / exact[1];
    errors.push_back(
        Ciede2000(Exposed(exact, exposure), Exposed(relative_xyz[i], exposure), kWhite));
    result.mean += errors.back() / static_cast<double>(spectra.size());
  }
  std::sort(errors.begin(), errors.end());
  result.count = errors.size();
  result.percentile95 = errors[errors.size() * 95 / 100];
  result.greatest = errors.back();
  return result;
}

ColourErrors ErrorsOf(const BandShares& shares, std::span<const SkySpectrum> spectra) {
  std::vector<TrainedTriple> colours;
  for (const SkySpectrum& spectrum : spectra) {
    colours.push_back(RelativeXyz(shares, spectrum.relative_to_sun));
  }
  return ErrorsOf(colours, spectra);
}

std::vector<SkySpectrum> OfRegime(SkyRegime regime, std::span<const SkySpectrum> spectra) {
  std::vector<SkySpectrum> chosen;
  for (const SkySpectrum& spectrum : spectra) {
    if (spectrum.regime == regime) chosen.push_back(spectrum);
  }
  return chosen;
}

BandTrainer::BandTrainer(std::span<const SkySpectrum> spectra)
    : n_(FineWavelengths().size()), products_(9 * n_ * n_, 0.0), with_exact_(3 * n_, 0.0) {
  for (const SkySpectrum& spectrum : spectra) {
    Accumulate(spectrum,
               WeightOf(spectrum.regime) / static_cast<double>(CountOf(spectrum.regime, spectra)));
  }
  std::vector<double> exact;
  for (const std::vector<double>& row : ExactRows()) {
    exact.insert(exact.end(), row.begin(), row.end());
  }
  const std::span<const double> products(products_);
  for (std::size_t u = 0; u < 3 * n_; ++u) {
    with_exact_[u] = Dot(products.subspan(u * 3 * n_, 3 * n_), exact);
  }
  exact_ = Dot(with_exact_, exact);
}

void BandTrainer::Accumulate(const SkySpectrum& spectrum, double weight) {
  const TrainedTriple exact = RelativeXyz(spectrum.relative_to_sun);
  const double exposure = kLuminance / exact[1];
  const std::array<TrainedTriple, 3> metric = MetricAt(Exposed(exact, exposure));
  const std::vector<double>& light = spectrum.relative_to_sun;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t d = 0; d < 3; ++d) {
      const double factor = weight * metric[c][d] * exposure * exposure;
      for (std::size_t i = 0; i < n_; ++i) {
        double* row = &products_[(c * n_ + i) * 3 * n_ + d * n_];
        for (std::size_t j = 0; j < n_; ++j) row[j] += factor * light[i] * light[j];
      }
    }
  }
}

// Minimises  m P m - 2 b m + ridge |m - start|^2  over m = start + change, with the changes of a
// row summing to 0: the last band's change is minus the sum of the others'.
std::vector<double> BandTrainer::Change(std::span<const double> products,
                                        std::span<const double> gradient) {
  constexpr double kRidge = 1e-4;  // in units of CIEDE2000 squared; shares are of order 1
  const std::size_t all = gradient.size();
  const std::size_t bands = all / 3;
  const std::size_t each = bands - 1;
  const std::size_t free = 3 * each;
  const auto from = [&](std::size_t u) { return u / each * bands + u % each; };
  const auto last = [&](std::size_t u) { return u / each * bands + each; };
  std::vector<double> matrix(free * free), right(free);
  for (std::size_t u = 0; u < free; ++u) {
    right[u] = gradient[from(u)] - gradient[last(u)];
    for (std::size_t v = 0; v < free; ++v) {
      const double same_row = u / each == v / each ? kRidge : 0.0;
      matrix[u * free + v] = products[from(u) * all + from(v)] - products[from(u) * all + last(v)] -
                             products[last(u) * all + from(v)] + products[last(u) * all + last(v)] +
                             (u == v ? kRidge : 0.0) + same_row;
    }
  }
  const std::vector<double> reduced = SolvePositiveDefinite(std::move(matrix), std::move(right));
  std::vector<double> change(all, 0.0);
  for (std::size_t u = 0; u < free; ++u) {
    change[from(u)] += reduced[u];
    change[last(u)] -= reduced[u];
  }
  return change;
}

BandTrainer::Fitted BandTrainer::FitSet(const Set& set) const {
  const std::size_t bands = set.size();
  const std::size_t all = 3 * bands;
  const auto at = [&](std::size_t u) { return u / bands * n_ + set[u % bands]; };
  Fitted fitted{BrokenLineShares(set), exact_};
  std::vector<double> shares;
  for (const auto& row : fitted.share) shares.insert(shares.end(), row.begin(), row.end());
  std::vector<double> products(all * all), gradient(all);
  for (std::size_t u = 0; u < all; ++u) {
    for (std::size_t v = 0; v < all; ++v) products[u * all + v] = products_[at(u) * 3 * n_ + at(v)];
    gradient[u] =
        with_exact_[at(u)] - Dot(std::span<const double>(products).subspan(u * all, all), shares);
  }
  const std::vector<double> change = Change(products, gradient);
  for (std::size_t u = 0; u < all; ++u) shares[u] += change[u];
  for (std::size_t u = 0; u < all; ++u) {
    fitted.cost +=
        shares[u] * (Dot(std::span<const double>(products).subspan(u * all, all), shares) -
                     2.0 * with_exact_[at(u)]);
    fitted.share[u / bands][u % bands] = shares[u];
  }
  return fitted;
}

BandShares BandTrainer::Fit(std::span<const double> wavelengths_nm) const {
  Set set;
  for (const double wavelength_nm : wavelengths_nm) set.push_back(FineIndex(wavelength_nm));
  return {{wavelengths_nm.begin(), wavelengths_nm.end()}, FitSet(set).share};
}

BandTrainer::Set BandTrainer::Descend(Set set, std::size_t step) const {
  double best = FitSet(set).cost;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t band = 0; band < set.size(); ++band) {
      const std::size_t low = band == 0 ? 0 : set[band - 1] + step;
      const std::size_t high = band + 1 == set.size() ? n_ : set[band + 1];
      Set trial = set;
      for (trial[band] = low; trial[band] < high; trial[band] += step) {
        const double cost = FitSet(trial).cost;
        if (cost >= best) continue;
        best = cost;
        set = trial;
        moved = true;
      }
    }
  }
  return set;
}

std::vector<double> BandTrainer::Search(int bands, int step_nm) const {
  const std::vector<double> fine = FineWavelengths();
  const auto step = static_cast<std::size_t>(step_nm / (fine[1] - fine[0]));
  constexpr int kStarts = 48;
  std::mt19937_64 engine(1);
  Set best;
  for (int start = 0; start < kStarts; ++start) {
    const Set found =
        Descend(DrawSet(static_cast<std::size_t>(bands), n_ / step, step, engine), step);
    if (best.empty() || FitSet(found).cost < FitSet(best).cost) best = found;
  }
  std::vector<double> wavelengths_nm;
  for (const std::size_t i : best) wavelengths_nm.push_back(fine[i]);
  return wavelengths_nm;
}

}  // namespace alpenglow::lut
