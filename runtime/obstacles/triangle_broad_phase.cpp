#include "runtime/obstacles/triangle_broad_phase.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/base/error.h"

namespace liana {
namespace {

// Of the mesh's diagonal, that boxes are wider than their triangles: what rounding to single precision, in
// the boxes, in a ray that begins less than two diagonals away, and in Embree's own sums, can come to.
constexpr double kSlack = 4e-6;
// The same for a point, by its distance from the centre.
constexpr double kSlackByDistance = 1e-6;

struct Boxes {
  const Mesh& mesh;
  Vec3 centre;
  double slack;
};

void box_of(const RTCBoundsFunctionArguments* arguments) {
  const auto& boxes = *static_cast<const Boxes*>(arguments->geometryUserPtr);
  const Triangle& t = boxes.mesh.triangles[arguments->primID];
  const std::vector<Vec3>& p = boxes.mesh.positions;
  const Vec3 low = p[t[0]].cwiseMin(p[t[1]]).cwiseMin(p[t[2]]) - boxes.centre;
  const Vec3 high = p[t[0]].cwiseMax(p[t[1]]).cwiseMax(p[t[2]]) - boxes.centre;
  RTCBounds& box = *arguments->bounds_o;
  float* lower[3] = {&box.lower_x, &box.lower_y, &box.lower_z};
  float* upper[3] = {&box.upper_x, &box.upper_y, &box.upper_z};
  for (int axis = 0; axis < 3; ++axis) {
    *lower[axis] = static_cast<float>(low[axis] - boxes.slack);
    *upper[axis] = static_cast<float>(high[axis] + boxes.slack);
  }
}

struct Around {
  FunctionRef<double(uint32_t)> visit;
  double radius, slack;
};

float widened(const Around& around) {
  return static_cast<float>((around.radius + around.slack) * (1 + 1e-6));
}

bool visit_near(RTCPointQueryFunctionArguments* arguments) {
  auto& around = *static_cast<Around*>(arguments->userPtr);
  const double radius = around.visit(arguments->primID);
  if (!(radius < around.radius)) return false;
  around.radius = radius;
  arguments->query->radius = widened(around);
  return true;
}

struct Along {
  RTCIntersectContext context;  // first: Embree hands back its address
  FunctionRef<bool(uint32_t)> visit;
};

void visit_along(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->N != 1 || !arguments->valid[0]) return;
  const auto& along = *reinterpret_cast<const Along*>(arguments->context);
  if (along.visit(arguments->primID))
    reinterpret_cast<RTCRay*>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
}

}  // namespace

// Embree wants flush-to-zero for speed and sets it in its own build only; it stays unset in our threads, so
// that our own arithmetic does not depend on whether a thread ever asked.
struct TriangleBroadPhase::Embree {
  Vec3 centre = Vec3::Zero();  // Embree sees positions relative to it: single precision loses less
  double size = 0;             // m, the diagonal
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Embree(const Mesh& mesh, const char* configuration) {
    Vec3 low = mesh.positions.front(), high = low;
    for (const Vec3& p : mesh.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    centre = (low + high) / 2;
    size = (high - low).norm();
    device = rtcNewDevice(configuration);
    if (!device)
      throw Error(Error::Kind::Partial, "Embree could not be started",
                  "check the installation of libembree3");
    Boxes boxes{mesh, centre, kSlack * size};
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
    rtcSetGeometryUserData(geometry, &boxes);
    rtcSetGeometryBoundsFunction(geometry, box_of, nullptr);
    rtcSetGeometryOccludedFunction(geometry, visit_along);
    rtcCommitGeometry(geometry);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);  // the boxes are made here
    rtcReleaseGeometry(geometry);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
      throw Error(Error::Kind::Partial, "Embree could not build its tree of boxes", "is there memory left?");
  }
  Embree(const Embree&) = delete;
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

TriangleBroadPhase::TriangleBroadPhase(const Mesh& mesh, const char* device)
    : embree_(std::make_unique<Embree>(mesh, device)) {}
TriangleBroadPhase::~TriangleBroadPhase() = default;
TriangleBroadPhase::TriangleBroadPhase(TriangleBroadPhase&&) noexcept = default;
TriangleBroadPhase& TriangleBroadPhase::operator=(TriangleBroadPhase&&) noexcept = default;

void TriangleBroadPhase::near(const Vec3& x, double radius, FunctionRef<double(uint32_t)> visit) const {
  const Vec3 local = x - embree_->centre;
  Around around{visit, radius, kSlackByDistance * local.norm()};
  RTCPointQuery query;
  query.x = static_cast<float>(local.x());
  query.y = static_cast<float>(local.y());
  query.z = static_cast<float>(local.z());
  query.time = 0;
  query.radius = widened(around);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->scene, &query, &context, visit_near, &around);
}

bool TriangleBroadPhase::along(const Vec3& x, const Vec3& direction,
                               FunctionRef<bool(uint32_t)> visit) const {
  // From nearby: what single precision loses grows with the way.
  const double before = std::max(0.0, direction.dot(embree_->centre - x) - embree_->size);
  const Vec3 local = x + before * direction - embree_->centre;
  if (local.norm() > 2 * embree_->size) return false;  // it passes by, or goes away
  RTCRay ray{};
  ray.org_x = static_cast<float>(local.x());
  ray.org_y = static_cast<float>(local.y());
  ray.org_z = static_cast<float>(local.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  Along along{{}, visit};
  rtcInitIntersectContext(&along.context);
  rtcOccluded1(embree_->scene, &along.context, &ray);
  return ray.tfar < 0;  // Embree's mark of a hit
}

}  // namespace liana
