// SPDX-License-Identifier: MIT
#include "renderer/surface/colour_drape.h"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/gdal_file.h"
#include "renderer/surface/drape_file.h"

namespace alpenglow::renderer {
namespace {

constexpr int kGridNodes = 33;  // of the grid of places, per side

using Pixel = std::array<std::uint16_t, 4>;

// Throws the fault of PROJ instead of its consequences.
void RequireProj(const std::filesystem::path& file) {
  if (const std::string fault = FaultOfProj(); !fault.empty()) RefuseFile(file, fault);
}

/// Maps longitude and latitude to pixels, by the file's own coordinate system.
class Georeference {
 public:
  /// Returns empty for a file without a georeference.
  static std::optional<Georeference> Of(const std::filesystem::path& file, GDALDataset& dataset) {
    Georeference reference;
    const OGRSpatialReference* crs = dataset.GetSpatialRef();
    std::array<double, 6> forward{};
    if (dataset.GetGeoTransform(forward.data()) != CE_None) return std::nullopt;
    if (crs == nullptr || crs->IsEmpty()) {
      RequireProj(file);
      return std::nullopt;
    }
    const bool is_finite = std::all_of(forward.begin(), forward.end(),
                                       [](double term) { return std::isfinite(term); });
    if (!is_finite || GDALInvGeoTransform(forward.data(), reference.pixel_from_crs_.data()) == 0)
      RefuseFile(file, "has a geotransform that cannot be inverted");
    OGRSpatialReference own = CrsOfTheEarth(file, dataset);
    own.StripVertical();
    own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference wgs84;
    wgs84.SetWellKnownGeogCS("WGS84");
    wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (own.IsGeographic() != 0) reference.turn_ = 2.0 * kPi / own.GetAngularUnits();
    reference.near_x_ = forward[0] + 0.5 * (forward[1] * dataset.GetRasterXSize() +
                                            forward[2] * dataset.GetRasterYSize());
    reference.crs_from_geographic_.reset(OGRCreateCoordinateTransformation(&wgs84, &own));
    if (!reference.crs_from_geographic_) {
      RequireProj(file);
      RefuseFile(file,
                 "has a coordinate system that cannot be reached from longitude and latitude");
    }
    return reference;
  }

  /// Counts whole turns of longitude so that places near this one lie beside it, and this one
  /// beside the picture.
  void CentreOn(const Place& place) {
    if (const auto xy = CrsOf(place)) near_x_ = (*xy)[0];
  }

  [[nodiscard]] std::array<double, 2> PixelOf(const Place& place) const {
    const auto xy = CrsOf(place);
    if (!xy)
      return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const auto [x, y] = *xy;
    return {pixel_from_crs_[0] + pixel_from_crs_[1] * x + pixel_from_crs_[2] * y,
            pixel_from_crs_[3] + pixel_from_crs_[4] * x + pixel_from_crs_[5] * y};
  }

  /// Returns the columns of a full turn of longitude; 0 where columns do not follow longitudes.
  [[nodiscard]] double ColumnsOfTurn() const {
    return pixel_from_crs_[4] == 0.0 ? std::abs(pixel_from_crs_[1]) * turn_ : 0.0;
  }

 private:
  [[nodiscard]] std::optional<std::array<double, 2>> CrsOf(const Place& place) const {
    double x = place.longitude_deg, y = place.latitude_deg;
    if (crs_from_geographic_->Transform(1, &x, &y) == 0) return std::nullopt;
    if (turn_ > 0.0) x -= turn_ * std::round((x - near_x_) / turn_);
    return std::array<double, 2>{x, y};
  }

  std::array<double, 6> pixel_from_crs_{};
  double turn_ = 0.0;    // of longitude, in the unit of x; 0 on projected maps
  double near_x_ = 0.0;  // longitudes are counted within half a turn of this one
  std::unique_ptr<OGRCoordinateTransformation> crs_from_geographic_;
};

struct Rectangle {
  double west, east, south, north;  // x and y of the frame
};

Rectangle BoundsOf(const TriangleMesh& mesh) {
  Rectangle bounds{
      std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
      std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto& position : mesh.positions) {
    const auto x = static_cast<double>(position[0]), y = static_cast<double>(position[1]);
    bounds = {std::min(bounds.west, x), std::max(bounds.east, x), std::min(bounds.south, y),
              std::max(bounds.north, y)};
  }
  return bounds;
}

}  // namespace

// Albedos are linear in colours that are not too saturated, so three differences around grey
// suffice.
BandsOfColour::BandsOfColour(std::span<const double> wavelengths_nm) {
  constexpr double kGrey = 0.5, kStep = 0.05;
  const std::vector<double> grey = AlbedoFromLinearSrgb({kGrey, kGrey, kGrey}, wavelengths_nm);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::array<double, 3> rgb{kGrey, kGrey, kGrey};
    rgb[channel] += kStep;
    const std::vector<double> moved = AlbedoFromLinearSrgb(rgb, wavelengths_nm);
    of_primary_[channel] = Spectrum(grey.size());
    for (std::size_t band = 0; band < grey.size(); ++band) {
      of_primary_[channel][band] = static_cast<float>((moved[band] - grey[band]) / kStep);
    }
  }
}

Spectrum BandsOfColour::Albedo(const std::array<double, 3>& rgb) const {
  Spectrum albedo(of_primary_[0].size());
  for (std::size_t band = 0; band < albedo.size(); ++band) {
    float sum = 0.0F;
    for (std::size_t channel = 0; channel < 3; ++channel)
      sum += static_cast<float>(rgb[channel]) * of_primary_[channel][band];
    albedo[band] = std::clamp(sum, 0.0F, 1.0F);
  }
  return albedo;
}

std::shared_ptr<const ColourDrape> ColourDrape::Of(const Scene& scene, const SceneGround& ground) {
  const std::filesystem::path& file = scene.terrain.Drape();
  if (file.empty()) return nullptr;
  if (!ground.terrain) RefuseFile(file, "there is no terrain under it");
  const QuietGdal quiet;
  return std::shared_ptr<const ColourDrape>(
      new ColourDrape(file, scene.terrain.colour.empty(), ground));
}

std::shared_ptr<const ColourDrape> ColourDrape::In(const LocalFrame& frame) const {
  auto moved = std::make_shared<ColourDrape>(*this);
  const auto axis = [&](const glm::dvec3& of_frame) {
    return frame_.EnuFromEcef(frame.EcefFromEnu(Vector<Enu>{of_frame})).xyz;
  };
  moved->turn_ = {axis({1.0, 0.0, 0.0}), axis({0.0, 1.0, 0.0}), axis({0.0, 0.0, 1.0})};
  moved->origin_ = frame_.EnuFromEcef(frame.EcefFromEnu(Point<Enu>{})).xyz;
  return moved;
}

ColourDrape::ColourDrape(const std::filesystem::path& file, bool is_land_cover,
                         const SceneGround& ground)
    : frame_(ground.frame),
      radius_m_(ground.frame.ellipsoid().equatorial_radius_m),
      is_land_cover_(is_land_cover) {
  const RasterFile dataset = OpenDrape(file, is_land_cover);
  DrapePixels read = is_land_cover ? ReadLandCover(file, *dataset) : ReadColours(file, *dataset);
  note_ = std::move(read.note);
  std::vector<Level> levels;
  levels.push_back({dataset->GetRasterXSize(), dataset->GetRasterYSize(), std::move(read.pixels)});
  while (levels.back().columns > 1 && levels.back().rows > 1) {
    const Level& fine = levels.back();
    Level coarse{fine.columns / 2, fine.rows / 2, {}};
    for (int y = 0; y < coarse.rows; ++y) {
      for (int x = 0; x < coarse.columns; ++x) {
        Pixel mean;
        for (std::size_t c = 0; c < mean.size(); ++c) {
          unsigned sum = 2;
          for (const int corner : {0, 1, 2, 3}) {
            const int from = (2 * y + corner / 2) * fine.columns + 2 * x + corner % 2;
            sum += fine.pixels[static_cast<std::size_t>(from)][c];
          }
          mean[c] = static_cast<std::uint16_t>(sum / 4);
        }
        coarse.pixels.push_back(mean);
      }
    }
    levels.push_back(std::move(coarse));
  }
  const int columns = levels.front().columns, rows = levels.front().rows;
  levels_ = std::make_shared<const std::vector<Level>>(std::move(levels));
  const Rectangle bounds = BoundsOf(ground.terrain->mesh());
  first_x_m_ = bounds.west;
  first_y_m_ = bounds.south;
  step_x_m_ = std::max(bounds.east - bounds.west, 1e-3) / (kGridNodes - 1);
  step_y_m_ = std::max(bounds.north - bounds.south, 1e-3) / (kGridNodes - 1);
  auto reference = Georeference::Of(file, *dataset);
  if (reference) {
    reference->CentreOn(ground.frame.GeodeticFromEnu(Point<Enu>{
        glm::dvec3(0.5 * (bounds.west + bounds.east), 0.5 * (bounds.south + bounds.north), 0.0)}));
    columns_of_turn_ = reference->ColumnsOfTurn();
  }
  for (int row = 0; row < kGridNodes; ++row) {
    for (int column = 0; column < kGridNodes; ++column) {
      const double x = first_x_m_ + column * step_x_m_, y = first_y_m_ + row * step_y_m_;
      if (!reference) {
        places_.push_back({columns * static_cast<double>(column) / (kGridNodes - 1),
                           rows * (1.0 - static_cast<double>(row) / (kGridNodes - 1))});
        continue;
      }
      const double z = -(x * x + y * y) / (2.0 * radius_m_);  // on the sphere
      const auto [px, py] =
          reference->PixelOf(ground.frame.GeodeticFromEnu(Point<Enu>{glm::dvec3(x, y, z)}));
      places_.push_back({px, py});
    }
  }
  if (IsBesideTheLand())
    note_ = fmt::format("{}{}{}: lies beside the land of the scene, which keeps its own cover",
                        note_, note_.empty() ? "" : "; ", file.string());
  const glm::dvec2& a = places_.front();
  const glm::dvec2& b = places_.back();
  const double across = std::hypot(step_x_m_, step_y_m_) * (kGridNodes - 1);
  pixel_m_ = across / std::max(std::hypot(b.x - a.x, b.y - a.y), 1e-6);
}

bool ColourDrape::IsBesideTheLand() const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  glm::dvec2 least{kFar, kFar}, most{-kFar, -kFar};
  for (const glm::dvec2& place : places_) {
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) continue;
    least = {std::min(least.x, place.x), std::min(least.y, place.y)};
    most = {std::max(most.x, place.x), std::max(most.y, place.y)};
  }
  const Level& picture = levels_->front();
  const double first_turn = columns_of_turn_ > 0.0 ? std::ceil(-most.x / columns_of_turn_) : 0.0;
  const double turned_m = first_turn * columns_of_turn_;
  return !(least.x + turned_m <= picture.columns && most.x + turned_m >= 0.0 &&
           least.y <= picture.rows && most.y >= 0.0);
}

std::array<double, 4> ColourDrape::Bilinear(std::size_t number, const glm::dvec2& at) const {
  const Level& level = (*levels_)[number];
  const double scale = 1.0 / static_cast<double>(std::size_t{1} << number);
  const double x = std::clamp(at.x * scale - 0.5, 0.0, level.columns - 1.0);
  const double y = std::clamp(at.y * scale - 0.5, 0.0, level.rows - 1.0);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double fx = x - column, fy = y - row;
  std::array<double, 4> seen{};
  for (const int corner : {0, 1, 2, 3}) {
    const int c = std::min(column + corner % 2, level.columns - 1);
    const int r = std::min(row + corner / 2, level.rows - 1);
    const double weight = (corner % 2 == 1 ? fx : 1.0 - fx) * (corner / 2 == 1 ? fy : 1.0 - fy);
    const auto& pixel =
        level.pixels[static_cast<std::size_t>(r) * static_cast<std::size_t>(level.columns) +
                     static_cast<std::size_t>(c)];
    for (std::size_t k = 0; k < 4; ++k) seen[k] += weight * pixel[k] / 65535.0;
  }
  return seen;
}

std::optional<std::array<double, 3>> ColourDrape::At(const glm::dvec3& point, double altitude_m,
                                                     double footprint_m) const {
  const glm::dvec3 own = turn_ * point + origin_;
  // Project the point radially onto the sphere.
  const double shrink = radius_m_ / (radius_m_ + altitude_m);
  const double gx = std::clamp((own.x * shrink - first_x_m_) / step_x_m_, 0.0,
                               static_cast<double>(kGridNodes - 1));
  const double gy = std::clamp((own.y * shrink - first_y_m_) / step_y_m_, 0.0,
                               static_cast<double>(kGridNodes - 1));
  const int column = std::min(static_cast<int>(gx), kGridNodes - 2);
  const int row = std::min(static_cast<int>(gy), kGridNodes - 2);
  const double fx = gx - column, fy = gy - row;
  const glm::dvec2* low = &places_[static_cast<std::size_t>(row * kGridNodes + column)];
  const glm::dvec2* high = low + kGridNodes;
  const glm::dvec2 south = low[0] + fx * (low[1] - low[0]);
  const glm::dvec2 north = high[0] + fx * (high[1] - high[0]);
  glm::dvec2 at = south + fy * (north - south);
  const Level& finest_level = levels_->front();
  if (columns_of_turn_ > 0.0 && (at.x < 0.0 || at.x > finest_level.columns))
    at.x -= columns_of_turn_ * std::floor(at.x / columns_of_turn_);
  if (!(at.x >= 0.0 && at.y >= 0.0 && at.x <= finest_level.columns && at.y <= finest_level.rows))
    return std::nullopt;
  const double wanted = std::log2(std::max(footprint_m / pixel_m_, 1.0));
  const double finest = std::min(std::floor(wanted), static_cast<double>(levels_->size() - 1));
  const auto level = static_cast<std::size_t>(finest);
  std::array<double, 4> seen = Bilinear(level, at);
  if (level + 1 < levels_->size()) {
    const std::array<double, 4> coarse = Bilinear(level + 1, at);
    for (std::size_t k = 0; k < 4; ++k) seen[k] += (wanted - finest) * (coarse[k] - seen[k]);
  }
  if (seen[3] < 0.5) return std::nullopt;
  return std::array<double, 3>{seen[0] / seen[3], seen[1] / seen[3], seen[2] / seen[3]};
}

}  // namespace alpenglow::renderer
