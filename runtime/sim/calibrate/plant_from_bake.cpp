#include "runtime/sim/calibrate/plant_from_bake.h"

#include <algorithm>

#include "mesher/base/error.h"
#include "runtime/sim/calibrate/equilibrium.h"
#include "runtime/sim/model/centreline.h"
#include "runtime/sim/model/rod_section.h"
#include "runtime/sim/model/rotation.h"
#include "runtime/sim/model/topology.h"

namespace liana {
namespace {

size_t particle_count(const BakedDomain& domain, const Centreline& line, double spacing) {
  const bool leaf = domain.kind == DomainKind::Leaf;
  if (spacing <= 0) spacing = leaf ? 0.15 : 4 * line.mean_diameter();
  const double wanted = std::ceil(line.length() / spacing - 0.5);
  return static_cast<size_t>(std::clamp(wanted, leaf ? 1.0 : 4.0, leaf ? 8.0 : 24.0));
}

// The frame of a segment: y along it, z as near the domain's flat normal as that allows. Where the normal
// runs along the segment (a leaf that curls over) the frame of the segment before is turned on instead.
Quat segment_frame(const Vec3& along, const Vec3& flat_normal, const Quat* before) {
  const Vec3 y = along.normalized();
  Vec3 z = flat_normal - flat_normal.dot(y) * y;
  if (z.norm() < 0.5) {
    const Vec3 fallback = before ? Vec3(*before * Vec3::UnitZ()) : y.unitOrthogonal();
    z = fallback - fallback.dot(y) * y;
    if (z.norm() < 1e-3) z = y.unitOrthogonal();
  }
  z.normalize();
  if (before && z.dot(*before * Vec3::UnitZ()) < 0) z = -z;
  Mat3 R;
  R << y.cross(z), y, z;
  return Quat(R).normalized();
}

// The particle of a branch whose segment comes nearest to a point.
ParticleId nearest_particle(const Plant& plant, const Branch& branch, const Vec3& point) {
  ParticleId best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const ParticleId id : branch.particles) {
    const Motion& m = plant.motion[id.index()];
    const double half = plant.particles[id.index()].half_length;
    const Vec3 axis = m.orientation * Vec3::UnitY();
    const double s = std::clamp(axis.dot(point - m.position), -half, half);
    const double distance = (m.position + s * axis - point).norm();
    if (distance < best_distance) best = id, best_distance = distance;
  }
  return best;
}

void check(const BakedDomain& domain) {
  const DomainMaterial& m = domain.material;
  const double must_be_positive[] = {domain.mass, domain.youngs_modulus, m.frequency, domain.stiffness_ratio};
  const bool good = std::all_of(std::begin(must_be_positive), std::end(must_be_positive),
                                [](double v) { return v > 0 && std::isfinite(v); }) &&
                    m.damping_factor >= 0 && domain.flat_normal.norm() > 0.5;
  if (!good)
    throw Error(
        Error::Kind::Input,
        "domain '" + domain.name + "': mass, Young's modulus, frequency or stiffness ratio is not positive",
        "bake the plant again");
}

// Uniform for a group that the law does not know, as in bakes that are no file's.
TaperLaw taper_of(const SpeciesLaw& law, const std::string& group) {
  try {
    return law.group(group).taper;
  } catch (const Error&) {
    return {};
  }
}

BranchId append_branch_of(Plant& plant, const BakedDomain& domain, DomainId id) {
  Branch branch{.parent = domain.parent.valid() ? BranchId(domain.parent.index()) : BranchId(),
                .kind = domain.kind,
                .level = domain.level,
                .group = domain.group,
                .domain = id,
                .particles = {},
                .length = domain.length,
                .material = domain.material};
  branch.lineage = child_lineage(
      branch.parent.valid() ? plant.branches[branch.parent.index()].lineage : plant_lineage(plant.name, 0),
      LineageKind::Branch, id.index());
  plant.branches.push_back(std::move(branch));
  return BranchId(id.index());
}

// Appends one domain as a chain, in the frame of the bake.
void append_chain(Plant& plant, const Bake& bake, DomainId id, double spacing) {
  const BakedDomain& domain = bake.domains[id.index()];
  check(domain);
  const Centreline line(domain, taper_of(bake.law, domain.group));
  const size_t n = particle_count(domain, line, spacing);
  const double h = line.length() / static_cast<double>(n);
  double shares = 0;
  for (size_t i = 0; i < n; ++i) shares += line.mass_share(h * i, h * (i + 1));
  const double poisson = bake.law.default_material.poisson_ratio;

  const BranchId self = append_branch_of(plant, domain, id);
  double mass_left = domain.mass;
  for (size_t i = 0; i < n; ++i) {
    const double s0 = h * static_cast<double>(i), s1 = i + 1 == n ? line.length() : s0 + h;
    const Vec3 tail = line.at(s0).position, head = line.at(s1).position;
    if (!((head - tail).norm() > 1e-3 * h))
      throw Error(Error::Kind::Input, "domain '" + domain.name + "': its centreline turns back on itself",
                  "bake the plant again; if it stays, look at this domain's surface");
    const Station middle = line.at((s0 + s1) / 2);

    Particle particle;
    particle.half_length = (head - tail).norm() / 2;
    particle.half_width = middle.half_width;
    particle.half_thickness = middle.half_thickness;
    particle.mass = i + 1 == n ? mass_left : domain.mass * line.mass_share(s0, s1) / shares;
    mass_left -= particle.mass;
    particle.inertia =
        rod_inertia(particle.mass, particle.half_length, middle.half_width, middle.half_thickness);
    if (i > 0)
      particle.parent = plant.branches[self.index()].particles.back();
    else if (domain.parent.valid())
      particle.parent = nearest_particle(plant, plant.branches[domain.parent.index()], tail);

    const Motion* parent = particle.parent.valid() ? &plant.motion[particle.parent.index()] : nullptr;
    Motion motion;
    motion.position = (tail + head) / 2;
    motion.orientation =
        segment_frame(head - tail, domain.flat_normal, i > 0 ? &parent->orientation : nullptr);
    Joint& joint = particle.joint;
    joint.on_self = {0, -particle.half_length, 0};
    joint.on_parent = parent ? Vec3(parent->orientation.conjugate() * (tail - parent->position)) : tail;
    joint.rest = parent ? parent->orientation.conjugate() * motion.orientation : motion.orientation;
    // A joint stands for the rod between two centres; the first one for half a segment, down to the clamp.
    const Station section = line.at(s0);
    const double stands_for =
        i > 0 ? particle.half_length + plant.particles.back().half_length : particle.half_length;
    set_section(joint,
                rod_section(domain.youngs_modulus * line.material_scaling(s0), poisson, section.half_width,
                            section.half_thickness, domain.stiffness_ratio),
                stands_for);

    append_particle(plant, self, particle, motion);
  }
}

void place(Plant& plant, const Vec3& position, double yaw) {
  const Quat turn = rotation_about(Vec3::UnitY(), yaw);
  for (size_t i = 0; i < plant.particles.size(); ++i) {
    Motion& m = plant.motion[i];
    m.position = turn * m.position + position;
    m.orientation = (turn * m.orientation).normalized();
    if (plant.particles[i].parent.valid()) continue;
    Joint& joint = plant.particles[i].joint;
    joint.on_parent = turn * joint.on_parent + position;
    joint.rest = (turn * joint.rest).normalized();
  }
}

}  // namespace

Plant make_plant(const Bake& bake, const PlacementOptions& options, CalibrationReport* report) {
  Plant plant;
  plant.name = bake.plant;
  for (size_t i = 0; i < bake.domains.size(); ++i) append_chain(plant, bake, DomainId(i), options.spacing);
  place(plant, options.position, options.yaw);
  const CalibrationReport calibrated = calibrate_plant(plant, options.scheme);
  if (report) *report = calibrated;
  carry_weight(plant, options.gravity);
  return plant;
}

}  // namespace liana
