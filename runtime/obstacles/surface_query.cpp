#include "runtime/obstacles/surface_query.h"

#include <embree3/rtcore.h>

#include <cmath>

#include "mesher/base/error.h"

namespace liana {

// Embree wants flush-to-zero for speed and sets it in its own build only; it stays unset in our threads, so
// that our own arithmetic does not depend on whether a thread ever asked.
struct SurfaceQuery::Embree {
  ClosedMesh surface;
  Vec3 centre = Vec3::Zero();  // Embree sees positions relative to it: single precision loses less
  double slack = 0;            // m, what rounding to single precision can move a point by
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  double half_sheet = 0;  // m
  bool convex = false;

  Embree(const Mesh& mesh, double sheet) : surface(mesh, sheet > 0), half_sheet(sheet / 2) {
    const Mesh& m = surface.mesh();
    Vec3 low = m.positions.front(), high = low;
    for (const Vec3& p : m.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    centre = (low + high) / 2;
    slack = (high - low).norm() * 1e-6;
    convex = sheet == 0 && is_convex((high - low).norm());

    device = rtcNewDevice("threads=1");
    if (!device)
      throw Error(Error::Kind::Partial, "Embree could not be started",
                  "check the installation of libembree3");
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), m.positions.size()));
    for (const Vec3& p : m.positions)
      for (int axis = 0; axis < 3; ++axis) *points++ = static_cast<float>(p[axis] - centre[axis]);
    auto* corners = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), m.triangles.size()));
    for (const Triangle& t : m.triangles)
      for (uint32_t corner : t) *corners++ = corner;
    rtcCommitGeometry(geometry);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  bool is_convex(double size) const {
    constexpr double kMost = 1e6, kRounding = 1e-14;
    const Mesh& m = surface.mesh();
    if (static_cast<double>(m.triangles.size()) * static_cast<double>(m.positions.size()) > kMost)
      return false;
    for (uint32_t i = 0; i < m.triangles.size(); ++i)
      for (const Vec3& p : m.positions)
        if ((p - m.positions[m.triangles[i][0]]).dot(surface.face_normal(i)) > kRounding * size) return false;
    return true;
  }
  Embree(const Embree&) = delete;
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

namespace {

struct Search {
  const ClosedMesh* surface;
  Vec3 x;
  double slack;
  TrianglePoint best;
  uint32_t triangle;
  double limit;  // m², beyond which a triangle is of no use
};

constexpr size_t kFew = 24;  // triangles that are looked at faster than Embree finds out which

// Whether it is nearer than the best one.
bool consider(uint32_t triangle, Search& search) {
  const Mesh& mesh = search.surface->mesh();
  const Triangle& t = mesh.triangles[triangle];
  const double height = (search.x - mesh.positions[t[0]]).dot(search.surface->face_normal(triangle));
  if (height * height > search.limit) return false;
  const TrianglePoint found =
      closest_on_triangle(search.x, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
  // Ties go to the lowest triangle, so that the answer does not depend on the order of the search.
  if (found.squared_distance > search.best.squared_distance ||
      (found.squared_distance == search.best.squared_distance && triangle >= search.triangle))
    return false;
  search.best = found;
  search.triangle = triangle;
  search.limit = found.squared_distance * (1 + 1e-9);
  return true;
}

bool visit(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<Search*>(arguments->userPtr);
  if (!consider(arguments->primID, search)) return false;
  arguments->query->radius =
      static_cast<float>(std::sqrt(search.best.squared_distance) * (1 + 1e-6) + search.slack);
  return true;
}

}  // namespace

SurfaceQuery::SurfaceQuery(const Mesh& mesh, double sheet) : embree_(std::make_unique<Embree>(mesh, sheet)) {}
SurfaceQuery::~SurfaceQuery() = default;
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;

const Mesh& SurfaceQuery::mesh() const {
  return embree_->surface.mesh();
}

bool SurfaceQuery::convex() const {
  return embree_->convex;
}

SurfacePoint SurfaceQuery::closest(const Vec3& x, double within) const {
  const Vec3 local = x - embree_->centre;
  // What single precision loses grows with the distance from the centre.
  const double slack = embree_->slack + local.norm() * 1e-6;
  const double reach = within + embree_->half_sheet + slack;
  Search search{&embree_->surface, x, slack, {}, Id<void>::kNone, reach * reach};
  search.best.squared_distance = std::numeric_limits<double>::infinity();

  if (const size_t count = mesh().triangles.size(); count <= kFew) {
    for (uint32_t i = 0; i < count; ++i) consider(i, search);
  } else {
    RTCPointQuery query;
    query.x = static_cast<float>(local.x());
    query.y = static_cast<float>(local.y());
    query.z = static_cast<float>(local.z());
    query.time = 0;
    query.radius = static_cast<float>(reach);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(embree_->scene, &query, &context, visit, &search);
  }
  require(search.triangle != Id<void>::kNone, "no closest point within the promised distance");

  const double distance = std::sqrt(search.best.squared_distance);
  const Vec3& normal = embree_->surface.pseudonormal(search.triangle, search.best.feature);
  if (embree_->half_sheet > 0) {
    const Vec3 away = distance > 1e-9 ? Vec3((x - search.best.point) / distance) : normal;
    return {search.best.point + embree_->half_sheet * away, away, distance - embree_->half_sheet,
            search.triangle};
  }
  const bool inside = (x - search.best.point).dot(normal) < 0;
  return {search.best.point, normal, inside ? -distance : distance, search.triangle};
}

bool SurfaceQuery::ray_meets(const Vec3& x, const Vec3& direction, double skip) const {
  const Vec3 local = x - embree_->centre;
  RTCRay ray{};
  ray.org_x = static_cast<float>(local.x());
  ray.org_y = static_cast<float>(local.y());
  ray.org_z = static_cast<float>(local.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = static_cast<float>(skip);
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar < 0;  // Embree's mark of a hit
}

}  // namespace liana
