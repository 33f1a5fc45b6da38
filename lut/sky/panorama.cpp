// SPDX-License-Identifier: MIT
#include "lut/sky/panorama.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>

#include "atmosphere/api/conversions.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"
#include "atmosphere/base/names.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"
#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

constexpr int kSteps = 48;  // over half a turn

PolarisedLight Along(const SingleScattering<float>& air,
                     const MultipleScattering& multiple_scattering, const ViewRay& ray) {
  const RaySamples<float> samples = air.Sample(ray, {.nodes = 16, .dark_samples = true});
  PolarisedLight light{Spectrum(air.bands()), Spectrum(air.bands())};
  if (samples.count == 0 || !air.medium().polarised) return light;
  light = PolarisedOnce(air.medium(), air.Scatter(samples), ray);
  const PolarisedLight more = multiple_scattering.PolarisationAlong(samples, ray.nu);
  for (std::size_t band = 0; band < air.bands(); ++band) {
    light.q[band] += more.q[band];
    light.u[band] += more.u[band];
  }
  return light;
}

constexpr EnumNames kCentres{{
    std::pair{PanoramaCentre::kNorth, "north"},
    {PanoramaCentre::kBlender, "blender"},
    {PanoramaCentre::kOpenExr, "openexr"},
    {PanoramaCentre::kThreeJs, "three"},
    {PanoramaCentre::kUnity, "unity"},
    {PanoramaCentre::kGodot, "godot"},
}};

/// View directions of the pixels of a latitude-longitude picture.
struct PanoramaGrid {
  int width, height;
  double centre_azimuth_rad;

  [[nodiscard]] double ZenithAngle(double y) const { return kPi * y / height; }
  [[nodiscard]] double Azimuth(double x) const {
    return centre_azimuth_rad + 2.0 * kPi * (x / width - 0.5);
  }
  /// Returns the solid angle of a pixel of a row [sr].
  [[nodiscard]] double SolidAngle(int y) const {
    return 2.0 * kPi / width * (std::cos(ZenithAngle(y)) - std::cos(ZenithAngle(y + 1.0)));
  }
};

/// Returns a row-major 3 x bands matrix: linear sRGB [cd/m^2] from radiance per unit solar
/// irradiance.
std::vector<float> SrgbFromRelative(const Medium& medium, double sun_distance) {
  const BandColour colour(medium.wavelengths_nm);
  const std::span<const double> matrix = colour.linear_srgb_from_bands();
  const std::size_t bands = medium.wavelengths_nm.size();
  std::vector<float> scaled(matrix.size());
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    scaled[i] = static_cast<float>(matrix[i] * medium.solar_irradiance[i % bands] /
                                   (sun_distance * sun_distance));
  }
  return scaled;
}

std::array<float, 3> Srgb(const std::vector<float>& matrix, std::span<const float> light) {
  std::array<float, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t band = 0; band < light.size(); ++band)
      rgb[c] += matrix[c * light.size() + band] * light[band];
  }
  return rgb;
}

double Luminance(const std::array<float, 3>& rgb) {
  return shared::Luminance<double>(double{rgb[0]}, double{rgb[1]}, double{rgb[2]});
}

/// A layer and the position of its channels in a picture.
struct LayerPlace {
  StokesLayer layer;
  std::size_t first_channel;
};

std::vector<LayerPlace> AddPanoramaLayers(const std::vector<std::string>& names, HdrImage& image) {
  std::vector<LayerPlace> places;
  for (const StokesLayer layer : StokesLayersFromNames(names)) {
    places.push_back({layer, image.layers.size()});
    for (const std::string& channel : ChannelsOf(layer))
      image.layers.push_back({channel, std::vector<float>(image.rgb.size(), 0.0F)});
  }
  return places;
}

/// Writes the values of the layers in a pixel. @param q, u  linear sRGB.
void SetLayers(const std::vector<LayerPlace>& places, std::size_t pixel,
               const std::array<float, 3>& q, const std::array<float, 3>& u, HdrImage& image) {
  for (const LayerPlace& place : places) {
    ImageLayer* channel = &image.layers[place.first_channel];
    if (place.layer == StokesLayer::kPolarisation) {
      const auto values = DegreeAndAngle(Luminance(image.rgb[pixel]), Luminance(q), Luminance(u));
      for (std::size_t i = 0; i < values.size(); ++i) channel[i].values[pixel] = values[i];
    } else {
      const auto& values = place.layer == StokesLayer::kQ ? q : u;
      for (std::size_t i = 0; i < values.size(); ++i) channel[i].values[pixel] = values[i];
    }
  }
}

/// A part of a pixel that lies on the disk.
struct DiskPiece {
  int x, y;
  double zenith_angle_rad;
  double rho;     // distance from the disk's centre, in radii
  double weight;  // its solid angle
};

// Returns the squared sine of half the angle between two directions.
double HalfSine2(double zenith_a, double zenith_b, double azimuth) {
  const double across = std::sin(0.5 * (zenith_a - zenith_b));
  const double along = std::sin(0.5 * azimuth);
  return across * across + std::sin(zenith_a) * std::sin(zenith_b) * along * along;
}

/// Parts of a pixel, by index: those from `first` on, before `last`.
struct PartsRange {
  std::int64_t first, last;
};

// Returns the parts of a pixel, of `count`, that can lie on a disk. Without this choice a small
// disk would need the work of its radius for all pixels near it.
// @param centre, half  of the disk, in pixels from the begin of this one.
PartsRange PartsAround(double centre, double half, std::int64_t count) {
  constexpr double kMargin = 2.0;  // in parts: more than rounding moves them
  const auto parts = static_cast<double>(count);
  const auto part = [parts](double at, double margin) {
    return static_cast<std::int64_t>(std::clamp(at * parts + margin, 0.0, parts));
  };
  return {part(centre - half, -kMargin), part(centre + half, kMargin)};
}

// Returns the largest difference in azimuth between the centre of a disk and its points at a zenith
// angle.
double HalfWidthOfDisk(double angle, double zenith, double radius) {
  const double across = std::sin(0.5 * radius), down = std::sin(0.5 * (angle - zenith));
  const double left = std::max((across - down) * (across + down), 0.0);
  const double reach = std::sin(angle) * std::sin(zenith);
  return left >= reach ? 2.0 * kPi : 2.0 * std::asin(std::sqrt(left / reach));
}

/// Divides all pixels near the sun into parts that are small relative to its disk.
std::vector<DiskPiece> PiecesOfDisk(const PanoramaGrid& grid, const SunInSky& sun) {
  constexpr int kPiecesPerRadius = 12;
  const double zenith = 0.5 * kPi - sun.elevation_rad();
  const double radius = sun.angular_radius_rad();
  const double sun_azimuth = sun.azimuth_rad();
  const auto parts_of = [radius](double pixel_rad) {
    return static_cast<std::int64_t>(
        std::max(std::ceil(kPiecesPerRadius * pixel_rad / radius), 1.0));
  };
  const std::int64_t down = parts_of(kPi / grid.height);
  const auto row_of = [&](double angle) {
    return std::clamp(static_cast<int>(std::floor(angle / kPi * grid.height)), 0, grid.height - 1);
  };
  std::vector<DiskPiece> pieces;
  for (int y = row_of(zenith - radius); y <= row_of(zenith + radius); ++y) {
    const PartsRange rows =
        PartsAround(zenith / kPi * grid.height - y, radius / kPi * grid.height, down);
    for (std::int64_t j = rows.first; j < rows.last; ++j) {
      const double angle =
          grid.ZenithAngle(y + (static_cast<double>(j) + 0.5) / static_cast<double>(down));
      // Columns narrow towards the zenith and the nadir, and need fewer parts there.
      const std::int64_t across = parts_of(2.0 * kPi / grid.width * std::sin(angle));
      const double weight = std::sin(angle) / static_cast<double>(across);
      const double width_rad = HalfWidthOfDisk(angle, zenith, radius);
      for (int x = 0; x < grid.width; ++x) {
        const double from_sun = grid.Azimuth(x) - sun_azimuth;
        const double centre =
            std::remainder(-from_sun - kPi / grid.width, 2.0 * kPi) + kPi / grid.width;
        const PartsRange columns = PartsAround(centre / (2.0 * kPi) * grid.width,
                                               width_rad / (2.0 * kPi) * grid.width, across);
        for (std::int64_t i = columns.first; i < columns.last; ++i) {
          const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(across);
          const double azimuth = grid.Azimuth(x + at) - sun_azimuth;
          const double rho =
              2.0 * std::asin(std::sqrt(std::min(HalfSine2(angle, zenith, azimuth), 1.0))) / radius;
          if (rho >= 1.0) continue;
          pieces.push_back({x, y, angle, rho, weight});
        }
      }
    }
  }
  return pieces;
}

/// Returns the fraction of the disk's light in each part, in each band.
std::vector<Spectrum> SharesOf(const std::vector<DiskPiece>& pieces,
                               const std::vector<double>& wavelengths_nm) {
  std::vector<Spectrum> shares(pieces.size(), Spectrum(wavelengths_nm.size()));
  for (std::size_t band = 0; band < wavelengths_nm.size(); ++band) {
    const auto light = [&](const DiskPiece& piece) {
      return piece.weight * LimbDarkening(piece.rho, wavelengths_nm[band]);
    };
    double total = 0.0;
    for (const DiskPiece& piece : pieces) total += light(piece);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      shares[i][band] = static_cast<float>(light(pieces[i]) / total);
    }
  }
  return shares;
}

void DrawSunDisk(const SingleScattering<float>& air, const PanoramaOptions& options,
                 const PanoramaGrid& grid, const std::vector<float>& srgb, HdrImage& image) {
  const std::vector<DiskPiece> pieces = PiecesOfDisk(grid, options.sun);
  const std::vector<Spectrum> shares = SharesOf(pieces, air.medium().wavelengths_nm);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const DiskPiece& piece = pieces[i];
    Spectrum seen = air.TransmittanceToSpace(options.altitude_m, std::cos(piece.zenith_angle_rad));
    for (std::size_t band = 0; band < seen.size(); ++band) seen[band] *= shares[i][band];
    const std::array<float, 3> rgb = Srgb(srgb, seen.values());
    const auto of_pixel = static_cast<float>(1.0 / grid.SolidAngle(piece.y));
    for (std::size_t c = 0; c < 3; ++c) image.at(piece.x, piece.y)[c] += of_pixel * rgb[c];
  }
}

/// Bitmap of a letter: five rows of five bits, the leftmost bit highest.
using Letter = std::array<unsigned, 5>;
constexpr std::array<Letter, 4> kCompassLetters{{
    {0b10001, 0b11001, 0b10101, 0b10011, 0b10001},  // N
    {0b11111, 0b10000, 0b11110, 0b10000, 0b11111},  // E
    {0b01111, 0b10000, 0b01110, 0b00001, 0b11110},  // S
    {0b10001, 0b10001, 0b10101, 0b10101, 0b01010},  // W
}};

// Paints the letters twice as bright as the brightest pixel of the middle row, 10 degrees high.
void PaintCompass(const PanoramaGrid& grid, HdrImage& image) {
  float ink = 1e-3F;
  for (int x = 0; x < grid.width; ++x) ink = std::max(ink, 2.0F * image.at(x, grid.height / 2)[1]);
  constexpr double kCell_rad = 2.0 * kRadiansPerDegree;
  for (int y = 0; y < grid.height; ++y) {
    const double down = (grid.ZenithAngle(y + 0.5) - 0.5 * kPi) / kCell_rad + 2.5;
    for (int x = 0; x < grid.width; ++x) {
      const double quarter = 2.0 * grid.Azimuth(x + 0.5) / kPi;
      const double nearest = std::round(quarter);
      const double across = (quarter - nearest) * 0.5 * kPi / kCell_rad + 2.5;
      if (down < 0.0 || down >= 5.0 || across < 0.0 || across >= 5.0) continue;
      const auto letter = static_cast<std::size_t>(static_cast<int>(nearest + 8.0) % 4);
      const unsigned row = kCompassLetters[letter][static_cast<std::size_t>(down)];
      if ((row >> (4U - static_cast<unsigned>(across)) & 1U) != 0U)
        image.at(x, y) = {ink, ink, ink};
    }
  }
}

// Returns a finer size: the computation time of a picture allows more than that of a view built for
// every frame.
SkyViewSize FineSize(const SkyViewSize& size) {
  return {size.sky_rows * 3 / 2, size.ground_rows * 3 / 2, 2 * size.azimuths - 1, 24};
}

}  // namespace

PolarisedRow::PolarisedRow(const SingleScattering<float>& air,
                           const MultipleScattering& multiple_scattering, double altitude_m,
                           double mu_s, double zenith_angle_rad) {
  const double mu = std::cos(zenith_angle_rad);
  const double sines =
      std::sin(zenith_angle_rad) * std::sqrt(std::max((1.0 - mu_s) * (1.0 + mu_s), 0.0));
  for (int k = 0; k <= kSteps; ++k) {
    const double nu = std::clamp(mu * mu_s + sines * std::cos(kPi * k / kSteps), -1.0, 1.0);
    nodes_.push_back(Along(air, multiple_scattering, {std::max(altitude_m, 0.0), mu, mu_s, nu}));
  }
}

// Interpolates with Lagrange's cubic through the four surrounding nodes.
PolarisedLight PolarisedRow::At(double azimuth_rad) const {
  const double turn = std::remainder(azimuth_rad, 2.0 * kPi) / kPi * kSteps;
  const int first = static_cast<int>(std::floor(turn));
  const double t = turn - first;
  const std::array<double, 4> weight{
      -t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
      -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
  const std::size_t bands = nodes_.front().q.size();
  PolarisedLight light{Spectrum(bands), Spectrum(bands)};
  for (int i = 0; i < 4; ++i) {
    int k = first - 1 + i;
    if (k > kSteps) k -= 2 * kSteps;  // the same azimuth
    if (k < -kSteps) k += 2 * kSteps;
    const PolarisedLight& node = nodes_[static_cast<std::size_t>(std::abs(k))];
    const auto of_q = static_cast<float>(weight.at(static_cast<std::size_t>(i)));
    const float of_u = k < 0 ? -of_q : of_q;
    for (std::size_t band = 0; band < bands; ++band) {
      light.q[band] += of_q * node.q[band];
      light.u[band] += of_u * node.u[band];
    }
  }
  return light;
}

PanoramaCentre PanoramaCentreFromName(const std::string& name) {
  if (name == "geographic") return PanoramaCentre::kNorth;
  return kCentres.Named(name, "orientation is \"{0}\"; it must be {2}");
}

std::string NameOf(PanoramaCentre centre) { return kCentres.Of(centre); }

double CentreAzimuth(PanoramaCentre centre) {
  switch (centre) {
    case PanoramaCentre::kNorth:
      return 0.0;
    case PanoramaCentre::kBlender:
    case PanoramaCentre::kThreeJs:
    case PanoramaCentre::kUnity:
      return 0.5 * kPi;
    case PanoramaCentre::kOpenExr:
    case PanoramaCentre::kGodot:
      return kPi;
  }
  throw InputError("centre is no PanoramaCentre");
}

HdrImage RenderPanorama(const SingleScattering<float>& air,
                        const MultipleScattering& multiple_scattering,
                        const PanoramaOptions& options, const std::function<void()>& row_done) {
  HdrImage image(options.width, options.height);
  image.is_panorama = true;
  const double mu_s = std::sin(SunForAir(options.sun).elevation_rad());
  const SkyView view = SkyView(air, multiple_scattering, options.altitude_m, mu_s,
                               FineSize(SkyViewSizeFor(air.medium(), options.altitude_m, mu_s)))
                           .WithSunSeenAt(0.5 * kPi - options.sun.elevation_rad());
  const PanoramaGrid grid{options.width, options.height, CentreAzimuth(options.centre)};
  std::vector<double> from_sun;
  for (int x = 0; x < grid.width; ++x)
    from_sun.push_back(grid.Azimuth(x + 0.5) - options.sun.azimuth_rad());
  const SkyAzimuths azimuths(view, from_sun);
  const std::vector<float> srgb = SrgbFromRelative(air.medium(), options.sun.distance_au);
  const std::vector<LayerPlace> layers = AddPanoramaLayers(options.layers, image);
  const auto add_polarisation = [&](int y) {
    const PolarisedRow row(air, multiple_scattering, options.altitude_m, mu_s,
                           grid.ZenithAngle(y + 0.5));
    for (int x = 0; x < grid.width; ++x) {
      const PolarisedLight light = row.At(from_sun[static_cast<std::size_t>(x)]);
      SetLayers(layers, static_cast<std::size_t>(y) * from_sun.size() + static_cast<std::size_t>(x),
                Srgb(srgb, light.q.values()), Srgb(srgb, light.u.values()), image);
    }
  };
  oneapi::tbb::parallel_for(0, grid.height, [&](int y) {
    if (Interrupted()) return;
    std::vector<float> row(azimuths.count() * view.stride());
    view.FillRow(grid.ZenithAngle(y + 0.5), azimuths, row);
    for (int x = 0; x < grid.width; ++x) {
      image.at(x, y) = Srgb(
          srgb, std::span(row).subspan(static_cast<std::size_t>(x) * view.stride(), view.bands()));
    }
    if (!layers.empty()) add_polarisation(y);
    row_done();
  });
  ThrowIfInterrupted();
  if (options.draws_compass) PaintCompass(grid, image);
  if (options.draws_sun) DrawSunDisk(air, options, grid, srgb, image);
  for (const auto& pixel : image.rgb) RequireFinite(std::span(pixel), "light of a panorama");
  return image;
}

double HorizontalIlluminance(const SingleScattering<float>& air,
                             const MultipleScattering& multiple_scattering, double altitude_m,
                             const SunInSky& sun) {
  const Medium& medium = air.medium();
  const double h = std::max(altitude_m, 0.0);
  const double mu_s = std::sin(sun.elevation_rad());
  const double horizon = std::cos(SkyViewMap(medium, h, mu_s).horizon_zenith_angle_rad());
  const VisibleDisk disk = DiskOverHorizon(mu_s, horizon, sun.angular_radius_rad());
  const double mu = disk.mu_s_effective;
  const Spectrum direct = air.TransmittanceToSpace(h, mu);
  const Spectrum sky =
      multiple_scattering.SkyIrradiance(h, std::sin(SunForAir(sun).elevation_rad()));
  std::vector<double> light;
  for (std::size_t band = 0; band < sky.size(); ++band) {
    light.push_back(medium.solar_irradiance[band] / (sun.distance_au * sun.distance_au) *
                    (double{sky[band]} + disk.fraction * std::max(mu, 0.0) * double{direct[band]}));
  }
  RequireFinite(std::span<const double>(light), "light of the ground");
  return BandColour(medium.wavelengths_nm).Xyz(light)[1];
}

}  // namespace alpenglow::lut
