// SPDX-License-Identifier: MIT
// Rays of a camera: directions, lens and iris, the filter of a pixel and the samples of its rays.
#include "renderer/camera/camera_rays.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

using Points = std::vector<std::array<double, 2>>;

constexpr double kDirectionTolerance = 1e-12;
const double kHalfRoot = std::sqrt(0.5);

void ExpectDirection(const glm::dvec3& actual, const glm::dvec3& expected) {
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(actual[axis], expected[axis], kDirectionTolerance);
}

/// Returns the rays of a pinhole camera; angles are in degrees.
CameraRays RaysOf(double heading, double pitch, double roll, double fov, int width = 200,
                  int height = 100) {
  return {CameraFromDegrees({}, heading, pitch, roll, fov), width, height};
}

// Hard case 44.
TEST(CameraRays, DirectionsFollowHeadingPitchAndRoll) {
  ExpectDirection(RaysOf(90.0, 0.0, 0.0, 60.0).Direction(100.0, 50.0), {1.0, 0.0, 0.0});
  ExpectDirection(RaysOf(0.0, 90.0, 0.0, 60.0).Direction(100.0, 50.0), {0.0, 0.0, 1.0});
  const CameraRays north = RaysOf(0.0, 0.0, 0.0, 90.0);
  ExpectDirection(north.Direction(200.0, 50.0), {kHalfRoot, kHalfRoot, 0.0});
  EXPECT_GT(north.Direction(100.0, 0.0).z, 0.0) << "rows count downwards";
  // The camera is rolled clockwise, so that the right edge of the picture looks down.
  ExpectDirection(RaysOf(0.0, 0.0, 90.0, 90.0).Direction(200.0, 50.0),
                  {0.0, kHalfRoot, -kHalfRoot});
}

TEST(CameraRays, APolariserTurnsWithTheCameraAndAbsorbsAlongOneAxis) {
  const auto camera = [](double roll, double polariser) {
    Camera with = CameraFromDegrees({}, 0.0, 0.0, roll, 90.0);
    with.polariser_rad = polariser * kRadiansPerDegree;
    return CameraRays(with, 200, 100);
  };
  EXPECT_FALSE(RaysOf(0.0, 0.0, 0.0, 90.0).PassedBy({0, 1, 0}));
  const glm::dvec3 north{0.0, 1.0, 0.0};
  ExpectDirection(*camera(0.0, 0.0).PassedBy(north), {0.0, 0.0, 1.0});
  ExpectDirection(*camera(0.0, 90.0).PassedBy(north), {1.0, 0.0, 0.0});
  ExpectDirection(*camera(0.0, 45.0).PassedBy(north), {kHalfRoot, 0.0, kHalfRoot});
  ExpectDirection(*camera(45.0, 0.0).PassedBy(north), {kHalfRoot, 0.0, kHalfRoot});
  const CameraRays rays = camera(0.0, 30.0);
  const glm::dvec3 absorbed(std::cos(30.0 * kRadiansPerDegree), 0.0, -0.5);
  const glm::dvec3 oblique = rays.Direction(190.0, 5.0);
  EXPECT_NEAR(glm::dot(*rays.PassedBy(oblique), oblique), 0.0, kDirectionTolerance);
  EXPECT_NEAR(glm::dot(*rays.PassedBy(oblique), absorbed), 0.0, kDirectionTolerance);
  const ViewAxes axes = rays.AxesAt(oblique);
  EXPECT_NEAR(glm::dot(axes.up, oblique), 0.0, kDirectionTolerance);
  ExpectDirection(glm::cross(oblique, axes.up), axes.right);
}

TEST(CameraRays, APanoramaHasItsHeadingInTheCentreAndTheZenithOnTop) {
  const CameraRays all = RaysOf(0.0, 0.0, 0.0, 360.0, 360, 180);
  ExpectDirection(all.Direction(180.0, 90.0), {0.0, 1.0, 0.0});
  ExpectDirection(all.Direction(270.0, 90.0), {1.0, 0.0, 0.0});
  ExpectDirection(all.Direction(0.0, 90.0), {0.0, -1.0, 0.0});
  ExpectDirection(all.Direction(123.0, 0.0), {0.0, 0.0, 1.0});
}

TEST(CameraRays, APlaceInThePictureFollowsFromItsDirection) {
  for (const double fov : {1.0, 60.0, 170.0, 360.0}) {
    const CameraRays rays = RaysOf(33.0, -20.0, 10.0, fov, 70, 50);
    for (double y = 0.5; y < 50.0; y += 7.0) {
      for (double x = 0.5; x < 70.0; x += 7.0) {
        const auto place = rays.PlaceOf(rays.Direction(x, y));
        ASSERT_TRUE(place.has_value());
        EXPECT_NEAR((*place)[0], x, 1e-9) << fov;
        EXPECT_NEAR((*place)[1], y, 1e-9) << fov;
      }
    }
  }
  EXPECT_FALSE(RaysOf(0.0, 0.0, 0.0, 60.0).PlaceOf({0.0, -1.0, 0.0}).has_value())
      << "behind the camera";
}

// Hard case 44.
TEST(CameraRays, DirectionsAreUnitVectorsForEveryFieldOfView) {
  for (const double fov : {0.1, 1.0, 60.0, 179.0, 360.0}) {
    const CameraRays rays = RaysOf(33.0, -20.0, 10.0, fov, 7, 5);
    for (int y = 0; y <= 5; ++y) {
      for (int x = 0; x <= 7; ++x)
        EXPECT_NEAR(glm::length(rays.Direction(x, y)), 1.0, kDirectionTolerance) << fov;
    }
  }
}

constexpr double kFocal_m = 0.085, kFNumber = 1.4, kFocus_m = 12.0;

CameraRays LensCamera(int blades = 0) {
  Camera camera = CameraFromDegrees({}, 33.0, -20.0, 10.0, 24.0);
  camera.lens = ThinLens{kFNumber, kFocal_m, kFocus_m, blades, 0.2};
  return {camera, 300, 200, FrameTransform(glm::dvec3(5.0, -7.0, 100.0))};
}

TEST(CameraRays, RaysOfALensMeetInThePlaneOfFocus) {
  const CameraRays camera = LensCamera();
  const glm::dvec3 ahead = camera.Direction(150.0, 100.0);
  for (const auto& [x, y] : {std::array{10.0, 20.0}, {150.0, 100.0}, {299.0, 199.0}}) {
    const glm::dvec3 middle = camera.Direction(x, y);
    const glm::dvec3 in_focus = camera.eye() + kFocus_m / glm::dot(middle, ahead) * middle;
    for (const double u : {0.05, 0.35, 0.8}) {
      const CameraRay ray = camera.Ray(x, y, {u, 0.9});
      EXPECT_NEAR(glm::length(ray.origin - camera.eye()),
                  0.5 * kFocal_m / kFNumber * std::sqrt(0.9), kDirectionTolerance);
      EXPECT_NEAR(glm::dot(ray.origin - camera.eye(), ahead), 0.0, kDirectionTolerance);
      const glm::dvec3 offset = in_focus - ray.origin;
      EXPECT_NEAR(glm::length(offset - glm::dot(offset, ray.direction) * ray.direction), 0.0, 1e-9);
    }
  }
}

TEST(CameraRays, BlurOnTheSensorIsTheCircleOfConfusion) {
  const CameraRays camera = LensCamera();
  const glm::dvec3 ahead = camera.Direction(150.0, 100.0);
  // A sensor of width 2 v tan(fov / 2) stands at a distance v behind the lens.
  const double v = kFocal_m * kFocus_m / (kFocus_m - kFocal_m);
  for (const double z : {2.0, 11.0, 12.0, 40.0, 1e5}) {
    const double circle_m =
        kFocal_m / kFNumber * std::abs(z - kFocus_m) / z * kFocal_m / (kFocus_m - kFocal_m);
    EXPECT_NEAR(2.0 * camera.BlurRadius(z * ahead) * v, circle_m, 1e-12) << z;
    // The rays of one point of the picture are spread as much at that depth.
    const CameraRay edge = camera.Ray(150.0, 100.0, {0.0, 1.0});
    const glm::dvec3 there =
        edge.origin + z / glm::dot(edge.direction, ahead) * edge.direction - camera.eye();
    EXPECT_NEAR(glm::length(there - z * ahead) / z * v, 0.5 * circle_m, 1e-12) << z;
  }
}

TEST(CameraRays, APinholeBlursNothing) {
  const CameraRays camera = RaysOf(90.0, 0.0, 0.0, 60.0);
  EXPECT_EQ(camera.BlurRadius({5.0, 0.0, 0.0}), 0.0);
  const CameraRay ray = camera.Ray(30.0, 40.0, {0.3, 0.9});
  EXPECT_EQ(ray.origin, camera.eye());
  EXPECT_EQ(ray.direction, camera.Direction(30.0, 40.0));
}

TEST(CameraRays, BlurKeepsTheLightOfAPoint) {
  const double soft = 0.9 * LensCamera().PixelAngle();
  for (const int blades : {0, 5, 6}) {
    const CameraRays camera = LensCamera(blades);
    for (const double z : {3.0, 11.8, 12.0, 30.0, 1000.0}) {
      const glm::dvec3 point = z * (camera.Direction(170.0, 90.0) / 0.98);
      double sum = 0.0;
      constexpr int kSub = 8;
      for (int y = 60 * kSub; y < 120 * kSub; ++y) {
        for (int x = 140 * kSub; x < 200 * kSub; ++x) {
          const glm::dvec3 way = camera.Direction((x + 0.5) / kSub, (y + 0.5) / kSub);
          const auto blur = camera.BlurAt(point, way, soft);
          if (!blur) continue;
          const double cosine = glm::dot(way, camera.Direction(150.0, 100.0));
          sum += blur->per_sr * std::pow(camera.PixelAngle() / kSub, 2) * std::pow(cosine, 3);
        }
      }
      EXPECT_NEAR(sum, 1.0, 0.01) << blades << " blades at " << z << ", 64 points a pixel";
    }
  }
}

TEST(CameraRays, APointOnTheLensAndTheBlurredPointAreOnOneRay) {
  const CameraRays camera = LensCamera(5);
  const glm::dvec3 ahead = camera.Direction(150.0, 100.0);
  for (const double z : {3.0, 300.0}) {
    const glm::dvec3 point = z * camera.Direction(150.0, 100.0);
    const glm::dvec3 way = camera.Direction(151.0, 100.8);
    // The softening is almost zero, so that the lens is not drawn wider than it is.
    const auto blur = camera.BlurAt(point, way, 1e-9);
    ASSERT_TRUE(blur) << z;
    const glm::dvec3 in_focus = camera.eye() + kFocus_m / glm::dot(way, ahead) * way;
    const glm::dvec3 a = glm::normalize(point - blur->on_lens);
    const glm::dvec3 b = glm::normalize(in_focus - camera.eye() - blur->on_lens);
    EXPECT_NEAR(glm::length(glm::cross(a, b)), 0.0, 1e-6) << z;
    EXPECT_NEAR(glm::dot(blur->on_lens, ahead), 0.0, 1e-9) << z;
  }
}

constexpr double kIrisRotation = 0.3;

TEST(Iris, AreaIsThatInsideTheEdge) {
  for (const int blades : {0, 3, 5, 6, 9}) {
    const Iris iris(blades, kIrisRotation);
    constexpr int kSteps = 3600;
    double area = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = 2.0 * kPi * (i + 0.5) / kSteps;
      area += 0.5 * std::pow(iris.EdgeTowards({std::cos(angle), std::sin(angle)}), 2) * 2.0 * kPi /
              kSteps;
    }
    EXPECT_NEAR(area, iris.area(), 1e-5) << blades << " blades, midpoint rule";
  }
}

TEST(Iris, CornersLieOnTheCircleStartingAtTheRotation) {
  const Iris iris(5, kIrisRotation);
  for (int corner = 0; corner < 5; ++corner) {
    const double angle = kIrisRotation + 2.0 * kPi * corner / 5.0;
    EXPECT_NEAR(iris.EdgeTowards({std::cos(angle), std::sin(angle)}), 1.0, 1e-12);
    const double between = angle + kPi / 5.0;
    EXPECT_NEAR(iris.EdgeTowards({std::cos(between), std::sin(between)}), std::cos(kPi / 5.0),
                1e-12);
  }
}

TEST(Iris, PointsFillItEvenly) {
  for (const int blades : {0, 3, 6}) {
    const Iris iris(blades, kIrisRotation);
    const PixelSamples samples(0, 0, PixelSamples::kMostSamples);
    glm::dvec2 sum(0.0);
    int inner = 0;
    for (int i = 0; i < PixelSamples::kMostSamples; ++i) {
      const glm::dvec2 point = iris.Point(samples.Point(i, SampleOf::kLens));
      const double relative = glm::length(point) / iris.EdgeTowards(point);
      EXPECT_LE(relative, 1.0 + 1e-12) << blades;
      inner += relative < std::sqrt(0.25) ? 1 : 0;
      sum += point;
    }
    EXPECT_NEAR(inner / 1024.0, 0.25, 2.0 / 1024.0) << "area goes with the square of the radius";
    EXPECT_LT(glm::length(sum) / 1024.0, 2e-3) << "no direction is preferred, " << blades;
  }
}

using Kind = PixelFilter::Kind;
constexpr std::array<Kind, 3> kKinds{Kind::kBox, Kind::kGaussian, Kind::kBlackmanHarris};

TEST(PixelFilter, OffsetsAreDistributedAsTheWeight) {
  for (const Kind kind : kKinds) {
    const PixelFilter filter(kind);
    constexpr int kRays = 2000;
    constexpr int kSteps = 20000;
    const double step = 2.0 * filter.radius() / kSteps;
    double below = 0.0;
    int rays = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = -filter.radius() + i * step;
      while (rays < kRays && filter.Offset((rays + 0.5) / kRays) < x) ++rays;
      EXPECT_NEAR(below, static_cast<double>(rays) / kRays, 2e-3)
          << NameOf(kind) << " at " << x << ": straight lines between 513 knots, and one ray";
      below += step * filter.Weight(x + 0.5 * step);
    }
    EXPECT_NEAR(below, 1.0, 1e-6) << NameOf(kind);
  }
}

TEST(PixelFilter, IsSymmetricAndPositive) {
  for (const Kind kind : kKinds) {
    const PixelFilter filter(kind);
    EXPECT_EQ(filter.Offset(0.5), 0.0);
    for (const double u : {0.0, 0.125, 0.25, 0.4375}) {
      EXPECT_NEAR(filter.Offset(u), -filter.Offset(1.0 - u), 1e-12) << NameOf(kind);
      EXPECT_LE(std::abs(filter.Offset(u)), filter.radius());
      EXPECT_GE(filter.Weight(filter.Offset(u)), 0.0) << "nothing rings at an edge";
    }
  }
}

TEST(PixelFilter, NamesAreReadBackAndOthersAreRefused) {
  for (const Kind kind : kKinds) EXPECT_EQ(PixelFilterFromName(NameOf(kind)), kind);
  EXPECT_THROW((void)PixelFilterFromName("gauss"), InputError);
}

/// Returns the transfer of a cosine with a frequency in cycles per pixel.
double Transfer(const PixelFilter& filter, double frequency) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = filter.radius() * ((i + 0.5) / kSteps * 2.0 - 1.0);
    sum += filter.Weight(x) * std::cos(2.0 * kPi * frequency * x);
  }
  return sum * 2.0 * filter.radius() / kSteps;
}

/// Results for a zone plate: mean square of aliased detail (frequencies from 1/2 to 3/2 cycles per
/// pixel, which appear as lower ones) and of the kept detail below, and the width in which an edge
/// rises from 10 to 90 % [pixels].
struct FilterQuality {
  double aliased = 0.0, kept = 0.0, rise = 0.0;
};
FilterQuality QualityOf(Kind kind) {
  const PixelFilter filter(kind);
  FilterQuality plate{0.0, 0.0, filter.Offset(0.9) - filter.Offset(0.1)};
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double low = 0.5 * (i + 0.5) / kSteps;
    plate.kept += std::pow(Transfer(filter, low), 2) / kSteps;
    plate.aliased +=
        0.5 *
        (std::pow(Transfer(filter, 0.5 + low), 2) + std::pow(Transfer(filter, 1.0 + low), 2)) /
        kSteps;
  }
  return plate;
}

TEST(PixelFilter, SofterFiltersAliasLess) {
  struct Case {
    Kind kind;
    FilterQuality expected;
  };
  for (const auto& [kind, expected] : {Case{Kind::kBox, {0.079, 0.77, 0.80}},
                                       {Kind::kBlackmanHarris, {0.019, 0.63, 1.08}},
                                       {Kind::kGaussian, {0.008, 0.56, 1.25}}}) {
    const FilterQuality found = QualityOf(kind);
    EXPECT_NEAR(found.aliased, expected.aliased, 0.001) << NameOf(kind);
    EXPECT_NEAR(found.kept, expected.kept, 0.01) << NameOf(kind);
    EXPECT_NEAR(found.rise, expected.rise, 0.01) << NameOf(kind);
  }
}

constexpr std::array kDecisions{SampleOf::kPixel, SampleOf::kLens, SampleOf::kSunDisk,
                                SampleOf::kTime};

/// Returns the points of all pixels of an aligned square.
Points OfSquare(int x0, int y0, int side, int samples, SampleOf decision) {
  Points points;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      const PixelSamples pixel(x, y, samples);
      for (int s = 0; s < samples; ++s) points.push_back(pixel.Point(s, decision));
    }
  }
  return points;
}
Points OfPixel(int x, int y, int samples, SampleOf decision) {
  return OfSquare(x, y, 1, samples, decision);
}

/// Returns whether each point has a rectangle of its own, for every shape of 2^j x 2^(k - j).
bool IsNet(const Points& points) {
  const std::size_t count = points.size();
  for (std::size_t columns = 1; columns <= count; columns *= 2) {
    const std::size_t rows = count / columns;
    std::set<std::size_t> taken;
    for (const auto& [u, v] : points) {
      taken.insert(static_cast<std::size_t>(u * static_cast<double>(columns)) * rows +
                   static_cast<std::size_t>(v * static_cast<double>(rows)));
    }
    if (taken.size() != count) return false;
  }
  return true;
}

TEST(PixelSamples, FillEveryRectangleOfEveryShapeOnce) {
  for (const SampleOf decision : kDecisions) {
    for (const int samples : {1, 2, 4, 16, 64, 1024}) {
      for (const int x : {0, 1, 255, 256, 16383})
        EXPECT_TRUE(IsNet(OfPixel(x, 77, samples, decision))) << samples << " at " << x;
    }
  }
  for (const int side : {2, 4, 8})
    EXPECT_TRUE(IsNet(OfSquare(3 * side, 5 * side, side, 4, SampleOf::kPixel))) << side;
}

TEST(PixelSamples, OtherCountsAreAsEvenAsTheNextLowerPowerOfTwo) {
  for (const int samples : {3, 9, 100}) {
    Points points = OfPixel(11, 12, samples, SampleOf::kPixel);
    points.resize(samples == 3 ? 2 : samples == 9 ? 8 : 64);
    EXPECT_TRUE(IsNet(points)) << samples;
  }
}

TEST(PixelSamples, DifferentDecisionsAreNotCorrelated) {
  // 64 x 64 pixels of 4 samples: chance alone gives a coefficient of 1 / sqrt(16384) = 0.008.
  for (std::size_t i = 0; i < kDecisions.size(); ++i) {
    for (std::size_t j = i + 1; j < kDecisions.size(); ++j) {
      const Points a = OfSquare(0, 0, 64, 4, kDecisions[i]);
      const Points b = OfSquare(0, 0, 64, 4, kDecisions[j]);
      for (std::size_t k = 0; k < 4; ++k) {
        double product = 0.0;
        for (std::size_t n = 0; n < a.size(); ++n)
          product += (a[n][k / 2] - 0.5) * (b[n][k % 2] - 0.5);
        EXPECT_LT(std::abs(12.0 * product / static_cast<double>(a.size())), 0.03) << i << j << k;
      }
    }
  }
}

/// Returns the rms error, over pixels, of the mean over a pixel's samples.
template <typename Function>
double RmsError(int samples, double truth, const Function& function) {
  constexpr int kSide = 48;
  double squares = 0.0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      double sum = 0.0;
      for (const auto& point : OfPixel(x, y, samples, SampleOf::kLens)) sum += function(point);
      squares += (sum / samples - truth) * (sum / samples - truth);
    }
  }
  return std::sqrt(squares) / kSide;
}

double Smooth(const std::array<double, 2>& p) { return std::exp(p[0] + p[1]); }
const double kMeanOfSmooth = std::pow(std::exp(1.0) - 1.0, 2);

TEST(PixelSamples, SixteenIntegrateTenTimesBetterThanRandomOnes) {
  const double variance = std::pow(0.5 * (std::exp(2.0) - 1.0), 2) - kMeanOfSmooth * kMeanOfSmooth;
  EXPECT_LT(RmsError(16, kMeanOfSmooth, Smooth), 0.1 * std::sqrt(variance / 16.0))
      << "a scrambled net's error falls as n^-3/2 (Owen 1997), that of random points as n^-1/2";
  EXPECT_LT(RmsError(4, kMeanOfSmooth, Smooth), 0.35 * std::sqrt(variance / 4.0));
}

TEST(PixelSamples, ErrorAtAnEdgeIsThatOfTheCellsItCrosses) {
  const auto edge = [](const std::array<double, 2>& p) {
    return p[0] + 0.6 * p[1] < 0.7 ? 1.0 : 0.0;
  };
  constexpr double kTruth = 0.4;  // The area under the line u = 0.7 - 0.6 v is 0.7 - 0.3.
  for (const int samples : {16, 64}) {
    const double crossed = 1.6 * std::sqrt(samples) + 1.0;
    EXPECT_LT(RmsError(samples, kTruth, edge), std::sqrt(0.25 * crossed) / samples)
        << "only squares of 1/n that the edge crosses have a variance, at most 1/4 each";
  }
}

TEST(PixelSamples, ErrorsOfNeighbouringPixelsCancel) {
  // Over 2 x 2 pixels of 4 samples the error is that of 16, not half that of 4.
  double alone = 0.0, together = 0.0;
  for (int y = 0; y < 64; y += 2) {
    for (int x = 0; x < 64; x += 2) {
      double square = 0.0;
      for (int k = 0; k < 4; ++k) {
        double sum = 0.0;
        for (const auto& p : OfPixel(x + k % 2, y + k / 2, 4, SampleOf::kSunDisk)) sum += Smooth(p);
        alone += (sum / 4.0 - kMeanOfSmooth) * (sum / 4.0 - kMeanOfSmooth) / 4.0;
        square += sum / 16.0;
      }
      together += (square - kMeanOfSmooth) * (square - kMeanOfSmooth);
    }
  }
  EXPECT_LT(std::sqrt(together / alone), 0.25) << "independent pixels: 0.5";
}

/// A camera that turns, zooms and rolls while the shutter is open.
MovingCamera TurningCamera(double turn_deg, bool has_lens) {
  std::vector<CameraRays> steps;
  for (int i = 0; i <= 4; ++i) {
    const double share = 0.25 * i;
    Camera camera = CameraFromDegrees({}, 20.0 + share * turn_deg, 10.0 - 5.0 * share, 40.0 * share,
                                      60.0 + 20.0 * share);
    if (has_lens) camera.lens = ThinLens{2.0, 0.05, 1.0};
    steps.emplace_back(camera, 64, 36);
  }
  return MovingCamera(std::move(steps));
}

// Directions on a spiral over the sphere: 500 of them are 9 degrees apart.
TEST(MovingCamera, MaySeeAllThatLightsThePictureAndLittleElse) {
  constexpr int kDirections = 500;
  constexpr double kBeyond = 2.0;
  for (const auto& [turn_deg, has_lens] : {std::pair{0.0, false}, {0.0, true}, {60.0, true}}) {
    const MovingCamera camera = TurningCamera(turn_deg, has_lens);
    int seen = 0, may_be_seen = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / kDirections, level = std::sqrt(1.0 - z * z);
      const glm::dvec3 direction(level * std::cos(2.4 * i), level * std::sin(2.4 * i), z);
      bool lights = false;
      const PixelSamples samples(i % 64, i / 64, 64);
      for (int k = 0; k < 64; ++k) {
        const auto ray = camera.At(samples.Point(k, SampleOf::kTime)[0])
                             .RayFrom(direction, samples.Point(k, SampleOf::kLens));
        lights |= ray && ray->x > -kBeyond && ray->x < 64.0 + kBeyond && ray->y > -kBeyond &&
                  ray->y < 36.0 + kBeyond;
      }
      const bool may_see = camera.MaySee(direction, 0.0, kBeyond);
      EXPECT_TRUE(may_see || !lights) << turn_deg << ": " << i;
      EXPECT_TRUE(camera.MaySee(direction, 3.2, kBeyond))
          << "all directions are within 180 degrees";
      seen += lights ? 1 : 0;
      may_be_seen += may_see ? 1 : 0;
    }
    EXPECT_GT(seen, kDirections / 20) << turn_deg;
    EXPECT_LT(may_be_seen, kDirections / 2) << "nothing that is behind the camera: " << turn_deg;
  }
}

TEST(PixelSamples, AreTheSameOnEveryMachine) {
  constexpr double kUnit = 4294967296.0;
  EXPECT_EQ(PixelSamples(0, 0, 4).Point(0, SampleOf::kPixel),
            (std::array{3773744660.0 / kUnit, 433932416.0 / kUnit}))
      << "as integers of any language compute it";
  EXPECT_EQ(PixelSamples(1279, 719, 16).Point(15, SampleOf::kTime),
            (std::array{2297610576.0 / kUnit, 2934753692.0 / kUnit}));
}

}  // namespace
}  // namespace alpenglow::renderer
