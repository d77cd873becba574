// Small plants and a small world for the view's tests, built in code.
#pragma once

#include <optional>

#include "runtime/picture/plant_drawing.h"
#include "runtime/picture/simulation_view.h"
#include "tests/support/scenes/draw_scenes.h"

namespace liana::support {

/// Appends a branch of `count` particles of the given half length and radius (m). It starts at `foot`, in the
/// world for the first branch of a plant and in the frame of `parent` (a particle of the plant) for others,
/// and runs along `way`.
inline BranchId add_chain(Plant& plant, ParticleId parent, const Vec3& foot, const Vec3& way, int count,
                          double half_length, double radius, DomainKind kind = DomainKind::Branch) {
  const BranchId id(plant.branches.size());
  Branch branch;
  branch.kind = kind;
  branch.parent = parent.valid() ? plant.particles[parent.index()].branch : BranchId{};
  const Quat turn = Quat::FromTwoVectors(Vec3::UnitY(), way);
  Vec3 tail = foot;
  if (parent.valid())
    tail = plant.motion[parent.index()].position + plant.motion[parent.index()].orientation * foot;
  for (int i = 0; i < count; ++i) {
    Particle particle;
    particle.parent = parent;
    particle.branch = id;
    particle.half_length = half_length;
    particle.half_width = particle.half_thickness = radius;
    particle.mass = 0.01;
    particle.joint.on_self = {0, -half_length, 0};
    particle.joint.on_parent = i == 0 ? foot : Vec3(0, half_length, 0);
    Motion motion;
    motion.orientation = turn;
    motion.position = tail + turn * Vec3(0, half_length, 0);
    tail = motion.position + turn * Vec3(0, half_length, 0);
    parent = ParticleId(plant.particles.size());
    plant.particles.push_back(particle);
    plant.motion.push_back(motion);
    branch.particles.push_back(parent);
  }
  branch.length = 2 * half_length * count;
  plant.branches.push_back(branch);
  return id;
}

/// A stem of 1 m (10 particles, 2 cm thick) with one side branch and a leaf, standing at the origin.
inline Plant forked_plant() {
  Plant plant;
  plant.name = "forked";
  add_chain(plant, {}, Vec3::Zero(), Vec3::UnitY(), 10, 0.05, 0.01);
  add_chain(plant, ParticleId(4), {0.01, 0.02, 0}, Vec3(1, 1, 0).normalized(), 5, 0.04, 0.005);
  add_chain(plant, ParticleId(9), {0, 0.05, 0}, Vec3(0, 0.5, 1).normalized(), 1, 0.04, 0.03,
            DomainKind::Leaf);
  return plant;
}

/// A world without physics: a step moves the grabbed particle half the way to its target.
class FakeSimulation : public Simulation {
 public:
  explicit FakeSimulation(Plant plant) : plant_(std::move(plant)) {}

  void step() override {
    ++steps_;
    if (!grab_) return;
    Motion& motion = plant_.motion[grab_->particle.index()];
    const Vec3 held = motion.position + motion.orientation * grab_->on_particle;
    motion.position += 0.5 * (grab_->target - held);
  }
  double time_step() const override { return 0.025; }
  Vec3 gravity() const override { return world_gravity; }
  void draw(DrawScene& scene) const override {
    scene = backdrop;
    add_plant(plant_, {}, {}, scene);
  }
  size_t plant_count() const override { return 1; }
  const Plant& plant(size_t) const override { return plant_; }
  void set_grab(size_t, const WorldSpring& grab) override { grab_ = grab; }
  void clear_grab() override { grab_.reset(); }
  void cut(size_t, ParticleId particle) override { cuts.push_back(particle); }
  SimulationStats stats() const override {
    return {.time = 0.025 * double(steps_), .steps = steps_, .particles = plant_.particles.size()};
  }

  const std::optional<WorldSpring>& grab() const { return grab_; }
  Vec3 world_gravity = {0, -9.81, 0};  ///< m/s²
  DrawScene backdrop;                  ///< drawn behind the plant
  std::vector<ParticleId> cuts;        ///< asked for so far

 private:
  Plant plant_;
  size_t steps_ = 0;
  std::optional<WorldSpring> grab_;
};

}  // namespace liana::support
