// make_solid: the rungs of the ladder, cheapest first.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "mesher/base/error.h"
#include "mesher/exact/alpha_wrap.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/exact/untangle.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/geometry/weld.h"
#include "mesher/solids/repair/mend.h"
#include "mesher/solids/repair/pull_back.h"
#include "mesher/solids/sections/beam_shape.h"
#include "mesher/solids/solidify/solid_attempt.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {
namespace {

constexpr double kWholePart = 0.75;    // a branch of several shells counts as one that is this share of it
constexpr double kUntangled = 0.02;    // relative change of volume that cutting out crossings may cost
constexpr double kWholeExtent = 0.85;  // of the box's diagonal: what a mended surface must keep
constexpr double kAlpha = 0.4, kOffset = 1. / 200;  // of the diameter
constexpr double kBothSides =
    1.6;  // wrapped area over area: a sheet, or a tube wrapped inside and out, has 2
constexpr double kMostWrapTriangles = 2500;  // expected; more take seconds, and alpha can be coarser
constexpr double kWholeLength = 0.8;         // of the box's diagonal: the length of what is long and thin
constexpr double kWide = 0.4;                // second over first spread, standard deviations of the area
constexpr double kLongAndThin = 6;           // π extent² / area: length over diameter of a tube
constexpr double kPlane = 1e-3;              // thinnest over longest extent (standard deviations)

double extent(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (const uint32_t v : t) box.extend(mesh.positions[v]);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

/// Everything in one plane: no wrap would give it a thickness of its own.
bool is_plane(const Mesh& mesh) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : mesh.positions) mean += p / double(mesh.positions.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : mesh.positions) spread += (p - mean) * (p - mean).transpose();
  const Vec3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return !(axes[0] > kPlane * kPlane * axes[2]);
}

/// Spread in two directions at least, as a crown is, and a branch is not.
bool is_wide(const Mesh& mesh) {
  double area = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const double a = area_vector(mesh, t).norm();
    const Vec3 p = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    area += a, first += a * p, second += a * p * p.transpose();
  }
  const Mat3 spread = second / area - first * first.transpose() / (area * area);
  const Vec3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread, Eigen::EigenvaluesOnly).eigenvalues();
  return axes[1] > kWide * kWide * axes[2];
}

bool has_border(const Mesh& mesh) {
  for (const auto& across : find_adjacency(mesh).across)
    for (const uint32_t other : across)
      if (other == Adjacency::kNone) return true;
  return false;
}

class Ladder {
 public:
  Ladder(const SegmentedPlant& plant, DomainId id)
      : domain_(plant.domains[id.index()]), support_(plant, id) {}

  SolidDomain climb() {
    if (auto solid = try_surface(domain_.surface, "", {})) return *solid;
    const Error reason = *failure_;
    const Mended mended = mend(domain_.surface);
    if (!mended.notes.empty())
      if (auto solid = try_surface(mended.mesh, mended.notes, {mended.dropped, mended.dropped_volume}))
        return *solid;
    if (auto solid = untangle(mended)) return *solid;
    if (auto solid = wrap(mended.mesh)) return *solid;
    auto beam = beam_shape(domain_, support_);
    if (!beam || is_short(*beam)) throw reason;
    // A wide sheet has no centreline to speak of, and a folded one is no tube.
    beam->route = domain_.kind == DomainKind::Leaf ? "rough-beam" : "beam";
    return *beam;
  }

 private:
  /// A branch whose root was found halfway up, or most of which is lost. A crown may be wider than it is
  /// long: of that only what lies far from the root counts.
  bool is_short(const SolidDomain& solid) const {
    const Mesh& whole = domain_.surface;
    const double size = extent(whole);
    if (domain_.kind != DomainKind::Branch || solid.length >= kWholeLength * size ||
        kPi * size * size <= kLongAndThin * surface_area(whole))
      return false;
    if (!is_wide(whole)) return true;
    double reach = 0;
    for (const Triangle& t : whole.triangles)
      for (const uint32_t v : t) reach = std::max(reach, (whole.positions[v] - solid.root).norm());
    return solid.length < kWholeLength * reach;
  }

  /// Share of the area, m³.
  struct Loss {
    double area = 0, volume = 0;
  };

  std::optional<SolidDomain> try_surface(const Mesh& surface, const std::string& notes, const Loss& loss) {
    attempt_ = {};
    try {
      SolidDomain solid = attempt_solid(domain_, surface, support_, attempt_);
      if (domain_.kind == DomainKind::Branch &&
          (attempt_.kept < kWholePart || (attempt_.is_sheet && !notes.empty()))) {
        failure_ = Error(Error::Kind::Input, fmt::format("domain '{}': it is in pieces", domain_.name),
                         "make every piece a domain of its own");
        return {};
      }
      if (is_short(solid) ||
          (!notes.empty() && extent(solid.surface) < kWholeExtent * extent(domain_.surface))) {
        failure_ =
            Error(Error::Kind::Input, fmt::format("domain '{}': a part of it would be lost", domain_.name),
                  "mend its surface by hand");
        return {};
      }
      solid.route += notes;
      solid.lost_area = 1 - (1 - loss.area) * attempt_.kept;
      solid.lost_volume = (loss.volume + attempt_.lost_volume) / solid.volume;
      return solid;
    } catch (const Error& error) {
      if (error.kind != Error::Kind::Input) throw;
      failure_ = error;
      return {};
    }
  }

  std::optional<SolidDomain> untangle(const Mended& mended) {
    if (attempt_.crossing.triangles.empty()) return {};
    const double volume = signed_volume(attempt_.crossing);
    const std::optional<Mesh> mesh = untangled(attempt_.crossing);
    if (!mesh) return {};
    const double changed = std::abs(signed_volume(*mesh) - volume);
    if (!(changed < kUntangled * std::abs(volume))) return {};
    const double kept = attempt_.kept, others = attempt_.lost_volume;
    return try_surface(*mesh, mended.notes + "+untangled",
                       {1 - (1 - mended.dropped) * kept, mended.dropped_volume + others + changed});
  }

  /// Alpha grows if the wrap would be too large or enters the surface by its openings. A sheet is none of its
  /// business: a wrap would give it the thickness of its offset.
  std::optional<SolidDomain> wrap(const Mesh& mended) {
    const Mesh mesh = weld(mended);
    if (mesh.triangles.empty() || is_plane(mesh)) return {};
    if (domain_.kind == DomainKind::Leaf && has_border(mesh)) return {};
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh.positions) box.extend(p);
    const double area = surface_area(mesh), diagonal = box.diagonal().norm();
    const double diameter = std::min(area / (kPi * diagonal), diagonal);  // of a tube that long
    if (!(diameter > 1e-4 * diagonal)) return {};
    const double offset = kOffset * diameter;
    for (const double alpha : {kAlpha * diameter, 2 * kAlpha * diameter, 4 * kAlpha * diameter}) {
      if (2.3 * area / (alpha * alpha) > kMostWrapTriangles) continue;
      std::optional<Mesh> wrapped = alpha_wrap(mesh, alpha, offset);
      if (!wrapped) continue;
      const double wrapped_area = surface_area(*wrapped);
      if (2 * signed_volume(*wrapped) / wrapped_area < 8 * offset || wrapped_area > kBothSides * area)
        continue;
      const Mesh pulled = pull_back(*wrapped, mesh, 3 * offset);
      if (!self_intersects(pulled)) wrapped = pulled;
      if (auto solid = try_surface(*wrapped, "+alpha-wrapped", {})) return solid;
    }
    return {};
  }

  const Domain& domain_;
  ParentSurface support_;
  Attempt attempt_;  // of the last try
  std::optional<Error> failure_;
};

}  // namespace

SolidDomain make_solid(const SegmentedPlant& plant, DomainId domain) {
  return Ladder(plant, domain).climb();
}

}  // namespace liana
