// SPDX-License-Identifier: MIT
#include "renderer/terrain/terrain.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

// Embree 4 has no context of a query.
void TraceNearest(RTCScene scene, RTCRayHit& query) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
#endif
}
void TraceAny(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

// Half an ulp of 1 in float, and the error bound of n successive roundings (Higham 2002, section
// 3.1).
constexpr double kUnitRoundoff = 0x1p-24;
constexpr double Gamma(int n) { return n * kUnitRoundoff / (1.0 - n * kUnitRoundoff); }

bool IsFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

struct Interval {
  double begin;
  double end;
};

// Returns the interval of a ray inside a box; nullopt if it is never inside at a distance in [0,
// length].
std::optional<Interval> Clip(const Box& box, const glm::dvec3& origin, const glm::dvec3& unit,
                             double length_m) {
  Interval inside{0.0, length_m};
  for (int axis = 0; axis < 3; ++axis) {
    if (unit[axis] == 0.0) {
      if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return std::nullopt;
      continue;
    }
    const double per_length = 1.0 / unit[axis];
    const double a = (box.low[axis] - origin[axis]) * per_length;
    const double b = (box.high[axis] - origin[axis]) * per_length;
    inside.begin = std::max(inside.begin, std::min(a, b));
    inside.end = std::min(inside.end, std::max(a, b));
  }
  if (!(inside.begin < inside.end)) return std::nullopt;
  return inside;
}

// Validates every ray, because Embree aborts the process for invalid ones.
glm::dvec3 CheckedUnit(const glm::dvec3& origin, const glm::dvec3& direction) {
  if (!IsFinite(origin)) {
    throw InternalError(fmt::format("a ray starts at ({}, {}, {})", origin.x, origin.y, origin.z));
  }
  constexpr double kUnit = 4.0 * std::numeric_limits<double>::epsilon();
  const double largest =
      std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  if (!IsFinite(direction) || !(largest > 0.0)) {
    throw InternalError(
        fmt::format("a ray points along ({}, {}, {})", direction.x, direction.y, direction.z));
  }
  const double length2 = glm::dot(direction, direction);
  if (std::abs(length2 - 1.0) < kUnit) return direction;
  return glm::normalize(direction / largest);
}

RTCRay MakeRay(const glm::dvec3& start, const glm::dvec3& unit, double length_m) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(start.x);
  ray.org_y = static_cast<float>(start.y);
  ray.org_z = static_cast<float>(start.z);
  ray.dir_x = static_cast<float>(unit.x);
  ray.dir_y = static_cast<float>(unit.y);
  ray.dir_z = static_cast<float>(unit.z);
  ray.tnear = 0.0F;
  ray.tfar = static_cast<float>(length_m);
  ray.mask = std::numeric_limits<unsigned>::max();
  return ray;
}

void CheckMesh(const TriangleMesh& mesh) {
  ALPENGLOW_ENSURE(mesh.normals.size(), ==, mesh.positions.size());
  for (const auto& position : mesh.positions) {
    if (!IsFinite(ToDouble(position))) throw InternalError("a vertex of the terrain is not finite");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) ALPENGLOW_ENSURE(vertex, <, mesh.positions.size());
  }
}

/// Bounding box of triangles, and the square of their longest edge.
struct BoxReach {
  Box box;
  double longest2_m2 = 0.0;

  void Add(const std::array<glm::dvec3, 3>& corner) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low = glm::min(box.low, corner[k]);
      box.high = glm::max(box.high, corner[k]);
      const glm::dvec3 edge = corner[(k + 1) % 3] - corner[k];
      longest2_m2 = std::max(longest2_m2, glm::dot(edge, edge));
    }
  }
  [[nodiscard]] BoxReach With(const BoxReach& other) const {
    return {{glm::min(box.low, other.box.low), glm::max(box.high, other.box.high)},
            std::max(longest2_m2, other.longest2_m2)};
  }
};

BoxReach ReachOf(const TriangleMesh& mesh) {
  const tbb::blocked_range<std::size_t> all(0, mesh.triangles.size(), 1 << 14);
  return tbb::parallel_reduce(
      all, BoxReach{},
      [&](const tbb::blocked_range<std::size_t>& some, BoxReach reach) {
        for (std::size_t i = some.begin(); i < some.end(); ++i) {
          const auto& [a, b, c] = mesh.triangles[i];
          reach.Add({ToDouble(mesh.positions[a]), ToDouble(mesh.positions[b]),
                     ToDouble(mesh.positions[c])});
        }
        return reach;
      },
      [](const BoxReach& a, const BoxReach& b) { return a.With(b); });
}

// Widens the box so much that a clipped ray starts off the triangles.
Box Widened(const Box& box) {
  const glm::dvec3 margin = 1.0 + 1e-5 * glm::max(glm::abs(box.low), glm::abs(box.high));
  return {box.low - margin, box.high + margin};
}

struct Corners {
  std::array<glm::dvec3, 3> position;
  std::array<glm::dvec3, 3> normal;
};

// Returns the weights of the corners at the intersection of the ray with the triangle's plane,
// clamped to the triangle: a ray that misses it narrowly in double may have hit its edge in float.
glm::dvec3 WeightsAt(const Corners& corners, const glm::dvec3& origin, const glm::dvec3& unit,
                     const RTCHit& found) {
  const glm::dvec3 u = corners.position[1] - corners.position[0];
  const glm::dvec3 v = corners.position[2] - corners.position[0];
  const glm::dvec3 normal = glm::cross(u, v);
  const double approach = glm::dot(unit, normal);
  double b1 = static_cast<double>(found.u);
  double b2 = static_cast<double>(found.v);
  if (approach != 0.0) {
    const double t = glm::dot(corners.position[0] - origin, normal) / approach;
    const glm::dvec3 at = origin + t * unit - corners.position[0];
    const double area2 = glm::dot(normal, normal);
    b1 = glm::dot(glm::cross(at, v), normal) / area2;
    b2 = glm::dot(glm::cross(u, at), normal) / area2;
  }
  b1 = std::clamp(b1, 0.0, 1.0);
  b2 = std::clamp(b2, 0.0, 1.0 - b1);
  return {1.0 - b1 - b2, b1, b2};
}

TerrainHit HitAt(const Corners& corners, const glm::dvec3& origin, const glm::dvec3& unit,
                 const RTCHit& found) {
  const glm::dvec3 weight = WeightsAt(corners, origin, unit, found);
  const glm::dvec3 flat = glm::normalize(glm::cross(corners.position[1] - corners.position[0],
                                                    corners.position[2] - corners.position[0]));
  const double side = glm::dot(flat, unit) <= 0.0 ? 1.0 : -1.0;
  glm::dvec3 point(0.0);
  glm::dvec3 normal(0.0);
  for (int k = 0; k < 3; ++k) {
    point += weight[k] * corners.position[static_cast<std::size_t>(k)];
    normal += side * weight[k] * corners.normal[static_cast<std::size_t>(k)];
  }
  // Sum over the corners of the weighted distance of the point below their tangent planes.
  glm::dvec3 lift(0.0);
  for (int k = 0; k < 3; ++k) {
    const auto corner = static_cast<std::size_t>(k);
    const glm::dvec3 up = side * corners.normal[corner];
    lift -= weight[k] * std::min(0.0, glm::dot(point - corners.position[corner], up)) * up;
  }
  const double length = glm::length(normal);
  return {glm::dot(point - origin, unit), length > 0.0 ? normal / length : side * flat, side * flat,
          point + lift};
}

}  // namespace

struct Terrain::Scene {
  TriangleMesh mesh;
  Box bounds;
  double longest_edge_m = 0.0;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::mutex fault_mutex;
  std::string fault;  // error message of Embree

  explicit Scene(TriangleMesh triangles) : mesh(std::move(triangles)) {
    CheckMesh(mesh);
    const BoxReach reach = ReachOf(mesh);
    bounds = Widened(reach.box);
    longest_edge_m = std::sqrt(reach.longest2_m2);
    device = rtcNewDevice("");
    if (device == nullptr) throw InternalError("Embree has no device for this processor");
    rtcSetDeviceErrorFunction(device, &Scene::KeepFault, this);
    try {
      Build();
      ThrowFault();
    } catch (...) {
      Release();
      throw;
    }
  }
  ~Scene() { Release(); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void Build() {
    // Above this number of triangles Embree's own copies of their corners need too much memory (44
    // bytes each); rays then fetch the corners from the mesh.
    constexpr std::size_t kManyTriangles = std::size_t{1} << 23;
    const bool many = mesh.triangles.size() > kManyTriangles;
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene,
                     many ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT : RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    ShareBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions);
    ShareBuffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, mesh.triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }

  // Embree reads the mesh's own memory 16 bytes at a time, also past the last element.
  template <typename Element>
  void ShareBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                   std::vector<Element>& elements) {
    elements.reserve(elements.size() + 2);
    rtcSetSharedGeometryBuffer(geometry, type, 0, format, elements.data(), 0, sizeof(Element),
                               elements.size());
    ThrowFault();
  }

  static void KeepFault(void* self, RTCError code, const char* text) {
    auto* scene = static_cast<Scene*>(self);
    const std::lock_guard<std::mutex> lock(scene->fault_mutex);
    scene->fault = fmt::format("Embree error {}: {}", static_cast<int>(code), text);
  }
  void ThrowFault() {
    const std::lock_guard<std::mutex> lock(fault_mutex);
    if (!fault.empty()) throw InternalError(fault);
  }

  void Release() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
    scene = nullptr;
    device = nullptr;
  }

  [[nodiscard]] Corners CornersOf(unsigned triangle) const {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[triangle][k];
      corners.position[k] = ToDouble(mesh.positions[vertex]);
      corners.normal[k] = ToDouble(mesh.normals[vertex]);
    }
    return corners;
  }

  // Returns a bound of the apparent distance of a triangle's point from the triangle in Embree's
  // arithmetic: its coordinates are rounded to float, and the distance to the plane is a dot
  // product of differences and a cross product of edges, 16 roundings of terms no longer than the
  // longest edge.
  [[nodiscard]] double ErrorBound(const glm::dvec3& point) const {
    return kUnitRoundoff * (std::abs(point.x) + std::abs(point.y) + std::abs(point.z)) +
           Gamma(16) * longest_edge_m;
  }
};

Terrain::Terrain(TriangleMesh mesh) : scene_(std::make_unique<Scene>(std::move(mesh))) {}
Terrain::~Terrain() = default;
Terrain::Terrain(Terrain&&) noexcept = default;
Terrain& Terrain::operator=(Terrain&&) noexcept = default;

std::optional<TerrainHit> Terrain::Intersect(const glm::dvec3& origin, const glm::dvec3& direction,
                                             double length_m) const {
  const glm::dvec3 unit = CheckedUnit(origin, direction);
  const std::optional<Interval> inside = Clip(scene_->bounds, origin, unit, length_m);
  if (!inside) return std::nullopt;
  const glm::dvec3 start = origin + inside->begin * unit;
  RTCRayHit query{};
  query.ray = MakeRay(start, unit, inside->end - inside->begin);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  TraceNearest(scene_->scene, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return HitAt(scene_->CornersOf(query.hit.primID), origin, unit, query.hit);
}

bool Terrain::Occluded(const glm::dvec3& origin, const glm::dvec3& normal,
                       const glm::dvec3& direction, double length_m) const {
  const glm::dvec3 unit = CheckedUnit(origin, direction);
  const glm::dvec3 away = CheckedUnit(origin, normal);
  if (!(length_m >= 0.0)) throw InternalError(fmt::format("a ray is {} m long", length_m));
  const glm::dvec3 lifted = origin + scene_->ErrorBound(origin) * away;
  const std::optional<Interval> inside = Clip(scene_->bounds, lifted, unit, length_m);
  if (!inside) return false;
  RTCRay ray = MakeRay(lifted + inside->begin * unit, unit, inside->end - inside->begin);
  TraceAny(scene_->scene, ray);
  return ray.tfar < 0.0F;
}

const TriangleMesh& Terrain::mesh() const { return scene_->mesh; }

std::pair<glm::dvec3, glm::dvec3> Terrain::Bounds() const {
  return {scene_->bounds.low, scene_->bounds.high};
}

}  // namespace alpenglow::renderer
